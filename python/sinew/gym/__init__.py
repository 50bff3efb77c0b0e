"""Environments for reinforcement learning: many robots in one process, with the interface of Gymnasium.

    envs = sinew.gym.make_vec("trunk-reach", num_envs=64, threads=2)
    observations, infos = envs.reset(seed=1)
    observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())

Gymnasium is optional. If it is installed, its spaces and base classes are used, and importing this package registers the
tasks under `sinew/...`. docs/gym.md is the guide.
"""

from . import spaces, tasks as _tasks
from .env import Env
from .expert import Expert, expert
from .registry import make, make_vec, tasks
from .spaces import AutoresetMode, Box
from .task import Task
from .vector_env import VectorEnv

__all__ = ["AutoresetMode", "Box", "Env", "Expert", "Task", "VectorEnv", "expert", "make", "make_vec", "spaces", "tasks"]
