"""What sinew raises and warns of."""

from __future__ import annotations

from typing import Any, NamedTuple, Union

__all__ = ["Error", "Location", "Notice", "RunError", "SinewWarning"]


class Location(NamedTuple):
    """Where something is wrong; what is unknown is empty or 0.

    Attributes
    ----------
    file : str
        The scene, table or mesh.
    line, column : int
        From 1.
    item : str
        The dotted path in the scene, as "bodies.trunk.mass", or the argument.
    """

    file: str = ""
    line: int = 0
    column: int = 0
    item: str = ""

    def __str__(self) -> str:
        text = self.file
        if self.line > 0:
            text += f":{self.line}"
            if self.column > 0:
                text += f":{self.column}"
        return ": ".join(part for part in (text, self.item) if part)


class Error(Exception):
    """Something wrong in what was given: a scene, a file, an argument.

    Parameters
    ----------
    kind : str
        Which error it is, as "unknown-name": stable, to be tested for.
    place : Location or str
        Where; a string is the item.
    message : str
        What is wrong, with the offending value.
    remedy : str
        What to do instead; may be empty.
    """

    #: What Simulation.run() recorded before it failed: dict of arrays; None elsewhere.
    recorded: dict[str, Any] | None = None

    def __init__(
        self, kind: str, place: Union[Location, str], message: str, remedy: str = ""
    ) -> None:
        place = Location(item=place) if isinstance(place, str) else Location(*place)
        super().__init__(kind, place, message, remedy)
        self.kind = kind
        self.place = place
        self.message = message
        self.remedy = remedy

    def __str__(self) -> str:
        text = ": ".join(part for part in (str(self.place), self.message) if part)
        if self.remedy:
            text += f"; {self.remedy}"
        return f"{text} [{self.kind}]"


class SinewWarning(UserWarning):
    """A notice of the level "warning", through Python's warnings."""


class Notice(NamedTuple):
    """Something that a user should know of a scene, and that stops nothing.

    Attributes
    ----------
    level : str
        "warning": it follows from a default, or the scene does not get what it asks for, and load()
        warns of it. "remark": the scene asks for what it is about.
    kind : str
        "locking-element": the elements make a body much stiffer than its material. "bare-points": a cable pulls at
        single points, which dent the material. "other-tangent": the tangent that the scene asks for is none of
        its materials, and another takes its place.
    place : Location
        Where in the scene.
    message : str
        With the value that it is about.
    remedy : str
        What to write instead.
    """

    level: str
    kind: str
    place: Location
    message: str
    remedy: str

    def __str__(self) -> str:
        text = ": ".join(part for part in (str(self.place), self.message) if part)
        if self.remedy:
            text += f"; {self.remedy}"
        return f"{text} [{self.kind}]"


class RunError(Error):
    """A run that cannot go on: diverged, inverted-in-run, not-converged, singular-matrix."""
