#!/usr/bin/env python3
"""Cross-entropy method for reaching with a trunk, or for damping it, with NumPy only.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/gym/learn.py trunk-reach [--seeds 5] [--threads 2] [--out FOLDER]

The policy is linear. Like the trunk, it is invariant under a quarter turn: a long and a short cable each have weights for the
observations relative to their side, eight weights in all for trunk-reach and ten for trunk-damp. A generation draws 24 sets of
weights from a normal distribution, runs all of them in the same episodes, and fits the distribution to the best six. The result
is evaluated in held-out episodes. Writes TASK.png, the learning curves, and TASK.npz to FOLDER.
"""

import argparse
import time
import warnings
from pathlib import Path

import numpy as np
import sinew.gym
from matplotlib.figure import Figure

POPULATION, ELITES = 24, 6
TASKS = {  # episodes per generation, time limit (s), action of zero weights, initial spread, weights per cable; test
    "trunk-reach": {"episodes": 6, "time_limit": 0.4, "bias": 0.0, "spread": 3.0, "size": 4, "test_time": 0.5, "tests": 100},
    "trunk-damp": {"episodes": 2, "time_limit": 0.6, "bias": -1.0, "spread": 0.1, "size": 5, "test_time": 1.0, "tests": 24},
}


def features(task, observations):
    """Observations relative to each of the four sides of the trunk, (environments, 4, features); the last feature is constant."""
    sides = []
    for k in range(4):
        if task == "trunk-reach":  # vector from tip to goal: radial, tangential, z
            c, s = np.cos((k + 1) * np.pi / 2), np.sin((k + 1) * np.pi / 2)
            x, y, z = observations[:, 19:22].T
            seen, constant = [x * c + y * s, y * c - x * s, z], 0.1
        else:  # rates of bending from opposite cables: radial and tangential, long and short
            rates = np.roll(observations[:, 19:27].reshape(-1, 2, 4), -k, axis=2)
            seen, constant = (rates[:, :, :2] - rates[:, :, 2:]).reshape(-1, 4).T, 1.0
        sides.append(np.column_stack([*seen, np.full(len(observations), constant)]))
    return np.stack(sides, axis=1)


def returns(task, envs, seeds, weights):
    """Sum of rewards of an episode in every environment, and the last infos, for weights (environments, 2, size)."""
    observations, _ = envs.reset(seed=seeds)
    total, ended = np.zeros(envs.num_envs), False
    while not ended:
        actions = TASKS[task]["bias"] + np.einsum("esf,ecf->ecs", features(task, observations), weights)  # long cables, then short
        observations, rewards, _, truncations, infos = envs.step(actions.reshape(envs.num_envs, 8))
        total, ended = total + rewards, truncations.all()
    return total, infos


def learn(task, seed, generations, threads):
    """Training returns (generations, 3) of the mean policy, the best one and the average, and the final mean weights."""
    options, random = TASKS[task], np.random.default_rng(seed)
    envs = sinew.gym.make_vec(task, POPULATION * options["episodes"], threads=threads, time_limit=options["time_limit"])
    shape, curve = (2, options["size"]), []
    mean, spread = np.zeros(shape), np.full(shape, options["spread"])
    for generation in range(generations):
        drawn = mean + spread * random.standard_normal((POPULATION, *shape))
        drawn[0] = mean
        seeds = [int(s) for s in random.integers(0, 2**31, options["episodes"])] * POPULATION
        total, _ = returns(task, envs, seeds, np.repeat(drawn, options["episodes"], axis=0))
        total = total.reshape(POPULATION, -1).mean(axis=1)
        best = drawn[np.argsort(total)[-ELITES:]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 0.1 * options["spread"] * 0.8**generation
        curve.append([total[0], total.max(), total.mean()])
        print(f"seed {seed} generation {generation + 1}: mean policy {total[0]:.2f}, best {total.max():.2f}", flush=True)
    envs.close()
    return np.array(curve), mean


def judge(task, weights, threads):
    """trunk-reach: fraction of goals reached within 5 mm at the end. trunk-damp: integral of energy relative to the passive trunk."""
    options = TASKS[task]
    envs = sinew.gym.make_vec(task, options["tests"], threads=threads, time_limit=options["test_time"])
    seeds = [2**31 + i for i in range(options["tests"])]  # held out: training draws smaller seeds
    run = lambda w: returns(task, envs, seeds, np.broadcast_to(w, (options["tests"], *weights.shape)))  # noqa: E731
    total, infos = run(weights)
    return infos["success"].mean() if task == "trunk-reach" else total.sum() / run(np.zeros_like(weights))[0].sum()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("task", choices=TASKS)
    for name, default in (("--seeds", 5), ("--generations", 12), ("--threads", 2)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument("--out", type=Path, default=Path("out"))
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore", sinew.SinewWarning)  # about flagged steps, because poor policies shake the trunk
    curves, results, start = [], [], time.perf_counter()
    axes = Figure(figsize=(6.0, 3.6), layout="constrained").subplots()
    for seed in range(given.seeds):
        curve, weights = learn(given.task, seed, given.generations, given.threads)
        results.append(judge(given.task, weights, given.threads))
        print(f"seed {seed}: {time.perf_counter() - start:.0f} s, result {results[-1]:.3f}, weights {weights.round(2).tolist()}", flush=True)
        curves.append(curve)
        np.savez(given.out / f"{given.task}.npz", curves=curves, results=results, weights=weights)
        axes.plot(np.arange(len(curve)) + 1, curve[:, 0], marker=".", label=f"seed {seed}: {results[-1]:.2f}")
        axes.set(xlabel="generation", ylabel="return of the mean policy", title=given.task)
        axes.legend()
        axes.figure.savefig(given.out / f"{given.task}.png", dpi=110)
