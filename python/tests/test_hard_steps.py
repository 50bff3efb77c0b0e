"""Quasi-static steps that Newton's method does not solve at once: the loads are those of the end of the step."""

import numpy as np
import pytest
import sinew


def plate(young_modulus):
    """A thin plate, clamped at its rim, under pressure from below."""
    return {
        "sinew": 1, "gravity": "0 0 0 m/s^2", "time_step": "50 ms", "duration": "1 s", "solver": {"tolerance": 1e-8},
        "bodies": {"plate": {
            "type": "fem", "mesh": {"shape": "cylinder", "radius": "50 mm", "height": "2 mm", "element_size": "5 mm"},
            "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": young_modulus, "poisson_ratio": 0.0},
            "fixed": {"set": "side"}}},
        "loads": {"gas": {"type": "pressure", "body": "plate", "surface": {"set": "bottom"},
                          "pressure": {"ramp": {"to": 1000.0, "duration": "1 s"}}}},
    }  # fmt: skip


def test_a_load_that_asks_for_parts_of_the_step_acts_in_full():
    # The first steps are strongly nonlinear: before it stretches, the plate has hardly any transverse stiffness.
    sim = sinew.load(plate("10 kPa"))
    iterations = []
    for _ in range(2):
        sim.step()
        assert not sim.report.flagged
        iterations.append(sim.report.iterations)
    assert max(iterations) > 50  # a step was split, or needed descent steps
    reached = sim.body("plate").positions.copy()
    sim.solve_static()
    assert np.abs(reached - sim.body("plate").positions).max() < 1e-6
    assert np.ptp(reached[:, 2]) > 20e-3


def hand():
    """A finger on a hinge whose motor holds 0.03 N m; a force across it grows to 1 N."""
    return {
        "sinew": 1, "gravity": "0 0 0 m/s^2", "time_step": "50 ms", "duration": "1 s", "solver": {"tolerance": 1e-8},
        "bodies": {
            "palm": {"type": "rigid", "shape": {"box": "30 30 10 mm"}, "mass": "50 g"},
            "finger": {"type": "fem", "element": "tet4", "mesh": {"shape": "block", "length": "15 mm", "width": "15 mm", "height": "60 mm",
                                               "element_size": "7.5 mm"}, "pose": {"position": "-7.5 -7.5 5 mm"},
                       "material": {"model": "neo-hookean", "young_modulus": "1 MPa", "poisson_ratio": 0.4}},
        },
        "joints": {"wrist": {"type": "hinge", "bodies": ["world", "palm"], "point": "0 0 0 mm", "axis": "y"},
                   "root": {"type": "weld", "bodies": ["finger", "palm"]}},
        "actuators": {"motor": {"type": "motor", "joint": "wrist", "command": {"angle": 0.0},
                                "limits": {"torque": {"min": -0.03, "max": 0.03}}}},
        "loads": {"push": {"type": "force", "body": "finger", "point": "0 0 60 mm", "force": "1 0 0 N",
                           "factor": {"ramp": {"to": 1.0, "duration": "1 s"}}}},
    }  # fmt: skip


def test_a_motor_at_its_limit_gives_way_to_the_load_of_the_step():
    sim = sinew.load(hand())
    torques = []
    for _ in range(20):
        sim.step()
        assert not sim.report.flagged
        # The motor balances the moment of the force about the hinge.
        torques.append(sim.actuator("motor").torque)
    end = sim.clone()
    end.solve_static()
    turned = [2.0 * np.arctan2(np.abs(s.body("palm").rotation[2]), s.body("palm").rotation[0]) for s in (sim, end)]
    assert abs(torques[-1]) > 0.03 - 1e-6 and turned[0] > 0.5
    assert abs(turned[0] - turned[1]) < 1e-6


def test_a_slack_cable_cannot_keep_the_limit_of_its_displacement():
    # A force shortens the path of the cable beyond its limit: the tension is at its minimum, so the limit must be violated.
    sim = sinew.load({
        "sinew": 1, "gravity": "0 0 0 m/s^2", "time_step": "5 ms", "integrator": "bdf2",
        "bodies": {"beam": {
            "type": "fem", "mesh": {"shape": "block", "length": "60 mm", "width": "10 mm", "height": "10 mm", "element_size": "10 mm"},
            "material": {"young_modulus": "150 kPa", "poisson_ratio": 0.3}, "density": 1000.0, "fixed": {"set": "x_min"}}},
        "actuators": {
            "cable": {"type": "cable", "body": "beam", "pull": "world", "outside": "nearest", "points": ["58 5 8 mm", "-10 5 8 mm"],
                      "limits": {"displacement": {"max": "0.5 mm"}}, "command": {"tension": "0 N"}},
            "push": {"type": "force", "body": "beam", "point": "58 5 5 mm", "direction": "-1 0 0", "outside": "nearest",
                     "command": {"force": {"ramp": {"to": 2.0, "duration": "20 ms"}}}}},
    })  # fmt: skip
    reached = []
    for _ in range(6):
        sim.step()
        assert not sim.report.flagged
        assert sim.report.iterations < 10
        assert sim.actuator("cable").tension == 0.0
        reached.append(sim.actuator("cable").displacement)
    assert max(reached) > 1.0e-3  # twice the limit


def pulled_arm(element, model, friction, command, points=6):
    """A slender arm, and a cable with friction off its axis that bends it."""
    x = np.linspace(0.0, 95.0, points)
    return {
        "sinew": 1, "gravity": "0 0 0 m/s^2",
        "bodies": {"arm": {"type": "fem", "element": element, "fixed": {"set": "x_min"},
                           "mesh": {"shape": "block", "length": "95 mm", "width": "27 mm", "height": "12 mm", "element_size": "6 mm"},
                           "material": {"model": model, "young_modulus": "72 kPa", "poisson_ratio": 0.42}}},
        "actuators": {"cable": {"type": "cable", "body": "arm", "friction": friction, "command": command,
                                "points": [f"{at} 20 10 mm" for at in x]}},
    }  # fmt: skip


@pytest.mark.filterwarnings("ignore:.*locking-element")
@pytest.mark.parametrize("command", [{"displacement": "14 mm"}, {"tension": "0.5 N"}])
@pytest.mark.parametrize("friction", [0.05, 0.3])
@pytest.mark.parametrize("element, model", [("tet4", "corotational"), ("hex8", "neo-hookean")])
def test_a_cable_slides_through_all_of_its_guides_in_one_step(element, model, friction, command):
    """The limits of friction move with the robot: a guide that has slid may end inside its own by less than the tolerance."""
    sim = sinew.load(pulled_arm(element, model, friction, command))
    cable = sim.actuator("cable")
    for _ in range(3):
        sim.step()
        assert sim.report.status == "solved"
        assert sim.report.iterations <= 20
    # Euler: all guides slide towards the pull. A guide within the tolerance of its limit is at it.
    assert cable.wrap > 0.3
    assert cable.tensions[0] / cable.tensions[-1] == pytest.approx(np.exp(friction * cable.wrap), rel=1e-4)
    end = sim.body("arm").positions.copy()
    sim.solve_static()
    assert np.abs(sim.body("arm").positions - end).max() < 1e-5


def column(side, **more):
    """A soft column that carries a block. Its own weight and the block's buckle it; nothing in it favours a side."""
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2",
        "bodies": {
            "column": {"type": "fem", "material": "ecoflex-00-30", "density": 1050.0, "fixed": {"set": "z_min"},
                       "pose": {"position": [-side / 2, -side / 2, 0]},
                       "mesh": {"shape": "block", "length": side, "width": side, "height": 0.1, "element_size": side / 2}},
            "block": {"type": "rigid", "shape": {"box": [side, side, side]}, "mass": 0.02, "pose": {"position": [0, 0, 0.1 + side / 2]}}},
        "joints": {"top": {"type": "weld", "bodies": ["column", "block"], "points": [[0, 0, 0.1], [side / 4, 0, 0.1], [0, side / 4, 0.1]],
                           "outside": "nearest"}},
        "effectors": {"tip": {"body": "column", "point": [0, 0, 0.1], "outside": "nearest"}}, **more,
    }  # fmt: skip


@pytest.mark.parametrize("side", [0.018, 0.02])
@pytest.mark.parametrize("wall", [False, True])
def test_a_column_that_buckles_in_a_step_comes_to_rest(side, wall):
    """From an unstable equilibrium, or past it; a wall may stop it on its way."""
    scene = column(side)
    if wall:
        scene["bodies"]["wall"] = {"type": "rigid", "shape": {"plane": {}}, "fixed": True,
                                   "pose": {"position": [-0.02, 0, 0], "rotation": {"axis": "y", "angle": "90 deg"}}}
        scene["contacts"] = {"wall": {"between": ["column", "wall"]}}
    sim = sinew.load(scene)
    sim.step()
    assert sim.report.status == "solved"
    assert sim.report.snapped
    there = np.array(sim.effector("tip").position)
    assert np.linalg.norm(there[:2]) > 0.01
    report = sim.solve_static()
    assert report.stable
    assert np.linalg.norm(np.array(sim.effector("tip").position) - there) < 1e-4


def drooping(height, commands):
    """A soft column with two cables inside that are reeled in: it droops, and the cables hold it where it would fall further."""
    side = 0.0153
    cables = {f"cable_{k}": {"type": "cable", "body": "column", "outside": "nearest",
                             "points": [[0, y, z] for z in np.linspace(0.002, height - 0.002, 6)],
                             "command": {"displacement": {"ramp": {"to": reeled, "duration": "100 ms"}}}}
              for k, (y, reeled) in enumerate(zip((0.0061, -0.0061), commands))}
    return {
        "sinew": 1, "gravity": "0 0 -9.81 m/s^2", "time_step": "20 ms",
        "bodies": {"column": {"type": "fem", "material": "ecoflex-00-30", "density": 1050.0, "fixed": {"set": "z_min"},
                              "pose": {"position": [-side / 2, -side / 2, 0]},
                              "mesh": {"shape": "block", "length": side, "width": side, "height": height, "element_size": side / 2}}},
        "masses": {"tip": {"body": "column", "point": [0, 0, height], "mass": 0.005, "outside": "nearest"}},
        "actuators": cables, "effectors": {"tip": {"body": "column", "point": [0, 0, height], "outside": "nearest"}},
    }  # fmt: skip


@pytest.mark.filterwarnings("ignore:.*(bare-points|strain-range)")
@pytest.mark.parametrize("commands", [(0.0114, 0.0069), (0.02, 0.0), (0.015, 0.012)])
def test_taut_cables_hold_what_would_fall_without_them(commands):
    sim = sinew.load(drooping(0.1, commands))
    for _ in range(6):
        sim.step()
        assert sim.report.status == "solved"
    there = np.array(sim.effector("tip").position)
    taut = [sim.actuator(name).tension > 0.0 for name in ("cable_0", "cable_1")]
    assert any(taut)
    report = sim.solve_static()
    assert report.stable
    assert np.linalg.norm(np.array(sim.effector("tip").position) - there) < 1e-5


@pytest.mark.parametrize("side", [0.018, 0.02, 0.022])
def test_statics_find_where_a_column_falls(side):
    """A motion with little inertia comes to a standstill at the upright, unstable equilibrium."""
    sim = sinew.load(column(side))
    report = sim.solve_static()
    assert report.stable
    there = np.array(sim.effector("tip").position)
    assert np.linalg.norm(there[:2]) > 0.01
    sim.step()
    assert sim.report.status == "solved" and not sim.report.snapped
    assert np.linalg.norm(np.array(sim.effector("tip").position) - there) < 1e-4
