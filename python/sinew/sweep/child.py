"""Runs samples with a time limit in a separate process, which can be killed together with its children."""

from __future__ import annotations

import ctypes
import os
import pickle
import select
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Sequence
from typing import Any, Optional

from .runner import Row, Runner

_LENGTH = struct.Struct("<Q")
_PR_SET_PDEATHSIG = 1
_LONGEST_WAIT = 3600.0  # s, because select() does not accept infinity


class Child:
    """A process that runs samples one by one. It is replaced if a sample takes too long or ends it.

    Parameters
    ----------
    packed : bytes
        The job.
    timeout : float
        Limit on each sample, s.
    """

    def __init__(self, packed: bytes, timeout: float) -> None:
        self._packed, self._timeout = packed, timeout
        self._process: Optional[subprocess.Popen] = None

    def row(self, index: int, values: Sequence[Any]):
        """As Runner.row()."""
        begin = time.perf_counter()
        try:
            if self._process is None:
                self._start()
                begin = time.perf_counter()  # the start of the process does not count
            self._send((index, values))
            return self._receive(begin + self._timeout)
        except TimeoutError:
            error = f"it took more than {self._timeout:g} s and was ended; simplify the sample, or give a longer timeout [timeout]"
        except (OSError, EOFError):
            error = f"its process died{self._cause()} [process-died]"
        self.close()
        return Row(index, "failed", error, time.perf_counter() - begin, {})

    def close(self) -> None:
        """Ends the process and all processes that it started."""
        if self._process is None:
            return
        try:
            os.killpg(self._process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self._process.communicate()
        self._process = None

    def _cause(self) -> str:
        code = self._process.wait() if self._process else None
        if code is None:
            return ""
        return f" of signal {signal.Signals(-code).name}" if code < 0 else f" with exit code {code}"

    def _start(self) -> None:
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        self._process = subprocess.Popen([sys.executable, "-c", "from sinew.sweep import child; child.serve()"], stdin=subprocess.PIPE,
                                         stdout=subprocess.PIPE, env=environment, start_new_session=True)
        self._send(self._packed)
        self._receive(time.perf_counter() + 300.0)  # acknowledges that the package is loaded

    def _send(self, what: Any) -> None:
        data = pickle.dumps(what)
        pipe = self._process.stdin
        pipe.write(_LENGTH.pack(len(data)) + data)
        pipe.flush()

    def _receive(self, end: float) -> Any:
        data = self._read(_LENGTH.size, end)
        return pickle.loads(self._read(_LENGTH.unpack(data)[0], end))

    def _read(self, count: int, end: float) -> bytes:
        handle, data = self._process.stdout.fileno(), b""
        while len(data) < count:
            left = end - time.perf_counter()
            if left <= 0.0:
                raise TimeoutError
            if not select.select([handle], [], [], min(left, _LONGEST_WAIT))[0]:
                continue
            part = os.read(handle, count - len(data))
            if not part:
                raise EOFError
            data += part
        return data


def serve() -> None:
    """Main loop of the process: reads the job, then samples, until its input ends."""
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)  # ends with the worker
    source, sink = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    # Samples print to standard error instead of the pipe of the rows, and read an empty standard input.
    os.dup2(2, 1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)

    def receive() -> Any:
        length = source.read(_LENGTH.size)
        return pickle.loads(source.read(_LENGTH.unpack(length)[0])) if len(length) == _LENGTH.size else None

    def send(what: Any) -> None:
        data = pickle.dumps(what)
        sink.write(_LENGTH.pack(len(data)) + data)
        sink.flush()

    runner = Runner(pickle.loads(receive()))
    send(True)
    while (sample := receive()) is not None:
        send(runner.row(*sample))
