"""Writes files that replace older ones only when they are complete."""

from __future__ import annotations

import contextlib
import errno
import os
import pathlib
from collections.abc import Iterator
from typing import Any

from .errors import Error, RunError


def is_full(problem: OSError) -> bool:
    """Whether the disk is full or broken, which is no wrong input."""
    return problem.errno in (errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EFBIG)


def unwritable(path: Any, problem: OSError) -> Error:
    """The error of a file that cannot be written: RunError (recording-failed) if the disk is full, else Error (file-unwritable)."""
    reason = problem.strerror or "cannot be written"
    if is_full(problem):
        return RunError("recording-failed", (str(path), 0, 0, ""), reason, "check that the disk is not full, or choose another one")
    return Error("file-unwritable", (str(path), 0, 0, ""), reason, "name a folder that exists and that you may write to")


@contextlib.contextmanager
def draft(path: Any) -> Iterator[pathlib.Path]:
    """A path beside `path`, with its ending, for a file that takes its place when the block ends without an exception.

    Raises
    ------
    Error
        file-unwritable, recording-failed.
    """
    path = pathlib.Path(path)
    beside = path.with_name(f".{path.stem}.{os.getpid()}.tmp{path.suffix}")
    try:
        yield beside
        os.replace(beside, path)
    except OSError as problem:
        raise unwritable(path, problem) from None
    finally:
        beside.unlink(missing_ok=True)
