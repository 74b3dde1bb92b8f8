"""What several tests share: the karst program, a small cave, and a folder for what is worked out of it once."""

import pytest
from karst.errors import Error
from karst.program import program, run_karst


@pytest.fixture(scope="session")
def karst_program():
    try:
        return program()
    except Error as e:
        pytest.skip(str(e))


@pytest.fixture(scope="session")
def small_cave(karst_program, tmp_path_factory):
    stem = tmp_path_factory.mktemp("cave") / "cave"
    run_karst(["cave", "generate", "--preset", "small", "--seed", "7", "--out", stem, "--quiet"])
    return stem.with_suffix(".info")
