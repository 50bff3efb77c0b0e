"""Chambers and springs from Python."""

import numpy as np
import pytest

import sinew

P_AMBIENT = 101325.0


def robot(**chamber):
    return sinew.load({
        "sinew": 1,
        "time_step": 0.01,
        "bodies": {"tube": {
            "type": "fem",
            "mesh": {"shape": "hollow-cylinder", "inner_radius": 0.01, "outer_radius": 0.015, "height": 0.03,
                     "element_size": 0.004},
            "element": "hex8", "material": "ecoflex-00-30",
            "fixed": [{"set": "bottom"}, {"set": "top"}]}},
        "actuators": {"air": {"type": "chamber", "body": "tube", "surface": {"set": "inner"}, "cap": True,
                              **chamber}},
        "effectors": {"wall": {"body": "tube", "point": [0.015, 0, 0.015], "outside": "nearest"}},
    })


def test_pressure_and_volume_are_two_sides_of_one_row():
    sim = robot()
    air = sim.actuator("air")
    rest = air.volume
    assert rest == pytest.approx(np.pi * 0.01**2 * 0.03, rel=1e-12)  # a polygon with the area of the circle
    air.pressure = 1500.0
    sim.solve_static()
    assert air.pressure == 1500.0 and air.volume_growth > 0.02 * rest
    assert air.volume == pytest.approx(rest + air.volume_growth)
    growth = air.volume_growth
    air.pressure = 0.0
    sim.solve_static()
    assert abs(air.volume_growth) < 1e-9 * rest
    air.volume_growth = growth
    sim.solve_static()
    assert air.pressure == pytest.approx(1500.0, rel=1e-6)


def test_gas_keeps_pressure_times_volume():
    sim = robot(gas={"dead_volume": 2e-6})
    air = sim.actuator("air")
    rest = air.volume + 2e-6
    air.gas = 0.5 * rest
    sim.solve_static()
    assert air.command == ("gas", 0.5 * rest)
    assert air.gas == pytest.approx(0.5 * rest, rel=1e-6)
    assert (air.pressure + P_AMBIENT) * (air.volume + 2e-6) == pytest.approx(P_AMBIENT * 1.5 * rest, rel=1e-7)


def test_inverse_control_finds_the_pressure():
    sim = robot()
    ik = sinew.InverseController(sim, targets={"wall": [0.0165, 0, 0.015]})
    for _ in range(60):
        ik.step()
    reached = sim.effector("wall").position
    assert reached[0] == pytest.approx(0.0165, abs=5e-5)
    ik.detach()
    assert sim.actuator("air").command[0] == "pressure"


def test_what_an_actuator_has_not_is_said():
    sim = robot()
    air = sim.actuator("air")
    for name in ("tension", "displacement", "gas", "liquid", "power", "phase", "temperature", "length"):
        with pytest.raises(sinew.Error) as caught:
            getattr(air, name)
        assert caught.value.kind == "wrong-actuator-type"
        assert ".pressure and .volume_growth" in caught.value.remedy
    with pytest.raises(sinew.Error) as caught:
        air.gas = 1e-6
    assert caught.value.kind == "wrong-actuator-type"


def test_open_chambers_need_a_cap():
    with pytest.raises(sinew.Error) as caught:
        robot(cap=False)
    assert caught.value.kind == "surface-not-closed" and "cap: true" in caught.value.remedy


@pytest.mark.parametrize("chamber,kind", [
    ({"command": {"gas": 1e-6}}, "conflicting-keys"),
    ({"gas": {}, "liquid": {}}, "conflicting-keys"),
    ({"surface": {"inside": [0, 0, 0.015]}}, "empty-region"),
    ({"surface": {"set": "inner", "inside": [0, 0, 0]}}, "conflicting-keys"),
    ({"surface": {}}, "missing-key"),
    ({"gas": {"polytropic_exponent": 0.9}}, "out-of-range"),
    ({"gas": {"supply": {}}}, "missing-key"),
    ({"command": {"pressure": "20 N"}}, "wrong-dimension"),
    ({"limits": {"pressure": {"min": 2.0, "max": 1.0}}}, "contradictory-limits"),
])
def test_broken_chambers(chamber, kind):
    with pytest.raises(sinew.Error) as caught:
        robot(**chamber)
    assert caught.value.kind == kind


def test_a_spring_follows_its_stretch_and_its_phase():
    tree = {
        "sinew": 1,
        "bodies": {"beam": {
            "type": "fem", "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02},
            "material": {"young_modulus": 200e3, "poisson_ratio": 0.4}, "fixed": {"set": "x_min"}}},
        "actuators": {
            "band": {"type": "spring", "body": "beam", "points": [[0.1, 0.01, 0.05], [0.1, 0.01, 0.02]],
                     "pull": "world", "stiffness": 20.0, "free_length": 0.02},
            "wire": {"type": "spring", "body": "beam", "points": [[0.02, 0.01, 0.0], [0.08, 0.01, 0.0]],
                     "shape_memory": {"wire_diameter": 5e-4, "mean_diameter": 2.4e-3, "coils": 10},
                     "free_length": 0.05, "command": {"phase": 0.0}}},
        "effectors": {"tip": {"body": "beam", "point": [0.1, 0.01, 0.02]}},
    }
    sim = sinew.load(tree)
    sim.step(40)
    band, wire = sim.actuator("band"), sim.actuator("wire")
    assert band.type == "spring"
    assert band.tension == pytest.approx(20.0 * (band.length - 0.02), rel=1e-6)
    cold = wire.tension / (wire.length - 0.05)
    wire.phase = 1.0
    sim.step(40)
    assert wire.phase == 1.0
    assert wire.tension / (wire.length - 0.05) == pytest.approx(cold * 24.7 / 14.1, rel=1e-6)
    with pytest.raises(sinew.Error) as caught:
        band.displacement = 0.01
    assert caught.value.kind == "wrong-actuator-type"
    with pytest.raises(sinew.Error) as caught:
        sinew.InverseController(sim, targets={"tip": [0.1, 0.01, 0.03]}, actuators=["band"])
    assert caught.value.kind == "wrong-actuator-type"
