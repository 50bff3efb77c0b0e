"""Batches: results are bit-identical to separate simulations; failures and invalid arguments."""

import numpy as np
import pytest
import sinew
from sinew import pcc

ARM = """
sinew: 1
time_step: 1 ms
integrator: backward-euler
bodies:
  arm:
    type: pcc
    segments:
      - {length: 140 mm, mass: 190 g, stiffness: 0.108 N m, damping: 4.2e-3 N m s}
      - {length: 140 mm, mass: 90 g, stiffness: 0.108 N m, damping: 4.2e-3 N m s}
actuators:
  first: {type: torque, body: arm, segment: 0}
  second: {type: torque, body: arm, segment: 1}
effectors:
  tip: {body: arm, point: 0 0 -280 mm}
"""
NAMES = ["tip.position", "arm.coordinates", "arm.rates", "second.torque"]


def alone(torques, steps):
    """Hash and observables of a single simulation after steps under constant torques (2,)."""
    sim = sinew.loads(ARM)
    for actuator, torque in zip(sim.actuators.values(), torques):
        actuator.torque = torque
    sim.step(steps)
    body = sim.body("arm")
    return sim.state_hash, np.concatenate([sim.effector("tip").position, body.coordinates, body.rates, [sim.actuator("second").torque]])


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_each_does_what_it_does_alone(threads):
    torques = np.random.default_rng(0).uniform(-0.05, 0.05, (7, 2))
    first = sinew.loads(ARM)
    sims = [first] + [first.clone() for _ in range(6)]
    batch = sinew.Batch(sims, threads=threads)
    batch.command("torque", torques)
    assert batch.step(30) == [None] * 7
    batch.step(10)
    read = batch.read(NAMES)
    expected = [alone(row, 40) for row in torques]
    assert [sim.state_hash for sim in sims] == [state for state, _ in expected]
    assert read.tobytes() == np.array([numbers for _, numbers in expected]).tobytes()
    assert len(batch) == 7 and batch.threads == threads and batch[3].state_hash == sims[3].state_hash


def test_only_those_that_are_chosen_take_part():
    sim = sinew.loads(ARM)
    batch = sinew.Batch([sim, sim.clone(), sim.clone()], threads=2)
    which = np.array([True, False, True])
    batch.command("torque", np.full((3, 2), 0.02), which)
    batch.step(5, which)
    assert [one.steps for one in (batch[0], batch[1], batch[2])] == [5, 0, 5]
    assert batch[1].actuator("first").command == ("torque", 0.0) and batch[2].actuator("first").command == ("torque", 0.02)
    assert batch[0].state_hash == batch[2].state_hash != batch[1].state_hash


def test_one_that_fails_leaves_the_others_alone(scene):
    sim = sinew.load(scene)
    batch = sinew.Batch([sim, sim.clone(), sim.clone()], threads=2)
    with pytest.raises(sinew.RunError) as expected:
        other = sim.clone()
        other.body(next(iter(other.bodies))).external_forces[:] = 1e9
        other.step(3)
    batch[1].body(next(iter(sim.bodies))).external_forces[:] = 1e9
    failures = batch.step(3)
    assert failures[0] is None and failures[2] is None and batch[0].steps == batch[2].steps == 3
    assert isinstance(failures[1], sinew.RunError) and str(failures[1]) == str(expected.value) and batch[1].steps == other.steps
    batch[1].body(next(iter(sim.bodies))).external_forces[:] = np.nan
    with pytest.raises(sinew.Error) as caught:
        batch.step()
    assert caught.value.kind == "not-finite"


def test_what_is_refused(scene):
    sim = sinew.loads(ARM)
    for make, kind in (
        (lambda: sinew.Batch([]), "empty-list"),
        (lambda: sinew.Batch([sim, sim]), "bad-argument"),
        (lambda: sinew.Batch([sim], threads=0), "out-of-range"),
        (lambda: sinew.Batch([sim])[1], "index-out-of-range"),
        (lambda: sinew.Batch([sim]).step(-1), "out-of-range"),
        (lambda: sinew.Batch([sim]).step(1, [True, False]), "wrong-shape"),
        (lambda: sinew.Batch([sim]).step(1, [1]), "wrong-shape"),
        (lambda: sinew.Batch([sim]).command("torque", np.zeros((2, 2))), "wrong-shape"),
        (lambda: sinew.Batch([sim]).command("torque", np.zeros((1, 3))), "wrong-shape"),
        (lambda: sinew.Batch([sim]).command("torque", [[0.0, np.nan]]), "not-finite"),
        (lambda: sinew.Batch([sim]).command("tension", np.zeros((1, 2))), "wrong-actuator-type"),
        (lambda: sinew.Batch([sinew.load(scene)]).command("tension", -np.ones((1, len(sinew.load(scene).actuators)))), "out-of-range"),
        (lambda: sinew.Batch([sim]).read(["tip.positoin"]), "unknown-name"),
    ):
        with pytest.raises(sinew.Error) as caught:
            make()
        assert caught.value.kind == kind
    assert sim.steps == 0


def test_many_arms_by_themselves_are_each_alone():
    arm = pcc.published_arm()
    random = np.random.default_rng(3)
    theta, rate = random.uniform(-0.5, 0.5, (2, 5, 4))
    torque = random.uniform(-0.05, 0.05, (5, 60, arm.simulate(theta[0], rate[0], np.zeros((0, 4)))[0].shape[1]))
    runs = [arm.simulate(theta, rate, torque, threads=threads) for threads in (1, 2, 8)]
    for angles, rates in runs:
        assert angles.shape == rates.shape == (5, 61, 4)
        for k in range(5):
            one = arm.simulate(theta[k], rate[k], torque[k])
            assert angles[k].tobytes() == one[0].tobytes() and rates[k].tobytes() == one[1].tobytes()
    same_start = arm.simulate(theta[0], rate[0], torque)[0]
    assert np.all(same_start[:, 0] == theta[0]) and same_start[0].tobytes() == runs[0][0][0].tobytes()
    for bad, kind in (((theta[:2], rate, torque), "wrong-shape"), ((theta, rate, torque[..., :3]), "wrong-shape"),
                      ((theta, rate, torque[0, 0]), "wrong-shape")):  # fmt: skip
        with pytest.raises(sinew.Error) as caught:
            arm.simulate(*bad)
        assert caught.value.kind == kind
    with pytest.raises(sinew.RunError, match="N m"):
        arm.simulate(theta, rate, 1e12 * torque, threads=2)
