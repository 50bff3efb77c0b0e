"""Common code of the commands that run in Python: parser, quantities and exit codes."""

from __future__ import annotations

import argparse
import signal
import sys
import warnings
from collections.abc import Callable
from typing import Optional

from . import _core
from ._whole_files import is_full, unwritable
from .errors import Error, RunError

__all__ = ["FAILED", "exit_code", "parser", "quantity", "seconds"]

#: Exit codes, as of the program: 0 success, 1 failed or unreliable run, 2 invalid input, 128 + n after signal n.
FAILED, INVALID_INPUT, SIGNALLED = 1, 2, 128

_TIME = (0, 0, 1, 0)


def parser(command: str) -> argparse.ArgumentParser:
    """Parser of a command's options. The program has already checked their names and prints their help.

    Parameters
    ----------
    command : str
        "sweep".

    Returns
    -------
    argparse.ArgumentParser
        With the argument SCENE.
    """
    found = argparse.ArgumentParser(prog=f"sinew {command}", usage=f"sinew {command} [OPTIONS] SCENE", allow_abbrev=False,
                                    description=f"`sinew {command} --help` describes the options.")
    found.add_argument("scene", metavar="SCENE")
    return found


def quantity(option: str, text: str, dimension: Optional[tuple[int, ...]] = None, *, kind: str = "", example: str = "") -> float:
    """The value of an option, in SI units.

    Parameters
    ----------
    option : str
        Its name, for errors.
    text : str
        A number with a unit, or in SI units without one.
    dimension : tuple of int, optional
        Exponents of length, mass, time and temperature; any by default.
    kind, example : str
        Kind of value that the option takes, such as "a time", and a valid example, for errors.

    Raises
    ------
    Error
        not-a-number, unknown-unit, wrong-dimension.
    """
    try:
        value, found = _core._quantity(text)
    except Error as error:
        raise Error(error.kind, option, error.message, error.remedy) from None
    if dimension is not None and found not in ((0, 0, 0, 0), dimension):
        raise Error("wrong-dimension", option, f"'{text}' is not {kind}", f"write for example {example}")
    return value


def seconds(option: str, text: Optional[str]) -> Optional[float]:
    """A time in s as quantity() reads it; None for an option that is not given."""
    return None if text is None else quantity(option, text, _TIME, kind="a time", example="5s")


def exit_code(command: Callable[[], int], interrupted: str = "") -> int:
    """Runs a command and returns its exit code. Errors and warnings go to standard error.

    Parameters
    ----------
    command : callable
        Returns the exit code.
    interrupted : str
        Printed after SIGINT and SIGTERM, both of which raise KeyboardInterrupt in the command.

    Returns
    -------
    int
        The value returned by `command`; 1 for RunError and a full disk, 2 for any other Error, 130 after SIGINT and 143 after SIGTERM.
    """
    before = {number: signal.signal(number, _interrupt) for number in (signal.SIGINT, signal.SIGTERM)}
    show = warnings.showwarning
    warnings.showwarning = lambda message, *_, **__: print(f"sinew: warning: {message}", file=sys.stderr)
    try:
        return command()
    except Error as error:
        print(f"sinew: error: {error}", file=sys.stderr)
        return FAILED if isinstance(error, RunError) else INVALID_INPUT
    except OSError as problem:
        if not is_full(problem):
            raise
        print(f"sinew: error: {unwritable(problem.filename or 'a file', problem)}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt as stop:
        if interrupted:
            print(f"sinew: {interrupted}", file=sys.stderr)
        return SIGNALLED + (stop.args[0] if stop.args else signal.SIGINT)
    finally:  # restores the handlers of a caller in Python
        warnings.showwarning = show
        for number, handler in before.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)


def _interrupt(number: int, _frame: object) -> None:
    raise KeyboardInterrupt(number)
