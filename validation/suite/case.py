"""Checks of a case: quantity, our value, reference, error, tolerance, verdict, source."""

from __future__ import annotations

import math
import os
import pathlib
from dataclasses import dataclass, field

import numpy as np

PASSED = "passed"
MISSED = "**missed**"
KNOWN = "**missed**, known"
REPORTED = "not scored"
SKIPPED = "skipped"


@dataclass
class Check:
    """One line of the scorecard. Numbers are stored as text, so they print the same everywhere."""

    quantity: str
    ours: str
    reference: str
    error: str
    tolerance: str
    verdict: str
    source: str
    remark: str = ""


@dataclass
class Result:
    """The result that a case returns from its process."""

    name: str
    title: str = ""
    setup: str = ""
    sources: dict[str, str] = field(default_factory=dict)
    checks: list[Check] = field(default_factory=list)
    figures: list[tuple[str, str]] = field(default_factory=list)
    failure: str = ""
    seconds: float = 0.0

    def count(self, *verdicts: str) -> int:
        return sum(check.verdict in verdicts for check in self.checks)


class Case:
    """Handed to a case's run(): collects checks and figures.

    Parameters
    ----------
    name : str
        The module's name; figures are named after it.
    images, scratch : Path
        The folder of the figures, and a temporary folder for meshes.
    sources : dict
        Short names to full citations, as in the case's SOURCES.
    """

    def __init__(
        self,
        name: str,
        images: pathlib.Path,
        scratch: pathlib.Path,
        sources: dict[str, str],
    ) -> None:
        self.name = name
        self.images = images
        self.scratch = scratch
        self.sources = sources
        self.checks: list[Check] = []
        self.figures: list[tuple[str, str]] = []

    def check(
        self,
        quantity: str,
        ours: float,
        reference: float,
        tolerance: float,
        *,
        source: str,
        unit: str = "",
        relative: bool = True,
        known_miss: str = "",
        remark: str = "",
    ) -> bool:
        """Compares our value with a reference.

        Parameters
        ----------
        quantity : str
        ours, reference : float
            In `unit`.
        tolerance : float
            Of |ours - reference|, divided by |reference| if `relative`.
        source : str
            A key of the case's SOURCES.
        known_miss : str
            Why a miss is expected. Without it, a miss makes the command fail.
        """
        self._require(source)
        error = abs(ours - reference)
        if relative:
            error /= abs(reference)
        held = bool(error <= tolerance)  # NaN is a miss
        self._add(
            quantity,
            number(ours, unit),
            number(reference, unit),
            percent(error) if relative else number(error, unit, 2),
            percent(tolerance) if relative else number(tolerance, unit, 2),
            held,
            source,
            known_miss,
            remark,
        )
        return held

    def bound(
        self,
        quantity: str,
        ours: float,
        tolerance: float,
        *,
        source: str,
        unit: str = "",
        known_miss: str = "",
        remark: str = "",
    ) -> bool:
        """Checks a quantity whose reference is zero: its magnitude may be at most `tolerance`, in `unit`."""
        self._require(source)
        held = bool(abs(ours) <= tolerance)
        text = number(abs(ours), unit, 3)
        self._add(
            quantity,
            text,
            "0",
            text,
            number(tolerance, unit, 2),
            held,
            source,
            known_miss,
            remark,
        )
        return held

    def identity(
        self,
        quantity: str,
        error: float,
        tolerance: float,
        *,
        source: str,
        known_miss: str = "",
        remark: str = "",
    ) -> bool:
        """Checks a quantity that is exact up to rounding; its relative error is shown as a power of ten."""
        self._require(source)
        held = bool(abs(error) <= tolerance)
        text = power_of_ten(error)
        self._add(
            quantity,
            text,
            "0",
            text,
            power_of_ten(tolerance)[2:],
            held,
            source,
            known_miss,
            remark,
        )
        return held

    def agree(
        self, quantity: str, ours: object, reference: object, *, source: str, remark: str = ""
    ) -> bool:
        """Checks that two values are equal, such as hashes or statuses; they are shown as text."""
        self._require(source)
        held = ours == reference
        self._add(
            quantity,
            str(ours),
            str(reference),
            "none" if held else "differs",
            "equal",
            held,
            source,
            "",
            remark,
        )
        return held

    def report(
        self,
        quantity: str,
        ours: float | str,
        *,
        source: str,
        unit: str = "",
        reference: float | None = None,
        remark: str = "",
    ) -> None:
        """Reports a number without a decisive reference; it never counts as a pass."""
        self._require(source)
        text = ours if isinstance(ours, str) else number(ours, unit)
        told = "none" if reference is None else number(reference, unit)
        self.checks.append(
            Check(quantity, text, told, "", "", REPORTED, source, remark)
        )

    def skip(self, quantity: str, why: str, *, source: str) -> None:
        """Records a check that this machine cannot run."""
        self._require(source)
        self.checks.append(Check(quantity, "", "", "", "", SKIPPED, source, why))

    def figure(self, figure, caption: str, suffix: str = "") -> None:
        """Saves and closes a matplotlib figure as docs/images/validation/<case><suffix>.png."""
        import matplotlib.pyplot as plt

        file = f"{self.name}{suffix}.png"
        self.images.mkdir(parents=True, exist_ok=True)
        figure.savefig(self.images / file, dpi=100, metadata={"Software": None})
        plt.close(figure)
        self.figures.append((file, caption))

    def _require(self, source: str) -> None:
        if source not in self.sources:
            raise KeyError(f"{self.name}: '{source}' is not in SOURCES")

    def _add(self, quantity, ours, reference, error, tolerance, held, source, known, remark):
        verdict = PASSED if held else KNOWN if known else MISSED
        if known:
            note = known if not held else "a miss was expected: " + known
            remark = f"{remark}; {note}" if remark else note
        self.checks.append(
            Check(quantity, ours, reference, error, tolerance, verdict, source, remark)
        )


def number(value: float, unit: str = "", digits: int = 5) -> str:
    """Formats a number with few enough significant digits to hide rounding errors."""
    if not math.isfinite(value):
        return str(value)
    return f"{value:.{digits}g} {unit}".rstrip()


def percent(value: float) -> str:
    if not math.isfinite(value):
        return str(value)
    return f"{100 * value:.2g} %" if value >= 1e-6 else f"{value:.1e}"


def power_of_ten(error: float) -> str:
    """Formats the next larger power of ten, at least 1e-15, as '< 1e-13'."""
    if not math.isfinite(error):
        return str(error)
    if error <= 0.0:
        return "0"
    return f"< 1e{max(-15, math.ceil(math.log10(error) - 1e-9))}"


def observed_order(steps, errors) -> float:
    """Slope of log(error) against log(step), by least squares."""
    return float(np.polyfit(np.log(steps), np.log(np.abs(errors)), 1)[0])


def shared_data(*parts: str) -> pathlib.Path | None:
    """A file of published data in $SINEW_SHARED_DATA, or in ../shared/data next to the
    repository; None if it is absent."""
    given = os.environ.get("SINEW_SHARED_DATA")
    folder = pathlib.Path(given) if given else REPOSITORY.parent / "shared" / "data"
    path = folder.joinpath(*parts)
    return path if path.exists() else None


REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
