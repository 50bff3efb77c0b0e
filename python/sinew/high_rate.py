"""Control and estimation at 500 Hz to 1 kHz beside a slower model: docs/high_rate.md is the guide."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from . import _core
from .errors import Error

__all__ = ["HighRateLoop", "HighRateOutput", "HighRateReport", "HighRateTimes", "Snapshot", "UdpReport"]


@dataclass
class Snapshot:
    """Linearised equations of a robot at one state: motions = free + compliance @ efforts.

    The rows follow the lists of the loop: `driven`, `unknown`, all rows of `effectors`, `hands`, then a normal and two
    tangents per contact. HighRateLoop.snapshot() creates one from a simulation.

    Attributes
    ----------
    compliance : (rows, rows) array_like
        W, m/N. The columns of effectors are ignored.
    free : (rows,) array_like
        Motions without efforts on these rows, m or rad.
    effort : (rows,) array_like, optional
        Efforts at the linearisation, N (default: zero).
    friction : (contacts,) array_like
        Coefficients of friction.
    time : float
        Time of the model, s.
    size : float
        Size of the robot, m, the scale of motions.
    """

    compliance: np.ndarray
    free: np.ndarray
    effort: np.ndarray = None
    friction: np.ndarray = ()
    time: float = 0.0
    size: float = 1.0


@dataclass(frozen=True)
class HighRateOutput:
    """Result of one period of a loop.

    Attributes
    ----------
    driven, driven_motion : dict
        Effort (N) of each driven actuator to apply in this period, and its predicted motion (m).
    unknown, deviation : dict
        Estimate and standard deviation of each unknown force, N. A deviation near the prior's means that the force is not
        observable.
    hands : dict
        Force of each hand on the robot, N; the hand feels the opposite force.
    tasks : dict
        Prediction for each task: (rows,) ndarray (m or rad) for an effector, float for a motion (m) or a hand (N).
    contacts : (max_contacts, 3) ndarray
        Normal and tangential forces, N; zero beyond the contacts of the snapshot.
    state : str
        'waiting' for the first snapshot, 'running', 'holding', 'releasing' or 'released' (docs/high_rate.md).
    cause : str
        Stale data: 'none', 'snapshot', 'input' or 'sensors'.
    limits_conflict, failed : bool
        Whether motion limits were relaxed in favour of effort limits; whether a program had no solution, in which case its
        part of the result is unchanged.
    law_residual : float
        Violation of the laws of hands and contacts, relative to the largest effort.
    snapshot_time, snapshot_age : float
        Time of the model, s; time since the loop received it, s.
    jump : float
        Largest change of a hand's force due to a new snapshot in this period, N.
    damping : float
        Damping added for passivity in this period, N s/m.
    energy_created : float
        Energy created by the forces on the hands since the start, J; not positive if passive.
    period : int
        Number of the output, from 1; 0 before the first.
    """

    driven: dict
    driven_motion: dict
    unknown: dict
    deviation: dict
    hands: dict
    tasks: dict
    contacts: np.ndarray
    state: str
    cause: str
    limits_conflict: bool
    failed: bool
    law_residual: float
    snapshot_time: float
    snapshot_age: float
    jump: float
    damping: float
    energy_created: float
    period: int


class HighRateReport(NamedTuple):
    """Counters of a loop since its creation.

    Attributes
    ----------
    periods, snapshots : int
        Number of outputs; number of snapshots used.
    missed : int
        Periods without an output in time.
    limits_conflicts, failures : int
        Number of periods with such a conflict or failure.
    real_time : bool
        Whether the thread has real-time priority (SCHED_FIFO).
    scheduling : str
        'SCHED_FIFO', or the reason why not and the remedy.
    """

    periods: int
    snapshots: int
    missed: int
    limits_conflicts: int
    failures: int
    real_time: bool
    scheduling: str


class UdpReport(NamedTuple):
    """Counters of a loop's socket.

    Attributes
    ----------
    port : int
        Port of the socket.
    received, invalid, outdated : int
        Valid measurements; invalid packets; repeated or late packets. The latter two are ignored.
    sent, not_sent : int
        Commands sent; commands that the operating system rejected.
    """

    port: int
    received: int
    invalid: int
    outdated: int
    sent: int
    not_sent: int


class HighRateTimes(NamedTuple):
    """Histogram of times in microseconds.

    Attributes
    ----------
    counts : (1001,) ndarray
        Number of times within [k, k + 1) us; the last entry counts times of 1 ms and more.
    longest : float
        Longest time, s.
    """

    counts: np.ndarray
    longest: float

    def quantile(self, part):
        """Quantile of the times, s, with a resolution of 1 us; 0 without data."""
        if self.counts.sum() == 0:
            return 0.0
        bin = int(np.searchsorted(np.cumsum(self.counts), part * self.counts.sum()))
        return self.longest if bin >= len(self.counts) - 1 else 1e-6 * (bin + 1)


def _refuse(kind, item, message, remedy):
    raise Error(kind, item, message, remedy)


def _pair(value, place, unit):
    try:
        low, high = (float(part) for part in value)
    except (TypeError, ValueError):
        _refuse("wrong-type", place, f"{value!r} is not a pair of limits", f"give (least, most) in {unit}")
    return low, high


def _number(value, place, unit):
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        return float(value)
    _refuse("wrong-type", place, f"{value!r} is not a number", f"give a number in {unit}")


class HighRateLoop:
    """Solves two small inverse problems per period on the latest snapshot of a robot: external forces from sensors, and
    efforts from targets, subject to the laws of hands and contacts. Its thread never blocks; the model is linearised in a
    thread of the caller, at 50 to 500 Hz:

        loop = sinew.HighRateLoop(sim, driven=["long_0", "long_1"], tasks={"tip": 1.0}, effectors=["tip"])
        with loop:                              # start() and stop()
            while ...:
                sim.step()
                loop.publish()                  # a snapshot of the simulation
                loop.set_input(targets={"tip": [0.0, 0.0, 0.18]})
                print(loop.output.driven)

    Parameters
    ----------
    sim : Simulation or None
        Simulation with the rows named below; None for snapshots from another source.
    driven : list of str, or dict of name: (least, most) effort
        Actuators whose efforts the loop chooses. Without limits here, the limits of the simulation's actuators apply,
        including their rates and motions.
    unknown : dict of name: float
        Actuators of type force that represent unmeasured external forces, with the prior standard deviation of each, N.
    effectors : list of str, or without a simulation dict of name: number of rows
        Effectors that are measured or controlled.
    hands : list of str, or dict of name: (least, most) force
        Actuators of type force that represent hands: the point follows the hand with a force (N) within these limits,
        which must include 0. Default (0, inf): a hand that pushes.
    sensors : dict of name: float
        Standard deviation (m or rad) of the measured motion of a driven actuator, or of every row of an effector.
    tasks : dict of name: float
        Weights of the targets: motion of an effector or a driven actuator, force of a hand.
    rate : float
        Periods per second, 10 to 10000.
    max_contacts : int
        Maximum number of contact points; those with a force or the smallest gap are used.
    blend : float
        Time over which a new snapshot is blended in, s.
    stale_after, release_time : float
        If the snapshot, the input (with sensors or hands) or any sensor value is older than `stale_after` (s), the efforts
        are held; after twice that time they ramp to zero within `release_time` (s).
    epsilon, largest_step : float
        As in InverseController.
    passivity : bool
        Whether to damp hands whose forces would create energy.
    reserve, damping_limit : float
        Additional dissipation as a fraction of the predicted energy; maximum damping relative to K T/2.
    udp : None or (str, int)
        Address and port (0: any) of a socket for measurements and commands; docs/high_rate.md specifies the packets.
        Sensors, hands and measured efforts are then read from it, and targets from set_input().

    Raises
    ------
    Error
        unknown-name, wrong-type, out-of-range, contradictory-limits, wrong-actuator-type, address-in-use, bad-argument.
    """

    def __init__(
        self, sim, *, driven=(), unknown=None, effectors=(), hands=(), sensors=None, tasks=None, rate=1000.0,
        max_contacts=12, blend=5e-3, stale_after=0.1, release_time=0.5, epsilon=1e-3, largest_step=0.02,
        passivity=True, reserve=0.5, damping_limit=4.0, udp=None,
    ):  # fmt: skip
        self._sim = sim
        self._driven, self._hands = list(driven), list(hands)
        self._unknown, self._effectors = list(unknown or {}), list(effectors)
        sizes = self._effector_sizes(effectors)
        self._rows = self._number_rows(sizes)
        sensors, tasks = sensors or {}, tasks or {}
        self._sensors = self._find("sensors", sensors, self._driven + self._effectors)
        self._tasks = self._find("tasks", tasks, self._driven + self._effectors + self._hands)
        settings = {
            "driven": self._driven_table(driven),
            "unknown": np.array([[_number(unknown[name], f"HighRateLoop(unknown['{name}'])", "N"), -np.inf, np.inf]
                                 for name in self._unknown]).reshape(-1, 3),
            "hands": self._hand_table(hands),
            "sensors": np.array([[row, _number(sensors[name], f"HighRateLoop(sensors['{name}'])", "m or rad")]
                                 for name, rows in self._sensors.items() for row in rows]).reshape(-1, 2),
            "tasks": np.array([[row, name in self._hands, _number(tasks[name], f"HighRateLoop(tasks['{name}'])", "no unit"),
                                self._turns(name)] for name, rows in self._tasks.items() for row in rows],
                              dtype=float).reshape(-1, 4),
            "observed": sum(sizes),
            "max_contacts": int(max_contacts),
            "passivity": bool(passivity),
        }  # fmt: skip
        self._max_contacts = int(max_contacts)
        rate = _number(rate, "HighRateLoop(rate)", "1/s")
        if not 10.0 <= rate <= 1e4:
            _refuse("out-of-range", "HighRateLoop(rate)", f"rate is {rate}", "give 10 to 10000 periods a second")
        settings["period"] = 1.0 / rate
        for name, value, unit in (("blend", blend, "s"), ("stale_after", stale_after, "s"), ("release_time", release_time, "s"),
                                  ("epsilon", epsilon, "no unit"), ("largest_step", largest_step, "no unit"),
                                  ("reserve", reserve, "no unit"), ("damping_limit", damping_limit, "no unit")):  # fmt: skip
            settings[name] = _number(value, f"HighRateLoop({name})", unit)
        self._loop = _core._HighRateLoop(settings, udp)
        self._input = {
            "sensors": {name: np.full(len(rows), np.nan) for name, rows in self._sensors.items()},
            "hands": {name: np.full(1, np.nan) for name in self._hands},
            "targets": {name: np.full(len(rows), np.nan) for name, rows in self._tasks.items()},
            "driven": {name: np.full(1, np.nan) for name in self._driven},
        }

    def _effector_sizes(self, effectors):
        if self._sim is None:
            if not isinstance(effectors, dict) and list(effectors):
                _refuse("wrong-type", "HighRateLoop(effectors)", f"{effectors!r} does not tell how many rows each has",
                        "give a dict such as {'tip': 3}")  # fmt: skip
            return [int(effectors[name]) for name in self._effectors]
        for name in self._effectors:
            self._sim.effector(name)  # raises unknown-name
        prefixes = {name: (f"{name}.", f"{name}[") for name in self._effectors}
        return [sum(row.startswith(prefixes[name]) for row in self._sim.rows) for name in self._effectors]

    def _turns(self, name):
        """Whether the rows of an effector or actuator are angles; false if only their number is known."""
        if self._sim is None or name in self._hands:
            return False
        if name in self._effectors:
            return self._sim.effector(name).unit == "rad"
        return "angle" in self._sim.actuator(name).limits

    def _number_rows(self, sizes):
        rows, count = {}, 0
        lists = [(self._driven, None), (self._unknown, None), (self._effectors, sizes), (self._hands, None)]
        for names, many in lists:
            for k, name in enumerate(names):
                if name in rows:
                    _refuse("bad-argument", "HighRateLoop", f"'{name}' is named twice",
                            "drive it, or take it for unknown, for an effector or for a hand's")  # fmt: skip
                size = many[k] if many else 1
                rows[name] = range(count, count + size)
                count += size
        return rows

    def _find(self, argument, names, allowed):
        for name in names:
            if name not in allowed:
                _refuse("unknown-name", f"HighRateLoop({argument})", f"there is no '{name}' that this could be of",
                        f"name one of {', '.join(allowed) or 'none: driven, effectors and hands are empty'}")  # fmt: skip
        return {name: self._rows[name] for name in names}

    def _driven_table(self, driven):
        table = []
        for name in self._driven:
            row = [-np.inf, np.inf, np.inf, -np.inf, np.inf, 0.0]
            if self._sim is not None:
                actuator = self._sim.actuator(name)
                effort, motion = _limits_of(actuator)
                row[:5] = [effort.min, effort.max, effort.rate, motion.min, motion.max]
            if isinstance(driven, dict) and driven[name] is not None:
                row[:2] = _pair(driven[name], f"HighRateLoop(driven['{name}'])", "N")
            row[5] = min(max(0.0, row[0]), row[1])
            table.append(row)
        return np.array(table).reshape(-1, 6)

    def _hand_table(self, hands):
        given = hands if isinstance(hands, dict) else {}
        for name in self._hands:
            if self._sim is not None:
                self._sim.actuator(name)  # raises unknown-name
        return np.array([_pair(given.get(name, (0.0, np.inf)), f"HighRateLoop(hands['{name}'])", "N")
                         for name in self._hands]).reshape(-1, 2)  # fmt: skip

    def snapshot(self, *, statics=True):
        """Snapshot of the simulation at its current state, which does not change.

        Parameters
        ----------
        statics : bool
            True: W of static equilibrium; False: W of the scene's integrator and time step.

        Raises
        ------
        RunError
            singular-matrix.
        """
        if self._sim is None:
            _refuse("bad-argument", "HighRateLoop.snapshot()", "the loop has no simulation", "give one when it is made")
        names = {"driven": self._driven, "unknown": self._unknown, "effectors": self._effectors, "hands": self._hands}
        return Snapshot(**_core._take_snapshot(self._sim, names, self._max_contacts, bool(statics)))

    def publish(self, snapshot=None):
        """Passes a Snapshot to the loop, by default snapshot(). May be called from any thread.

        Raises
        ------
        Error
            wrong-shape, not-finite, out-of-range.
        """
        if snapshot is None:
            snapshot = self.snapshot()
        compliance = np.ascontiguousarray(snapshot.compliance, dtype=float)
        free = np.ascontiguousarray(snapshot.free, dtype=float).ravel()
        effort = np.zeros_like(free) if snapshot.effort is None else np.ascontiguousarray(snapshot.effort, dtype=float)
        if compliance.ndim != 2:
            _refuse("wrong-shape", "publish(snapshot)", f"compliance has the shape {compliance.shape}", "give (rows, rows)")
        friction = [float(mu) for mu in snapshot.friction]
        self._loop.publish(compliance, free, effort.ravel(), friction, float(snapshot.time), float(snapshot.size))

    def set_input(self, *, sensors=None, hands=None, targets=None, driven=None):
        """Sets measurements and targets from the next period on. Omitted values are unchanged.

        Parameters
        ----------
        sensors : dict of name: (rows,) array_like
            Measured motions, m or rad; nan for a missing value.
        hands : dict of name: float
            Positions of hands along their rows, m from rest; nan for no hand.
        targets : dict of name: (rows,) array_like
            Targets, m or rad, N for a hand; nan for no target.
        driven : dict of name: float
            Measured efforts, N; nan for the efforts of the last output.

        Raises
        ------
        Error
            unknown-name, wrong-shape, not-finite.
        """
        for argument, given in (("sensors", sensors), ("hands", hands), ("targets", targets), ("driven", driven)):
            known = self._input[argument]
            for name, values in (given or {}).items():
                if name not in known:
                    _refuse("unknown-name", f"set_input({argument})", f"the loop has no '{name}' there",
                            f"name one of {', '.join(known) or 'none'}")  # fmt: skip
                numbers = np.atleast_1d(np.asarray(values, dtype=float))
                if numbers.shape != known[name].shape:
                    _refuse("wrong-shape", f"set_input({argument}['{name}'])", f"the shape is {numbers.shape}",
                            f"give {known[name].size} number(s)")  # fmt: skip
                known[name] = numbers
        lists = [np.concatenate([*self._input[key].values(), []]) for key in ("sensors", "hands", "targets", "driven")]
        self._loop.set_input(*lists)

    def start(self):
        """Starts the thread. Raises Error(bad-argument) if it is running."""
        self._loop.start()

    def stop(self):
        """Stops the thread and waits for its end. start() resumes."""
        self._loop.stop()

    def advance(self, periods=1):
        """Runs a number of periods in the calling thread with an ideal clock, for tests and examples.

        Raises
        ------
        Error
            bad-argument: the thread runs.
        """
        self._loop.advance(int(periods))

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.stop()

    @property
    def running(self):
        """bool: whether the thread is running."""
        return self._loop.running()

    @property
    def output(self):
        """HighRateOutput: the latest."""
        numbers = self._loop.output()
        names = {"driven": self._driven, "driven_motion": self._driven, "unknown": self._unknown, "deviation": self._unknown,
                 "hands": self._hands}  # fmt: skip
        for key, owners in names.items():
            numbers[key] = dict(zip(owners, numbers[key].tolist()))
        tasks, begin = {}, 0
        for name, rows in self._tasks.items():
            values = numbers["tasks"][begin : begin + len(rows)]
            tasks[name] = values if name in self._effectors else float(values[0])
            begin += len(rows)
        numbers["tasks"] = tasks
        numbers["contacts"] = numbers["contacts"].reshape(-1, 3)
        return HighRateOutput(**numbers)

    @property
    def report(self):
        """HighRateReport: counters since creation."""
        return HighRateReport(**self._loop.report())

    @property
    def udp(self):
        """UdpReport, or None without a socket."""
        report = self._loop.udp_report()
        return None if report is None else UdpReport(**report)

    @property
    def lateness(self):
        """HighRateTimes: delay of the start of periods."""
        counts, longest = self._loop.lateness()
        return HighRateTimes(np.array(counts), longest)

    @property
    def work(self):
        """HighRateTimes: computation time of periods."""
        counts, longest = self._loop.work()
        return HighRateTimes(np.array(counts), longest)


def _limits_of(actuator):
    """(effort, motion) limits of an actuator, independent of the names of its quantities."""
    effort, motion = actuator.limits.values()
    return effort, motion
