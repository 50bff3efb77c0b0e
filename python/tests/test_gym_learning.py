"""The learner of examples/gym: a few small generations improve the policy, and a seed reproduces the numbers."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
import sinew.gym

EXAMPLE = Path(__file__).parents[2] / "examples" / "gym" / "learn.py"
TESTS = 3


@pytest.fixture
def learn(monkeypatch):
    """The example with eight policies per generation and one episode of ten steps each."""
    spec = importlib.util.spec_from_file_location("learn", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "POPULATION", 8)
    monkeypatch.setattr(module, "ELITES", 2)
    for options in module.TASKS.values():
        options.update(episodes=1, time_limit=0.1, tests=TESTS, test_time=0.1)
    return module


@pytest.mark.filterwarnings("ignore::sinew.SinewWarning")
@pytest.mark.parametrize("task, share", [("trunk-reach", 0.6), ("trunk-damp", 0.85)])
def test_three_generations_improve(learn, task, share):
    curve, weights = learn.learn(task, 0, 3, 1)
    assert curve.shape == (3, 3) and np.all(curve[:, 1] >= curve[:, 0]) and np.all(curve[:, 1] >= curve[:, 2])
    envs = sinew.gym.make_vec(task, TESTS, time_limit=0.1)
    seeds = [2**31 + i for i in range(TESTS)]  # held out: training draws smaller seeds
    passive, learned = (learn.returns(task, envs, seeds, np.broadcast_to(w, (TESTS, *w.shape)))[0].sum() for w in (0.0 * weights, weights))
    assert share * passive < learned < 0.0
    judged = learn.judge(task, weights, 1)
    assert judged in (0.0, 1 / 3, 2 / 3, 1.0) if task == "trunk-reach" else judged == learned / passive


@pytest.mark.filterwarnings("ignore::sinew.SinewWarning")
def test_a_seed_gives_the_same_numbers_for_any_number_of_threads(learn):
    curve, weights = learn.learn("trunk-reach", 1, 2, 1)
    again, same_weights = learn.learn("trunk-reach", 1, 2, 2)
    assert again.tobytes() == curve.tobytes() and same_weights.tobytes() == weights.tobytes()
    assert not np.any(learn.learn("trunk-reach", 2, 2, 1)[1] == weights)


def test_features_turn_with_the_trunk(learn):
    seen = np.random.default_rng(0).normal(size=(5, 22))
    turned = seen.copy()  # a quarter turn from x to y
    turned[:, 19], turned[:, 20] = -seen[:, 20], seen[:, 19]
    sides = learn.features("trunk-reach", seen)
    np.testing.assert_allclose(learn.features("trunk-reach", turned), np.roll(sides, 1, axis=1), atol=1e-15)
