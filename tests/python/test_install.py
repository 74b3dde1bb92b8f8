"""`pip install` against an installed karst."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import karst
import pytest
from karst.errors import Error
from karst.program import program

SOURCE = Path(__file__).resolve().parents[2] / "sdk/python"


@pytest.fixture
def sources(tmp_path):
    """pip builds in the folder that it is given."""
    pytest.importorskip("setuptools")
    if subprocess.run([sys.executable, "-m", "pip", "--version"], capture_output=True).returncode != 0:
        pytest.skip("skipped: no pip")
    return shutil.copytree(SOURCE, tmp_path / "python")


def install(sources, into, karst_program):
    command = [sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index", "-q",
               "--target", str(into), str(sources)]
    clean = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    return subprocess.run(command, capture_output=True, text=True, env=clean | {"KARST": str(karst_program)})


def test_the_module_is_installed_with_its_compiled_parts(sources, tmp_path):
    try:
        found = program()
    except Error as e:
        pytest.skip(f"skipped: {e}")
    done = install(sources, tmp_path / "into", found)
    assert done.returncode == 0, done.stderr
    said = subprocess.run(
        [sys.executable, "-c", "import karst; print(karst.__version__, karst.read_map, karst.__file__)"],
        capture_output=True, text=True, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(tmp_path / "into")},
    )
    assert said.returncode == 0, said.stderr
    assert said.stdout.startswith(karst.__version__) and str(tmp_path) in said.stdout


def test_another_version_of_karst_is_refused(sources, tmp_path):
    other = tmp_path / "karst"
    other.write_text("#!/bin/sh\necho karst 9.8.7\n")
    other.chmod(0o755)
    done = install(sources, tmp_path / "into", other)
    assert done.returncode != 0 and "is version karst 9.8.7, and this module is" in done.stderr + done.stdout
