"""Grabs learned from attempt to attempt: identify, plan, invert, run, repeat.

    from sinew import learn, pcc
    learner = learn.Learner(arm, actuators, cylinders, goal=[0.20, 0.0, -0.40], torque_limits=[0.12, 0.13, 0.18])
    for attempt in learner.run(plant, attempts=5):    # plant(command) -> sinew.identify.MotionRecord
        print(attempt.tip_error)                      # m, as measured

A robot that is no function runs `learner.propose().command` and hands back what was measured with
`learner.observe(record)`. docs/learning.md has the method and what it reaches. SI units everywhere.
"""

from __future__ import annotations

from typing import Any, Callable, Iterator, Mapping, NamedTuple, Optional, Sequence

import numpy as np

from . import errors, identify, pcc, plan

__all__ = ["Attempt", "Learner", "Proposal"]


class Proposal(NamedTuple):
    """What is to be run next.

    Attributes
    ----------
    times : (samples,) s
        From 0 to lead + duration, when the tip is to be at the goal.
    command : (samples, inputs)
        Of the cylinders.
    volume : (samples, inputs) m^3
        That they are expected to deliver.
    plan : Plan
        Of the model; its time 0 is `lead`.
    predicted : (3,) m
        Where the tip is expected at the end.
    arm, actuators, cylinders
        The model that it was made with.
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
    """What became of a proposal.

    Attributes
    ----------
    proposal : Proposal
    record : sinew.identify.MotionRecord
        What was measured.
    tip_error : float
        m, measured distance of the tip from the goal at the end.
    fit : sinew.identify.ArmFit or None
        Of the arm after it; None where the fit failed and the model stays.
    """

    proposal: Proposal
    record: identify.MotionRecord
    tip_error: float
    fit: Optional[identify.ArmFit]


class Learner:
    """Brings an arm's tip to a goal that it cannot hold, with a model that learns from each attempt.

    An attempt is planned with the model as it is (plan.Task), taken back through actuators and
    cylinders (plan.invert_drive), run and measured; then arm and actuators are fitted to the latest
    records (identify.fit_arm) and the cylinders to all (identify.fit_cylinder). What the model still
    misses at the end of the last attempt, and what the cylinders cannot follow, moves the plan's aim.

    Parameters
    ----------
    arm : sinew.pcc.Arm
    actuators : list of FluidicActuator
    cylinders : list of DriveCylinder
        The model at first; one of each for each input, cylinders of one sample time.
    goal : (3,) m
    torque_limits : (inputs,) N m
        Either way, by the first model; what is kept are the volumes that they take, as motion leaves the scale of
        torques open.
    torque_rate_limits : (inputs,) or float, N m/s
    duration : float
        s, of the plan.
    lead : float
        s before it, for the delay and for the cylinders to start.
    memory : int
        Latest records that the arm is fitted to: a model that is wrong is right near them only.
    corrections : int
        Most plans made for a proposal, until the model with its cylinders is within `close` of the goal.
    close : float
        m.
    fit_options, plan_options : dict, optional
        More for identify.fit_arm and plan.Task.
    seed : int
        Of the first plan.

    Raises
    ------
    Error
        wrong-length, out-of-range and what plan.Task raises.
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
        fit_options: Optional[Mapping[str, Any]] = None,
        plan_options: Optional[Mapping[str, Any]] = None,
        seed: int = 1,
    ) -> None:
        for name, value in (("memory", memory), ("corrections", corrections)):
            if value < 1:
                raise errors.Error("out-of-range", errors.Place(item=name), f"it is {value}", "give 1 or more")
        if len(actuators) != len(cylinders):
            raise errors.Error("wrong-length", errors.Place(item="cylinders"),
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
        self._seed = seed
        self._plan: Optional[plan.Plan] = None
        self._proposal: Optional[Proposal] = None
        self._aim = self.goal.copy()
        self._missed = np.zeros(3)  # of the fitted model at the last attempt's end
        plan.Task(arm, self.goal, torque_limits, **self._task)

    def learn_from(self, command: np.ndarray, record: identify.MotionRecord) -> Optional[identify.ArmFit]:
        """Fits the model to a motion before the first attempt, from rest, of the arm's free excitation for example.

        Parameters
        ----------
        command : (samples, inputs)
            Of the cylinders, in their sample time.
        record : sinew.identify.MotionRecord
            What was measured at the same times; its inputs are the volumes delivered, m^3.

        Returns
        -------
        ArmFit or None
            None where the fit failed and the model stays.

        Raises
        ------
        Error
            wrong-length: another number of samples.
        """
        command = np.asarray(command, dtype=float)
        if len(record.time) != len(command):
            raise errors.Error("wrong-length", errors.Place(item="record"),
                               f"{len(record.time)} samples for {len(command)} commands", "measure at their times")
        self._motions.append((command, record))
        return self._identify()

    def propose(self) -> Proposal:
        """The next attempt's commands.

        Raises
        ------
        RunError
            not-converged: no plan could be simulated.
        """
        best, least = None, np.inf
        aim = self._aim
        for _ in range(self._corrections):
            candidate = self._candidate(aim)
            if candidate is None:
                break
            left = self.goal - candidate.predicted
            if np.linalg.norm(left) < least:
                best, least, self._aim, self._plan = candidate, np.linalg.norm(left), aim, candidate.plan
            if least < self._close:
                break
            aim = aim + left
        if best is None:
            raise errors.RunError("not-converged", errors.Place(item="goal"), "no plan could be simulated",
                                  "give more time or torque, or a looser plan")
        self._proposal = best
        return best

    def observe(self, record: identify.MotionRecord) -> Attempt:
        """Takes in what was measured of the last proposal.

        Parameters
        ----------
        record : sinew.identify.MotionRecord
            At the proposal's times; its inputs are the volumes delivered, m^3.

        Raises
        ------
        Error
            wrong-length: another number of samples; out-of-range: nothing was proposed.
        """
        proposal = self._proposal
        if proposal is None:
            raise errors.Error("out-of-range", errors.Place(item="observe"), "nothing was proposed", "call propose()")
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
        """Attempts on a plant: plant(command (samples, inputs)) gives the record."""
        for _ in range(attempts):
            yield self.observe(plant(self.propose().command))

    def _candidate(self, aim: np.ndarray) -> Optional[Proposal]:
        try:
            limits = [float(a.torque(v)) for a, v in zip(self.actuators, self._volume_limits)]
            task = plan.Task(self.arm, aim, limits, **self._task)
        except errors.Error:
            return None  # the aim went beyond the arm
        found = None if self._plan is None else task.solve(warm=self._plan, max_iterations=100)
        if found is None or not found.found:
            found = task.solve(self._seed, max_iterations=100)
        # One that breaks a limit or ends beside its aim is still worth an attempt: its motion decides, as simulated
        # here.
        drive = plan.invert_drive(found, self.actuators, self.cylinders, lead=self._lead)
        if not drive["found"]:
            return None
        try:
            ends = identify.predict_motion(self.arm, drive["times"], np.zeros(found.theta.shape[1]),
                                           inputs=drive["volume"], actuators=self.actuators)
        except errors.RunError:
            return None
        return Proposal(drive["times"], drive["command"], drive["volume"], found, ends[-1, -1] + self._missed,
                        self.arm, self.actuators, self.cylinders)

    def _identify(self) -> Optional[identify.ArmFit]:
        records = [record for _, record in self._motions]
        self.cylinders = [self._fitted_cylinder(k) for k in range(len(self.cylinders))]
        try:
            fit = identify.fit_arm(self._first_arm, records[-self._memory:], actuators=self._first_actuators,
                                   **self._fit_options)
        except errors.RunError:
            return None
        self.arm, self.actuators = fit.arm, list(fit.actuators)
        return fit

    def _fitted_cylinder(self, k: int) -> pcc.DriveCylinder:
        """Fitted to all records, with the limits of the one before."""
        before = self.cylinders[k]
        records = [(command[:, k], record.inputs[:, k], before.sample_time) for command, record in self._motions]
        try:
            found = identify.fit_cylinder(records)[0]
            return pcc.DriveCylinder(found.a, found.b, found.c, found.d, sample_time=before.sample_time,
                                     input_limits=before.input_limits, volume_limits=before.volume_limits)
        except errors.Error:
            return before
