"""Iterative learning of dynamic reaching motions: identify, plan, invert, run, repeat.

    from sinew import learn, pcc
    learner = learn.Learner(arm, actuators, cylinders, goal=[0.20, 0.0, -0.40], torque_limits=[0.12, 0.13, 0.18])
    for attempt in learner.run(plant, attempts=5):    # plant(command) -> sinew.identify.MotionRecord
        print(attempt.tip_error)                      # m, as measured

For hardware, run the command of `learner.propose()` yourself and pass the measurement to
`learner.observe(record)`. docs/learning.md describes the method and its accuracy. SI units everywhere.
"""

from __future__ import annotations

from typing import Any, Callable, Iterator, Mapping, NamedTuple, Optional, Sequence

import numpy as np

from . import errors, identify, pcc, plan

__all__ = ["Attempt", "Learner", "Proposal"]

_HAT = 0.1  # s, half the width of the hat functions that change commands


class Proposal(NamedTuple):
    """The next attempt.

    Attributes
    ----------
    times : (samples,) s
        From 0 to lead + duration, the time at which the tip should be at the goal.
    command : (samples, inputs)
        Commands of the cylinders.
    volume : (samples, inputs) m^3
        Predicted volumes.
    plan : Plan
        Plan from which the commands were derived; its time 0 is `lead`.
    predicted : (3,) m
        Predicted final position of the tip.
    arm, actuators, cylinders
        Model used for the proposal.
    """

    times: np.ndarray
    command: np.ndarray
    volume: np.ndarray
    plan: plan.Plan
    predicted: np.ndarray
    arm: pcc.Arm
    actuators: list[pcc.FluidicActuator]
    cylinders: list[pcc.DriveCylinder]


class Attempt(NamedTuple):
    """Outcome of a proposal.

    Attributes
    ----------
    proposal : Proposal
    record : sinew.identify.MotionRecord
        Measured motion.
    tip_error : float
        Measured final distance of the tip from the goal, m.
    fit : sinew.identify.ArmFit or None
        Fit of the arm after the attempt; None if it failed, in which case the model is unchanged.
    """

    proposal: Proposal
    record: identify.MotionRecord
    tip_error: float
    fit: Optional[identify.ArmFit]


class Learner:
    """Brings an arm's tip to a goal beyond its static workspace, with a model that is refitted after each attempt.

    A swing is planned with the current model (plan.Task), inverted through actuators and cylinders
    (plan.invert_drive), run and measured. Then the arm and the actuators are fitted to the latest records
    (identify.fit_arm), and the cylinders to all records (identify.fit_cylinder). The commands of the next attempt are the
    previous ones with the smallest change that moves the tip of the model to the goal, corrected for the final error of
    the model in that attempt. If there is no such change, the swing is planned again.

    Parameters
    ----------
    arm : sinew.pcc.Arm
    actuators : list of FluidicActuator
    cylinders : list of DriveCylinder
        Initial model, with one of each per input; all cylinders have the same sample time.
    goal : (3,) m
    torque_limits : (inputs,) N m
        Limits in both directions, for the initial model. The corresponding volumes are kept as limits, because motion data
        do not determine the scale of the torques.
    torque_rate_limits : (inputs,) or float, N m/s
    duration : float
        Duration of the plan, s.
    lead : float
        Time before the plan, s, for the delay and the start of the cylinders.
    memory : int
        Number of latest records that the arm is fitted to: an imperfect model holds only near them.
    corrections : int
        Maximum number of Gauss-Newton steps when changing commands.
    close : float
        Distance of the model's tip from the goal beyond which the swing is planned again, m.
    time_step : float
        Time step of the simulations, s.
    fit_options, plan_options : dict, optional
        Further arguments of identify.fit_arm (except its time step) and plan.Task.
    seed : int
        Random seed of the first plan.

    Raises
    ------
    Error
        wrong-length, out-of-range, and the errors of plan.Task.
    """

    def __init__(
        self,
        arm: pcc.Arm,
        actuators: Sequence[pcc.FluidicActuator],
        cylinders: Sequence[pcc.DriveCylinder],
        goal: Sequence[float],
        torque_limits: Sequence[float],
        *,
        torque_rate_limits: Any = 2.0,
        duration: float = 1.6,
        lead: float = 0.25,
        memory: int = 1,
        corrections: int = 4,
        close: float = 2e-3,
        time_step: float = 0.02,
        fit_options: Optional[Mapping[str, Any]] = None,
        plan_options: Optional[Mapping[str, Any]] = None,
        seed: int = 1,
    ) -> None:
        for name, value in (("memory", memory), ("corrections", corrections)):
            if value < 1:
                raise errors.Error("out-of-range", errors.Location(item=name), f"it is {value}", "give 1 or more")
        if len(actuators) != len(cylinders):
            raise errors.Error("wrong-length", errors.Location(item="cylinders"),
                               f"{len(actuators)} actuators and {len(cylinders)} cylinders",
                               "give a cylinder for each actuator")
        self._first_arm, self._first_actuators = arm, list(actuators)
        self.arm, self.actuators, self.cylinders = arm, list(actuators), list(cylinders)
        self.goal = np.array(goal, dtype=float)
        self.attempts: list[Attempt] = []
        self._motions: list[tuple[np.ndarray, identify.MotionRecord]] = []
        self._task = {"torque_rate_limits": torque_rate_limits, "duration": duration, **(plan_options or {})}
        self._volume_limits = [float(a.volume(t)) for a, t in zip(self.actuators, torque_limits)]
        self._fit_options = dict(fit_options or {})
        self._lead, self._memory, self._corrections, self._close = lead, memory, corrections, close
        self._seed, self._time_step = seed, time_step
        self._last: Optional[Proposal] = None
        self._proposal: Optional[Proposal] = None
        self._missed = np.zeros(3)  # measured minus modelled final position, fitted model, last attempt
        plan.Task(arm, self.goal, torque_limits, **self._task)

    def learn_from(self, command: np.ndarray, record: identify.MotionRecord) -> Optional[identify.ArmFit]:
        """Fits the model to a motion from rest before the first attempt: an excitation or a rehearsal.

        Parameters
        ----------
        command : (samples, inputs)
            Commands of the cylinders, at their sample time.
        record : sinew.identify.MotionRecord
            Motion measured at the same times; its inputs are the delivered volumes, m^3.

        Returns
        -------
        ArmFit or None
            None if the fit failed; the model is then unchanged.

        Raises
        ------
        Error
            wrong-length: another number of samples.
        """
        command = np.asarray(command, dtype=float)
        if len(record.time) != len(command):
            raise errors.Error("wrong-length", errors.Location(item="record"),
                               f"{len(record.time)} samples for {len(command)} commands", "measure at their times")
        self._motions.append((command, record))
        return self._identify()

    def rehearsal(self, fraction: float = 0.9) -> np.ndarray:
        """Commands (samples, inputs) of the next attempt at a fraction of its volumes, for learn_from() before the
        attempt.

        Parameters
        ----------
        fraction : float
            Above 0, below 1. The torque scales with its cube.

        Raises
        ------
        Error
            out-of-range: the fraction.
        RunError
            not-converged: no plan could be simulated.
        """
        if not 0.0 < fraction < 1.0:
            raise errors.Error("out-of-range", errors.Location(item="fraction"), f"it is {fraction}",
                               "give a number between 0 and 1")
        return fraction * self._next().command

    def propose(self) -> Proposal:
        """Commands of the next attempt.

        Raises
        ------
        RunError
            not-converged: no plan could be simulated.
        """
        self._proposal = self._next()
        return self._proposal

    def observe(self, record: identify.MotionRecord) -> Attempt:
        """Learns from the measurement of the last proposal.

        Parameters
        ----------
        record : sinew.identify.MotionRecord
            Motion at the proposal's times; its inputs are the delivered volumes, m^3.

        Raises
        ------
        Error
            wrong-length: another number of samples; out-of-range: nothing was proposed.
        """
        proposal = self._proposal
        if proposal is None:
            raise errors.Error("out-of-range", errors.Location(item="observe"), "no proposal to observe", "call propose() first")
        fit = self.learn_from(proposal.command, record)
        residual = (record.positions - fit.records[-1].predicted)[-5:, -1] if fit else np.full((1, 3), np.nan)
        if np.isfinite(residual).any(axis=0).all():
            self._missed = np.nanmean(residual, axis=0)
        ends = record.positions[:, -1]
        seen = np.flatnonzero(np.isfinite(ends).all(axis=1))
        error = float(np.linalg.norm(ends[seen[-1]] - self.goal)) if len(seen) else float("nan")
        self.attempts.append(Attempt(proposal, record, error, fit))
        self._proposal = None
        return self.attempts[-1]

    def run(self, plant: Callable[[np.ndarray], identify.MotionRecord], attempts: int) -> Iterator[Attempt]:
        """Runs attempts on a plant: plant(command (samples, inputs)) returns the record."""
        for _ in range(attempts):
            yield self.observe(plant(self.propose().command))

    def _next(self) -> Proposal:
        """The corrected last commands, or those of a new plan if the model cannot reach the goal with them."""
        best = self._corrected(self._last.plan, self._last.command) if self._last else None
        if best is None or self._left(best) > self._close:
            planned = self._planned()
            if planned is not None and (best is None or self._left(planned) < self._left(best)):
                best = planned
        if best is None:
            raise errors.RunError("not-converged", errors.Location(item="goal"), "no plan could be simulated",
                                  "give more time or torque, or a looser plan")
        self._last = best
        return best

    def _planned(self) -> Optional[Proposal]:
        limits = [float(a.torque(v)) for a, v in zip(self.actuators, self._volume_limits)]
        task = plan.Task(self.arm, self.goal, limits, **self._task)
        found = task.solve(warm=self._last.plan, max_iterations=100) if self._last else None
        if found is None or not found.found:
            found = task.solve(self._seed, max_iterations=100)
        # The correction can start even from a plan that violates a limit or misses the goal.
        drive = plan.invert_drive(found, self.actuators, self.cylinders, lead=self._lead)
        return self._corrected(found, drive["command"]) if drive["found"] else None

    def _corrected(self, found: plan.Plan, command: np.ndarray) -> Optional[Proposal]:
        """Commands with the smallest change that moves the model's tip to the goal: Gauss-Newton, with each step halved until the
        tip comes closer.
        """
        best = self._simulated(found, command)
        for _ in range(self._corrections):
            if best is None or self._left(best) < 0.1 * self._close:
                break
            try:
                change = self._least_change(best)
            except errors.RunError:
                break
            tried = (self._simulated(found, best.command + share * change) for share in (1.0, 0.5, 0.25))
            nearer = next((t for t in tried if t is not None and self._left(t) < self._left(best)), None)
            if nearer is None:
                break
            best = nearer
        return best

    def _least_change(self, proposal: Proposal) -> np.ndarray:
        """Smallest change B x of the commands, (samples, inputs), that brings the model's tip to the goal.

        The columns of B are hat functions in time, x are their heights for each input. Minimises |B x|^2 subject to
        J x = goal - tip, with J by differences. Hat functions that would exceed a volume limit are omitted.
        """
        samples, inputs = proposal.command.shape
        hats = self._hats(samples)
        count = hats.shape[1]
        size = 0.01 * max(self._volume_limits)
        end = self._end(proposal.volume)
        by_height = np.zeros((3, inputs, count))
        raised = np.zeros((samples, inputs, count))  # d volume / d height
        for k in range(inputs):
            for i in range(count):
                volume = proposal.volume.copy()
                volume[:, k] = self.cylinders[k].simulate(proposal.command[:, k] + size * hats[:, i])
                by_height[:, k, i] = (self._end(volume) - end) / size
                raised[:, k, i] = (volume[:, k] - proposal.volume[:, k]) / size
        # With y = R x and B^T B = R^T R, the norm of the change |B x| equals |y|.
        shape = np.linalg.inv(np.linalg.cholesky(hats.T @ hats)).T
        used = np.ones((inputs, count), dtype=bool)
        limits = np.maximum(self._volume_limits, np.abs(proposal.volume))
        left = self.goal - proposal.predicted
        for _ in range(count):
            weighted = np.where(used, by_height, 0.0) @ shape
            heights = np.linalg.lstsq(weighted.reshape(3, -1), left, rcond=1e-6)[0].reshape(inputs, count) @ shape.T
            heights = np.where(used, heights, 0.0)
            volume = proposal.volume + np.einsum("ski,ki->sk", raised, heights)
            beyond = np.abs(volume) > limits * (1.0 + 1e-9)
            outward = np.einsum("sk,ski->ki", beyond * np.sign(volume), raised) * heights > 0.0
            if not (outward & used).any():
                break
            used &= ~outward
        return hats @ heights.T

    def _hats(self, samples: int) -> np.ndarray:
        step = self.cylinders[0].sample_time
        time = step * np.arange(samples)
        width = min(_HAT, 0.25 * time[-1])
        centres = np.arange(width, time[-1] - 0.5 * width, width)  # none near the end, where commands no longer move the tip
        return np.maximum(0.0, 1.0 - np.abs(time[:, None] - centres) / width)

    def _simulated(self, found: plan.Plan, command: np.ndarray) -> Optional[Proposal]:
        command = np.stack([np.clip(u, *c.input_limits) for c, u in zip(self.cylinders, command.T)], axis=1)
        volume = np.stack([c.simulate(u) for c, u in zip(self.cylinders, command.T)], axis=1)
        try:
            end = self._end(volume)
        except errors.RunError:
            return None
        times = self.cylinders[0].sample_time * np.arange(len(command))
        return Proposal(times, command, volume, found, end + self._missed, self.arm, self.actuators, self.cylinders)

    def _end(self, volume: np.ndarray) -> np.ndarray:
        """(3,) m, final tip position of the model for volumes (samples, inputs)."""
        times = self.cylinders[0].sample_time * np.arange(len(volume))
        return identify.predict_motion(self.arm, times, np.zeros(self.arm.coordinates), inputs=volume,
                                       actuators=self.actuators, time_step=self._time_step)[-1, -1]

    def _left(self, proposal: Proposal) -> float:
        return float(np.linalg.norm(self.goal - proposal.predicted))

    def _identify(self) -> Optional[identify.ArmFit]:
        records = [record for _, record in self._motions]
        self.cylinders = [self._fitted_cylinder(k) for k in range(len(self.cylinders))]
        try:
            fit = identify.fit_arm(self._first_arm, records[-self._memory:], actuators=self._first_actuators,
                                   time_step=self._time_step, **self._fit_options)
        except errors.RunError:
            return None
        self.arm, self.actuators = fit.arm, list(fit.actuators)
        return fit

    def _fitted_cylinder(self, k: int) -> pcc.DriveCylinder:
        """Cylinder fitted to all records, with the limits of the previous one."""
        before = self.cylinders[k]
        records = [(command[:, k], record.inputs[:, k], before.sample_time) for command, record in self._motions]
        try:
            found = identify.fit_cylinder(records)[0]
            return pcc.DriveCylinder(found.a, found.b, found.c, found.d, sample_time=before.sample_time,
                                     input_limits=before.input_limits, volume_limits=before.volume_limits)
        except errors.Error:
            return before
