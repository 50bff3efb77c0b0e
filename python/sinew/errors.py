"""Errors and warnings."""

from __future__ import annotations

from typing import Any, NamedTuple, Union

__all__ = ["Error", "Location", "Notice", "RunError", "SinewWarning"]


class Location(NamedTuple):
    """Location of an error or notice. Unknown fields are empty or 0.

    Attributes
    ----------
    file : str
        The scene, table or mesh.
    line, column : int
        From 1.
    item : str
        Dotted path in the scene, such as "bodies.trunk.mass", or name of the argument.
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
    """Invalid input: a scene, a file or an argument.

    Parameters
    ----------
    kind : str
        Kind of error, such as "unknown-name". Kinds are stable: programs may test for them.
    place : Location or str
        Location; a string gives the item only.
    message : str
        Description with the offending value.
    remedy : str
        Suggested fix; may be empty.
    """

    #: Arrays recorded by Simulation.run() before it failed, by name; None for other errors.
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
    """Issued by load() for every notice of level "warning", and by runs for what they show about their scene."""


class StepWarning(SinewWarning):
    """Issued for the first step with each flag, for example command-not-reached."""


class Notice(NamedTuple):
    """Information about a scene that does not prevent it from running.

    Attributes
    ----------
    level : str
        "warning": a default or an ignored request may surprise; load() issues a warning. "remark": the consequence
        of an explicit choice in the scene.
    kind : str
        "locking-element": the elements are much stiffer than the material. "bare-points": a cable pulls at single
        points, which dent the material. "other-tangent": the materials do not have the requested tangent, and another
        one is used. "slack-cable": a cable with a commanded displacement was slack in all steps of a run. "bowstring": a
        cable ran straight between two points of a body that bent. Simulation.run() warns of the last two, and of bare
        points whose dents took more than a tenth of a cable's pull.
        "unstable-law": a material loses its stability at strains of robots. "strain-range": a library law was not tested
        at the strains of the run, or is too soft at small strain. "renamed-word": a key of the scene has another name
        now.
    place : Location
        Location in the scene.
    message : str
        Description with the value in question.
    remedy : str
        Suggested change.
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
    """A simulation that cannot continue: diverged, inverted-in-run, not-converged, singular-matrix."""
