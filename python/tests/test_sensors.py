"""Sensors: samples in runs, in Python, in files, and from real robots."""

import copy
import csv
import pathlib

import numpy as np
import pytest
import sinew

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIDE = 0.01
END = [6 * SIDE, SIDE / 2, SIDE / 2]


def beam(sensors, **scene):
    return sinew.load({
        "sinew": 1, "time_step": 0.01,
        "bodies": {"beam": {
            "type": "fem", "material": {"young_modulus": 2e5, "poisson_ratio": 0.3}, "density": 1000.0,
            "mesh": {"shape": "block", "length": 6 * SIDE, "width": SIDE, "height": SIDE, "element_size": SIDE / 2},
            "fixed": [{"set": "x_min"}]}},
        "actuators": {"pull": {"type": "cable", "body": "beam", "points": [[0, SIDE / 2, 0.008], [0.055, SIDE / 2, 0.008]],
                               "command": {"displacement": {"ramp": {"to": 0.004, "duration": 0.5}}}}},
        "effectors": {"tip": {"body": "beam", "point": END}},
        "sensors": sensors, **scene})


SENSORS = {
    "eye": {"type": "marker", "body": "beam", "point": END, "noise": 1e-4, "rate": 50, "delay": 0.03, "seed": 1},
    "length": {"type": "cable-length", "actuator": "pull", "noise": "0.1 mm", "quantum": "0.01 mm"},
    "fibre": {"type": "curvature", "body": "beam", "line": [[0, SIDE / 2, SIDE / 2], END], "places": [0.02, 0.04], "gauge": 0.02},
}


def test_a_sensor_says_what_it_is_and_what_is_true():
    sim = beam(SENSORS)
    assert list(sim.sensors) == list(SENSORS)
    eye, length = sim.sensor("eye"), sim.sensor("length")
    assert (eye.name, eye.kind, eye.unit, eye.size) == ("eye", "marker", "m", 3)
    assert (eye.rate, eye.delay, length.rate, length.delay) == (50, 0.03, None, 0)
    assert length.std == pytest.approx(np.hypot(1e-4, 1e-5 / np.sqrt(12)))
    assert (length.observable, eye.observable) == ("pull.displacement", "eye.true")
    assert np.isnan(eye.value).all() and np.isnan(eye.time) and not eye.valid and not eye.fresh
    sim.step(20)
    assert eye.true_value == pytest.approx(sim.effector("tip").position, abs=1e-15)
    assert length.true_value == sim.actuator("pull").displacement
    assert length.value == pytest.approx(length.true_value, abs=5e-4) and length.value != length.true_value
    assert round(length.value / 1e-5) * 1e-5 == pytest.approx(length.value, abs=1e-15)
    assert eye.valid and eye.time == pytest.approx(0.16) and not eye.fresh  # taken at 0.16 s, delivered at 0.19 s
    assert sim.sensor("fibre").value.shape == (2,)
    with pytest.raises(sinew.Error, match="did you mean 'eye'"):
        sim.sensor("aye")


def test_a_run_returns_samples_at_their_rate_and_delay():
    sim = beam(SENSORS)
    out = sim.run(0.5)
    measured, true, taken, time = out["eye.measured"], out["eye.true"], out["eye.sample_time"], out["time"]
    assert measured.shape == true.shape == (51, 3)
    assert np.isnan(measured[:3]).all() and np.isfinite(measured[3:]).all()
    expected = np.floor((time[3:] - 0.03) / 0.02 + 1e-6) * 0.02
    np.testing.assert_allclose(taken[3:], expected, atol=1e-12)
    error = measured[3:] - true[np.rint(taken[3:] / 0.01).astype(int)]
    _, first = np.unique(taken[3:], return_index=True)
    assert np.abs(error).max() < 5e-4
    # 24 samples of three numbers; the tolerance is five standard deviations of the sample deviation.
    assert error[first].std() == pytest.approx(1e-4, abs=5 * 1e-4 / np.sqrt(2 * 3 * len(first)))
    bare = beam({}).run(0.5)
    assert bare["tip.position"].tobytes() == out["tip.position"].tobytes()


def test_noise_is_that_of_philox():
    settings = dict(noise=0.3, seed=7, size=2)
    channel = sinew.sensors.Channel(**settings)
    for k in range(5):
        assert channel.offer(0.1 * k, [1.0, 2.0])
        for c in range(2):
            counter = (k + (c << 64) - 1) % (1 << 256)  # numpy increments the counter before it draws
            words = np.random.Philox(key=7, counter=counter).random_raw(4)
            u, v = (int(w) >> 11 for w in words[:2])
            normal = np.sqrt(-2 * np.log1p(-u * 2.0**-53)) * np.cos(2 * np.pi * v * 2.0**-53)
            assert channel.value[c] == pytest.approx(c + 1 + 0.3 * normal, abs=1e-14)


def test_a_channel_copies_and_refuses():
    channel = sinew.sensors.Channel(noise=1, drift=1, rate=10, delay=0.2, dropout=0.1)
    for k in range(30):
        channel.offer(0.05 * k, 0.0)
    other = copy.deepcopy(channel)
    for k in range(30, 60):
        channel.offer(0.05 * k, 0.0)
        other.offer(0.05 * k, 0.0)
        assert (channel.value, channel.time, channel.fresh) == (other.value, other.time, other.fresh)
    assert channel.samples == 30
    for wrong in ({"noise": -1}, {"dropout": 2}, {"range": (1, 0)}, {"size": 0}, {"delay": -1}):
        with pytest.raises(sinew.Error) as caught:
            sinew.sensors.Channel(**wrong)
        assert caught.value.kind == "out-of-range"
    with pytest.raises(sinew.Error, match="2 numbers for a channel of 1"):
        channel.offer(9, [1, 2])


def resting(sensors):
    """A ball on a block on a table."""
    return sinew.load({
        "sinew": 1, "time_step": 1e-3, "integrator": "backward-euler", "gravity": [0, 0, -9.81],
        "bodies": {
            "block": {"type": "fem", "density": 1000.0, "damping": {"stiffness": "2 ms"},
                      "material": {"young_modulus": "200 kPa", "poisson_ratio": 0.3},
                      "mesh": {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.02, "element_size": 0.02}},
            "ball": {"type": "rigid", "shape": {"sphere": {"radius": "10 mm"}}, "mass": "20 g", "pose": {"position": "20 20 30 mm"}},
            "table": {"type": "rigid", "shape": {"box": "200 200 20 mm"}, "pose": {"position": "20 20 -10 mm"}, "fixed": True}},
        "contacts": {"all": {"between": "all", "friction": 0.3, "except": [["block", "block"]]}}, "sensors": sensors})


def felt(contact, **more):
    return {"type": "contact-force", "contact": contact, **more}


def test_pairs_of_all_bodies_are_felt():
    sim = resting({"pair": felt("all-block-table"), "every": felt("all"), "under": felt("all", patch={"body": "block", "set": "z_min"}),
                   "over": felt("all", patch={"body": "block", "set": "z_max"}), "on": {"type": "touch", "contact": "all", "threshold": "0.3 N"},
                   "off": {"type": "touch", "contact": "all-ball-table"}})
    sim.step(60)
    below, above = (sim.contact(f"all-block-{other}").normal_force for other in ("table", "ball"))
    assert below > above > 0.1 and list(sim.contacts) == ["all-block-ball", "all-block-table", "all-ball-table"]
    assert sim.sensor("pair").observable == "all-block-table.normal_force" and sim.sensor("every").observable == "every.true"
    value = {name: sensor.value for name, sensor in sim.sensors.items()}
    assert (value["pair"], value["on"], value["off"]) == (below, 1.0, 0.0)
    assert value["every"] == pytest.approx(below + above, rel=1e-14)
    assert (value["under"], value["over"]) == pytest.approx((below, above), rel=1e-14)


@pytest.mark.parametrize("sensor, kind, part", [
    (felt("all-block-wall"), "unknown-name", "all-block-table"),
    (felt("some-block-table"), "unknown-name", "under `contacts` there are all"),
    (felt("all", patch={"set": "z_min"}), "missing-key", "add body"),
    (felt("all-block-table", patch={"body": "ball", "sphere": {"centre": "20 20 30 mm", "radius": "20 mm"}}), "unknown-name", "name the body 'block'"),
])
def test_pairs_that_cannot_be_felt_are_named(sensor, kind, part):
    with pytest.raises(sinew.Error) as caught:
        resting({"s": sensor})
    assert caught.value.kind == kind and part in str(caught.value)


def test_states_clones_and_threads_keep_the_samples():
    def numbers(sim):
        return np.concatenate([np.atleast_1d(s.value) for s in sim.sensors.values()] + [[s.missing for s in sim.sensors.values()]])

    sim, threaded = beam(SENSORS), beam(SENSORS, solver={"threads": 2})
    sim.step(13)
    state, clone = sim.state(), sim.clone()
    for one in (sim, clone):
        one.step(20)
    threaded.step(33)
    after = numbers(sim)
    assert numbers(clone).tobytes() == after.tobytes() == numbers(threaded).tobytes()
    sim.restore(state)
    sim.step(20)
    assert numbers(sim).tobytes() == after.tobytes()
    sim.reset()
    sim.step(33)
    assert numbers(sim).tobytes() == after.tobytes()


def test_seeds_and_names_make_different_noise():
    one = {"type": "cable-length", "actuator": "pull", "noise": 1e-4}
    sim = beam({"a": one, "b": one, "c": {**one, "seed": 5}})
    values = {name: sensor.value for name, sensor in sim.sensors.items()}
    assert len(set(values.values())) == 3
    assert beam({"b": one}).sensor("b").value == values["b"]


def test_a_static_solution_is_sampled_at_once():
    sim = beam(SENSORS)
    sim.actuator("pull").displacement = 0.004
    sim.solve_static()
    eye = sim.sensor("eye")
    assert eye.valid and eye.fresh and eye.time == 0
    assert eye.value == pytest.approx(sim.effector("tip").position, abs=5e-4)
    first = eye.value
    sim.solve_static()
    assert (eye.value != first).any()


def test_real_samples_replace_simulated_ones():
    sim = beam({**SENSORS, "length": {**SENSORS["length"], "timeout": 0.025}})
    length = sim.sensor("length")
    sim.step(3)
    length.feed(0.0012, time=0.028)
    assert (length.value, length.time, length.fresh) == (0.0012, 0.028, True)
    sim.step()
    assert length.fresh and length.valid
    sim.step()
    assert (length.value, length.fresh) == (0.0012, False) and length.valid
    length.feed(float("nan"), time=0.05)
    assert (length.value, length.missing) == (0.0012, 1)
    sim.step()
    assert not length.valid
    length.feed(0.002)
    assert length.time == sim.time and length.valid
    for value, time, kind in ((0.1, 0.01, "non-monotonic-time"), ([1, 2], None, "wrong-length"), (np.inf, None, "not-finite"),
                              ("x", None, "wrong-type")):
        with pytest.raises(sinew.Error) as caught:
            length.feed(value, time)
        assert caught.value.kind == kind
        assert "sensor('length').feed" in str(caught.value)
    sim.reset()
    sim.step()
    assert length.value != 0.002 and length.time == sim.time


def test_a_recorded_run_is_replayed(tmp_path):
    out = beam(SENSORS).run(0.4)
    axes = "xyz"
    with open(tmp_path / "sensors.csv", "w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["time [s]", *(f"eye.measured_{axis} [mm]" for axis in axes), "eye.sample_time [s]"])
        for row in zip(out["time"], out["eye.measured"], out["eye.sample_time"]):
            table.writerow([row[0], *(1e3 * row[1]), row[2]])
    eye = {"type": "marker", "body": "beam", "point": END, "file": str(tmp_path / "sensors.csv"), "missing": "lost"}
    again = beam({"eye": eye}).run(0.4)
    np.testing.assert_allclose(again["eye.measured"], out["eye.measured"], rtol=1e-15)
    np.testing.assert_array_equal(again["eye.sample_time"], out["eye.sample_time"])
    np.testing.assert_array_equal(again["eye.true"], out["eye.true"])
    del eye["missing"]
    with pytest.raises(sinew.Error, match="sensors.csv:2:.*not-finite"):
        beam({"eye": eye})


def test_the_finger_with_sensors_runs():
    finger = sinew.load(ROOT / "examples/finger/sensors.yaml")
    out = finger.run(0.6)
    pressure = out["gauge.true"]
    assert 14e3 < pressure[-1] < 25e3  # behind the command, since the supply is narrow
    error = out["gauge.measured"] - pressure - 100
    assert error[1:].std() == pytest.approx(finger.sensor("gauge").std, rel=0.5)
    # The inflow agrees with the isothermal gas law p V = p_0 v.
    growth, filled = out["air.volume_growth"][-1], out["supply.true"].sum() * finger.time_step
    volume = (101325.0 * filled - (101325.0 + pressure[-1]) * growth) / pressure[-1]  # at rest
    bore = np.pi * 0.0037**2 * 0.060
    assert volume == pytest.approx(bore, rel=0.12)  # the bore is a polygon with few sides
    # The rotation along a circle through three points of the axis equals that of the tip.
    turn = np.linalg.norm(out["imu.true"][-1])
    assert np.mean(out["fibre.true"][-1]) * 0.065 == pytest.approx(turn, rel=0.3)
    stretched = out["skin.true"][-1] / 1000 - 1
    assert abs(stretched) > 0.01


@pytest.mark.parametrize(("sensor", "kind", "part"), [
    ({"type": "cable-length", "actuator": "pul"}, "unknown-name", "did you mean 'pull'"),
    ({"type": "pressure", "actuator": "pull"}, "wrong-actuator-type", "name an actuator of type chamber"),
    ({"type": "cable-length", "actuator": "pull", "rate": 30}, "out-of-range", "choose 25 Hz"),
    ({"type": "cable-length", "actuator": "pull", "noise": -1}, "out-of-range", "sensors.s.noise"),
    ({"type": "marker", "body": "beam", "point": [1, 1, 1]}, "point-outside-mesh", "point 0 of sensor 's'"),
])
def test_wrong_sensors_are_errors_with_place_and_remedy(sensor, kind, part):
    with pytest.raises(sinew.Error) as caught:
        beam({"s": sensor})
    assert caught.value.kind == kind
    assert part in str(caught.value)
    assert "sensors.s" in str(caught.value) or "sensor 's'" in str(caught.value)
