"""Shapes, scaled meshes and scaled materials in scenes; meshes created in Python."""

import pathlib

import numpy as np
import pytest
import sinew

BALL = 4.0 / 3.0 * np.pi * 0.01**3
SHAPES = {
    "sphere": ({"shape": "sphere", "radius": "10 mm"}, BALL),
    "capsule": ({"shape": "capsule", "radius": "10 mm", "length": "30 mm"}, BALL + np.pi * 0.01**2 * 0.03),
    "ribbed-finger": ({"shape": "ribbed-finger", "length": "110 mm", "width": "20 mm", "height": "15 mm", "ribs": 4},
                      0.02 * (0.11 * 0.015 - 3 * 0.01 * 0.010)),
}  # fmt: skip
RUBBER = {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.45}


def body(mesh, material=RUBBER, **more):
    return {"type": "fem", "mesh": mesh, "material": material, "mass": "10 g", **more}


def scene(**bodies):
    return {"sinew": 1, "gravity": [0.0, 0.0, 0.0], "time_step": 0.01, "integrator": "bdf2", "bodies": bodies}


@pytest.mark.parametrize("element", ["tet4", "hex8", "tet10"])
@pytest.mark.parametrize("name", SHAPES)
def test_shapes_of_scenes(name, element):
    mesh, volume = SHAPES[name]
    size = {"element_size": "2.5 mm" if name == "sphere" else "4 mm"}
    coarse, fine = (sinew.load(scene(b=body({**mesh, **size}, element=element))).body("b") for size in ({}, size))
    assert coarse.volume == pytest.approx(volume, rel=0.03 if element == "tet10" else 1e-9)
    assert fine.volume == pytest.approx(volume, rel=0.01 if element == "tet10" else 1e-9)
    count = [len(one.hexahedra) + len(one.tetrahedra) for one in (coarse, fine)]
    assert count[1] > count[0] > 0


def test_shapes_of_python():
    assert sinew.mesh.sphere(radius=0.01, rings=4).volume == pytest.approx(BALL)
    assert sinew.mesh.capsule(radius=0.01, length=0.03).volume == pytest.approx(SHAPES["capsule"][1])
    assert sinew.mesh.ribbed_finger((0.11, 0.02, 0.015), spine=0.005, gap=0.01, ribs=4).volume == pytest.approx(SHAPES["ribbed-finger"][1])
    assert "chamber" in sinew.mesh.chambered_cylinder().node_sets
    whole = sinew.mesh.block(cells=(2, 1, 1))
    assert len(whole.refined().tetrahedra) == 8 * len(whole.tetrahedra) and whole.refined().volume == pytest.approx(whole.volume)
    with pytest.raises(sinew.Error, match="out-of-range"):
        sinew.mesh.ribbed_finger(gap=0.02)


def test_a_ball_is_squeezed_alike_from_all_sides():
    # Isotropic pressure on the whole surface: E/(1 - 2 nu) times the strain along any radius.
    mesh, pressure = {"shape": "sphere", "radius": "10 mm", "element_size": "3 mm"}, 10.0
    fixed = [{"sphere": {"centre": [0, 0, 0], "radius": "0.1 mm"}}]
    squeezed = {**scene(b=body(mesh, element="tet10", fixed=fixed)),
                "loads": {"water": {"type": "pressure", "body": "b", "surface": {"set": "surface"}, "pressure": pressure}}}  # fmt: skip
    sim = sinew.load(squeezed)
    sim.solve_static()
    ball = sim.body("b")
    size = np.linalg.norm(ball.rest_positions, axis=1)
    outside = size > 0.00999
    shrunk = 1.0 - np.linalg.norm(ball.positions, axis=1)[outside] / size[outside]
    assert shrunk == pytest.approx(pressure * (1.0 - 2.0 * 0.45) / 100e3, rel=0.02)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "finger.vtu"
    sinew.mesh.ribbed_finger().write(path)
    return str(path)


def test_a_mesh_is_scaled_mirrored_turned_and_moved(file):
    own = sinew.mesh.read(file)
    twice = sinew.load(scene(b=body({"file": file, "scale": 2}))).body("b")
    assert np.array_equal(twice.rest_positions[: len(own.nodes)], 2.0 * own.nodes)
    turned = body({"file": file, "scale": [1, 1, -0.5]}, pose={"position": "10 20 30 mm", "rotation": "0 0 90 deg"})
    turned = sinew.load(scene(b=turned)).body("b")
    x, y, z = own.nodes.T
    assert turned.rest_positions[: len(own.nodes)] == pytest.approx(np.c_[0.01 - y, 0.02 + x, 0.03 - 0.5 * z], abs=1e-15)
    assert turned.volume == pytest.approx(0.5 * own.volume)


def test_a_rigid_mesh_is_scaled(tmp_path):
    path = tmp_path / "ball.stl"
    sinew.mesh.sphere(radius=0.01).write(path)
    rigid = lambda **mesh: {"type": "rigid", "mesh": {"file": str(path), **mesh}, "density": 1000.0}
    sim = sinew.load(scene(one=rigid(unit="m"), other=rigid(unit="m", scale=[1, -2, 3])))
    assert sim.body("other").mass == pytest.approx(6.0 * sim.body("one").mass)


@pytest.mark.parametrize("scale, what", [(0, "out-of-range"), ("1 2", "wrong-length"), ("1 mm", "wrong-dimension")])
def test_scales_that_cannot_be(file, scale, what):
    with pytest.raises(sinew.Error, match=what) as caught:
        sinew.load(scene(b=body({"file": file, "scale": scale})))
    assert "bodies.b.mesh.scale" in str(caught.value)


def test_a_chamber_in_a_file_goes_with_its_body(tmp_path):
    solid, cavity = tmp_path / "block.vtu", tmp_path / "cavity.stl"
    sinew.mesh.block((0.02, 0.02, 0.04), (4, 4, 8), corner=(-0.012, -0.01, -0.005)).write(solid)
    sinew.mesh.cylinder(radius=0.004, height=0.03, rings=1, layers=3).write(cavity)

    def inflated(unit, **more):
        scale = more.pop("scale", 1)
        soft = body({"file": str(solid), "unit": unit, "scale": scale}, element="tet4", fixed={"set": "z_min"}, **more)
        air = {"type": "chamber", "body": "b", "surface": {"file": str(cavity), "unit": unit}, "command": {"pressure": 5e3}}
        sim = sinew.load({**scene(b=soft), "actuators": {"air": air}})
        sim.solve_static()
        return sim.body("b")

    there = inflated("m", pose={"position": "1 2 3 m", "rotation": "0 90 0 deg"})
    here = inflated("m")
    moved = here.positions - here.rest_positions
    # The mean stress of a body is the sum of x times force, here pressure times the volume that the surface encloses (Betti); the mean
    # strain is that over three times the bulk modulus. The clamped end, which cannot widen, adds 5 %.
    free, enclosed, volume = here.rest_positions[:, 2] > 0.0349, np.pi * 0.004**2 * 0.03, 0.02 * 0.02 * 0.04
    stretched = 5e3 * enclosed / volume * (1.0 - 2.0 * 0.45) / 100e3
    assert moved[free, 2].mean() == pytest.approx(0.04 * stretched, rel=0.08)
    x, y, z = moved.T
    assert there.positions - there.rest_positions == pytest.approx(np.c_[z, y, -x], abs=1e-10)
    # Lengths scale; strains do not.
    large = inflated("m", scale=3)
    assert large.positions - large.rest_positions == pytest.approx(3.0 * moved, abs=1e-9)


def test_a_material_is_scaled_and_loosely_spelled(tmp_path):
    pulled = lambda material: {**scene(b=body({"shape": "block", "length": 0.02, "width": 0.01, "height": 0.01}, material, element="hex8",
                                              fixed={"set": "x_min"})),
                               "loads": {"pull": {"type": "traction", "body": "b", "surface": {"set": "x_max"}, "traction": [30e3, 0, 0]}}}  # fmt: skip

    def stretch(material, factor=1.0):
        given = pulled(material)
        given["loads"]["pull"]["traction"][0] *= factor
        sim = sinew.load(given)
        sim.solve_static()
        return sim.body("b").positions

    plain = stretch("dragon-skin-30")
    for spelled in ("Dragon Skin 30", "dragon skin-30", {"name": "DragonSkin 30"}):
        assert np.array_equal(stretch(spelled), plain)
    scaled = {"name": "dragon-skin-30", "scale": 1.5}
    assert stretch(scaled, 1.5) == pytest.approx(plain, abs=1e-9)
    assert np.abs(stretch(scaled) - plain).max() > 1e-4
    law = tmp_path / "law.yaml"
    law.write_text("model: ogden\nmu: 144776.9 Pa\nalpha: 2.71607\nconvention: mu-over-alpha\npoisson_ratio: 0.49\n")
    assert stretch({"file": str(law), "scale": 1.5}, 1.5) == pytest.approx(plain, abs=1e-9)
    # The short form of a material accepts the factor, too.
    sim = sinew.load(pulled("dragon-skin-30"), set=["bodies.b.material.scale=1.5"])
    sim.solve_static()
    assert sim.body("b").positions == pytest.approx(stretch(scaled), abs=1e-12)


@pytest.mark.parametrize(
    "material, what",
    [("dragon skin 31", "did you mean 'dragon-skin-30'"), ({"name": "Dragon Skin 30", "scale": 0}, "scale"),
     ({"name": "dragon-skin-30", "young_modulus": 1e5}, "young_modulus"), ({"scale": 2}, "material")],
)  # fmt: skip
def test_materials_that_cannot_be(material, what):
    with pytest.raises(sinew.Error, match=what):
        sinew.load(scene(b=body({"shape": "block", "length": 0.02, "width": 0.01, "height": 0.01}, material)))


def test_paper_keeps_the_back_of_the_ribbed_finger_from_stretching():
    example = pathlib.Path(__file__).parents[2] / "examples" / "finger" / "ribbed.yaml"

    def back(**change):
        sim = sinew.load(example, set={"time_step": "0.1 s", **change})
        sim.run()
        finger = sim.body("finger")
        middle = np.flatnonzero((np.abs(finger.rest_positions - [0.05, 0.01, 0.0]) < [1.0, 1e-6, 1e-9]).all(axis=1))
        middle = middle[np.argsort(finger.rest_positions[middle, 0])]
        length = np.linalg.norm(np.diff(finger.positions[middle], axis=0), axis=1).sum()
        return length / 0.1 - 1.0, sim.effector("tip").position[2]

    (stretched, height), (soft, _) = back(), back(**{"membranes.paper.young_modulus": "1 kPa"})
    assert 0.0 < stretched < 5e-4 < 0.02 < soft
    assert height > 0.03  # it bends towards its cable
