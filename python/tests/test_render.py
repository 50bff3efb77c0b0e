"""Pictures and videos: positions, colours and number of drawn objects and frames."""

import math
import os
import re
import shutil
import stat
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import sinew
from sinew.render import Camera, Recording, Renderer, colours
from sinew.render.geometry import Skin, boundary_of
from sinew.render.moment import moment_of
from sinew.render.scene import outline_of

pytest.importorskip("moderngl")
h5py = pytest.importorskip("h5py")
Image = pytest.importorskip("PIL.Image")

ROOT = Path(__file__).resolve().parents[2]
SCENES = sorted((ROOT / "examples").rglob("*.yaml"))
SIZE, LARGE = (160, 120), (640, 480)
BACKGROUND = np.array([255, 255, 255])
PLAIN = {"background": "#ffffff", "floor": False, "lighting": False}
FIRST, SECOND = np.array([0xD9, 0xA0, 0x66]), np.array([0x7F, 0xA6, 0xC9])  # colours of bodies, in their order
ALONG_Y = Camera((0.0, -0.4, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.5)


def rigid(shape, **more):
    """A fixed body."""
    return {"type": "rigid", "shape": shape, "fixed": True, **more}


def scene(bodies, **more):
    """A simulation of bodies."""
    return sinew.load({"sinew": 1, "time_step": "10 ms", "integrator": "backward-euler", "bodies": bodies, **more})


def block(**more):
    """A deformable block that stands on its end."""
    return {"type": "fem", "mesh": {"shape": "block", "length": "20 mm", "width": "20 mm", "height": "60 mm", "element_size": "10 mm"},
            "material": {"young_modulus": "100 kPa", "poisson_ratio": 0.4}, "density": "1000 kg/m^3", "fixed": {"set": "z_min"}, **more}


def projected(camera, point, size=SIZE):
    """Column and row (floats) of a point by the pinhole model, independent of the renderer."""
    eye, target = np.array(camera.position), np.array(camera.target)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    upward = np.cross(right, forward)
    ray = np.asarray(point) - eye
    scale = size[1] / 2 / math.tan(camera.field_of_view / 2) / (ray @ forward)
    return size[0] / 2 + scale * (ray @ right), size[1] / 2 - scale * (ray @ upward)


def pixel(picture, camera, point):
    """Colour of the pixel in which a point is seen."""
    column, row = projected(camera, point, picture.shape[1::-1])
    return picture[int(row), int(column)].astype(int)


def covered(picture, background=BACKGROUND):
    """Pixels in which something is drawn."""
    return np.any(picture != background, axis=2)


# Positions


def test_a_picture_is_an_array_of_the_size_that_was_asked_for():
    picture = sinew.render(scene({"box": rigid({"box": "40 40 40 mm"})}), size=(123, 77))
    assert picture.shape == (77, 123, 3) and picture.dtype == np.uint8 and picture.flags.c_contiguous and picture.flags.writeable


def test_a_body_covers_where_it_is_and_the_rest_is_background():
    # The nearest face is a rectangle in the picture; all other parts lie within it, because they are farther away.
    sim = scene({"box": rigid({"box": "60 40 20 mm"}, pose={"position": "10 0 -5 mm"})})
    picture = sinew.render(sim, SIZE, ALONG_Y, **PLAIN)
    left, top = projected(ALONG_Y, [-0.02, -0.02, 0.005])
    right, bottom = projected(ALONG_Y, [0.04, -0.02, -0.015])
    rows, columns = np.mgrid[0 : SIZE[1], 0 : SIZE[0]] + 0.5
    inside = (columns > left + 1) & (columns < right - 1) & (rows > top + 1) & (rows < bottom - 1)
    outside = (columns < left - 1) | (columns > right + 1) | (rows < top - 1) | (rows > bottom + 1)
    assert inside.sum() > 300 and (picture[inside] == FIRST).all() and (picture[outside] == BACKGROUND).all()


def test_the_outline_of_a_ball_has_the_area_of_its_cone():
    sim = scene({"ball": rigid({"sphere": {"radius": "30 mm"}})})
    picture = sinew.render(sim, (320, 240), ALONG_Y, **PLAIN)
    focal = 120 / math.tan(0.25)
    radius = focal * 0.03 / math.sqrt(0.4**2 - 0.03**2)
    assert covered(picture).sum() == pytest.approx(math.pi * radius**2, rel=0.04)
    rows, columns = np.nonzero(covered(picture))
    assert rows.mean() + 0.5 == pytest.approx(120, abs=0.3) and columns.mean() + 0.5 == pytest.approx(160, abs=0.3)


def test_edges_are_smooth():
    sim = scene({"box": rigid({"box": "40 40 40 mm"}, pose={"rotation": {"axis": "y", "angle": "20 deg"}})})
    picture = sinew.render(sim, SIZE, ALONG_Y, **PLAIN)
    colours_seen = np.unique(picture.reshape(-1, 3), axis=0)
    assert len(colours_seen) > 3  # body, background, and blends of both


def test_a_body_that_moves_moves_on_the_picture():
    motion = {"x": {"ramp": {"to": "30 mm", "duration": "0.1 s"}}}
    sim = scene({"box": {"type": "rigid", "shape": {"box": "20 20 20 mm"}, "motion": motion}})
    renderer = Renderer(sim, SIZE, ALONG_Y, **PLAIN)
    before = covered(renderer.frame())
    sim.step(10)
    after = covered(renderer.frame())
    shift = np.nonzero(after)[1].mean() - np.nonzero(before)[1].mean()
    # The shift lies between that of the near face and that of the far one.
    near, far = (projected(ALONG_Y, [0.03, y, 0])[0] - projected(ALONG_Y, [0, y, 0])[0] for y in (-0.01, 0.01))
    assert far - 0.7 < shift < near + 0.7


def test_what_is_near_hides_what_is_far_whatever_the_order():
    for y in (-50, 50):
        sim = scene({"one": rigid({"box": "40 10 40 mm"}, pose={"position": f"0 {y} 0 mm"}), "two": rigid({"box": "40 10 40 mm"})})
        picture = sinew.render(sim, SIZE, ALONG_Y, **PLAIN)
        assert (pixel(picture, ALONG_Y, [0.0, 0.0, 0.0]) == (FIRST if y < 0 else SECOND)).all()


def test_a_deformed_body_is_drawn_where_its_nodes_are():
    sim = scene({"block": block()}, gravity="6 0 0 m/s^2", integrator="quasi-static")
    sim.solve_static()
    body = sim.body("block")
    camera = Camera((0.01, -0.4, 0.03), (0.01, 0.01, 0.03))
    picture = sinew.render(sim, SIZE, camera, **PLAIN)
    triangles, _ = boundary_of(body)
    middles = np.asarray(body.positions)[triangles].mean(axis=1)
    near = middles[middles[:, 1] < 1e-4]
    assert len(near) > 10 and np.ptp(np.asarray(body.positions) - body.rest_positions) > 1e-3
    for middle in near:
        assert (pixel(picture, camera, middle) == FIRST).all()


# Surfaces


@pytest.mark.parametrize("element", ["tet4", "tet10", "hex8"])
def test_the_surface_of_every_element_encloses_the_body(element):
    sim = scene({"block": block(element=element, material="dragon-skin-10")})
    body = sim.body("block")
    triangles, edges = boundary_of(body)
    a, b, c = (np.asarray(body.rest_positions)[triangles[:, k]] for k in range(3))
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(body.volume, rel=1e-9)  # closed and oriented outwards
    assert len(np.unique(np.sort(triangles, axis=1), axis=0)) == len(triangles)
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert {tuple(edge) for edge in edges} <= {tuple(side) for side in sides}
    picture = sinew.render(sim, SIZE, "front", **PLAIN)
    assert 0.05 < covered(picture).mean() < 0.6


@pytest.mark.parametrize("shape", [{"box": "40 30 20 mm"}, {"sphere": {"radius": "20 mm"}},
                                   {"capsule": {"radius": "10 mm", "length": "30 mm"}}, {"cylinder": {"radius": "15 mm", "height": "40 mm"}}], ids=lambda shape: next(iter(shape)))
def test_rigid_shapes(shape):
    picture = sinew.render(scene({"one": rigid(shape)}), SIZE, **PLAIN)
    assert 0.1 < covered(picture).mean() < 0.8 and (picture[SIZE[1] // 2, SIZE[0] // 2] == FIRST).all()


def test_a_rigid_body_from_a_file():
    sim = scene({"part": {"type": "rigid", "mesh": {"file": str(ROOT / "examples/rigid/meshes/forearm.stl"), "unit": "mm"}, "fixed": True}})
    body = sim.body("part")
    triangles, _ = boundary_of(body)
    a, b, c = (np.asarray(body.rest_positions)[triangles[:, k]] for k in range(3))
    assert len(triangles) > 10 and np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0.0
    assert covered(sinew.render(sim, SIZE, **PLAIN)).mean() > 0.05


def test_an_arm_is_a_tube_along_its_axis():
    sim = sinew.load(ROOT / "examples/fluidic_arm/arm.yaml")
    sim.run(0.5)
    body = sim.body("arm")
    camera = Camera((0.0, -2.0, -0.25), (0.0, 0.0, -0.25))
    picture = sinew.render(sim, SIZE, camera, effectors=False, **PLAIN)
    for end in [np.zeros(3) - [0, 0, 0.01], *body.arm.endpoints(body.coordinates)[:-1]]:
        assert (pixel(picture, camera, end) == FIRST).all()


def test_normals_of_a_ball_point_outward_and_a_box_keeps_its_edges():
    ball, box = scene({"a": rigid({"sphere": {"radius": "20 mm"}})}).body("a"), scene({"a": rigid({"box": "1 2 3 mm"})}).body("a")
    skin = Skin(*boundary_of(ball), ball.rest_positions)
    points, normals = skin.shape(ball.positions)
    assert np.einsum("ij,ij->i", normals, points / np.linalg.norm(points, axis=1)[:, None]).min() > 0.98
    assert len(skin.nodes) == len(np.unique(skin.nodes))  # no creases
    skin = Skin(*boundary_of(box), box.rest_positions)
    _, normals = skin.shape(box.positions)
    assert len(skin.nodes) == 24 and np.abs(np.sort(np.abs(normals), axis=1) - [0.0, 0.0, 1.0]).max() < 1e-6


@pytest.mark.parametrize("path", SCENES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_example(path):
    sim = sinew.load(path)
    sim.step(3)
    picture = sinew.render(sim, SIZE, background="#ffffff", floor=False, contacts=False)
    assert 0.01 < covered(picture).mean() < 0.8
    # The whole body is in the picture.
    assert not covered(picture)[[0, -1]].any() and not covered(picture)[:, [0, -1]].any()


# Colours


def lifted(field_range=(0.0, 0.02), **more):
    """A box that is displaced by 10 mm, coloured by its displacement."""
    motion = {"z": {"ramp": {"to": "10 mm", "duration": "0.1 s"}}}
    sim = scene({"box": {"type": "rigid", "shape": {"box": "40 40 40 mm"}, "motion": motion}})
    sim.step(10)
    return sinew.render(sim, SIZE, ALONG_Y, field="displacement", field_range=field_range, **{**PLAIN, "colour_bar": False, **more})


@pytest.mark.parametrize("field_range,expected", [((0.0, 0.02), (33, 144, 141)), ((0.0, 0.01), (253, 231, 37)), ((0.01, 0.02), (68, 1, 84)),
                                                  ((0.02, 0.03), (68, 1, 84)), ((0.0, 0.04), (59, 81, 139))])
def test_the_colour_of_a_value_is_that_of_the_map(field_range, expected):
    assert np.abs(pixel(lifted(field_range), ALONG_Y, [0, -0.02, 0.01]) - expected).max() <= 2


def test_another_colour_map():
    assert np.abs(pixel(lifted(colour_map="cividis"), ALONG_Y, [0, -0.02, 0.01]) - [112, 113, 115]).max() <= 2


def test_a_field_of_elements_and_a_body_without_it():
    soft = {"young_modulus": "20 kPa", "poisson_ratio": 0.3}
    sim = scene({"block": block(material=soft), "box": rigid({"box": "10 10 10 mm"}, pose={"position": "60 10 5 mm"})},
                gravity="0 0 9.81 m/s^2", integrator="quasi-static")
    sim.solve_static()
    body = sim.body("block")
    stretch = body.nodal_field("max_stretch")
    low, high = float(stretch.min()), float(stretch.max())
    camera = Camera((0.03, -0.4, 0.03), (0.03, 0.01, 0.03))
    picture = sinew.render(sim, SIZE, camera, field="max_stretch", colour_bar=False, **PLAIN)
    triangles, _ = boundary_of(body)
    face = triangles[np.asarray(body.rest_positions)[triangles][:, :, 1].max(axis=1) < 1e-9]
    for nodes in face:
        value = (stretch[nodes].mean() - low) / (high - low)
        expected = np.array([np.interp(255 * value, np.arange(256), colours.table("viridis")[:, c]) for c in range(3)])
        assert np.abs(pixel(picture, camera, np.asarray(body.positions)[nodes].mean(axis=0)) - expected).max() < 12
    assert (pixel(picture, camera, [0.06, 0.005, 0.005]) == [0xB4, 0xBA, 0xC2]).all()


def test_the_bar_tells_field_unit_and_ends():
    assert colours.ticks(0.0, 0.02, "m") == ["20.0 mm", "15.0 mm", "10.0 mm", "5.0 mm", "0.0 mm"]
    assert colours.ticks(0.0, 4.0e4, "Pa")[0] == "40.0 kPa" and colours.ticks(1.0, 1.2, "")[0] == "1.200"
    assert colours.ticks(0.0, 0.5, "J/m^3")[0].endswith("mJ/m³")
    strip, opacity = colours.bar("displacement", 0.0, 0.02, "viridis", 240, (0, 0, 0))
    solid = np.flatnonzero((opacity[:, :, 0] == 1.0).sum(axis=1) >= 5)
    column = solid[len(solid) // 2], np.flatnonzero(opacity[solid[len(solid) // 2], :, 0] == 1.0)[2]
    assert np.allclose(255 * strip[solid[-1], column[1]], (68, 1, 84), atol=1.5)
    without, with_bar = lifted(), lifted(colour_bar=True)
    corner = np.s_[: SIZE[1] // 2, : SIZE[0] // 3]
    assert (without[corner] == 255).all() and (with_bar[corner] != 255).any(axis=2).sum() > 100


def test_light_makes_faces_differ_and_is_brighter_from_above():
    sim = scene({"box": rigid({"box": "40 40 40 mm"})}, gravity="0 0 -9.81 m/s^2")
    camera = Camera((0.25, -0.3, 0.25), (0.0, 0.0, 0.0))
    picture = sinew.render(sim, SIZE, camera, background="#ffffff", floor=False)
    top, front, side = (pixel(picture, camera, point).sum() for point in ([0, 0, 0.02], [0, -0.02, 0], [0.02, 0, 0]))
    assert top > front + 20 and front > side + 20


def test_edges_of_the_mesh():
    sim = scene({"block": block()})
    plain, lined = (sinew.render(sim, SIZE, "front", edges=edges, **PLAIN) for edges in (False, True))
    darker = (lined.astype(int).sum(axis=2) < plain.astype(int).sum(axis=2) - 60)
    assert darker.mean() > 0.01 and (covered(lined) == covered(plain)).mean() > 0.97


# Marks


def tied(**more):
    """The block with a straight cable at its front."""
    cable = {"type": "cable", "body": "block", "points": ["10 3 5 mm", "10 3 30 mm", "10 3 55 mm"], **more}
    tip = {"body": "block", "point": "10 10 60 mm"}
    return scene({"block": block()}, actuators={"string": cable}, effectors={"tip": tip}, integrator="quasi-static")


def test_a_cable_is_seen_through_the_body_and_tells_whether_it_pulls():
    camera = Camera((0.01, -0.3, 0.03), (0.01, 0.01, 0.03))
    picture = {}
    for tension in (0.0, 0.5):
        sim = tied()
        sim.actuator("string").tension = tension
        sim.step(5)
        picture[tension] = sinew.render(sim, LARGE, camera, **PLAIN)
        points = sim.actuator("string").points
    bare = sinew.render(sim, LARGE, camera, cables=False, **PLAIN)
    beside = points[1] + [0.006, 0.0, 0.0]
    for point in (0.5 * (points[0] + points[1]), points[1]):
        assert pixel(picture[0.5], camera, point)[0] < pixel(bare, camera, point)[0] - 25  # faintly blue, so less red
        assert pixel(picture[0.5], camera, point)[0] < pixel(picture[0.0], camera, point)[0] - 15
    assert (pixel(picture[0.5], camera, beside) == pixel(bare, camera, beside)).all()


def test_effectors_and_goals():
    sim = tied()
    controller = sinew.InverseController(sim, {"tip": [0.03, -0.01, 0.06]})
    camera = Camera((0.01, -0.3, 0.03), (0.01, 0.01, 0.03))
    more = [[-0.02, 0.0, 0.02]]
    picture = sinew.render(sim, LARGE, camera, goals=more, **PLAIN)
    for goal in ([0.03, -0.01, 0.06], more[0]):
        red, _, blue = pixel(picture, camera, goal)
        assert red > blue + 80
    tip = sim.effector("tip").position - [0, 0, 0.0003]  # inside the body, but visible through it
    bare = sinew.render(sim, LARGE, camera, effectors=False, **PLAIN)
    assert pixel(picture, camera, tip).sum() < pixel(bare, camera, tip).sum() - 70
    assert (pixel(bare, camera, more[0]) == BACKGROUND).all()
    controller.detach()
    assert (pixel(sinew.render(sim, LARGE, camera, **PLAIN), camera, [0.03, -0.01, 0.06]) == BACKGROUND).all()


def standing(**motion):
    """A box on a plane."""
    sim = scene({"box": {"type": "rigid", "shape": {"box": "40 40 40 mm"}, "mass": "100 g", "pose": {"position": "0 0 20 mm"}}},
                gravity="0 0 -9.81 m/s^2", contacts={"floor": {"body": "box", "surface": {"plane": {}}, "friction": 0.5, **motion}})
    sim.step(5)
    return sim


def test_forces_are_arrows_from_where_they_act_along_them():
    sim = standing()
    camera = Camera((0.0, -0.2, 0.02), (0.0, 0.0, 0.02))
    picture, bare = (sinew.render(sim, LARGE, camera, contacts=contacts, **{**PLAIN, "lighting": True}) for contacts in (True, False))
    contact = sim.contact("floor")
    acting = contact.positions[contact.normal_forces > 0.1]
    assert len(acting) == 4 and contact.normal_force == pytest.approx(0.981, rel=1e-3)
    red = picture[..., 0].astype(int) - picture[..., 2] > bare[..., 0].astype(int) - bare[..., 2] + 10
    forces = (contact.normal_forces[:, None] * contact.normals + contact.friction_forces)[contact.normal_forces > 0.1]
    # The largest arrow has 0.22 of the size of the robot.
    lengths = 0.22 * 0.04 * math.sqrt(3.0) / np.linalg.norm(forces, axis=1).max()
    for point, force in zip(acting, forces):
        for share, arrow in ((0.3, True), (0.7, True), (1.5, False), (-0.3, False)):
            column, row = (int(x) for x in projected(camera, point + share * lengths * force, LARGE))
            assert red[row - 1 : row + 2, column - 1 : column + 2].any() == arrow
    assert 20 < red.sum() < 2000


def test_a_plane_is_a_floor_with_the_shadow_of_what_stands_on_it():
    sim = standing()
    picture = sinew.render(sim, SIZE, background="#ffffff", contacts=True)
    without = sinew.render(sim, SIZE, background="#ffffff", contacts=False, floor=False)
    camera = Renderer(sim, SIZE)
    camera.frame()
    assert (pixel(without, camera.camera, [0.03, 0.03, 0.0]) == BACKGROUND).all()
    # The light comes from the left front, so the shadow lies at the right rear.
    dark, light = (pixel(picture, camera.camera, point).sum() for point in ([0.027, 0.005, 0.0], [-0.04, -0.02, 0.0]))
    assert dark < light - 60 and light < 3 * 255


@pytest.mark.filterwarnings("ignore::sinew.SinewWarning")
def test_spheres_and_capsules_that_move_are_drawn_where_they_are():
    sim = scene({"block": block()}, contacts={
        "ball": {"body": "block", "surface": {"sphere": {"centre": "60 10 50 mm", "radius": "15 mm"}},
                 "motion": {"z": {"ramp": {"to": "-30 mm", "duration": "50 ms"}}}},
        "rod": {"body": "block", "surface": {"capsule": {"ends": ["-40 -20 20 mm", "-40 20 20 mm"], "radius": "15 mm"}}}})
    camera = Camera((0.01, -0.5, 0.03), (0.01, 0.01, 0.03))
    renderer = Renderer(sim, SIZE, camera, **PLAIN)
    before = renderer.frame()
    sim.step(5)
    after = renderer.frame()
    for picture, there, not_there in ((before, 0.05, 0.02), (after, 0.02, 0.05)):
        assert not (pixel(picture, camera, [0.06, 0.01, there]) == BACKGROUND).all()
        assert (pixel(picture, camera, [0.06, 0.01, not_there]) == BACKGROUND).all()
        assert not (pixel(picture, camera, [-0.04, -0.02, 0.02]) == BACKGROUND).all()


def test_what_a_picture_needs_of_a_scene():
    block = {"type": "fem", "mesh": {"shape": "block", "length": "40 mm", "width": "20 mm", "height": "20 mm", "element_size": "10 mm"},
             "material": {"young_modulus": "100 kPa", "poisson_ratio": 0.3}, "density": "1000 kg/m^3", "fixed": {"set": "x_min"}}  # fmt: skip
    cable = {"type": "cable", "body": "b", "points": [[0.01, 0.01, 0.005], [0.03, 0.01, 0.005]]}
    scene = {
        "sinew": 1,
        "gravity": "0 3 -4 m/s^2",
        "bodies": {"b": block, "wall": {"type": "rigid", "shape": {"plane": {}}, "motion": {"x": "1 mm"},
                                        "pose": {"position": "0.2 0 0 m", "rotation": {"axis": "0 1 0", "angle": "-90 deg"}}}},
        "actuators": {"a": cable, "c": {**cable, "pull": "body"}},
        "contacts": {
            "p": {"body": "b", "surface": {"plane": {"point": "0 0 -3mm", "normal": [0, 0, 2]}}},
            "k": {"body": "b", "surface": {"capsule": {"ends": ["0 0 -50 mm", [0.1, 0, -0.05]], "radius": "5 mm"}}, "motion": {"x": "1 mm"}},
            "o": {"between": ["b", "b"]},
            "w": {"between": ["wall", "b"]},
        },
    }  # fmt: skip
    sim = sinew.load(scene)
    outline = outline_of(sim)
    assert np.allclose(outline.up, [0.0, -0.6, 0.8]) and set(outline.surfaces) == {"p", "k", "w"} and outline.held == {"a"}
    assert np.allclose(outline.surfaces["p"].points, [[0, 0, -3e-3]]) and np.allclose(outline.surfaces["p"].normal, [0, 0, 1])
    assert np.allclose(outline.surfaces["k"].points, [[0, 0, -0.05], [0.1, 0, -0.05]]) and outline.surfaces["k"].radius == 5e-3
    assert np.allclose(outline.surfaces["w"].points, [[0.2, 0, 0]]) and np.allclose(outline.surfaces["w"].normal, [-1, 0, 0])
    poses = moment_of(sim, outline).poses
    assert np.allclose(poses["p"], np.eye(3, 4)) and all(np.allclose(poses[name][:, 3], [1e-3, 0, 0]) for name in "kw")
    assert np.allclose(outline_of(sinew.load({**scene, "gravity": "0 0 0 m/s^2"})).up, [0, 0, 1])


# Cameras


@pytest.mark.parametrize("view,forward", [("front", (0, 1, 0)), ("side", (-1, 0, 0)), ("top", (0, 0, -1)), (None, None)])
def test_views_see_all_of_a_scene_as_near_as_they_can(view, forward):
    sim = scene({"one": rigid({"box": "200 20 20 mm"}), "two": rigid({"sphere": {"radius": "30 mm"}}, pose={"position": "50 80 90 mm"})})
    renderer = Renderer(sim, SIZE, view, **PLAIN)
    picture = renderer.frame()
    rows, columns = np.nonzero(covered(picture))
    camera = renderer.camera
    assert rows.min() > 0 and columns.min() > 0 and rows.max() < SIZE[1] - 1 and columns.max() < SIZE[0] - 1
    share = max(np.ptp(rows) / SIZE[1], np.ptp(columns) / SIZE[0])
    assert 0.75 < share < 0.9
    direction = np.subtract(camera.target, camera.position)
    if forward is not None:
        assert np.allclose(direction / np.linalg.norm(direction), forward, atol=1e-9)
    points = np.concatenate([body.positions for body in sim.bodies.values()])
    mine = np.array([projected(camera, point) for point in points])
    assert np.allclose(camera.project(points, SIZE), mine)
    assert np.isnan(camera.project([2 * np.array(camera.position) - camera.target], SIZE)).all()


@pytest.mark.parametrize("gravity", ["0 0 -9.81", "0 0 9.81", "9.81 0 0", "0 -9.81 0", "0 3 -9"])
def test_gravity_points_down(gravity):
    sim = scene({"box": rigid({"box": "20 20 20 mm"})}, gravity=f"{gravity} m/s^2")
    down = np.array(gravity.split(), dtype=float)
    for view in (None, "front", "side"):
        renderer = Renderer(sim, SIZE, view)
        renderer.frame()
        (column, row), (below, lower) = projected(renderer.camera, [0, 0, 0]), projected(renderer.camera, 1e-3 * down)
        assert lower > row + 1.0 and abs(below - column) < 0.05 * (lower - row)


# Repeated rendering


def test_the_same_state_gives_the_same_bits():
    sim = sinew.load(ROOT / "examples/contact/incline.yaml")
    sim.step(20)
    first, second = (sinew.render(sim, SIZE, field="displacement") for _ in range(2))
    other = sinew.render(sim.clone(), SIZE, field="displacement")
    assert (first == second).all() and (first == other).all()
    found = []
    thread = threading.Thread(target=lambda: found.append(sinew.render(sim, SIZE, field="displacement")))
    thread.start()
    thread.join()
    assert (first == found[0]).all()


def test_a_renderer_keeps_camera_range_and_scale():
    sim = sinew.load(ROOT / "examples/beam/swing.yaml")
    with Renderer(sim, SIZE, field="displacement") as renderer:
        renderer.frame()
        camera = renderer.camera
        sim.step(10)
        moved = renderer.frame()
        assert renderer.camera is camera and isinstance(camera, Camera)
        high = np.linalg.norm(np.asarray(sim.body("beam").positions) - sim.body("beam").rest_positions, axis=1).max()
        sim.reset()
        back = renderer.frame()
        assert (moved != back).any() and renderer._range == (0.0, pytest.approx(high))
    with pytest.raises(sinew.Error) as caught:
        renderer.frame()
    assert caught.value.kind == "closed"
    renderer.close()


def test_a_simulation_is_a_picture_in_a_notebook(sim, tmp_path):
    (tmp_path / "sim.png").write_bytes(sim._repr_png_())
    assert Image.open(tmp_path / "sim.png").size == (640, 480)


def test_the_picture_does_not_keep_the_simulation_alive(sim):
    import gc
    import weakref

    copy = sim.clone()
    sinew.render(copy, SIZE)
    gone = weakref.ref(copy)
    del copy
    gc.collect()
    assert gone() is None


# Videos


def record(sim, folder, duration):
    """Records those parts of a run that are drawn, in the format of `sinew run`."""
    names = [f"{name}.positions" for name in sim.bodies] + [f"{name}.tension" for name in sim.actuators]
    parts = ("position", "normal", "normal_force", "friction_force")
    names += [f"{name}.points.{part}" for name in sim.contacts for part in parts] + [f"{name}.pose" for name in sim.contacts]
    names += [f"{name}.position" for name in sim.effectors]
    text = sim.to_yaml()
    told = sim.run(duration, record=names)
    folder.mkdir()
    with h5py.File(folder / "run.h5", "w") as file:
        file.attrs["format"] = "sinew-run"
        file["time"], file["scene"] = told["time"], text.encode()
        for name in sim.bodies:
            file[f"positions/{name}"] = told[f"{name}.positions"]
        for name in sim.actuators:
            file[f"actuators/{name}/effort"] = told[f"{name}.tension"]
        for name in sim.effectors:
            file[f"effectors/{name}/position"] = told[f"{name}.position"]
        for name in sim.contacts:
            file[f"contacts/{name}/pose"] = told[f"{name}.pose"]
            for part in parts:
                file[f"contacts/{name}/{part}"] = told[f"{name}.points.{part}"]
    return folder


@pytest.fixture
def pulled():
    """The block, with its cable pulled in 0.2 s."""
    return tied(command={"displacement": {"ramp": {"to": "4 mm", "duration": "0.2 s"}}})


def frames_of(path):
    """All frames of an animated file, and their durations (ms)."""
    with Image.open(path) as file:
        found = []
        for k in range(file.n_frames):
            file.seek(k)
            found.append((np.asarray(file.convert("RGB")).astype(int), file.info["duration"]))
    return [frame for frame, _ in found], [length for _, length in found]


@pytest.mark.parametrize("suffix", ["webp", "gif"])
def test_a_video_of_a_simulation(pulled, tmp_path, suffix):
    path = sinew.render.video(tmp_path / f"a.{suffix}", pulled, 25, duration=0.2, size=SIZE, camera="front")
    frames, lengths = frames_of(path)
    assert pulled.time == pytest.approx(0.2)
    assert len(frames) == 6 and frames[0].shape == (120, 160, 3) and set(lengths) == {40}
    assert all(np.abs(a - b).max() > 60 for a, b in zip(frames, frames[1:]))


def test_speed_and_even_times(pulled, tmp_path):
    twice = pulled.clone()
    sinew.render.video(tmp_path / "a", pulled, 25, duration=0.2, speed=0.5, size=(40, 30))
    assert len(list((tmp_path / "a").glob("frame_*.png"))) == 11 and pulled.time == pytest.approx(0.2)
    assert sinew.render.video(tmp_path / "b" / "x_%03d.png", twice, 25, duration=0.2, speed=2, size=(40, 30)) == tmp_path / "b"
    assert sorted(path.name for path in (tmp_path / "b").iterdir()) == ["x_000.png", "x_001.png", "x_002.png"]
    # Frame 1 of one series and frame 4 of the other are both at 80 ms.
    first, second = (np.asarray(Image.open(path)) for path in (tmp_path / "b" / "x_001.png", tmp_path / "a" / "frame_0004.png"))
    assert (first == second).all()


def test_a_video_of_frames(tmp_path):
    frames = [np.full((30, 40, 3), 40 * k, np.uint8) for k in range(5)]
    sinew.render.video(tmp_path / "a.webp", frames, 10)
    seen, lengths = frames_of(tmp_path / "a.webp")
    assert len(seen) == 5 and set(lengths) == {100} and [int(np.median(frame) + 2) // 40 for frame in seen] == list(range(5))
    assert sinew.render.video(tmp_path / "b", iter(frames)) == tmp_path / "b" and len(list((tmp_path / "b").iterdir())) == 5


def test_a_recorded_run_looks_as_it_did(pulled, tmp_path):
    folder = record(pulled.clone(), tmp_path / "run", 0.2)
    camera = Camera((0.01, -0.3, 0.03), (0.01, 0.01, 0.03))
    with Recording(folder) as run:
        assert len(run) == 21 and run.times[-1] == pytest.approx(0.2)
        pulled.step(20)
        live = sinew.render(pulled, SIZE, camera, field="displacement")
        replayed = Renderer(run.sim, SIZE, camera, field="displacement").frame(run.at(0.2, "displacement"))
        assert (np.abs(live.astype(int) - replayed) > 8).any(axis=2).mean() < 0.002
        # The cable moves with the body, although its points are not recorded; its pull point stays.
        points = run.at(0.2).cables["string"]
        assert np.abs(points - pulled.actuator("string").points).max() < 1e-4
        assert np.abs(points - run.moment(0).cables["string"]).max() > 3e-4
        between = run.at(0.105).positions["block"]
        assert np.allclose(between, 0.5 * (run.moment(10).positions["block"] + run.moment(11).positions["block"]))
        assert run.at(-1.0).time == 0.0 and run.at(9.0).time == pytest.approx(0.2)


def test_a_run_that_was_recorded_with_words_that_have_another_name_now(tmp_path):
    sphere = "contacts.left.surface={sphere: {centre: -8 0 20 mm, radius: 8 mm}}"
    sim = sinew.load(ROOT / "examples/contact/squeeze.yaml", set=[sphere])
    folder = record(sim, tmp_path / "run", 0.01)
    with h5py.File(folder / "run.h5", "a") as file:
        text = file["scene"][()].decode()
        del file["scene"]
        file["scene"] = text.replace("centre", "center").encode()
    with pytest.warns(sinew.SinewWarning, match="'center' has another name now; write centre"):
        sinew.loads(text.replace("centre", "center"))
    with Recording(folder) as run:
        assert run.sim.to_yaml() == text


def test_a_recorded_run_with_contacts(tmp_path):
    sim = sinew.load(ROOT / "examples/contact/squeeze.yaml")
    folder = record(sim, tmp_path / "run", 0.05)
    with Recording(folder) as run:
        moment = run.at(0.05)
        now = sim.contact("left")
        acting = now.normal_forces > 0
        assert np.allclose(moment.touching[: len(acting)], now.positions)
        assert np.allclose(moment.forces[: len(acting)], now.normal_forces[:, None] * now.normals + now.friction_forces)
        assert np.allclose(moment.poses["left"][:, 3], [0.005, 0.0, 0.0], atol=1e-9)
    path = sinew.render.video(tmp_path / "series", folder, 100, size=SIZE)
    pictures = [np.asarray(Image.open(one)) for one in sorted(path.iterdir())]
    assert len(pictures) == 6 and (pictures[0] != pictures[-1]).any()


def program(*words, cwd):
    """Runs python3 -m sinew.render."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", "sinew.render", *map(str, words)]
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)


def test_the_program_draws_runs_and_scenes(pulled, tmp_path):
    folder = record(pulled, tmp_path / "run", 0.2)
    done = program(folder, "--video", "a.webp", "--fps", 25, "--size", "80x60", "--camera", "side", "--picture", "a.png", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["drew", "a.png", "drew", "a.webp"]
    assert len(frames_of(tmp_path / "a.webp")[0]) == 6 and Image.open(tmp_path / "a.png").size == (80, 60)
    beam = ROOT / "examples/beam/swing.yaml"
    done = program(beam, "--video", "b", "--duration", "0.1s", "--field", "von_mises_stress", "--size", "80x60", "--quiet", cwd=tmp_path)
    assert done.returncode == 0 and done.stdout == "" and len(list((tmp_path / "b").iterdir())) == 4


@pytest.mark.parametrize("words,kind", [(["none", "--video", "a.webp"], "file-not-found"), (["--video", "a.webp"], "bad-argument"),
                                        (["run", "--video", "a.avi"], "unknown-format"),
                                        (["run", "--video", "a.webp", "--size", "9"], "bad-argument"),
                                        (["run", "--video", "a.webp", "--field", "presure"], "unknown-name"),
                                        (["--check", "--video", "a.avi"], "unknown-format")], ids=str)
def test_the_program_says_what_is_wrong(pulled, tmp_path, monkeypatch, capsys, words, kind):
    from sinew.render.__main__ import main

    record(pulled, tmp_path / "run", 0.05)
    (tmp_path / "none").mkdir()
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2 and f"[{kind}]" in capsys.readouterr().err and not (tmp_path / "a.webp").exists()
    assert main(["--check", "--video", "a.webp"]) == 0 and list(tmp_path.glob("a.*")) == []


def test_mp4_needs_ffmpeg_and_says_so(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(sinew.Error) as caught:
        sinew.render.video(tmp_path / "a.mp4", [np.zeros((2, 2, 3), np.uint8)])
    assert caught.value.kind == "tool-missing" and "ffmpeg" in str(caught.value) and ".webp" in caught.value.remedy


def stand_in(folder, text, monkeypatch):
    """Installs a program named ffmpeg in the path."""
    file = folder / "ffmpeg"
    file.write_text(f"#!/bin/sh\n{text}\n")
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")


def test_ffmpeg_gets_all_bytes_of_all_frames(monkeypatch, tmp_path):
    stand_in(tmp_path, 'for last; do :; done; echo "$@" > words; cat > "$last"', monkeypatch)
    monkeypatch.chdir(tmp_path)
    frames = np.random.default_rng(1).integers(0, 256, (4, 3, 5, 3), dtype=np.uint8)
    sinew.render.video("out/a.mp4", frames, 12.5)
    assert Path("out/a.mp4").read_bytes() == frames.tobytes()
    assert "-s 5x3 -r 12.5 -i -" in Path("words").read_text() and "yuv420p" in Path("words").read_text()


def test_ffmpeg_that_fails(monkeypatch, tmp_path):
    stand_in(tmp_path, "echo no such encoder >&2; exit 1", monkeypatch)
    with pytest.raises(sinew.Error) as caught:
        sinew.render.video(tmp_path / "a.mp4", np.zeros((200, 90, 90, 3), np.uint8))
    assert caught.value.kind == "recording-failed" and "no such encoder" in str(caught.value)


@pytest.mark.skipif(shutil.which("ffprobe") is None, reason="ffmpeg and ffprobe are not installed")
def test_an_mp4(pulled, tmp_path):
    sinew.render.video(tmp_path / "a.mp4", pulled, 25, duration=0.2, size=(161, 121))
    shown = "stream=nb_read_frames,width,height,r_frame_rate"
    probe = ["ffprobe", "-v", "error", "-count_frames", "-show_entries", shown, "-of", "csv=p=0"]
    told = subprocess.run([*probe, str(tmp_path / "a.mp4")], capture_output=True, text=True, check=True).stdout.strip()
    assert told == "162,122,25/1,6"


def test_the_page_about_it(tmp_path, monkeypatch):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "rendering.md").read_text(encoding="utf-8"), re.DOTALL)
    names = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"docs/rendering.md, block {number}", "exec"), names)
    assert len(blocks) == 3 and names["picture"].shape == (480, 640, 3)
    assert [len(frames_of(name)[0]) for name in ("wheel.webp", "roll.webp")] == [10, 5] and Path("wheel.png").exists()


# Errors


@pytest.mark.parametrize("options,kind", [
    ({"camera": "frnt"}, "unknown-name"), ({"camera": 3}, "wrong-type"), ({"field": "von_mises"}, "unknown-name"),
    ({"size": (0, 10)}, "out-of-range"), ({"size": 10}, "wrong-shape"), ({"size": (10**6, 10)}, "out-of-range"),
    ({"colour_map": "jet"}, "unknown-name"), ({"background": "white"}, "out-of-range"), ({"field_range": (2.0, 1.0)}, "out-of-range"),
    ({"goals": [1.0, 2.0]}, "wrong-shape"), ({"goals": [[np.nan, 0.0, 0.0]]}, "not-finite"),
], ids=str)  # fmt: skip
def test_errors(sim, options, kind):
    with pytest.raises(sinew.Error) as caught:
        sinew.render(sim, **options)
    assert caught.value.kind == kind and caught.value.remedy
    if "field" in options:
        assert "von_mises_stress" in caught.value.remedy


@pytest.mark.parametrize("arguments,kind", [(((0, 0, 0), (0, 0, 0)), "out-of-range"), (((0, 0, 1), (0, 0, 0)), "out-of-range"),
                                            (((0, 0), (0, 0, 0)), "wrong-shape"), (((0, np.nan, 0), (0, 0, 0)), "not-finite"),
                                            (((1, 0, 0), (0, 0, 0), (0, 0, 1), 4.0), "out-of-range")], ids=str)
def test_cameras_that_see_nothing(arguments, kind):
    with pytest.raises(sinew.Error) as caught:
        Camera(*arguments)
    assert caught.value.kind == kind


@pytest.mark.parametrize("call,kind", [
    (lambda sim, folder: sinew.render.video(folder / "a.webp", sim), "bad-argument"),
    (lambda sim, folder: sinew.render.video(folder / "a.webp", []), "wrong-length"),
    (lambda sim, folder: sinew.render.video(folder / "a.webp", [np.zeros((2, 2))]), "wrong-shape"),
    (lambda sim, folder: sinew.render.video(folder / "a.webp", sim, 0.0, duration=1.0), "out-of-range"),
    (lambda sim, folder: sinew.render.video(folder / "a.webp", sim, duration=-1.0), "out-of-range"),
    (lambda sim, folder: sinew.render.video(folder / "a.png", sim, duration=1.0), "unknown-format"),
    (lambda sim, folder: sinew.render.video("/proc/none/a.webp", sim, duration=1.0), "file-unwritable"),
    (lambda sim, folder: Recording(folder), "file-not-found"),
    (lambda sim, folder: Recording(__file__), "unknown-format"),
])  # fmt: skip
def test_errors_of_videos(sim, tmp_path, call, kind):
    with pytest.raises(sinew.Error) as caught:
        call(sim, tmp_path)
    assert caught.value.kind == kind and list(tmp_path.iterdir()) == []


def test_a_run_without_positions_says_so(tmp_path):
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file.attrs["format"], file["time"] = "sinew-run", [0.0]
    with pytest.raises(sinew.Error) as caught:
        Recording(tmp_path)
    assert caught.value.kind == "malformed-file" and "states: true" in caught.value.remedy


@pytest.mark.parametrize("missing", ["moderngl", "yaml", "PIL"])
def test_what_is_missing_is_named(sim, monkeypatch, missing):
    monkeypatch.setitem(sys.modules, missing, None)
    found = []

    def work():
        try:
            sinew.render(sim, SIZE, field="displacement")
        except sinew.Error as error:
            found.append(error)

    colours.bar.cache_clear()
    thread = threading.Thread(target=work)  # each thread has its own context
    thread.start()
    thread.join()
    assert found[0].kind == "tool-missing" and "install python3-" in found[0].remedy
    assert missing in ("yaml", "PIL") or sim._repr_png_ is not None


def test_no_driver(monkeypatch, sim):
    import moderngl

    def refuse(**_):
        raise RuntimeError("no display")

    monkeypatch.setattr(moderngl, "create_context", refuse)
    found = []
    thread = threading.Thread(target=lambda: found.append(pytest.raises(sinew.Error, sinew.render, sim)))
    thread.start()
    thread.join()
    assert found[0].value.kind == "tool-missing" and "libegl1" in found[0].value.remedy
