"""Finding and running karst, with shell scripts in its place."""

import sys

import karst
import pytest
from karst.errors import Error
from karst.program import program, run_karst

module = sys.modules["karst.program"]  # karst.program may also be the function


def script(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f'#!/bin/sh\n[ "$1" = --version ] && echo "karst {karst.__version__}" && exit\n{text}\n')
    path.chmod(0o755)
    return path


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    """The package as if installed in tmp_path/prefix, without KARST and with a PATH of one empty folder."""
    installed = tmp_path / "prefix/lib/karst/python/karst/program.py"
    monkeypatch.setattr(module, "__file__", str(installed))
    monkeypatch.delenv("KARST", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path / "path"))
    return tmp_path


def test_order_of_places(elsewhere, monkeypatch):
    on_path = script(elsewhere / "path/karst", "")
    assert program() == on_path
    beside = script(elsewhere / "prefix/bin/karst", "")
    assert program() == beside
    named = script(elsewhere / "mine/karst-new", "")
    monkeypatch.setenv("KARST", str(named))
    assert program() == named


def test_none_says_what_was_tried(elsewhere, monkeypatch):
    with pytest.raises(Error, match=r"KARST is not set, .*/prefix/bin/karst is no program, .* on the PATH"):
        program()
    monkeypatch.setenv("KARST", "/no/such/karst")
    with pytest.raises(Error, match="KARST: /no/such/karst: is no program"):
        program()


def test_output_and_errors(tmp_path, monkeypatch):
    monkeypatch.setenv("KARST", str(script(tmp_path / "karst", 'echo "$1 ä"')))
    assert run_karst(["a b"]) == "a b ä\n"
    fails = script(tmp_path / "fails", 'echo "karst: x.info: line 3: no such key" >&2; exit 1')
    monkeypatch.setenv("KARST", str(fails))
    with pytest.raises(Error, match=r"^x.info: line 3: no such key$"):
        run_karst(["fly"])
    monkeypatch.setenv("KARST", str(script(tmp_path / "dies", "kill -SEGV $$")))
    with pytest.raises(Error, match="fly: was ended by SIGSEGV"):
        run_karst(["fly"])
    monkeypatch.setenv("KARST", str(script(tmp_path / "mute", "exit 7")))
    with pytest.raises(Error, match="exit code 7, without a message"):
        run_karst(["fly"])


def test_what_is_not_installed_is_named(monkeypatch):
    from karst.needed import needed

    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(Error, match="plotting needs .* python3-matplotlib, or pip install matplotlib"):
        needed("matplotlib.pyplot", "plotting")
