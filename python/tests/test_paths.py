"""Paths of equilibria: columns that buckle, with any first step; chambers beyond their limit point."""

import numpy as np
import pytest

import sinew

WIDTH, HEIGHT, MODULUS = 0.01, 0.2, 1e6
EULER = np.pi**2 * MODULUS * WIDTH**4 / 12 / (4 * HEIGHT**2)


def column(load, side=0.0, *, modulus=MODULUS, ratio=0.0, element="hex8", **more):
    """Clamped below, pressed by a dead load on its upper end."""
    loads = {"press": {"type": "traction", "body": "b", "surface": {"set": "z_max"}, "traction": [0, 0, -load / WIDTH**2]}}
    if side:
        loads["push"] = {"type": "traction", "body": "b", "surface": {"set": "z_max"}, "traction": [side / WIDTH**2, 0, 0]}
    return sinew.load({"sinew": 1, "bodies": {"b": {
        "type": "fem", "mesh": {"shape": "block", "length": WIDTH, "width": WIDTH, "height": HEIGHT, "element_size": 0.005},
        "element": element, "material": {"model": "neo-hookean", "young_modulus": modulus, "poisson_ratio": ratio},
        "fixed": [{"set": "z_min"}]}}, "loads": loads,
        "effectors": {"tip": {"body": "b", "point": [WIDTH / 2, WIDTH / 2, HEIGHT]}}, **more})


def unstable(load, **more):
    return column(load, **more).solve_static(stability="any").negative_pivots


def critical_load(low, high, **more):
    for _ in range(9):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle, **more) else (middle, high)
    return 0.5 * (low + high)


def check_loads(path):
    fractions = path["load_fraction"]
    assert np.abs(np.diff(fractions, prepend=0.0)).max() <= 0.1 + 1e-12
    assert 1.0 <= fractions[-1] <= 1.1 and fractions.max() <= 1.1
    assert path["status"] == "full-load" and path["reason"] == ""


@pytest.mark.parametrize("first_step", [None, 1e-4, 0.1])
def test_a_column_with_a_side_load_bends_and_stays_stable(first_step):
    sim = column(1.3 * EULER, 1e-4 * EULER)
    path = sim.follow_path(**({} if first_step is None else {"first_step": first_step}))
    check_loads(path)
    assert not path["negative_pivots"].any() and set(path["event"]) == {"none"} and np.isnan(path["limit_load"])
    other = column(path["load_fraction"][-1] * 1.3 * EULER, 1e-4 * path["load_fraction"][-1] * EULER)
    other.solve_static()
    np.testing.assert_allclose(path["tip"][-1], other.effector("tip").position, atol=1e-4 * HEIGHT)


@pytest.mark.parametrize("modulus, first_step", [(1e6, None), (3e4, None), (1e6, 0.1)])
def test_a_straight_column_bifurcates_and_stays_straight(modulus, first_step):
    scale = modulus / MODULUS
    critical = critical_load(0.8 * EULER * scale, 1.1 * EULER * scale, modulus=modulus)
    sim = column(1.4 * critical, modulus=modulus)
    path = sim.follow_path(**({} if first_step is None else {"first_step": first_step}))
    check_loads(path)
    (at,) = np.flatnonzero(path["event"] == "bifurcation")
    assert 1.4 * path["load_fraction"][at] == pytest.approx(1.0, abs=0.01)
    assert not path["negative_pivots"][:at].any() and (path["negative_pivots"][at:] == 2).all()
    assert np.abs(path["tip"][:, :2] - WIDTH / 2).max() < 1e-6
    assert np.isnan(path["limit_load"]) and len(path["states"]) == len(path["load_fraction"])
    tip = path["tip"][at]
    sim.restore(path["states"][at])
    np.testing.assert_array_equal(sim.effector("tip").position, tip)


def test_a_path_that_ends_early_returns_what_it_found():
    path = column(1.3 * EULER, 1e-4 * EULER).follow_path(max_points=5, states=False)
    assert path["status"] == "max-points" and "max_points" in path["reason"]
    assert len(path["load_fraction"]) == 5 and path["states"] == []


def finger(pressure, **more):
    """A hollow cylinder with an eccentric chamber; its pressure has a peak at 6.5 kPa."""
    sim = sinew.load({"sinew": 1, "bodies": {"f": {
        "type": "fem", "element": "tet10", "fixed": [{"set": "bottom"}],
        "mesh": {"shape": "chambered-cylinder", "radius": "10 mm", "height": "60 mm", "chamber_radius": "6 mm",
                 "chamber_offset": "2 mm", "chamber_bottom": "5 mm", "chamber_top": "55 mm", "element_size": "5 mm"},
        "material": {"model": "neo-hookean", "young_modulus": "60 kPa", "poisson_ratio": 0.45}}},
        "actuators": {"air": {"type": "chamber", "body": "f", "surface": {"set": "chamber"}, "command": {"pressure": pressure}}},
        **more})
    return sim


def test_a_large_pressure_is_divided_by_itself():
    """In one search as in two: 74 iterations for 17 before large loads were divided."""
    sim = finger(5e3)
    at_once = sim.solve_static()
    volume = sim.actuator("air").volume
    sim = finger(2.5e3)
    halves = sim.solve_static().iterations
    sim.actuator("air").pressure = 5e3
    halves += sim.solve_static().iterations
    assert sim.actuator("air").volume == pytest.approx(volume, rel=1e-8)
    assert at_once.iterations <= 3 * halves


@pytest.mark.parametrize("pressure", [7e3, 20e3])
def test_a_pressure_beyond_the_limit_point_is_named(pressure):
    sim = finger(pressure)
    with pytest.raises(sinew.RunError, match="chamber 'air' has no equilibrium at .* kPa.*limit point") as error:
        sim.solve_static()
    named = float(str(error.value).split("about ")[1].split(" kPa")[0])
    path = finger(pressure).follow_path(max_points=30)
    assert named == pytest.approx(1e-3 * pressure * path["limit_load"], rel=0.01)
