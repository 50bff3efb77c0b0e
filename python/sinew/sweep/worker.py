"""A worker: runs samples of one job in batches."""

from __future__ import annotations

import math
import os
import pickle
import socket
import threading
from collections.abc import Sequence
from typing import Any

from .. import _core
from .child import Child
from .runner import Row, Runner
from .samples import Value

_turn = threading.Lock()
_known: dict[str, Any] = {}  # digest of the last job, and its runners


def run_batch(digest: str, packed: bytes, samples: Sequence[tuple[int, Sequence[Value]]],
              apart: bool = False) -> tuple[dict[str, str], list[Row]]:
    """Rows of some samples, and the worker that computed them. This is the task that Dask sends.

    Parameters
    ----------
    digest : str
        Digest of `packed`: a worker unpacks a job only once.
    packed : bytes
        The Job.
    samples : list of (index, values)
    apart : bool
        Run in a separate process even without a time limit, because a sample may end its process.
    """
    with _turn:  # one sample at a time, for any number of threads of the worker
        if _known.get("digest") != digest:
            _forget()
            job = pickle.loads(packed)
            _known.update(digest=digest, runner=Child(packed, job.timeout) if job.timeout else Runner(job))
        runner = _known["runner"]
        if apart and isinstance(runner, Runner):
            runner = _known.setdefault("apart", Child(packed, math.inf))
        rows = [runner.row(index, values) for index, values in samples]
    me = {"version": _core.__version__, "instruction_set": _core.instruction_set, "worker": f"{socket.gethostname()}:{os.getpid()}"}
    return me, rows


def _forget() -> None:
    for runner in _known.values():
        if isinstance(runner, Child):
            runner.close()
    _known.clear()
