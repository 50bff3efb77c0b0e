"""Parts of a scene that a picture needs: gravity, contact surfaces, and the ends of cables."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import numpy as np

from .. import _core
from ..errors import Error

__all__ = ["Outline", "Surface", "outline_of", "parsed"]


@dataclasses.dataclass(frozen=True)
class Surface:
    """A surface of the world that a contact names.

    Attributes
    ----------
    kind : str
        "plane", "sphere" or "capsule".
    points : (1 or 2, 3) ndarray
        A point of the plane, the sphere's centre, or the ends of the capsule's axis, m, at their positions in the scene.
    normal : (3,) ndarray
        Of a plane, unit.
    radius : float
        Of a sphere or a capsule, m.
    """

    kind: str
    points: np.ndarray
    normal: np.ndarray
    radius: float

    def moved(self, pose: np.ndarray) -> Surface:
        """The surface after a rotation and translation (3, 4), m, from its position in the scene."""
        turn, shift = pose[:, :3], pose[:, 3]
        return Surface(self.kind, self.points @ turn.T + shift, turn @ self.normal, self.radius)


@dataclasses.dataclass(frozen=True)
class Outline:
    """Parts of a scene that a picture needs.

    Attributes
    ----------
    up : (3,) ndarray
        Unit vector opposite to gravity; +z without gravity.
    surfaces : dict of str to Surface
        By the names of the contacts.
    held : set of str
        Cables whose pull point is fixed in the world.
    """

    up: np.ndarray
    surfaces: dict[str, Surface]
    held: set[str]


def parsed(text: str) -> dict[str, Any]:
    """Parses a scene's text into dicts and lists of text. Raises tool-missing without PyYAML."""
    try:
        import yaml
    except ImportError:
        raise Error("tool-missing", "render", "pictures need PyYAML, which is not installed",
                    "install python3-yaml, or pip install sinew[render]") from None
    # All scalars stay text: YAML 1.1 reads "1e-3" as text and "yes" as true, unlike Sinew.
    return yaml.load(text, Loader=yaml.BaseLoader)


def outline_of(sim: Any) -> Outline:
    """What a picture of a simulation needs. Raises tool-missing without PyYAML."""
    tree = parsed(sim.to_yaml())
    gravity = _vector(tree.get("gravity", "0 0 0"))
    length = np.linalg.norm(gravity)
    up = -gravity / length if length > 0.0 else np.array([0.0, 0.0, 1.0])
    surfaces = {name: _surface(contact.surface) for name, contact in sim.contacts.items() if contact.surface}
    cables = (tree.get("actuators") or {}).items()
    held = {name for name, cable in cables if cable["type"] == "cable" and cable.get("pull", "world") == "world"}
    return Outline(up, surfaces, held)


def _surface(described: dict[str, dict[str, Any]]) -> Surface:
    (kind, own), = described.items()
    if kind == "plane":
        return Surface(kind, own["point"][None], own["normal"], 0.0)
    points = own["centre"][None] if kind == "sphere" else own["ends"]
    return Surface(kind, points, np.zeros(3), own["radius"])


def _vector(written: Any) -> np.ndarray:
    """(3,), SI, from "0 0 190 mm" or a list of numbers."""
    if not isinstance(written, str):
        return np.array([_core._quantity(str(number))[0] for number in written])
    # The unit may follow the last number without a space.
    x, y, rest = written.split(None, 2)
    z, unit = re.fullmatch(r"([-+.\d]+(?:[eE][-+]?\d+)?)\s*(.*)", rest.strip()).groups()
    return np.array([_core._quantity(f"{number} {unit}".strip())[0] for number in (x, y, z)])
