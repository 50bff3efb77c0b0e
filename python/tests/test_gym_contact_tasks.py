"""Tasks with contact: behaviour of grasp and crawler, and returns of their experts."""

import numpy as np
import pytest
import sinew
import sinew.gym
from sinew.gym.scenes import crawler
from sinew.gym.tasks.crawl import PERIOD, gait


def play(env, policy, steps, seed=0, **reset):
    """Resets and steps with a policy. Returns the sum of rewards, all observations and the last info."""
    seen, total = [env.reset(seed=seed, **reset)[0]], 0.0
    for _ in range(steps):
        observation, reward, terminated, _, info = env.step(policy(seen[-1]))
        seen.append(observation)
        total += reward
        if terminated:
            break
    return total, np.array(seen), info


# Grasp


@pytest.fixture(scope="module")
def lifted():
    """The expert lifts the cup by 30 mm and holds it for a second."""
    env = sinew.gym.make("grasp")
    return env, *play(env, sinew.gym.expert(env), env.task.episode_steps, options={"height": 0.030})


def test_the_script_lifts_the_cup(lifted):
    env, total, seen, info = lifted
    assert len(seen) == 151 and info["success"] and total > 90.0
    assert info["height"] == pytest.approx(0.030, abs=0.2e-3) and info["tilt"] < np.radians(1.0)
    weight = 9.81 * env.episode.robot.sim.body("cup").mass
    assert 0.2 * seen[-1, 18:21].sum() == pytest.approx(weight, rel=1e-3)  # the fingers carry the cup
    assert env.episode.robot.sim.contact("table").normal_force == 0.0
    assert np.abs(seen[-1, 10:13]).max() < 1e-3  # at rest to within 0.1 mm/s


def test_the_grip_is_that_of_the_finer_example(lifted):
    _, _, seen, _ = lifted
    assert 0.5 * seen[-1, 15:18] == pytest.approx([0.41, 0.40, 0.40], rel=0.05)  # docs/grasping.md
    assert 10.0 * seen[-1, 3:6] == pytest.approx([7.1, 7.1, 7.1], rel=0.03)


def test_without_closing_the_cup_stays():
    env = sinew.gym.make("grasp")
    total, seen, info = play(env, lambda seen: np.array([0.0, 0.0, 0.0, 1.0]), 40)
    assert abs(info["height"]) < 0.1e-3 and not info["success"] and abs(total) < 0.5
    assert seen[-1, 6] == pytest.approx(40 * 1.2 / 50.0) and not seen[-1, 15:21].any()


def test_a_cup_that_is_let_go_ends_the_episode(lifted):
    env = sinew.gym.make("grasp", time_limit=10.0)
    script = sinew.gym.expert(env)
    released = lambda seen: script() if env.episode.steps < 85 else np.array([-1.0, -1.0, -1.0, 0.0])  # noqa: E731
    _, seen, info = play(env, released, 150, options={"height": 0.030})
    assert len(seen) < 150 and not info["success"] and seen[80, 9] > 0.2
    with pytest.raises(sinew.Error, match="not-reset"):
        env.step(np.zeros(4))


def test_the_height_of_the_feet_keeps_its_rate():
    env = sinew.gym.make("grasp", action="displacement")
    _, seen, _ = play(env, lambda seen: np.ones(4), 2)
    assert 50.0 * seen[:, 6] == pytest.approx([0.0, 1.2, 2.4])  # mm, at 60 mm/s
    assert 10.0 * seen[:, 0] == pytest.approx([0.0, 0.4, 0.8], abs=1e-3)  # mm, at 20 mm/s, the limit of the cable


def test_heights_by_options():
    envs = sinew.gym.make_vec("grasp", 2)
    envs.reset(seed=0, options={"height": [0.02, 0.05]})
    assert [episode.memory["height"] for episode in envs.episodes] == [0.02, 0.05]
    envs.reset(options={"height": 0.03})
    assert [episode.memory["height"] for episode in envs.episodes] == [0.03, 0.03]
    for bad in (0.2, "high", np.nan):
        with pytest.raises(sinew.Error) as caught:
            envs.reset(options={"height": bad})
        assert caught.value.kind == "out-of-range" and "0.075 m" in str(caught.value)


def test_the_success_of_the_script_over_heights_friction_and_payload():
    envs = sinew.gym.make_vec("grasp", 4, friction=(0.5, 0.8), payload=(0.0, 0.01), material_scale=(0.8, 1.25), models=4)
    policy = sinew.gym.expert(envs)
    _, drawn = envs.reset(seed=10)
    assert np.ptp(drawn["friction"]) > 0.1 and drawn["friction"].min() > 0.5
    for _ in range(envs.task.episode_steps):
        *_, terminations, truncations, infos = envs.step(policy())
        assert not terminations.any()
    assert truncations.all() and infos["success"].all()


# Crawl


@pytest.fixture(scope="module")
def crawled():
    """Two cycles of the gait from rest."""
    env = sinew.gym.make("crawl")
    return env, *from_rest(env, sinew.gym.expert(env), 100)


def from_rest(env, policy, steps):
    """Like play(), from the initial state with empty chambers."""
    env.episode._models[0].starts[1:] = []
    return play(env, policy, steps)


def test_the_gait_moves_the_crawler_forward(crawled):
    env, total, seen, info = crawled
    forward = 50.0 * seen[:, 10]  # mm
    assert forward[50] == pytest.approx(12.1, rel=0.05) and forward[100] == pytest.approx(24.2, rel=0.05)
    assert abs(info["drift"]) < 1e-3 and abs(info["heading"]) < 0.05
    effort = np.diff(seen[:, :5] * env.task.high, axis=0) / env.task.increment
    drift = 50.0 * abs(seen[-1, 11]) / 2.0
    assert total == pytest.approx(forward[-1] - drift - 0.01 * np.mean(effort**2, axis=1).sum(), abs=0.01)
    assert seen[:, 17:21].sum(axis=1).max() < 1.3 and seen[0, 17:21].min() > 0.05  # all feet carry some of the weight


def test_the_expert_of_the_crawler_succeeds():
    env = sinew.gym.make("crawl")
    total, seen, info = play(env, sinew.gym.expert(env), env.task.episode_steps, seed=3)
    assert len(seen) == 151 and info["success"] and total > 30.0


def test_without_pressure_the_crawler_stays():
    env = sinew.gym.make("crawl")
    _, seen, info = from_rest(env, lambda seen: np.zeros(5), 10)
    assert abs(info["distance"]) < 0.05e-3 and abs(info["drift"]) < 0.05e-3 and not seen[:, :5].any()


def test_friction_moves_the_crawler():
    env = sinew.gym.make("crawl", friction=0.0)
    _, seen, info = from_rest(env, sinew.gym.expert(env), 50)
    assert abs(info["distance"]) < 0.1e-3 and np.max(seen[:, :3]) == pytest.approx(1.0)


def test_the_gait_repeats_and_empties():
    shares = np.array([gait(time) for time in np.linspace(0.0, PERIOD, 101)])
    assert shares.min() == 0.0 and shares.max() == 1.0 and not shares[0].any() and not shares[-1].any()
    assert np.array_equal(gait(0.7), gait(0.7)) and gait(0.7) == pytest.approx(gait(0.7 + PERIOD))
    assert np.argmax(shares[:, 0] > 0.5) < np.argmax(shares[:, 2] > 0.5) < np.argmax(shares[:, 4] > 0.5)


def test_the_mesh_of_the_crawler_is_symmetric():
    solid, chamber, edges = crawler.cells()
    assert np.array_equal(solid, solid[::-1]) and np.array_equal(solid, solid[:, ::-1])
    for axis in (0, 1):
        assert edges[axis] == pytest.approx(-edges[axis][::-1])
    assert [np.count_nonzero(chamber == k) for k in range(1, 6)] == [2, 2, 10, 2, 2]


# Both


@pytest.mark.parametrize("name", ["grasp", "crawl"])
def test_states_go_on_bit_for_bit(name):
    """Including the height of the feet, which is not an actuator."""
    env = sinew.gym.make(name)
    script = sinew.gym.expert(env)
    play(env, lambda seen: script(), 12)
    task, episode = env.task, env.episode
    sim, twin = episode.robot.sim, episode.robot.sim.clone()
    before, commands = sim.state(), episode.commands.copy()
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (4, len(commands)))
    for action in actions:
        episode.step(action)
    after = sim.state()
    sim.restore(before)
    episode.commands = commands.copy()
    for action in actions:
        episode.step(action)
    assert sim.state() == after != before
    episode.robot.sim, episode.commands = twin, commands.copy()
    episode.robot.actuators = list(twin.actuators.values())
    episode.robot.body = next(iter(twin.bodies.values()))
    for action in actions:
        episode.step(action)
    assert twin.state() == after
    assert task.commanded(episode.robot)[:3] == pytest.approx(episode.commands[:3])


def test_errors_of_making():
    for make, kind, words in (
        (lambda: sinew.gym.make("grasp", friction=(0.5, 3.0)), "out-of-range", "0 <= low <= high <= 2"),
        (lambda: sinew.gym.make("grasp", frction=0.5), "unknown-name", "did you mean 'friction'"),
        (lambda: sinew.gym.make("crawl", friction="rough"), "wrong-type", "'rough'"),
        (lambda: sinew.gym.expert(sinew.gym.make("crawl", action="pressure")), "bad-argument", "pressure-increment"),
    ):
        with pytest.raises(sinew.Error) as caught:
            make()
        assert caught.value.kind == kind and words in str(caught.value)
