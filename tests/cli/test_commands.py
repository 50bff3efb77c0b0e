"""The commands: arguments, help, completion, checks, benchmarks, validation.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import json
import os
import re
import shutil
import subprocess

import pytest
from program import CONTROL, DONE, PROGRAM, ROOT, WRONG, sinew

WRONG_ARGUMENTS = [
    ([], "bad-argument", "the commands are run"),
    (["rnu"], "unknown-option", "did you mean 'run'?"),
    (["run"], "bad-argument", "SCENE"),
    (["run", "--durration", "5s", "a.yaml"], "unknown-option", "did you mean --duration?"),
    (["bench", "a.yaml", "--step", "3"], "unknown-option", "did you mean --steps?"),
    (["run", "a.yaml", "b.yaml"], "bad-argument", "b.yaml"),
    (["run", "none.yaml"], "file-not-found", "none.yaml"),
    (["run", "{scene}", "--duration", "5mm"], "wrong-dimension", "--duration"),
    (["run", "{scene}", "--duration", "soon"], "not-a-number", "--duration"),
    (["run", "{scene}", "--duration", "0s"], "out-of-range", "--duration"),
    (["run", "{scene}", "--duration", "5 parsec"], "unknown-unit", "--duration"),
    (["run", "{scene}", "--duration", "1e12 s"], "out-of-range", "steps"),
    (["run", "{scene}", "--threads", "0"], "out-of-range", "--threads"),
    (["run", "{scene}", "--set", "time_step"], "bad-argument", "time_step"),
    (["run", "{scene}", "--set", "time_stp=1ms"], "unknown-key", "time_step"),
    (["run", "{scene}", "--set", "actuators.upp.command.tension=1N"], "unknown-name", "up"),
    (["run", "{scene}", "--controller", "x"], "unknown-name", "--controller"),
    (["run", "{scene}", "--out", "/proc/nothing/here"], "file-unwritable", "--out"),
    (["bench", "{scene}", "--steps", "0"], "out-of-range", "--steps"),
    (["bench", "{scene}", "--steps", "many"], "bad-argument", "--steps"),
    (["bench", "{scene}", "--tangent", "best"], "unknown-choice", "exact, projected or corotated"),
    (["validate", "patch", "--json"], "unknown-option", "unknown option '--json'"),
    (["validate", "patch", "--lst"], "unknown-option", "did you mean --list?"),
    (["validate", "--jobs", "two"], "bad-argument", "--jobs"),
    (["info"], "bad-argument", "FILE"),
    (["info", "none.vtu"], "file-not-found", "none.vtu"),
    (["info", "{scene}", "--units", "mm"], "unknown-option", "did you mean --unit?"),
    (["info", "{folder}"], "file-unreadable", "give a mesh, a surface, a scene, a saved state, or the folder of a run"),
    (["info", "{junk}"], "unknown-format", "junk"),
    (["info", "{junk}", "--unit", "kg"], "wrong-dimension", "--unit"),
    (["mesh", "-o", "a.vtu"], "bad-argument", "--shape"),
    (["mesh", "--shape", "torus", "-o", "a.vtu"], "unknown-choice", "torus"),
    (["mesh", "--shape", "block", "-o", "a.msh"], "unknown-format", ".vtu"),
    (["mesh", "--shape", "block", "-o", "/proc/nothing/a.vtu"], "file-unwritable", "/proc/nothing"),
    (["mesh", "a.stl", "-o", "a.vtu"], "bad-argument", "--size"),
    (["mesh", "none.stl", "-o", "a.vtu", "--size", "5mm"], "file-not-found", "none.stl"),
    (["mesh", "--shape", "block", "--size", "-5mm", "-o", "a.vtu"], "out-of-range", "--size"),
    (["mesh", "--shape", "block", "--set", "lenght=5mm", "-o", "a.vtu"], "unknown-key", "did you mean 'length'"),
    (["mesh", "--shape", "block", "--set", "length=5kg", "-o", "a.vtu"], "wrong-dimension", "length"),
    (["mesh", "--shape", "block", "--set", "length", "-o", "a.vtu"], "bad-argument", "length"),
    (["mesh", "a.stl", "--size", "5mm", "--set", "length=5mm", "-o", "a.vtu"], "bad-argument", "--set"),
    (["run", "{scene}", "--check", "--set", "bodies.beam.fixed=[{{set: x_mn}}]"], "unknown-set", "x_mi"),
    (["completion", "tcsh"], "unknown-choice", "use one of bash, zsh, fish"),
    (["run", "{scene}", "--glb", "motion.gltf"], "unknown-format", "*.glb"),
    (["run", "{scene}", "--glb", "none/motion.glb"], "file-unwritable", "none/motion.glb"),
    (["view", "{scene}", "--no-open", "--port", "99999"], "out-of-range", "65535"),
    (["view", "{scene}", "--no-open", "--host", "nowhere"], "bad-argument", "127.0.0.1"),
    (["view", "{scene}", "--no-open", "--speed", "1000"], "out-of-range", "100"),
]


@pytest.mark.parametrize("arguments, kind, words", WRONG_ARGUMENTS,
                         ids=[" ".join(a) or "nothing" for a, _, _ in WRONG_ARGUMENTS])
def test_wrong_arguments(arguments, kind, words, scene, tmp_path):
    (tmp_path / "junk").write_bytes(b"\x00\x01junk")
    names = {"scene": scene(), "folder": tmp_path, "junk": tmp_path / "junk"}
    before = sorted(tmp_path.rglob("*"))
    result = sinew(*(a.format(**names) for a in arguments), cwd=tmp_path)
    assert result.returncode == WRONG, result.stdout + result.stderr
    assert result.stderr.startswith("sinew: error: ") and f"[{kind}]" in result.stderr, result.stderr
    assert words in result.stderr
    assert result.stdout == ""
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("command", [[], ["run"], ["bench"], ["info"], ["mesh"], ["validate"], ["schema"], ["plot"], ["sweep"], ["estimate"], ["convergence"],
                                     ["completion"]],
                         ids=lambda c: " ".join(c) or "sinew")
def test_help(command):
    result = sinew(*command, "--help")
    assert result.returncode == DONE and result.stderr == ""
    examples = re.findall(r"^  (sinew .*)", result.stdout, re.MULTILINE)
    assert examples
    if command:
        assert all(command[0] in line for line in examples)  # its own examples, not those of the program


def test_version():
    assert sinew("--version").stdout.startswith("sinew 0.")


def test_schema_and_reference_are_those_of_the_documentation():
    schema = sinew("schema").stdout
    assert json.loads(schema) == json.loads((ROOT / "docs" / "scene.schema.json").read_text())
    assert sinew("reference").stdout.startswith("# ")


def test_a_check_builds_and_runs_nothing(scene, tmp_path):
    path = scene()
    result = sinew("run", path, "--check", cwd=tmp_path)
    assert result.returncode == DONE and result.stderr == ""
    assert "240 tet4 elements" in result.stdout and re.search(r"would run +0.1 s in 10 steps", result.stdout)
    assert list(tmp_path.iterdir()) == [path]

COMPLETIONS = [
    ("sinew ru", {"run"}, {"bench"}),
    ("sinew ''", {"run", "mesh", "convergence"}, {"reference"}),
    ("sinew --", {"--help", "--version"}, {"run"}),
    ("sinew run --v", {"--vtk", "--video"}, {"--set"}),
    ("sinew mesh --shape r", {"ribbed-finger"}, {"block"}),
    ("sinew run be", {"beam.yaml"}, {"--set"}),
    ("sinew completion ''", {"bash", "zsh", "fish"}, {"beam.yaml"}),
]

# Script for each shell: the preamble, and the commands that complete the words of a case.
COMPLETE = {
    "bash": ("source <({program} completion bash)",
             "COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _sinew; printf '%s\\n' \"${{COMPREPLY[@]}}\""),
    # Replaces zsh's completion functions by ones that print their matches for the word at the cursor.
    "zsh": ("""compdef() {{ }}
offer() {{ for word in "$@"; do [[ $word == $PREFIX* ]] && print -r -- $word; done }}
compadd() {{ shift; offer "$@" }}
_files() {{ offer *(N) }}
_describe() {{ local -a all; all=(${{(P)@[-1]}}); offer ${{all%%:*}} }}
source <({program} completion zsh)""", "words=({words}); CURRENT=$#words; PREFIX=$words[CURRENT]; _sinew"),
    "fish": ("{program} completion fish | source", "complete -C \"$(string replace \"''\" '' \"{words}\")\""),
}  # fmt: skip


@pytest.mark.parametrize("shell", COMPLETE)
def test_shells_complete(shell, scene):
    if shutil.which(shell) is None:
        pytest.skip(f"without {shell}")
    first, each = COMPLETE[shell]
    lines = [first.format(program=os.path.abspath(PROGRAM))]
    for words, _, _ in COMPLETIONS:
        lines += [each.format(words=words), "echo @@"]
    plain = {"bash": ["--norc"], "zsh": ["-f"], "fish": ["--no-config"]}[shell]
    found = subprocess.run([shell, *plain, "-c", "\n".join(lines)], capture_output=True, text=True, cwd=scene().parent, check=True)
    assert found.stderr == ""
    answers = found.stdout.split("@@\n")
    assert len(answers) == len(COMPLETIONS) + 1
    for answer, (words, some, without) in zip(answers, COMPLETIONS):
        offered = {row.split("\t")[0] for row in answer.splitlines()}  # fish: word, tab, description
        assert some <= offered and not without & offered, (words, offered)

STAGES = ["detection", "assembly", "rows", "factorisation", "law", "correction", "total"]


def test_bench_writes_its_figures(scene, tmp_path):
    path = scene()
    path.write_text(path.read_text() + CONTROL)
    result = sinew("bench", path, "--steps", "25", "--threads", "2", "--json", tmp_path / "b.json",
                   "--compare-eigen", "--tangent", "projected", cwd=tmp_path)
    assert result.returncode == DONE, result.stderr
    figures = json.loads((tmp_path / "b.json").read_text())
    assert figures["steps"] == 25 and figures["threads"] == 2 and figures["machine"]
    assert figures["tangent"] == "projected"
    assert list(figures["stages"]) == STAGES
    for stage in figures["stages"].values():
        assert 0 <= stage["median_us"] <= stage["p95_us"]
    total = figures["stages"]["total"]["median_us"]
    assert total > figures["stages"]["assembly"]["median_us"] > 0
    eigen = figures["eigen_simplicial_ldlt"]
    assert eigen["ratio"] == pytest.approx(total / eigen["median_us"])
    assert figures["bytes_per_simulation"] > 1000
    assert "Eigen SimplicialLDLT" in result.stdout
    assert not (tmp_path / "out").exists(), "nothing is recorded"


def test_validate_passes_cases_on(tmp_path):
    (tmp_path / "run.py").write_text("import sys\nprint(sys.argv[1:])\nsys.exit(3)\n")
    result = subprocess.run([os.path.abspath(PROGRAM), "validate", "patch", "--jobs", "2", "--list"],
                            capture_output=True, text=True, env={**os.environ, "SINEW_VALIDATION_DIR": str(tmp_path)}, check=False)
    assert result.returncode == 3
    assert result.stdout.strip() == "['--list', '--jobs=2', '--', 'patch']"
    nowhere = subprocess.run([os.path.abspath(PROGRAM), "validate"], capture_output=True, text=True,
                             env={**os.environ, "SINEW_VALIDATION_DIR": "/nowhere"}, check=False)
    assert nowhere.returncode == WRONG and "[tool-missing]" in nowhere.stderr


def test_validation_resumes_with_the_cases_that_have_not_ended(tmp_path):
    folder, runs = tmp_path / "validation", tmp_path / "runs"
    shutil.copytree(ROOT / "validation" / "suite", folder / "suite", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "validation" / "run.py", folder)
    (folder / "cases").mkdir()
    case = folder / "cases" / "circle.py"
    case.write_text('TITLE, SETUP, SOURCES = "Circle", "A circle.", {"Archimedes": "Measurement of a circle"}\n'
                    f'def run(case):\n    open("{runs}", "a").write("x")\n'
                    '    case.check("pi", 3.1416, 3.14159265, 1e-5, source="Archimedes")\n')

    def validate(*options):
        done = subprocess.run([os.path.abspath(PROGRAM), "validate", *options, "--out", str(tmp_path / "docs")], capture_output=True,
                              text=True, env={**os.environ, "SINEW_VALIDATION_DIR": str(folder)}, check=False)
        assert done.returncode == 0, done.stderr
        return len(runs.read_text()), (tmp_path / "docs" / "scorecard.md").read_text()

    assert validate()[0] == 1
    assert validate()[0] == 2
    count, card = validate("--resume")
    assert count == 2 and "1 passed, 0 missed" in card
    case.write_text(case.read_text().replace("3.1416", "3.14159"))
    assert validate("--resume")[0] == 3
    shutil.copy(case, folder / "cases" / "other.py")
    one = subprocess.run([os.path.abspath(PROGRAM), "validate", "circle", "--out", str(tmp_path / "docs")], capture_output=True,
                         text=True, env={**os.environ, "SINEW_VALIDATION_DIR": str(folder)}, check=False)
    assert "    passed: pi: 3.1416, reference 3.1416, error " in one.stdout, one.stdout
    assert f"scorecard.md is unchanged; the plots are in {tmp_path / 'docs' / 'images'}" in one.stdout
