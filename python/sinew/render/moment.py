"""State of a robot that a picture shows, from a simulation or a recorded run."""

from __future__ import annotations

import dataclasses
from typing import Any, Optional

import numpy as np

from ..errors import Error
from .colours import unit_of
from .scene import Outline

__all__ = ["Moment", "between", "moment_of"]


@dataclasses.dataclass
class Moment:
    """The state that a picture shows, in world axes.

    Attributes
    ----------
    time : float
        s.
    positions : dict of str to (n, 3) ndarray
        Of the nodes of each body, m.
    values : dict of str to (n,) ndarray
        Values of a field at the nodes of the bodies that have it.
    cables : dict of str to (k, 3) ndarray
        Points of cables and springs, the pull point first, m.
    slack : set of str
        Cables without tension.
    poses : dict of str to (3, 4) ndarray
        Rotation and translation (m) of contact surfaces from their positions in the scene.
    touching, forces : (m, 3) ndarrays
        Contact points, m (NaN: not found, without a force), and the forces on the bodies there, N.
    effectors, goals : dict of str to (3,) ndarray
        m.
    """

    time: float
    positions: dict[str, np.ndarray]
    values: dict[str, np.ndarray]
    cables: dict[str, np.ndarray]
    slack: set[str]
    poses: dict[str, np.ndarray]
    touching: np.ndarray
    forces: np.ndarray
    effectors: dict[str, np.ndarray]
    goals: dict[str, np.ndarray]


def moment_of(sim: Any, outline: Outline, field: Optional[str] = None) -> Moment:
    """Present state of a simulation.

    Parameters
    ----------
    sim : Simulation
    outline : Outline
        Of its scene.
    field : str, optional
        "displacement", or a name in sinew.fields.FIELDS.

    Raises
    ------
    Error
        unknown-name, simulation-busy.
    """
    positions = {name: np.array(body.positions) for name, body in sim.bodies.items()}
    values = {} if field is None else {name: v for name, body in sim.bodies.items() if (v := _values(body, field)) is not None}
    lines = {name: part for name, part in sim.actuators.items() if part.type in ("cable", "spring")}
    slack = {name for name, part in lines.items() if part.type == "cable" and not part.tension > 0.0}
    # The poses are available as observables only: a run of zero steps reads them.
    told = sim.run(0.0, record=[f"{name}.pose" for name in outline.surfaces]) if outline.surfaces else {}
    contacts = list(sim.contacts.values())
    touching = [contact.positions for contact in contacts]
    forces = [contact.normal_forces[:, None] * contact.normals + contact.friction_forces for contact in contacts]
    return Moment(
        time=sim.time,
        positions=positions,
        values=values,
        cables={name: part.points for name, part in lines.items()},
        slack=slack,
        poses={name: told[f"{name}.pose"][0] for name in outline.surfaces},
        touching=np.concatenate([np.zeros((0, 3)), *touching]),
        forces=np.concatenate([np.zeros((0, 3)), *forces]),
        effectors={name: part.position for name, part in sim.effectors.items() if part.unit == "m"},
        goals=_goals(sim),
    )


def _values(body: Any, field: str) -> Optional[np.ndarray]:
    """(n,): a field at a body's nodes; None if the body does not have the field."""
    return values_at(body, field, None)


def values_at(body: Any, field: str, positions: Optional[np.ndarray]) -> Optional[np.ndarray]:
    """(n,): a field at a body's nodes; None if the body does not have the field.

    Parameters
    ----------
    body : Body
    field : str
        "displacement", or a name in sinew.fields.FIELDS; Error (unknown-name) for others.
    positions : (n, 3) array_like or None
        m, for which the body is at rest; None: the present ones, with the history of the material.
    """
    if field == "displacement":
        return np.linalg.norm(np.asarray(body.positions if positions is None else positions) - np.asarray(body.rest_positions), axis=1)
    unit_of(field)  # raises unknown-name
    try:
        return np.nan_to_num(body.nodal_field(field) if positions is None else body._nodal_field_at(field, positions))
    except Error as error:
        if error.kind != "wrong-type":  # rigid bodies and arms have no elements
            raise
        return None


def _goals(sim: Any) -> dict[str, np.ndarray]:
    """(3,) m of each effector that a controller moves to a point."""
    if sim.controller is None:
        return {}
    targets, found = sim.controller.targets, {}
    for name in targets:
        if sim.effector(name).unit == "m":
            target = targets[name]
            found[name] = np.asarray(target.at(sim.time) if hasattr(target, "at") else target, dtype=float)
    return found


def between(first: Moment, second: Moment, share: float) -> Moment:
    """Linear interpolation between two moments of a robot; values that are not numbers come from the nearer one.

    So do contact points where not all were found in both moments: an index may then mean two different points.
    """

    def mixed(a: Any, b: Any) -> Any:
        if isinstance(a, dict):
            return {name: mixed(a[name], b[name]) for name in a}
        return (1.0 - share) * a + share * b

    nearer = first if share < 0.5 else second
    if not np.isfinite([first.touching, second.touching]).all():
        first, second = (dataclasses.replace(one, touching=nearer.touching, forces=nearer.forces) for one in (first, second))
    parts = {part.name: mixed(getattr(first, part.name), getattr(second, part.name))
             for part in dataclasses.fields(Moment) if part.name != "slack"}  # fmt: skip
    return Moment(**parts, slack=nearer.slack)
