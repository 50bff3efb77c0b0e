"""Model predictive control of measured effectors."""

from __future__ import annotations

from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np

from ..errors import Error
from .loop import Loop
from .program import Choice, Standing, Weights, choose
from .robot import Answer

__all__ = ["PredictiveController"]


class PredictiveController(Loop):
    """Brings measured effectors to their targets over a short horizon of linearised steps, within all limits.

    In each step, the changes z_1 .. z_N of the efforts after the next N steps minimise

        sum_j |x + b + W_ea z_j - r_j|^2_Q + s change |z_j - z_(j-1)|^2_W_aa + s relaxation |lambda + z_j|^2_W_aa

    within the limits of efforts, motions and their rates in all steps. z_1 is applied, and the next step solves the problem
    anew. x are the effectors of the model, which receives the same commands as the robot. r_j are the targets at the ends of
    the steps, so moving targets are anticipated. b is the measurement minus the model at the time of the sample, filtered:
    b <- b + observer (y - x(t - age) - b). A constant difference between robot and model therefore leaves no error at rest
    (dynamic matrix control: Cutler & Ramaker, Joint Automatic Control Conf. 1980; offset-free by the disturbance b: Muske &
    Badgwell, J. Process Control 12 (2002) 617-632). The steps are steps of equilibrium, without inertia.

    The prediction contains the delay. With an exact model b does not depend on the commands, and the delay sets no limit.
    Model errors make b depend on them. A smaller `observer` tolerates larger model errors and passes less noise.

    Parameters
    ----------
    model, effectors, actuators, sensors, command, weights, tolerance, hold, real_jacobian, estimator
        See ClosedLoop.
    horizon : int
        N, number of steps.
    change : float
        Weight of the changes of efforts between steps. Larger values give smoother motion.
    relaxation : float
        Weight of the efforts themselves.
    observer : float
        Fraction by which b follows a new difference per step; above 0, at most 1.

    Raises
    ------
    Error
        As ClosedLoop.
    """

    def __init__(
        self,
        model: Any,
        effectors: Mapping[str, Any],
        actuators: Optional[Sequence[str]] = None,
        *,
        horizon: int = 10,
        change: float = 1e-2,
        relaxation: float = 1e-5,
        observer: float = 0.2,
        sensors: Union[Mapping[str, Any], Sequence[Any], None] = None,
        command: Union[str, Mapping[str, str], None] = None,
        weights: Optional[Mapping[str, Any]] = None,
        tolerance: float = 5e-4,
        hold: float = 0.1,
        real_jacobian: Union[str, Callable[[], np.ndarray]] = "estimate",
        estimator: Optional[Mapping[str, Any]] = None,
    ) -> None:
        super().__init__(model, effectors, actuators, command, weights, tolerance, sensors, hold, real_jacobian, estimator)
        if not (isinstance(horizon, int) and 1 <= horizon <= 100):
            raise Error("out-of-range", f"{self._place}(horizon)", f"it is {horizon!r}", "give 1 to 100 steps")
        if not 0.0 < observer <= 1.0:
            raise Error("out-of-range", f"{self._place}(observer)", f"it is {observer!r}",
                        "give a number above 0, at most 1")
        self.horizon, self._observer = horizon, float(observer)
        self._weights = Weights.checked(self._row_weights, change, relaxation, self._place)

    def _choose(self, answer: Answer, standing: Standing, found: Mapping[str, Any]) -> Choice:
        time_step = self.model.time_step
        predicted: Mapping[str, Any] = {name: None for name in found}
        wanted = np.array([self._robot.rows(self._differences(predicted, self._time + (step + 1) * time_step))
                           for step in range(self.horizon)])
        return choose(self._robot, answer, standing, wanted, self._weights, time_step)
