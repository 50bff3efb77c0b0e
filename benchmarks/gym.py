"""Learning environments: steps per second and core, what Python adds, reset time, memory.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/gym.py [--envs 64] [--steps 200] [--threads 1 2] [--task trunk-reach]

An environment step of trunk-reach is one simulated step of 10 ms of the trunk (709 nodes, eight cables): actions, the step,
observation, reward and the resets at the ends of episodes. Actions are uniform in [-1, 1]: every cable's tension goes up or
down by up to 1 N a step, within 0 to 8 N. `--task grasp` and `--task crawl` have contacts and take one step of 20 ms and 40 ms;
8 environments and 60 steps are enough for them. Rates are environment steps over processor time of all threads (a core's rate
whatever else the machine does), and over wall time. Python's share is the processor time that is not spent in sim.step().
"""

import argparse
import time
import warnings

import numpy as np
import sinew
import sinew.gym
from sinew import _core

SETTINGS = {
    "trunk-reach": [
        ("as shipped", {}),
        ("Newton to 1e-4", {"solver": {"method": "newton", "tolerance": 1e-4}}),
        ("one linearisation", {"solver": "one-linearisation"}),
    ],
}


def random_actions(envs, steps):
    shape = envs.action_space.shape
    return np.random.default_rng(0).uniform(-1.0, 1.0, (steps, *shape))


def rate(task, envs, steps, threads, settings):
    """Environment steps per processor second and wall second, largest and median relative residual."""
    made = sinew.gym.make_vec(task, envs, threads=threads, set=settings)
    made.reset(seed=0)
    actions = random_actions(made, steps)
    made.step(actions[0])
    processor, wall = time.process_time(), time.perf_counter()
    for action in actions[1:]:
        made.step(action)
    processor, wall = time.process_time() - processor, time.perf_counter() - wall
    count = envs * (steps - 1)
    residuals = []
    for action in actions[: min(steps, 100)]:
        made.step(action)
        residuals += [episode.robot.sim.report.relative_residual for episode in made.episodes]
    made.close()
    return count / processor, count / wall, max(residuals), np.median(residuals)


def python_share(task, envs, steps):
    """Share of the processor time that is not spent in sim.step(), in one thread."""
    made = sinew.gym.make_vec(task, envs)
    made.reset(seed=0)
    spent = 0.0

    class Timed:
        """A simulation whose steps are timed."""

        def __init__(self, sim):
            self._sim, self.step_untimed = sim, sim.step

        def __getattr__(self, name):
            return getattr(self._sim, name)

        def step(self, n):
            nonlocal spent
            start = time.thread_time()
            self.step_untimed(n)
            spent += time.thread_time() - start

    for episode in made.episodes:
        episode.robot.sim = Timed(episode.robot.sim)
    actions = random_actions(made, steps)
    start = time.process_time()
    for action in actions:
        made.step(action)
    return 1.0 - spent / (time.process_time() - start), envs * steps


def reset_times(task):
    """Medians (us): sim.restore alone, and a reset of an environment with its draws, without the observation."""
    made = sinew.gym.make(task)
    made.reset(seed=0)
    sim, start = made.episode.robot.sim, made.episode.model.starts[0]

    def median(work):
        taken = []
        for _ in range(400):
            begun = time.perf_counter()
            work()
            taken.append(time.perf_counter() - begun)
        return 1e6 * np.median(taken)

    return median(lambda: sim.restore(start)), median(lambda: made.episode.reset(None, {})), median(sim.reset), len(start.bytes)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--envs", type=int, default=64)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--task", default="trunk-reach", choices=list(sinew.gym.tasks()))
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)  # one linearisation leaves residuals, which are printed
    print(f"sinew {sinew.__version__}, {_core.compiler}, {_core.instruction_set}; {given.task}, {given.envs} environments")
    print("solver              threads  steps/s a core  steps/s wall  largest residual  median (of the forces)")
    for name, settings in SETTINGS.get(given.task, [("as shipped", {})]):
        for threads in given.threads:
            a_core, wall, largest, median = rate(given.task, given.envs, given.steps, threads, settings)
            print(f"{name:18}  {threads:7d}  {a_core:14.0f}  {wall:12.0f}  {largest:16.1e}  {median:.1e}")
    share, _ = python_share(given.task, given.envs, given.steps)
    print(f"Python's share at {given.envs} environments, one thread: {100 * share:.1f} %")
    restore, reset, again, size = reset_times(given.task)
    print(f"restore of a state of {size} bytes: {restore:.0f} us; reset of an environment: {reset:.0f} us; sim.reset(): {again:.0f} us")
    made = sinew.gym.make_vec(given.task, 1)
    print(f"memory of an environment's simulation: {made.memory / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
