"""Rigid bodies from mesh files, compared with closed forms and with primitive shapes."""

import numpy as np
import pytest
import sinew
import solids
from scipy.spatial.transform import Rotation

DENSITY = 1200.0
EDGES = np.array([60, 40, 20])  # mm


def body(file, **more):
    return {"type": "rigid", "mesh": {"file": file, "unit": "mm"}, "density": f"{DENSITY} kg/m^3", **more}


def make(bodies, **more):
    return sinew.load({"sinew": 1, "time_step": "1 ms", "integrator": "bdf2", "bodies": bodies, **more})


def box_file(tmp_path, centre=(0, 0, 0), name="box.stl"):
    return solids.write_stl(tmp_path / name, *solids.box(EDGES, centre))


def box_inertia(mass):
    a, b, c = 1e-3 * EDGES
    return mass / 12 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])


@pytest.mark.parametrize("write,ending", [(solids.write_stl, "stl"), (solids.write_obj, "obj")])
def test_a_box_has_the_mass_of_a_box(tmp_path, write, ending):
    centre = np.array([7, -30, 128])
    made = make({"part": body(write(tmp_path / f"box.{ending}", *solids.box(EDGES, centre)))}).body("part")
    mass = DENSITY * 48e-6
    assert made.mass == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(made.centre_of_mass, 1e-3 * centre, rtol=1e-12)
    np.testing.assert_allclose(made.inertia, box_inertia(mass), rtol=0, atol=1e-12 * box_inertia(mass).max())
    np.testing.assert_array_equal(made.position, 0)


def test_a_tetrahedron_has_the_mass_of_a_tetrahedron(tmp_path):
    # The right-angled corner is at the origin: second moments m / 10 and products m / 20 about that corner.
    made = make({"part": {**body(solids.write_stl(tmp_path / "t.stl", *solids.tetrahedron())), "mesh": {
        "file": str(tmp_path / "t.stl")}}}).body("part")
    mass, centre = DENSITY / 6, np.full(3, 0.25)
    second = mass * (np.full((3, 3), 0.05) + 0.05 * np.eye(3)) - mass * np.outer(centre, centre)
    assert made.mass == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(made.centre_of_mass, centre, rtol=1e-12)
    np.testing.assert_allclose(made.inertia, np.trace(second) * np.eye(3) - second, atol=1e-12 * mass)


def test_an_icosphere_tends_to_a_ball(tmp_path):
    errors = []
    for divisions in (1, 2, 3):
        nodes, triangles = solids.icosphere(divisions)
        made = make({"ball": body(solids.write_obj(tmp_path / "ball.obj", 15 * nodes, triangles))}).body("ball")
        mass = DENSITY * 4 / 3 * np.pi * 0.015**3
        moment = 0.4 * mass * 0.015**2
        errors.append([abs(made.mass / mass - 1), np.abs(made.inertia / moment - np.eye(3)).max()])
        assert np.linalg.norm(made.centre_of_mass) < 1e-7 * 0.015  # files hold single precision
    order = np.log2(np.array(errors[:-1]) / errors[1:])
    print(errors, order)
    assert (order[-1] > 1.9).all() and errors[-1][0] < 0.02


def test_inertia_does_not_depend_on_where_the_file_puts_the_part(tmp_path):
    nodes, triangles = solids.icosphere(1)
    stretched = 10 * nodes * [1, 2, 3]
    turn = Rotation.from_rotvec([0.3, -0.8, 0.5]).as_matrix()
    own = make({"part": body(solids.write_obj(tmp_path / "a.obj", stretched, triangles))}).body("part")
    far = make({"part": body(solids.write_obj(tmp_path / "b.obj", stretched @ turn.T + [50, -80, 20], triangles))}).body("part")
    assert far.mass == pytest.approx(own.mass, rel=1e-6)
    np.testing.assert_allclose(far.inertia, turn @ own.inertia @ turn.T, atol=1e-5 * own.inertia.max())
    # About the origin of the file, by the parallel axis theorem.
    shift = 1e-3 * np.array([50, -80, 20])
    assert np.trace(far.inertia) + 2 * far.mass * shift @ shift == pytest.approx(
        np.trace(own.inertia) + 2 * far.mass * shift @ shift, rel=1e-5)
    # A pose in the scene moves the body without changing its inertia.
    placed = make({"part": body(str(tmp_path / "a.obj"), pose={"position": "50 -80 20 mm", "rotation": "0.3 -0.8 0.5 rad"})})
    part = placed.body("part")
    np.testing.assert_allclose(part.inertia, own.inertia, rtol=1e-12, atol=1e-12 * own.inertia.max())
    np.testing.assert_allclose(part.positions, own.positions @ turn.T + shift, atol=1e-12)
    np.testing.assert_allclose(part.centre_of_mass, turn @ own.centre_of_mass + shift, atol=1e-12)
    np.testing.assert_allclose(part.position, shift, atol=1e-15)


def spinning(part, steps, **more):
    sim = make({"part": {**part, "velocity": {"angular": "0.1 20 0.1 rad/s", "linear": "0.3 0 0.1 m/s"}}}, **more)
    sim.run(duration=1e-3 * steps)
    return sim.body("part")


def test_a_box_of_triangles_spins_as_a_box(tmp_path):
    shape = {"type": "rigid", "shape": {"box": "60 40 20 mm"}, "density": f"{DENSITY} kg/m^3"}
    ours, theirs = spinning(body(box_file(tmp_path)), 300), spinning(shape, 300)
    np.testing.assert_allclose(ours.rotation, theirs.rotation, atol=1e-9)
    np.testing.assert_allclose(ours.position, theirs.position, atol=1e-9)
    np.testing.assert_allclose(ours.velocity, theirs.velocity, atol=1e-9 * 20)
    # With another origin of the file, the frame shifts and the motion of the centre of mass is the same.
    off = spinning(body(box_file(tmp_path, (10, 20, 30))), 300)
    turn = Rotation.from_quat(np.roll(off.rotation, -1))
    np.testing.assert_allclose(off.rotation, theirs.rotation, atol=1e-9)
    np.testing.assert_allclose(off.centre_of_mass - [0.01, 0.02, 0.03], theirs.centre_of_mass, atol=1e-9)
    np.testing.assert_allclose(off.position, off.centre_of_mass - turn.apply([0.01, 0.02, 0.03]), atol=1e-12)


def test_a_box_of_triangles_swings_and_is_driven_as_a_box(tmp_path):
    joints = {"pin": {"type": "hinge", "bodies": ["world", "part"], "point": "-30 0 0 mm", "axis": "0 1 0"}}
    ends = []
    for part in (body(box_file(tmp_path)), {"type": "rigid", "shape": {"box": "60 40 20 mm"},
                                            "density": f"{DENSITY} kg/m^3"}):
        free = make({"part": part}, joints=joints, gravity="0 0 -9.81 m/s^2", actuators={
            "push": {"type": "force", "body": "part", "point": "30 0 0 mm", "direction": "0 0 1",
                     "command": {"force": "0.1 N"}}})
        free.run(duration=0.3)
        driven = make({"part": part}, joints=joints, gravity="0 0 -9.81 m/s^2", actuators={
            "motor": {"type": "motor", "joint": "pin", "command": {"velocity": "2 rad/s"}},
            "cable": {"type": "cable", "body": "part", "points": ["0 0 200 mm", "30 0 10 mm"],
                      "command": {"tension": "0.2 N"}}})
        driven.run(duration=0.1)
        ends.append([free.joint("pin").angle, *free.joint("pin").force, *free.body("part").rotation,
                     driven.actuator("motor").torque, *driven.joint("pin").force])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9, rtol=1e-9)


def test_mass_and_inertia_of_the_scene_replace_those_of_the_surface(tmp_path):
    file = box_file(tmp_path)
    part = {"type": "rigid", "mesh": {"file": file, "unit": "mm"}, "mass": "100 g"}
    np.testing.assert_allclose(make({"part": part}).body("part").inertia, box_inertia(0.1), atol=1e-16)
    given = make({"part": {**part, "inertia": "1e-5 2e-5 2.5e-5 kg m^2", "centre_of_mass": "0 0 5 mm"}}).body("part")
    np.testing.assert_allclose(given.inertia, np.diag([1e-5, 2e-5, 2.5e-5]), atol=1e-18)
    np.testing.assert_allclose(given.centre_of_mass, [0, 0, 0.005], atol=1e-15)


def test_an_open_surface_serves_where_no_mass_is_asked_of_it(tmp_path):
    nodes, triangles = solids.box(EDGES)
    file = solids.write_stl(tmp_path / "open.stl", nodes, triangles[:-1])
    part = {"type": "rigid", "mesh": {"file": file, "unit": "mm"}}
    make({"part": {**part, "fixed": True}})
    make({"part": {**part, "mass": "100 g", "inertia": "1e-5 2e-5 2.5e-5 kg m^2", "centre_of_mass": "0 0 0 mm"}})
    with pytest.raises(sinew.Error, match="do not have one triangle on either side") as error:
        make({"part": {**part, "mass": "100 g"}})
    assert error.value.kind == "surface-not-closed" and "open.stl" in str(error.value)


def test_surfaces_that_are_no_solid_are_named(tmp_path):
    nodes, triangles = solids.box(EDGES)
    inside_out = solids.write_stl(tmp_path / "out.stl", nodes, triangles[:, ::-1])
    with pytest.raises(sinew.Error, match="inside out.*-4.8e-05 m") as error:
        make({"part": body(inside_out)})
    assert error.value.kind == "inverted-element"
    other, more = solids.box(EDGES, (30, 10, 5))
    crossing = solids.write_stl(tmp_path / "cross.stl", np.vstack([nodes, other]), np.vstack([triangles, more + 8]))
    with pytest.raises(sinew.Error, match="cross or touch.*unite") as error:
        make({"part": body(crossing)})
    assert error.value.kind == "self-crossing"
    with pytest.raises(sinew.Error, match="there is no file"):
        make({"part": body(str(tmp_path / "none.stl"))})
    with pytest.raises(sinew.Error, match="'shape' and 'mesh' exclude each other"):
        make({"part": body(crossing, shape={"box": "1 1 1 mm"})})
    with pytest.raises(sinew.Error, match="one of shape, mesh is missing"):
        make({"part": {"type": "rigid", "mass": "1 g"}})
    flat = solids.write_stl(tmp_path / "flat.stl", nodes * [1, 1, 0], triangles)
    with pytest.raises(sinew.Error):
        make({"part": body(flat)})


def test_two_parts_and_a_hollow_count(tmp_path):
    nodes, triangles = solids.box(EDGES)
    inner, _ = solids.box(EDGES / 2)
    hollow = solids.write_stl(tmp_path / "h.stl", np.vstack([nodes, inner]), np.vstack([triangles, triangles[:, ::-1] + 8]))
    assert make({"part": body(hollow)}).body("part").mass == pytest.approx(DENSITY * 48e-6 * 7 / 8, rel=1e-12)
    other, _ = solids.box(EDGES, (100, 0, 0))
    two = solids.write_stl(tmp_path / "2.stl", np.vstack([nodes, other]), np.vstack([triangles, triangles + 8]))
    made = make({"part": body(two)}).body("part")
    assert made.mass == pytest.approx(2 * DENSITY * 48e-6, rel=1e-12)
    np.testing.assert_allclose(made.centre_of_mass, [0.05, 0, 0], atol=1e-15)


def test_vtk_files_give_a_surface(tmp_path):
    nodes, triangles = solids.box(EDGES)
    points = "\n".join(" ".join(map(repr, map(float, node))) for node in nodes)
    head = f"# vtk DataFile Version 2.0\npart\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n{points}\n"
    volume = tmp_path / "volume.vtk"
    volume.write_text(head + "CELLS 1 9\n8 0 4 6 2 1 5 7 3\nCELL_TYPES 1\n12\n")
    surface = tmp_path / "surface.vtk"
    cells = "\n".join(f"3 {a} {b} {c}" for a, b, c in triangles)
    surface.write_text(head + f"CELLS 12 48\n{cells}\nCELL_TYPES 12\n" + "5\n" * 12)
    for file in (volume, surface):
        made = make({"part": body(str(file))}).body("part")
        np.testing.assert_allclose(made.inertia, box_inertia(DENSITY * 48e-6), atol=1e-12 * 1e-5)


def test_a_soft_beam_is_welded_to_a_part_as_to_a_box(tmp_path):
    beam = {"type": "fem", "mesh": {"shape": "block", "length": "100 mm", "width": "20 mm", "height": "20 mm",
                                    "element_size": "10 mm"}, "element": "hex8",
            "material": {"model": "neo-hookean", "young_modulus": "1 MPa", "poisson_ratio": 0.4},
            "density": "1000 kg/m^3", "fixed": {"set": "x_min"}}
    tips = []
    for part in (body(box_file(tmp_path)), {"type": "rigid", "shape": {"box": "60 40 20 mm"},
                                            "density": f"{DENSITY} kg/m^3"}):
        sim = make({"beam": beam, "part": {**part, "pose": {"position": "130 10 10 mm"}}}, gravity="0 0 -9.81 m/s^2",
                   integrator="quasi-static", joints={"bond": {"type": "weld", "bodies": ["beam", "part"]}})
        sim.solve_static()
        tips.append(np.concatenate([sim.body("part").position, sim.joint("bond").force, sim.joint("bond").moment]))
    assert tips[0][2] < 0.009
    np.testing.assert_allclose(tips[0], tips[1], atol=1e-9)


def test_points_attach_inside_and_not_outside(tmp_path):
    part = body(box_file(tmp_path))
    pull = {"type": "force", "body": "part", "direction": "0 0 1"}
    make({"part": part}, actuators={"pull": {**pull, "point": "29 19 9 mm"}})
    with pytest.raises(sinew.Error, match="0.005 m outside body 'part'"):
        make({"part": part}, actuators={"pull": {**pull, "point": "35 0 0 mm"}})


def test_points_of_a_surface_may_touch(tmp_path):
    sim = make({"part": body(box_file(tmp_path), pose={"position": "0 0 100 mm"})}, gravity="0 0 -9.81 m/s^2",
               contacts={"touch": {"body": "part", "surface": {"plane": {"point": "0 0 80 mm"}},
                                   "points": ["-30 -20 90 mm", "30 -20 90 mm", "0 20 90 mm"]}})
    sim.run(duration=0.2)
    assert sim.body("part").position[2] == pytest.approx(0.09, abs=1e-6)


def hull(file, **more):
    return body(file, **{"mesh": {"file": file, "unit": "mm", "use": "convex"}, **more})


@pytest.mark.parametrize("friction,pose,velocity", [
    (0.0, {"position": "0 0 30 mm", "rotation": "0.2 0.1 0 rad"}, {"linear": "0.3 0.1 0 m/s"}),  # falls, tilts, lies
    (0.4, {"position": "0 0 10 mm"}, {"linear": "0.5 0 0 m/s"}),  # slides
])
def test_a_convex_body_on_the_floor_is_as_a_box(tmp_path, friction, pose, velocity):
    # With friction, four points can share a twisting moment in many ways, so the case with rotation is frictionless.
    ends = []
    for part in (hull(box_file(tmp_path)), {"type": "rigid", "shape": {"box": "60 40 20 mm"},
                                            "density": f"{DENSITY} kg/m^3"}):
        sim = make({"part": {**part, "pose": pose, "velocity": velocity}}, gravity="0 0 -9.81 m/s^2",
                   integrator="backward-euler",
                   contacts={"floor": {"body": "part", "surface": {"plane": {}}, "friction": friction}})
        sim.run(duration=0.3)
        # The contacts of a step are solved to 1e-10 m, which is 1e-7 m/s.
        ends.append(np.concatenate([sim.body("part").position, sim.body("part").rotation, 1e-2 * sim.body("part").velocity]))
    assert ends[0][2] == pytest.approx(0.01, abs=1e-6)
    if friction:
        assert ends[0][0] == pytest.approx(0.5**2 / (2 * 0.4 * 9.81), rel=0.01) and abs(ends[0][7]) < 1e-11
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


def test_a_soft_block_falls_on_a_convex_body_as_on_a_box(tmp_path):
    soft = {"type": "fem", "mesh": {"shape": "block", "length": "20 mm", "width": "20 mm", "height": "20 mm",
                                    "element_size": "10 mm"}, "element": "hex8", "pose": {"position": "-5 -10 12 mm"},
            "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.4},
            "density": "1000 kg/m^3"}
    ends = []
    for part in (hull(box_file(tmp_path)), {"type": "rigid", "shape": {"box": "60 40 20 mm"},
                                            "density": f"{DENSITY} kg/m^3"}):
        sim = make({"part": part, "soft": soft}, gravity="0 0 -9.81 m/s^2", integrator="backward-euler",
                   joints={"hold": {"type": "hinge", "bodies": ["world", "part"], "point": "0 0 0 mm", "axis": "y",
                                    "friction": "0.5 mN m"}},
                   contacts={"lie": {"between": ["soft", "part"], "friction": 0.5}})
        sim.run(duration=0.1)
        ends.append((sim.body("soft").positions.copy(), sim.joint("hold").angle))
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=1e-8)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=1e-7) and abs(ends[0][1]) > 1e-3


def test_a_hull_spans_what_the_surface_leaves_out(tmp_path):
    # The convex hull spans the gap between two boxes, so a soft block on it does not fall through.
    nodes, triangles = solids.box(np.array([20, 40, 20]), (-40, 0, 0))
    other, _ = solids.box(np.array([20, 40, 20]), (40, 0, 0))
    two = solids.write_stl(tmp_path / "two.stl", np.vstack([nodes, other]), np.vstack([triangles, triangles + 8]))
    soft = {"type": "fem", "mesh": {"shape": "block", "length": "20 mm", "width": "20 mm", "height": "20 mm",
                                    "element_size": "20 mm"}, "element": "hex8", "pose": {"position": "-10 -10 11 mm"},
            "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.4},
            "density": "1000 kg/m^3"}
    sim = make({"part": {**hull(two), "fixed": True}, "soft": soft}, gravity="0 0 -9.81 m/s^2",
               integrator="backward-euler", contacts={"lie": {"between": ["soft", "part"]}})
    assert sim.body("part").mass == pytest.approx(DENSITY * 32e-6, rel=1e-12)
    sim.run(duration=0.3)
    assert sim.body("soft").positions[:, 2].min() == pytest.approx(0.01, abs=1e-5)


def test_states_and_clones_go_on_bit_for_bit(tmp_path):
    def load(file):
        return make({"part": body(file, velocity={"angular": "1 20 3 rad/s"})}, gravity="0 0 -9.81 m/s^2")

    file = box_file(tmp_path, (3, 2, 1))
    one, other = load(file), load(file)
    one.run(duration=0.05)
    one.save_state(tmp_path / "state")
    twin = one.clone()
    other.load_state(tmp_path / "state")
    for sim in (one, other, twin):
        sim.run(duration=0.05)
        assert np.array_equal(sim.body("part").positions, one.body("part").positions)
    with pytest.raises(sinew.Error, match="shape"):
        load(box_file(tmp_path, (3, 2, 1.5), "moved.stl")).load_state(tmp_path / "state")


def test_runs_record_the_surface(tmp_path):
    sim = make({"part": body(box_file(tmp_path), velocity={"linear": "1 0 0 m/s"})})
    assert sim.body("part").positions.shape == (8, 3)
    np.testing.assert_allclose(np.abs(sim.body("part").positions), np.tile(EDGES / 2000, (8, 1)), rtol=1e-12)
