"""Measurement model of a robot: readings as a function of the unknowns, and derivatives."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from .. import _core
from ..errors import Error, RunError
from ..scene import load
from .quantities import Effort, Force, Measured, Motion, NodalForce, Parameter, Unknown, names_of, prior_of
from .response import Response, StandingRows, drives, has_rows_alone

__all__ = ["Twin"]

_EFFORTS = {"tension", "force", "pressure", "torque"}
_MOTIONS = {"displacement", "angle", "volume_growth"}
# Limits of an equilibrium search. They are low: if it fails, the estimator tries a shorter step.
_ITERATIONS, _LOAD_STEPS, _RELAXATION_STEPS = 25, 4, 1
_STEP = 1e-3  # step of central differences, in standard deviations of the prior


@dataclass(frozen=True)
class _Output:
    """One measured number that the model predicts."""

    name: str
    of: Measured
    component: int  # component of the observable; -1 for a scalar
    row: str  # name of the row; "" if there is none
    kind: str  # "motion", "effort", "rotation", "observable"


@dataclass(frozen=True)
class _Input:
    """One unknown number: component `component` of `unknown`."""

    name: str
    unknown: Unknown
    component: int
    measured: Optional[Measured] = None  # sensor of a measured command, whose reading is the prior mean


def _tree(scene: Any, folder: str, overrides: Any) -> dict:
    """A scene as a dict with absolute paths, without controllers."""
    import yaml

    sim = scene if isinstance(scene, _core.Simulation) else load(scene, set=overrides, folder=folder)
    tree = yaml.safe_load(sim.to_yaml())
    tree.pop("controllers", None)
    return tree


class Twin:
    """Measurement model of a robot: its scene, its sensors and the unknowns.

    Readings of commanded quantities, such as the length of a cable from its encoder, are noisy inputs of the model: the true
    command is an additional unknown, with the reading as mean and the standard deviation of the sensor. All other readings
    are outputs, y = h(u) + noise, where h is the static equilibrium.

    Parameters
    ----------
    scene : path-like, dict or Simulation
        The robot. Its controllers are ignored.
    measured : iterable of Measured
    unknowns : iterable of Force, NodalForce, Effort, Motion, Parameter
        Unknowns; empty if only the location of a force is searched, see locate().
    markers : dict of str to (str, (3,) array_like), optional
        Measured points that are not in the scene, as body and position at rest (m); they become effectors of the model.
    commanded : dict of str to str, optional
        Actuators with their commanded quantity, "displacement" or "tension". A scene that commands this quantity keeps its
        command; if it commands the other one, the command starts at the value reached in the scene's equilibrium, and without
        a command at 0. Only a reading changes it.
    set, folder, threads
        As in sinew.load().

    Raises
    ------
    Error
        unknown-name for sensors and actuators that do not exist; duplicate-name; no-sensors; and the errors of
        sinew.load().

    Attributes
    ----------
    sim : sinew.Simulation
        The model. The caller sets its commands, except measured ones, which follow their readings.
    inputs, outputs : list of str
        Names of the components of the unknowns, then of the measured commands; names of the measured components.
    """

    def __init__(self, scene: Any, measured: Iterable[Measured], unknowns: Iterable[Unknown], *,
                 markers: Optional[Mapping[str, tuple[str, Sequence[float]]]] = None,
                 commanded: Optional[Mapping[str, str]] = None, set: Any = None, folder: str = "",
                 threads: Optional[int] = None) -> None:
        self.measured, self.unknowns = list(measured), list(unknowns)
        self._threads = threads
        self._tree = _tree(scene, folder, set)
        for name, (body, point) in (markers or {}).items():
            self._add("effectors", name, {"body": body, "point": [float(x) for x in point], "outside": "nearest"})
        for name, quantity in (commanded or {}).items():
            if name not in self._tree.get("actuators", {}):
                raise Error("unknown-name", "Twin(commanded)", f"the scene has no actuator '{name}'",
                            f"it has {', '.join(self._tree.get('actuators', {})) or 'none'}")
        told = {name: self._told(name, quantity) for name, quantity in (commanded or {}).items()}
        for name, command in told.items():
            self._tree["actuators"][name]["command"] = command
        for unknown in self.unknowns:
            if isinstance(unknown, Force):
                for path, what in unknown.overrides().items():
                    self._add(*path.split(".", 1), what)
        self.sim = load(self._tree, set=self._at_start(), threads=threads)
        self._parameters: tuple[float, ...] = ()
        self._prepare()

    def _at_start(self) -> dict[str, float]:
        return {path: value for p in self.unknowns if isinstance(p, Parameter) for path, value in p.overrides(0.0).items()}

    def _add(self, section: str, name: str, what: dict) -> None:
        parts = self._tree.setdefault(section, {})
        if name in parts:
            raise Error("duplicate-name", f"Twin({section})", f"the scene has '{name}' already", "choose another name")
        parts[name] = what

    def _told(self, name: str, quantity: str) -> Any:
        """Command of an actuator in the given quantity that leaves the scene's equilibrium as it is."""
        command = self._tree["actuators"][name].get("command")
        if isinstance(command, Mapping) and quantity in command:
            return command
        if not command:
            return {quantity: 0.0}
        scene = load(self._tree, set=self._at_start(), threads=self._threads)
        scene.solve_static()
        return {quantity: float(getattr(scene.actuator(name), quantity))}

    def _prepare(self) -> None:
        self._fresh = self.sim.state()
        self._path_dependent = bool(self.sim.contacts) or any(" point " in row for row in self.sim.rows)
        self._outputs: list[_Output] = []
        self._inputs = [_Input(name, unknown, k) for unknown in self.unknowns for k, name in enumerate(names_of(unknown))]
        self._check_actuators()
        for sensor in self.measured:
            self._take(sensor)
        names = self.inputs
        if len(names) != len({*names}):
            raise Error("duplicate-name", "Twin(unknowns)", f"two unknowns have one name among {', '.join(names)}", "rename one")
        if not self._outputs:
            raise Error("no-sensors", "Twin(measured)", "only commands are measured",
                        "give a marker, or the effort of a cable")
        self._from_rows = has_rows_alone(self.sim) and all(o.kind != "observable" for o in self._outputs)
        self._fields = any(isinstance(u, NodalForce) for u in self.unknowns)
        self._drives = drives(self.sim)
        self._standing: Optional[StandingRows] = None

    def _check_actuators(self) -> None:
        for unknown in self.unknowns:
            if isinstance(unknown, (Effort, Motion)):
                actuator = self._actuator(unknown.actuator, "Twin(unknowns)")
                quantity = _MOTIONS if isinstance(unknown, Motion) else _EFFORTS
                if actuator.command[0] not in quantity:
                    raise Error("bad-argument", f"Twin(unknowns): {unknown.actuator}",
                                f"it is commanded in {actuator.command[0]}, so that its {names_of(unknown)[0].rpartition('.')[2]} "
                                "is an answer", "command it the other way, or measure it")

    def _actuator(self, name: str, place: str) -> _core.Actuator:
        try:
            return self.sim.actuator(name)
        except Error as error:
            raise Error(error.kind, place, error.message, error.remedy) from None

    def _take(self, sensor: Measured) -> None:
        owner, _, quantity = sensor.name.rpartition(".")
        if owner in self.sim.actuators and quantity in _EFFORTS | _MOTIONS:
            self._take_actuator(sensor, owner, quantity)
        elif owner in self.sim.effectors and quantity in ("position", "rotation", "x", "y", "z"):
            self._take_effector(sensor, owner, quantity)
        else:
            shape = np.shape(self._observed([sensor.name])[sensor.name])
            names = [sensor.name] if shape == () else [f"{sensor.name}[{k}]" for k in range(shape[0])]
            for k, name in enumerate(names):
                self._outputs.append(_Output(name, sensor, -1 if shape == () else k, "", "observable"))

    def _take_actuator(self, sensor: Measured, name: str, quantity: str) -> None:
        actuator = self.sim.actuator(name)
        if actuator.command[0] == quantity:
            known = Motion(name, sensor.std) if quantity in _MOTIONS else Effort(name, sensor.std)
            if names_of(known)[0] in [i.name for i in self._inputs]:
                raise Error("bad-argument", f"Measured({sensor.name!r})", "it is both a command and an unknown",
                            "leave one of them out: a measured command is an unknown by itself")
            self._inputs.append(_Input(names_of(known)[0], known, 0, sensor))
            return
        self._observed([sensor.name])
        self._outputs.append(_Output(sensor.name, sensor, -1, name, "motion" if quantity in _MOTIONS else "effort"))

    def _take_effector(self, sensor: Measured, owner: str, quantity: str) -> None:
        effector = self.sim.effector(owner)
        axes = quantity if quantity in "xyz" else "xyz"
        if (quantity == "rotation") != (effector.unit == "rad") and quantity not in "xyz":
            raise Error("unknown-name", f"Measured({sensor.name!r})", f"effector '{owner}' has no {quantity}",
                        "an orientation has .rotation, a point .position")
        for axis in axes:
            row = f"{owner}.{axis}" if f"{owner}.{axis}" in self.sim.rows else ""
            kind = "rotation" if effector.unit == "rad" else "motion" if row else "observable"
            self._outputs.append(_Output(f"{owner}.{axis}", sensor, "xyz".index(axis), row, kind))

    def _observed(self, names: list[str]) -> dict[str, np.ndarray]:
        try:
            recorded = self.sim.run(0.0, record=names)
        except Error as error:
            raise Error(error.kind, "Twin(measured)", error.message, error.remedy) from None
        return {name: recorded[name][-1] for name in names}

    # Inputs and outputs.

    @property
    def inputs(self) -> list[str]:
        return [i.name for i in self._inputs]

    @property
    def outputs(self) -> list[str]:
        return [o.name for o in self._outputs]

    @property
    def asked(self) -> int:
        """Number of inputs that are requested unknowns; the remaining inputs are measured commands."""
        return sum(i.measured is None for i in self._inputs)

    @property
    def is_linear_in_rows(self) -> bool:
        """Whether one linearisation gives all derivatives."""
        return self._from_rows

    @property
    def noise(self) -> np.ndarray:
        """(outputs,) standard deviations of the readings."""
        return np.array([o.of.std for o in self._outputs])

    @property
    def sensors(self) -> list[Measured]:
        """Sensor of each output."""
        return [o.of for o in self._outputs]

    def prior(self, commands: Optional[Mapping[str, float]] = None) -> tuple[np.ndarray, np.ndarray]:
        """(inputs,) means and standard deviations of all inputs; measured commands have their readings as means.

        Parameters
        ----------
        commands : dict of str to float, optional
            Readings of measured commands. The mean of a command without a reading is its present value.
        """
        means, stds = [], []
        for one in self._inputs:
            mean, std = (values[one.component] for values in prior_of(one.unknown))
            if one.measured is not None:
                mean = self._command_value(one.unknown.actuator)
                reading = (commands or {}).get(one.measured.name, math.nan)
                mean = reading if math.isfinite(reading) else mean
            means.append(mean)
            stds.append(std)
        return np.array(means), np.array(stds)

    def walk(self) -> np.ndarray:
        """(inputs,) random walk of each input, per sqrt(s)."""
        return np.array([i.unknown.walk if i.measured is None else 0.0 for i in self._inputs], float)

    def _command_value(self, actuator: str) -> float:
        value = self.sim.actuator(actuator).command[1]
        return float(value.value(self.sim.time) if isinstance(value, _core.Signal) else value)

    def split(self, readings: Mapping[str, Any]) -> tuple[np.ndarray, dict[str, float]]:
        """Splits readings by name into (outputs,) values and measured commands; NaN if missing.

        Parameters
        ----------
        readings : dict of str to float or array_like
            By name of the sensor or of the component ("tip.x").

        Raises
        ------
        Error
            unknown-name, wrong-shape.
        """
        values = dict.fromkeys(self.outputs, math.nan)
        commands = {i.measured.name: math.nan for i in self._inputs if i.measured is not None}
        by_sensor: dict[str, list[str]] = {}
        for output in self._outputs:
            by_sensor.setdefault(output.of.name, []).append(output.name)
        for name, reading in readings.items():
            place = f"readings[{name!r}]"
            if name in commands:
                commands[name] = float(reading)
            elif name in by_sensor:
                components, numbers = by_sensor[name], np.atleast_1d(np.asarray(reading, float))
                if len(numbers) != len(components):
                    raise Error("wrong-shape", place, f"{len(numbers)} numbers", f"the sensor reads {len(components)}")
                values.update(zip(components, numbers))
            elif name in values:
                values[name] = float(reading)
            else:
                raise Error("unknown-name", place, "no sensor has this name",
                            f"the model has {', '.join([*by_sensor, *commands])}")
        return np.array(list(values.values())), commands

    # Predictions.

    def predict(self, values: Sequence[float]) -> np.ndarray:
        """(outputs,) noise-free readings at the static equilibrium for given unknowns.

        Parameters
        ----------
        values : (inputs,) array_like
            SI; for a Parameter, log(value/start).

        Raises
        ------
        RunError
            not-converged, diverged if no stable equilibrium is found.
        """
        self.set(values)
        self.settle()
        return self.read()

    def set(self, values: Sequence[float]) -> None:
        """Sets the unknowns in the model without solving for equilibrium."""
        values = np.asarray(values, float)
        self._build([v for i, v in zip(self._inputs, values) if isinstance(i.unknown, Parameter)])
        nodal: dict[str, np.ndarray] = {}
        for one, value in zip(self._inputs, values):
            self._apply(one, float(value), nodal)
        for body, forces in nodal.items():
            self.sim.body(body).external_forces = forces

    def _apply(self, one: _Input, value: float, nodal: dict[str, np.ndarray]) -> None:
        unknown = one.unknown
        if isinstance(unknown, Force):
            self.sim.actuator(unknown.actuators[one.component]).force = value
        elif isinstance(unknown, (Effort, Motion)):
            actuator = self.sim.actuator(unknown.actuator)
            setattr(actuator, actuator.command[0], value)
        elif isinstance(unknown, NodalForce):
            if unknown.body not in nodal:
                nodal[unknown.body] = np.zeros_like(np.asarray(self.sim.body(unknown.body).external_forces))
            direction = value * unknown.axes[one.component]
            np.add.at(nodal[unknown.body], np.asarray(unknown.nodes), np.outer(unknown.weights, direction))

    def handles(self) -> list[tuple[_core.Actuator, str]]:
        """Actuator of each input, and the quantity that is set. Raises Error (bad-argument) for inputs without an actuator."""
        found = []
        for one in self._inputs:
            if isinstance(one.unknown, (NodalForce, Parameter)):
                raise Error("bad-argument", f"'{one.name}'", "it does not belong to an actuator, and a step gives no derivative by it",
                            "use TwinModel, or a Force at a point")
            actuator = self.sim.actuator(_row_name(one))
            found.append((actuator, actuator.command[0]))
        return found

    # Rebuilds the simulation for other parameter values, with the same commands.
    def _build(self, logarithms: list[float]) -> None:
        if not logarithms or tuple(logarithms) == self._parameters:
            return
        parameters = [u for u in self.unknowns if isinstance(u, Parameter)]
        overrides = {path: v for p, x in zip(parameters, logarithms) for path, v in p.overrides(x).items()}
        fresh = load(self._tree, set=overrides, threads=self._threads)
        for name, actuator in self.sim.actuators.items():
            kind, value = actuator.command
            if not actuator.owned:
                setattr(fresh.actuator(name), kind, value)
        self.sim, self._parameters = fresh, tuple(logarithms)
        self._fresh = fresh.state()

    def settle(self) -> None:
        """Brings the model to its static equilibrium; with contacts and friction always from the same initial state.

        Without an equilibrium from the present state, the search starts once more from the scene's initial state.

        Raises
        ------
        RunError
            not-converged; the model is then in the state before the search.
        """
        before = self.sim.state()
        if self._path_dependent:
            self.sim.restore(self._fresh)
        try:
            self._solve()
        except RunError:
            try:
                if self._path_dependent:
                    raise
                self.sim.restore(self._fresh)
                self._solve()
            except RunError:
                self.sim.restore(before)
                raise

    def _solve(self) -> None:
        report = self.sim.solve_static(max_iterations=_ITERATIONS, max_load_steps=_LOAD_STEPS,
                                       max_relaxation_steps=_RELAXATION_STEPS)
        if report.status != "converged":
            raise RunError("not-converged", "Twin", f"the equilibrium was not found: {report.status}",
                           "take a nearer start, or a tighter prior")

    def keep(self, values: Sequence[float]) -> tuple:
        """The model at its present equilibrium, for go_back().

        Parameters
        ----------
        values : (inputs,) array_like
            Present values of the inputs.
        """
        return np.array(values, float), self.sim, self._parameters, self._fresh, self.sim.state()

    def go_back(self, kept: tuple) -> None:
        """Returns to a kept equilibrium without solving for it again, so it cannot fail."""
        values, self.sim, self._parameters, self._fresh, state = kept
        self.set(values)
        self.sim.restore(state)

    def read(self) -> np.ndarray:
        """(outputs,) present readings of the sensors, without noise."""
        observed = [o.of.name for o in self._outputs if o.kind == "observable"]
        values = self._observed(list(dict.fromkeys(observed))) if observed else {}
        owners: dict[str, Any] = {}
        found = []
        for output in self._outputs:
            owner, _, quantity = output.name.rpartition(".")
            if output.kind == "observable":
                value = values[output.of.name]
                found.append(float(value) if output.component < 0 else float(value[output.component]))
                continue
            if owner not in owners:
                is_effector = quantity in "xyz"
                owners[owner] = self.sim.effector(owner).value if is_effector else self.sim.actuator(owner)
            found.append(owners[owner][output.component] if quantity in "xyz" else getattr(owners[owner], quantity))
        return np.array(found, float)

    def sensitivity(self, values: Optional[Sequence[float]] = None) -> np.ndarray:
        """(outputs, inputs) derivative of predict() at the present equilibrium.

        From one linearisation if all readings are rows. Otherwise, and for parameters, by central differences, which leave the
        model in its present state; beside a value without an equilibrium, by a difference to the other side.

        Parameters
        ----------
        values : (inputs,) array_like, optional
            Present values of the inputs: needed for differences.
        """
        result = np.empty((len(self._outputs), len(self._inputs)))
        by_differences = [k for k, i in enumerate(self._inputs) if not self._from_rows or isinstance(i.unknown, Parameter)]
        if len(by_differences) < len(self._inputs):
            response = Response(self.sim, self.sim.linearise(fields=self._fields))
            self._fill(response, result)
        if by_differences:
            if values is None:
                raise Error("bad-argument", "sensitivity(values)", "this model needs differences about a point", "give the values")
            self._differentiate(np.asarray(values, float), by_differences, result)
        return result

    def of_step(self) -> tuple[np.ndarray, np.ndarray]:
        """(outputs,) readings and their derivative (outputs, inputs) after a step, from the linearisation of that step, at no
        additional cost.

        Raises
        ------
        Error
            bad-argument if readings are not rows, or if unknowns are parameters or forces on nodes.
        """
        if not self._from_rows or self._fields or any(isinstance(i.unknown, Parameter) for i in self._inputs):
            raise Error("bad-argument", "of_step()", "a step gives derivatives by efforts and motions of rows only",
                        "measure rows, or use a filter of equilibria")
        linear = self.sim.last_linearisation()
        if self.sim.contacts or any(o.kind == "rotation" for o in self._outputs):
            result = np.empty((len(self._outputs), len(self._inputs)))
            self._fill(Response(self.sim, linear, self._drives), result)
            return self.read(), result
        if self._standing is None:
            self._standing = self._stand(linear.rows)
        return self._standing(linear)

    def _stand(self, rows: list[str]) -> StandingRows:
        inputs = [(k, _row_name(one), isinstance(one.unknown, Motion)) for k, one in enumerate(self._inputs)]
        outputs = [(k, o.row, o.kind == "effort") for k, o in enumerate(self._outputs)]
        return StandingRows(rows, self._drives, [(k, r) for k, r, motion in inputs if not motion],
                            [(k, r) for k, r, motion in inputs if motion], [(k, r) for k, r, told in outputs if not told],
                            [(k, r) for k, r, told in outputs if told])

    def _fill(self, response: Response, result: np.ndarray) -> None:
        by_effort, by_motion, by_nodes = [], [], []
        for k, one in enumerate(self._inputs):
            if isinstance(one.unknown, NodalForce):
                by_nodes.append(k)
            elif isinstance(one.unknown, Motion):
                by_motion.append((k, response.rows[one.unknown.actuator]))
            elif not isinstance(one.unknown, Parameter):
                by_effort.append((k, response.rows[_row_name(one)]))
        for found, answer in ((by_effort, response.to_efforts), (by_motion, response.to_motions)):
            if found:
                result[:, [k for k, _ in found]] = self.rows_to_outputs(*answer([row for _, row in found]), response)
        for k in by_nodes:
            result[:, k] = self.rows_to_outputs(*self.column(response, self._inputs[k].unknown, self._inputs[k].component), response)

    def column(self, response: Response, unknown: Unknown, component: int) -> tuple[np.ndarray, np.ndarray]:
        """(rows,) motions and efforts of all rows for a unit value of one component of an unknown."""
        if isinstance(unknown, Motion):
            motions, efforts = response.to_motions([response.rows[unknown.actuator]])
            return motions[:, 0], efforts[:, 0]
        if not isinstance(unknown, NodalForce):
            row = unknown.actuators[component] if isinstance(unknown, Force) else unknown.actuator
            motions, efforts = response.to_efforts([response.rows[row]])
            return motions[:, 0], efforts[:, 0]
        columns = self.nodal_columns(response, unknown.body)[:, np.asarray(unknown.nodes)]
        alone = np.einsum("rnc,n,c->r", columns, np.asarray(unknown.weights, float), unknown.axes[component])
        motions, efforts = response.to_columns(alone[:, None])
        return motions[:, 0], efforts[:, 0]

    def nodal_columns(self, response: Response, body: str) -> np.ndarray:
        """(rows, n, 3) m/N: motion of the rows for a unit force on each node of a body."""
        field = response.linear.fields[list(self.sim.bodies).index(body)]
        if field.shape[0] == 0:
            raise Error("wrong-type", f"body('{body}')", "it has no finite elements", "give a Force at a point")
        return field

    def rows_to_outputs(self, motions: np.ndarray, efforts: np.ndarray, response: Response) -> np.ndarray:
        """(outputs, ...) from (rows, ...) motions and efforts."""
        result = np.empty((len(self._outputs), *motions.shape[1:]))
        for kind, values in (("motion", motions), ("effort", efforts)):
            which = [k for k, o in enumerate(self._outputs) if o.kind == kind]
            result[which] = values[[response.rows[self._outputs[k].row] for k in which]]
        for k, output in enumerate(self._outputs):
            if output.kind == "rotation":
                owner = output.name.rpartition(".")[0]
                turns = motions[[response.rows[f"{owner}.{axis}"] for axis in "xyz"]]
                rate = _rotation_rate(np.asarray(self.sim.effector(owner).value))[output.component]
                result[k] = np.tensordot(rate, turns, 1)
        return result

    def _differentiate(self, values: np.ndarray, which: list[int], result: np.ndarray) -> None:
        stds, here, kept = self.prior()[1], self.read(), self.keep(values)
        try:
            for k in which:
                step = np.zeros(len(values))
                step[k] = _STEP * stds[k]
                result[:, k] = self._slope(values, step, step[k], here, kept)
        finally:
            self.go_back(kept)

    def _slope(self, values: np.ndarray, step: np.ndarray, length: float, here: np.ndarray, kept: tuple) -> np.ndarray:
        sides: list[tuple[float, np.ndarray]] = []
        failure: Optional[RunError] = None
        for sign in (1.0, -1.0):
            try:
                sides.append((sign, self.predict(values + sign * step)))
            except RunError as error:
                failure = error
                self.go_back(kept)
        if len(sides) == 2:
            return (sides[0][1] - sides[1][1]) / (2.0 * length)
        if not sides:
            assert failure is not None
            raise failure
        return sides[0][0] * (sides[0][1] - here) / length

    def with_unknowns(self, unknowns: Iterable[Unknown], measured: Optional[Iterable[Measured]] = None) -> "Twin":
        """A model on the same simulation with other unknowns. It must need no new rows, hence no new Force.

        Parameters
        ----------
        unknowns : iterable of NodalForce, Effort, Motion, or unknowns of this model
        measured : iterable of Measured, optional
            Replaces the sensors of this model.
        """
        other = object.__new__(Twin)
        other.__dict__.update(self.__dict__)
        other.unknowns = list(unknowns)
        other.measured = list(self.measured if measured is None else measured)
        for unknown in other.unknowns:
            if isinstance(unknown, Force) and unknown.actuators[0] not in self.sim.actuators:
                raise Error("bad-argument", "with_unknowns()", f"'{unknown.name}' needs rows of its own", "make a new Twin")
        other._prepare()
        return other


def _row_name(one: _Input) -> str:
    return one.unknown.actuators[one.component] if isinstance(one.unknown, Force) else one.unknown.actuator


def _rotation_rate(vector: np.ndarray) -> np.ndarray:
    """(3, 3): derivative of a rotation vector with respect to a small rotation about world axes, the inverse of the left
    Jacobian (Sola et al., arXiv 1812.01537, eq. 146).
    """
    angle = float(np.linalg.norm(vector))
    skew = np.array([[0, -vector[2], vector[1]], [vector[2], 0, -vector[0]], [-vector[1], vector[0], 0]])
    if angle < 1e-6:
        return np.eye(3) - 0.5 * skew + skew @ skew / 12.0
    factor = 1.0 / angle**2 - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
    return np.eye(3) - 0.5 * skew + factor * skew @ skew
