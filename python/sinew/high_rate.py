"""A loop at 500 Hz to 1 kHz beside a slow model: docs/high_rate.md is the guide."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from . import _core
from .errors import Error

__all__ = ["HighRateLoop", "HighRateOutput", "HighRateReport", "HighRateTimes", "Snapshot", "UdpReport"]


@dataclass
class Snapshot:
    """A robot's linear equations at one state: motions = free + compliance @ efforts.

    Rows stand in the order of the loop's lists: `driven`, `unknown`, all rows of `effectors`, `hands`, then a normal and
    two tangents of each contact. HighRateLoop.snapshot() makes one from a simulation.

    Attributes
    ----------
    compliance : (rows, rows) array_like
        W, m/N. Columns of effectors do not count.
    free : (rows,) array_like
        Motions without efforts of these rows, m or rad.
    effort : (rows,) array_like, optional
        Efforts at the linearisation, N; zero unless given.
    friction : (contacts,) array_like
        Coulomb's coefficients.
    time : float
        Of the model, s.
    size : float
        Of the robot, m: what motions are small beside.
    """

    compliance: np.ndarray
    free: np.ndarray
    effort: np.ndarray = None
    friction: np.ndarray = ()
    time: float = 0.0
    size: float = 1.0


@dataclass(frozen=True)
class HighRateOutput:
    """What a loop found in one period.

    Attributes
    ----------
    driven, driven_motion : dict
        Of each driven actuator its effort (N), to be applied in this period, and its motion then (m), foreseen.
    unknown, deviation : dict
        Of each unknown force its estimate and its standard deviation, N. One near the prior's says that no sensor sees it.
    hands : dict
        Of each hand the force that it pushes with, N; it feels the opposite.
    tasks : dict
        Of each task what is foreseen: (rows,) ndarray in m or rad of an effector, float of a motion (m) or a hand (N).
    contacts : (max_contacts, 3) ndarray
        Normal and tangential forces, N, zero behind those of the snapshot.
    state : str
        'waiting' for the first snapshot, 'running', 'holding', 'releasing' or 'released' (docs/high_rate.md).
    cause : str
        What is stale: 'none', 'snapshot', 'input' or 'sensors'.
    limits_conflict, failed : bool
        Limits of motions gave way to those of efforts; a program had no solution, and its part stays as it was.
    law_residual : float
        Distance of hands and contacts from their laws, of the largest effort.
    snapshot_time, snapshot_age : float
        s, of the model; s, since the loop got it.
    jump : float
        N, the largest change of a hand's force by a refresh in this period.
    damping : float
        N s/m, that passivity took in this period.
    energy_created : float
        J, by the forces that hands felt since the start; passive where it is not positive.
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
    """What a loop has done since it was made.

    Attributes
    ----------
    periods, snapshots : int
        Outputs; snapshots that were taken up.
    missed : int
        Periods without an output in time.
    limits_conflicts, failures : int
        Periods with them.
    real_time : bool
        Whether the thread runs before all ordinary ones (SCHED_FIFO).
    scheduling : str
        'SCHED_FIFO', or why not and what allows it.
    """

    periods: int
    snapshots: int
    missed: int
    limits_conflicts: int
    failures: int
    real_time: bool
    scheduling: str


class UdpReport(NamedTuple):
    """What came through a loop's socket.

    Attributes
    ----------
    port : int
        That it is bound to.
    received, invalid, outdated : int
        Good measurements; bad packets, and those that came again or too late: both are ignored.
    sent, not_sent : int
        Commands; those that the operating system did not take.
    """

    port: int
    received: int
    invalid: int
    outdated: int
    sent: int
    not_sent: int


class HighRateTimes(NamedTuple):
    """How often times of so many microseconds occurred.

    Attributes
    ----------
    counts : (1001,) ndarray
        Of times within [k, k + 1) us; the last of those of a millisecond and more.
    longest : float
        s.
    """

    counts: np.ndarray
    longest: float

    def quantile(self, part):
        """The time (s) that this part of all times does not exceed, to a microsecond; 0 without any."""
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
        _refuse("wrong-type", place, f"{value!r} is no pair of limits", f"give (least, most) in {unit}")
    return low, high


def _number(value, place, unit):
    if isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool):
        return float(value)
    _refuse("wrong-type", place, f"{value!r} is no number", f"give a number in {unit}")


class HighRateLoop:
    """Solves two small inverse problems once a period on the latest snapshot of a robot: sensors to outside forces, and
    targets to efforts, while hands and contacts obey their laws. Its thread waits for nobody; the model linearises in a
    thread of the caller's, at 50 to 500 Hz:

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
        Whose rows are named below; None for snapshots that are made by hand.
    driven : list of str, or dict of name: (least, most) effort
        Actuators whose efforts the loop chooses. Limits that are not given are those of the simulation's actuators, with
        those on rates and motions.
    unknown : dict of name: float
        Actuators of type force, as outside forces that nobody measures, and the standard deviation that is expected of
        each, N.
    effectors : list of str, or without a simulation dict of name: number of rows
        Whose motions are measured or asked for.
    hands : list of str, or dict of name: (least, most) force
        Actuators of type force that hands push with: where a hand is, their point goes, with a force (N) within these
        limits, which hold 0. (0, inf) unless given: a hand that pushes.
    sensors : dict of name: float
        Standard deviation (m or rad) of the measured motion of a driven actuator, or of each row of an effector.
    tasks : dict of name: float
        Weights of targets: motion of an effector or of a driven actuator, force of a hand.
    rate : float
        Periods a second, 10 to 10000.
    max_contacts : int
        Of contact points those take part that carry a force or are nearest, at most so many.
    blend : float
        s: a new snapshot comes to count in equal parts in this time.
    stale_after, release_time : float
        s: without a newer snapshot, input (with sensors or hands) or any sensor's value for longer than `stale_after`,
        efforts are held; after twice that time they go to zero along a ramp of `release_time`.
    epsilon, largest_step : float
        As those of InverseController.
    passivity : bool
        Whether hands are damped where their forces would create energy.
    reserve, damping_limit : float
        Part of the energy foreseen that is dissipated on top; largest damping, over K T/2.
    udp : None or (str, int)
        Address and port (0: any) of a socket that measurements come through and commands go out: docs/high_rate.md has
        the packets. Sensors, hands and measured efforts then come from there, targets from set_input().

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
        """Whether the rows of an effector or actuator are angles; not where only their number is known."""
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
        """A Snapshot of the simulation as it is now, which is left as it is.

        Parameters
        ----------
        statics : bool
            W of equilibrium; False: of the scene's integrator and time step.

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
        """Hands a Snapshot to the loop; without one, that of the simulation. From any thread.

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
        """What is measured and asked from the next period on; what is not named stays as it was.

        Parameters
        ----------
        sensors : dict of name: (rows,) array_like
            Measured motions, m or rad, nan where there is none.
        hands : dict of name: float
            Where hands are along their rows, m from rest; nan: no hand is there.
        targets : dict of name: (rows,) array_like
            m or rad, of a hand N; nan: nothing is asked.
        driven : dict of name: float
            Measured efforts, N; nan: those of the last output are taken.

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
        """Begins the loop's thread. Raises Error(bad-argument) where it runs."""
        self._loop.start()

    def stop(self):
        """Returns when the thread has ended; start() goes on."""
        self._loop.stop()

    def advance(self, periods=1):
        """So many periods now, in the calling thread, on an ideal clock: what tests and examples do.

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
        """bool: whether the thread runs."""
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
        """HighRateReport: counts since the loop was made."""
        return HighRateReport(**self._loop.report())

    @property
    def udp(self):
        """UdpReport, or None without a socket."""
        report = self._loop.udp_report()
        return None if report is None else UdpReport(**report)

    @property
    def lateness(self):
        """HighRateTimes: by how much periods began after they were due."""
        counts, longest = self._loop.lateness()
        return HighRateTimes(np.array(counts), longest)

    @property
    def work(self):
        """HighRateTimes: how long periods took."""
        counts, longest = self._loop.work()
        return HighRateTimes(np.array(counts), longest)


def _limits_of(actuator):
    """(effort, motion) Limits of an actuator, whatever its quantities are called."""
    effort, motion = actuator.limits.values()
    return effort, motion
