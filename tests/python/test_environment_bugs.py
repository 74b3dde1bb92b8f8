"""Bugs of karst.Environment that were fixed."""

import karst
import pytest


@pytest.fixture(scope="module")
def cave(tmp_path_factory):
    try:
        karst.program.program()
    except karst.Error as e:
        pytest.skip(str(e))
    stem = tmp_path_factory.mktemp("caves") / "demo"
    karst.run_karst(["cave", "generate", "--preset", "small", "--seed", "7", "--out", stem])
    return stem.with_suffix(".info")


def test_reset_with_the_seed_of_a_flight_that_was_given_up_begins_anew(cave):
    with karst.Environment(cave, seed=3, time_s=40) as environment:
        first = [environment.reset(), environment.step(0)]
        again = [environment.reset(), environment.step(0)]
        assert first[1][1] == again[1][1]


def test_a_wrong_argument_of_a_service_costs_no_decision(cave):
    with karst.Environment(cave, time_s=40) as environment:
        _, info = environment.reset()
        with pytest.raises(karst.Error, match="TypeError"):
            info["request"].map.cells("here")
        assert info["request"].map.free_cells > 0
        assert info["request"].sequence + 1 == environment.step(0)[4]["request"].sequence


def test_an_action_that_is_none_leaves_all_environments_as_they_are(cave):
    both = karst.Environments([karst.Environment(cave, seed=seed, time_s=40) for seed in (1, 2)])
    before = [info["request"] for _, info in both.reset()]
    with pytest.raises(karst.Error, match="there is no frontier 99"):
        both.step([0, 99])
    after = [info["request"] for _, _, _, _, info in both.step([0, 0])]
    assert [r.sequence for r in after] == [r.sequence + 1 for r in before]
    both.close()
