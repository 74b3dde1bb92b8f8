"""The examples of the tutorials: their own tests, and their twins in C++."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples/policies/python"


@pytest.mark.parametrize("test", sorted(EXAMPLES.glob("*_test.py")), ids=lambda path: path.stem)
def test_an_examples_own_test_passes(test):
    done = subprocess.run([sys.executable, str(test)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("passed: ") >= 1
