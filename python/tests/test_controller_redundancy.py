"""Controllers with redundant actuators, and with rows that they do not control: twin cables, springs, gas, friction."""

import numpy as np
import pytest
import sinew

TARGET = [0.0125, 0.011, 0.0985]
MODERATE = {"tension": {"min": 0.0, "max": 4.0}}


def cable(x, y, **more):
    points = [[x, y, z] for z in (0.0, 0.02, 0.04, 0.06, 0.08, 0.1)]
    return {"type": "cable", "body": "b", "points": points, "limits": MODERATE, **more}


def block(**actuators):
    """A block of 20 x 20 x 100 mm with a cable at each side, and further actuators."""
    sides = {"east": cable(0.017, 0.01), "north": cable(0.01, 0.017), "west": cable(0.003, 0.01),
             "south": cable(0.01, 0.003)}
    return {
        "sinew": 1,
        "solver": {"tangent": "exact"},
        "bodies": {"b": {
            "type": "fem", "fixed": [{"set": "z_min"}],
            "material": {"young_modulus": 3e5, "poisson_ratio": 0.4},
            "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.1, "element_size": 0.01},
        }},
        "actuators": {**sides, **actuators},
        "effectors": {"tip": {"body": "b", "point": [0.01, 0.01, 0.1]}},
    }


def spring(x, y):
    return {"type": "spring", "body": "b", "points": [[x, y, 0.0], [x, y, 0.1]], "stiffness": 50.0}


def comes_to_rest(scene, owned=("east", "north", "west", "south"), **settings):
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": TARGET}, actuators=list(owned), **settings)
    ik.step(150)
    assert ik.status == "on-target" and ik.error < 5e-5
    before = sim.effector("tip").position
    ik.step(20)
    assert sim.effector("tip").position == pytest.approx(before, abs=1e-6)
    assert sim.report.relative_residual < 1e-3
    return sim, ik


@pytest.mark.parametrize("offset", [0.0, 1e-9, 1e-6])
@pytest.mark.parametrize("regularisation", ["change", "effort"])
def test_twin_cables_share_the_pull(offset, regularisation):
    scene = block(twin=cable(0.017 + offset, 0.01))
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": TARGET}, regularisation=regularisation, epsilon=1e-4)
    ik.step(150)
    assert ik.status == "on-target"
    efforts = dict(zip(ik.actuators, ik.efforts))
    if offset == 0.0:  # with an offset, however small, the cables differ
        assert efforts["twin"] == pytest.approx(efforts["east"], abs=1e-3)
    _, single = comes_to_rest(block())
    pull = dict(zip(single.actuators, single.efforts))["east"]
    assert efforts["twin"] + efforts["east"] == pytest.approx(pull, rel=0.05)


def test_a_twin_takes_over_where_the_other_is_at_its_limit():
    weak = cable(0.017, 0.01)
    weak["limits"] = {"tension": {"min": 0.0, "max": 0.05}}
    sim, ik = comes_to_rest(block(twin=weak), owned=("east", "north", "west", "south", "twin"))
    assert sim.actuator("twin").tension == pytest.approx(0.05, abs=1e-9)
    assert sim.actuator("east").tension > 0.05


def test_a_twin_that_others_command():
    scene = block(twin=cable(0.017, 0.01, command={"tension": 0.1}))
    sim, ik = comes_to_rest(scene)
    assert sim.actuator("twin").tension == pytest.approx(0.1)
    scene = block(twin=cable(0.017, 0.01, command={"displacement": 0.0005}))
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": TARGET}, actuators=["east", "north", "west", "south"])
    ik.step(100)
    # East, on the same line, can replace the twin, which is then slack with a command of 0.5 mm.
    assert ik.status == "on-target"
    assert sim.actuator("twin").slack and sim.actuator("twin").displacement > 0.0005
    # The target needs the twin, whose command remains in effect.
    sim = sinew.load(block(twin=cable(0.017, 0.01, command={"displacement": 0.003})))
    ik = sinew.InverseController(sim, targets={"tip": TARGET}, actuators=["north", "west", "south"])
    ik.step(100)
    assert sim.actuator("twin").displacement == pytest.approx(0.003, abs=1e-6)
    assert sim.actuator("twin").tension > 0.0


@pytest.mark.parametrize("place", [(0.01, 0.01), (0.017, 0.01)])
def test_beside_a_spring_also_along_a_cable(place):
    sim, ik = comes_to_rest(block(spring=spring(*place)))
    assert sim.actuator("spring").tension != 0.0


def test_beside_two_springs_on_one_line():
    comes_to_rest(block(spring=spring(0.01, 0.01), second=spring(0.01, 0.01)))


def test_with_friction_and_a_twin():
    friction = {"friction": 0.2}
    scene = block(twin=cable(0.017, 0.01, **friction))
    for name in ("east", "north", "west", "south"):
        scene["actuators"][name].update(friction)
    comes_to_rest(scene, owned=("east", "north", "west", "south", "twin"))


def test_beside_gas():
    scene = {
        "sinew": 1,
        "bodies": {"b": {
            "type": "fem", "fixed": [{"plane": {"point": "0 0 0 mm", "normal": "0 0 1"}}],
            "material": {"model": "neo-hookean", "young_modulus": 1e5, "poisson_ratio": 0.45},
            "mesh": {"shape": "chambered-cylinder", "radius": "12.5 mm", "height": "65 mm",
                     "chamber_radius": "3.7 mm", "chamber_offset": "7.3 mm", "chamber_bottom": "2.5 mm",
                     "chamber_top": "62.5 mm", "element_size": "6 mm"},
        }},
        "actuators": {
            "air": {"type": "chamber", "body": "b", "surface": {"inside": "7.3 0 30 mm"}, "gas": {"dead_volume": 2e-6}},
            "east": {"type": "cable", "body": "b", "points": [[0.0, 0.011, 0], [0.0, 0.011, 0.03], [0.0, 0.011, 0.06]]},
            "west": {"type": "cable", "body": "b", "points": [[0.0, -0.011, 0], [0.0, -0.011, 0.03], [0.0, -0.011, 0.06]]},
        },
        "effectors": {"top": {"body": "b", "point": [0, 0, 0.065], "directions": [[0, 1, 0]]}},
    }
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"top": [0, 0.004, 0.065]}, actuators=["east", "west"])
    ik.step(80)
    assert ik.status == "on-target" and ik.error < 5e-5


def test_nothing_asked_lets_go():
    sim = sinew.load(block())
    ik = sinew.InverseController(sim, targets={"tip": TARGET}, weights={"tip": 0.0})
    ik.step(20)
    assert ik.status == "on-target" and ik.predicted_error == 0.0
    assert ik.efforts == pytest.approx(np.zeros(4), abs=1e-9)
    ik.detach()
    ik = sinew.InverseController(sim, targets={"tip": TARGET}, weights={"tip": [1.0, 0.0, 0.0]})
    ik.step(100)
    assert sim.effector("tip").position[0] == pytest.approx(TARGET[0], abs=5e-5)
    assert ik.status == "on-target" and ik.error < 5e-5  # directions without weight do not count as error


def test_conflicts_name_actuators_and_limits():
    tight = {"tension": {"min": 3.0, "max": 4.0}, "displacement": {"min": -1e-5, "max": 1e-5}}
    scene = block()
    scene["actuators"]["east"]["limits"] = tight
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": [0.01, 0.01, 0.099]})
    assert ik.step() == "limits-conflict"
    assert "displacement of 'east' leaves -1e-05..1e-05 m by" in ik.conflict
    assert "tension of 'east' is at its limit, 3 N" in ik.conflict


def test_status_before_the_first_step_and_after_a_reset():
    sim = sinew.load(block())
    ik = sinew.InverseController(sim, targets={"tip": TARGET})
    assert ik.status == "not-started" and np.isnan(ik.predicted_error)
    assert ik.error == pytest.approx(np.linalg.norm(np.subtract(TARGET, [0.01, 0.01, 0.1])))
    ik.step()
    assert ik.status != "not-started" and ik.predicted_error >= 0.0
    sim.reset()
    assert ik.status == "not-started"


def test_targets_in_millimetres_are_suspicious():
    sim = sinew.load(block())
    with pytest.raises(sinew.Error) as caught:
        sinew.InverseController(sim, targets={"tip": [0, 0, 180]})
    assert caught.value.kind == "suspicious-unit"
    assert "179.9 m from the effector" in str(caught.value) and "0.18 for 180 mm" in caught.value.remedy
    ik = sinew.InverseController(sim, targets={"tip": TARGET})
    for far in ([0, 0, 180], sinew.Circle([0, 0, 180], 30.0, period=2.0),
                sinew.Polyline([[0, 0, 0.1], [30, 0, 100]], period=1.0)):
        with pytest.raises(sinew.Error) as caught:
            ik.targets["tip"] = far
        assert caught.value.kind == "suspicious-unit"
    assert ik.targets["tip"] == pytest.approx(TARGET)
    ik.targets["tip"] = [0, 0, 1.0]


def test_what_rests_is_named_so():
    sim = sinew.load(block())
    ik = sinew.InverseController(sim, targets={"tip": [0.08, 0.03, 0.09]})
    seen = {ik.step() for _ in range(400)}
    assert "moving" in seen and ik.status == "out-of-reach"
    # A single force without limits and a target beside its line: only the direction of the force prevents the motion.
    scene = block()
    scene["actuators"] = {"push": {"type": "force", "body": "b", "point": [0.01, 0.01, 0.1],
                                   "direction": [1, 0, 0]}}
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": [0.012, 0.02, 0.1]})
    ik.step(300)
    assert ik.status == "local-optimum" and ik.error > 0.009
