"""Learning environments: steps per second and core, residuals, overhead of Python, reset time, memory.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/gym.py [--envs 64] [--steps 200] [--threads 1 2] [--task trunk-reach]
                                                                       [--mesh own published published-light] [--data ../shared/data]

An environment step of trunk-reach is one simulated step of 10 ms of the trunk with eight cables. It includes the action, the step,
observation, reward and the resets at the ends of episodes. Actions are uniform in [-1, 1]: each tension changes by up to 1 N per
step, within 0 to 8 N. `--mesh` selects the trunk: `own` is the task's (shape: trunk, 703 nodes, 2592 tetrahedra); `published` is the
mesh of SofaDefrost (709 nodes, 1972 tetrahedra) in the same task; `published-light` has a quarter of the tensions (2 N, 0.25 N per
step), because that mesh is four times as soft and buckles at 8 N. Without the file in DATA/trunk, these two are skipped.
`--task grasp` and `--task crawl` have contacts and steps of 20 ms and 40 ms; 8 environments and 60 steps suffice for them.
`--task arm-swing-up` is measured with ten steps per action, as in the task, and with one.
Rates are environment steps per processor time of all threads (the rate of a core, independent of other load) and per wall time;
the best of `--repeat` interleaved runs counts. Residuals are relative to the forces. The error of the tip is its distance from the
position that Newton's method with a tolerance of 1e-9 gives under the same actions, over 200 steps: four environments, one episode
each. The share of Python is the fraction of processor time outside of sim.step().
"""

import argparse
import os
import pathlib
import time
import warnings

import numpy as np
import sinew
import sinew.gym
from sinew import _core
from sinew.gym.tasks import ArmSwingUp, TrunkReach

ROOT = pathlib.Path(__file__).resolve().parent.parent

NEWTON = {"solver": {"tolerance": 1e-9}}  # reference for the error of the tip
SETTINGS = [
    ("as shipped", {}),
    ("tolerance 1e-1", {"solver": {"tolerance": 1e-1}}),
    ("tolerance 1e-2", {"solver": {"tolerance": 1e-2}}),
    ("tolerance 1e-3", {"solver": {"tolerance": 1e-3}}),
    ("tolerance 5e-4", {"solver": {"tolerance": 5e-4}}),
    ("tolerance 1e-4", {"solver": {"tolerance": 1e-4}}),
    ("1e-1, corotated", {"solver": {"tolerance": 1e-1, "tangent": "corotated"}}),
    ("one linearisation", {"solver": "one-linearisation"}),
    ("one, corotated", {"solver": {"method": "one-linearisation", "tangent": "corotated"}}),
]
CABLES = [f"{kind}_{k}" for kind in ("long", "short") for k in range(4)]


class OneStep(ArmSwingUp):
    """The arm with an action for every simulated step."""

    substeps = 1


def published(mesh, light):
    """trunk-reach with the published mesh; its guides lie up to 0.5 mm outside of it."""

    class Published(TrunkReach):
        settings = {
            "bodies.trunk.mesh": {"file": str(mesh), "unit": "mm"}, "effectors.tip.outside": "nearest",
            **{f"actuators.{name}.outside": "nearest" for name in CABLES},
            **({f"actuators.{name}.limits.tension": {"min": 0.0, "max": 2.0, "rate": 25.0} for name in CABLES} if light else {}),
        }  # fmt: skip

        def measure_rest(self, robot):
            body = robot.body  # a mesh file has no node set at the tip
            return {"tip": robot.tip.position, "positions": body.positions.copy(), "top": np.flatnonzero(body.rest_positions[:, 2] > 0.19),
                    "energy": body.strain_energy + body.gravity_energy}

    return Published


def tasks_of(given):
    """(label, function from scene settings to a task) for each requested variant."""
    if given.task == "arm-swing-up":
        return [("ten steps of 2 ms to an action", lambda settings: ArmSwingUp(set=settings)),
                ("one step of 1 ms to an action", lambda settings: OneStep(set={"time_step": 1e-3, **settings}, time_limit=0.5))]
    if given.task != "trunk-reach":
        return [(given.task, lambda settings: given.task)]
    found = []
    for name in given.mesh:
        mesh = given.data / "trunk" / "trunk.vtk"
        if name == "own":
            found.append(("own mesh", lambda settings: TrunkReach(set=settings)))
        elif mesh.is_file():
            kind = published(mesh, name == "published-light")
            found.append((f"{name} mesh", lambda settings, kind=kind: kind(set=settings)))
        else:
            print(f"no {mesh}: {name} is left out")
    return found


def random_actions(envs, steps):
    shape = envs.action_space.shape
    return np.random.default_rng(0).uniform(-1.0, 1.0, (steps, *shape))


def rate(task, envs, steps, threads):
    """Environment steps per processor second and wall second."""
    made = sinew.gym.make_vec(task, envs, threads=threads)
    made.reset(seed=0)
    actions = random_actions(made, steps)
    made.step(actions[0])
    processor, wall = time.process_time(), time.perf_counter()
    for action in actions[1:]:
        made.step(action)
    processor, wall = time.process_time() - processor, time.perf_counter() - wall
    made.close()
    count = envs * (steps - 1)
    return count / processor, count / wall


def watched(task, envs=4, steps=50):
    """Relative residuals, iterations and tips of all steps."""
    made = sinew.gym.make_vec(task, envs)
    made.reset(seed=0)
    residuals, iterations, tips = [], [], []
    for action in random_actions(made, steps):
        made.step(action)
        robots = [episode.robot for episode in made.episodes]
        residuals += [robot.sim.report.relative_residual for robot in robots]
        iterations += [robot.sim.report.iterations for robot in robots]
        tips += [robot.tip.position for robot in robots if robot.tip is not None]
    made.close()
    return np.array(residuals), np.mean(iterations), np.array(tips)


def table(given, name, task):
    """Prints a row for every setting and number of threads."""
    chosen = SETTINGS if given.task == "trunk-reach" else SETTINGS[:1]
    if given.settings:
        chosen = [one for one in chosen if one[0] in given.settings]
    print(f"\n{name}, {given.envs} environments, load {os.getloadavg()[0]:.1f}\n"
          "solver              threads  steps/s a core  steps/s wall  iterations  residual: largest   median  tip's error (mm): largest   median",
          flush=True)
    exact = watched(task(NEWTON))[2] if given.task == "trunk-reach" else None
    best = {}
    for _ in range(given.repeat):
        for label, settings in chosen:
            for threads in given.threads:
                now = rate(task(settings), given.envs, given.steps, threads)
                best[label, threads] = np.maximum(best.get((label, threads), 0.0), now)
    for label, settings in chosen:
        residuals, iterations, tips = watched(task(settings))
        error = "" if exact is None else "{:26.3f} {:8.4f}".format(*(f(1e3 * np.linalg.norm(tips - exact, axis=1)) for f in (np.max, np.median)))
        for threads in given.threads:
            a_core, wall = best[label, threads]
            print(f"{label:18}  {threads:7d}  {a_core:14.0f}  {wall:12.0f}  {iterations:10.1f}  {residuals.max():17.1e}  {np.median(residuals):.1e} "
                  f"{error}", flush=True)


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
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--task", default="trunk-reach", choices=list(sinew.gym.tasks()))
    parser.add_argument("--mesh", nargs="+", default=["own"], choices=["own", "published", "published-light"])
    parser.add_argument("--settings", nargs="+", help=", ".join(label for label, _ in SETTINGS))
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data")
    given = parser.parse_args()
    warnings.simplefilter("ignore", sinew.SinewWarning)  # about residuals of one linearisation, which are printed
    print(f"sinew {sinew.__version__}, {_core.compiler}, {_core.instruction_set}; {given.task}")
    for name, task in tasks_of(given):
        table(given, name, task)
    share, _ = python_share(given.task, given.envs, given.steps)
    print(f"\nPython's share at {given.envs} environments, one thread: {100 * share:.1f} %")
    restore, reset, again, size = reset_times(given.task)
    print(f"restore of a state of {size} bytes: {restore:.0f} us; reset of an environment: {reset:.0f} us; sim.reset(): {again:.0f} us")
    made = sinew.gym.make_vec(given.task, 1)
    made.reset(seed=0)
    made.step(random_actions(made, 1)[0])
    print(f"memory of an environment's simulation: {made.memory / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
