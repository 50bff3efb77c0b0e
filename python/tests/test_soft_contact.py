"""Contact between deformable bodies, and self-contact."""

import itertools

import meshio
import numpy as np
import pytest
import sinew

GRAVITY = 9.81


def block(size, origin, element_size, rotation="0 0 0 deg", **more):
    length, width, height = (1e-3 * x for x in size)
    return {"type": "fem", "density": 1000.0, "damping": {"stiffness": "1 ms"},
            "material": {"young_modulus": "200 kPa", "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": length, "width": width, "height": height, "element_size": 1e-3 * element_size},
            "pose": {"position": [1e-3 * x for x in origin], "rotation": rotation}, **more}


def make(bodies, contacts, step="1 ms", gravity="0 0 -9.81 m/s^2", integrator="backward-euler", threads=1, **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": gravity,
                       "bodies": bodies, "contacts": contacts, **more}, threads=threads)


def base(**more):
    return block((40, 40, 20), (0, 0, 0), 5, fixed=[{"set": "z_min"}], **more)


def pile(order=("low", "top"), friction=0.5, **more):
    """A block on a wider one, with non-matching meshes."""
    bodies = {"low": base(), "top": block((20, 20, 20), (7, 9, 20.2), 4)}
    return make({name: bodies[name] for name in order}, {"floor": {"between": list(order), "friction": friction}}, **more)


@pytest.mark.parametrize("order", itertools.permutations(["low", "top"]))
def test_a_block_rests_on_a_softer_one(order):
    sim = pile(order)
    deepest = 0.0
    for _ in range(60):
        sim.step()
        assert not sim.report.flagged
        deepest = min(deepest, sim.contact("floor").gap)
    floor = sim.contact("floor")
    assert floor.bodies == list(order)
    # Edges of flat faces carry forces only after using up the separation, 1e-7 of the diagonal of the larger body.
    assert deepest > -1e-7 * np.linalg.norm([0.04, 0.04, 0.02])
    assert floor.normal_force == pytest.approx(sim.body("top").mass * GRAVITY, rel=1e-3)
    sign = 1.0 if order[0] == "top" else -1.0
    assert sign * floor.force[2] == pytest.approx(sim.body("top").mass * GRAVITY, rel=1e-3)
    assert np.abs(sim.body("top").velocities).max() < 1e-4


def test_a_look_at_the_linearisation_moves_nothing():
    sim = pile()
    sim.step(30)
    watched = sim.clone()
    before = watched.state()
    linear = watched.linearise(statics=False)
    assert watched.state() == before
    normal = [k for k, row in enumerate(linear.rows) if row.endswith("normal")]
    assert len(normal) > 3
    # Newly detected points inherit the forces, along their own normals.
    assert linear.effort[normal].sum() == pytest.approx(sim.contact("floor").normal_force, rel=1e-6)
    for each in (sim, watched):
        each.step(5)
    assert sim.state() == watched.state()


def test_the_order_of_bodies_changes_nothing_to_speak_of():
    one, other = pile(), pile(("top", "low"))
    one.step(40)
    other.step(40)
    assert one.body("top").positions == pytest.approx(other.body("top").positions, abs=2e-6)


@pytest.mark.parametrize("friction, slides", [(0.2, True), (0.32, False)])
def test_a_block_on_a_slope_obeys_coulomb(friction, slides):
    angle = 0.3
    low = block((80, 40, 10), (0, 0, 0), 10, fixed=[{"set": "z_min"}])
    top = block((20, 20, 10), (7.3, 9.1, 10.01), 4)
    sim = make({"low": low, "top": top}, {"slope": {"between": ["low", "top"], "friction": friction}},
               gravity=[GRAVITY * np.sin(angle), 0.0, -GRAVITY * np.cos(angle)])
    speed = lambda: np.mean(sim.body("top").velocities, axis=0)
    sim.run(duration=0.04)
    before = speed()
    sim.run(duration=0.1)
    down = GRAVITY * (np.sin(angle) - friction * np.cos(angle))
    assert speed()[0] - before[0] == pytest.approx(0.1 * down if slides else 0.0, abs=1e-3)
    force = sim.contact("slope")
    if slides:
        assert force.friction_force == pytest.approx(friction * force.normal_force, rel=1e-6)
        assert set(force.states) <= {"open", "slip"}


def test_edges_that_cross_hold_each_other():
    """Two bars on their edges, across each other: only edges touch, no vertices."""
    ends = [{"box": "-100 -100 -100 5 100 100 mm"}, {"box": "55 -100 -100 100 100 100 mm"}]
    low = block((60, 10, 10), (0, 0, 0), 5, fixed=ends, rotation="45 0 0 deg")
    top = block((10, 60, 10), (23, -30, 24), 5, rotation="0 45 0 deg", damping={"stiffness": "10 ms"})
    sim = make({"low": low, "top": top}, {"cross": {"between": ["low", "top"], "friction": 0.5}}, step="2 ms")
    lowest = np.inf
    forces = []
    for _ in range(80):  # before it rolls off
        sim.step()
        lowest = min(lowest, sim.body("top").positions[:, 2].min())
        forces.append(sim.contact("cross").normal_force)
    assert lowest > 0.012  # the ridge of the lower bar is at 14 mm and bends by 2 mm
    assert np.mean(forces[-20:]) == pytest.approx(sim.body("top").mass * GRAVITY, rel=0.05)


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2"])
def test_a_collision_keeps_momentum_and_gains_no_energy(integrator):
    one = block((20, 20, 20), (0, 0, 0), 5, velocity={"linear": "0.5 0 0 m/s"})
    other = block((20, 20, 20), (20.5, 3, 4), 5)
    sim = make({"one": one, "other": other}, {"hit": {"between": ["one", "other"], "friction": 0.3}}, step="0.5 ms",
               gravity="0 0 0 m/s^2", integrator=integrator)
    def momentum():
        return sum(sim.body(name).mass * np.mean(sim.body(name).velocities, axis=0) for name in ("one", "other"))
    before, pushed = sim.body("one").mass * 0.5, 0.0
    for _ in range(40):
        sim.step()
        pushed = max(pushed, sim.contact("hit").normal_force)
        assert sim.report.energy_gained < 1e-5 * 0.5 * sim.body("one").mass * 0.5**2
    assert pushed > 0.1
    assert np.mean(sim.body("other").velocities, axis=0)[0] > 0.2
    # Nodal masses differ, so the mean velocity equals that of the centre of mass only up to vibrations.
    assert momentum() == pytest.approx([before, 0.0, 0.0], abs=0.02 * before)


def test_statics_find_what_time_steps_find():
    top = block((20, 20, 20), (7, 9, 20.5), 4, fixed=[{"set": "z_max"}],
                motion={"z": {"ramp": {"to": "-2.5 mm", "duration": "50 ms"}}})
    sim = make({"low": base(), "top": top}, {"press": {"between": ["low", "top"], "friction": 0.5}}, step="10 ms",
               integrator="quasi-static", gravity="0 0 0 m/s^2")
    sim.run(duration=0.08)
    stepped, where = sim.contact("press").normal_force, sim.body("low").positions.copy()
    assert stepped > 1.0
    assert sim.solve_static().stable
    assert sim.contact("press").normal_force == pytest.approx(stepped, rel=1e-6)
    assert sim.body("low").positions == pytest.approx(where, abs=1e-8)


def test_a_state_goes_on_bit_for_bit(tmp_path):
    sim = pile()
    sim.step(14)
    sim.save_state(tmp_path / "now.state")
    clone, loaded = sim.clone(), pile()
    loaded.load_state(tmp_path / "now.state")
    contact, again = sim.contact("floor"), loaded.contact("floor")
    assert contact.normal_force > 0.0 and again.normal_force == contact.normal_force
    assert np.array_equal(again.positions, contact.positions)
    two = pile(threads=2)
    two.step(14)
    fresh = pile()
    fresh.step(20)
    fresh.reset()
    fresh.step(14)
    for one in (sim, clone, loaded, two, fresh):
        one.step(6)
        assert np.array_equal(one.body("top").positions, sim.body("top").positions)


def horseshoe(path, gap=10.0, thickness=5.0, leg=40.0, width=10.0, rows=12, bends=10):
    """Two legs along z, joined by an arc below: hexahedra, mm."""
    radius = 0.5 * (gap + thickness)
    line = [((-radius, leg * (1.0 - i / rows)), (1.0, 0.0)) for i in range(rows + 1)]
    for i in range(1, bends + 1):
        angle = np.pi * i / bends
        line.append(((-radius * np.cos(angle), -radius * np.sin(angle)), (np.cos(angle), np.sin(angle))))
    line += [((radius, leg * i / rows), (-1.0, 0.0)) for i in range(1, rows + 1)]
    points = [(x + (0.5 - j) * -nx * thickness, width * (0.5 * k - 0.5), z + (0.5 - j) * -nz * thickness)
              for (x, z), (nx, nz) in line for j in range(2) for k in range(3)]
    at = lambda i, j, k: 6 * i + 3 * j + k
    cells = [[at(i, 0, k), at(i, 1, k), at(i + 1, 1, k), at(i + 1, 0, k),
              at(i, 0, k + 1), at(i, 1, k + 1), at(i + 1, 1, k + 1), at(i + 1, 0, k + 1)]
             for i in range(len(line) - 1) for k in range(2)]
    meshio.write(path, meshio.Mesh(np.array(points), [("hexahedron", np.array(cells))]))


def test_a_body_closes_on_itself(tmp_path):
    """A cable pulls the ends of a horseshoe together: their contact carries its tension."""
    horseshoe(tmp_path / "horseshoe.vtk")
    shoe = {"type": "fem", "mesh": {"file": str(tmp_path / "horseshoe.vtk"), "unit": "mm"}, "density": 1000.0,
            "damping": {"stiffness": "5 ms"}, "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.3},
            "fixed": [{"box": "-20 -20 -20 20 20 -6 mm"}]}
    cable = {"type": "cable", "body": "shoe", "points": ["-10 0 38 mm", "10 0 38 mm"], "pull": "body", "outside": "nearest",
             "command": {"tension": {"ramp": {"to": "0.8 N", "duration": "0.2 s"}}}}
    sim = make({"shoe": shoe}, {"self": {"between": ["shoe", "shoe"], "friction": 0.3}}, step="2 ms", gravity="0 0 0 m/s^2",
               actuators={"pull": cable})
    for _ in range(130):
        sim.step()
        assert not sim.report.flagged
        contact = sim.contact("self")
        assert contact.gaps[contact.normal_forces > 0.0].min(initial=0.0) > -1e-9
        assert not contact.gap <= -6e-9  # crossing edges carry forces only after using up the separation, 1e-7 of the size
    assert sim.contact("self").bodies == ["shoe", "shoe"]
    # The bent legs carry a small part of the tension.
    assert 0.75 < sim.contact("self").normal_force < 0.8


def test_all_pairs_of_deformable_bodies_touch():
    sim = make({"low": base(), "top": block((20, 20, 20), (7, 9, 20.2), 4)}, {"all": {"between": "all", "friction": 0.5}})
    assert set(sim.contacts) == {"all-low-low", "all-low-top", "all-top-top"}
    sim.step(30)
    assert sim.contact("all-low-top").normal_force > 0.0


def test_bodies_that_overlap_are_named():
    with pytest.raises(sinew.Error, match="bodies 'low' and 'top' overlap by 0.001 m at .*move one of them by at least 0.001 m") as error:
        make({"low": base(), "top": block((20, 20, 20), (7, 9, 19), 4)}, {"floor": {"between": ["low", "top"]}})
    assert error.value.kind == "out-of-range"


def test_a_part_of_a_surface_is_refused():
    with pytest.raises(sinew.Error, match="whole of their surfaces") as error:
        make({"low": base(), "top": block((20, 20, 20), (7, 9, 21), 4)},
             {"floor": {"between": ["low", "top"], "nodes": {"set": "z_max"}}})
    assert error.value.kind == "conflicting-keys"


def halves(edges, poisson_ratio):
    """A block cut into two halves that lie on each other; the upper one moves down by 1 mm in 0.3 s."""
    def half(edge, height, face):
        return {"type": "fem", "element": "hex8", "density": "1000 kg/m^3", "pose": {"position": f"0 0 {height} mm"}, "fixed": {"set": face},
                "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": poisson_ratio},
                "mesh": {"shape": "block", "length": "20 mm", "width": "20 mm", "height": "10 mm", "element_size": edge}}

    return {"low": half(edges[0], 0, "z_min"),
            "up": {**half(edges[1], 10, "z_max"), "motion": {"z": {"ramp": {"to": "-1 mm", "duration": "0.3 s"}}}}}


@pytest.mark.parametrize("edges", [("5 mm", "5 mm"), ("5 mm", "4 mm")])
def test_flush_blocks_press_on_each_other_at_their_rims_and_corners(edges):
    """A block cut into two halves, with initially coincident rims, is as stiff as in one piece."""
    sim = sinew.load({"sinew": 1, "time_step": "0.1 s", "gravity": "0 0 0 m/s^2", "solver": {"tolerance": 1e-10},
                      "bodies": halves(edges, 0.0),
                      "contacts": {"cut": {"between": ["low", "up"]}}})
    sim.step(5)
    stretch = 0.95
    uniform = 100e3 / 2 * (stretch - 1 / stretch) * 4e-4  # approximately without lateral strain
    assert sim.contact("cut").force[2] == pytest.approx(uniform, rel=0.02)
    for name, z in (("low", 9.5e-3), ("up", 9.5e-3)):
        body = sim.body(name)
        touching = np.isclose(body.rest_positions[:, 2], 0.01)
        assert np.abs(body.positions[touching, 2] - z).max() < 1e-6


@pytest.mark.parametrize("element", ["hex8", "tet4", "tet10"])
@pytest.mark.parametrize("steps", [2, 4, 8])
def test_flush_corners_hold_each_other_while_bodies_slide_a_little(element, steps):
    """If both corners lie a micrometre beside the other face, only the crossing of their rims keeps them apart.

    Regression: with four steps and linear tetrahedra, corners passed each other by 1.1 mm, because faces tilted by 1e-4.
    """
    def half(height, face):
        return {"type": "fem", "element": element, "density": 1000.0, "pose": {"position": [0, 0, height]}, "fixed": {"set": face},
                "material": {"model": "saint-venant-kirchhoff", "young_modulus": 100e3, "poisson_ratio": 0.0},
                "mesh": {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.02, "element_size": 0.01}}

    sim = sinew.load({"sinew": 1, "time_step": 1.0 / steps, "gravity": [0, 0, 0], "solver": {"tolerance": 1e-10},
                      "bodies": {"low": half(0.0, "z_min"), "up": {**half(0.02, "z_max"), "motion": {"z": {"ramp": {"to": -4e-3, "duration": 1.0}}}}},
                      "contacts": {"cut": {"between": ["low", "up"]}}})
    sim.step(steps)
    low, up = sim.body("low"), sim.body("up")
    for corner in ([x, y, 0.02] for x in (0.0, 0.04) for y in (0.0, 0.04)):
        below, above = (body.positions[np.argmin(np.abs(body.rest_positions - corner).sum(axis=1))] for body in (low, up))
        assert below[2] - above[2] < 1e-6 * 0.04
        assert below[2] == pytest.approx(0.018, abs=1e-5)
    stretch = 0.9
    assert sim.contact("cut").normal_force == pytest.approx(0.04**2 * 100e3 * stretch * (1.0 - stretch**2) / 2.0, rel=1e-4)


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_flush_blocks_with_fine_meshes_are_solved(friction):
    """Most of the 758 points are crossing edges, which carry no force yet: a law of all points has 2274 rows of rank 843."""
    def pressed(edges):
        sim = sinew.load({"sinew": 1, "time_step": "0.1 s", "gravity": "0 0 0 m/s^2",
                          "bodies": halves(edges, 0.3),
                          "contacts": {"cut": {"between": ["low", "up"], "friction": friction}}})
        sim.step(3)
        return sim

    sim, coarse = pressed(("2 mm", "1.67 mm")), pressed(("5 mm", "4 mm"))
    assert sim.report.status == "solved"
    assert sim.contact("cut").normal_force == pytest.approx(coarse.contact("cut").normal_force, rel=0.02)
    assert sim.contact("cut").gap > -1e-6 * 0.02
