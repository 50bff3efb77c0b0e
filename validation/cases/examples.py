"""Every scene and script of examples/ as written: it ends without a complaint, and its figures are those that it claims."""

import pathlib
import tempfile

import sinew

from suite import examples
from suite.example_table import EXAMPLES

TITLE = "Examples: scenes and scripts as written"
SETUP = """Each scene and script of examples/ runs in an empty folder with the arguments that its page gives. It must end
without an error, a warning or a flagged step, and write nothing into examples/. Figures that its comment or page claims are
compared with the claim; the tolerance is a few units of its last digit, or the spread that the page names. `make examples` does
the same, and `make examples PRESET=portable` with the portable build."""
SOURCES = {"claim": "the comment of the example, or the page of the documentation named in the line"}
COST = 600
PATIENCE = 5.0  # other cases run beside it


def run(case):
    build = pathlib.Path(sinew.__file__).resolve().parents[2]
    if not (build / "bin" / "sinew").exists():
        case.skip("all examples", "the package is not in a build tree with bin/sinew", source="claim")
        return
    before = examples.source_state()
    for example in EXAMPLES:
        with tempfile.TemporaryDirectory(dir=case.scratch) as folder:
            ran = examples.run(example, build, pathlib.Path(folder), PATIENCE)
            if ran is None:
                case.skip(example.path, f"{example.needs} is missing", source="claim")
                continue
            case.agree(f"{example.path}: errors, warnings, flagged steps", ran.problem or "none", "none", source="claim")
            for figure in example.figures if not ran.problem else ():
                case.check(f"{example.path}: {figure.quantity}", figure.read(ran), figure.claim, figure.tolerance,
                           unit=figure.unit, relative=False, source="claim", remark=figure.where)
    case.agree("files under examples/ that have changed", ", ".join(examples.changed_sources(before)) or "none", "none",
               source="claim")
