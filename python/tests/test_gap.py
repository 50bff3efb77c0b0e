"""Gaps of open contacts: the distance of the surfaces, or NaN with a bound below it; never a placeholder."""

import math

import meshio
import numpy as np
import pytest
import sinew

import solids
from sinew.sweep.plots import draw

SOFT = {"type": "fem", "density": 1000.0, "damping": {"stiffness": "2 ms"},
        "material": {"model": "neo-hookean", "young_modulus": "200 kPa", "poisson_ratio": 0.3}}


def block(size, origin, element_size, **more):
    """Sizes in mm."""
    length, width, height = (1e-3 * x for x in size)
    return {**SOFT, "pose": {"position": [1e-3 * x for x in origin]}, **more,
            "mesh": {"shape": "block", "length": length, "width": width, "height": height, "element_size": 1e-3 * element_size}}


def base(**more):
    return block((40, 40, 20), (0, 0, 0), 10, fixed=[{"set": "z_min"}], **more)


def make(bodies, contacts, step="4 ms", gravity="0 0 -9.81 m/s^2", integrator="backward-euler", **more):
    return sinew.load({"sinew": 1, "time_step": step, "gravity": gravity, "integrator": integrator,
                       "bodies": bodies, "contacts": contacts, **more})


def is_right(contact, actual, tolerance):
    """Whether what a contact says of its gap agrees with the actual distance, m."""
    if math.isnan(contact.gap):
        return 0.0 < contact.gap_above < actual
    return math.isnan(contact.gap_above) and abs(contact.gap - actual) <= tolerance


def triangles_of(cells):
    """Triangles of the boundary of hexahedra or tetrahedra."""
    faces = {8: [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
             4: [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]}[cells.shape[1]]
    found = {}
    for cell in cells:
        for face in faces:
            nodes = tuple(cell[list(face)])
            key = tuple(sorted(nodes))
            found[key] = None if key in found else nodes
    return np.array([t for f in found.values() if f for t in ((f[0], f[1], f[2]), *(((f[0], f[2], f[3]),) if len(f) == 4 else ()))])


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
@pytest.mark.parametrize("speed", [0.0, 3.0])
def test_a_block_that_falls_on_a_block_says_how_far_it_is(integrator, speed):
    sim = make({"low": base(), "top": block((20, 20, 20), (7, 9, 57), 10, velocity={"linear": [0, 0, -speed]})},
               {"floor": {"between": ["top", "low"]}}, integrator=integrator)
    floor, reach, seen = sim.contact("floor"), 0.0, set()
    for _ in range(40):
        if floor.normal_force > 0.0:
            assert abs(floor.gap) < 1e-7 and math.isnan(floor.gap_above)
            break
        actual = sim.body("top").positions[:, 2].min() - sim.body("low").positions[:, 2].max()
        assert is_right(floor, actual, 2e-5), (floor.gap, floor.gap_above, actual)
        seen.add(math.isnan(floor.gap))
        reach = np.fmax(reach, floor.gap_above)
        assert np.isfinite(floor.positions).all() and np.linalg.norm(floor.normals, axis=1) == pytest.approx(1.0)
        assert len(floor.gaps) == len(floor.positions) == len(floor.normals) == len(floor.normal_forces) == len(floor.states)
        sim.step()
    assert seen == {True, False} and floor.normal_force > 0.0
    assert 0.0 < reach < 0.0012  # 1 % of the diagonal of all bodies


@pytest.mark.parametrize("order", [["ball", "block"], ["block", "ball"]])
def test_bodies_that_are_far_apart_do_not_say_how_far(order):
    bodies = {"ball": {**SOFT, "mesh": {"shape": "sphere", "radius": "17 mm"}}, "block": block((20, 40, 40), (22, -20, -20), 10)}
    sim = make(bodies, {"g": {"between": order}}, gravity="0 0 0 m/s^2")
    grip = sim.contact("g")
    for _ in range(2):  # before the first step, and after it
        assert math.isnan(grip.gap) and 0.0 < grip.gap_above < 5e-3
        assert grip.positions.shape == grip.normals.shape == grip.friction_forces.shape == (0, 3)
        assert len(grip.gaps) == len(grip.normal_forces) == 0 and grip.states == []
        assert grip.normal_force == 0.0 and not grip.force.any()
        sim.step()
    told = sim.run(0.004, record=["g.gap", "g.gap_above", "g.points.gap", "g.points.position", "g.points.normal_force"])
    assert np.isnan(told["g.gap"]).all() and (told["g.gap_above"] == grip.gap_above).all()
    assert np.isnan(told["g.points.gap"]).all() and np.isnan(told["g.points.position"]).all()
    assert not told["g.points.normal_force"].any()


def spring_of_two_legs(path):
    """A U of hexahedra, mm: legs of 40 mm along z, 8 mm apart."""
    x = np.array([0.0, 4.0, 8.0, 12.0, 16.0])
    at = {}
    cells = []
    number = lambda i, j, k: at.setdefault((i, j, k), len(at))
    for k in range(12):
        for i in range(4):
            if k >= 2 and i in (1, 2):
                continue
            cells.append([number(i + a, b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))])
    nodes = np.array([[x[i], 8.0 * j, 4.0 * k] for i, j, k in at])
    meshio.write(path, meshio.Mesh(nodes, [("hexahedron", np.array(cells))]))
    return nodes, np.array(cells)


def test_a_spring_that_closes_on_itself_says_how_far_it_is_open(tmp_path):
    nodes, cells = spring_of_two_legs(tmp_path / "u.vtk")
    pull = {"type": "cable", "body": "u", "points": ["2 4 46 mm", "14 4 46 mm"], "pull": "body",
            "command": {"displacement": {"ramp": {"to": "9 mm", "duration": "1.8 s"}}}}
    sim = make({"u": {**SOFT, "mesh": {"file": str(tmp_path / "u.vtk"), "unit": "mm"}, "fixed": [{"box": "-1 -1 -1 17 9 1 mm"}]}},
               {"self": {"between": ["u", "u"]}}, step="0.2 s", gravity="0 0 0 m/s^2", integrator="quasi-static",
               actuators={"pull": pull})
    own = sim.body("u")
    middle = nodes[cells].mean(axis=1)
    legs = [triangles_of(own.hexahedra[(middle[:, 2] > 12) & ((middle[:, 0] > 8) == side)]) for side in (False, True)]

    def distance():
        here = own.positions
        return min(sinew.collision.Surface(here, legs[b]).nearest(here[np.unique(legs[a])]).distances.min() for a, b in ((0, 1), (1, 0)))

    follow_until_touch(sim, sim.contact("self"), distance, 2e-5, 9)


def follow_until_touch(sim, contact, distance, within, steps):
    """The gap of a contact is right in every step until it has a force; it is unknown at first, and known at last."""
    seen = set()
    for _ in range(steps):
        actual = distance()
        assert is_right(contact, actual, within), (contact.gap, contact.gap_above, actual)
        seen.add(math.isnan(contact.gap))
        if contact.normal_force > 0.0:
            break
        sim.step()
    assert seen == {True, False} and contact.normal_force > 0.0


def test_contacts_with_shapes_measure_every_gap(tmp_path):
    """Also before the first step, and in a loaded state: rigid on rigid, soft on rigid, soft on a plane."""
    stone = {"type": "rigid", "shape": {"box": "10 10 10 mm"}, "mass": "10 g",
             "pose": {"position": "60 0 40 mm", "rotation": {"axis": "y", "angle": "20 deg"}}, "velocity": {"angular": "0 3 0 rad/s"}}
    table = {"type": "rigid", "shape": {"box": "200 200 20 mm"}, "fixed": True, "pose": {"position": "0 0 -10 mm"}}
    ball = {"type": "rigid", "shape": {"sphere": {"radius": "5 mm"}}, "fixed": True, "pose": {"position": "10 10 0 mm"}}
    sim = make({"stone": stone, "table": table, "ball": ball, "soft": block((20, 20, 20), (0, 0, 40), 10)},
               {"drop": {"between": ["stone", "table"]}, "on": {"between": ["soft", "ball"]},
                "ground": {"body": "soft", "surface": {"plane": {"point": "0 0 1 mm", "normal": "0 0 1"}}}})
    corners = 0.005 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])

    def statements(sim):
        rigid, soft = sim.body("stone"), sim.body("soft").positions
        lowest = (sim.body("stone").position + corners @ np.asarray(rotation(rigid)).T)[:, 2].min()
        assert is_right(sim.contact("on"), np.linalg.norm(soft - [0.01, 0.01, 0], axis=1).min() - 0.005, 1e-4)
        for name, gap in {"drop": lowest, "ground": soft[:, 2].min() - 0.001}.items():
            contact = sim.contact(name)
            assert contact.gap == pytest.approx(gap, abs=1e-9) and math.isnan(contact.gap_above), name
            assert np.isfinite(contact.gaps).all() and np.isfinite(contact.positions).all()
            if len(contact.gaps):
                assert contact.gaps.min() == pytest.approx(gap, abs=1e-4)
            assert np.linalg.norm(contact.normals, axis=1) == pytest.approx(1.0)

    statements(sim)
    sim.step(5)
    statements(sim)
    again = sim.clone()
    statements(again)
    again.restore(sim.state())
    statements(again)
    assert [len(again.contact(name).gaps) for name in sim.contacts] == [len(sim.contact(name).gaps) for name in sim.contacts]


def rotation(body):
    """(3, 3) of the quaternion w, x, y, z."""
    w, x, y, z = body.rotation
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def test_rigid_meshes_say_how_far_they_are(tmp_path):
    for name, edges in (("low", (60, 60, 10)), ("top", (10, 10, 10))):
        solids.write_stl(tmp_path / f"{name}.stl", *solids.box(edges))
    part = lambda name, **more: {"type": "rigid", "mesh": {"file": str(tmp_path / f"{name}.stl"), "unit": "mm"}, "density": 1000.0, **more}
    sim = make({"low": part("low", fixed=True), "top": part("top", pose={"position": "3 4 25 mm"})},
               {"drop": {"between": ["top", "low"]}})
    follow_until_touch(sim, sim.contact("drop"), lambda: sim.body("top").position[2] - 0.01, 1e-6, 30)


def test_sweeps_and_plots_take_gaps_that_are_not_known(tmp_path):
    scene = {"sinew": 1, "time_step": "4 ms", "integrator": "backward-euler", "gravity": "0 0 -9.81 m/s^2", "duration": "40 ms",
             "bodies": {"low": base(), "top": block((20, 20, 20), (7, 9, 26), 10)}, "contacts": {"floor": {"between": ["top", "low"]}}}
    table = sinew.sweep.run(scene, vary={"bodies.low.mesh.height": ["20 mm", "23 mm", "25.3 mm", "25.4 mm"]},
                            measure=["floor.gap", "floor.gap_above"], duration=0.008, out=tmp_path / "s", workers=1)
    assert set(table["status"]) == {"done"}
    assert np.isnan(table["floor.gap"]).tolist() == [True, True, False, False]
    assert np.isnan(table["floor.gap_above"]).tolist() == [False, False, True, True]
    made = draw(tmp_path / "s")
    assert made and all(path.stat().st_size > 5000 for path in made)
