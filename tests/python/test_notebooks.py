"""The notebooks of examples/notebooks run from the first cell to the last, in short versions."""

import json
import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
pytest.importorskip("matplotlib")
pytest.importorskip("pandas")

NOTEBOOKS = Path(__file__).resolve().parents[2] / "examples/notebooks"
sys.path.insert(0, str(NOTEBOOKS))
import to_docs  # noqa: E402

SHORT = {
    "first_policy": {"FLIGHT_S": 45},
    "reading_a_campaign": {"FLIGHT_S": 45, "SEEDS": 2},
    "learning_a_policy": {
        "GENERATIONS": 2, "POPULATION": 4, "EPISODE_S": 8,
        "HELD_OUT_CAVES": {"small": 904}, "HELD_OUT_SEEDS": 1, "HELD_OUT_S": 45,
    },
}
PICTURES = {"first_policy": 4, "reading_a_campaign": 3, "learning_a_policy": 2}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return to_docs.copy_to(tmp_path_factory.mktemp("notebooks"))


@pytest.fixture(scope="module")
def executed(folder):
    """The notebook of a name, executed once. A cell that fails raises CellExecutionError."""
    made = {}

    def of(name):
        if name not in made:
            made[name] = to_docs.execute(name, folder, timeout_s=600, **SHORT[name])
        return made[name]

    return of


def printed(notebook):
    return "\n".join(o.text for c in notebook.cells if c.cell_type == "code" for o in c.outputs
                     if o.output_type == "stream" and o.name == "stdout")


@pytest.mark.parametrize("name", to_docs.NAMES)
def test_a_notebook_runs_and_becomes_a_page(name, executed):
    notebook = executed(name)
    assert all(o.output_type != "error" for c in notebook.cells if c.cell_type == "code" for o in c.outputs)
    page, files = to_docs.markdown(notebook, name, "images")
    assert len(files) == PICTURES[name]
    assert all(content.startswith(b"\x89PNG") and f"](images/{file})" in page for file, content in files.items())
    assert "| --- |" in page


def test_the_first_policy_is_tested_and_flown(executed, folder):
    said = printed(executed("first_policy"))
    assert "frontier 1: score -5.4, 5.4 m away\nfrontier 2: score -7.4, 7.4 m away" in said
    assert re.search(r"landed: my_nearest explored \d+ m³ of demo", said)
    assert (folder / "runs/my_nearest/report.html").exists()


def test_the_campaign_has_its_verdict(executed):
    said = printed(executed("reading_a_campaign"))
    assert "no difference shown between nearest_frontier and lateral_frontier" in said
    assert re.search(r"p = [\d.]+, 4 pairs, better: None", said)


def test_the_policy_is_learned_written_and_compared(executed, folder):
    said = printed(executed("learning_a_policy"))
    assert "generation 2: " in said
    assert json.loads((NOTEBOOKS / "held_out.json").read_text())["sentence"] in " ".join(said.split())


def test_the_learned_policy_has_the_stored_weights():
    sys.modules.pop("train", None)
    import train

    stored = json.loads((NOTEBOOKS / "learned_weights.json").read_text())
    assert (NOTEBOOKS / "learned_frontier.py").read_text() == train.policy_text(stored["weights"])


def test_training_and_comparison_fly_in_different_caves():
    import held_out

    stored = json.loads((NOTEBOOKS / "learned_weights.json").read_text())
    compared = json.loads((NOTEBOOKS / "held_out.json").read_text())["settings"]
    assert compared["caves"] == held_out.CAVES and compared["seeds"] == held_out.SEEDS
    assert not set(compared["caves"].values()) & set(stored["settings"]["cave_seeds"])


def test_notebooks_are_kept_without_output():
    for name in to_docs.NAMES:
        for cell in json.loads((NOTEBOOKS / f"{name}.ipynb").read_text())["cells"]:
            assert cell["cell_type"] != "code" or (cell["outputs"] == [] and cell["execution_count"] is None)


def test_the_pages_have_the_cells_of_the_notebooks():
    """`examples/notebooks/to_docs.py` makes the pages anew."""
    for name in to_docs.NAMES:
        page = (NOTEBOOKS.parents[1] / f"docs/notebooks/{name}.md").read_text()
        for cell in json.loads((NOTEBOOKS / f"{name}.ipynb").read_text())["cells"]:
            source = "".join(cell["source"]).rstrip()
            shown = to_docs.linked(source) if cell["cell_type"] == "markdown" else f"```python\n{source}\n```"
            assert shown in page, f"docs/notebooks/{name}.md is older than {name}.ipynb"
        for picture in re.findall(r"\]\((images/[^)]+)\)", page):
            assert (NOTEBOOKS.parents[1] / "docs/notebooks" / picture).exists()
