"""Exit codes and quantities of the commands that run in Python."""

import contextlib
import os
import signal
import subprocess
import sys
import warnings

import pytest

from sinew import Error, RunError, command

SCRIPT = """
import os, signal
from sinew import command

def work():
    os.kill(os.getpid(), signal.{name})
    signal.pause()

raise SystemExit(command.exit_code(work, "the table is complete"))
"""


def raising(error):
    def work():
        raise error

    return work


def test_who_calls_a_command_keeps_its_handlers():
    def state():
        return [signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM), warnings.showwarning]

    before = state()
    seen = []
    for error in (None, Error("unknown-name", "--measure", "no 'tp'"), KeyboardInterrupt(), ValueError()):
        def work(error=error):
            seen.append(state())
            if error is not None:
                raise error
            return 0

        with contextlib.suppress(ValueError):  # other exceptions pass to the caller
            command.exit_code(work)
        assert state() == before
    assert all(one[:2] != before[:2] for one in seen)


def test_errors_are_told_on_stderr_with_their_exit_code(capsys):
    assert command.exit_code(lambda: 0) == 0
    assert command.exit_code(raising(RunError("diverged", "step 3", "no solution", "try less"))) == 1
    assert command.exit_code(raising(Error("unknown-name", "--measure", "no 'tp'"))) == 2
    assert capsys.readouterr().err == ("sinew: error: step 3: no solution; try less [diverged]\n"
                                       "sinew: error: --measure: no 'tp' [unknown-name]\n")


def test_warnings_are_told_as_the_program_tells_them(capsys):
    def work():
        warnings.warn("the mesh is coarse", UserWarning, stacklevel=1)
        return 0

    assert command.exit_code(work) == 0
    assert capsys.readouterr().err == "sinew: warning: the mesh is coarse\n"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_a_command_with_128_and_their_number(number):
    done = subprocess.run([sys.executable, "-c", SCRIPT.format(name=number.name)], capture_output=True, text=True, check=False,
                          env=os.environ, timeout=60)
    assert done.returncode == 128 + number
    assert done.stderr == "sinew: the table is complete\n"


def test_a_time_has_a_unit_or_is_in_seconds():
    assert command.seconds("--duration", None) is None
    assert command.seconds("--duration", "250 ms") == 0.25
    assert command.seconds("--duration", "2") == 2.0
    for text, kind in (("5 mm", "wrong-dimension"), ("5 parsec", "unknown-unit"), ("soon", "not-a-number")):
        with pytest.raises(Error, match="--duration") as wrong:
            command.seconds("--duration", text)
        assert wrong.value.kind == kind
