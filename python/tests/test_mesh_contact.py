"""Contact of rigid triangle meshes with each other and with deformable bodies."""

import numpy as np
import pytest
import sinew
import solids
from scipy.spatial.transform import Rotation

G = 9.81
TABLE = {"type": "rigid", "shape": {"box": "400 400 10 mm"}, "fixed": True, "pose": {"position": "0 0 -5 mm"}}
SOFT = {"type": "fem", "element": "hex8", "density": "1000 kg/m^3",
        "material": {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.4}}


def part(file, **more):
    return {"type": "rigid", "mesh": {"file": file, "unit": "mm"}, "density": "1200 kg/m^3", **more}


def box(tmp_path, edges):
    name = "x".join(str(e) for e in edges) + ".stl"
    return solids.write_stl(tmp_path / name, *solids.box(np.array(edges)))


def cup(tmp_path):
    return solids.write_stl(tmp_path / "cup.stl", *solids.cup([60, 50, 40], 5))


def block(length, width, height, size):
    return {"shape": "block", "length": f"{length} mm", "width": f"{width} mm", "height": f"{height} mm",
            "element_size": f"{size} mm"}


def make(bodies, friction=0.3, **more):
    return sinew.load({"sinew": 1, "time_step": "1 ms", "integrator": "backward-euler", "gravity": f"0 0 -{G} m/s^2",
                       "bodies": bodies, "contacts": {"all": {"between": "all", "friction": friction}}, **more})


def weight(sim, name):
    return G * sim.body(name).mass


def test_a_mesh_slides_as_coulomb_says(tmp_path):
    sim = make({"table": TABLE, "part": part(box(tmp_path, (60, 40, 20)), pose={"position": "0 0 10.0001 mm"},
                                             velocity={"linear": "0.5 0 0 m/s"})}, friction=0.4, time_step="0.2 ms")
    sim.run(duration=0.2)
    assert sim.body("part").position[0] == pytest.approx(0.5**2 / (2 * 0.4 * G), rel=2e-3)
    assert sim.body("part").position[2] == pytest.approx(0.01, abs=1e-6)
    assert sim.contact("all-table-part").normal_force == pytest.approx(weight(sim, "part"), rel=1e-6)


def test_a_part_comes_to_rest_in_a_cup_and_its_hull_does_not(tmp_path):
    heights = []
    for use in ("surface", "convex"):
        file = {"file": cup(tmp_path), "unit": "mm", "use": use}
        tilted = {"position": "2 1 5 mm" if use == "surface" else "2 1 32 mm", "rotation": "0.3 0.2 0.4 rad"}
        sim = make({"table": {**TABLE, "pose": {"position": "0 0 -25.02 mm"}}, "cup": {**part(""), "mesh": file},
                    "part": part(box(tmp_path, (20, 16, 12)), pose=tilted)})
        sim.run(duration=0.8)
        assert np.abs(sim.body("part").velocity).max() < 1e-9
        inside, below = sim.contact("all-cup-part"), sim.contact("all-table-cup")
        assert inside.normal_force == pytest.approx(weight(sim, "part"), rel=1e-6)
        assert below.normal_force == pytest.approx(weight(sim, "part") + weight(sim, "cup"), rel=1e-6)
        heights.append(sim.body("part").position[2] - sim.body("cup").position[2])
    assert heights[0] == pytest.approx(-0.015 + 0.006, abs=1e-6)  # on the bottom
    assert heights[1] == pytest.approx(0.02 + 0.006, abs=1e-6)  # on the plane of the rim


def test_a_soft_block_falls_into_a_cup(tmp_path):
    sim = make({"cup": part(cup(tmp_path), fixed=True),
                "soft": {**SOFT, "mesh": block(20, 20, 20, 5), "pose": {"position": "-8 -10 -10 mm"}}})
    sim.run(duration=0.4)
    nodes = sim.body("soft").positions
    assert nodes[:, 2].min() == pytest.approx(-0.015, abs=1e-6)
    assert sim.contact("all-cup-soft").normal_force == pytest.approx(weight(sim, "soft"), rel=1e-3)


SHAPES = [{"sphere": {"radius": "3 mm"}}, {"capsule": {"radius": "2 mm", "length": "6 mm"}},
          {"cylinder": {"radius": "3 mm", "height": "8 mm"}}, {"box": "6 6 6 mm"}, None]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: next(iter(s)) if s else "mesh")
def test_nothing_falls_between_the_nodes_of_a_coarse_body(tmp_path, shape):
    small = {"type": "rigid", "density": "2000 kg/m^3", "pose": {"position": "5 5 8 mm", "rotation": "0.3 0.2 0 rad"}}
    small |= {"shape": shape} if shape else {"mesh": {"file": box(tmp_path, (6, 6, 6)), "unit": "mm"}}
    pad = {**SOFT, "mesh": block(60, 60, 20, 10), "pose": {"position": "-30 -30 -20 mm"}, "fixed": {"set": "z_min"}}
    sim = make({"pad": pad, "part": small})
    sim.run(duration=0.15)
    assert sim.body("part").position[2] > 0.0015
    assert sim.contact("all-pad-part").normal_force == pytest.approx(weight(sim, "part"), rel=0.05)
    assert sim.contact("all-pad-part").gap > -1e-7


def test_a_corner_dents_as_the_same_body_of_a_shape(tmp_path):
    pad = {**SOFT, "mesh": block(60, 60, 20, 15), "pose": {"position": "-30 -30 -20 mm"}, "fixed": {"set": "z_min"}}
    pose = {"position": "3.7 2.3 38 mm", "rotation": "0.6 0.9 0 rad"}
    ends = []
    for small in (part(box(tmp_path, (60, 40, 20)), pose=pose),
                  {"type": "rigid", "shape": {"box": "60 40 20 mm"}, "density": "1200 kg/m^3", "pose": pose}):
        sim = make({"pad": pad, "part": small}, friction=0.8)
        sim.run(duration=0.08)
        ends.append(np.concatenate([sim.body("part").position, sim.body("pad").positions.ravel()]))
    assert ends[0][2] < 0.035
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-6)


def test_collisions_keep_momentum(tmp_path):
    # Linear momentum to rounding, angular momentum to first order in the step, because contact frames are fixed within it.
    errors = [momentum_lost(tmp_path, step) for step in ("0.2 ms", "0.05 ms")]
    assert max(linear for linear, _ in errors) < 1e-12
    assert errors[0][1] < 5e-3 and errors[1][1] < 0.4 * errors[0][1]


def momentum_lost(tmp_path, step):
    velocities = [{"linear": "1 0.1 0 m/s", "angular": "3 -5 9 rad/s"}, {"linear": "-1 0 0.2 m/s", "angular": "-7 2 1 rad/s"}]
    files = [cup(tmp_path), box(tmp_path, (20, 16, 12))]
    sim = make({"a": part(files[0], pose={"position": "-45 0 0 mm"}, velocity=velocities[0]),
                "b": part(files[1], pose={"position": "10 4 -3 mm", "rotation": "0.4 0.1 0.9 rad"}, velocity=velocities[1])},
               gravity="0 0 0 m/s^2", integrator="bdf2", time_step=step)

    def momenta():
        linear, angular = np.zeros(3), np.zeros(3)
        for name in "ab":
            body = sim.body(name)
            linear += body.mass * body.velocity[:3]
            angular += np.cross(body.centre_of_mass, body.mass * body.velocity[:3])
            w, *vector = body.rotation
            turn = Rotation.from_quat([*vector, w]).as_matrix()
            angular += turn @ body.inertia @ turn.T @ body.velocity[3:]
        return linear, angular

    before, most = momenta(), 0.0
    while sim.time < 0.04:
        sim.step()
        most = max(most, sim.contact("all-a-b").normal_force)
    after = momenta()
    assert most > 1.0
    return np.abs(after[0] - before[0]).max(), np.abs(after[1] - before[1]).max() / np.abs(before[1]).max()


def test_states_and_clones_go_on_bit_for_bit(tmp_path):
    def load(threads=1):
        return make({"cup": part(cup(tmp_path), fixed=True),
                     "part": part(box(tmp_path, (20, 16, 12)), pose={"position": "2 1 5 mm", "rotation": "0.3 0.2 0.4 rad"}),
                     "soft": {**SOFT, "mesh": block(12, 12, 8, 4), "pose": {"position": "-20 -18 -14 mm"}}},
                    solver={"threads": threads})

    one, other = load(), load(2)
    one.run(duration=0.06)
    one.save_state(tmp_path / "state")
    twin = one.clone()
    other.load_state(tmp_path / "state")
    for sim in (one, other, twin):
        sim.run(duration=0.06)
        for name in ("part", "soft"):
            assert np.array_equal(sim.body(name).positions, one.body(name).positions)
    assert one.contact("all-cup-part").normal_force > 0.0
    one.reset()
    one.run(duration=0.12)
    assert np.array_equal(one.body("part").positions, twin.body("part").positions)


def test_points_do_not_touch_the_surface_of_a_mesh(tmp_path):
    bodies = {"cup": part(cup(tmp_path), fixed=True), "soft": {**SOFT, "mesh": block(10, 10, 10, 5), "pose": {"position": "0 0 0 mm"}}}
    with pytest.raises(sinew.Error, match="whole of their surfaces|use: convex"):
        make(bodies, contacts={"touch": {"between": ["soft", "cup"], "nodes": {"set": "z_min"}}})


def test_a_rigid_mesh_does_not_touch_itself(tmp_path):
    with pytest.raises(sinew.Error, match="touch itself") as error:
        make({"cup": part(cup(tmp_path))}, contacts={"self": {"between": ["cup", "cup"]}})
    assert error.value.kind == "wrong-type"


def test_an_overlap_is_named(tmp_path):
    with pytest.raises(sinew.Error, match="overlap by 0.00[0-9]+ m"):
        make({"cup": part(cup(tmp_path), fixed=True),
              "part": part(box(tmp_path, (20, 16, 12)), pose={"position": "0 0 -10 mm"})})


@pytest.mark.parametrize("first", ["beam", "pillow"])
def test_a_law_with_more_points_than_coordinates_is_solved(first):
    # With 50 points between 31 nodes, at 1 m/s, the forces are not unique. Proximal iterations cycle in this case.
    rubber = {"model": "yeoh", "c10": "20 kPa", "c20": "1 kPa", "c30": "0.1 kPa", "poisson_ratio": 0.45,
              "viscosity": [{"relative_modulus": 0.2, "relaxation_time": "20 ms"}]}  # fmt: skip
    bodies = {
        "beam": {"type": "fem", "mesh": {"shape": "block", "length": "60 mm", "width": "20 mm", "height": "10 mm", "element_size": "10 mm"},
                 "material": rubber, "density": 1000.0, "mass_matrix": "consistent", "fixed": {"set": "x_min"}},
        "pillow": {"type": "fem", "mesh": {"shape": "block", "length": "30 mm", "width": "30 mm", "height": "30 mm", "element_size": "15 mm"},
                   "pose": {"position": "45 -5 -32.2387 mm"}, "density": 1000.0, "material": {"young_modulus": "100 kPa", "poisson_ratio": 0.3},
                   "velocity": {"linear": "0 0 1 m/s"}},
    }  # fmt: skip
    sim = sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": "backward-euler",
        "solver": {"method": "newton", "adaptive": {"tolerance": 1e-3, "smallest": "2.5 ms"}},
        "bodies": {first: bodies[first], **bodies},
        "actuators": {"push": {"type": "force", "body": "beam", "point": "54 10 5 mm", "direction": "1 1 0", "outside": "nearest",
                               "command": {"displacement": {"ramp": {"to": "0.3284 mm", "duration": "40 ms"}}}, "limits": {"force": {"min": "-2 N", "max": "2 N"}}}},
        "contacts": {"floor": {"between": ["beam", "pillow"], "friction": 0.5}},
    })  # fmt: skip
    for _ in range(3):
        sim.step()
        assert not sim.report.flagged
    assert abs(sim.contact("floor").gaps).min() < 1e-9
