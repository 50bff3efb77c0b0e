"""The simulation that a loop uses: chosen effectors and actuators, limits, and the response to commands."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from . import rotations

__all__ = ["Answer", "Robot", "condensed"]

_COMMANDS = ("motion", "effort")


class Answer(NamedTuple):
    """Response of effectors and actuators to efforts of the actuators, near one state.

    Attributes
    ----------
    w_ea : (rows, actuators)
    w_aa : (actuators, actuators)
    jacobian : (rows, actuators)
        Of effectors with respect to commands, see condensed().
    """

    w_ea: np.ndarray
    w_aa: np.ndarray
    jacobian: np.ndarray


def condensed(w_ea: np.ndarray, w_aa: np.ndarray, by_motion: np.ndarray, slack: np.ndarray) -> np.ndarray:
    """J (rows, actuators) of the effectors with respect to commands, from W_ea and W_aa.

    With motions s of the actuators M that are commanded in motion, and efforts of the others F,
        lambda_M = W_MM^+ (s - W_MF lambda_F),   J_M = W_eM W_MM^+,   J_F = W_eF - J_M W_MF.
    A slack cable moves nothing, so its column is zero. W_MM is scaled to a unit diagonal, and W_MM^+ omits directions with
    eigenvalues below 1e-9 of the largest one: two cables on one line have one motion.

    Parameters
    ----------
    w_ea : (rows, actuators)
    w_aa : (actuators, actuators)
    by_motion, slack : (actuators,) bool
    """
    result = np.where(slack, 0.0, w_ea)
    held = by_motion & ~slack
    if not held.any():
        return result
    own = w_aa[np.ix_(held, held)]
    scale = 1.0 / np.sqrt(np.maximum(np.diag(own), np.finfo(float).tiny))
    inverse = scale[:, None] * np.linalg.pinv(scale[:, None] * own * scale, rcond=1e-9) * scale
    result[:, held] = w_ea[:, held] @ inverse
    others = ~by_motion & ~slack
    result[:, others] = w_ea[:, others] - result[:, held] @ w_aa[np.ix_(held, others)]
    return result


class Robot:
    """A simulation with some of its effectors and actuators.

    Parameters
    ----------
    sim : Simulation
    effectors : list of str
    actuators : list of str, optional
        By default all that can be controlled.
    command : 'motion', 'effort' or dict, optional
        Commanded quantity of the actuators; None: motion, for chambers pressure.
    place : str
        For messages.
    """

    def __init__(self, sim: Any, effectors: Sequence[str], actuators: Optional[Sequence[str]],
                 command: Union[str, Mapping[str, str], None], place: str) -> None:
        self.sim = sim
        self.effectors = {name: sim.effector(name) for name in effectors}
        names = [n for n, a in sim.actuators.items() if a.controllable] if actuators is None else list(actuators)
        if isinstance(actuators, str):
            raise Error("wrong-type", f"{place}(actuators)", f"{actuators!r} is not a list of names",
                        "give a list of names")
        if not names:
            raise Error("no-actuators", f"{place}(actuators)", "there are none", "name at least one")
        if len(set(names)) < len(names):
            raise Error("bad-argument", f"{place}(actuators)", f"a name comes twice in {names}", "name each once")
        self.actuators = {name: sim.actuator(name) for name in names}
        for name, actuator in self.actuators.items():
            if not actuator.controllable:
                raise Error("wrong-actuator-type", f"{place}(actuators)",
                            f"'{name}' is a {actuator.type}, whose effort no controller chooses", "name actuators that can be commanded")
        self.by_motion = np.array([kind == "motion" for kind in self._kinds(command, place)])
        # actuator.limits: {name of the effort: Limits, name of the motion: Limits}, in this order
        limits = [tuple(actuator.limits.items()) for actuator in self.actuators.values()]
        self._effort_names = [each[0][0] for each in limits]
        self._motion_names = [each[1][0] for each in limits]
        self.effort_limits = np.array([[each[0][1].min, each[0][1].max, each[0][1].rate] for each in limits]).T
        self.motion_limits = np.array([[each[1][1].min, each[1][1].max, each[1][1].rate] for each in limits]).T
        self.pulls_only = np.array([actuator.pulls_only for actuator in self.actuators.values()])
        self.effort_limits[0][self.pulls_only] = np.maximum(self.effort_limits[0][self.pulls_only], 0.0)
        self.directions = [np.array(effector.directions) for effector in self.effectors.values()]

    def _kinds(self, command: Union[str, Mapping[str, str], None], place: str) -> list[str]:
        kinds = {name: "effort" if a.regulates_effort else "motion" for name, a in self.actuators.items()}
        given = {name: command for name in kinds} if isinstance(command, str) else dict(command or {})
        for name, kind in given.items():
            if name not in kinds:
                raise Error("unknown-name", f"{place}(command)", f"'{name}' is not one of its actuators",
                            f"they are {', '.join(kinds)}")
            if kind not in _COMMANDS:
                raise Error("unknown-choice", f"{place}(command)", f"there is no command {kind!r}",
                            "use 'motion' or 'effort'")
            kinds[name] = kind
        return list(kinds.values())

    def on(self, sim: Any) -> "Robot":
        """The same selection on another simulation of this robot."""
        kinds = {name: "motion" if by_motion else "effort" for name, by_motion in zip(self.actuators, self.by_motion)}
        return Robot(sim, list(self.effectors), list(self.actuators), kinds, "clone")

    @property
    def quantities(self) -> dict[str, str]:
        """Commanded quantity of each actuator: "displacement", "pressure" ..."""
        return {name: (self._motion_names if by_motion else self._effort_names)[k]
                for k, (name, by_motion) in enumerate(zip(self.actuators, self.by_motion))}

    @property
    def efforts(self) -> np.ndarray:
        """(actuators,) N, Pa or N m."""
        return np.array([actuator.effort for actuator in self.actuators.values()])

    @property
    def motions(self) -> np.ndarray:
        """(actuators,) m, m^3 or rad."""
        return np.array([actuator.motion for actuator in self.actuators.values()])

    @property
    def slack(self) -> np.ndarray:
        """(actuators,) bool: cables without tension that are commanded in length."""
        return self.pulls_only & self.by_motion & (self.efforts <= 0.0)

    def positions(self) -> dict[str, np.ndarray]:
        """(3,) position (m) or rotation vector (rad) of each effector."""
        return {name: np.array(effector.value) for name, effector in self.effectors.items()}

    def difference(self, name: str, to: np.ndarray, start: np.ndarray) -> np.ndarray:
        """(3,): difference between two values of an effector."""
        return rotations.difference(to, start) if self.effectors[name].unit == "rad" else to - start

    def shifted(self, name: str, value: np.ndarray, difference: np.ndarray) -> np.ndarray:
        """(3,): a value of an effector plus a difference."""
        return rotations.product(difference, value) if self.effectors[name].unit == "rad" else value + difference

    def rows(self, differences: Mapping[str, np.ndarray]) -> np.ndarray:
        """(rows,): differences (3,) of the effectors along their directions."""
        return np.concatenate([d @ differences[name] for name, d in zip(self.effectors, self.directions)])

    def response(self) -> Answer:
        """Response at the present state. Raises RunError: singular-matrix."""
        found = self.sim.response(list(self.actuators))
        w_ea = np.vstack([found.W_ea[name] for name in self.effectors])
        return Answer(w_ea, found.W_aa, self.jacobian_of(w_ea, found.W_aa))

    def jacobian_of(self, w_ea: np.ndarray, w_aa: np.ndarray) -> np.ndarray:
        """(rows, actuators): of effectors with respect to commands."""
        return condensed(w_ea, w_aa, self.by_motion, self.slack)

    def send(self, sim: Any, commands: Mapping[str, float]) -> None:
        """Sends commands to a simulation with these actuators."""
        quantities = self.quantities
        for name, value in commands.items():
            setattr(sim.actuator(name), quantities[name], value)
