"""The hand with soft fingers on a rigid arm: grip forces, final position of the box, motor torques."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hybrid" / "pick.py"


@pytest.fixture(scope="module")
def pick():
    described = importlib.util.spec_from_file_location("pick", EXAMPLE)
    module = importlib.util.module_from_spec(described)
    described.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def found(pick):
    return pick.pick(set={"time_step": "10 ms"})[0]  # raises if a step is not solved


def test_the_motion_is_the_script_s(pick, tmp_path):
    pick.write_motion(tmp_path / "pick.csv")
    tables = (folder / "pick.csv" for folder in (tmp_path, EXAMPLE.parent))
    written, kept = (np.loadtxt(table, delimiter=",", skiprows=1) for table in tables)
    np.testing.assert_allclose(written, kept, atol=1.01e-4)


def test_nothing_overlaps(found):
    assert -1e-8 < found["gap"] <= 0.0


def test_the_fingers_bear_the_weight(found):
    assert found["borne"].sum() == pytest.approx(found["weight"], rel=1e-6)
    assert found["normal"] == pytest.approx([0.290, 0.290, 0.575], rel=0.02)
    assert found["borne"] == pytest.approx([0.100, 0.1055, 0.187], rel=0.02)
    assert found["tension"] == pytest.approx([6.22, 6.23, 11.47], rel=0.02)
    assert (found["borne"] < 0.7 * found["normal"]).all()


def test_the_box_stays_in_the_hand_and_gets_to_its_place(found):
    (before, turned_before), (after, turned) = found["lifted"], found["held"]
    assert np.linalg.norm(after - before) < 0.1e-3
    assert abs(turned - turned_before) < np.radians(0.3)
    outwards, sideways, up = found["off"]
    assert outwards == pytest.approx(-0.5e-3, abs=0.1e-3)
    assert abs(sideways) < 0.05e-3
    assert abs(up) < 1e-8  # it stands on the table


def test_the_motors_bear_what_statics_says(pick, found):
    for case in ("loaded", "empty"):
        assert found[case][:2] == pytest.approx(pick.torques(case == "loaded")[:2], rel=1e-3)
        assert abs(found[case][2]) < 5e-4
    assert found["loaded"][0] - found["empty"][0] == pytest.approx(-found["weight"] * pick.REACH, rel=5e-3)
