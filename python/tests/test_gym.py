"""Learning environments: Gymnasium's rules, bit-identical results for any number of environments and threads, solvable tasks."""

import functools
import importlib.util
import subprocess
import sys
import textwrap
import urllib.request
from pathlib import Path

import numpy as np
import pytest
import sinew
import sinew.gym
from sinew.gym import spaces
from sinew.gym.models import Models
from sinew.gym.task import Task
from sinew.gym.tasks.trunk_damp import TrunkDamp

NAMES = list(sinew.gym.tasks())
SHORT = 0.05  # s, five steps of a trunk task


def actions_of(envs, steps, seed=0):
    """Random actions (steps, num_envs, size), with a separate random stream for each environment."""
    size = envs.single_action_space.shape[0]
    streams = [np.random.default_rng([seed, i]).uniform(-1.0, 1.0, (steps, size)) for i in range(envs.num_envs)]
    return np.stack(streams, axis=1)


def same(first, second):
    """Whether two results, with nested dicts and tuples, are equal; arrays bit for bit."""
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[k], second[k]) for k in first)
    if isinstance(first, (tuple, list)):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, np.ndarray) and first.dtype == object:
        return first.shape == second.shape and all(map(same, first, second))
    if isinstance(first, np.ndarray):
        return first.dtype == second.dtype and first.shape == second.shape and first.tobytes() == second.tobytes()
    return first is second or first == second


# Gymnasium's rules


@pytest.mark.parametrize("name", NAMES)
def test_rules_of_a_single_environment(name):
    env = sinew.gym.make(name, time_limit=SHORT)
    for space in (env.action_space, env.observation_space):
        assert isinstance(space, sinew.gym.Box) and space.dtype == np.float32 and len(space.shape) == 1
    assert np.all(env.action_space.low == -1.0) and np.all(env.action_space.high == 1.0)
    first, info = env.reset(seed=123)
    after_first = env._np_random.bit_generator.state
    assert first.dtype == np.float32 and first in env.observation_space and isinstance(info, dict)
    again, _ = env.reset(seed=123)
    assert same(first, again) and env._np_random.bit_generator.state == after_first
    env.reset(seed=456)
    assert env._np_random.bit_generator.state != after_first
    env.reset(options={})
    env.action_space.seed(7)
    for step in range(env.task.episode_steps):
        result = env.step(env.action_space.sample())
        assert len(result) == 5
        observation, reward, terminated, truncated, info = result
        assert observation in env.observation_space and np.isfinite(observation).all()
        assert type(reward) is float and type(terminated) is bool and type(truncated) is bool and isinstance(info, dict)
        assert truncated == (step == env.task.episode_steps - 1) and not terminated
    assert env.unwrapped is env and env.metadata["render_modes"] == ["rgb_array", "human"] and env.render() is None
    env.close()
    env.close()


@pytest.mark.parametrize("name", NAMES)
def test_rules_of_many_environments(name):
    with sinew.gym.make_vec(name, 3, threads=2, time_limit=SHORT) as envs:
        assert envs.num_envs == 3 and envs.metadata["autoreset_mode"] is sinew.gym.AutoresetMode.NEXT_STEP
        assert envs.observation_space.shape == (3, *envs.single_observation_space.shape)
        assert envs.action_space.shape == (3, *envs.single_action_space.shape)
        observations, infos = envs.reset(seed=5)
        assert observations in envs.observation_space and isinstance(infos, dict)
        kept = observations.copy()
        envs.action_space.seed(1)
        observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())
        assert same(envs.reset(seed=5)[0], kept)
        assert observations in envs.observation_space
        assert rewards.shape == terminations.shape == truncations.shape == (3,)
        assert rewards.dtype == np.float64 and terminations.dtype == truncations.dtype == bool
        for key, values in infos.items():
            assert len(values) == 3 and (key.startswith("_") or infos[f"_{key}"].all())


def test_observations_are_copies():
    envs = sinew.gym.make_vec("trunk-reach", 2)
    first, _ = envs.reset(seed=0)
    kept = first.copy()
    second = envs.step(np.ones((2, 8)))[0]
    assert same(first, kept) and not same(first, second)
    second[:] = np.nan
    assert np.isfinite(envs.step(np.ones((2, 8)))[0]).all()


def test_names_of_observations_fit():
    for name in NAMES:
        for observe in ("sensors", "state"):
            env = sinew.gym.make(name, observe=observe)
            assert len(env.task.observation_names(env.episode.model.first)) == env.observation_space.shape[0]
    arm = sinew.gym.make("arm-swing-up")
    assert arm.task.observation_names(arm.episode.model.first)[0] == "angle 0 / 1 rad"


def test_spaces_of_our_own():
    box = spaces.PlainBox([-1.0, 0.0, -np.inf, -np.inf], [1.0, np.inf, 2.0, np.inf])
    assert box.shape == (4,) and box.dtype == np.float32
    assert box.seed(3) == 3
    drawn = [box.sample() for _ in range(50)]
    assert all(x in box and x.dtype == np.float32 for x in drawn)
    box.seed(3)
    assert same(drawn, [box.sample() for _ in range(50)])
    assert np.ptp([x[0] for x in drawn]) > 1.0 and np.std([x[3] for x in drawn]) > 0.5
    assert [0.0, 1.0] not in box
    assert np.array([2.0, 0.0, 0.0, 0.0], dtype=np.float32) not in box
    assert np.array([np.nan, 0.0, 0.0, 0.0], dtype=np.float32) not in box
    assert np.zeros(4) not in box  # float64 does not cast safely
    assert not box.is_bounded() and spaces.PlainBox(-1.0, 1.0, (2,)).is_bounded("both")
    assert spaces.PlainBox(-1.0, 1.0, (2,)) == spaces.PlainBox([-1.0, -1.0], 1.0) != spaces.PlainBox(-1.0, 1.0, (3,))
    for bad in (dict(low=1.0, high=0.0), dict(low=np.nan, high=0.0)):
        with pytest.raises(sinew.Error, match="low <= high"):
            spaces.PlainBox(**bad)
    with pytest.raises(sinew.Error) as caught:
        spaces.PlainBox([0.0, 0.0], [1.0, 1.0, 1.0])
    assert caught.value.kind == "wrong-shape"


# Seeds and bits


def trajectory(envs, seed, steps=8):
    """All results of a reset and some steps, past the end of an episode."""
    return [envs.reset(seed=seed)] + [envs.step(a) for a in actions_of(envs, steps)]


@pytest.mark.parametrize("name", NAMES)
def test_the_same_bits_for_any_number_of_threads(name):
    options = dict(time_limit=SHORT, material_scale=(0.8, 1.25), payload=(0.0, 0.01), models=2, action_delay=(0, 2))
    runs = [trajectory(sinew.gym.make_vec(name, 4, threads=threads, **options), 11) for threads in (1, 2, 3)]
    assert same(runs[0], runs[1]) and same(runs[0], runs[2])


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
def test_an_environment_is_the_same_alone_and_among_others(mode):
    options = dict(time_limit=SHORT, autoreset_mode=mode, material_scale=(0.8, 1.25), models=2)
    among = sinew.gym.make_vec("trunk-hold", 3, threads=2, **options)
    alone = sinew.gym.make_vec("trunk-hold", 1, **options)
    steps = actions_of(among, 12)
    first, second = [among.reset(seed=20)[0][2]], [alone.reset(seed=22)[0][0]]
    for a in steps:
        first.append([part[2] for part in among.step(a)[:4]])
        second.append([part[0] for part in alone.step(a[2:])[:4]])
    assert same(first, second)


@pytest.mark.parametrize("name", NAMES)
def test_the_single_environment_is_environment_0(name):
    env, envs = sinew.gym.make(name, time_limit=SHORT), sinew.gym.make_vec(name, 2, autoreset_mode="DISABLED", time_limit=SHORT)
    assert same(env.reset(seed=4)[0], envs.reset(seed=4)[0][0])
    for a in actions_of(envs, env.task.episode_steps):
        one, many = env.step(a[0]), envs.step(a)
        assert same(one[0], many[0][0]) and one[1:4] == tuple(part[0] for part in many[1:4])
        assert one[4] == {key: many[4][key][0] for key in one[4]}


def test_seeds():
    envs = sinew.gym.make_vec("trunk-reach", 3)
    goals = lambda **seed: envs.reset(**seed)[0][:, 19:].copy()  # noqa: E731
    first = goals(seed=8)
    assert same(first, goals(seed=[8, 9, 10])) and same(first[1:], goals(seed=[1, 9, 10])[1:])
    continued = goals()
    assert not np.any(continued == first)
    envs.reset(seed=[1, 9, 10])
    assert same(continued, goals())
    mixed = goals(seed=[None, 9, None])
    assert same(mixed[1], first[1]) and not np.any(mixed[0] == first[0])
    assert not np.any(sinew.gym.make_vec("trunk-reach", 1).reset()[0][:, 19:] == sinew.gym.make_vec("trunk-reach", 1).reset()[0][:, 19:])


# End of an episode, with a limit of 2 steps


def short(mode, count=2):
    envs = sinew.gym.make_vec("trunk-reach", count, time_limit=0.02, autoreset_mode=mode)
    return envs, envs.reset(seed=1)[0], actions_of(envs, 6)


def by_hand(seed, resets, actions):
    """Results of single environments: a list with one entry per reset (None) or action."""
    env = sinew.gym.make("trunk-reach", time_limit=0.02)
    out = []
    for k, a in enumerate(actions):
        out.append(env.reset(seed=seed if k == 0 else None)[0] if a is None else env.step(a))
    return out


def test_next_step_resets_a_step_later():
    envs, first, a = short("NEXT_STEP")
    hand = by_hand(1, None, [None, a[0, 0], a[1, 0], None, a[3, 0]])
    assert same(first[0], hand[0])
    results = [envs.step(actions) for actions in a[:4]]
    for result, (observation, reward, _, truncated, info) in zip(results[:2], hand[1:3]):
        assert same(result[0][0], observation) and result[1][0] == reward and result[3][0] == truncated
    assert results[1][3].all() and "final_obs" not in results[1][4]
    observations, rewards, terminations, truncations, infos = results[2]  # the step resets, so a[2] does not matter
    assert same(observations[0], hand[3])
    assert not rewards.any() and not terminations.any() and not truncations.any() and infos == {}
    assert same(results[3][0][0], hand[4][0]) and results[3][1][0] == hand[4][1]


def test_same_step_resets_at_once():
    envs, _, a = short("SAME_STEP")
    hand = by_hand(1, None, [None, a[0, 0], a[1, 0], None, a[2, 0]])
    assert "final_obs" not in envs.step(a[0])[4]
    observations, rewards, _, truncations, infos = envs.step(a[1])
    assert truncations.all() and same(observations[0], hand[3]) and rewards[0] == hand[2][1]
    assert infos["final_obs"].dtype == object and infos["_final_obs"].all() and same(infos["final_obs"][0], hand[2][0])
    assert infos["_final_info"].all() and infos["final_info"]["distance"][0] == hand[2][4]["distance"]
    assert infos["final_info"]["_distance"].all() and "distance" not in infos
    observations, rewards, _, truncations, infos = envs.step(a[2])
    assert same(observations[0], hand[4][0]) and rewards[0] == hand[4][1] and not truncations.any() and "final_obs" not in infos


def test_disabled_waits_for_a_reset_with_a_mask():
    envs, _, a = short("DISABLED", 3)
    envs.step(a[0])
    last = envs.step(a[1])
    assert last[3].all()
    with pytest.raises(sinew.Error, match="0, 1, 2") as caught:
        envs.step(a[2])
    assert caught.value.kind == "not-reset"
    observations, infos = envs.reset(options={"reset_mask": np.array([False, True, True])})
    assert same(observations[0], last[0][0]) and not np.any(observations[1:, 19:] == last[0][1:, 19:]) and infos == {}
    with pytest.raises(sinew.Error, match="begun an episode: 0;"):
        envs.step(a[2])
    envs.reset(seed=[1, None, None], options={"reset_mask": np.array([True, False, False])})
    hand = by_hand(1, None, [None, a[2, 0]])
    assert same(envs.step(a[2])[0][0], hand[1][0])


def test_a_mask_in_the_midst_of_episodes():
    envs, _, a = short("NEXT_STEP")
    envs.step(a[0])
    envs.reset(seed=[1, None], options={"reset_mask": np.array([True, False])})
    assert envs.step(a[1])[3].tolist() == [False, True]
    observations, rewards, *_, infos = envs.step(a[2])
    assert rewards[0] != 0.0 and rewards[1] == 0.0 and infos["_distance"].tolist() == [True, False]
    assert same(observations[0], by_hand(1, None, [None, a[1, 0], a[2, 0]])[2][0])


def test_a_run_that_cannot_go_on_is_truncated(monkeypatch):
    envs = sinew.gym.make_vec("trunk-reach", 2, time_limit=SHORT)
    before, _ = envs.reset(seed=0)

    class Stuck:
        def __init__(self, sim):
            self.sim = sim

        def step(self, n):
            raise sinew.RunError("not-converged", "step", "the step does not converge", "")

        def __getattr__(self, name):
            return getattr(self.sim, name)

    robot = envs.episodes[1].robot
    monkeypatch.setattr(robot, "sim", Stuck(robot.sim))
    observations, rewards, terminations, truncations, infos = envs.step(np.zeros((2, 8)))
    assert truncations.tolist() == [False, True] and not terminations.any() and rewards[1] == -100.0
    assert "does not converge" in infos["failure"][1] and infos["_failure"].tolist() == [False, True]
    assert same(observations[1], before[1])


class Inflate(Task):
    """Inflates a balloon: a tube whose pressure has a peak of 10 kPa."""

    name = "inflate"
    actions = ("pressure-increment", "pressure")
    default_time_limit = 1.0

    def described(self, folder):
        return {
            "sinew": 1, "time_step": 0.05,
            "bodies": {"tube": {
                "type": "fem", "element": "hex8", "density": 1000.0, "fixed": [{"set": "bottom"}, {"set": "top"}],
                "mesh": {"shape": "hollow-cylinder", "inner_radius": 0.01, "outer_radius": 0.013, "height": 0.03, "element_size": 0.005},
                "material": {"model": "neo-hookean", "young_modulus": 90e3, "poisson_ratio": 0.45}}},
            "actuators": {"air": {"type": "chamber", "body": "tube", "surface": {"set": "inner"}, "cap": True,
                                  "limits": {"pressure": {"min": 0.0, "max": 60e3, "rate": 96e3}}}}}

    def randomised(self, material_scale, payload):
        return {}

    def measure_rest(self, robot):
        return {}

    def observation_names(self, robot):
        return ["pressure / 10 kPa", "growth / 1 ml"]

    def sense(self, episode, out):
        air = episode.robot.actuators[0]
        out[:] = air.pressure / 1e4, air.volume_growth / 1e-6

    def reward(self, episode):
        return episode.robot.actuators[0].volume_growth / 1e-6, False, {}


class InflateMany(Inflate):
    """The same, for all environments at once."""

    name = "inflate-many"
    observables = ("air.pressure", "air.volume_growth")
    sense, reward = Task.sense, Task.reward

    def sense_rows(self, episodes, read, out):
        out[:] = read / [1e4, 1e-6]

    def reward_rows(self, episodes, read, actions):
        return read[:, 1] / 1e-6, np.zeros(len(read), bool), {}


@pytest.mark.parametrize("task", [Inflate, InflateMany])
def test_an_episode_that_inflates_a_chamber_past_its_peak_is_truncated(task):
    """The reason is in info, the observation is that of the last solved state, and the next episode begins at rest."""
    env = sinew.gym.make(task())
    ends = []
    for _ in range(2):
        first, _ = env.reset(seed=0)
        assert np.abs(first).max() < 1e-12
        for steps in range(1, 21):
            before = first
            first, reward, terminated, truncated, info = env.step(np.ones(1, np.float32))
            assert not terminated
            if truncated:
                break
            assert "failure" not in info and "flagged" not in info
            assert first[0] == pytest.approx(0.48 * steps, rel=1e-6) and reward == pytest.approx(first[1], rel=1e-6) and reward > before[1]
        assert truncated and steps < 20, "before the time limit"
        assert "chamber 'air' has no equilibrium" in info["failure"] and "limit point" in info["failure"] and "volume_growth" in info["failure"]
        assert reward == -100.0 and np.array_equal(first, before) and first[1] < 100
        ends.append((steps, first.tobytes()))
    assert ends[0] == ends[1]
    # Of two environments, only the one that fails ends.
    envs = sinew.gym.make_vec(task(), 2)
    envs.reset(seed=0)
    for _ in range(ends[0][0] - 1):
        *_, truncations, infos = envs.step(np.array([[1.0], [0.1]]))
        assert not truncations.any()
    observations, rewards, terminations, truncations, infos = envs.step(np.array([[1.0], [0.1]]))
    assert truncations.tolist() == [True, False] and not terminations.any() and rewards[0] == -100.0 and rewards[1] > 0
    assert "limit point" in infos["failure"][0] and infos["_failure"].tolist() == [True, False]
    assert observations[0].tobytes() == ends[0][1]
    observations, rewards, *_ = envs.step(np.array([[1.0], [0.1]]))
    assert np.abs(observations[0]).max() < 1e-12 and rewards[1] > 0, "it begins anew"


def test_environments_hold_no_factor_between_steps():
    for name in ("trunk-reach", "trunk-damp"):
        envs = sinew.gym.make_vec(name, 3, threads=2)
        with pytest.raises(sinew.Error, match="reset"):
            envs.memory
        envs.reset(seed=0)
        envs.step(np.zeros((3, 8)))
        assert envs.memory < 2.0e6  # bytes, the size of the trunk's factor alone


# Simulations that are stepped by one call


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP", "DISABLED"])
def test_one_call_for_all_is_one_call_each(mode):
    options = dict(time_limit=0.06, autoreset_mode=mode, material_scale=(0.8, 1.25), payload=(0.0, 0.01), models=2, action_delay=(0, 2))
    together, each = (sinew.gym.make_vec("arm-swing-up", 4, threads=2, **options) for _ in range(2))
    assert together._together is not None
    each._together = None
    assert same(together.reset(seed=3), each.reset(seed=3))
    for k, a in enumerate(actions_of(together, 9)):
        if mode == "DISABLED" and k == 2:  # the other environments continue
            mask = {"reset_mask": np.array([False, True, False, True])}
            assert same(together.reset(options=mask), each.reset(options=mask))
        if mode == "DISABLED" and each._ended.any():
            mask = {"reset_mask": each._ended.copy()}
            assert same(together.reset(options=mask), each.reset(options=mask))
        assert same(together.step(a), each.step(a))
        for one, other in zip(together.episodes, each.episodes):
            assert one.steps == other.steps and same(one.commands, other.commands) and same(one.action, other.action)
            assert one.memory == other.memory and one.robot.sim.state_hash == other.robot.sim.state_hash


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
def test_one_call_for_all_tells_which_failed(mode):
    huge = {"actuators.fourth.limits.torque": {"min": -1e7, "max": 0.18}}
    together, each = (sinew.gym.make_vec("arm-swing-up", 3, autoreset_mode=mode, set=huge) for _ in range(2))
    each._together = None
    assert same(together.reset(seed=0), each.reset(seed=0))
    a = np.ones((3, 3))
    a[1] = -1.0
    for step in range(3):
        one, other = together.step(a), each.step(a)
        assert same(one, other)
        if step == 0:
            infos = one[4] if mode == "NEXT_STEP" else one[4]["final_info"]
            assert one[3].tolist() == [False, True, False] and not one[2].any() and one[1][1] == -100.0 and "Newton" in infos["failure"][1]


# Tasks


def test_actions_go_to_the_limits():
    envs = sinew.gym.make_vec("trunk-reach", 1, action="tension", time_limit=0.2)
    envs.reset(seed=0)
    up = np.array([[1.0, -1.0, 0.0, -1.0, -1.0, -1.0, -1.0, -1.0]])
    for _ in range(10):
        observations = envs.step(up)[0]
    tensions = observations[0, 8:16]
    assert tensions[[0, 2]] == pytest.approx([1.0, 0.5], abs=1e-6) and np.all(tensions[[1, 3, 4]] == 0.0)
    beyond = sinew.gym.make_vec("trunk-reach", 1, action="tension", time_limit=0.2)
    beyond.reset(seed=0)
    for _ in range(10):
        clipped = beyond.step(100.0 * up)[0]
    assert same(clipped, observations)
    increments = sinew.gym.make("trunk-reach")
    increments.reset(seed=0)
    for k in range(3):
        seen = increments.step(np.full(8, 0.5))[0]
        assert seen[8:16] == pytest.approx((k + 1) * 0.5 / 8.0, abs=1e-6)  # N relative to 8 N: half of 100 N/s for 10 ms
    lengths = sinew.gym.make("trunk-reach", action="displacement-increment")
    start = lengths.reset(seed=0)[0]
    pulled = lengths.step(np.array([0.2, 0, 0, 0, 0, 0, 0, 0]))[0]
    assert pulled[0] - start[0] == pytest.approx(0.06, abs=1e-4)  # a fifth of 300 mm/s for 10 ms, relative to 10 mm


def test_the_delay_of_actions():
    late, prompt = (sinew.gym.make("trunk-reach", action_delay=delay) for delay in (2, 0))
    assert same(late.reset(seed=0)[0], prompt.reset(seed=0)[0])
    little = np.full(8, 0.1)  # an increment of 0.1 N per step
    acting = prompt.step(little)[0]
    assert acting[8:16] == pytest.approx(0.0125, abs=1e-6)
    for _ in range(2):
        assert np.all(late.step(little)[0][8:16] == 0.0)
    assert late.step(np.zeros(8))[0][8:16] == pytest.approx(acting[8:16], abs=1e-6)


def test_models_of_domain_randomisation():
    task = sinew.gym.make("trunk-reach", material_scale=(0.5, 2.0), payload=(0.0, 0.02), models=4).task
    models = Models(task)
    scales, payloads = np.array([(m.material_scale, m.payload) for m in models.all]).T
    assert np.all(np.diff(np.log(scales)) == pytest.approx(np.log(4.0) / 4)) and 0.5 < scales[0] < scales[-1] < 2.0
    assert np.unique(np.floor(payloads / 0.005)).size >= 3  # the payloads cover at least three quarters of their range
    assert all(m.first.sim.masses["payload"].mass == m.payload for m in models.all)
    stiff, soft = models[3].first, models[0].first
    for robot in (stiff, soft):
        robot.actuators[0].tension = 1.0
        robot.sim.solve_static()
    assert np.hypot(*stiff.tip.position[:2]) < 0.5 * np.hypot(*soft.tip.position[:2])
    envs = sinew.gym.make_vec("trunk-damp", 6, threads=2, material_scale=(0.8, 1.25), models=3, time_limit=0.02)
    envs.reset(seed=0)
    first = {id(episode.robot.sim) for episode in envs.episodes}
    for _ in range(12):
        envs.step(np.zeros((6, 8)))
    # The number of clones of a model depends on how the resets of the threads interleave; the limit is the number of environments.
    own = [len(model._free) + sum(episode.model is model for episode in envs.episodes) for model in envs.episodes[0]._models.all]
    assert len(first) == 6 and all(count <= 6 for count in own)


def test_a_simulation_that_others_have_used_is_as_new():
    options = dict(time_limit=0.02, material_scale=(0.8, 1.25), models=2)
    used, new = (sinew.gym.make_vec("trunk-hold", 2, **options) for _ in range(2))
    used.reset(seed=50)
    for _ in range(9):
        used.step(np.ones((2, 8)))
    assert same(trajectory(used, 3), trajectory(new, 3))


def test_goals_by_options():
    goal = [0.02, -0.01, 0.185]
    env = sinew.gym.make("trunk-reach")
    assert env.reset(seed=0, options={"goal": goal})[0][19:] == pytest.approx((goal - env.episode.robot.tip.position) / 0.1, abs=1e-6)
    envs = sinew.gym.make_vec("trunk-reach", 2)
    envs.reset(options={"goal": [goal, [0.0, 0.0, 0.19]]})
    assert envs.episodes[1].goal.tolist() == [0.0, 0.0, 0.19]


def test_rewards():
    envs = sinew.gym.make_vec("trunk-reach", 2)
    envs.reset(seed=0)
    observations, rewards, *_, infos = envs.step(np.zeros((2, 8)))
    assert 0.1 * np.linalg.norm(observations[:, 19:], axis=1) == pytest.approx(infos["distance"], rel=1e-6)
    assert rewards == pytest.approx(-infos["distance"] / 0.05)
    damp = sinew.gym.make("trunk-damp", time_limit=0.1)
    damp.reset(seed=0)
    for _ in range(8):
        _, reward, *_, info = damp.step(-np.ones(8))
    body = damp.episode.robot.body
    assert reward == pytest.approx(-1e3 * info["energy"]) and info["energy"] > 0.5 * body.kinetic_energy > 0.0


def test_the_expert_reaches_goals():
    envs = sinew.gym.make_vec("trunk-reach", 8, threads=2)
    policy = sinew.gym.expert(envs)
    observations, _ = envs.reset(seed=100)
    for _ in range(envs.task.episode_steps):
        observations, _, _, truncations, infos = envs.step(policy(observations))
    assert truncations.all() and infos["success"].all() and infos["distance"].max() < 2e-3


@pytest.mark.parametrize("name,close", [("trunk-follow", 1e-3), ("trunk-hold", 5e-3)])
def test_the_expert_follows_and_holds(name, close):
    env = sinew.gym.make(name, time_limit=0.6)
    policy = sinew.gym.expert(env)
    env.reset(seed=1)
    with_expert = [env.step(policy())[4]["distance"] for _ in range(env.task.episode_steps)]
    env.reset(seed=1)
    passive = [env.step(np.zeros(8))[4]["distance"] for _ in range(env.task.episode_steps)]
    assert np.mean(with_expert) < close and np.mean(with_expert) < 0.4 * np.mean(passive)


class SeenView:
    """Replaces the live view and records its calls."""

    def __init__(self, opened):
        self.opened = opened

    def __call__(self, sim, block):
        assert block is False
        self.opened.append([sim])
        self.calls = self.opened[-1]
        return self

    def __enter__(self):
        self.calls.append("enter")
        return self

    def update(self):
        self.calls.append("update")

    def __exit__(self, *_):
        self.calls.append("exit")


@pytest.mark.parametrize("many", [False, True])
def test_the_view_shows_environment_0_after_every_step(monkeypatch, many):
    opened = []
    monkeypatch.setattr(sinew._core, "view", SeenView(opened))
    options = dict(render_mode="human", time_limit=0.02)
    env = sinew.gym.make_vec("trunk-reach", 2, **options) if many else sinew.gym.make("trunk-reach", **options)
    assert env.render_mode == "human" and not opened
    env.reset(seed=0)
    first = (env.episodes[0] if many else env.episode).robot.sim
    actions = np.zeros(env.action_space.shape)
    for _ in range(2):
        env.step(actions)
    assert env.render() is None
    env.reset()
    assert opened == [[first, "enter", "update", "update", "update", "update"]]  # one view for all episodes
    env.close()
    env.close()
    assert opened[0][-1] == "exit" and opened[0].count("exit") == 1 and len(opened) == 1


def test_the_view_opens_anew_where_an_episode_has_another_robot(monkeypatch):
    opened = []
    monkeypatch.setattr(sinew._core, "view", SeenView(opened))
    env = sinew.gym.make("trunk-reach", render_mode="human", time_limit=0.01, material_scale=(0.8, 1.25), models=2)
    env.reset(seed=0)
    shown = [env.episode.robot.sim]
    while len(shown) < 2:
        env.step(np.zeros(8))
        env.reset()
        if env.episode.robot.sim is not shown[-1]:
            shown.append(env.episode.robot.sim)
    assert [calls[0] for calls in opened] == shown and opened[0][-1] == "exit" and opened[1][-1] == "update"
    env.close()


def test_the_real_view_serves_its_page_until_the_environment_is_closed(monkeypatch):
    real = sinew._core.view
    monkeypatch.setattr(sinew._core, "view", lambda sim, block: real(sim, block=block, open_browser=False))
    env = sinew.gym.make("trunk-reach", render_mode="human")
    env.reset(seed=0)
    address = env._picture._view.url
    with urllib.request.urlopen(address, timeout=10) as page:
        assert page.status == 200 and page.headers["Content-Type"].startswith("text/html")
    env.step(np.ones(8))
    env.close()
    with pytest.raises(OSError):
        urllib.request.urlopen(address, timeout=2)


def test_pictures():
    pytest.importorskip("moderngl")
    for name in ("trunk-reach", "arm-swing-up"):
        env = sinew.gym.make(name, render_mode="rgb_array")
        env.reset(seed=0)
        before = env.render()
        for _ in range(6):
            env.step(np.linspace(-1.0, 1.0, *env.action_space.shape))
        assert before.shape == (400, 400, 3) and before.dtype == np.uint8
        assert np.any(before != env.render()) and np.ptp(before) > 100
    frames = sinew.gym.make_vec("trunk-reach", 2, render_mode="rgb_array")
    frames.reset(options={"goal": [[0.03, 0.0, 0.19], [-0.03, 0.0, 0.19]]})
    first, second = (frame.astype(int) for frame in frames.render())
    goal = [(frame[..., 0] > frame[..., 2] + 100) & (frame[..., 1] < 110) for frame in (first, second)]  # the orange pixels of a goal
    assert goal[0].sum() > 10 and goal[1].sum() > 10 and not (goal[0] & goal[1]).any()


# Errors


class WithoutScript(TrunkDamp):
    """A task without an expert."""

    scripted = Task.scripted


@pytest.mark.parametrize("make,kind,words", [
    (lambda: sinew.gym.make("trunk-raech"), "unknown-name", "did you mean 'trunk-reach'"),
    (lambda: sinew.gym.make("trunk-reach", materialscale=1.0), "unknown-name", "did you mean 'material_scale'"),
    (lambda: sinew.gym.make("trunk-reach", action="tensoin"), "unknown-name", "did you mean 'tension'"),
    (lambda: sinew.gym.make("trunk-reach", observe="all"), "unknown-name", "sensors, state"),
    (lambda: sinew.gym.make("trunk-reach", render_mode="rgb"), "unknown-name", "rgb_array"),
    (lambda: sinew.gym.make("trunk-reach", material_scale=(2.0, 0.5)), "out-of-range", "(2, 0.5)"),
    (lambda: sinew.gym.make("trunk-reach", payload=1.0), "out-of-range", "0.05 kg"),
    (lambda: sinew.gym.make("trunk-reach", payload="heavy"), "wrong-type", "'heavy'"),
    (lambda: sinew.gym.make("trunk-reach", action_delay=0.5), "wrong-type", "0.5"),
    (lambda: sinew.gym.make("trunk-reach", models=0), "out-of-range", "1 to 64"),
    (lambda: sinew.gym.make("trunk-reach", time_limit=0.001), "out-of-range", "0.01 s"),
    (lambda: sinew.gym.make("trunk-hold", push=2.0), "out-of-range", "1 N"),
    (lambda: sinew.gym.make("trunk-reach", set={"gravty": 0}), "unknown-key", "gravity"),
    (lambda: sinew.gym.make_vec("trunk-reach", 0), "out-of-range", "1 or more"),
    (lambda: sinew.gym.make_vec("trunk-reach", 2, threads=0), "out-of-range", "threads"),
    (lambda: sinew.gym.make_vec("trunk-reach", 2, autoreset_mode="later"), "unknown-name", "NEXT_STEP, SAME_STEP, DISABLED"),
    (lambda: sinew.gym.expert(sinew.gym.make(WithoutScript())), "bad-argument", "no expert for trunk-damp"),
    (lambda: sinew.gym.expert(sinew.gym.make("trunk-reach", action="tension")), "bad-argument", "tension-increment"),
])  # fmt: skip
def test_errors_of_making(make, kind, words):
    with pytest.raises(sinew.Error) as caught:
        make()
    assert caught.value.kind == kind and words in str(caught.value)


@pytest.fixture(scope="module")
def pair():
    return sinew.gym.make_vec("trunk-reach", 2, threads=2)


def with_nan():
    actions = np.zeros((2, 8))
    actions[1, 3] = np.nan
    return actions


@pytest.mark.parametrize("use,kind,words", [
    (lambda envs: envs.step(np.zeros(8)), "wrong-shape", "(2, 8)"),
    (lambda envs: envs.step(np.zeros((3, 8))), "wrong-shape", "shape (3, 8)"),
    (lambda envs: envs.step(with_nan()), "not-finite", "[1, 3] is NaN"),
    (lambda envs: envs.step("left"), "wrong-type", "'left'"),
    (lambda envs: envs.reset(seed=[1]), "wrong-length", "1 seeds for 2"),
    (lambda envs: envs.reset(seed=-4), "out-of-range", "-4"),
    (lambda envs: envs.reset(seed=[1, 0.5]), "out-of-range", "0.5"),
    (lambda envs: envs.reset(options={"goals": 1}), "unknown-name", "did you mean 'goal'"),
    (lambda envs: envs.reset(options={"goal": [1.0]}), "wrong-shape", "three numbers"),
    (lambda envs: envs.reset(options={"goal": np.zeros((3, 3))}), "wrong-length", "3 rows for 2"),
    (lambda envs: envs.reset(options={"reset_mask": np.array([1, 0])}), "wrong-shape", "2 bools"),
    (lambda envs: envs.reset(options={"reset_mask": np.array([False, False])}), "out-of-range", "at least one"),
])  # fmt: skip
def test_errors_of_use(pair, use, kind, words):
    pair.reset(seed=0)
    with pytest.raises(sinew.Error) as caught:
        use(pair)
    assert caught.value.kind == kind and words in str(caught.value)
    pair.reset(seed=0)
    pair.step(np.zeros((2, 8)))


def test_errors_of_order():
    env, envs = sinew.gym.make("trunk-reach", time_limit=0.01), sinew.gym.make_vec("trunk-reach", 1)
    for use in (lambda: env.step(np.zeros(8)), lambda: envs.step(np.zeros((1, 8))), env.render, envs.render):
        with pytest.raises(sinew.Error) as caught:
            use()
        assert caught.value.kind == "not-reset"
    env.reset(seed=0)
    assert env.step(np.zeros(8))[3]
    with pytest.raises(sinew.Error, match="reset"):
        env.step(np.zeros(8))
    with pytest.raises(sinew.Error, match="not-finite"):
        env.step(np.full(8, np.nan))
    for each in (env, envs):
        each.close()
        with pytest.raises(sinew.Error, match="make a new one"):
            each.reset()


# Gymnasium itself

FAKE = {
    "__init__.py": """
        from . import spaces, vector
        from sinew_plain import PlainEnv as Env
        registered = {}
        def register(id, entry_point, vector_entry_point=None):
            registered[id] = entry_point, vector_entry_point
    """,
    "spaces.py": "from sinew_plain import PlainSpace as Space\nclass Box(Space):\n"
    "    def __init__(self, low, high, shape=None, dtype=None):\n        super().__init__(shape or low.shape, dtype)\n"
    "        self.low, self.high = (b + __import__('numpy').zeros(self.shape) for b in (low, high))",
    "vector.py": "from sinew_plain import PlainEnv as VectorEnv, PlainAutoresetMode as AutoresetMode",
}


def test_gymnasium_is_used_where_it_is(tmp_path):
    """Classes, registration and the registered environments, with a stand-in because Gymnasium may not be installed."""
    (tmp_path / "gymnasium").mkdir()
    for name, text in FAKE.items():
        (tmp_path / "gymnasium" / name).write_text(textwrap.dedent(text))
    plain = Path(spaces.__file__).read_text(encoding="utf-8").replace("from ..errors", "from sinew.errors")
    (tmp_path / "sinew_plain.py").write_text(plain.replace("import gymnasium", "raise ImportError", 1))
    script = """
        import sys, gymnasium, numpy as np, sinew, sinew.gym
        assert sinew.gym.Box is gymnasium.spaces.Box and sinew.gym.AutoresetMode is gymnasium.vector.AutoresetMode
        assert issubclass(sinew.gym.Env, gymnasium.Env) and issubclass(sinew.gym.VectorEnv, gymnasium.vector.VectorEnv)
        assert set(gymnasium.registered) == {"sinew/" + name for name in sinew.gym.tasks()}
        single, vector = gymnasium.registered["sinew/trunk-reach"]
        env = single(time_limit=0.02)
        env.reset(seed=0)
        print(env.step(np.zeros(8))[0].shape, vector(num_envs=3).reset()[0].shape)
    """
    path = [str(tmp_path), *sys.path]
    run = subprocess.run([sys.executable, "-c", f"import sys; sys.path[:0] = {path!r}\n" + textwrap.dedent(script)],
                         capture_output=True, text=True, check=False)  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip() == "(22,) (3, 22)"


@pytest.mark.parametrize("name", NAMES)
def test_gymnasiums_own_checker(name):
    checker = pytest.importorskip("gymnasium.utils.env_checker", reason="Gymnasium is not installed: its checker is restated above")
    checker.check_env(sinew.gym.make(name, time_limit=SHORT), skip_render_check=True)


MODES = ["NEXT_STEP", "SAME_STEP", "DISABLED"]
OF_TASK = {"arm-swing-up": 0.1, "grasp": 0.06, "crawl": 0.08}  # s, duration of an episode: two to five steps


def course(envs, seed, steps, mode):
    """Results of steps past the ends of episodes; with DISABLED, environment 0 is reset early, and ended ones are reset."""
    out = [envs.reset(seed=seed)]
    for k, actions in enumerate(actions_of(envs, steps)):
        out.append(envs.step(actions))
        if mode == "DISABLED":
            mask = out[-1][2] | out[-1][3]
            mask[0] |= k == 0
            if mask.any():
                out.append(envs.reset(options={"reset_mask": mask}))
    return out


class OneByOne:
    """Single environments stepped in a loop, by Gymnasium's rules for the autoreset modes (docs: API, Vector, Autoreset Mode)."""

    def __init__(self, envs, mode):
        self.envs, self.mode, self.num_envs, self.single_action_space = envs, mode, len(envs), envs[0].action_space
        self.seen, self.ended = [None] * len(envs), np.zeros(len(envs), dtype=bool)

    def reset(self, seed=None, options=None):
        mask = (options or {}).get("reset_mask", np.ones(self.num_envs, dtype=bool))
        infos = [{} for _ in self.envs]
        for i in np.flatnonzero(mask):
            self.seen[i], infos[i] = self.envs[i].reset(seed=None if seed is None else seed + int(i))
        self.ended[mask] = False
        return np.stack(self.seen), infos

    def step(self, actions):
        rows = []
        for i, env in enumerate(self.envs):
            if self.mode == "NEXT_STEP" and self.ended[i]:
                self.seen[i], info = env.reset()
                row = (0.0, False, False, info)
            else:
                self.seen[i], *row = env.step(actions[i])
                if self.mode == "SAME_STEP" and (row[1] or row[2]):
                    last = {"final_obs": self.seen[i], "final_info": row[3]}
                    self.seen[i], info = env.reset()
                    row[3] = {**info, **last}
            self.ended[i] = row[1] or row[2]
            rows.append(row)
        rewards, terminations, truncations, infos = zip(*rows)
        return np.stack(self.seen), np.array(rewards), np.array(terminations), np.array(truncations), list(infos)


def info_of(infos, i):
    """Info of one environment from the infos of many, with their masks."""
    return {key: info_of(value, i) if isinstance(value, dict) else value[i]
            for key, value in infos.items() if not key.startswith("_") and infos[f"_{key}"][i]}  # fmt: skip


@functools.lru_cache(maxsize=None)
def pair_of(name, limit):
    """Two single environments; a reset with a seed makes them like new, so all modes share them."""
    return [sinew.gym.make(name, time_limit=limit) for _ in range(2)]


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", NAMES)
def test_equal_to_single_environments_in_a_loop(name, mode):
    limit = OF_TASK.get(name, 0.03)
    ours = course(sinew.gym.make_vec(name, 2, threads=2, time_limit=limit, autoreset_mode=mode), 3, 6, mode)
    loop = course(OneByOne(pair_of(name, limit), mode), 3, 6, mode)
    assert len(ours) == len(loop) > 6 and sum(part[3].any() for part in ours if len(part) == 5) >= 1
    for one, other in zip(ours, loop):
        assert same(tuple(one[:-1]), tuple(other[:-1]))
        assert same([info_of(one[-1], i) for i in range(2)], other[-1])


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("name", NAMES)
def test_equal_to_gymnasiums_vector_environment(name, mode):
    vector = pytest.importorskip("gymnasium.vector", reason="Gymnasium is not installed: its modes are checked by hand above")
    limit = OF_TASK.get(name, SHORT)
    ours = sinew.gym.make_vec(name, 3, threads=2, time_limit=limit, autoreset_mode=mode)
    theirs = vector.SyncVectorEnv([lambda: sinew.gym.make(name, time_limit=limit)] * 3, autoreset_mode=vector.AutoresetMode[mode])
    assert same(course(ours, 3, 12, mode), course(theirs, 3, 12, mode))


def test_a_task_of_ones_own_may_bring_a_script():
    class Lazy(TrunkDamp):
        """Does nothing."""

        def scripted(self, episode):
            return np.full(8, -1.0)

    env = sinew.gym.make(Lazy(time_limit=0.05))
    env.reset(seed=1)
    np.testing.assert_array_equal(sinew.gym.expert(env)(), np.full(8, -1.0, dtype=np.float32))


@pytest.fixture(scope="module")
def judge():
    path = Path(__file__).parents[2] / "examples" / "gym" / "judge.py"
    spec = importlib.util.spec_from_file_location("judge", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.judge


def test_experts_are_judged(judge):
    returns, succeeded = judge("trunk-reach", 2, time_limit=0.5)
    assert returns.shape == (2,) and (returns < 0.0).all()
    assert succeeded.all()
    assert not judge("trunk-reach", 1, without_expert=True)[1].any()


def test_the_expert_damps(judge):
    returns, succeeded = judge("trunk-damp", 2, seed=20, time_limit=0.4)
    passive, neither = judge("trunk-damp", 2, seed=20, without_expert=True, time_limit=0.4)
    assert succeeded.all() and not neither.any()
    assert (returns > 0.35 * passive).all() and (passive < -100.0).all()  # mJ summed over steps of 10 ms: a struck trunk has 10 mJ or more


def test_the_expert_swings_up_beyond_what_torques_hold(judge):
    returns, succeeded = judge("arm-swing-up", 2, seed=23)
    env = sinew.gym.make("arm-swing-up")
    env.reset(seed=23)
    still = sum(env.step(np.ones(3))[1] for _ in range(env.task.episode_steps))
    assert succeeded.all() and (returns > 1.5 * still).all()
    assert not judge("arm-swing-up", 1, seed=23, without_expert=True)[1].any()
