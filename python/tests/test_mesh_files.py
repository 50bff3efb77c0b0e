"""Meshes written by Sinew, as read by other programs."""

import numpy as np
import pytest

import sinew

meshio = pytest.importorskip("meshio")


@pytest.mark.parametrize("ending", [".vtu", ".vtk"])
def test_another_reader_finds_the_same_mesh(tmp_path, ending):
    mesh = sinew.mesh.block((0.06, 0.02, 0.02), (6, 2, 2))
    mesh.write(tmp_path / f"block{ending}")
    back = meshio.read(tmp_path / f"block{ending}")
    assert np.array_equal(back.points, mesh.nodes)
    cells = np.vstack([block.data for block in back.cells if block.type == "tetra"])
    assert np.array_equal(cells, mesh.tetrahedra)
    assert np.count_nonzero(back.point_data["x_min"]) == 9


def test_an_stl_is_the_outside_alone(tmp_path):
    mesh = sinew.mesh.block((0.06, 0.02, 0.02), (6, 2, 2))
    mesh.write(tmp_path / "block.stl")
    back = meshio.read(tmp_path / "block.stl")
    assert back.cells_dict.keys() == {"triangle"}
    assert len(back.cells_dict["triangle"]) == 2 * (2 * 2 * 2 + 4 * 6 * 2)
    a, b, c = (back.points[back.cells_dict["triangle"][:, k]].astype(float) for k in range(3))
    assert np.einsum("ij,ij", a, np.cross(b, c)) / 6 == pytest.approx(0.06 * 0.02**2, rel=1e-6)


@pytest.mark.parametrize("name", ["block.msh", "block.obj", "block"])
def test_an_unknown_ending_is_refused(tmp_path, name):
    with pytest.raises(sinew.Error) as caught:
        sinew.mesh.block().write(tmp_path / name)
    assert caught.value.kind == "unknown-format" and ".vtu" in str(caught.value)
    assert not any(tmp_path.iterdir())
