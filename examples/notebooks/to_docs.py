#!/usr/bin/python3
"""Executes the notebooks and renders them, with their output, to Markdown and PNG.

    to_docs.py [--out docs/notebooks] [--work FOLDER] [NAME ...]

A notebook runs in a copy of this folder, so that nothing of it stays here. Its cell tagged `parameters` can be
followed by other values: see `execute`.
"""

import argparse
import base64
import os
import re
import shutil
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

HERE = Path(__file__).resolve().parent
NAMES = ("first_policy", "reading_a_campaign", "learning_a_policy")
ROOT_LINK = "../../"  # what leads from here, and from docs/notebooks, to the repository's root


def copy_to(folder):
    """This folder's files, for a notebook to run with."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for file in HERE.iterdir():
        if file.is_file():
            shutil.copy(file, folder)
    return folder


def execute(name, folder, timeout_s=1800, **parameters):
    """The executed notebook, a node of nbformat. `parameters` replace those of the cell tagged `parameters`."""
    notebook = nbformat.read(HERE / f"{name}.ipynb", as_version=4)
    if parameters:
        at = next(i for i, cell in enumerate(notebook.cells) if "parameters" in cell.metadata.get("tags", []))
        text = "\n".join(f"{key} = {value!r}" for key, value in parameters.items())
        notebook.cells.insert(at + 1, nbformat.v4.new_code_cell(text))
    os.environ.pop("MPLBACKEND", None)  # with it, a plot is no output of its cell
    NotebookClient(notebook, timeout=timeout_s, kernel_name="python3",
                   resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


def markdown(notebook, name, pictures):
    """The page, and its pictures by file name. `pictures`: their folder as the page links it."""
    parts, files = [f"<!-- examples/notebooks/to_docs.py makes this page of {name}.ipynb -->"], {}
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            parts.append(linked(cell.source))
        elif cell.cell_type == "code":
            parts.append(f"```python\n{cell.source.rstrip()}\n```")
            for output in merged(cell.outputs):
                parts += shown(output, name, pictures, files, cell.metadata.get("alt", "Plot"))
    return "\n\n".join(part for part in parts if part) + "\n", files


def merged(outputs):
    """The outputs, with what was printed in several pieces as one."""
    whole = []
    for output in outputs:
        if whole and output.output_type == "stream" == whole[-1].output_type and output.name == whole[-1].name:
            whole[-1].text += output.text
        else:
            whole.append(output)
    return whole


def linked(text):
    """Links to other notebooks lead to their pages, and links into docs/ leave out the way there."""
    text = re.sub(r"\]\((\w+)\.ipynb\)", r"](\1.md)", text)
    return text.replace(f"]({ROOT_LINK}docs/", "](../")


def shown(output, name, pictures, files, alternative):
    """An output as Markdown: a picture, a table or text."""
    if output.output_type == "stream":
        return [fenced(output.text)] if output.name == "stdout" else []
    data = output.get("data", {})
    if "image/png" in data:
        file = f"{name}_{len(files) + 1}.png"
        files[file] = base64.b64decode(data["image/png"])
        return [f"![{alternative}]({pictures}/{file})"]
    if "text/html" in data and "<table" in data["text/html"]:
        return [table(data["text/html"])]
    if "text/markdown" in data:
        return [data["text/markdown"]]
    return [fenced(data["text/plain"])] if "text/plain" in data else []


def fenced(text):
    return f"```text\n{text.rstrip()}\n```" if text.strip() else ""


def table(html):
    """The table of a data frame in Markdown; its index is left out if it only counts."""
    head, _, body = html.partition("</thead>")
    cells = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.S) for row in re.findall(r"<tr.*?</tr>", body, re.S)]
    names = re.findall(r"<th[^>]*>(.*?)</th>", head, re.S)
    if cells and [row[0] for row in cells] == [str(i) for i in range(len(cells))]:
        names, cells = names[1:], [row[1:] for row in cells]
    rows = [names, ["---"] * len(names), *cells]
    return "\n".join("| " + " | ".join(cell.strip().replace("|", "\\|") for cell in row) + " |" for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=NAMES, metavar="NAME")
    parser.add_argument("--out", type=Path, default=HERE.parents[1] / "docs/notebooks")
    parser.add_argument("--work", type=Path, help="folder to run in, which is kept; default: a temporary one")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="karst-notebooks-") as temporary:
        folder = copy_to(a.work or temporary)
        for name in a.names:
            page, files = markdown(execute(name, folder), name, "images")
            (a.out / "images").mkdir(parents=True, exist_ok=True)
            for old in (a.out / "images").glob(f"{name}_*.png"):
                old.unlink()
            (a.out / f"{name}.md").write_text(page, encoding="utf-8")
            for file, content in files.items():
                (a.out / "images" / file).write_bytes(content)
            print(f"{a.out / name}.md: {len(files)} pictures")


if __name__ == "__main__":
    main()
