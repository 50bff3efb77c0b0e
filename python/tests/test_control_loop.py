"""Closed loops with two simulations: a plant and a model."""

import re
from pathlib import Path

import numpy as np
import pytest
import sinew
from sinew import control

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CABLES = ["east", "north", "west", "south"]
GOAL = np.array([0.005, 0.0035, 0.0755])
STIFFER = ["bodies.finger.material.young_modulus=520 kPa", "bodies.finger.mesh.element_size=12 mm",
           *(f"actuators.{name}.friction=0.1" for name in CABLES), "masses={load: {body: finger, point: 0 0 80 mm, mass: 3 g}}"]
GRAVITY = "gravity=0 0 9.81 m/s^2"


def camera(channel="", body="finger", point="0 0 80 mm"):
    """Setting for a marker at the tip of the finger; `channel` is its noise, rate, delay ..."""
    return f"sensors={{camera: {{type: marker, body: {body}, point: {point}, {channel}}}}}"


def drive(loop, plant, steps, *, lost=lambda k: False, start=0, wires=None):
    """Steps loop and plant; a loop without sensors gets exact measurements. Returns true errors, (steps,) m, and the statuses."""
    names = list(loop.targets)
    errors, statuses = [], []
    for k in range(start, start + steps):
        if loop._sensors is not None:
            commands = loop.step(time=plant.time)
        else:
            commands = loop.step({} if lost(k) else {name: plant.effector(name).value for name in names}, k * plant.time_step)
        if wires:
            commands = {wires.get(name, name): value for name, value in commands.items()}
        loop.send(plant, commands)
        plant.step()
        now = {name: np.array(plant.effector(name).value) for name in names}
        errors.append(max(np.linalg.norm(loop._robot.difference(name, loop._target(name, (k + 1) * plant.time_step), value))
                          for name, value in now.items()))
        statuses.append(loop.status)
    return np.array(errors), statuses


def twins(scene, plant=(), model=()):
    return sinew.load(scene, set=[GRAVITY, *plant]), sinew.load(scene, set=[GRAVITY, *model])


LOOPS = {
    "rate": lambda model, **more: control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=6.0, **more),
    "integral": lambda model, **more: control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=(6.0, 9.0), **more),
    "compensated": lambda model, **more: control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=6.0, compensate=True, **more),
    "predictive": lambda model, **more: control.PredictiveController(model, {"tip": GOAL}, CABLES, **more),
}


@pytest.mark.parametrize("kind", LOOPS)
@pytest.mark.parametrize("command", ["motion", "effort"])
def test_feedback_makes_up_for_what_the_model_does_not_know(scene, kind, command):
    """The plant has another mesh, 30 % more stiffness, cable friction, a payload, noise of 0.1 mm and a delay of 20 ms."""
    plant, model = twins(scene, [*STIFFER, camera("noise: 0.1 mm, delay: 20 ms")])
    loop = LOOPS[kind](model, command=command, sensors={"tip": plant.sensor("camera")})
    errors, statuses = drive(loop, plant, 300)
    assert errors[-100:].mean() < 2e-4
    assert statuses[-1] in ("on-target", "at-limits")
    assert loop.least_eigenvalue > 0.0 and loop.least_eigenvalue_std > 0.0
    if command == "effort":  # tensions alone miss because of stiffness and friction
        plant, model = twins(scene, STIFFER)
        alone, statuses = drive(LOOPS[kind](model, command=command, hold=0.0), plant, 250, lost=lambda k: True)
        assert set(statuses) == {"open-loop"}
        assert alone[-100:].mean() > 8e-4


def test_without_errors_of_the_model_the_loop_is_first_order(scene):
    """e(t) = e(0) exp(-rate t), in samples (1 - rate T)^k."""
    plant, model = twins(scene)
    for sim in (plant, model):
        for name in CABLES:
            sim.actuator(name).tension = 3.0
        sim.step(60)
        sim.solve_static()
    start = np.array(plant.effector("tip").position)
    loop = control.ClosedLoop(model, {"tip": start + [1e-4, 1e-4, 0.0]}, CABLES, gains=10.0, weights={"tip": [1, 1, 0]},
                              change=0.0, relaxation=0.0)
    errors, _ = drive(loop, plant, 20)
    plane = np.sqrt(2.0) * 1e-4 * 0.9 ** np.arange(1, 21)
    assert loop.errors["tip"] == pytest.approx(plane[-2], rel=0.02)
    assert loop.least_eigenvalue == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_the_largest_gain_is_that_of_an_integrator_with_a_delay(scene, delay):
    model = sinew.load(scene, set=[camera(f"delay: {10 * delay} ms")])
    for name in CABLES:
        model.actuator(name).tension = 3.0
    model.step(60)
    model.solve_static()
    start = np.array(model.effector("tip").position)

    def growth(gain, **more):
        plant = model.clone()
        loop = control.ClosedLoop(model.clone(), {"tip": start + [2e-5, 0.0, 0.0]}, CABLES, gains=gain / model.time_step,
                                  weights={"tip": [1, 0, 0]}, change=0.0, relaxation=0.0, real_jacobian="model",
                                  sensors={"tip": plant.sensor("camera")}, **more)
        places = []
        for _ in range(120):
            loop.send(plant, loop.step(time=plant.time))
            plant.step()
            places.append(abs(plant.effector("tip").position[0] - start[0] - 2e-5))
        return max(places[60:]) / max(places[20:60])

    limit = control.delay_limit(delay)
    assert growth(0.97 * limit) < 1.0 < growth(1.03 * limit)
    if delay:
        # With compensation by the model, the limit is that without delay, 2.
        assert growth(1.5, compensate=True) < 1.0


def test_vibrations_limit_the_rate():
    """x'' + 2 zeta w x' + w^2 x = w^2 s with s' = rate (r - x) is stable for rate < 2 zeta w (Routh)."""
    def arm(integrator):
        return sinew.load({
            "sinew": 1, "time_step": "10 ms", "integrator": integrator, "gravity": "0 0 0 m/s^2",
            "bodies": {"arm": {"type": "pcc", "segments": [{"length": "200 mm", "mass": "200 g", "stiffness": "5e-3 N m",
                                                            "damping": "3.125e-4 N m s"}]}},
            "actuators": {"bend": {"type": "torque", "body": "arm", "segment": 0}},
            "effectors": {"tip": {"body": "arm", "point": "0 0 -200 mm"}}})

    rest = arm("quasi-static")
    inertia = rest.body("arm").arm.mass_matrix(np.zeros(1))[0, 0]
    limit = 3.125e-4 / inertia  # 2 zeta w = b/H
    assert np.sqrt(5e-3 / inertia) == pytest.approx(6.3, abs=0.1) and limit == pytest.approx(2.5)

    def growth(rate):
        plant = arm({"type": "generalized-alpha", "spectral_radius": 1.0})
        loop = control.ClosedLoop(arm("quasi-static"), {"tip": plant.effector("tip").position + [1e-4, 0.0, 0.0]}, gains=rate,
                                  command="effort", weights={"tip": [1, 0, 0]}, change=0.0, relaxation=0.0, real_jacobian="model")
        errors = []
        for _ in range(1200):
            loop.send(plant, loop.step({"tip": plant.effector("tip").position}, plant.time))
            plant.step()
            errors.append(loop.error)
        return max(errors[800:]) / max(errors[400:800])

    # Sampling at 10 ms with held commands reduces the damping: a phase lag of w T/2 = 0.03 rad.
    assert growth(0.85 * limit) < 1.0 < growth(1.1 * limit)


def test_a_plant_that_is_wired_wrongly_violates_the_condition(scene):
    """East and west are swapped: the tip diverges along x, and the loop reports it with the exact Jacobian and with an
    estimate."""
    wires = {"east": "west", "west": "east"}
    order = [CABLES.index(wires.get(name, name)) for name in CABLES]
    for real in ("exact", "estimate"):
        plant, model = twins(scene)
        for sim in (plant, model):
            for name in CABLES:
                sim.actuator(name).tension = 3.0
            sim.step(60)
        start = np.array(plant.effector("tip").position)
        loop = control.ClosedLoop(
            model, {"tip": start + [1e-4, 0.0, 0.0]}, CABLES, gains=4.0, tolerance=1e-5,
            real_jacobian=real if real == "estimate" else lambda: control.jacobian(plant, ["tip"], CABLES)[:, order],
            estimator={"noise": 1e-6, "spread": 1.0})
        errors, statuses = drive(loop, plant, 60, wires=wires)
        assert statuses[-1] == "condition-violated"
        assert loop.least_eigenvalue < -0.5
        assert errors[-1] > 2.0 * errors[0]


def test_the_least_eigenvalue_in_a_twin(scene):
    """Tensions move a finger of 1.3 times the stiffness by 1/1.3; the estimate agrees within its reported deviation."""
    harder = [setting for setting in STIFFER if "friction" not in setting and "mesh" not in setting]
    found = {}
    for real in ("exact", "estimate"):
        plant, model = twins(scene, harder)
        loop = control.ClosedLoop(
            model, {"tip": sinew.Circle([0.0, 0.0, 0.0755], 0.005, period=1.0)}, CABLES, gains=6.0, command="effort",
            real_jacobian=real if real == "estimate" else lambda: control.jacobian(plant, ["tip"], CABLES, command="effort"))
        drive(loop, plant, 200)
        found[real] = loop
    assert found["exact"].least_eigenvalue == pytest.approx(1.0 / 1.3, abs=0.03)
    assert found["exact"].least_eigenvalue_std == 0.0
    assert 0.0 < found["estimate"].least_eigenvalue_std < 0.2
    assert found["estimate"].least_eigenvalue == pytest.approx(found["exact"].least_eigenvalue,
                                                               abs=3.0 * found["estimate"].least_eigenvalue_std)


def test_an_integral_follows_ramps_and_does_not_wind_up(scene):
    """A disturbance that grows by d m/s leaves an error d/rate without an integral, and none with one."""
    left = {}
    for gains in ((5.0, 0.0), (5.0, 6.25)):
        plant, model = twins(scene)
        loop = control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=gains, relaxation=0.0)
        for k in range(400):
            drift = np.array([2e-3, 0.0, 0.0]) * k * plant.time_step  # drift of the measurement frame, m
            commands = loop.step({"tip": np.array(plant.effector("tip").position) + drift}, k * plant.time_step)
            loop.send(plant, commands)
            plant.step()
        left[gains] = loop.error
    assert left[5.0, 0.0] == pytest.approx(2e-3 / 5.0, rel=0.1)
    assert left[5.0, 6.25] < 0.05 * left[5.0, 0.0]
    # The target is 0.2 m out of reach for two seconds. With wind-up, the error would still be 33 mm three seconds later.
    plant, model = twins(scene)
    loop = control.ClosedLoop(model, {"tip": [0.2, 0.0, 0.06]}, CABLES, gains=(5.0, 6.25))
    _, statuses = drive(loop, plant, 200)
    assert statuses[-1] == "at-limits"
    loop.set_target("tip", GOAL)
    errors, _ = drive(loop, plant, 300, start=200)
    assert errors[-1] < 5e-4


def test_lost_measurements_hold_and_then_open_the_loop(scene):
    plant, model = twins(scene, STIFFER)
    loop = control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=6.0, hold=0.1)
    drive(loop, plant, 150)
    held = loop.commands
    _, statuses = drive(loop, plant, 10, start=150, lost=lambda k: True)
    assert statuses == ["holding"] * 10 and loop.commands == held
    assert np.isnan(loop.least_eigenvalue)
    # Open loop: the loop follows a new target with the model, corrected by the last measured difference.
    loop.set_target("tip", GOAL + [-0.002, 0.0, 0.0])
    errors, statuses = drive(loop, plant, 100, start=160, lost=lambda k: True)
    assert set(statuses) == {"open-loop"}
    assert errors[-1] < 7e-4 < errors[0]
    errors, statuses = drive(loop, plant, 100, start=260)
    assert errors[-1] < 1e-4 and statuses[-1] == "on-target"
    # NaN and None count as lost measurements.
    for lost in ({"tip": None}, {"tip": [np.nan, 0.0, 0.0]}, None):
        loop.step(lost, loop.time + 0.01)
        assert loop.status == "holding"
    loop.step({"tip": GOAL}, loop.time + 0.01)
    assert loop.status != "holding"


def test_samples_that_do_not_come_are_lost_measurements(scene):
    """With a camera of 50 Hz and a delay of 20 ms, a sample may be at most 40 ms old."""
    plant, model = twins(scene, [camera("rate: 50 Hz, delay: 20 ms")])
    tip = plant.sensor("camera")
    loop = control.ClosedLoop(model, {"tip": GOAL}, CABLES, sensors={"tip": tip})
    _, statuses = drive(loop, plant, 12)
    assert statuses[:3] == ["holding", "holding", "moving"] and set(statuses[3:]) == {"moving"}
    tip.feed(plant.effector("tip").position, time=plant.time)
    _, statuses = drive(loop, plant, 7)
    assert statuses == ["moving"] * 5 + ["holding"] * 2
    tip.feed([np.nan, 0.0, 0.0], time=plant.time)
    assert drive(loop, plant, 1)[1] == ["holding"]
    tip.feed(plant.effector("tip").position, time=plant.time)
    assert drive(loop, plant, 1)[1] == ["moving"]
    # A sensor may specify a timeout for its samples.
    plant, model = twins(scene, [camera("delay: 20 ms, rate: 25 Hz, timeout: 25 ms")])
    loop = control.ClosedLoop(model, {"tip": GOAL}, CABLES, sensors={"tip": plant.sensor("camera")}, hold=1.0)
    assert drive(loop, plant, 10)[1][2:] == ["moving", "holding", "holding", "holding"] * 2


@pytest.mark.parametrize("kind", LOOPS)
def test_states_and_clones_go_on_bit_for_bit(scene, kind):
    plant, model = twins(scene, [*STIFFER, camera("noise: 0.1 mm, rate: 50 Hz, delay: 10 ms")])
    loop = LOOPS[kind](model, sensors={"tip": plant.sensor("camera")})
    drive(loop, plant, 40)
    other = plant.clone()
    saved, at, copy = loop.state(), plant.state(), loop.clone(sensors={"tip": other.sensor("camera")})

    def go_on(one, sim):
        drive(one, sim, 25, start=40)
        return one.commands, sim.state_hash, one.least_eigenvalue, one.model.state_hash

    first = go_on(loop, plant)
    assert go_on(copy, other) == first
    loop.restore(saved)
    plant.restore(at)
    assert go_on(loop, plant) == first


def test_limits_are_kept(scene):
    limits = "{tension: {min: 0.2 N, max: 4 N}, displacement: {min: -8 mm, max: 8 mm, rate: 20 mm/s}}"
    settings = [f"actuators.{name}.limits={limits}" for name in CABLES]
    for kind in LOOPS:
        plant, model = twins(scene, settings, settings)
        loop = LOOPS[kind](model)
        loop.set_target("tip", [0.03, 0.02, 0.06])
        before = None
        for k in range(120):
            commands = np.array(list(loop.step({"tip": plant.effector("tip").position}, k * 0.01).values()))
            loop.send(plant, loop.commands)
            plant.step()
            assert (np.abs(commands) <= 8e-3 + 1e-12).all()
            if before is not None:
                assert (np.abs(commands - before) <= 20e-3 * 0.01 + 1e-12).all()
            before = commands
            tensions = np.array([model.actuator(name).tension for name in CABLES])
            assert (tensions < 4.0 + 0.05).all()
        assert loop.status == "at-limits"
        assert (tensions > 0.15).all()


def test_a_moving_target_is_seen_coming(scene):
    circle = sinew.Circle([0.0, 0.0, 0.0785], 0.004, period=1.0)
    worst = {}
    for name, make in (("rate", control.ClosedLoop), ("predictive", control.PredictiveController)):
        plant, model = twins(scene, STIFFER)
        loop = make(model, {"tip": circle}, CABLES, weights={"tip": [1, 1, 0]})
        drive(loop, plant, 150)
        worst[name] = 0.0
        for k in range(150, 250):
            loop.send(plant, loop.step({"tip": plant.effector("tip").position}, k * 0.01))
            plant.step()
            worst[name] = max(worst[name], loop.error)
    # The target moves at 25 mm/s: at a rate of 5/s without feedforward of its velocity, the lag would be 5 mm.
    assert worst["rate"] < 1e-3
    assert worst["predictive"] < 1e-3


def test_gains_by_schedule(scene):
    plant, model = twins(scene)
    seen = []

    def bend(loop):
        seen.append(loop.positions["tip"][0])
        return seen[-1]

    loop = control.ClosedLoop(model, {"tip": GOAL}, CABLES, gains=control.Schedule(bend, [0.0, 0.005], [(2.0, 0.0), (8.0, 0.0)]),
                              relaxation=0.0)
    errors, _ = drive(loop, plant, 200)
    assert errors[-1] < 2e-5 and len(seen) == 200
    assert seen[-1] == pytest.approx(0.005, abs=1e-4)
    # Per step, the error falls by 2 % at a gain of 2/s, and by 8 % at 8/s.
    assert errors[120] / errors[119] == pytest.approx(0.92, abs=0.01)


# Other robots


def test_arms_of_constant_curvature(tmp_path):
    def arm(stiffness, mass):
        segment = {"length": "140 mm", "mass": mass, "stiffness": stiffness, "damping": "4e-3 N m s", "bending": "spatial"}
        return sinew.load({
            "sinew": 1, "time_step": "10 ms", "integrator": "quasi-static", "gravity": "0 0 -9.81 m/s^2",
            "bodies": {"arm": {"type": "pcc", "segments": [segment, segment]}},
            "actuators": {f"{way}_{k}": {"type": "torque", "body": "arm", "segment": k, "towards": way,
                                         "limits": {"torque": {"min": "-0.5 N m", "max": "0.5 N m"}}}
                          for k in (0, 1) for way in ("side", "across")},
            "effectors": {"tip": {"body": "arm", "point": "0 0 -280 mm"}, "hand": {"body": "arm", "orientation": "0 0 -280 mm"}},
            "sensors": {"tip": {"type": "marker", "body": "arm", "point": "0 0 -280 mm", "delay": "20 ms"},
                        "hand": {"type": "orientation", "body": "arm", "at": "0 0 -280 mm", "delay": "20 ms"}}})

    goal = arm("0.108 N m", "100 g")
    for name, torque in (("side_0", 0.08), ("across_0", -0.03), ("side_1", 0.03), ("across_1", 0.02)):
        goal.actuator(name).torque = torque
    goal.solve_static()
    target = {name: np.array(goal.effector(name).value) for name in ("tip", "hand")}
    for make in (control.ClosedLoop, control.PredictiveController):
        plant, model = arm("0.14 N m", "130 g"), arm("0.108 N m", "100 g")
        # With this weight, 1 rad counts as 0.1 m.
        loop = make(model, target, command="effort", weights={"hand": 0.01}, sensors=[plant.sensor(name) for name in target])
        errors, _ = drive(loop, plant, 400)
        assert loop.quantities["side_0"] == "torque"
        assert errors[-1] < 1e-3
        assert 0.3 < loop.least_eigenvalue < 1.0


def test_two_bodies_with_joints_and_pressed_against_a_wall():
    """Two welded segments with three cables through both; a wall with friction stops their tip."""
    def robot(stiffness, wall=True):
        scene = sinew.load(EXAMPLES / "joints" / "two_segments.yaml", set=[
            f"bodies.upper.material.young_modulus={stiffness}", "time_step=10 ms",
            *(["contacts={wall: {body: upper, surface: {plane: {point: 14 0 0 mm, normal: -1 0 0}}, friction: 0.3}}"] if wall else [])])
        scene.detach()
        return scene

    for name, goal, wall in (("free", [0.010, 0.006, 0.136], False), ("touching", [0.0035, 0.004, 0.1395], True)):
        plant, model = robot("150 kPa", wall), robot("120 kPa", wall)
        plant.step()
        model.step()
        loop = control.ClosedLoop(model, {"tip": goal}, gains=8.0, weights={"tip": [1, 1, 0]})
        drive(loop, plant, 150)
        assert loop.error < 2e-4, name
        if wall:
            # The tip can reach beyond the wall's limit for the flank: the segment bends over the contact and slides on it.
            loop.set_target("tip", [0.009, 0.004, 0.1395])
            errors, statuses = drive(loop, plant, 150, start=150)
            assert statuses[-1] == "on-target" and loop.error < 1e-4
            assert plant.contact("wall").normal_force > 0.3
            assert loop.least_eigenvalue > 0.5


def test_chambers_are_commanded_their_pressure():
    def module(material):
        return sinew.load(EXAMPLES / "finger" / "module.yaml", set=["integrator=quasi-static", f"bodies.module.material={material}",
                                            "bodies.module.mesh.element_size=8 mm", "actuators.chamber.command={pressure: 0 kPa}"])

    plant, model = module("{model: neo-hookean, young_modulus: 90 kPa, poisson_ratio: 0.45}"), module(
        "{model: neo-hookean, young_modulus: 70 kPa, poisson_ratio: 0.45}")
    goal = module("{model: neo-hookean, young_modulus: 70 kPa, poisson_ratio: 0.45}")
    goal.actuator("chamber").pressure = 6e3
    goal.solve_static()
    loop = control.ClosedLoop(model, {"tip": goal.effector("tip").position}, gains=15.0, weights={"tip": [1, 0, 0]})
    assert loop.quantities == {"chamber": "pressure"}
    drive(loop, plant, 60)
    assert loop.error < 1e-4
    assert plant.actuator("chamber").pressure > 1.15 * 6e3


# Errors and failures


def test_bad_input_has_names(scene, sim):
    for arguments, options, kind in (
        (("tip",), {}, "wrong-type"), (({},), {}, "no-effectors"), (({"top": GOAL},), {}, "unknown-name"),
        (({"tip": [0, 0]},), {}, "wrong-shape"), (({"tip": "there"},), {}, "wrong-type"),
        (({"tip": [0, np.nan, 0]},), {}, "not-finite"), (({"tip": [0, 0, 780.0]},), {}, "suspicious-unit"),
        (({"tip": GOAL}, ["nord"]), {}, "unknown-name"), (({"tip": GOAL}, []), {}, "no-actuators"),
        (({"tip": GOAL}, ["east", "east"]), {}, "bad-argument"),
        (({"tip": GOAL},), {"command": "speed"}, "unknown-choice"), (({"tip": GOAL},), {"command": {"nord": "motion"}}, "unknown-name"),
        (({"tip": GOAL},), {"weights": {"top": 1.0}}, "unknown-name"), (({"tip": GOAL},), {"weights": {"tip": [1, 1]}}, "wrong-shape"),
        (({"tip": GOAL},), {"weights": {"tip": -1.0}}, "out-of-range"), (({"tip": GOAL},), {"weights": {"tip": 0.0}}, "out-of-range"),
        (({"tip": GOAL},), {"tolerance": 0.0}, "out-of-range"), (({"tip": GOAL},), {"hold": -0.01}, "out-of-range"),
        (({"tip": GOAL},), {"hold": np.nan}, "out-of-range"),
        (({"tip": GOAL},), {"real_jacobian": "true"}, "unknown-choice"), (({"tip": GOAL},), {"change": -1.0}, "out-of-range"),
        (({"tip": GOAL},), {"estimator": {"noise": 0.0}}, "out-of-range"),
    ):
        for make in (control.ClosedLoop, control.PredictiveController):
            with pytest.raises(sinew.Error) as caught:
                make(sim, *arguments, **options)
            assert caught.value.kind == kind and caught.value.remedy, (arguments, options)
    for gains, kind in ((-1.0, "out-of-range"), ((1.0, -1.0), "out-of-range"), ("fast", "wrong-type"), (np.inf, "out-of-range")):
        with pytest.raises(sinew.Error) as caught:
            control.ClosedLoop(sim, {"tip": GOAL}, gains=gains)
        assert caught.value.kind == kind
    for options in ({"horizon": 0}, {"horizon": 2.5}, {"observer": 0.0}, {"observer": 1.5}):
        with pytest.raises(sinew.Error) as caught:
            control.PredictiveController(sim, {"tip": GOAL}, **options)
        assert caught.value.kind == "out-of-range"
    with sinew.InverseController(sim, targets={"tip": GOAL}), pytest.raises(sinew.Error) as caught:
        control.ClosedLoop(sim, {"tip": GOAL})
    assert caught.value.kind == "actuator-owned"


def test_bad_measurements_have_names(sim):
    loop = control.ClosedLoop(sim, {"tip": GOAL}, CABLES, real_jacobian=lambda: np.zeros((2, 2)))
    assert loop.status == "not-started" and np.isnan(loop.error) and np.isnan(loop.least_eigenvalue)
    before = sim.state_hash
    for arguments, kind in (
        ((GOAL, 0.0), "wrong-type"), (({"top": GOAL}, 0.0), "unknown-name"), (({"tip": [0, 0]}, 0.0), "wrong-shape"),
        (({"tip": "far"}, 0.0), "wrong-type"), (({"tip": GOAL}, np.nan), "not-finite"), (({"tip": GOAL},), "not-finite"),
    ):
        with pytest.raises(sinew.Error) as caught:
            loop.step(*arguments)
        assert caught.value.kind == kind
    assert sim.state_hash == before and loop.status == "not-started"
    with pytest.raises(sinew.Error) as caught:
        loop.step({"tip": GOAL}, 0.0)
    assert caught.value.kind == "wrong-shape" and "real_jacobian" in str(caught.value)
    good = control.ClosedLoop(sim, {"tip": GOAL}, CABLES)
    good.step({"tip": GOAL}, 0.0)
    with pytest.raises(sinew.Error) as caught:
        good.step({"tip": GOAL}, 0.0)
    assert caught.value.kind == "non-monotonic-time"
    with pytest.raises(sinew.Error) as caught:
        good.set_target("top", GOAL)
    assert caught.value.kind == "unknown-name"


def test_wrong_sensors_have_names(scene):
    sensors = ("sensors={tip: {type: marker, body: finger, point: 0 0 80 mm}, "
               "pull: {type: cable-length, actuator: east}}")
    plant, model = twins(scene, [sensors])
    tip = plant.sensor("tip")
    for wrong, kind in (({"top": tip}, "unknown-name"), ({}, "missing-key"), ([plant.sensor("pull")], "unknown-name"),
                        ({"tip": plant.sensor("pull")}, "wrong-type"), (["tip"], "wrong-type"), ({"tip": 1.0}, "wrong-type")):
        for make in (control.ClosedLoop, control.PredictiveController):
            with pytest.raises(sinew.Error) as caught:
                make(model, {"tip": GOAL}, CABLES, sensors=wrong)
            assert caught.value.kind == kind and caught.value.remedy, wrong
    loop = control.ClosedLoop(model, {"tip": GOAL}, CABLES, sensors=[tip])
    plant.step(3)
    for arguments, kind in ((({"tip": GOAL}, plant.time), "bad-argument"), ((None, 0.0), "non-monotonic-time")):
        with pytest.raises(sinew.Error) as caught:
            loop.step(*arguments)
        assert caught.value.kind == kind
    loop.step(time=plant.time)
    assert loop.errors["tip"] == pytest.approx(np.linalg.norm(tip.value - GOAL))


def test_the_guide(monkeypatch):
    """The code of docs/closed_loop.md runs."""
    root = EXAMPLES.parent
    monkeypatch.chdir(root)
    text = (root / "docs" / "closed_loop.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names = {}
    for block in blocks:
        exec(compile(block, "docs/closed_loop.md", "exec"), names)
    assert names["loop"].status == "on-target"
    assert 0.5 < names["loop"].least_eigenvalue < 2.0
