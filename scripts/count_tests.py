#!/usr/bin/env python3
"""Sums up the results that scripts/test.sh left in a folder, as one line: "N passed, N failed".

Before it, each failed test is named with the end of what it printed: whoever sees only the last lines of
a long log learns what to run again.

A ctest entry without a report of GoogleTest or pytest, such as a program that crashed, counts as one test. Skipped
tests, if any, are counted separately. If nothing passed, the run fails.
"""

import sys
import xml.etree.ElementTree as xml
from pathlib import Path


def cases(path):
    """The (name, outcome) of each test in a JUnit or GoogleTest report: "passed", "failed" or "skipped"."""
    outcomes = []
    for case in xml.parse(path).getroot().iter("testcase"):
        skipped = case.find("skipped") is not None or case.get("status") in ("notrun", "disabled")
        failed = (
            case.find("failure") is not None
            or case.find("error") is not None
            or case.get("status") == "fail"
        )
        outcome = "failed" if failed else "skipped" if skipped else "passed"
        outcomes.append((case.get("name"), outcome))
    return outcomes


def ending(path, name, lines=4):
    """The last lines of what the failed test of this name printed, from a JUnit or GoogleTest report."""
    for case in xml.parse(path).getroot().iter("testcase"):
        if case.get("name") != name:
            continue
        # ctest writes the output beside an empty message, the others write it into the failure.
        said = [case.findtext(tag) or "" for tag in ("failure", "error", "system-out")]
        printed = [line.rstrip() for text in said for line in text.splitlines() if line.strip()]
        return [line[:200] for line in printed[-lines:]]
    return []


def tell(path, name, outcome):
    """Prints the name of a failed test and the end of its output."""
    if outcome == "failed":
        print(f"failed: {path.stem}: {name}")
        for line in ending(path, name):
            print(f"    {line}")


def main(folder):
    """Prints the failed tests and the sums. Returns 1 if anything failed or nothing passed."""
    count = {"passed": 0, "failed": 0, "skipped": 0}
    reports = {path.stem.removeprefix("test_"): path for path in (folder / "gtest").glob("*.xml")}
    reports |= {path.stem: path for path in (folder / "pytest").glob("*.xml")}
    programs = cases(folder / "ctest.xml") if (folder / "ctest.xml").exists() else []
    for name, outcome in programs:
        inside = cases(reports[name]) if name in reports else []
        # A program can fail although all of its tests passed, for example by a leak that is found at its end.
        if not inside or (outcome == "failed" and all(o != "failed" for _, o in inside)):
            count[outcome] += 1
            tell(folder / "ctest.xml", name, outcome)
        for test, outcome in inside:
            count[outcome] += 1
            tell(reports[name], test, outcome)

    skipped = f", {count['skipped']} skipped" if count["skipped"] else ""
    print(f"{count['passed']} passed, {count['failed']} failed{skipped}")
    return 1 if count["failed"] or not count["passed"] else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
