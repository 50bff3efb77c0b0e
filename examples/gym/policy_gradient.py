#!/usr/bin/env python3
"""Proximal policy optimisation (Schulman et al., arXiv:1707.06347, 2017) for reaching with a trunk, with PyTorch.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/gym/policy_gradient.py [--iterations 60] [--seed 0] [--threads 2] [--out FOLDER]

A network of two layers maps the observation of `trunk-reach` to the mean of a normal distribution of actions; another one estimates
the value of a state. An iteration runs an episode in 64 environments and improves both networks by the clipped objective with
generalised advantages. The result is evaluated without noise in 100 held-out episodes. Writes policy_gradient.png, the learning
curve, to FOLDER. Needs PyTorch (python3-torch).
"""

import argparse
import time
import warnings
from pathlib import Path

import numpy as np
import sinew.gym
import torch
from matplotlib.figure import Figure

ENVIRONMENTS, TESTS = 64, 100
DISCOUNT, TRACE = 0.95, 0.9  # gamma of rewards, lambda of advantages (Schulman et al., arXiv:1506.02438, equation 16)
CLIP, EPOCHS, BATCHES, RATE = 0.2, 8, 4, 2e-3


def network(inputs, outputs, gain):
    layers = [torch.nn.Linear(inputs, 64), torch.nn.Tanh(), torch.nn.Linear(64, 64), torch.nn.Tanh(), torch.nn.Linear(64, outputs)]
    torch.nn.init.normal_(layers[-1].weight, std=gain / 8.0)
    torch.nn.init.zeros_(layers[-1].bias)
    return torch.nn.Sequential(*layers)


class Policy(torch.nn.Module):
    def __init__(self, inputs, outputs):
        super().__init__()
        self.mean, self.value = network(inputs, outputs, 0.01), network(inputs, 1, 1.0)
        self.log_spread = torch.nn.Parameter(torch.full((outputs,), -0.7))

    def distribution(self, seen):
        return torch.distributions.Normal(self.mean(seen), self.log_spread.exp())


def episode(envs, act, seeds):
    """Observations (steps + 1, environments, inputs), actions and rewards of an episode, and the last infos."""
    seen, _ = envs.reset(seed=seeds)
    seens, actions, rewards, ended = [seen.copy()], [], [], False
    while not ended:
        action = act(torch.as_tensor(seen, dtype=torch.float32)).numpy()
        seen, reward, _, truncations, infos = envs.step(np.clip(action, -1.0, 1.0))
        seens.append(seen.copy()), actions.append(action), rewards.append(reward.copy())
        ended = truncations.all()
    as_tensor = lambda parts: torch.as_tensor(np.array(parts), dtype=torch.float32)  # noqa: E731
    return as_tensor(seens), as_tensor(actions), as_tensor(rewards), infos


def advantages(rewards, values):
    """Generalised advantages (steps, environments); the last value bootstraps truncated episodes, values (steps + 1, environments)."""
    result, ahead = torch.zeros_like(rewards), torch.zeros_like(rewards[0])
    for k in reversed(range(len(rewards))):
        ahead = rewards[k] + DISCOUNT * values[k + 1] - values[k] + DISCOUNT * TRACE * ahead
        result[k] = ahead
    return result


def improve(policy, optimiser, seen, actions, rewards):
    with torch.no_grad():
        values = policy.value(seen).squeeze(-1)
        better = advantages(rewards, values)
        goals = (better + values[:-1]).flatten()
        better = ((better - better.mean()) / (better.std() + 1e-8)).flatten()
        seen, actions = seen[:-1].flatten(0, 1), actions.flatten(0, 1)
        before = policy.distribution(seen).log_prob(actions).sum(-1)
    for _ in range(EPOCHS):
        for part in torch.randperm(len(seen)).chunk(BATCHES):
            distribution = policy.distribution(seen[part])
            ratio = (distribution.log_prob(actions[part]).sum(-1) - before[part]).exp()
            gain = torch.minimum(ratio * better[part], ratio.clamp(1.0 - CLIP, 1.0 + CLIP) * better[part]).mean()
            miss = (policy.value(seen[part]).squeeze(-1) - goals[part]).square().mean()
            optimiser.zero_grad()
            (0.5 * miss - gain).backward()
            torch.nn.utils.clip_grad_norm_(policy.parameters(), 0.5)
            optimiser.step()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("--iterations", 60), ("--seed", 0), ("--threads", 2)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument("--out", type=Path, default=Path("out"))
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore", sinew.SinewWarning)  # about flagged steps, because poor policies shake the trunk
    torch.manual_seed(given.seed)
    torch.set_num_threads(given.threads)
    random = np.random.default_rng(given.seed)
    envs = sinew.gym.make_vec("trunk-reach", ENVIRONMENTS, threads=given.threads)
    policy = Policy(envs.observation_space.shape[1], envs.action_space.shape[1])
    optimiser = torch.optim.Adam(policy.parameters(), lr=RATE)
    curve, start = [], time.perf_counter()

    def draw(seen):
        with torch.no_grad():
            return policy.distribution(seen).sample()

    def best(seen):
        with torch.no_grad():
            return policy.mean(seen)

    for iteration in range(given.iterations):
        for group in optimiser.param_groups:
            group["lr"] = RATE * (1.0 - iteration / given.iterations)
        seen, actions, rewards, infos = episode(envs, draw, [int(s) for s in random.integers(0, 2**31, ENVIRONMENTS)])
        improve(policy, optimiser, seen, actions, rewards)
        curve.append(rewards.sum(0).mean().item())
        print(f"iteration {iteration + 1}: return {curve[-1]:.2f}, within 5 mm {infos['success'].mean():.2f}, "
              f"{time.perf_counter() - start:.0f} s", flush=True)  # fmt: skip
    envs.close()
    tests = sinew.gym.make_vec("trunk-reach", TESTS, threads=given.threads)
    success = episode(tests, best, [2**31 + i for i in range(TESTS)])[3]["success"].mean()  # held-out seeds
    print(f"of {TESTS} goals never seen, within 5 mm: {success:.2f}")
    axes = Figure(figsize=(6.0, 3.6), layout="constrained").subplots()
    axes.plot(np.arange(len(curve)) + 1, curve, label=f"within 5 mm: {success:.2f}")
    axes.set(xlabel="iteration", ylabel="return", title="trunk-reach, policy gradient")
    axes.legend()
    axes.figure.savefig(given.out / "policy_gradient.png", dpi=110)


if __name__ == "__main__":
    main()
