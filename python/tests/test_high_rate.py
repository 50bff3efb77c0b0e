"""The high-rate loop: solutions for snapshots of simulations, hands, stale data, and its socket."""

import re
import socket
import struct
from pathlib import Path

import numpy as np
import pytest

import sinew

CABLES = ["east", "north", "west", "south"]
HEADER = struct.Struct("<IHHIHHHHId")
MAGIC = 0x52484E53


def wall_loop(**options):
    return sinew.HighRateLoop(None, hands=["hand"], max_contacts=0, **options)


def wall(stiffness=1000.0):
    return sinew.Snapshot(np.array([[1.0 / stiffness]]), np.zeros(1))


def test_an_outside_force_is_found_from_sensors(sim):
    sim.actuator("east").tension = 2.0
    sim.actuator("push").force = -0.3
    sim.step(3)
    sensors = {name: 1e-5 for name in ["tip", *CABLES]}
    loop = sinew.HighRateLoop(sim, driven=CABLES, effectors=["tip"], unknown={"push": 1.0}, sensors=sensors)
    loop.publish()
    loop.set_input(
        sensors={"tip": sim.effector("tip").position, **{name: sim.actuator(name).displacement for name in CABLES}},
        driven={name: sim.actuator(name).tension for name in CABLES},
    )
    loop.advance(3)
    output = loop.output
    assert output.state == "running"
    assert output.unknown["push"] == pytest.approx(-0.3, rel=0.01)
    assert 0.0 < output.deviation["push"] < 0.01


def steer(sim, goal):
    """Position of the tip after one second of the loop at 1 kHz with the model at 100 Hz."""
    loop = sinew.HighRateLoop(sim, driven=CABLES, effectors=["tip"], tasks={"tip": 1.0})
    loop.set_input(targets={"tip": goal})
    for _ in range(100):
        loop.publish()
        loop.advance(10)
        for name, effort in loop.output.driven.items():
            sim.actuator(name).tension = effort
            assert -1e-12 <= effort <= 20.0
        sim.step()
    np.testing.assert_allclose(loop.output.tasks["tip"], sim.effector("tip").position, atol=1e-6)
    return sim.effector("tip").position.copy()


def test_a_finger_reaches_its_target_under_a_push(sim):
    sim.actuator("push").force = 0.1
    sim.actuator("east").tension = 1.5
    sim.actuator("north").tension = 0.8
    sim.solve_static()
    goal = sim.effector("tip").position.copy()
    sim.reset()
    sim.actuator("push").force = 0.1
    assert np.linalg.norm(steer(sim, goal) - goal) < 1e-6


def test_out_of_reach_it_ends_where_the_inverse_controller_does(sim):
    sim.actuator("push").force = 0.1
    goal = sim.effector("tip").position + [4e-3, -3e-3, -0.2e-3]
    ended = steer(sim, goal)
    sim.reset()
    sim.actuator("push").force = 0.1
    with sinew.InverseController(sim, targets={"tip": goal}, actuators=CABLES) as ik:
        ik.step(300)
        assert ik.status == "out-of-reach"
    np.testing.assert_allclose(ended, sim.effector("tip").position, atol=1e-6)


def test_a_hand_feels_the_finger(sim):
    loop = sinew.HighRateLoop(sim, hands=["push"])
    loop.publish()
    loop.set_input(hands={"push": 0.5e-3})
    loop.advance(10)
    felt = loop.output.hands["push"]
    sim.actuator("push").displacement = 0.5e-3
    sim.solve_static()
    assert felt == pytest.approx(sim.actuator("push").force, rel=0.02)
    assert felt > 0.01


def test_a_snapshot_leaves_the_simulation_as_it_is(sim):
    sim.actuator("east").displacement = 2e-3
    sim.step(2)
    before = sim.state()
    loop = sinew.HighRateLoop(sim, driven=["north"], effectors=["tip"])
    snapshot = loop.snapshot()
    assert sim.state() == before
    assert snapshot.compliance.shape == (4, 4)
    linear = sim.linearise()
    own = linear.W[linear.rows.index("north"), linear.rows.index("north")]
    assert snapshot.compliance[0, 0] < own  # because `east` holds its length


@pytest.mark.parametrize("passivity", [True, False])
def test_energy_at_a_wall(passivity):
    loop = wall_loop(passivity=passivity)
    loop.publish(wall())
    time = 1e-3 * np.arange(3000)
    place = 5e-3 * np.sin(2 * np.pi * 6.0 * time) + 5e-3 * np.sin(2 * np.pi * 1.7 * time + 1.0)
    created, force = 0.0, 0.0
    for before, here in zip(np.r_[place[0], place], place):
        created -= force * (here - before)
        loop.set_input(hands={"hand": here})
        loop.publish(wall())
        loop.advance()
        force = loop.output.hands["hand"]
    assert loop.output.energy_created == pytest.approx(created, abs=1e-9)
    assert created <= 0.0 if passivity else created > 0.01


def test_it_holds_and_lets_go():
    loop = wall_loop(stale_after=0.05, release_time=0.1)
    assert loop.output.state == "waiting" and loop.output.period == 0
    loop.publish(wall())
    seen = []
    for _ in range(220):
        loop.set_input(hands={"hand": 1e-3})
        loop.advance()
        seen.append((loop.output.state, loop.output.cause, loop.output.hands["hand"]))
    assert seen[20] == ("running", "none", pytest.approx(1.0))
    assert seen[80] == ("holding", "snapshot", pytest.approx(1.0))
    assert seen[150][0] == "releasing" and seen[150][2] == pytest.approx(0.5, abs=0.02)
    assert seen[-1] == ("released", "snapshot", 0.0)


def test_its_thread_runs_and_stops():
    loop = wall_loop()
    loop.publish(wall())
    with loop:
        assert loop.running
        while loop.report.periods < 5:
            pass
    assert not loop.running
    report = loop.report
    assert report.real_time == (report.scheduling == "SCHED_FIFO")
    assert loop.lateness.counts.sum() == loop.work.counts.sum() == report.periods
    assert 0.0 <= loop.work.quantile(0.5) <= max(loop.work.longest, 1e-6 * 1000)


def test_the_guide(monkeypatch, capsys):
    root = Path(__file__).resolve().parents[2]
    monkeypatch.chdir(root)
    (block,) = re.findall(r"```python\n(.*?)```", (root / "docs/high_rate.md").read_text(encoding="utf-8"), re.DOTALL)
    exec(compile(block, "docs/high_rate.md", "exec"), {"sinew": sinew})
    assert "HighRateReport(periods=" in capsys.readouterr().out


def measurement(sequence, sensors, hands=(), version=1):
    counts = (len(sensors), len(hands), 0)
    return HEADER.pack(MAGIC, version, 1, sequence, *counts, 0, 0, 0.0) + struct.pack(
        f"<{len(sensors) + len(hands)}d", *sensors, *hands
    )


def test_a_device_talks_to_it():
    loop = wall_loop(udp=("127.0.0.1", 0), stale_after=1e3)
    loop.publish(wall())
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as device:
        device.settimeout(30.0)
        device.connect(("127.0.0.1", loop.udp.port))
        for bad in (b"", b"noise", measurement(1, [], [1e-3], version=2), measurement(1, [0.0], [1e-3])):
            device.send(bad)
        device.send(measurement(1, [], [2e-3]))
        device.send(measurement(1, [], [9e-3]))  # again
        loop.advance()
        magic, version, kind, sequence, driven, hands, unknown, state, _, _ = HEADER.unpack(device.recv(2000)[:32])
        assert (magic, version, kind, sequence) == (MAGIC, 1, 2, 1)
        assert (driven, hands, unknown) == (0, 1, 0)
        assert state == 1  # running
        with loop:  # in the loop's own thread, the latest position takes effect
            for sequence in range(2, 200):
                device.send(measurement(sequence, [], [3e-3]))
                (force,) = struct.unpack("<d", device.recv(2000)[32:])
                if abs(force - 3.0) < 1e-6:
                    break
            assert force == pytest.approx(3.0)
    assert loop.udp.invalid == 4
    assert loop.udp.outdated == 1
    assert loop.udp.received >= 2


@pytest.mark.parametrize(
    "options, kind",
    [
        ({"driven": ["nobody"]}, "unknown-name"),
        ({"effectors": ["nobody"]}, "unknown-name"),
        ({"hands": ["nobody"]}, "unknown-name"),
        ({"driven": ["east"], "unknown": {"east": 1.0}}, "bad-argument"),
        ({"driven": ["east"], "sensors": {"tip": 1e-4}}, "unknown-name"),
        ({"tasks": {"tip": 1.0}}, "unknown-name"),
        ({"driven": ["east"], "sensors": {"east": "low"}}, "wrong-type"),
        ({"driven": ["east"], "sensors": {"east": 0.0}}, "out-of-range"),
        ({"driven": {"east": (3.0, 1.0)}}, "contradictory-limits"),
        ({"driven": {"east": 3.0}}, "wrong-type"),
        ({"hands": {"push": (1.0, 2.0)}}, "out-of-range"),
        ({"rate": 0.0}, "out-of-range"),
        ({"rate": "fast"}, "wrong-type"),
        ({"stale_after": -1.0}, "out-of-range"),
        ({"udp": ("nowhere", 0)}, "bad-argument"),
    ],
)
def test_what_is_wrong_is_named(sim, options, kind):
    with pytest.raises(sinew.Error) as caught:
        sinew.HighRateLoop(sim, **options)
    assert caught.value.kind == kind
    assert caught.value.remedy


def test_wrong_input_is_named(sim):
    loop = sinew.HighRateLoop(sim, driven=["east"], effectors=["tip"], tasks={"tip": 1.0})
    for given, kind in (
        ({"targets": {"top": [0, 0, 0]}}, "unknown-name"),
        ({"targets": {"tip": [0.0, 0.0]}}, "wrong-shape"),
        ({"targets": {"tip": [0.0, 0.0, np.inf]}}, "not-finite"),
        ({"sensors": {"tip": [0, 0, 0]}}, "unknown-name"),
    ):
        with pytest.raises(sinew.Error) as caught:
            loop.set_input(**given)
        assert caught.value.kind == kind
    with pytest.raises(sinew.Error) as caught:
        loop.publish(wall())
    assert caught.value.kind == "wrong-shape"
    with pytest.raises(sinew.Error) as caught:
        wall_loop().snapshot()
    assert caught.value.kind == "bad-argument"
