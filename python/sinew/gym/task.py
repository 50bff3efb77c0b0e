"""Base of all tasks: scene, actions, observations, rewards and random quantities of an episode."""

from __future__ import annotations

import difflib
import inspect
import itertools
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from .._core import State
from ..errors import Error
from .models import Robot
from .spaces import Box

__all__ = ["SCENES", "Range", "Task", "range_of", "unknown"]

SCENES = Path(__file__).parent / "scenes"

Range = Union[float, Sequence[float]]


def unknown(place: str, what: str, name: Any, known: Sequence[str]) -> Error:
    """Returns an error of kind unknown-name that suggests the most similar known name."""
    near = difflib.get_close_matches(str(name), known, n=1, cutoff=0.5)
    remedy = f"did you mean {near[0]!r}? " if near else ""
    return Error("unknown-name", place, f"there is no {what} {name!r}", f"{remedy}there are: {', '.join(known)}")


def range_of(item: str, value: Range, least: float, greatest: float, unit: str) -> tuple[float, float]:
    """(low, high) from a number or a pair, within bounds."""
    try:
        low, high = (float(v) for v in (value if np.ndim(value) else (value, value)))
    except (TypeError, ValueError):
        raise Error("wrong-type", item, f"{value!r} is not a range", "give a number, or (low, high)") from None
    if not least <= low <= high <= greatest:
        raise Error("out-of-range", item, f"the range is ({low:g}, {high:g}){unit}", f"give {least:g} <= low <= high <= {greatest:g}{unit}")
    return low, high


class Task:
    """A robot with its actions, observations and rewards.

    A task is immutable while environments use it; the data of one environment are in its Episode. A subclass sets the class
    attributes, defines `sense` and `reward`, and overrides further methods as needed. A task whose steps take microseconds sets
    `observables` and defines `sense_rows` and `reward_rows` instead: VectorEnv then processes all environments at once.

    Parameters
    ----------
    time_limit : float, optional
        Duration of an episode, s, after which it is truncated; by default the task's own.
    observe : str
        "sensors", or "state", which adds the hidden state. See the task.
    action : str, optional
        Meaning of the actions, one of `actions`; by default the first.
    material_scale : float or (low, high)
        Factor of the stiffness, 0.5 to 2; a range is drawn from for each episode. It applies to all materials unless the task
        says otherwise.
    payload : float or (low, high)
        Mass fixed to the tip, kg, 0 to 0.05; a range is drawn from for each episode.
    models : int
        Number of models to build for ranges, 1 to 64; 1 without a range.
    action_delay : int or (low, high)
        Delay of the actions in steps, 0 to 10; a range is drawn from for each episode.
    set : dict, optional
        Overrides of scene values, as in sinew.load: {"solver": "one-linearisation"}.

    Raises
    ------
    Error
        out-of-range, unknown-name, wrong-type, and the errors of sinew.load.
    """

    name = ""
    summary = ""
    scene: Path = SCENES
    settings: dict[str, Any] = {}  # scene values in which the task differs from the file
    actions: tuple[str, ...] = ()
    substeps = 1  # simulated steps per action
    default_time_limit = 1.0
    camera = "corner"  # default view of pictures
    observables: tuple[str, ...] = ()  # names of the values for sense_rows and reward_rows, as in Batch.read()
    failure_reward = -100.0  # reward of a failed simulation step, which ends the episode

    def __init__(
        self,
        *,
        time_limit: Optional[float] = None,
        observe: str = "sensors",
        action: Optional[str] = None,
        material_scale: Range = 1.0,
        payload: Range = 0.0,
        models: int = 8,
        action_delay: Union[int, Sequence[int]] = 0,
        set: Optional[Mapping[str, Any]] = None,  # noqa: A002 - as in sinew.load
    ) -> None:
        self.observe = observe
        if observe not in ("sensors", "state"):
            raise unknown("observe", "observation", observe, ("sensors", "state"))
        self.action = self.actions[0] if action is None else action
        if self.action not in self.actions:
            raise unknown("action", f"action of {self.name}", action, self.actions)
        self.material_scale = range_of("material_scale", material_scale, 0.5, 2.0, "")
        self.payload = range_of("payload", payload, 0.0, 0.05, " kg")
        delay = range_of("action_delay", action_delay, 0, 10, " steps")
        if delay != (int(delay[0]), int(delay[1])):
            raise Error("wrong-type", "action_delay", f"{action_delay!r} is not a number of steps", "give whole numbers")
        self.action_delay = (int(delay[0]), int(delay[1]))
        if not 1 <= models <= 64:
            raise Error("out-of-range", "models", f"it is {models}", "give 1 to 64")
        self.models = int(models)
        self.set = dict(set or {})
        self._time_limit = self.default_time_limit if time_limit is None else float(time_limit)

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Randomised quantities of a model: the arguments of `randomised`, each with (low, high). The first is log-uniform."""
        return {"material_scale": self.material_scale, "payload": self.payload}

    @property
    def is_randomised(self) -> bool:
        """Whether episodes draw from several models."""
        return any(low < high for low, high in self.ranges.values())

    @staticmethod
    def bounded(item: str, value: float, least: float, greatest: float, unit: str = "") -> float:
        """A number, checked against two bounds. Raises out-of-range and wrong-type."""
        if np.ndim(value):
            raise Error("wrong-type", item, f"{value!r} is not a number", "give a number")
        return range_of(item, value, least, greatest, unit)[0]

    def bind(self, robot: Robot) -> None:
        """Stores what all models have in common, from the first one: time step, limits, spaces."""
        self.time_step = self.substeps * robot.sim.time_step
        if not self._time_limit >= self.time_step:
            raise Error("out-of-range", "time_limit", f"it is {self._time_limit} s",
                        f"give {self.time_step:g} s, the time of a step, or more")
        self.time_limit = self._time_limit
        self.episode_steps = round(self._time_limit / self.time_step)
        self.kind, self.is_increment = self.action.split("-")[0], self.action.endswith("-increment")
        self.low, self.high, rates = self.limits(robot)
        self.increment = np.minimum(rates * self.time_step, self.high - self.low)  # largest change per step
        self.action_space = Box(low=-1.0, high=1.0, shape=self.low.shape, dtype=np.float32)
        self.observation_space = Box(low=-np.inf, high=np.inf, shape=(self.observation_size(robot),), dtype=np.float32)

    # Methods and attributes that a subclass may define.

    def described(self, folder: Path) -> Union[Path, dict[str, Any]]:
        """The scene, in a form that sinew.load accepts. Meshes may be written to the folder, which exists until the scene is loaded."""
        return self.scene

    def randomised(self, material_scale: float, payload: float) -> dict[str, Any]:
        """Scene values for a material scale and a payload (kg)."""
        raise NotImplementedError

    def limits(self, robot: Robot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Lower and upper limits of the commands, and limits on their rates (1/s), (actions,) each; by default those of the actuators."""
        limits = [actuator.limits[self.kind] for actuator in robot.actuators]
        least, greatest, rates = (np.array([getattr(limit, part) for limit in limits]) for part in ("min", "max", "rate"))
        return least, greatest, rates

    def prepare(self, robot: Robot) -> list[State]:
        """Initial states of episodes. The simulation is as loaded."""
        robot.sim.solve_static()
        return [robot.sim.state()]

    def picture_points(self, robot: Robot) -> np.ndarray:
        """(n, 3) m: points that a picture must show. By default the space around the robot at rest."""
        rest = np.asarray(robot.body.rest_positions)
        low, high = rest.min(axis=0), rest.max(axis=0)
        room = np.where(high - low < np.max(high - low), 0.22, 0.04) * np.max(high - low)
        return np.array(list(itertools.product(*zip(low - room, high + room))))

    def measure_rest(self, robot: Robot) -> dict[str, Any]:
        """Quantities of a model that the task stores. The simulation is in the first initial state."""
        return {"tip": robot.tip.position}

    def begin(self, episode: Any, options: Mapping[str, Any]) -> None:
        """Draws the random quantities of an episode from `episode.random`. The robot is in its initial state."""

    def commanded(self, robot: Robot) -> np.ndarray:
        """Commands in the initial state, (actions,). The robot is in this state."""
        return np.array([getattr(actuator, self.kind) for actuator in robot.actuators])

    def apply(self, episode: Any) -> None:
        """Sends `episode.commands` to the robot."""
        for actuator, value in zip(episode.robot.actuators, episode.commands.tolist()):
            setattr(actuator, self.kind, value)

    def disturb(self, episode: Any) -> None:
        """Changes the environment of the robot just before a step."""

    def observation_names(self, robot: Robot) -> list[str]:
        """Name of every number of an observation."""
        raise NotImplementedError

    def sense(self, episode: Any, out: np.ndarray) -> None:
        """Writes an observation into out, (observation size,)."""
        self.sense_rows([episode], episode.robot.read(self.observables), out[None])

    def reward(self, episode: Any) -> tuple[float, bool, dict[str, Any]]:
        """Reward of the last step, whether the task has ended, and info."""
        rewards, over, infos = self.reward_rows([episode], episode.robot.read(self.observables), episode.action[None])
        return rewards.item(), bool(over[0]), {key: values[0].item() for key, values in infos.items()}

    def sense_rows(self, episodes: Sequence[Any], read: np.ndarray, out: np.ndarray) -> None:
        """The same as `sense` for many episodes, for tasks with `observables`. It must not call methods of the robots.

        Parameters
        ----------
        episodes : list of n Episode
        read : (n, numbers)
            Values of the `observables` of their robots.
        out : (n, observation size)
        """
        raise NotImplementedError

    def reward_rows(
        self, episodes: Sequence[Any], read: np.ndarray, actions: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """The same as `reward` for many episodes: rewards, whether the task has ended, and infos, arrays (n,).

        Parameters
        ----------
        episodes, read
            As for `sense_rows`.
        actions : (n, actions)
            Actions that took effect.
        """
        raise NotImplementedError

    #: Names accepted by reset(options=...) for an environment, with the number of axes of a value.
    options: Mapping[str, int] = {}

    def scripted(self, episode: Any) -> np.ndarray:
        """Action of a scripted expert in the present state, (actions,) in [-1, 1], for the task's first kind of action. Optional."""
        raise NotImplementedError

    def observation_size(self, robot: Robot) -> int:
        """Size of an observation."""
        return len(self.observation_names(robot))

    def commands(self, episode: Any, action: np.ndarray) -> np.ndarray:
        """Commands of the actuators (N, m or N m) for an action in [-1, 1]; both are (actuators,)."""
        return self.next_commands(episode.commands, action)

    def next_commands(self, commands: np.ndarray, action: np.ndarray) -> np.ndarray:
        """The same from given last commands, (..., actuators) each."""
        if self.is_increment:  # np.clip is four times slower
            return np.minimum(np.maximum(commands + action * self.increment, self.low), self.high)
        return self.low + 0.5 * (action + 1.0) * (self.high - self.low)

    @classmethod
    def keywords(cls) -> list[str]:
        """Names of all keyword arguments of the task."""
        found: list[str] = []
        for base in cls.__mro__:
            if "__init__" in vars(base) and base is not object:
                found += [p.name for p in inspect.signature(base.__init__).parameters.values() if p.kind is p.KEYWORD_ONLY]
        return found
