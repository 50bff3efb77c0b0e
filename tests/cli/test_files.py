"""Commands for meshes, surfaces and scenes: sinew mesh, info, convergence.

    SINEW_PROGRAM=build/release/bin/sinew /usr/bin/python3 -m pytest tests/cli
"""

import json
import re
import shutil

import meshio
import numpy as np
import pytest
from program import DONE, ROOT, sinew


def test_shapes_have_the_dimensions_that_are_asked_for(tmp_path):
    made = sinew("mesh", "--shape", "capsule", "--set", "radius=5mm", "--set", "length=2cm", "--size", "2mm", "-o", tmp_path / "c.vtu")
    assert made.returncode == DONE, made.stderr
    facts = json.loads(sinew("info", tmp_path / "c.vtu", "--json").stdout)
    assert facts["volume_m3"] == pytest.approx(np.pi * 0.005**2 * (0.02 + 4.0 / 3.0 * 0.005))


def test_convergence(scene, tmp_path):
    path = scene()
    result = sinew("convergence", path, "--levels", "2", "--json", tmp_path / "figures.json")
    assert result.returncode == DONE, result.stderr
    assert "error of the scene's mesh" in result.stdout
    first, second = json.loads((tmp_path / "figures.json").read_text())["levels"]
    assert first["elements"] == 240 < second["elements"]


def test_a_filled_surface_names_the_unit_of_its_file(tmp_path):
    if shutil.which("gmsh") is None:
        pytest.skip("without Gmsh")
    cube = ROOT / "tests" / "mesh" / "data_surface" / "cube_binary.stl"
    for unit, length in (("m", "1 m"), ("cm", "10 mm")):
        made = sinew("mesh", cube, "--unit", unit, "--size", f"0.05 {unit}", "-o", tmp_path / "cube.vtu")
        assert made.returncode == DONE, made.stderr
        assert f"1 file unit = {length}\n" in made.stdout and f"wrote {tmp_path / 'cube.vtu'}, lengths in m\n" in made.stdout


def test_mesh_and_info(tmp_path):
    made = sinew("mesh", "--shape", "block", "--size", "10mm", "-o", tmp_path / "b.vtu")
    assert made.returncode == DONE, made.stderr
    plain = sinew("info", tmp_path / "b.vtu")
    assert plain.returncode == DONE and "radius ratio" in plain.stdout
    facts = json.loads(sinew("info", tmp_path / "b.vtu", "--json").stdout)
    assert facts["volume_m3"] == pytest.approx(0.1 * 0.02 * 0.02)
    assert facts["nodes"] == 11 * 3 * 3 and facts["tetrahedra"] == 10 * 2 * 2 * 6
    assert sum(facts["radius_ratio"]["histogram"]["counts"]) == facts["tetrahedra"]
    assert facts["defects"] == []
    assert {"x_min", "x_max"} <= {s["name"] for s in facts["sets"]}


def test_info_reports_defects_and_does_not_fail(tmp_path):
    path = tmp_path / "flat.vtk"
    path.write_text("# vtk DataFile Version 3.0\nflat\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                    "POINTS 4 double\n0 0 0 1 0 0 0 1 0 1 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n")
    result = sinew("info", path, "--json")
    assert result.returncode == DONE, result.stderr
    assert [d["kind"] for d in json.loads(result.stdout)["defects"]] == ["zero-volume"]
    assert "zero" in sinew("info", path).stdout


def test_info_of_every_kind(scene, tmp_path):
    path = scene()
    assert sinew("run", path, "--out", tmp_path / "o").returncode == DONE
    run = json.loads(sinew("info", tmp_path / "o" / "run.h5", "--json").stdout)
    assert run["kind"] == "run" and run["frames"] == 11 and run["bodies"] == ["beam"]
    assert json.loads(sinew("info", tmp_path / "o", "--json").stdout) == run  # the folder of a run gives the same
    described = json.loads(sinew("info", path, "--json").stdout)
    assert described["kind"] == "scene" and described["bodies"][0]["mass_kg"] == pytest.approx(0.0428)
    stl = tmp_path / "t.stl"
    stl.write_text("solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                   "endloop\nendfacet\nendsolid t\n")
    surface = json.loads(sinew("info", stl, "--json", "--unit", "mm").stdout)
    assert surface["kind"] == "surface" and surface["closed"] is False and surface["triangles"] == 1
    cube = json.loads(sinew("info", ROOT / "tests" / "mesh" / "data_surface" / "cube_binary.stl", "--json").stdout)
    assert cube["closed"] is True and cube["triangles"] == 12 and "defect" not in cube
    size = cube["size_m"][0]
    assert abs(cube["volume_m3"] / size**3 - 1) < 1e-9
    assert abs(cube["inertia_m5"][1][1] / (size**5 / 6) - 1) < 1e-9 and len(cube["centre_m"]) == 3
    robot = json.loads(sinew("info", ROOT / "examples" / "rigid" / "urdf_arm.yaml", "--json").stdout)
    upper = next(body for body in robot["bodies"] if body["name"] == "arm.upper")
    assert upper["mass_kg"] == 0.5 and upper["closed"] is True and upper["triangles"] == 76
    assert abs(upper["centre_of_mass_m"][2] - 0.093) < 1e-12 and abs(upper["inertia_kg_m2"][0][0] - 0.0022) < 1e-12


def test_info_writes_few_digits(scene):
    path = scene(replace=("effectors:", """  air:
    type: chamber
    body: beam
    surface: {file: cavity.stl, unit: mm}
effectors:"""))
    low, high = np.array([20.0, 5.0, 5.0]), np.array([51.3, 12.7, 14.1])
    corners = [[(low, high)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    meshio.Mesh(np.array(corners), [("triangle", np.array(faces))]).write(path.parent / "cavity.stl")
    told = sinew("info", path)
    assert told.returncode == DONE, told.stderr
    assert "chamber air, 2.193 ml in 96 faces" in told.stdout
    assert not re.search(r"\d{7}", told.stdout)
