"""The example in which a soft gripper lifts a soft cup."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

GRASP = Path(__file__).resolve().parents[2] / "examples" / "grasp" / "grasp.py"


@pytest.fixture
def grasp():
    described = importlib.util.spec_from_file_location("grasp", GRASP)
    example = importlib.util.module_from_spec(described)
    described.loader.exec_module(example)
    example.LIFTS, example.LIFTED, example.LIFT = 1.1, 1.3, 12e-3  # s, m: an earlier and shorter lift at the speed of the example
    return example


def test_a_soft_gripper_lifts_a_soft_cup(grasp):
    sim = grasp.make()
    gaps, _, _ = grasp.run(sim, 1.5)  # raises if a step is flagged
    cup = sim.body("cup")
    before = cup.positions.copy()
    later, _, _ = grasp.run(sim, 1.7)
    held = grasp.held(sim)
    assert cup.mass == pytest.approx(54.4e-3, rel=1e-3)
    assert held["risen"] - grasp.LIFT == pytest.approx(2.45e-3, abs=0.2e-3)
    assert held["normal"] == pytest.approx([0.41, 0.40, 0.40], rel=0.04)
    assert held["along"] == pytest.approx([0.097, 0.101, 0.091], rel=0.05)
    assert abs(held["imbalance"]) < 1e-4
    assert np.degrees(held["tilt"]) < 0.3
    assert held["sideways"] < 1e-3
    assert held["carrying"] <= 12 < held["near"]
    assert np.abs(cup.positions - before).max() < 50e-6  # after 0.2 s at rest
    assert np.nanmin([*gaps, *later]) > -1e-9


def test_walls_that_widen_upwards_need_less_friction(grasp):
    grasp.STEP = 0.02  # s
    tapered, straight = (grasp.make(radii=radii, friction=0.3) for radii in (grasp.TAPERED, grasp.STRAIGHT))
    for sim in (tapered, straight):
        grasp.run(sim, 1.3)
    assert grasp.risen(tapered) > grasp.LIFT - 0.5e-3
    assert abs(grasp.risen(straight)) < 0.5e-3
    assert straight.contact("table").normal_force > 0.0


def test_fingers_that_pull_too_hard_slide_around_the_cup(grasp):
    grasp.STEP = 0.02  # s
    sim = grasp.make(pull=10e-3)
    grasp.run(sim, 1.1)
    assert grasp.sideways(sim) > 10e-3  # 0.3 mm at a pull of 8 mm
