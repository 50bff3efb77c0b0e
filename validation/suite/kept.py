"""Stored results of finished cases, to resume an interrupted run."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import importlib.util
import json
import pathlib

from .case import Check, Result

VALIDATION = pathlib.Path(__file__).resolve().parent.parent
FOLDER = VALIDATION.parent / "build" / "validation"


@functools.cache
def _code() -> bytes:
    """A digest of the code that every case runs: the Python package with its library, the suite, the reference solutions."""
    package = importlib.util.find_spec("sinew")
    digest = hashlib.sha256()
    for folder in (pathlib.Path(package.origin).parent, VALIDATION / "suite", VALIDATION / "reference"):
        for path in sorted(folder.rglob("*")):
            if path.suffix in (".py", ".so"):
                digest.update(path.read_bytes())
    return digest.digest()


def _stamp(name: str) -> str:
    case = (VALIDATION / "cases" / f"{name}.py").read_bytes()
    return hashlib.sha256(_code() + case).hexdigest()


def keep(result: Result) -> None:
    """Writes a case's result to build/validation, unless an error stopped the case."""
    if result.failure:
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"stamp": _stamp(result.name), "result": dataclasses.asdict(result)})
    (FOLDER / f"{result.name}.json").write_text(text)


def find(name: str, images: pathlib.Path) -> Result | None:
    """The stored result, if it was made by the same code and its figures still exist."""
    try:
        kept = json.loads((FOLDER / f"{name}.json").read_text())
    except (FileNotFoundError, json.JSONDecodeError):
        return None
    if kept["stamp"] != _stamp(name):
        return None
    result = Result(**kept["result"])
    result.checks = [Check(**check) for check in kept["result"]["checks"]]
    result.figures = [(file, caption) for file, caption in kept["result"]["figures"]]
    return result if all((images / file).exists() for file, _ in result.figures) else None
