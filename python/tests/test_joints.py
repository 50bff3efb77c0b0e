"""Welded bodies, positioned bodies, and cables through two bodies."""

import pathlib

import numpy as np
import pytest
import sinew

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "joints" / "two_segments.yaml"


def block(**keys):
    return {"type": "fem", "density": 1000.0,
            "mesh": {"shape": "block", "length": 0.04, "width": 0.02, "height": 0.02,
                     "element_size": 0.01},
            "material": {"model": "corotational", "young_modulus": 2e5, "poisson_ratio": 0.3}, **keys}


def scene(**keys):
    return {"sinew": 1, "gravity": [0, 0, -9.81],
            "bodies": {"a": block(fixed={"set": "x_min"}), "b": block(pose={"position": [0.04, 0, 0]})},
            "joints": {"seam": {"type": "weld", "bodies": ["b", "a"]}}, **keys}


def test_a_weld_carries_what_hangs_on_it():
    sim = sinew.load(scene())
    sim.solve_static()
    seam = sim.joint("seam")
    weight = 0.04 * 0.02 * 0.02 * 1000.0 * 9.81
    assert seam.bodies == ("b", "a")
    assert seam.force == pytest.approx([0, 0, -weight], abs=1e-9)
    assert seam.gap < 1e-12
    assert seam.centre == pytest.approx([0.04, 0.01, 0.01], abs=2e-3)
    assert seam.moment[1] == pytest.approx(weight * 0.02, rel=0.05)
    assert repr(seam) == "<sinew.Joint 'seam', 9 points of 'b' welded to 'a'>"
    assert list(sim.joints) == ["seam"]
    with pytest.raises(sinew.Error, match="did you mean 'seam'"):
        sim.joint("seem")


@pytest.mark.parametrize("keys", [{}, {"integrator": "backward-euler", "time_step": 0.005}])
def test_a_chain_of_welds_is_one_body(keys):
    whole = scene(joints={}, **keys)
    whole["bodies"] = {"a": block(fixed={"set": "x_min"})}
    whole["bodies"]["a"]["mesh"]["length"] = 0.16
    chain = scene(**keys)
    chain["bodies"] |= {"c": block(pose={"position": [0.08, 0, 0]}), "d": block(pose={"position": [0.12, 0, 0]})}
    chain["joints"] |= {"two": {"type": "weld", "bodies": ["c", "b"]},
                        "three": {"type": "weld", "bodies": ["d", "c"]},
                        "again": {"type": "weld", "bodies": ["c", "b"]}}  # shares the load
    tips = []
    for given, last in ((whole, "a"), (chain, "d")):
        sim = sinew.load({**given, "effectors": {"tip": {"body": last, "point": [0.16, 0.01, 0.01]}}})
        sim.solve_static()
        tips.append(np.array(sim.effector("tip").position))
    assert tips[1] == pytest.approx(tips[0], abs=1e-10)
    assert sim.joint("again").force == pytest.approx(sim.joint("two").force, rel=1e-6, abs=1e-9)


def test_rows_of_joints_are_taken_out_of_the_compliance():
    sim = sinew.load(scene(effectors={"tip": {"body": "b", "point": [0.08, 0.01, 0.01]}}))
    sim.solve_static()
    assert sim.rows == ["tip.x", "tip.y", "tip.z"]
    assert sim.linearise().W.shape == (3, 3)
    assert sim.linearise().negative_pivots == 0


def test_a_body_is_turned_about_its_origin_and_placed():
    turned = block(pose={"position": [0, 0, 0.1], "rotation": [0, 0, np.pi / 2]}, fixed={"set": "x_min"})
    sim = sinew.load({"sinew": 1, "bodies": {"a": turned}})
    nodes = np.array(sim.body("a").rest_positions)
    assert nodes.min(axis=0) == pytest.approx([-0.02, 0.0, 0.1], abs=1e-12)
    assert nodes.max(axis=0) == pytest.approx([0.0, 0.04, 0.12], abs=1e-12)


def test_states_go_on_bit_for_bit():
    sim = sinew.load(str(EXAMPLE))
    for _ in range(20):
        sim.step()
    state = sim.state()
    for _ in range(5):
        sim.step()
    after = np.array(sim.body("upper").positions)
    sim.restore(state)
    for _ in range(5):
        sim.step()
    assert np.array_equal(after, sim.body("upper").positions)


def test_the_example_stays_on_its_circle():
    sim = sinew.load(str(EXAMPLE))
    recorded = sim.run(2.0, record=["tip.position", "seam.gap", "status"])
    tip = np.array(recorded["tip.position"])[50:]
    radius = np.hypot(tip[:, 0], tip[:, 1])
    assert np.abs(radius - 0.02).max() < 5e-5
    assert np.max(recorded["seam.gap"]) < 1e-12
    assert set(recorded["status"][1:]) == {"solved"}


def test_what_is_not_held_is_named():
    with pytest.raises(sinew.Error, match="nothing holds this body.*weld it to a body"):
        sinew.load(scene(joints={}))
    with pytest.raises(sinew.Error, match="leave it free to move"):
        sinew.load(scene(joints={"seam": {"type": "weld", "bodies": ["b", "a"],
                                          "points": [[0.04, 0.01, 0.01]]}}))
    with pytest.raises(sinew.Error, match="cannot be welded to itself"):
        sinew.load(scene(joints={"seam": {"type": "weld", "bodies": ["b", "b"]}}))
    apart = scene()
    apart["bodies"]["b"]["pose"] = {"position": [0.05, 0, 0]}
    with pytest.raises(sinew.Error, match="no node of 'b' lies in or on 'a'"):
        sinew.load(apart)


def test_points_of_a_weld_may_lie_beside_both_bodies():
    beside = {"type": "weld", "bodies": ["b", "a"], "points": [[0.04, 0.01, 0.0205], [0.04, 0.005, 0.0205], [0.04, 0.01, -0.0005]]}
    with pytest.raises(sinew.Error, match="lies 0.0005 m outside.*`outside: nearest`"):
        sinew.load(scene(joints={"seam": beside}))
    sim = sinew.load(scene(joints={"seam": beside | {"outside": "nearest"}}))
    sim.solve_static()
    assert sim.joint("seam").gap < 1e-12
    assert sim.joint("seam").force == pytest.approx([0, 0, -0.04 * 0.02 * 0.02 * 1000.0 * 9.81], abs=1e-9)


def test_a_light_bracket_under_great_forces_takes_few_iterations():
    # A stone of 20 g at 1 m/s hits a link, which a bracket of 0.6 g connects to a rubber finger; steps of 5 ms.
    sim = sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": "bdf2", "gravity": "-3 0 -5 m/s^2", "solver": {"method": "newton"},
        "bodies": {
            "finger": {"type": "fem", "element": "tet4",
                       "mesh": {"shape": "cylinder", "radius": "10 mm", "height": "60 mm", "element_size": "15 mm"},
                       "material": {"model": "neo-hookean", "young_modulus": "120 kPa", "poisson_ratio": 0.35}, "density": 1000.0,
                       "fixed": {"set": "bottom"}},
            "bracket": {"type": "rigid", "shape": {"box": "8 8 8 mm"}, "density": 1200.0, "pose": {"position": "0 8 48 mm"}},
            "link": {"type": "rigid", "shape": {"capsule": {"radius": "8 mm", "length": "44 mm"}}, "density": 1000.0,
                     "pose": {"position": "30 8 48 mm", "rotation": {"axis": "y", "angle": "90 deg"}}},
            "stone": {"type": "rigid", "shape": {"box": "30 30 30 mm"}, "pose": {"position": "60 8 26.1 mm"}, "mass": "20 g",
                      "velocity": {"linear": "0 0 1 m/s", "angular": "3 1 2 rad/s"}},
        },
        "contacts": {"knock": {"between": ["link", "stone"], "points": ["60 8 48 mm", "60 8 43 mm"], "outside": "nearest"}},
        "joints": {"bond": {"type": "weld", "bodies": ["finger", "bracket"], "points": ["0 8 45 mm", "3 8 51 mm", "-3 7 48 mm"], "outside": "nearest"},
                   "seam": {"type": "slider", "bodies": ["bracket", "link"], "point": "0 8 48 mm", "axis": "1 0 0",
                            "limits": {"displacement": {"min": "-2 mm", "max": "1 mm"}}}},
    })  # fmt: skip
    for _ in range(6):
        sim.step()
        assert not sim.report.flagged
        assert sim.report.substeps == 1
        assert sim.report.iterations <= 8


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
def test_efforts_of_limits_and_of_friction(integrator):
    """A bar rests on the stop of its hinge; a slider sticks by friction, and slides against it."""
    weight, arm = 0.2 * 9.81, 0.05
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, -9.81], "integrator": integrator, "time_step": "1 ms",
        "bodies": {"bar": {"type": "rigid", "shape": {"box": "100 10 10 mm"}, "mass": "200 g", "pose": {"position": [arm, 0, 0]}},
                   "cart": {"type": "rigid", "shape": {"box": "10 10 10 mm"}, "mass": "100 g", "pose": {"position": [0, 1, 0]}}},
        "joints": {"stop": {"type": "hinge", "bodies": ["world", "bar"], "point": [0, 0, 0], "axis": "y", "limits": {"angle": {"max": 0}}},
                   "rail": {"type": "slider", "bodies": ["world", "cart"], "point": [0, 1, 0], "axis": "x", "friction": "0.7 N"}},
        "actuators": {"push": {"type": "linear-motor", "joint": "rail", "command": {"force": 0.5}}}})
    sim.run(0.05)
    stop, rail = sim.joint("stop"), sim.joint("rail")
    assert stop.limit_torque == pytest.approx(-weight * arm, rel=1e-6)  # gravity turns it towards a larger angle about y
    assert stop.friction_effort == 0.0 and rail.limit_force == 0.0
    assert rail.friction_effort == pytest.approx(-0.5, rel=1e-6)
    sim.actuator("push").force = 2.0
    sim.run(0.05)
    assert rail.friction_effort == pytest.approx(-0.7, rel=1e-9) and rail.displacement > 0.005
    with pytest.raises(AttributeError, match="hinge and has no limit_force"):
        stop.limit_force
    speed = 0.05 * (2.0 - 0.7) / 0.1
    assert sim.body("cart").kinetic_energy == pytest.approx(0.5 * 0.1 * speed**2, rel=5e-2)
    assert sim.body("cart").kinetic_energy == pytest.approx(sim.ledger["kinetic_energy"], rel=1e-9)
