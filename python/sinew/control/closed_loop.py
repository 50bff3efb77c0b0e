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

    The desired velocity of the effectors is v = dr/dt + rate e + integral (time integral of e). A small quadratic
    program finds the changes u of the efforts that achieve it within the limits of efforts, motions and rates,

        min |W_ea u - v T|^2_Q + s change |u|^2_W_aa + s relaxation |lambda + u|^2_W_aa,

    and the commands are the motions m + W_aa u (or the efforts lambda + u), that is J_model^+ v T with
    J_model = W_ea W_aa^-1 and the static compliance W (Simulation.response()). The model receives the same commands as
    the robot: W is the compliance at the state of the robot, up to the errors of the model.

    The errors decrease if the symmetric part of J_real J_model^+ is positive definite (Zhang, Dequidt, Kruszewski,
    Largilliere & Duriez, IROS 2016; Zhang et al., IEEE Robotics and Automation Letters 3 (2018) 1529-1536): then
    d|e|^2/dt = -2 rate e^T J_real J_model^+ e < 0. `least_eigenvalue` reports the condition in every step, including
    the active limits. docs/closed_loop.md derives it and the largest gain for a delay.

    Anti-windup: the motion prevented by limits is subtracted from the integral (back-calculation).

    If a measurement is missing, all commands are held for the time `hold`. After that the model, corrected by the last
    measured difference, replaces the measurement until it is back; `status` reports it.

    Parameters
    ----------
    model : Simulation
        Model of the robot, usually quasi-static, in the same state and with the same commands. The loop commands and
        steps it once per step(): its time step is the sample time of the loop.
    effectors : dict
        Targets by name of the effector: (3,) array_like (m; for an orientation effector the rotation vector, rad), or a
        Circle, Polyline or Trajectory over the time given to step().
    actuators : list of str, optional
        Actuators to use; by default all that take commands. The others keep their commands.
    gains : Gains, Schedule or float
        A number is the rate, 1/s.
    sensors : dict or list of Sensor, optional
        Sensor of each effector, a marker or an orientation sensor of a plant or robot (`plant.sensor('camera')`), or a
        list if sensors and effectors have the same names. step() then uses the delivered samples, with their rate, delay
        and dropouts. Without sensors, step() takes exact and current measurements.
    command : 'motion', 'effort' or dict by actuator, optional
        Commanded quantity: by default the motion (displacement, angle), for chambers the pressure.
    weights : dict, optional
        Weight of each effector, or one per direction; >= 0.
    compensate : bool
        Whether to compensate the age of samples with the model (Smith predictor, Chem. Eng. Prog. 53 (1957) 217): the
        error is the present error of the model, corrected by the difference between the measurement and the model at the
        time of the sample.
    tolerance : float
        Distance below which an effector is on target, m (or rad).
    change, relaxation : float
        Weights of the changes of efforts and of the efforts in the program.
    hold : float
        Time for which commands are held if a measurement is missing, s: if the sample is invalid, or older than the
        delay and period of its sensor.
    real_jacobian : 'estimate', 'model' or callable
        J_real of `least_eigenvalue`: estimated from measured motions (JacobianEstimator), the Jacobian of the model, or a
        function without arguments that returns it, (rows, actuators), for example control.jacobian() of a plant.
    estimator : dict, optional
        Arguments of JacobianEstimator: `noise` (1e-4 m) and `noise_rotation` (1e-3 rad), standard deviations of
        measurements without a sensor that specifies them; `spread` (0.3), of the relative error of the model's Jacobian;
        `forgetting` (0.9); `window` (5), samples between measured differences.

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
        self._integral = np.zeros(len(self._row_weights))  # time integral of the error, m s

    @property
    def gains(self) -> Union[Gains, Schedule]:
        """Gains of the next step."""
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
            raise Error("wrong-type", f"{self._place}(gains)", f"{gains!r} are not gains",
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
