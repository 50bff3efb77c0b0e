"""Contacts in Python."""

import numpy as np
import pytest

import sinew

WEIGHT = 1000.0 * 0.04 * 0.04 * 0.02 * 9.81


def block(friction=0.5, angle=0.0, floor=0.0, held={}, **more):
    return sinew.load({
        "sinew": 1, "integrator": "backward-euler", "time_step": "1 ms",
        "gravity": [9.81 * np.sin(angle), 0.0, -9.81 * np.cos(angle)],
        "bodies": {"block": {
            "type": "fem", "density": 1000.0, "damping": {"stiffness": "2 ms"},
            "material": {"young_modulus": "1 MPa", "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.02, "element_size": 0.01}, **held}},
        "contacts": {"floor": {"body": "block", "nodes": {"set": "z_min"}, "friction": friction,
                               "surface": {"plane": {"point": [0.0, 0.0, floor]}}}}, **more})


def test_resting_block():
    sim = block()
    sim.step(400)
    floor = sim.contact("floor")
    assert sim.contacts["floor"].name == "floor"
    assert floor.friction == 0.5
    assert floor.normal_force == pytest.approx(WEIGHT, rel=1e-6)
    assert floor.force == pytest.approx([0.0, 0.0, WEIGHT], abs=1e-6 * WEIGHT)
    assert floor.normal_forces.sum() == pytest.approx(floor.normal_force)
    assert floor.friction_forces.shape == floor.positions.shape == floor.normals.shape == (25, 3)
    assert abs(floor.gap) < 1e-9 and abs(floor.gaps).max() < 1e-9
    assert len(floor.states) == 25 and set(floor.states) <= {"stick", "slip", "open"}
    assert "floor" in repr(floor)


def test_sliding_block_is_recorded():
    angle = 0.8
    sim = block(angle=angle)
    run = sim.run(1.0)
    assert run["floor.force"].shape == (1001, 3)
    assert run["floor.normal_force"][-1] == pytest.approx(WEIGHT * np.cos(angle), rel=1e-3)
    assert run["floor.gap"][-1] == pytest.approx(0.0, abs=1e-9)
    speed = sim.body("block").velocities[:, 0].mean()
    assert speed == pytest.approx(9.81 * (np.sin(angle) - 0.5 * np.cos(angle)), rel=2e-3)
    assert set(sim.contact("floor").states) <= {"slip", "open"}


def test_errors():
    sim = block()
    with pytest.raises(sinew.Error) as error:
        sim.contact("flor")
    assert error.value.kind == "unknown-name"
    with pytest.raises(sinew.Error) as error:
        sim.follow_path()
    assert error.value.kind == "not-in-this-version"


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_path_onto_a_floor(friction):
    """A block hangs from its top; a growing body force pulls it onto the floor."""
    sim = block(friction=friction, floor=-2e-5, held={"fixed": {"set": "z_max"}}, loads={
        "draw": {"type": "acceleration", "body": "block", "acceleration": [0.0, 0.0, -2000.0]}})
    path = sim.follow_path(first_step=1e-4, largest_step=1e-3)
    assert 1.0 <= path["load_fraction"][-1] <= 1.1
    assert not path["negative_pivots"].any()
    floor = sim.contact("floor")
    pressed, states = floor.normal_forces, floor.states
    assert floor.gaps.min() > -1e-9 and floor.normal_force > 1.0
    assert np.all(np.linalg.norm(floor.friction_forces, axis=1) <= friction * pressed * (1.0 + 1e-9))
    assert all((state == "open") == (force == 0.0) for state, force in zip(states, pressed))
    sim.load("draw").factor = float(path["load_fraction"][-1])
    sim.solve_static()
    assert sim.contact("floor").normal_forces == pytest.approx(pressed, abs=1e-6 * pressed.sum())


def whole_block(**contact):
    """A block on the floor whose surface nodes may all touch it. Returns the simulation and the nodes of the lower face."""
    sim = block(contacts={"floor": {"body": "block", "friction": 0.5, "surface": {"plane": {}}, **contact}})
    sim.step(100)
    return sim, [k for k, z in enumerate(sim.contact("floor").positions[:, 2]) if z < 1e-3]


def test_linearisation_has_the_points_that_take_part():
    sim, lower = whole_block()
    floor, before, last = sim.contact("floor"), sim.state(), sim.last_linearisation()
    linear = sim.linearise(statics=False)
    assert sim.state() == before
    assert len(lower) == 25 < len(floor.states)
    assert linear.rows == [f"floor point {k} {way}" for k in lower for way in ("normal", "tangent 1", "tangent 2")]
    at = [sim.rows.index(row) for row in linear.rows]
    every = sim.compliance(statics=False)
    assert every.shape == (len(sim.rows), len(sim.rows))
    assert linear.W == pytest.approx(every[np.ix_(at, at)], abs=1e-12 * every.max())
    assert np.array_equal(linear.effort[::3], floor.normal_forces[lower])
    assert linear.delta[::3] == pytest.approx(floor.gaps[lower], abs=1e-12)
    assert last.rows == linear.rows


def same(one, other):
    return one.rows == other.rows and all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("W", "delta", "delta_free", "effort"))


def test_queries_leave_the_last_linearisation_as_it_was():
    sim, _ = whole_block()
    last = sim.last_linearisation()
    assert not same(last, sim.linearise(statics=False))
    for ask in (sim.linearise, sim.compliance):
        ask(statics=False)
        assert same(sim.last_linearisation(), last)
    with pytest.raises(sinew.RunError, match="singular"):
        sim.linearise()  # singular in statics, because nothing holds the block
    assert same(sim.last_linearisation(), last)
    sim.step()
    after = sim.last_linearisation()
    other, _ = whole_block()
    other.step()
    assert same(after, other.last_linearisation())


def test_states_have_no_last_linearisation(tmp_path):
    sim, _ = whole_block()
    state = sim.state()
    sim.save_state(tmp_path / "state")
    for take_up in (lambda: sim.restore(state), lambda: sim.load_state(tmp_path / "state"), sim.reset):
        sim.step()
        sim.last_linearisation()
        take_up()
        with pytest.raises(sinew.Error, match="no step led to this state.*linearise") as error:
            sim.last_linearisation()
        assert error.value.kind == "bad-argument"
        sim.linearise(statics=False)  # a query does not count as a step
        with pytest.raises(sinew.Error, match="no step led"):
            sim.last_linearisation()


def test_linearisation_of_zones_has_their_sums():
    sim, lower = whole_block(aggregate=0.02)
    last = sim.last_linearisation()
    linear = sim.linearise(statics=False)
    assert 0 < len(linear.rows) < 3 * len(lower)
    for each in (linear, last):
        normals = [k for k, row in enumerate(each.rows) if row.endswith("normal")]
        assert each.effort[normals].sum() == pytest.approx(sim.contact("floor").normal_force, rel=1e-12)


@pytest.mark.parametrize("floor", [0.0, -0.05])
def test_compliance_has_every_point(floor):
    sim = block(floor=floor)
    compliance = sim.compliance(statics=False)
    assert compliance.shape == (75, 75)
    assert np.diag(compliance).min() > 0.0
    far = block(floor=-0.05)
    assert compliance == pytest.approx(far.compliance(statics=False), abs=1e-6 * compliance.max())


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "quasi-static"])
def test_a_plane_is_a_body_that_all_others_touch(integrator, tmp_path):
    # Both scenes have the same contacts: a tilted floor that rises, under a soft and a rigid block.
    tilt = np.radians(5.0)
    rises = {"z": {"ramp": {"to": "2 mm", "duration": "50 ms"}}}
    soft = {"type": "fem", "mesh": {"shape": "block", "length": "30 mm", "width": "30 mm", "height": "15 mm", "element_size": "10 mm"},
            "pose": {"position": "0 0 0.2 mm"}, "material": "dragon-skin-30", "element": "hex8"}  # fmt: skip
    if integrator == "quasi-static":
        soft["fixed"] = {"box": "-1 -1 15 31 31 16 mm"}
    bodies = {"soft": soft}
    if integrator != "quasi-static":
        bodies["hard"] = {"type": "rigid", "shape": {"box": "20 20 20 mm"}, "density": "900 kg/m^3", "pose": {"position": "60 10 12 mm"}}
    ground = {"type": "rigid", "shape": {"plane": {}}, "motion": rises, "pose": {"rotation": {"axis": "0 1 0", "angle": "5 deg"}}}
    world = {"sinew": 1, "gravity": "0 0 -9.81 m/s^2", "integrator": integrator, "time_step": "5 ms", "solver": {"tolerance": 1e-12}}
    named = sinew.load({**world, "bodies": {"ground": ground, **bodies}, "contacts": {"all": {"between": "all", "friction": 0.4, "except": [["soft", "soft"], ["soft", "hard"]][: len(bodies)]}}})  # fmt: skip
    surface = {"plane": {"normal": [np.sin(tilt), 0.0, np.cos(tilt)]}}
    apart = sinew.load({**world, "bodies": bodies, "contacts": {name: {"body": name, "surface": surface, "motion": rises, "friction": 0.4} for name in bodies}})  # fmt: skip
    assert set(named.bodies) == set(bodies) and list(named.contacts) == [f"all-{name}-ground" for name in bodies]
    contact = named.contact("all-soft-ground")
    assert contact.bodies == ["soft"] and set(contact.surface) == {"plane"}
    assert contact.surface["plane"]["normal"] == pytest.approx(surface["plane"]["normal"], abs=1e-15)
    largest = 0.0
    for _ in range(30):
        named.step()
        apart.step()
        largest = max(largest, contact.normal_force)
    assert largest > 0.1
    assert contact.force == pytest.approx(apart.contact("soft").force, rel=1e-9, abs=1e-9)
    assert named.body("soft").positions == pytest.approx(apart.body("soft").positions, abs=1e-12)
    if "hard" in bodies:
        assert named.body("hard").position == pytest.approx(apart.body("hard").position, abs=1e-12)
    # A clone and a saved state know the plane.
    clone = named.clone()
    named.save_state(tmp_path / "state")
    named.step(5)
    clone.step(5)
    assert (clone.body("soft").positions == named.body("soft").positions).all()
    (tmp_path / "scene.yaml").write_text(named.to_yaml())
    again = sinew.load(tmp_path / "scene.yaml")
    again.load_state(tmp_path / "state")
    again.step(5)
    assert (again.body("soft").positions == named.body("soft").positions).all()
