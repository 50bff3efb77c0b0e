"""Progress of a sweep: a line on a terminal."""

from __future__ import annotations

import sys
import time
from typing import Callable, Optional, Union

_REDRAW, _WIDTH = 0.1, 30


class Progress:
    """Counts samples and reports them.

    Parameters
    ----------
    total : int
        Number of samples of the sweep.
    there : int
        Number of samples finished in earlier runs.
    shown : bool or callable, optional
        None: on standard error if it is a terminal. A function is called with (rows, samples) after each batch.
    """

    def __init__(self, total: int, there: int, shown: Union[bool, Callable[[int, int], object], None] = None) -> None:
        self.total, self.there, self.done, self.failed = total, there, there, 0
        self._call = shown if callable(shown) else None
        self._drawn = sys.stderr.isatty() if shown is None else bool(shown) and self._call is None
        self._begin = time.monotonic()
        self._last = 0.0

    def add(self, rows: int, failed: int) -> None:
        """Counts a finished batch."""
        self.done += rows
        self.failed += failed
        if self._call is not None:
            self._call(self.done, self.total)

    @property
    def seconds(self) -> float:
        """s since the start."""
        return time.monotonic() - self._begin

    @property
    def rate(self) -> float:
        """Samples per second in this run."""
        return (self.done - self.there) / max(self.seconds, 1e-9)

    def draw(self, workers: int) -> None:
        """Draws the line, at most ten times per second."""
        if not self._drawn or time.monotonic() - self._last < _REDRAW:
            return
        self._last = time.monotonic()
        share = self.done / max(self.total, 1)
        filled = min(_WIDTH, int(share * _WIDTH))
        text = f"{self.done} of {self.total}, {self.rate:.3g}/s, {workers} workers"
        if self.done > self.there:
            text += f", {clock((self.total - self.done) / self.rate)} left"
        if self.failed:
            text += f", {self.failed} failed"
        print(f"\r\033[K[{'#' * filled}{'.' * (_WIDTH - filled)}] {100 * share:3.0f} %  {text}", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        """Removes the line."""
        if self._drawn and self._last > 0.0:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


def clock(seconds: Optional[float]) -> str:
    """Formats a time as "1:02:03" or "2:03"."""
    whole = int(round(seconds or 0.0))
    hours, minutes, rest = whole // 3600, whole // 60 % 60, whole % 60
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
