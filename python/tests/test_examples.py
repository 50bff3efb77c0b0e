"""The examples and the program that runs them: all are in its table, none writes beside itself, and wrong claims are found."""

import ast
import dataclasses
import sys
from pathlib import Path

import pytest
import sinew

REPOSITORY = Path(__file__).resolve().parents[2]
FOLDER = REPOSITORY / "examples"
sys.path.insert(0, str(REPOSITORY / "validation"))
from suite import examples  # noqa: E402
from suite.example_table import EXAMPLES, PARTS  # noqa: E402

SCRIPTS = sorted(FOLDER.rglob("*.py"))
# Calls that write a file named by an argument, or by the object before the point.
WRITERS = {"savefig", "savetxt", "savez", "savez_compressed", "save", "write", "write_text", "write_bytes", "mkdir", "touch",
           "to_csv", "to_file", "unlink", "rmdir", "rename", "replace", "write_motion"}  # fmt: skip


def test_every_example_is_in_the_table():
    found = {str(path.relative_to(FOLDER)) for kind in ("*.py", "*.yaml") for path in FOLDER.rglob(kind)}
    assert {one.path for one in EXAMPLES} == found - set(PARTS)


def calls_that_write_beside(text):
    """Lines of calls that write to a place derived from __file__, through variables and arguments of functions of the script."""
    tree = ast.parse(text)
    functions = {node.name: node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    own = {"__file__"}

    def is_own(node):
        return any(isinstance(part, ast.Name) and part.id in own for part in ast.walk(node))

    def names(target):
        return {part.id for part in ast.walk(target) if isinstance(part, ast.Name)}

    while True:
        before = len(own)
        for node in ast.walk(tree):
            if isinstance(node, ast.Assign) and is_own(node.value) and not reads(node.value):
                own |= set().union(*map(names, node.targets))
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in functions:
                for argument, given in zip(functions[node.func.id].args.args, node.args):
                    own |= {argument.arg} if is_own(given) else set()
        if len(own) == before:
            break
    return [node.lineno for node in ast.walk(tree) if isinstance(node, ast.Call) and writes(node)
            and any(map(is_own, [node.func, *node.args, *(key.value for key in node.keywords)]))]


def reads(node):
    """Whether an expression is what a call makes of a file, such as a loaded scene, and no longer its place."""
    paths = {"Path", "resolve", "absolute", "with_name", "joinpath", "str"}
    calls = [part.func for part in ast.walk(node) if isinstance(part, ast.Call)]
    return any((call.attr if isinstance(call, ast.Attribute) else getattr(call, "id", "")) not in paths for call in calls
               if not (isinstance(call, ast.Name) and call.id == "len"))


def writes(call):
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    if name == "open":
        return any(isinstance(given, ast.Constant) and str(given.value)[:1] in ("w", "a", "x") for given in call.args[1:])
    return name in WRITERS


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: str(path.relative_to(FOLDER)))
def test_no_script_writes_beside_itself(script):
    assert calls_that_write_beside(script.read_text()) == []


def test_writing_beside_itself_is_noticed():
    head = "import sys\nfrom pathlib import Path\n"
    default = head + ("def draw(figure, folder):\n    figure.savefig(folder / 'a.png')\n"
                      "folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent\ndraw(None, folder)\n")
    assert calls_that_write_beside(default) == [4]
    assert calls_that_write_beside(head + "HERE = Path(__file__).parent\n(HERE / 'a.csv').write_text('')\n") == [4]
    assert calls_that_write_beside(head + "with open(Path(__file__).with_name('a'), 'w') as file:\n    pass\n") == [3]
    assert calls_that_write_beside(head + "text = Path(__file__).with_name('a').read_text()\nPath('b').write_text(text)\n") == []


@pytest.fixture
def build():
    folder = Path(sinew.__file__).resolve().parents[2]
    if not (folder / "bin" / "sinew").exists():
        pytest.skip("needs a build tree with bin/sinew")
    return folder


def test_figures_and_complaints_are_found(build, tmp_path):
    scene = tmp_path / "sag.yaml"
    scene.write_text("sinew: 1\ngravity: 0 0 -9.81 m/s^2\ntime_step: 0.1 s\nintegrator: quasi-static\nduration: 0.3 s\n"
                     "bodies:\n  beam:\n    type: fem\n    mesh: {shape: block, length: 60 mm, width: 10 mm, height: 10 mm, element_size: 5 mm}\n"
                     "    material: {model: neo-hookean, young_modulus: 1 MPa, poisson_ratio: 0.4}\n    density: 1000 kg/m^3\n"
                     "    fixed: [{set: x_min}]\neffectors:\n  tip: {body: beam, point: 60 5 5 mm}\n")  # fmt: skip
    example = examples.Example(str(scene))
    (tmp_path / "run").mkdir()
    ran = examples.run(example, build, tmp_path / "run")
    assert ran.problem == ""
    # The deflection of a beam by its weight, rho g L^4/(8 E I/A), with shear.
    assert examples.last("tip.z", 1e3)(ran) - 5.0 == pytest.approx(-1.9, rel=0.1)
    assert examples.printed(r"^steps +([0-9]+)")(ran) == 3.0
    assert examples.at("time", 0.2)(ran) == pytest.approx(0.2)
    (tmp_path / "other").mkdir()
    broken = examples.run(dataclasses.replace(example, arguments=("--set", "bodies.beam.density=-1 kg/m^3")), build, tmp_path / "other")
    assert "exit code 2" in broken.problem
    script = tmp_path / "warns.py"
    script.write_text("import warnings\nwarnings.warn('no')\n")
    assert "Warning" in examples.run(examples.Example(str(script)), build, tmp_path).problem
    said = "a.py:3: SinewWarning: bodies.a.element: too stiff [locking-element]\n  load()\n"
    assert "locking" in examples.complaint(0, said) and examples.complaint(0, said, ("locking-element",)) == ""
    assert "bare" in examples.complaint(0, said + "sinew: warning: bare points [bare-points]\n", ("locking-element",))
    script.write_text("import time\ntime.sleep(60)\n")
    assert "not finished" in examples.run(examples.Example(str(script), limit=0.3), build, tmp_path).problem


def test_a_changed_example_is_noticed(tmp_path, monkeypatch):
    monkeypatch.setattr(examples, "FOLDER", tmp_path)
    (tmp_path / "a.png").write_bytes(b"1")
    before = examples.source_state()
    assert examples.changed_sources(before) == []
    (tmp_path / "a.png").write_bytes(b"12")
    (tmp_path / "b.csv").write_text("")
    assert examples.changed_sources(before) == ["a.png", "b.csv"]
