"""Filters: comparison with batch least squares, delays, lost sensors, full arm dynamics, finite elements with few unknowns."""

import numpy as np
import pytest
import sinew

pytest.importorskip("scipy")
pytest.importorskip("yaml")

from sinew import estimate, pcc  # noqa: E402
from test_estimate import CABLES, HAND, PULL, made, sensors  # noqa: E402

STEP = 0.02


class Cart:
    """A linear robot with position and speed, driven by white noise; two sensors with different rates."""

    names = ["place", "speed"]

    def __init__(self, delay=0.0):
        self.sensors = [estimate.Measured("place", 0.02, rate=25.0, delay=delay), estimate.Measured("speed", 0.1)]
        self.map = [np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])]

    def start(self):
        return np.array([0.0, 1.0]), np.diag([0.3, 0.5]) ** 2

    def matrix(self, step):
        return np.array([[1.0, step], [0.0, 1.0]])

    def advance(self, x, time, step):
        return self.matrix(step) @ x

    def transition(self, x, time, step):
        return self.matrix(step)

    def noise(self, step):
        return 0.2**2 * np.array([[step**3 / 3, step**2 / 2], [step**2 / 2, step]])

    def read(self, x, sensor):
        return self.map[sensor] @ x

    def sensitivity(self, x, sensor):
        return self.map[sensor]

    def save(self):
        return None

    def restore(self, kept):
        pass


def cart_readings(count=30, seed=0):
    model, generator = Cart(), np.random.default_rng(seed)
    x, readings = generator.multivariate_normal(*model.start()), []
    for k in range(1, count + 1):
        x = model.advance(x, 0.0, STEP) + generator.multivariate_normal(np.zeros(2), model.noise(STEP))
        for sensor in ([0, 1] if k % 2 == 0 else [1]):
            noise = model.sensors[sensor].std * generator.standard_normal(1)
            readings.append(estimate.Reading(k * STEP, sensor, model.read(x, sensor) + noise))
    return readings


def batch(readings, count=30):
    """Last state and its covariance by weighted least squares over all states at once."""
    model = Cart()
    mean, covariance = model.start()
    rows, right = [], []

    def add(matrix, value, spread):
        whiten = np.linalg.inv(np.linalg.cholesky(spread))
        rows.append(whiten @ matrix)
        right.append(whiten @ value)
    size = 2 * (count + 1)
    add(np.eye(2, size), mean, covariance)
    for k in range(count):
        matrix = np.zeros((2, size))
        matrix[:, 2 * k:2 * k + 2], matrix[:, 2 * k + 2:2 * k + 4] = -model.matrix(STEP), np.eye(2)
        add(matrix, np.zeros(2), model.noise(STEP))
    for reading in readings:
        k, matrix = round(reading.time / STEP), np.zeros((1, size))
        matrix[:, 2 * k:2 * k + 2] = model.map[reading.sensor]
        add(matrix, reading.values, np.array([[model.sensors[reading.sensor].std ** 2]]))
    whole = np.concatenate(rows)
    inverse = np.linalg.inv(whole.T @ whole)
    return (inverse @ whole.T @ np.concatenate(right))[-2:], inverse[-2:, -2:]


KINDS = {"extended": estimate.ExtendedKalman, "unscented": estimate.UnscentedKalman,
         "horizon": lambda model, step, **more: estimate.MovingHorizon(model, step, horizon=4, **more)}


@pytest.mark.parametrize("kind", KINDS)
def test_linear_filters_are_batch_least_squares(kind):
    readings = cart_readings()
    run = KINDS[kind](Cart(), STEP)
    for k in range(1, 31):
        run.update(k * STEP, [r for r in readings if abs(r.time - k * STEP) < 1e-9])
    mean, covariance = batch(readings)
    np.testing.assert_allclose(run.mean, mean, rtol=1e-8)
    np.testing.assert_allclose(run.covariance, covariance, rtol=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_delays_change_nothing_once_all_has_arrived(kind):
    readings = cart_readings()
    late, delay = KINDS[kind](Cart(delay=0.06), STEP), 0.06
    for k in range(1, 34):
        time = k * STEP
        arrived = [r for r in readings if abs(r.time + (delay if r.sensor == 0 else 0.0) - time) < 1e-9]
        late.update(time if k <= 30 else 30 * STEP, arrived) if k <= 30 else late.update(late.time, arrived)
    mean, covariance = batch(readings)
    np.testing.assert_allclose(late.mean, mean, rtol=1e-8)
    np.testing.assert_allclose(late.covariance, covariance, rtol=1e-8)
    assert late.dropped == 0


def test_lost_sensor_is_named_and_its_covariance_grows():
    readings = cart_readings(60)
    run = estimate.ExtendedKalman(Cart(), STEP)
    spread = []
    for k in range(1, 61):
        run.update(k * STEP, [r for r in readings if abs(r.time - k * STEP) < 1e-9 and not (r.sensor == 0 and k > 20)])
        spread.append(run.std[0])
        if k == 20:
            assert run.lost == []
    assert run.lost == ["place"]
    assert spread[-1] > 1.5 * spread[19] and (np.diff(spread[22:]) > 0.0).all()


def test_filters_refuse_what_does_not_fit():
    with pytest.raises(sinew.Error, match="faster"):
        estimate.ExtendedKalman(Cart(), 0.1)
    with pytest.raises(sinew.Error, match="memory"):
        estimate.ExtendedKalman(Cart(delay=1.0), STEP)
    run = estimate.ExtendedKalman(Cart(), STEP, memory=0.1)
    run.update(1.0)
    with pytest.raises(sinew.Error) as caught:
        run.update(0.5)
    assert caught.value.kind == "non-monotonic-time"
    with pytest.raises(sinew.Error):
        run.update(1.0, [estimate.Reading(2.0, 0, np.array([0.0]))])
    run.update(1.0, [estimate.Reading(0.2, 0, np.array([0.0]))])
    assert run.dropped == 1
    run.update(1.02, [estimate.Reading(1.02, 0, np.array([np.nan]))])
    assert run.lost == ["place", "speed"]
    with pytest.raises(sinew.Error) as caught:
        run.sensor("nose")
    assert caught.value.kind == "unknown-name"


def arm_of():
    return pcc.Arm([0.15, 0.15], [0.1, 0.08], [0.12, 0.08], 6e-3)


def arm_run(kind, push=np.array([0.08, 0.0, 0.03]), seconds=1.6):
    """Final filter, true angles, and errors over time in standard deviations."""
    arm, generator = arm_of(), np.random.default_rng(3)

    def torque(time):
        return np.array([0.06, -0.03]) * np.sin(4.0 * time)
    model = estimate.ArmModel(arm, torque, {"tip": (1, 1.0), "middle": (0, 1.0)},
                              [estimate.Measured("tip.position", 1e-3, rate=25.0, delay=0.04),
                               estimate.Measured("middle.position", 1e-3, rate=50.0)],
                              push=(1, 1.0, 0.2, 0.02), force_noise=0.3)
    run = KINDS[kind](model, 0.01)
    theta, rate = arm.equilibrium(torque(0.0)) + 0.1, np.zeros(2)
    pending, errors = [], []
    for k in range(1, round(seconds / 0.01) + 1):
        time = 0.01 * k
        for part in range(4):  # four times finer steps than the filter
            load = torque(time - 0.01 + 0.0025 * (part + 1)) + arm.jacobian(theta, 1).T @ push
            thetas, rates = arm.simulate(theta, rate, load[None], time_step=0.0025)
            theta, rate = thetas[-1], rates[-1]
        if k % 4 == 0:
            pending.append((time + 0.04, estimate.Reading(time, 0, arm.point(theta, 1) + 1e-3 * generator.standard_normal(3))))
        if k % 2 == 0:
            pending.append((time, estimate.Reading(time, 1, arm.point(theta, 0) + 1e-3 * generator.standard_normal(3))))
        run.update(time, [r for at, r in pending if at <= time + 1e-9])
        pending = [one for one in pending if one[0] > time + 1e-9]
        if k > 60:
            errors.append((run.mean[:2] - theta) / run.std[:2])
    return run, theta, np.array(errors)


@pytest.mark.parametrize("kind", KINDS)
def test_arm_in_full_with_a_push_on_its_tip(kind):
    run, theta, errors = arm_run(kind)
    np.testing.assert_allclose(run.mean[:2], theta, atol=0.02)
    assert 0.2 < np.mean(errors**2) < 4.0  # about 1 if the model is correct
    seen = run.mean[4:]
    assert abs(seen[0] - 0.08) < 4.0 * run.std[4] and run.std[4] < 0.05
    assert run.std[5] == pytest.approx(0.2, rel=0.05)  # normal to the plane of the arm: not observable


def test_arm_with_an_unknown_number(scene):
    arm = arm_of()
    theta = arm.equilibrium(np.array([0.05, -0.02]))
    model = estimate.ArmModel(lambda p: pcc.Arm([0.15, 0.15], [0.1, 0.08], np.exp(p[0]) * np.array([0.12, 0.08]), 6e-3),
                              lambda time: np.array([0.05, -0.02]), {"tip": (1, 1.0)}, [estimate.Measured("tip.position", 5e-4)],
                              unknowns={"stiffness": (0.3, 0.3, 0.0)}, force_noise=0.05)
    run = estimate.ExtendedKalman(model, 0.02)
    generator = np.random.default_rng(0)
    for k in range(1, 101):
        run.update(0.02 * k, [estimate.Reading(0.02 * k, 0, arm.point(theta, 1) + 5e-4 * generator.standard_normal(3))])
    assert abs(run.mean[-1]) < 4.0 * run.std[-1] and run.std[-1] < 0.1


@pytest.mark.parametrize("kind", ["extended", "unscented"])
def test_finger_by_few_unknowns_follows_a_force(scene, kind):
    unknown = estimate.Force("hand", "finger", (0, 0, 0.08), prior=0.5, walk=1.0)
    plant, twin = made(scene, (unknown,)), made(scene, (unknown,), sensors(lengths=False))
    twin.sim.actuator("east").displacement = PULL[0]
    model = estimate.TwinModel(twin, lambda time: dict(zip(CABLES, PULL)))
    run, generator, errors = KINDS[kind](model, 0.05), np.random.default_rng(4), []
    for k in range(1, 21):
        force = np.array([0.4 * np.sin(0.2 * k), -0.2, 0.0])
        answer = plant.predict(np.concatenate([force, PULL])) + plant.noise * generator.standard_normal(len(plant.noise))
        run.update(0.05 * k, [estimate.Reading(0.05 * k, s, answer[rows]) for s, rows in enumerate(model.rows)])
        errors.append((run.mean[:2] - force[:2]) / run.std[:2])
    assert np.mean(np.square(errors[3:])) < 4.0
    assert run.std[:2].max() < 0.05


def test_measured_commands_have_white_errors(scene):
    twin = made(scene)
    model = estimate.TwinModel(twin)
    run = estimate.ExtendedKalman(model, 0.05)
    answer = twin.predict(np.concatenate([[0.2, 0.1, 0.0], np.zeros(4)]))
    spread = []
    for k in range(1, 5):
        run.update(0.05 * k, [estimate.Reading(0.05 * k, s, answer[rows]) for s, rows in enumerate(model.rows)])
        spread.append(run.std[3:].copy())
    assert (spread[-1] > 0.5e-4).all()  # the errors of different instants are independent
    np.testing.assert_allclose(run.mean[:2], [0.2, 0.1], atol=0.01)


def test_stepped_model_costs_one_step_and_follows(scene):
    twin = made(scene, (estimate.Force("hand", "finger", (0, 0, 0.08), prior=1.0, walk=0.3),), set={"time_step": "50 ms"})
    truth = np.concatenate([[0.3, -0.1, 0.05], np.zeros(4)])
    answer = twin.predict(truth)
    first = estimate.solve(twin, dict(zip(twin.outputs, answer)))
    model = estimate.SteppedModel(twin)
    run = estimate.ExtendedKalman(model, 0.05, start=model.state_of(first), memory=0.0)
    steps = twin.sim.steps
    for k in range(1, 21):
        run.update(0.05 * k, [estimate.Reading(0.05 * k, s, answer[rows]) for s, rows in enumerate(model.rows)])
    assert twin.sim.steps - steps == 20
    np.testing.assert_allclose(run.mean[:2], truth[:2], atol=0.01)
    with pytest.raises(sinew.Error, match="time_step"):
        model.advance(run.mean, 1.0, 0.01)


def test_stepped_model_wants_rows(scene):
    touch = estimate.NodalForce("touch", "finger", [20], [1.0])
    with pytest.raises(sinew.Error) as caught:
        made(scene, (touch,)).of_step()
    assert caught.value.kind == "bad-argument"
    with pytest.raises(sinew.Error):
        estimate.TwinModel(made(scene, (HAND, estimate.Parameter("bodies.finger.material.young_modulus", 4e5))))


def test_rows_that_stay_give_what_differences_give(scene):
    twin = made(scene)
    values = np.concatenate([[0.3, -0.2, 0.1], PULL])
    twin.predict(values)
    numbers, slope = twin.of_step()
    np.testing.assert_allclose(numbers, twin.read(), rtol=1e-12, atol=1e-15)
    reference = twin.sensitivity()
    np.testing.assert_allclose(slope, reference, rtol=1e-6, atol=1e-9 * np.abs(reference).max())


def seen_finger(scene):
    """A plant under a push, its sensors with different rates and delays, and a twin with the push as an unknown."""
    sensing = ("sensors={tip: {type: marker, body: finger, point: 0 0 80 mm, noise: 0.05 mm, rate: 50 Hz, delay: 30 ms}, "
               "side: {type: marker, body: finger, point: 10 0 50 mm, outside: nearest, noise: 0.05 mm, dropout: 20 %}, "
               + ", ".join(f"{c}: {{type: cable-tension, actuator: {c}, noise: 5 mN}}, "
                           f"{c}_length: {{type: cable-length, actuator: {c}, noise: 0.01 mm}}" for c in CABLES) + "}")
    plant = sinew.load(scene, set=[sensing, *(f"actuators.{c}.command={{displacement: 0 mm}}" for c in CABLES)])
    watching = list(plant.sensors.values())
    twin = made(scene, measured=[estimate.Measured.by(sensor) for sensor in watching])
    return plant, watching, twin


def test_readings_come_from_sensors(scene):
    plant, watching, twin = seen_finger(scene)
    assert [(m.name, m.std, m.rate, m.delay) for m in twin.measured[:2]] == [
        ("tip.position", 5e-5, 50.0, 0.03), ("side.position", 5e-5, None, 0.0)]
    assert [m.name for m in twin.measured[2:4]] == ["east.tension", "east.displacement"]
    plant.actuator("push").force = 0.3
    plant.solve_static()
    found = estimate.solve(twin, estimate.readings_of(watching))
    assert found.values["hand.x"] == pytest.approx(0.3, abs=4.0 * found.std["hand.x"])
    assert found.std["hand.x"] < 0.05


def test_a_filter_takes_samples_as_they_are_delivered(scene):
    plant, watching, twin = seen_finger(scene)
    commands = [sensor for sensor in watching if sensor.kind == "cable-length"]
    answers = [sensor for sensor in watching if sensor not in commands]
    model = estimate.TwinModel(twin, lambda time: {sensor.name.removesuffix("_length"): sensor.value for sensor in commands})
    run = estimate.ExtendedKalman(model, step=0.01)
    force, taken = 0.2, 0
    for _ in range(12):
        plant.actuator("push").force = force
        plant.step()
        new = run.delivered(answers)
        assert all(reading.time <= plant.time for reading in new)
        taken += sum(reading.sensor == 0 for reading in new)
        run.update(plant.time, new)
    assert taken == 5  # samples of 0 to 80 ms, with a delay of 30 ms
    hand = twin.inputs.index("hand.x")
    assert run.mean[hand] == pytest.approx(force, abs=4.0 * run.std[hand])
    assert run.std[hand] < 0.1


def test_sensors_that_no_estimate_can_use_are_named(scene):
    plant = sinew.load(scene, set=["sensors={exact: {type: marker, body: finger, point: 0 0 80 mm}, "
                                   "skin: {type: stretch, body: finger, line: [0 0 0 mm, 0 0 80 mm], noise: 1e-4}}"])
    for name, kind in (("exact", "out-of-range"), ("skin", "bad-argument")):
        with pytest.raises(sinew.Error) as caught:
            estimate.Measured.by(plant.sensor(name))
        assert caught.value.kind == kind and caught.value.remedy
