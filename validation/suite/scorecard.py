"""Writes docs/scorecard.md from the results of all cases."""

from __future__ import annotations

import pathlib

from .case import PASSED, KNOWN, MISSED, REPORTED, SKIPPED, Result

HEAD = """# Scorecard

Written by `make validate` (`/usr/bin/python3 validation/run.py`); do not edit. [validation.md](validation.md) describes the
cases. Errors are relative unless they have a unit. `< 1e-13` is used for quantities that are exact up to rounding: the error
is below this power of ten. *Not scored* marks a number without a reference that could decide. Times depend on the machine and
are in [performance.md](performance.md).

"""


def totals(results: list[Result]) -> str:
    """A summary such as '120 checks: 118 passed, 2 missed, 1 skipped; 4 numbers not scored'."""
    def count(*verdicts):
        return sum(result.count(*verdicts) for result in results)

    scored = count(PASSED, MISSED, KNOWN)
    text = f"{scored} checks: {count(PASSED)} passed, {count(MISSED, KNOWN)} missed"
    if count(KNOWN):
        text += f" ({count(KNOWN)} of them known)"
    if count(SKIPPED):
        text += f", {count(SKIPPED)} skipped"
    if count(REPORTED):
        text += f"; {count(REPORTED)} numbers not scored"
    broken = [result.name for result in results if result.failure]
    if broken:
        text += f"; stopped with an error: {', '.join(broken)}"
    return text


def write(results: list[Result], path: pathlib.Path, images: pathlib.Path) -> None:
    """Writes all cases in the given order, that of their file names."""
    text = HEAD + f"**{totals(results)}.**\n\n"
    text += "| case | passed | missed | not scored | skipped |\n|---|---|---|---|---|\n"
    for result in results:
        missed = result.count(MISSED, KNOWN)
        text += (f"| [{result.title}](#{result.name}) | {result.count(PASSED)} | "
                 f"{f'**{missed}**' if missed else 0} | {result.count(REPORTED)} | "
                 f"{result.count(SKIPPED)} |\n")
    for result in results:
        text += "\n" + section(result, path.parent, images)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def section(result: Result, folder: pathlib.Path, images: pathlib.Path) -> str:
    """The scorecard's section for one case."""
    text = f'<a id="{result.name}"></a>\n## {result.title}\n\n{result.setup.strip()}\n\n'
    if result.failure:
        text += f"**Stopped with an error:** `{result.failure.strip().splitlines()[-1]}`\n\n"
    remarks: list[str] = []
    if result.checks:
        text += "| quantity | Sinew | reference | error | tolerance | verdict | source |\n"
        text += "|---|---|---|---|---|---|---|\n"
    for check in result.checks:
        mark = ""
        if check.remark:
            if check.remark not in remarks:
                remarks.append(check.remark)
            mark = f" ({remarks.index(check.remark) + 1})"
        text += (f"| {check.quantity}{mark} | {check.ours} | {check.reference} | {check.error} | "
                 f"{check.tolerance} | {check.verdict} | {check.source} |\n")
    text += "\n"
    for i, remark in enumerate(remarks):
        text += f"({i + 1}) {remark}.  \n"
    if remarks:
        text += "\n"
    for file, caption in result.figures:
        link = pathlib.PurePosixPath(images.relative_to(folder).as_posix()) / file
        text += f"![{caption}]({link})\n*{caption}*\n\n"
    used = {check.source for check in result.checks}
    for key, citation in result.sources.items():
        if key in used:
            text += f"- *{key}*: {citation}\n"
    return text
