"""The examples of docs/steering.md, in shorter runs."""

import importlib.util
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import sinew

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "steer"


def load(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_trunk_leans_on_a_tube_and_arrives_behind_it(friction):
    inspection = load("inspection")
    inspection.TRAVEL = 0.5
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        rows, _ = inspection.inspect(friction)
    # Columns: time, error, seconds, points, sticking, slipping, normal force, gap, on target.
    there = rows[(rows[:, 0] > 1.0) & (rows[:, 0] < 1.5)]
    assert there[:, 1].max() < 5e-6 and there[:, 8].all()
    assert there[:, 6].min() > 0.5
    assert rows[:, 7].min() > -1e-9


def test_fingers_hold_a_shell_with_the_force_asked_for():
    grip = load("grip")
    grip.END, grip.ASIDE = 3.6, 0.0  # the hand has risen and rests
    rows, sim = grip.hold(1.0)
    late = rows[rows[:, 0] > 2.25]
    # The aim is 2 %, see docs/steering.md.
    assert np.abs(late[:, 1:4] - 1.0).max() < 0.04
    assert late[-1, 4] > 0.06
    assert rows[:, 5].min() > -1e-8
    # A minute's aim is 1e-6 of its size: no node goes farther, the steps' own alternation included.
    assert 0.0 < grip.creep(sim, 0.3) < 1e-6 * 2 * grip.TALL
