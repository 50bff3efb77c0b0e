"""Notices about numbers whose unit was probably forgotten: stiffnesses, files, and what a script sets."""

import warnings

import pytest
import sinew


def finger(**more):
    return {"sinew": 1, "time_step": 0.01,
            "bodies": {"finger": {"type": "fem", "element": "hex8", "density": 1000.0, "fixed": {"set": "bottom"},
                                  "mesh": {"shape": "hollow-cylinder", "inner_radius": 0.005, "outer_radius": 0.008, "height": 0.03, "element_size": 0.005},
                                  "material": {"model": "neo-hookean", "young_modulus": 1e6, "poisson_ratio": 0.45}}},
            "actuators": {"air": {"type": "chamber", "body": "finger", "surface": {"set": "inner"}, "cap": True}}, **more}


def spring(stiffness):
    return finger(actuators={"s": {"type": "spring", "body": "finger", "points": [[0.007, 0, 0.0], [0.007, 0, 0.03]], "stiffness": stiffness}})


def arm(stiffness):
    return {"sinew": 1, "bodies": {"a": {"type": "pcc", "segments": [{"length": 0.03, "mass": 0.01, "stiffness": 0.02, "bending": "spatial",
                                                                   "axial_stiffness": stiffness}]}}}


def told(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        return [one for one in sinew.load(scene).notices if one.kind == "suspicious-unit"]


@pytest.mark.parametrize(("scene", "item"), [(spring, "actuators.s.stiffness"), (arm, "bodies.a.segments")])
def test_stiffnesses_far_from_those_of_robots_are_named(scene, item):
    for bare, words in ((0.2, "0.2 without a unit is 200 mN/m, which is little for a stiffness; write its unit, such as 0.2 N/mm"),
                        (2e9, "which is much for a stiffness")):
        (notice,) = told(scene(bare))
        assert notice.level == "warning" and item in str(notice) and words in str(notice), str(notice)
    for fine in (200.0, 1.0, "0.2 N/m", "0.2 N/mm", "2e9 N/m"):
        assert told(scene(fine)) == []


def said(act):
    """The warnings of an act."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", sinew.SinewWarning)
        act()
    return [str(one.message) for one in caught if "without a unit" in str(one.message)]


@pytest.mark.parametrize("how", ["run", "step", "static"])
def test_pressures_that_a_script_sets_are_judged_by_the_largest(how):
    """Before a static solution, in a run and after ten steps at once, each attribute once."""
    scene = finger(loads={"wind": {"type": "pressure", "body": "finger", "surface": {"set": "outer"}, "pressure": "5 kPa"}})

    def go(sim):
        return {"run": lambda: sim.run(duration=0.1), "step": lambda: sim.step(10), "static": sim.solve_static}[how]

    def loaded():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", sinew.SinewWarning)
            return sinew.load(scene)

    for value in (30, -20, sinew.Ramp(0.0, 30.0, duration=0.1), [[0.0, 0.0], [0.05, 30.0]]):
        sim = loaded()
        sim.actuator("air").pressure = value
        (message,) = said(go(sim))
        assert "actuator('air').pressure" in message and "little for a pressure" in message and "kPa" in message
        assert said(go(sim)) == []
    sim = loaded()
    sim.load("wind").pressure = 5
    (message,) = said(go(sim))
    assert "load('wind').pressure" in message
    for value in (0, 30e3, sinew.Ramp(0.0, 2e3, duration=0.1)):
        sim = loaded()
        sim.actuator("air").pressure = value
        sim.load("wind").pressure = 2e3
        assert said(go(sim)) == []
    # A script that goes up in small steps meant its first ones.
    sim = loaded()
    for pressure in range(0, 2000, 100):
        sim.actuator("air").pressure = pressure
        assert said(sim.step) == []
    assert said(go(sim)) == []
