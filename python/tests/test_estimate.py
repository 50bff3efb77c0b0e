"""Estimates of robots at rest: derivatives, optimum, covariance, observability, localisation, invalid input."""

import numpy as np
import pytest
import sinew

scipy = pytest.importorskip("scipy")
pytest.importorskip("yaml")

import scipy.optimize  # noqa: E402
import scipy.stats  # noqa: E402
from sinew import estimate  # noqa: E402

CABLES = ["east", "north", "west", "south"]
SIDE = {"side": ("finger", (0.010, 0.0, 0.05))}
HAND = estimate.Force("hand", "finger", (0.0, 0.0, 0.08), prior=2.0)


def sensors(noise=1e-4, tension=0.02, lengths=True):
    found = [estimate.Measured("tip.position", noise), estimate.Measured("side.position", noise)]
    found += [estimate.Measured(f"{cable}.tension", tension) for cable in CABLES]
    return found + [estimate.Measured(f"{cable}.displacement", noise) for cable in CABLES if lengths]


def made(scene, unknowns=(HAND,), measured=None, commanded="displacement", **more):
    return estimate.Twin(scene, sensors() if measured is None else measured, unknowns, markers=SIDE,
                         commanded=dict.fromkeys(CABLES, commanded), **more)


def by_differences(twin, values, step):
    columns = []
    for k in range(len(values)):
        change = step[k] * np.eye(len(values))[k]
        columns.append((twin.predict(values + change) - twin.predict(values - change)) / (2 * step[k]))
    twin.predict(values)
    return np.array(columns).T


def agrees(twin, values, step):
    twin.predict(values)
    ours, reference = twin.sensitivity(values), by_differences(twin, values, step)
    # The column of a slack cable is zero; its differences only show the tolerance of the equilibrium.
    size = np.maximum(np.abs(reference).max(axis=0), 1e-6 * np.abs(reference).max())
    assert np.abs((ours - reference) / size).max() < 1e-5
    return ours


PULL = np.array([0.004, 0.0, 0.0, 0.002])


def test_sensitivity_with_held_cables_is_that_of_differences(scene):
    twin = made(scene)
    slope = agrees(twin, np.concatenate([[0.3, -0.2, 0.1], PULL]), np.concatenate([np.full(3, 1e-3), np.full(4, 1e-6)]))
    slack = [c for c in CABLES if twin.sim.actuator(c).slack]
    assert 0 < len(slack) < 4  # both taut and slack cables occur
    assert all((slope[:, twin.inputs.index(f"{c}.motion")] == 0.0).all() for c in slack)


def test_sensitivity_with_given_tensions_is_that_of_differences(scene):
    measured = [m for m in sensors() if m.name != "west.tension"]
    twin = made(scene, (HAND, estimate.Effort("west", 0.5)), measured, commanded="tension")
    assert twin.asked == 4 and len(twin.inputs) == 7
    values = np.array([0.3, -0.2, 0.1, 0.7, 1.0, 0.5, 0.2])
    agrees(twin, values, np.full(7, 1e-3))


def test_sensitivity_to_forces_on_nodes_and_of_rotations(scene):
    tree = {"effectors.tip": {"body": "finger", "orientation": ["0 0 80 mm", "9 0 80 mm", "0 9 80 mm"]}}
    touch = estimate.NodalForce("touch", "finger", [20, 30, 31], [0.5, 0.25, 0.25])
    measured = [estimate.Measured("tip.rotation", 1e-3), estimate.Measured("side.position", 1e-4)]
    twin = made(scene, (touch,), measured, set=tree)
    agrees(twin, np.array([0.6, -0.9, 0.4]), np.full(3, 1e-3))
    assert np.linalg.norm(twin.sim.effector("tip").value) > 0.03


@pytest.mark.parametrize("friction", [0.0, 0.8])
def test_sensitivity_beside_a_contact(scene, friction):
    import yaml

    tree = yaml.safe_load(sinew.load(scene).to_yaml())
    tree["contacts"] = {"wall": {"body": "finger", "points": ["10 0 80 mm"], "friction": friction,
                                 "surface": {"plane": {"point": [0.0115, 0, 0], "normal": [-1, 0, 0]}}}}
    twin = made(tree, measured=sensors(lengths=False))
    values = np.array([1.2, 0.0, 0.1])
    twin.predict(values)
    assert twin.sim.contact("wall").normal_force > 0.05
    agrees(twin, values, np.full(3, 1e-4))


def readings_of(twin, values, generator=None):
    answer = twin.predict(values)
    noise = 0.0 if generator is None else twin.noise * generator.standard_normal(len(answer))
    readings = dict(zip(twin.outputs, answer + noise))
    for cable, pull in zip(CABLES, values[twin.asked:]):
        readings[f"{cable}.displacement"] = pull + (0.0 if generator is None else 1e-4 * generator.standard_normal())
    return readings


def test_large_push_is_found_with_its_shape(scene):
    twin = made(scene)
    still = twin.predict(np.concatenate([np.zeros(3), PULL]))
    truth = np.concatenate([[1.5, -1.0, 0.2], PULL])
    readings = readings_of(twin, truth)
    shape = np.array(twin.sim.body("finger").positions)
    assert np.linalg.norm(twin.read()[:3] - still[:3]) > 5e-3
    found = estimate.solve(twin, readings)
    assert found.status == "converged"
    # The prior of 2 N has little weight compared with the readings.
    np.testing.assert_allclose(found.unknowns[:3], truth[:3], atol=3e-3)
    assert np.abs(found.positions["finger"] - shape).max() < 2e-5
    np.testing.assert_array_equal(found.positions["finger"], twin.sim.body("finger").positions)


def test_optimum_is_that_of_scipy(scene):
    twin = made(scene)
    truth = np.concatenate([[0.8, -0.5, 0.3], PULL])
    readings = readings_of(twin, truth, np.random.default_rng(1))
    found = estimate.solve(twin, readings, tolerance=1e-6)
    numbers, commands = twin.split(readings)
    mean, std = twin.prior(commands)

    def residual(v):
        return np.concatenate([(numbers - twin.predict(mean + std * v)) / twin.noise, v])
    reference = scipy.optimize.least_squares(residual, (truth - mean) / std, diff_step=1e-6, xtol=1e-14, ftol=1e-14)
    # Within 1e-3 standard deviations of the optimum, the cost differs by at most 1e-6.
    np.testing.assert_allclose(2 * reference.cost, found.chi_squared, atol=1e-6)
    deviations = np.sqrt(np.diag(found.covariance))
    assert np.abs((mean + std * reference.x - found.unknowns) / deviations).max() < 1e-3
    # SciPy's steps are relative: for unknowns near zero, the differences are lost in rounding.
    way = 1e-2 * np.eye(len(mean))
    jacobian = np.column_stack([(residual(reference.x + one) - residual(reference.x - one)) / 2e-2 for one in way])
    information = np.linalg.inv(jacobian.T @ jacobian)
    apart = found.covariance - information * np.outer(std, std)
    assert np.abs(apart / np.outer(deviations, deviations)).max() < 1e-3


def test_errors_are_as_the_covariance_says(scene):
    twin = made(scene)
    generator, distance, held = np.random.default_rng(5), 0.0, 0
    count = 60
    for _ in range(count):
        truth = np.concatenate([generator.normal(0.0, 0.5, 3), PULL])
        found = estimate.solve(twin, readings_of(twin, truth, generator))
        error = found.unknowns[:3] - truth[:3]
        distance += error @ np.linalg.solve(found.covariance[:3, :3], error)
        held += found.holds(truth[:3])
    low, high = scipy.stats.chi2.ppf([0.005, 0.995], 3 * count)
    assert low < distance < high
    low, high = scipy.stats.binom.ppf([0.005, 0.995], count, 0.9)
    assert low <= held <= high


def test_shape_deviation_is_that_of_sigma_points(scene):
    small = estimate.Force("hand", "finger", (0, 0, 0.08), prior=0.005)  # small, so the response is linear
    twin = made(scene, (small,), [estimate.Measured("tip.z", 1.0)], commanded="tension")  # at rest, cables are about to become taut
    found = estimate.solve(twin, {"tip.z": 0.08})
    ours = estimate.shape_std(twin, found, "finger")
    shapes = []
    for axis in np.sqrt(3.0) * 0.005 * np.concatenate([np.eye(3), -np.eye(3)]):  # sigma points with the covariance of the prior
        twin.predict(axis)
        shapes.append(np.array(twin.sim.body("finger").positions))
    sampled = np.std(shapes, axis=0)
    moving = sampled > 0.01 * sampled.max()
    np.testing.assert_allclose(ours[moving], sampled[moving], rtol=1e-2)


def test_what_is_not_observable_is_named_and_refused(scene):
    twin = made(scene, measured=[estimate.Measured("tip.x", 1e-4)])
    seen = estimate.solve(twin, {"tip.x": 0.001}).observability
    assert seen.singular_values[0] > 10.0 and (seen.singular_values[1:] < 1.0).all()
    assert len(seen.unobservable) == 2 and "hand.y" in "".join(seen.unobservable) and "hand.z" in "".join(seen.unobservable)
    with pytest.raises(sinew.Error, match="hand.y") as caught:
        estimate.solve(twin, {"tip.x": 0.001}, unobservable="refuse")
    assert caught.value.kind == "unobservable"


def test_prior_decides_where_nothing_is_seen(scene):
    twin = made(scene, measured=[estimate.Measured("tip.x", 1e-4)])
    found = estimate.solve(twin, {"tip.x": twin.predict(np.zeros(3))[0]})
    assert 1.8 < found.std["hand.y"] <= 2.0 and 1.8 < found.std["hand.z"] <= 2.0
    assert found.values["hand.y"] == pytest.approx(0.0, abs=1e-6)


def test_singular_values_are_reductions_of_the_prior(scene):
    twin = made(scene, measured=sensors(lengths=False))
    found = estimate.solve(twin, readings_of(twin, np.array([0.3, 0.1, 0.2])))
    prior = np.diag([4.0, 4.0, 4.0])
    left = scipy.linalg.eigh(found.covariance, prior, eigvals_only=True)
    np.testing.assert_allclose(np.sort(left), np.sort(1.0 / (1.0 + found.observability.singular_values**2)), rtol=1e-6)


def test_modulus_from_readings(scene):
    modulus = estimate.Parameter("bodies.finger.material.young_modulus", 300e3, 0.5)
    measured = [estimate.Measured("tip.position", 1e-5), estimate.Measured("side.position", 1e-5)]
    plant = estimate.Twin(scene, measured, [HAND], markers=SIDE)
    twin = estimate.Twin(scene, measured, [modulus], markers=SIDE)
    for model in (plant, twin):
        model.sim.actuator("push").force = 0.5
    found = estimate.solve(twin, dict(zip(plant.outputs, plant.predict(np.zeros(3)))))
    assert found.values[modulus.path] == pytest.approx(400e3, rel=1e-3)
    assert twin.sim.actuator("push").force == 0.5  # a rebuilt model keeps the commands


def test_two_forces_and_a_tension_at_once(scene):
    second = estimate.Force("knock", "finger", (0.01, 0.0, 0.04), prior=2.0, directions=[[-1, 0, 0]])
    measured = [m for m in sensors(1e-6, 1e-4) if m.name != "west.tension"]  # so accurate that the prior does not matter
    twin = made(scene, (HAND, second, estimate.Effort("west", 3.0)), measured, commanded="tension")
    truth = np.array([0.2, -0.3, 0.1, 0.9, 1.4, 0.5, 0.5, 0.5])
    readings = dict(zip(twin.outputs, twin.predict(truth)))
    readings.update({f"{cable}.tension": 0.5 for cable in ("east", "north", "south")})
    found = estimate.solve(twin, readings)
    np.testing.assert_allclose(found.unknowns, truth, atol=1e-4)
    assert max(found.std.values()) < 0.01


def test_friction_of_a_wall_from_a_tip_that_slides(scene):
    import yaml

    tree = yaml.safe_load(sinew.load(scene).to_yaml())
    tree["actuators"]["across"] = {**tree["actuators"]["push"], "direction": [0, 1, 0]}
    tree["contacts"] = {"wall": {"body": "finger", "points": ["10 0 80 mm"], "friction": 0.3,
                                 "surface": {"plane": {"point": [0.0105, 0, 0], "normal": [-1, 0, 0]}}}}
    measured = [estimate.Measured("tip.position", 1e-6)]
    plant = estimate.Twin(tree, measured, [estimate.Parameter("contacts.wall.friction", 0.3)])
    twin = estimate.Twin(tree, measured, [estimate.Parameter("contacts.wall.friction", 0.2, 0.5)])
    for model in (plant, twin):
        model.sim.actuator("push").force, model.sim.actuator("across").force = 1.5, 1.5
    readings = dict(zip(plant.outputs, plant.predict([0.0])))
    assert plant.sim.contact("wall").states == ["slip"]
    found = estimate.solve(twin, readings)
    assert found.values["contacts.wall.friction"] == pytest.approx(0.3, rel=1e-2)


def test_unknown_pressure_and_a_reading_of_the_volume():
    tree = {"sinew": 1, "bodies": {"tube": {
        "type": "fem",
        "mesh": {"shape": "hollow-cylinder", "inner_radius": 0.01, "outer_radius": 0.015, "height": 0.03, "element_size": 0.004},
        "element": "hex8", "material": "ecoflex-00-30", "fixed": [{"set": "bottom"}, {"set": "top"}]}},
        "actuators": {"air": {"type": "chamber", "body": "tube", "surface": {"set": "inner"}, "cap": True,
                              "command": {"pressure": 0}}},
        "effectors": {"wall": {"body": "tube", "point": [0.015, 0, 0.015], "outside": "nearest"}}}
    measured = [estimate.Measured("wall.position", 1e-5), estimate.Measured("air.volume_growth", 1e-8)]
    twin = estimate.Twin(tree, measured, [estimate.Effort("air", 2000.0)])
    assert twin.is_linear_in_rows
    agrees(twin, np.array([1200.0]), np.array([1.0]))
    found = estimate.solve(twin, dict(zip(twin.outputs, twin.predict([1200.0]))))
    assert found.values["air.effort"] == pytest.approx(1200.0, abs=1.0)


def test_arm_of_constant_curvature_with_a_torque_that_is_not_known():
    tree = {"sinew": 1, "gravity": "0 0 -9.81 m/s^2", "bodies": {"arm": {
        "type": "pcc", "segments": [{"length": 0.14, "mass": 0.1, "stiffness": 0.1, "damping": 4e-3},
                                    {"length": 0.14, "mass": 0.1, "stiffness": 0.1, "damping": 4e-3}]}},
        "actuators": {"first": {"type": "torque", "body": "arm", "segment": 0, "command": {"torque": 0}}},
        "effectors": {"tip": {"body": "arm", "point": [0, 0, -0.28], "outside": "nearest"}}}
    twin = estimate.Twin(tree, [estimate.Measured("tip.position", 1e-4)],
                         [estimate.Effort("first", 0.1), estimate.Force("hand", "arm", (0, 0, -0.28), prior=0.5)])
    assert twin.is_linear_in_rows
    truth = np.array([0.08, 0.05, 0.0, 0.02])
    agrees(twin, truth, np.full(4, 1e-3))
    found = estimate.solve(twin, dict(zip(twin.outputs, twin.predict(truth))))
    assert any("1.00 hand.y" in text for text in found.observability.unobservable)  # normal to the bending plane of the arm
    assert max(abs(r) for r in found.residuals.values()) < 0.5


def test_lost_sensors_leave_the_others(scene):
    twin = made(scene)
    truth = np.concatenate([[0.4, -0.3, 0.1], PULL])
    readings = readings_of(twin, truth)
    whole = estimate.solve(twin, readings)
    readings.update({"tip.x": np.nan, "tip.y": np.nan, "tip.z": np.nan})
    found = estimate.solve(twin, readings)
    assert set(found.residuals) == set(whole.residuals) - {"tip.x", "tip.y", "tip.z"}
    assert found.std["hand.x"] > whole.std["hand.x"]
    np.testing.assert_allclose(found.unknowns[:2], truth[:2], atol=0.02)
    with pytest.raises(sinew.Error) as caught:
        estimate.solve(twin, {"tip.x": np.nan})
    assert caught.value.kind == "no-sensors"


def test_same_bits_with_other_threads(scene):
    found = []
    for threads in (1, 2):
        twin = made(scene, threads=threads)
        found.append(estimate.solve(twin, readings_of(twin, np.concatenate([[0.4, -0.3, 0.1], PULL]), np.random.default_rng(0))))
    np.testing.assert_array_equal(found[0].unknowns, found[1].unknowns)
    np.testing.assert_array_equal(found[0].covariance, found[1].covariance)


# Localisation

def test_patches_cover_the_free_surface_once(scene):
    sim = sinew.load(scene)
    areas = estimate.patches(sim, "finger", 12)
    triangles = np.concatenate([a.triangles for a in areas])
    assert len(np.unique(np.sort(triangles, axis=1), axis=0)) == len(triangles)
    rest, fixed = np.array(sim.body("finger").rest_positions), np.array(sim.body("finger").fixed)
    assert not fixed[triangles].any()
    corners = rest[triangles]
    whole = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    assert sum(a.area for a in areas) == pytest.approx(whole)
    for k, area in enumerate(areas):
        assert area.weights.sum() == pytest.approx(1.0) and area.shares.sum() == pytest.approx(1.0)
        assert area.area < 3.0 * whole / len(areas)
        assert all(k in areas[other].neighbours for other in area.neighbours)
    outwards = [a.normal[:2] @ a.centre[:2] for a in areas if abs(a.normal[2]) < 0.5]
    assert min(outwards) > 0.0
    again = estimate.patches(sinew.load(scene), "finger", 12)
    assert all((a.triangles == b.triangles).all() for a, b in zip(areas, again))


def test_place_of_a_push_is_found(scene):
    twin = made(scene, ())
    areas = estimate.patches(twin.sim, "finger", 12)
    body = twin.sim.body("finger")
    right = 0
    for k in range(len(areas)):
        area = areas[k]
        forces = np.zeros_like(np.asarray(body.external_forces))
        forces[area.triangles[len(area.triangles) // 2]] = -0.6 * area.normal / 3.0
        body.external_forces = forces
        twin.set(np.zeros(4))
        twin.settle()
        readings = {**dict(zip(twin.outputs, twin.read())), **{f"{c}.displacement": 0.0 for c in CABLES}}
        body.external_forces = np.zeros_like(forces)
        found = estimate.locate(twin, readings, areas)
        assert found.probability.sum() == pytest.approx(1.0)
        if found.patch == k:
            right += 1
            assert found.force @ -area.normal > 0.8 * np.linalg.norm(found.force)
        else:
            assert found.probability[k] > 1e-3 or found.status != "found", k
    assert right >= 9


def test_no_force_is_said(scene):
    twin = made(scene, ())
    areas = estimate.patches(twin.sim, "finger", 12)
    found = estimate.locate(twin, readings_of(twin, np.zeros(4), np.random.default_rng(2)), areas)
    assert found.status == "no-force"


def test_places_that_sensors_do_not_tell_are_refused(scene):
    twin = made(scene, (), [estimate.Measured("tip.position", 1.0)])  # a marker with a standard deviation of 1 m
    areas = estimate.patches(twin.sim, "finger", 12)
    found = estimate.locate(twin, dict(zip(("tip.x", "tip.y", "tip.z"), twin.predict(np.zeros(0)) + [0.5, 0.0, 0.0])), areas)
    assert found.status == "unobservable"
    np.testing.assert_allclose(found.probability, [a.area / sum(b.area for b in areas) for a in areas], rtol=0.3)


def test_readings_that_no_place_explains_are_refused(scene):
    twin = made(scene, ())
    areas = estimate.patches(twin.sim, "finger", 12)
    readings = readings_of(twin, np.zeros(4))
    readings["tip.x"] += 3e-3
    readings["side.x"] -= 3e-3
    assert estimate.locate(twin, readings, areas).status == "unexplained"


# Invalid input

@pytest.mark.parametrize("sensor", ["nose.position", "tip.rotation", "tip.heat"])
def test_sensors_that_do_not_exist(scene, sensor):
    with pytest.raises(sinew.Error) as caught:
        made(scene, measured=[estimate.Measured(sensor, 1e-3)])
    assert caught.value.kind == "unknown-name" and caught.value.remedy


def test_wrong_numbers_are_refused(scene):
    for make, kind in [
        (lambda: estimate.Measured("tip.x", 0.0), "out-of-range"),
        (lambda: estimate.Measured("tip.x", float("nan")), "out-of-range"),
        (lambda: estimate.Measured("tip.x", 1.0, rate=-1.0), "out-of-range"),
        (lambda: estimate.Measured("tip.x", 1.0, delay=-1.0), "out-of-range"),
        (lambda: made(scene, (estimate.Force("hand", "hand", (0, 0, 0)),)), "unknown-name"),
        (lambda: made(scene, (estimate.Effort("east", 1.0),)), "bad-argument"),
        (lambda: made(scene, (HAND, HAND)), "duplicate-name"),
        (lambda: made(scene, measured=[estimate.Measured("east.displacement", 1e-4)]), "no-sensors"),
        (lambda: estimate.Twin(scene, sensors(), [HAND], markers=SIDE, commanded={"up": "tension"}), "unknown-name"),
        (lambda: estimate.solve(made(scene), {"tip.position": [1.0, 2.0]}), "wrong-shape"),
        (lambda: estimate.solve(made(scene), {"nose": 1.0}), "unknown-name"),
        (lambda: estimate.patches(sinew.load(scene), "finger", 1), "out-of-range"),
    ]:
        with pytest.raises(sinew.Error) as caught:
            make()
        assert caught.value.kind == kind
        assert str(caught.value.place)
