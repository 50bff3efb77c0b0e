#!/usr/bin/env python3
"""Evaluates an expert: returns and successes over many episodes of a task.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/gym/judge.py TASK [--episodes 50] [--seed 0] [--passive]
                                                                              [--set NAME=VALUE ...]

TASK is any of sinew.gym.tasks(). `--set friction=0.2` and the like are options of the task. Episode k has the seed --seed + k.
Prints a line for each episode without success, and a summary. The info of the last step tells whether an episode was a success.
For trunk-damp, which does not report success, the return must be at least half of the (negative) return of the passive trunk in
the same episode. `--passive` uses no expert and keeps all actuators as close to zero as possible.
"""

import argparse

import numpy as np
import sinew.gym


def passive(task):
    """Action that keeps the actuators at zero, or as close as their limits allow."""
    zero = np.clip(0.0, task.low, task.high)
    return np.zeros(len(zero)) if task.is_increment else 2.0 * (zero - task.low) / (task.high - task.low) - 1.0


def episode_of(env, policy, seed):
    """Sum of rewards of an episode, and its last info."""
    observation, info = env.reset(seed=seed)
    total, over = 0.0, False
    while not over:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        total += reward
        over = terminated or truncated
    return total, info


def judge(task, episodes, seed=0, without_expert=False, **options):
    """Sum of rewards and success of each episode."""
    env = sinew.gym.make(task, **options)
    nothing = passive(env.task)
    at_rest = lambda _: nothing  # noqa: E731
    policy = at_rest if without_expert else sinew.gym.expert(env)
    returns, succeeded = np.zeros(episodes), np.zeros(episodes, dtype=bool)
    for k in range(episodes):
        returns[k], info = episode_of(env, policy, seed + k)
        succeeded[k] = info["success"] if "success" in info else returns[k] >= 0.5 * episode_of(env, at_rest, seed + k)[0]
    env.close()
    return returns, succeeded


def option(text):
    name, _, value = text.partition("=")
    return name, float(value)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("task")
    parser.add_argument("--episodes", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--passive", action="store_true")
    parser.add_argument("--set", type=option, nargs="*", default=[], metavar="NAME=VALUE")
    arguments = parser.parse_args()
    returns, succeeded = judge(arguments.task, arguments.episodes, arguments.seed, arguments.passive, **dict(arguments.set))
    for k in np.flatnonzero(~succeeded):
        print(f"seed {arguments.seed + k}: return {returns[k]:.2f}, no success")
    print(f"{arguments.task}: {succeeded.sum()} of {len(returns)} succeed, return {returns.mean():.1f} on average, "
          f"{returns.min():.1f} to {returns.max():.1f}")


if __name__ == "__main__":
    main()
