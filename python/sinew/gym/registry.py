"""Tasks by name."""

from __future__ import annotations

from typing import Any, Optional, Union

from ..errors import Error
from . import tasks as _tasks
from .env import Env
from .spaces import AutoresetMode, gymnasium
from .task import Task, unknown
from .vector_env import VectorEnv

__all__ = ["make", "make_vec", "tasks"]

_TASKS: dict[str, type[Task]] = {
    task.name: task
    for task in (_tasks.TrunkReach, _tasks.TrunkFollow, _tasks.TrunkHold, _tasks.TrunkDamp, _tasks.ArmSwingUp, _tasks.Grasp, _tasks.Crawl)
}


def tasks() -> dict[str, str]:
    """Names of the tasks with their goals.

    Examples
    --------
    >>> for name, summary in sinew.gym.tasks().items():
    ...     print(name, summary)
    """
    return {name: task.summary for name, task in _TASKS.items()}


def _task(task: Union[str, Task], options: dict[str, Any], own: tuple[str, ...]) -> Task:
    """A task by name, or the task itself. `own` are the options that are not passed to the task."""
    if isinstance(task, Task):
        if options:
            raise Error("bad-argument", "make", f"{', '.join(options)} given with a Task object", "pass them to its constructor")
        return task
    if task not in _TASKS:
        raise unknown("make", "task", task, list(_TASKS))
    known = _TASKS[task].keywords()
    for name in options:
        if name not in known:
            raise unknown("make", f"option of {task}", name, [*own, *known])
    return _TASKS[task](**options)


def make(task: Union[str, Task], *, render_mode: Optional[str] = None, **options: Any) -> Env:
    """Creates an environment of a task.

    Parameters
    ----------
    task : str or Task
        A name from `tasks()`, or a task of your own.
    render_mode : str, optional
        "rgb_array" or "human".
    **options
        Options of the task: see its class in sinew.gym.tasks, and Task.

    Returns
    -------
    Env

    Raises
    ------
    Error
        unknown-name, with a suggestion; out-of-range, wrong-type.

    Examples
    --------
    >>> env = sinew.gym.make("trunk-reach", time_limit=1.0)
    """
    return Env(_task(task, options, ("render_mode",)), render_mode=render_mode)


def make_vec(
    task: Union[str, Task],
    num_envs: int = 1,
    *,
    threads: int = 1,
    autoreset_mode: Union[str, Any] = AutoresetMode.NEXT_STEP,
    render_mode: Optional[str] = None,
    **options: Any,
) -> VectorEnv:
    """Creates many environments of a task.

    Parameters
    ----------
    task : str or Task
        A name from `tasks()`, or a task of your own.
    num_envs : int
        1 or more.
    threads : int
        Number of threads that share the environments; results do not depend on it.
    autoreset_mode : AutoresetMode or str
        "NEXT_STEP", "SAME_STEP" or "DISABLED": see VectorEnv.
    render_mode : str, optional
        "rgb_array" or "human".
    **options
        Options of the task: see its class in sinew.gym.tasks, and Task.

    Returns
    -------
    VectorEnv

    Raises
    ------
    Error
        unknown-name, with a suggestion; out-of-range, wrong-type.

    Examples
    --------
    >>> envs = sinew.gym.make_vec("trunk-reach", num_envs=64, threads=2)
    """
    made = _task(task, options, ("num_envs", "threads", "autoreset_mode", "render_mode"))
    return VectorEnv(made, num_envs, threads=threads, autoreset_mode=autoreset_mode, render_mode=render_mode)


def _register() -> None:
    """Registers the tasks with Gymnasium as sinew/NAME."""
    for name in _TASKS:

        def single(*, _name: str = name, **options: Any) -> Env:
            return make(_name, **options)

        def vector(*, _name: str = name, **options: Any) -> VectorEnv:
            options.pop("vectorization_mode", None)
            return make_vec(_name, **options)

        gymnasium.register(id=f"sinew/{name}", entry_point=single, vector_entry_point=vector)


if gymnasium is not None:
    _register()
