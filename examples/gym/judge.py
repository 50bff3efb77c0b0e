#!/usr/bin/env python3
"""What an expert reaches: returns and successes over many episodes of a task.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/gym/judge.py TASK [--episodes 50] [--seed 0] [--set NAME=VALUE ...]

TASK is one of those with an expert: trunk-reach, trunk-follow, trunk-hold, grasp, crawl. `--set friction=0.2` and the like go to
the task. Episode k has the seed --seed + k. The table has a row for each episode that does not succeed, and the sums.
"""

import argparse

import numpy as np
import sinew.gym


def judge(task, episodes, seed=0, **options):
    """Sum of rewards of each episode, and whether its last step was a success."""
    env = sinew.gym.make(task, **options)
    policy = sinew.gym.expert(env)
    returns, succeeded = np.zeros(episodes), np.zeros(episodes, dtype=bool)
    for k in range(episodes):
        observation, info = env.reset(seed=seed + k)
        over = False
        while not over:
            observation, reward, terminated, truncated, info = env.step(policy(observation))
            returns[k] += reward
            over = terminated or truncated
        succeeded[k] = info["success"]
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
    parser.add_argument("--set", type=option, nargs="*", default=[], metavar="NAME=VALUE")
    arguments = parser.parse_args()
    returns, succeeded = judge(arguments.task, arguments.episodes, arguments.seed, **dict(arguments.set))
    for k in np.flatnonzero(~succeeded):
        print(f"seed {arguments.seed + k}: return {returns[k]:.2f}, no success")
    print(f"{arguments.task}: {succeeded.sum()} of {len(returns)} succeed, return {returns.mean():.1f} on average, "
          f"{returns.min():.1f} to {returns.max():.1f}")


if __name__ == "__main__":
    main()
