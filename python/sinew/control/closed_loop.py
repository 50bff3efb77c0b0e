"""Feedback on measured effectors: resolved rate and PI."""

from __future__ import annotations

from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from .gains import Gains, Schedule
from .loop import Loop
from .program import Choice, Standing, Weights, choose
from .robot import Answer

__all__ = ["ClosedLoop"]


class ClosedLoop(Loop):
    """Brings measured effectors to their targets by a resolved-rate or PI law with the Jacobian of a model.

    The effectors are asked for the velocity v = dr/dt + rate e + integral (time integral of e). A small quadratic
    program finds the changes u of efforts that give it within the limits of efforts, motions and their rates,

        min |W_ea u - v T|^2_Q + s change |u|^2_W_aa + s relaxation |lambda + u|^2_W_aa,

    and the actuators are commanded the motions m + W_aa u (or the efforts lambda + u), that is J_model^+ v T with
    J_model = W_ea W_aa^-1, the compliance being that of equilibrium (Simulation.response()). The model obeys the same
    commands beside the robot, so that W belongs to where the robot is, up to the model's errors.

    The errors fall where the symmetric part of J_real J_model^+ is positive definite (Zhang, Dequidt, Kruszewski,
    Largilliere & Duriez, IROS 2016; Zhang et al., IEEE Robotics and Automation Letters 3 (2018) 1529-1536): then
    d|e|^2/dt = -2 rate e^T J_real J_model^+ e < 0. `least_eigenvalue` reports it in each step, with the limits that
    are active. docs/closed_loop.md derives both, and the largest gain for a delay.

    While an integral acts, what limits keep from the effectors is taken off it (back-calculation).

    When a measurement stays away, all commands are held for the time `hold`; after that the model stands in for it,
    corrected by the last difference, until it is back: `status` says so.

    Parameters
    ----------
    model : Simulation
        Of the robot, quasi-static as a rule, in the state and with the commands that the robot has. The loop commands
        it and steps it, once in each step(): its time step is the loop's.
    effectors : dict
        Names to targets: (3,) array_like (m; for an orientation effector the rotation vector, rad), or a Circle,
        Polyline or Trajectory over the time given to step().
    actuators : list of str, optional
        Which it may use; all that take commands by default. The model's others keep their commands.
    gains : Gains, Schedule or float
        A number is the rate, 1/s.
    sensors : dict or list of Sensor, optional
        Of each effector the sensor of a plant or of a robot that measures it: a marker, or an orientation
        (`plant.sensor('camera')`); a list where their names are those of the effectors. step() then takes the
        samples that have been delivered, with their rate, delay and losses. Without, step() is given measurements
        that are exact and of now.
    command : 'motion', 'effort' or dict by actuator, optional
        What actuators are commanded: a motion by default (displacement, angle), but chambers their pressure.
    weights : dict, optional
        Effectors to one weight, or one for each of its directions; >= 0.
    compensate : bool
        Whether the age of samples is made up for by the model (Smith, Chem. Eng. Prog. 53 (1957) 217): the error is
        that of the model now, corrected by what was measured less what the model had then.
    tolerance : float
        m (or rad): an effector measured this near is on target.
    change, relaxation : float
        Weights of the program: of changes of efforts, and of efforts themselves.
    hold : float
        s, for how long commands are held when measurements stay away: a sample that is not valid, or older than its
        sensor's delay and period.
    real_jacobian : 'estimate', 'model' or callable
        The J_real of `least_eigenvalue`: estimated from measured motions (JacobianEstimator); that of the model; or a
        function without arguments that returns it, (rows, actuators), as control.jacobian() does for a plant.
    estimator : dict, optional
        Of JacobianEstimator: `noise` (1e-4 m) and `noise_rotation` (1e-3 rad), standard deviations of measurements
        where no sensor says its own;
        `spread` (0.3), of the relative error of the model's Jacobian; `forgetting` (0.9); `window` (5), samples from
        one measured difference to the next.

    Raises
    ------
    Error
        wrong-type, no-effectors, no-actuators, unknown-name, missing-key (a sensor), unknown-choice, wrong-shape, not-finite, out-of-range,
        suspicious-unit, wrong-actuator-type; actuator-owned: a controller is attached to the model.
    """

    def __init__(
        self,
        model: Any,
        effectors: Mapping[str, Any],
        actuators: Optional[Sequence[str]] = None,
        gains: Union[Gains, Schedule, float] = Gains(),
        *,
        sensors: Union[Mapping[str, Any], Sequence[Any], None] = None,
        command: Union[str, Mapping[str, str], None] = None,
        weights: Optional[Mapping[str, Any]] = None,
        compensate: bool = False,
        tolerance: float = 5e-4,
        change: float = 1e-5,
        relaxation: float = 1e-7,
        hold: float = 0.1,
        real_jacobian: Union[str, Callable[[], np.ndarray]] = "estimate",
        estimator: Optional[Mapping[str, Any]] = None,
    ) -> None:
        super().__init__(model, effectors, actuators, command, weights, tolerance, sensors, hold, real_jacobian, estimator)
        self.gains = gains
        self._compensate = bool(compensate)
        self._weights = Weights.checked(self._row_weights, change, relaxation, self._place)
        self._integral = np.zeros(len(self._row_weights))  # of the error, m s

    @property
    def gains(self) -> Union[Gains, Schedule]:
        """Assigning them takes effect in the next step."""
        return self._gains

    @gains.setter
    def gains(self, gains: Union[Gains, Schedule, float]) -> None:
        if isinstance(gains, Schedule):
            self._gains: Union[Gains, Schedule] = gains
        elif isinstance(gains, (int, float)) and not isinstance(gains, bool):
            self._gains = Gains(float(gains)).check("gains")
        elif isinstance(gains, tuple) and len(gains) == 2:
            self._gains = Gains(*gains).check("gains")
        else:
            raise Error("wrong-type", f"{self._place}(gains)", f"{gains!r} are no gains",
                        "give Gains, a Schedule or a rate")

    def _choose(self, answer: Answer, standing: Standing, found: Mapping[str, Any]) -> Choice:
        robot, time_step, time = self._robot, self.model.time_step, self._time
        gains = self._gains.at(self._gains.variable(self)) if isinstance(self._gains, Schedule) else self._gains
        predicted: Mapping[str, Any] = {name: None for name in found}
        error = robot.rows(self._differences(predicted if self._compensate else found, time))
        next_targets = {name: self._target(name, time + time_step) for name in found}
        ahead = robot.rows({name: robot.difference(name, target, self._target(name, time))
                            for name, target in next_targets.items()})
        velocity = ahead / time_step + gains.rate * error + gains.integral * self._integral
        choice = choose(robot, answer, standing, time_step * velocity[None, :], self._weights, time_step)
        if gains.integral > 0.0:
            missed = velocity - answer.w_ea @ choice.change / time_step
            self._integral = self._integral + time_step * (error - missed / gains.rate)
        return choice

    def _state(self) -> tuple:
        return (self._integral.copy(),)

    def _restore(self, state: tuple) -> None:
        self._integral = state[0].copy()
