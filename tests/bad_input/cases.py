"""Invalid inputs of every kind that Sinew reads, with the expected errors.

A case describes how to break a valid input, and the expected error: its kind, its location (`place`),
and words of its message, with the offending value and the remedy (`says`). A place that begins with ":"
is a line and column of the faulty file.
"""

import pathlib
import struct
from dataclasses import dataclass
from typing import Callable, Optional, Sequence, Tuple, Union

SCENE = """sinew: 1
gravity: 0 0 -9.81 m/s^2
time_step: 10 ms
duration: 0.05 s
bodies:
  beam:
    type: fem
    mesh: {shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}
    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}
    density: 1070 kg/m^3
    fixed: [{set: x_min}]
actuators:
  up:
    type: cable
    body: beam
    points: [0 10 16 mm, 30 10 16 mm, 60 10 16 mm, 98 10 16 mm]
    limits: {tension: {min: 0 N, max: 20 N}}
    command: {displacement: 2 mm}
effectors:
  tip: {body: beam, point: 100 10 10 mm}
controllers:
  follow:
    type: inverse
    effectors:
      tip: {target: {circle: {centre: 100 10 15 mm, radius: 2 mm, normal: 1 0 0, period: 1 s}}}
"""

# A tetrahedron on the unit square, in mm.
TETRAHEDRON = """# vtk DataFile Version 3.0
one tetrahedron
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0
100 0 0
0 100 0
0 0 100
CELLS 1 5
4 0 1 2 3
CELL_TYPES 1
10
"""

GMSH = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
1
1 4 2 1 1 1 2 3 4
$EndElements
"""

STL = """solid open
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid open
"""

Edit = Tuple[str, str]


@dataclass(frozen=True)
class Case:
    """One invalid input.

    `scene` edits SCENE (old, new); `files` are written beside it; `line` is a command line with
    {scene}, {out} and {folder} filled in. `call` is a call of the Python package instead.
    """

    name: str
    kind: str
    place: str
    says: Sequence[str]
    scene: Sequence[Edit] = ()
    files: Sequence[Tuple[str, Union[str, bytes]]] = ()
    line: Sequence[str] = ("run", "{scene}", "--out", "{out}", "--quiet")
    call: Optional[Callable[[pathlib.Path], object]] = None
    code: int = 2


def scene(name, kind, place, says, *edits, files=()):
    return Case(name, kind, place, says, scene=edits, files=files)


def mesh(name, kind, place, says, file, text, *edits):
    """Case with a mesh file of this content instead of the block."""
    block = "{shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}"
    return Case(name, kind, place, says, files=((file, text),),
                scene=((block, f"{{file: {file}, unit: mm}}"), *edits))


def table(name, kind, place, says, text):
    """Case with the points of a cable from this table."""
    points = "[0 10 16 mm, 30 10 16 mm, 60 10 16 mm, 98 10 16 mm]"
    return Case(name, kind, place, says, files=(("points.csv", text),),
                scene=((points, "{file: points.csv, unit: mm}"),))


def command(name, kind, place, says, *line, files=(), code=2):
    return Case(name, kind, place, says, files=files, line=line, code=code)


def python(name, kind, place, says, call):
    return Case(name, kind, place, says, call=call)


def vtk(old, new):
    assert old in TETRAHEDRON, old
    return TETRAHEDRON.replace(old, new)


def msh(old, new):
    assert old in GMSH, old
    return GMSH.replace(old, new)


# ---------------------------------------------------------------------------------------- scenes

LAW = "{model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}"
SCENES = [
    scene("yaml-that-never-ends", "syntax-error", "scene.yaml:9:13", [], ("element_size: 10 mm}", "element_size: 10 mm")),
    scene("tab-for-indent", "syntax-error", "scene.yaml:6:1", [], ("  beam:", "\tbeam:")),
    scene("not-utf-8", "bad-encoding", "scene.yaml:1:12", [], ("sinew: 1", "sinew: 1 # \udcff")),
    scene("misspelt-key", "unknown-key", "scene.yaml:3:1", ["time_stp", "time_step"], ("time_step:", "time_stp:")),
    scene("misspelt-nested-key", "unknown-key", "scene.yaml:9:37", ["yung_modulus", "young_modulus"], ("young_modulus", "yung_modulus")),
    scene("key-twice", "duplicate-key", "scene.yaml:5:1", ["duration"], ("duration: 0.05 s", "duration: 0.05 s\nduration: 1 s")),
    scene("no-material", "missing-key", "scene.yaml:7:5", ["material"], ("    material: {model: corotational, young_modulus: 200 kPa, poisson_ratio: 0.4}\n", "")),
    scene("misspelt-silicone", "unknown-choice", "scene.yaml:9:15", ["ecoflex-00-30"], (LAW, "ecoflx-00-30")),
    scene("ogden-without-convention", "missing-key", "scene.yaml:9:15", ["mu-over-alpha"],
          (LAW, "{model: ogden, mu: 24 kPa, alpha: 1.7, poisson_ratio: 0.49}")),
    scene("softer-than-nothing", "invalid-material", "scene.yaml:9:15", ["-2000 Pa"],
          (LAW, "{model: mooney-rivlin, c10: 1 kPa, c01: -2 kPa, poisson_ratio: 0.49}")),
    scene("corotational-hexahedra", "unsupported-element", "scene.yaml:10:15", ["neo-hookean"],
          ("    material:", "    element: hex8\n    material:")),
    scene("no-version", "missing-key", "scene.yaml:1:1", ["sinew"], ("sinew: 1\n", "")),
    scene("version-of-the-future", "unsupported-version", "scene.yaml:1:8", ["99"], ("sinew: 1", "sinew: 99")),
    scene("list-for-a-map", "wrong-type", "scene.yaml:19:12", [], ("effectors:\n  tip: {body: beam, point: 100 10 10 mm}", "effectors: [tip]")),
    scene("misspelt-choice", "unknown-choice", "scene.yaml:14:11", ["cabel", "cable"], ("type: cable", "type: cabel")),
    scene("later-key", "not-in-this-version", "scene.yaml:21:1", ["obstacles"], ("controllers:", "obstacles: {}\ncontrollers:")),
    scene("later-type", "not-in-this-version", "scene.yaml:7:11", ["rod"], ("type: fem", "type: rod")),
    scene("spectral-radius", "out-of-range", "scene.yaml:3:", ["spectral_radius"], ("time_step:", "integrator: {type: generalized-alpha, spectral_radius: 1.5}\ntime_step:")),
    scene("unknown-body", "unknown-name", "scene.yaml:15:11", ["beem", "beam"], ("    body: beam\n    points", "    body: beem\n    points")),
    scene("unknown-effector", "unknown-name", "scene.yaml:25:7", ["tpi", "tip"], ("      tip: {target", "      tpi: {target")),
    scene("mass-and-density", "conflicting-keys", "scene.yaml:10:5", ["density"], ("    density: 1070 kg/m^3", "    density: 1070 kg/m^3\n    mass: 40 g")),
    scene("nothing-in-fixed", "empty-list", "scene.yaml:11:12", [], ("[{set: x_min}]", "[]")),
    scene("millimetres-of-time", "wrong-dimension", "scene.yaml:3:12", ["10 mm"], ("time_step: 10 ms", "time_step: 10 mm")),
    scene("pascal-seconds", "wrong-dimension", "scene.yaml:9:52", ["200 kPa s"], ("young_modulus: 200 kPa", "young_modulus: 200 kPa s")),
    scene("unit-that-is-none", "unknown-unit", "scene.yaml:8:85", ["furlong"], ("element_size: 10 mm", "element_size: 10 furlong")),
    scene("word-for-a-number", "not-a-number", "scene.yaml:9:76", ["soft"], ("poisson_ratio: 0.4", "poisson_ratio: soft")),
    scene("infinite-step", "not-finite", "scene.yaml:3:12", ["inf"], ("time_step: 10 ms", "time_step: .inf")),
    scene("step-of-zero", "out-of-range", "scene.yaml:3:12", ["0"], ("time_step: 10 ms", "time_step: 0 s")),
    scene("poisson-ratio-of-a-half", "invalid-material", "scene.yaml:9:76", ["0.5"], ("poisson_ratio: 0.4", "poisson_ratio: 0.5")),
    scene("negative-stiffness", "invalid-material", "scene.yaml:9:52", ["-200"], ("young_modulus: 200 kPa", "young_modulus: -200 kPa")),
    scene("limits-crossed", "contradictory-limits", "scene.yaml:17:40", ["20"], ("{min: 0 N, max: 20 N}", "{min: 30 N, max: 20 N}")),
    scene("two-coordinates", "wrong-length", "scene.yaml:20:28", [], ("point: 100 10 10 mm", "point: 100 10 mm")),
    scene("ramp-of-no-time", "out-of-range", "scene.yaml:18:81", ["0 s"], ("command: {displacement: 2 mm}", "command: {displacement: {ramp: {from: 0 mm, to: 1 mm, start: 0 s, duration: 0 s}}}")),
    scene("time-runs-back", "non-monotonic-time", "scene.yaml:18:37", [], ("command: {displacement: 2 mm}", "command: {displacement: {steps: [[0 s, 0 mm], [2 s, 1 mm], [1 s, 2 mm]]}}")),
    scene("mesh-not-there", "file-not-found", "scene.yaml:8:18", ["arm.vtk"], ("{shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}", "{file: arm.vtk, unit: mm}")),
    scene("mesh-is-a-folder", "file-unreadable", "scene.yaml:8:18", ["beams.vtk"], ("{shape: block, length: 100 mm, width: 20 mm, height: 20 mm, element_size: 10 mm}", "{file: beams.vtk, unit: mm}"), files=(("beams.vtk/note", "x"),)),
    scene("too-many-elements", "out-of-range", "scene.yaml:8:11", ["100000"], ("element_size: 10 mm", "element_size: 1 um")),
    scene("set-not-there", "unknown-set", "scene.yaml:11:19", ["x_mim", "x_min"], ("set: x_min", "set: x_mim")),
    scene("box-beside-the-body", "empty-region", "scene.yaml:11:19", [], ("{set: x_min}", "{box: 1 1 1 2 2 2 m}")),
    scene("box-round-the-body", "everything-fixed", "scene.yaml:6:3", [], ("{set: x_min}", "{box: -1 -1 -1 2 2 2 m}")),
    scene("held-by-nothing", "nothing-fixed", "scene.yaml:6:3", [], ("    fixed: [{set: x_min}]\n", "")),
    scene("no-mass-in-dynamics", "missing-mass", "scene.yaml:7:3", [], ("time_step:", "integrator: backward-euler\ntime_step:"), ("    density: 1070 kg/m^3\n", "")),
    scene("cable-of-one-point", "wrong-length", "scene.yaml:16:13", ["1"], ("[0 10 16 mm, 30 10 16 mm, 60 10 16 mm, 98 10 16 mm]", "[0 10 16 mm]")),
    scene("cable-without-length", "degenerate-cable", "scene.yaml:16:39", [], ("30 10 16 mm, 60 10 16 mm", "30 10 16 mm, 30 10 16 mm")),
    scene("cable-beside-the-body", "point-outside-mesh", "scene.yaml:16:39", ["0.016 m"], ("60 10 16 mm", "60 10 36 mm")),
    scene("effector-in-the-air", "point-outside-mesh", "scene.yaml:20:3", [], ("point: 100 10 10 mm", "point: 300 10 10 mm")),
    scene("orientation-of-a-line", "degenerate-orientation", "scene.yaml:20:34", [], ("{body: beam, point: 100 10 10 mm}", "{body: beam, orientation: [100 2 10 mm, 100 10 10 mm, 100 18 10 mm]}"), ("controllers:\n  follow:\n    type: inverse\n    effectors:\n      tip: {target: {circle: {centre: 100 10 15 mm, radius: 2 mm, normal: 1 0 0, period: 1 s}}}\n", "")),
    scene("controller-without-effectors", "empty-list", "scene.yaml:24:16", [], ("    effectors:\n      tip: {target: {circle: {centre: 100 10 15 mm, radius: 2 mm, normal: 1 0 0, period: 1 s}}}", "    effectors: {}")),
    scene("force-command-of-a-cable", "unknown-key", "scene.yaml:18:15", ["force"], ("{displacement: 2 mm}", "{force: 2 N}")),
    scene("controller-without-actuators", "no-actuators", "scene.yaml:15:3", [], ("actuators:\n  up:\n    type: cable\n    body: beam\n    points: [0 10 16 mm, 30 10 16 mm, 60 10 16 mm, 98 10 16 mm]\n    limits: {tension: {min: 0 N, max: 20 N}}\n    command: {displacement: 2 mm}\n", "")),
]

# ---------------------------------------------------------------------------- meshes and surfaces

FIXED = ("[{set: x_min}]", "[{box: -1 -1 -1 200 200 1 mm}]")
MESHES = [
    mesh("empty-mesh", "truncated-file", "m.vtk", [], "m.vtk", ""),
    mesh("not-a-mesh", "unknown-format", "m.vtk", [], "m.vtk", "a poem\nof two lines\n"),
    mesh("unknown-extension", "unknown-format", "m.xyz", [".xyz"], "m.xyz", "0 0 0\n"),
    mesh("vtk-cut-short", "truncated-file", "m.vtk:5", [], "m.vtk", TETRAHEDRON[:110]),
    mesh("vtk-count-too-large", "size-limit", "m.vtk:5", [], "m.vtk", vtk("POINTS 4", "POINTS 4000000000")),
    mesh("vtk-letters-for-a-number", "malformed-file", "m.vtk:7", ["hundred"], "m.vtk", vtk("100 0 0", "hundred 0 0")),
    mesh("vtk-index-beyond-nodes", "index-out-of-range", "m.vtk", ["7"], "m.vtk", vtk("4 0 1 2 3", "4 0 1 2 7")),
    mesh("vtk-node-twice-in-element", "repeated-node-in-element", "m.vtk", [], "m.vtk", vtk("4 0 1 2 3", "4 0 1 2 2")),
    mesh("vtk-flat-element", "zero-volume", "m.vtk", [], "m.vtk", vtk("0 0 100", "100 100 0")),
    mesh("vtk-node-twice", "duplicate-node", "m.vtk", [], "m.vtk", TETRAHEDRON.replace("POINTS 4", "POINTS 5").replace("0 0 100\n", "0 0 100\n0 0 100\n").replace("CELLS 1 5\n4 0 1 2 3", "CELLS 2 10\n4 0 1 2 3\n4 0 2 1 4").replace("CELL_TYPES 1\n10", "CELL_TYPES 2\n10\n10")),
    mesh("vtk-node-is-nan", "non-finite-node", "m.vtk", [], "m.vtk", vtk("0 0 100", "0 0 nan")),
    mesh("vtk-only-triangles", "no-volume-elements", "m.vtk", [], "m.vtk", vtk("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10", "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5")),
    mesh("vtk-polyhedra", "unsupported-element", "m.vtk", ["42"], "m.vtk", vtk("CELL_TYPES 1\n10", "CELL_TYPES 1\n42")),
    mesh("two-parts", "disconnected-mesh", "m.vtk", ["2"], "m.vtk", TETRAHEDRON.replace("POINTS 4", "POINTS 8").replace("0 0 100\n", "0 0 100\n500 0 0\n600 0 0\n500 100 0\n500 0 100\n").replace("CELLS 1 5\n4 0 1 2 3", "CELLS 2 10\n4 0 1 2 3\n4 4 5 6 7").replace("CELL_TYPES 1\n10", "CELL_TYPES 2\n10\n10"), FIXED),
    mesh("a-hundred-metres-tall", "suspicious-unit", "m.vtk", ["unit: mm"], "m.vtk", TETRAHEDRON, ("{file: m.vtk, unit: mm}", "{file: m.vtk}")),
    mesh("vtu-broken-tags", "malformed-file", "m.vtu:1", [], "m.vtu", "<VTKFile type='UnstructuredGrid'><UnstructuredGrid></VTKFile>"),
    mesh("vtu-of-images", "unknown-format", "m.vtu:1", ["ImageData"], "m.vtu", "<VTKFile type='ImageData' version='1.0' byte_order='LittleEndian'/>"),
    mesh("gmsh-version-3", "unsupported-version", "m.msh:2", ["3"], "m.msh", msh("2.2 0 8", "3.0 0 8")),
    mesh("gmsh-element-without-nodes", "index-out-of-range", "m.msh:13", ["9"], "m.msh", msh("1 4 2 1 1 1 2 3 4", "1 4 2 1 1 1 2 3 9")),
    mesh("gmsh-cut-short", "truncated-file", "m.msh:11", [], "m.msh", GMSH[:90]),
    mesh("gmsh-of-second-order", "unsupported-element", "m.msh", ["quadratic hexahedron"], "m.msh", msh("1 4 2 1 1 1 2 3 4", "1 12 2 1 1 " + "1 2 3 " * 9)),
    mesh("stl-for-a-body", "no-volume-elements", "m.stl", [], "m.stl", STL),
    command("surface-with-a-hole", "surface-not-closed", "open.stl", ["open"], "mesh", "{folder}/open.stl", "-o", "{out}/x.vtu", "--size", "1mm", files=(("open.stl", STL),)),
    command("surface-cut-short", "malformed-file", "cut.stl", [], "mesh", "{folder}/cut.stl", "-o", "{out}/x.vtu", "--size", "1mm", files=(("cut.stl", struct.pack("<80sI", b"binary", 1000) + bytes(100)),)),
]

# -------------------------------------------------------------------------------------- CSV tables

TABLES = [
    table("table-of-two-columns", "wrong-columns", "points.csv:1:4", ["2"], "0,10\n98,10\n"),
    table("table-with-a-word", "malformed-table", "points.csv:2:1", ["left"], "0,10,16\nleft,10,16\n"),
    table("table-with-a-short-row", "wrong-columns", "points.csv:2:5", [], "0,10,16\n30,10\n98,10,16\n"),
    table("empty-table", "malformed-table", "points.csv", [], ""),
    table("table-with-nan", "not-finite", "points.csv:2:1", ["nan"], "0,10,16\nnan,10,16\n"),
    table("table-of-noise", "bad-encoding", "points.csv", [], b"\x00\x01\xfe\xff\x00"),
    table("table-beside-the-body", "point-outside-mesh", "points.csv", [], "0,10,16\n30,10,16\n98,10,61\n"),
    Case("signal-runs-back", "non-monotonic-time", "pull.csv", [], files=(("pull.csv", "0,0\n2,1\n1,2\n"),), scene=(("{displacement: 2 mm}", "{displacement: {file: pull.csv, unit: mm}}"),)),
    Case("trajectory-of-three-columns", "wrong-columns", "way.csv", ["3"], files=(("way.csv", "0,0,0\n1,0,0\n"),), scene=(("{circle: {centre: 100 10 15 mm, radius: 2 mm, normal: 1 0 0, period: 1 s}}", "{file: way.csv, unit: mm}"),)),
]

# ------------------------------------------------------------------------------------ command lines

COMMANDS = [
    command("no-such-option", "unknown-option", "--wings", ["--wings"], "run", "{scene}", "--wings"),
    command("no-such-command", "unknown-option", "sinew", ["fly"], "fly"),
    command("no-scene", "bad-argument", "run", ["SCENE"], "run"),
    command("scene-not-there", "file-not-found", "nothing.yaml", ["nothing.yaml"], "run", "{folder}/nothing.yaml"),
    command("mesh-for-a-scene", "wrong-type", "m.vtk:2:1", [], "run", "{folder}/m.vtk", files=(("m.vtk", TETRAHEDRON),)),
    command("set-without-value", "bad-argument", "--set", ["time_step"], "run", "{scene}", "--out", "{out}", "--set", "time_step"),
    command("set-of-unknown-key", "unknown-key", "--set: time_stp:", ["time_stp"], "run", "{scene}", "--out", "{out}", "--set", "time_stp=1 s"),
    command("set-of-unknown-actuator", "unknown-name", "--set: actuators.upp.command.displacement:", ["upp", "up"], "run", "{scene}", "--out", "{out}", "--set", "actuators.upp.command.displacement=1mm"),
    command("set-of-wrong-dimension", "wrong-dimension", "--set: actuators.up.command.displacement:", ["1 N"], "run", "{scene}", "--out", "{out}", "--set", "actuators.up.command.displacement=1 N"),
    command("duration-in-metres", "wrong-dimension", "--duration", ["3 m"], "run", "{scene}", "--out", "{out}", "--duration", "3 m"),
    command("duration-backwards", "out-of-range", "--duration", ["-1"], "run", "{scene}", "--out", "{out}", "--duration=-1s"),
    command("duration-of-ages", "out-of-range", "duration", [], "run", "{scene}", "--out", "{out}", "--duration", "1e12 s"),
    command("no-threads", "out-of-range", "--threads", ["0"], "bench", "{scene}", "--threads", "0"),
    command("steps-in-words", "bad-argument", "--steps", ["many"], "bench", "{scene}", "--steps", "many"),
    command("unknown-controller", "unknown-name", "--controller", ["folow", "follow"], "run", "{scene}", "--out", "{out}", "--controller", "folow"),
    command("out-is-a-file", "file-unwritable", "taken", ["taken"], "run", "{scene}", "--out", "{folder}/taken", "--quiet", files=(("taken", "x"),)),
    command("json-into-nowhere", "file-unwritable", "nowhere/b.json", ["nowhere"], "bench", "{scene}", "--steps", "1", "--warm-up", "0", "--json", "{folder}/nowhere/b.json"),
    command("info-of-nothing", "file-not-found", "gone.vtk", ["gone.vtk"], "info", "{folder}/gone.vtk"),
    command("info-of-a-picture", "unknown-format", "p.png", ["p.png"], "info", "{folder}/p.png", files=(("p.png", b"\x89PNG\r\n\x1a\n" + bytes(64)),)),
    command("unit-of-time-for-a-mesh", "wrong-dimension", "--unit", ["s"], "info", "{folder}/m.vtk", "--unit", "s", files=(("m.vtk", TETRAHEDRON),)),
    command("no-such-shape", "unknown-choice", "--shape", ["banana"], "mesh", "--shape", "banana", "-o", "{out}/x.vtu"),
    command("gmsh-not-there", "tool-missing", "no-such-gmsh", ["no-such-gmsh"], "mesh", "{folder}/cube.stl", "-o", "{out}/x.vtu", "--size", "5mm", "--gmsh", "no-such-gmsh", files=(("cube.stl", "CUBE"),)),
    command("gmsh-that-fails", "tool-failed", "cube.stl", ["code 1"], "mesh", "{folder}/cube.stl", "-o", "{out}/x.vtu", "--size", "5mm", "--gmsh", "/bin/false", files=(("cube.stl", "CUBE"),), code=1),
    command("no-such-case", "unknown-name", "CASE", ["astrology"], "validate", "astrology"),
    command("run-cut-short", "unknown-format", "run.h5", [], "info", "{folder}/run.h5", files=(("run.h5", b"\x89HDF\r\n\x1a\n" + bytes(100)),)),
    command("a-run-that-cannot-go-on", "not-converged", "step 1 (t = 0.01 s), body beam", ["beam"], "run", "{scene}", "--out", "{out}", "--quiet", "--set", "gravity=0 0 -90000 m/s^2", "--set", "bodies.beam.material.young_modulus=1 Pa", code=1),
]


def sound(folder):
    """A simulation of SCENE."""
    import sinew

    path = folder / "scene.yaml"
    path.write_text(SCENE, encoding="utf-8")
    return sinew.load(path)


def damaged_state(folder, damage):
    sim = sound(folder)
    path = folder / "saved.state"
    sim.save_state(path)
    path.write_bytes(damage(path.read_bytes()))
    sim.load_state(path)


def other_robot(folder):
    import sinew

    sim = sound(folder)
    sim.save_state(folder / "saved.state")
    other = sinew.load(folder / "scene.yaml", set={"time_step": "5 ms"})
    other.load_state(folder / "saved.state")


def controller(folder, **settings):
    import sinew

    return sinew.InverseController(detached(folder), **{"targets": {"tip": [0.1, 0.01, 0.01]}, **settings})


def detached(folder):
    sim = sound(folder)
    sim.detach()
    return sim


PYTHON = [
    python("name-of-no-actuator", "unknown-name", "actuator", ["upp", "up"], lambda f: sound(f).actuator("upp")),
    python("command-while-controlled", "actuator-owned", "up", ["detach"], lambda f: setattr(sound(f).actuator("up"), "tension", 1.0)),
    python("force-of-a-cable", "wrong-actuator-type", "up", ["tension"], lambda f: setattr(detached(f).actuator("up"), "force", 1.0)),
    python("tension-is-nan", "not-finite", "up", ["nan"], lambda f: setattr(detached(f).actuator("up"), "tension", float("nan"))),
    python("push-by-a-cable", "out-of-range", "up", ["-1"], lambda f: setattr(detached(f).actuator("up"), "tension", -1.0)),
    python("tension-in-words", "wrong-type", "up", ["2 N"], lambda f: setattr(detached(f).actuator("up"), "tension", "2 N")),
    python("steps-backwards", "out-of-range", "step", ["-3"], lambda f: sound(f).step(-3)),
    python("forces-of-too-few-nodes", "wrong-shape", "external_forces", ["(4, 3)"], lambda f: setattr(sound(f).body("beam"), "external_forces", [[0, 0, 0]] * 4)),
    python("target-in-the-plane", "wrong-shape", "tip", ["(2,)"], lambda f: controller(f, targets={"tip": [0.1, 0.0]})),
    python("controller-of-nothing", "no-effectors", "controller", [], lambda f: controller(f, targets={})),
    python("two-controllers", "actuator-owned", "InverseController", [], lambda f: __import__("sinew").InverseController(sound(f), targets={"tip": [0.1, 0.01, 0.01]})),
    python("state-of-another-robot", "state-mismatch", "saved.state", [], other_robot),
    python("state-of-another-version", "state-version", "saved.state", [], lambda f: damaged_state(f, lambda b: b[:8] + b"\x63\0\0\0" + b[12:])),
    python("state-cut-short", "state-corrupt", "saved.state", [], lambda f: damaged_state(f, lambda b: b[:-9])),
    python("state-with-a-flipped-bit", "state-corrupt", "saved.state", [], lambda f: damaged_state(f, lambda b: b[:200] + bytes([b[200] ^ 4]) + b[201:])),
    python("state-that-is-none", "state-corrupt", "saved.state", [], lambda f: damaged_state(f, lambda b: b"hello")),
    python("circle-without-radius", "out-of-range", "Circle", ["0"], lambda f: __import__("sinew").Circle([0, 0, 0], 0.0, period=1.0)),
]

CASES = SCENES + MESHES + TABLES + COMMANDS + PYTHON
