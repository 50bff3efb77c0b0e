"""Runs the samples of a sweep on Dask workers and writes the results."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import queue
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from multiprocessing import resource_tracker
from typing import Any, Optional

from ..errors import Error, RunError
from .progress import Progress
from .runner import Row
from .samples import Design
from .store import Store
from .worker import run_batch

_BATCH = 0.5  # s, intended duration of a batch
_LARGEST = 10_000
_GROWTH = 8
_POLL = 0.1  # s
_ANSWER, _NO_ANSWER = 3.0, 10.0  # s: timeouts of a request to the scheduler, and of a lost connection
_CONNECT, _FIRST_WORKER = 20.0, 120.0  # s


class Batches:
    """Size of batches of samples, from the times measured so far."""

    def __init__(self) -> None:
        self._recent: deque[float] = deque(maxlen=9)  # s per sample
        self._largest = 1

    def add(self, rows: Sequence[Row]) -> None:
        """Takes a finished batch into account."""
        self._recent.append(sum(row.seconds for row in rows) / len(rows))
        self._largest = max(self._largest, len(rows))

    def size(self, left: int, workers: int) -> int:
        """Size of the next batch. Batches become smaller towards the end, so that no worker waits long for the last one."""
        if not self._recent:
            return 1
        typical = sorted(self._recent)[len(self._recent) // 2]
        wanted = min(round(_BATCH / max(typical, 1e-6)), _GROWTH * self._largest, _LARGEST)
        return max(1, min(wanted, -(-left // (2 * max(workers, 1)))))


@contextlib.contextmanager
def connect(scheduler: Any, workers: Optional[int]) -> Iterator[Any]:
    """A Dask client: the given one, one for the address of a scheduler, or one for a new cluster of local processes.

    Raises
    ------
    Error
        tool-missing without Dask; bad-argument if no scheduler answers at the address.
    """
    try:
        import dask
        import distributed
    except ImportError as missing:
        raise Error("tool-missing", "sinew.sweep", f"sweeps need Dask: {missing}", "apt-get install python3-distributed") from None
    if isinstance(scheduler, distributed.Client):
        yield scheduler
        return
    with contextlib.ExitStack() as stack:
        stack.enter_context(_quiet())
        if scheduler is None:
            # A new process reports folders left behind by killed ones before silence_logs takes effect.
            silent = dask.config.set({"distributed.nanny.pre-spawn-environ.DASK_LOGGING__DISTRIBUTED": "critical"})
            with _without_interrupts(), silent:
                cluster = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0",
                                                   silence_logs=logging.CRITICAL)
                stack.callback(_close, cluster, 5)
                client = distributed.Client(cluster)
                stack.callback(_close, client, 2)
        else:
            try:
                client = distributed.Client(str(scheduler), timeout=_CONNECT)
            except (OSError, ValueError, TimeoutError) as problem:
                raise Error("bad-argument", "sweep(scheduler)", f"no scheduler answers at '{scheduler}': {problem}",
                            "start one with dask-scheduler, and give its address such as tcp://127.0.0.1:8786") from None
            stack.callback(_close, client, 2)
        yield client


def _close(what: Any, timeout: int) -> None:
    """Closes a client or a cluster. One that no longer answers must not hide an earlier error."""
    with contextlib.suppress(OSError, TimeoutError):
        what.close(timeout=timeout)


@contextlib.contextmanager
def _without_interrupts() -> Iterator[None]:
    """Blocks Ctrl-C while processes are started. The started threads and processes inherit the mask, so Ctrl-C on a terminal,
    which goes to all of its processes, reaches the client only.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    resource_tracker.ensure_running()  # its own start would unblock the signal in this thread
    waiting: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: waiting.append(number))
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        signal.signal(signal.SIGINT, before)
        if waiting:
            signal.raise_signal(signal.SIGINT)


@contextlib.contextmanager
def held_interrupts() -> Iterator[Callable[[], None]]:
    """Delays Ctrl-C, and other signals with handlers, until the returned function is called; a second signal acts at once.

    Python ignores exceptions of handlers in some places, such as the destructors of Dask's futures; the sweep would then
    continue. In threads other than the main one, which get no signals, the function does nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield lambda: None
        return
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    before = {number: handler for number, handler in before.items() if callable(handler)}
    waiting: list[int] = []

    def hold(number: int, frame: Any) -> None:
        waiting.append(number)
        if len(waiting) > 1:
            before[number](number, frame)

    def act() -> None:
        while waiting:
            number = waiting.pop()
            before[number](number, sys._getframe())

    for number in before:
        signal.signal(number, hold)
    try:
        yield act
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Silences Dask's messages about lost workers and connections; the sweep reports their consequences."""
    names = [name for name in logging.root.manager.loggerDict if name.split(".")[0] in ("distributed", "tornado", "asyncio")]
    loggers = [logging.getLogger(name) for name in names]
    before = [logger.level for logger in loggers]
    try:
        for logger in loggers:
            logger.setLevel(logging.CRITICAL)
        yield
    finally:
        for logger, level in zip(loggers, before):
            logger.setLevel(level)


class Engine:
    """Keeps the workers of a client busy with the remaining samples.

    Parameters
    ----------
    client : distributed.Client
    packed : bytes
        The job.
    design : Design
    order : list of int
        Remaining samples.
    store : Store
    progress : Progress
    """

    def __init__(self, client: Any, packed: bytes, design: Design, order: Sequence[int], store: Store, progress: Progress) -> None:
        self._client, self._packed, self._design = client, packed, design
        self._digest = hashlib.sha256(packed).hexdigest()
        self._left, self._store, self._progress = deque(order), store, progress
        self._batches = Batches()
        self._done: queue.SimpleQueue = queue.SimpleQueue()
        self._flying: dict[Any, tuple[list[int], bool]] = {}
        self._workers, self._counted = 0, 0.0
        self._answered = time.monotonic()

    def run(self) -> None:
        """Runs until every sample has a row.

        Raises
        ------
        RunError
            scheduler-lost; the rows written so far are kept.
        Error
            If the workers cannot run samples at all.
        """
        with held_interrupts() as act:
            self._await_workers(act)
            try:
                while self._left or self._flying:
                    self._fill()
                    try:
                        self._take(self._done.get(timeout=_POLL))
                    except queue.Empty:
                        self._check_scheduler()
                    self._progress.draw(self._workers)
                    act()
            finally:
                if self._flying and self._client.status == "running":
                    self._client.cancel(list(self._flying), force=True)

    def _await_workers(self, act: Callable[[], None]) -> None:
        begin = time.monotonic()
        while self._count_workers() == 0:
            act()
            if time.monotonic() - begin > _FIRST_WORKER:
                raise RunError("scheduler-lost", "sweep(scheduler)", f"the scheduler had no worker for {_FIRST_WORKER:g} s",
                               "start workers: dask-worker ADDRESS --nthreads 1")
            time.sleep(_POLL)

    def _count_workers(self) -> int:
        """Number of threads of all workers, updated about once per second."""
        if time.monotonic() - self._counted > 1.0 or self._workers == 0:
            try:
                # As Client.nthreads(), which waits too long if the scheduler is gone.
                self._workers = sum(self._client.sync(self._client.scheduler.ncores, callback_timeout=_ANSWER).values())
            except (OSError, RuntimeError, TimeoutError) as problem:
                if self._client.status != "running" or self._workers == 0:
                    self._lost(problem)
            self._counted = time.monotonic()
        return self._workers

    def _fill(self) -> None:
        workers = self._count_workers()
        while self._left and len(self._flying) < 2 * workers:
            size = self._batches.size(len(self._left), workers)
            self._submit([self._left.popleft() for _ in range(min(size, len(self._left)))])

    def _submit(self, samples: list[int], apart: bool = False) -> None:
        batch = [(index, self._design.values(index)) for index in samples]
        future = self._client.submit(run_batch, self._digest, self._packed, batch, apart, pure=False)
        self._flying[future] = samples, apart
        future.add_done_callback(self._done.put)

    def _take(self, future: Any) -> None:
        from distributed import KilledWorker

        if future not in self._flying:
            return
        samples, apart = self._flying[future]
        if future.status in ("pending", "lost"):  # the worker died before its rows arrived; Dask repeats the task
            future.add_done_callback(self._done.put)
            return
        if future.status == "cancelled":
            self._forgotten(future)
            return
        try:
            by, rows = future.result(timeout=60)
        except KilledWorker:
            self._died(samples, apart)
        except (OSError, TimeoutError) as problem:
            self._lost(problem)
        except Exception as problem:  # from Dask or the worker's installation, because samples do not raise
            if type(problem).__name__ == "CancelledError":
                self._forgotten(future)
                return
            raise RunError("worker-failed", "sweep", f"a worker could not run samples: {type(problem).__name__}: {problem}",
                           "its Python needs this version of sinew, h5py and NumPy") from problem
        else:
            self._batches.add(rows)
            self._write(rows, by)
        del self._flying[future]

    def _forgotten(self, future: Any) -> None:
        """Resubmits a batch that is unknown to the scheduler, which was restarted at the same address; raises if it is gone."""
        if self._client.status != "running":
            self._lost("the connection broke")
        self._submit(*self._flying.pop(future))

    def _died(self, samples: list[int], apart: bool) -> None:
        """Handles a batch whose workers died several times, perhaps because of another batch on them. Its samples are run again in
        separate processes, which shows the sample that ends its process.
        """
        if not apart:
            for index in samples:
                self._submit([index], apart=True)
            return
        error = "the sample ended its worker, also when repeated; give the processes more memory [process-died]"
        nobody = {"version": "", "instruction_set": "", "worker": ""}
        self._write([Row(index, "failed", error, float("nan"), {}) for index in samples], nobody)

    def _write(self, rows: Sequence[Row], by: dict[str, str]) -> None:
        self._store.append(rows, [self._design.values(row.index) for row in rows], by)
        self._progress.add(len(rows), sum(row.status == "failed" for row in rows))

    def _check_scheduler(self) -> None:
        if self._client.status == "running":
            self._answered = time.monotonic()
        elif time.monotonic() - self._answered > _NO_ANSWER:
            self._lost("it does not answer")

    def _lost(self, why: Any) -> None:
        raise RunError("scheduler-lost", "sweep", f"the scheduler is gone ({why}); {self._store.count} of {self._design.size} samples are "
                       f"in {self._store.path}", "go on with resume=True (--resume)") from None
