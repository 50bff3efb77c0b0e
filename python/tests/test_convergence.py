"""Convergence studies: extrapolation of known sequences, and refined scenes."""

import json
import pathlib
import re

import numpy as np
import pytest
import sinew
from sinew import convergence


def powers(p, sizes=(1.0, 0.7, 0.4), at=np.array([2.0, -1.0, 0.5])):
    """Values that converge to `at` as h^p."""
    return sizes, [at + 0.3 * np.array([1.0, 2.0, -1.0]) * h**p for h in sizes]


@pytest.mark.parametrize("p", [1.1, 1.7, 2.0, 4.0])
def test_richardson_finds_order_and_limit(p):
    sizes, values = powers(p)
    found = convergence._estimate(sizes, values)
    assert found.order == pytest.approx(p, abs=1e-8)  # for uneven size ratios, too
    assert found.extrapolated == pytest.approx([2.0, -1.0, 0.5], abs=1e-8)
    assert found.error == pytest.approx(0.3 * np.sqrt(6.0), rel=1e-7)
    assert found.relative_error == pytest.approx(found.error / np.sqrt(5.25), rel=1e-9)
    assert found.uncertainty == pytest.approx(1.25 * 0.3 * np.sqrt(6.0) * 0.4**p, rel=1e-6)


def test_what_does_not_converge_is_told():
    sizes, values = powers(2.0)
    for wrong in ([values[0], values[1], values[0]], [values[1], values[1] + 1e-3, values[1] + 1.0], powers(0.8)[1]):
        found = convergence._estimate(sizes, wrong)
        assert found.order is None
        assert found.uncertainty == pytest.approx(3.0 * np.linalg.norm(found.extrapolated - wrong[-1]))
    assert convergence._estimate(sizes[1:], values[1:]).order is None  # two meshes give no order


def beam(mesh, element, **more):
    return {"sinew": 1, "gravity": [0.0, 0.0, 0.0], "time_step": 0.01,
            "bodies": {"beam": {"type": "fem", "mesh": mesh, "element": element, "mass": "1 g", "fixed": {"set": "x_min"},
                                "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.3}}},
            "effectors": {"tip": {"body": "beam", "point": [0.04, 0.005, 0.005]}},
            "loads": {"push": {"type": "traction", "body": "beam", "surface": {"set": "x_max"}, "traction": [0.0, 0.0, 20.0]}}, **more}  # fmt: skip


def shape(size):
    return {"shape": "block", "length": 0.04, "width": 0.01, "height": 0.01, "element_size": size}


#: Displacement of the tip of the beam on 12 288 quadratic tetrahedra of 1.25 mm, m; precomputed, because it takes long.
TRUTH = np.array([-3.88156e-06, 0.0, 5.27308e-04])


def test_a_beam_shows_the_order_of_its_elements_and_what_its_mesh_costs():
    study = convergence.study(beam(shape(0.005), "tet10"), static=True)
    assert [level.elements for level in study.levels] == [6 * 8 * 2 * 2, 6 * 16 * 4 * 4, 6 * 24 * 6 * 6]  # even numbers of cells
    found = study["tip.position"]
    assert found.order == pytest.approx(2.0, abs=0.3)
    assert np.linalg.norm(found.extrapolated - TRUTH) < 2e-3 * np.linalg.norm(TRUTH)
    assert found.error == pytest.approx(np.linalg.norm(study.levels[0].values["tip.position"] - TRUTH), rel=0.2)


def test_a_beam_that_locks_shows_a_low_order():
    # With two linear tetrahedra through the height, more than a third of the deflection is missing.
    study = convergence.study(beam(shape(0.005), "tet4"), static=True)
    found, own = study["tip.position"], np.linalg.norm(study.levels[0].values["tip.position"] - TRUTH)
    assert own > 0.35 * np.linalg.norm(TRUTH)
    assert found.order < 1.5  # on meshes that are fine enough: 2
    assert found.error == pytest.approx(own, rel=0.25)
    assert np.linalg.norm(found.extrapolated - TRUTH) < found.uncertainty


@pytest.mark.parametrize("element, numbers", [("tet4", [8, 16, 24]), ("hex8", [8, 12, 16])])
def test_all_directions_are_refined_alike(element, numbers):
    """Tetrahedra have even numbers of cells along each edge: two do not become three."""
    study = convergence.study(beam(shape(0.005), element), static=True)
    cells = [level.elements // (6 if element == "tet4" else 1) for level in study.levels]
    assert cells == [n * (n // 4) ** 2 for n in numbers]


def test_a_mesh_file_is_cut(tmp_path):
    path = tmp_path / "beam.vtu"
    sinew.mesh.block((0.04, 0.01, 0.01), (8, 2, 2)).write(path)
    given = beam({"file": str(path)}, "tet4", duration=0.02)
    study = convergence.study(given, levels=2, measure=["beam.strain_energy", "tip.position"])
    assert [level.elements for level in study.levels] == [192, 8 * 192]
    assert study.levels[1].size == pytest.approx(0.5 * study.levels[0].size)
    assert study["beam.strain_energy"].order is None and study["tip.position"].error > 0.0
    given["bodies"]["beam"].update(mesh={"file": str(hexahedra(tmp_path))}, element="hex8")
    with pytest.raises(sinew.Error, match="unsupported-element"):
        convergence.study(given, levels=2)


def hexahedra(folder):
    import meshio

    at = sinew.load(beam(shape(0.005), "hex8")).body("beam")
    path = folder / "hexahedra.vtu"
    ends = {name: (np.abs(at.rest_positions[:, 0] - x) < 1e-9).astype(np.uint8) for name, x in (("x_min", 0.0), ("x_max", 0.04))}
    meshio.write(path, meshio.Mesh(at.rest_positions, [("hexahedron", at.hexahedra)], point_data=ends))
    return path


def test_what_cannot_be_studied():
    bare = {**beam(shape(0.005), "tet4")}
    with pytest.raises(sinew.Error, match="out-of-range"):
        convergence.study(bare, levels=1)
    del bare["effectors"]
    with pytest.raises(sinew.Error, match="no effectors"):
        convergence.study(bare, static=True)
    with pytest.raises(sinew.Error, match="unknown-name"):
        convergence.study(bare, static=True, measure=["tip.position"])
    arm = {"sinew": 1, "time_step": 0.01, "integrator": "bdf2", "bodies": {"box": {"type": "rigid", "shape": {"box": "10 10 10 mm"}, "mass": "1 g"}}}
    with pytest.raises(sinew.Error, match="no body of finite elements"):
        convergence.study(arm)


@pytest.mark.parametrize("run", [{"static": True}, {"duration": 0.02}])
def test_a_robot_without_load_has_no_error_to_estimate(run):
    still = beam(shape(0.005), "tet4")
    still["loads"] = {}
    for name, word in (("tip.position", "displacement"), ("beam.strain_energy", "value")):
        with pytest.raises(sinew.Error, match=f"{name}: its {word} is zero to rounding on every mesh.*gravity.*bad-argument"):
            convergence.study(still, levels=2, measure=[name], **run)
    study = convergence.study(still, levels=2, measure=["beam.volume"], **run)  # is nonzero without load
    assert study["beam.volume"].extrapolated == pytest.approx(4e-6)


def test_small_motions_are_no_rounding():
    faint = beam(shape(0.005), "tet4")
    faint["loads"]["push"]["traction"] = [0.0, 0.0, 2e-6]  # 1e-7 of the other tests: some 3e-11 m
    study = convergence.study(faint, levels=2, static=True, measure=["tip.position"])
    strong = convergence.study(beam(shape(0.005), "tet4"), levels=2, static=True, measure=["tip.position"])
    assert study["tip.position"].relative_error == pytest.approx(strong["tip.position"].relative_error, rel=0.01)


def test_the_command(tmp_path, capsys):
    path, out = tmp_path / "beam.yaml", tmp_path / "figures.json"
    path.write_text(json.dumps(beam(shape(0.005), "tet4")))
    assert convergence.main([str(path), "--static", "--levels=2", f"--json={out}"]) == 0
    told = capsys.readouterr()
    assert "error of the scene's mesh" in told.out and "mesh 2 of 2" in told.err
    figures = json.loads(out.read_text())
    assert len(figures["levels"]) == 2 and len(figures["estimates"]["tip.position"]["extrapolated"]) == 3
    assert convergence.main([str(path), "--static", "--measure=tip.positon"]) == 2
    assert "did you mean" in capsys.readouterr().err


def test_the_guide(capsys):
    text = (pathlib.Path(__file__).parents[2] / "docs" / "convergence.md").read_text()
    code = re.search(r"```python\n(.*?)```", text, re.DOTALL)[1]
    exec(compile(code, "docs/convergence.md", "exec"), {})
    printed = float(re.search(r"# (0\.\d+), of the scene", code)[1])
    assert float(capsys.readouterr().out) == pytest.approx(printed, abs=0.005)
