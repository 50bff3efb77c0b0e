"""Zones of contact points that act as one (`aggregate`): the same forces from fewer rows."""

import copy

import numpy as np
import pytest
import sinew

SILICONE = {"model": "neo-hookean", "young_modulus": "100 kPa", "poisson_ratio": 0.45}


def pad(edge, element="tet4-patch"):
    return {"type": "fem", "element": element, "material": SILICONE, "density": "1000 kg/m^3",
            "mesh": {"shape": "block", "length": "50 mm", "width": "50 mm", "height": "20 mm", "element_size": edge},
            "fixed": {"set": "z_min"}}


def pressed(zone=None, shape={"sphere": {"radius": "20 mm"}}, height=40.1, friction=0.5, edge="2.5 mm", **changes):
    """A rigid body that is pressed 2 mm into a pad."""
    contact = {"between": ["pad", "ball"], "friction": friction}
    if zone is not None:
        contact["aggregate"] = zone
    return {
        "sinew": 1, "time_step": "10 ms", **changes,
        "bodies": {
            "pad": pad(edge),
            "ball": {"type": "rigid", "shape": shape, "mass": "10 g",
                     "pose": {"position": f"25 25 {height} mm"},
                     "motion": {"z": {"ramp": {"to": "-2.1 mm", "duration": "0.2 s"}}}}},
        "contacts": {"grip": contact}}


def rows_of(sim):
    """Number of contact force components in the last step."""
    return sim.contact_problem().W.shape[0]


def test_the_force_is_that_of_all_points():
    whole = sinew.load(pressed())
    whole.step(22)
    rows, force = rows_of(whole), whole.contact("grip").normal_force
    assert (np.array(whole.contact("grip").normal_forces) > 0).sum() > 20
    for zone, fewer in (("8 mm", 2.0), ("16 mm", 3.0)):
        sim = sinew.load(pressed(zone))
        sim.step(22)
        contact = sim.contact("grip")
        assert contact.normal_force == pytest.approx(force, rel=0.02)
        assert rows_of(sim) <= rows / fewer
        assert -3e-4 * float(zone.split()[0]) * 1e-3 < contact.gap < 0


def test_without_friction_the_forces_become_those_of_all_points():
    whole, sim = sinew.load(pressed(friction=0)), sinew.load(pressed("12 mm", friction=0))
    for each in (whole, sim):
        each.step(22)
    mine, theirs = (np.array(each.contact("grip").normal_forces) for each in (sim, whole))
    assert mine.sum() == pytest.approx(theirs.sum(), rel=2e-3)
    assert np.abs(mine - theirs).max() < 0.05 * theirs.max()


@pytest.mark.parametrize("shape, height", [({"box": "20 20 10 mm"}, 25.1), ({"cylinder": {"radius": "8 mm", "height": "10 mm"}}, 25.1)])
def test_edges_that_carry_most_do_so_in_zones(shape, height):
    """A flat punch touches with triangles; its pressure is singular at the rim."""
    whole, sim = (sinew.load(pressed(zone, shape, height, friction=0.3, edge="4 mm")) for zone in (None, "10 mm"))
    for each in (whole, sim):
        each.step(22)
    assert sim.contact("grip").normal_force == pytest.approx(whole.contact("grip").normal_force, rel=0.02)
    assert rows_of(sim) <= rows_of(whole) / 2.5


def test_deformable_bodies_touch_in_zones():
    def scene(zone):
        contact = {"between": ["pad", "block"], "friction": 0.5, **({"aggregate": zone} if zone else {})}
        block = {"type": "fem", "element": "tet4-patch", "material": SILICONE, "density": "1000 kg/m^3",
                 "mesh": {"shape": "block", "length": "23 mm", "width": "21 mm", "height": "12 mm", "element_size": "3 mm"},
                 "pose": {"position": "13 15 20.1 mm"}, "fixed": {"set": "z_max"},
                 "motion": {"z": {"ramp": {"to": "-2.1 mm", "duration": "0.2 s"}},
                          "x": {"ramp": {"to": "3 mm", "start": "0.22 s", "duration": "0.2 s"}}}}
        return {"sinew": 1, "time_step": "10 ms", "bodies": {"pad": pad("4 mm"), "block": block},
                "contacts": {"grip": contact}}

    whole, sim = sinew.load(scene(None)), sinew.load(scene("10 mm"))
    for steps in (22, 20):  # pressed, then dragged until it slides
        for each in (whole, sim):
            each.step(steps)
        one, other = sim.contact("grip").force, whole.contact("grip").force
        assert np.linalg.norm(one - other) < 0.025 * np.linalg.norm(other)
        assert rows_of(sim) <= rows_of(whole) / 3


@pytest.mark.parametrize("cells, friction, least, most", [((13, 13, 5), 0.0, 0.8, 8.0), ((13, 13, 5), 0.5, 0.1, 2.0),
                                                          ((14, 14, 6), 0.0, 0.4, 8.0), ((14, 14, 6), 0.5, 0.1, 3.0)])
@pytest.mark.parametrize("zone", ["10 mm", "20 mm"])
def test_every_step_tells_about_how_far_it_is_from_single_points(cells, friction, least, most, zone, tmp_path):
    """Compares the report with the error relative to the same scene with single points. Of the error of friction, it covers a part.

    The ball presses on the middle of a cell (odd numbers of cells) or on a node about which the mesh is symmetric. There the errors
    of zones on opposite sides are alike and add up, but the estimate of each zone holds all others: it tells half of it.
    """
    path = tmp_path / "pad.vtu"
    sinew.mesh.block((0.05, 0.05, 0.02), cells).write(path)

    def scene(given):
        result = pressed(given, friction=friction)
        result["bodies"]["pad"]["mesh"] = {"file": str(path), "unit": "m"}
        return result

    whole, sim = sinew.load(scene(None)), sinew.load(scene(zone))
    for step in range(22):
        whole.step()
        sim.step()
        assert whole.report.contact_aggregation == 0.0
        reference = np.linalg.norm(whole.contact("grip").force)
        if step < 5:
            continue
        true = np.linalg.norm(sim.contact("grip").force - whole.contact("grip").force) / reference
        assert least * true - 1e-4 < sim.report.contact_aggregation < most * true + 3e-4
    assert sim.report.contact_aggregation > 1e-5
    sim.reset()
    assert sim.report.contact_aggregation == 0.0


def test_a_grip_lifts_what_friction_can_hold():
    """Two pads press on a box and lift it: the forces equal its weight, as with single points."""
    grip = {"friction": 0.6, "aggregate": "8 mm"}

    def side(at, normal, base):
        return {"type": "fem", "material": "dragon-skin-30", "pose": {"position": at}, "fixed": {"set": normal},
                "mesh": {"shape": "block", "length": "15 mm", "width": "20 mm", "height": "20 mm", "element_size": "4 mm"},
                "motion": {"x": {"ramp": {"to": base, "duration": "0.2 s"}},
                         "z": {"ramp": {"to": "20 mm", "start": "0.25 s", "duration": "0.4 s"}}}}

    sim = sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": "backward-euler", "gravity": "0 0 -9.81 m/s^2",
        "bodies": {
            "table": {"type": "rigid", "shape": {"box": "160 80 10 mm"}, "fixed": True, "pose": {"position": "0 0 -5 mm"}},
            "box": {"type": "rigid", "shape": {"box": "40 30 40 mm"}, "mass": "100 g", "pose": {"position": "0 0 20 mm"}},
            "left": side("-36 -10 12 mm", "x_min", "2 mm"), "right": side("21 -10 12 mm", "x_max", "-2 mm")},
        "contacts": {"all": {"between": "all", **grip, "except": [["left", "right"], ["left", "left"], ["right", "right"]]}}})
    sim.run(duration=1.0)
    assert sim.body("box").position[2] == pytest.approx(0.04, abs=1e-3)
    held = sim.contact("all-box-left").force + sim.contact("all-box-right").force
    assert abs(held[2]) == pytest.approx(0.981, rel=1e-4)
    drift = sim.body("box").position[2]
    sim.run(duration=0.5)
    assert sim.body("box").position[2] == pytest.approx(drift, abs=1e-5)


@pytest.mark.parametrize("changes", [{}, {"integrator": "bdf2"}])
def test_states_clones_and_threads_go_on_bit_for_bit(tmp_path, changes):
    scene = pressed("10 mm", edge="4 mm", **changes)
    sim = sinew.load(scene)
    sim.step(12)
    sim.save_state(tmp_path / "half.state")
    clone = copy.copy(sim)
    resumed = sinew.load(scene)
    resumed.load_state(tmp_path / "half.state")
    threaded = sinew.load(scene, threads=2)
    threaded.step(12)
    runs = [sim, clone, resumed, threaded]
    for run in runs:
        run.step(8)
    for run in runs[1:]:
        assert np.array_equal(run.body("pad").positions, sim.body("pad").positions)
        assert np.array_equal(run.contact("grip").normal_forces, sim.contact("grip").normal_forces)
    other = sinew.load(pressed("9 mm", edge="4 mm", **changes))
    with pytest.raises(sinew.Error, match="grip"):
        other.load_state(tmp_path / "half.state")


def struck_cylinder(order, at, integrator, mass="2 g", edge="30 mm", **contact):
    """A tube with liquid, clamped below, that a soft cube strikes at 1 m/s: its edges and corners come and go in the
    zones. The names give the order of the bodies."""
    rubber = {"model": "neo-hookean", "shear_modulus": "40 kPa", "poisson_ratio": 0.45}
    bodies = {
        "tube": {"type": "fem", "material": rubber, "density": "1000 kg/m^3", "fixed": {"set": "bottom"},
                 "mesh": {"shape": "chambered-cylinder", "radius": "12 mm", "height": "60 mm", "chamber_radius": "5 mm",
                          "chamber_offset": "4 mm", "chamber_bottom": "10 mm", "chamber_top": "50 mm",
                          "element_size": edge}},
        "cube": {"type": "fem", "material": {"young_modulus": "100 kPa", "poisson_ratio": 0.3}, "density": "1000 kg/m^3",
                 "mesh": {"shape": "block", "length": "30 mm", "width": "30 mm", "height": "30 mm",
                          "element_size": "15 mm"},
                 "element": "tet4", "pose": {"position": at}, "velocity": {"linear": "0 1 0 m/s"}}}
    return sinew.load({
        "sinew": 1, "time_step": "5 ms", "integrator": integrator, "gravity": "-3 0 -5 m/s^2",
        "bodies": {name: bodies[name] for name in order},
        "actuators": {"liquid": {"type": "chamber", "body": "tube", "surface": {"inside": "4 0 30 mm"},
                                 "liquid": {"bulk_modulus": "1 MPa", "dead_volume": "1 ml"},
                                 "command": {"liquid": {"steps": [["0 s", "0 ml"], ["20 ms", "0.046 ml"]]}}}},
        "masses": {"hung": {"body": "tube", "point": "2 2 57 mm", "mass": mass, "outside": "nearest"}},
        "contacts": {"floor": {"between": ["tube", "cube"], **contact}}})


# The gap of a point with a force is zero up to rounding, so its sign depends on the order in which forces are summed.
@pytest.mark.filterwarnings("ignore:.*locking-element")
@pytest.mark.parametrize(("at", "mass", "integrator"), [
    ("-15 -43.2535 45 mm", "2 g", "event-driven"),
    ("-14.3 -42.9063 46 mm", "3.6 g", "event-driven"),
    ("-14.2 -43 45 mm", "2 g", "event-driven"),
    ("-15 -43.2535 45 mm", "2 g", "backward-euler"),
])
def test_the_order_of_bodies_changes_nothing(at, mass, integrator):
    one = struck_cylinder(["tube", "cube"], at, integrator, mass, aggregate="12 mm")
    other = struck_cylinder(["cube", "tube"], at, integrator, mass, aggregate="12 mm")
    for sim in (one, other):
        sim.step(6)
        assert not sim.report.flagged
    assert np.linalg.norm(one.contact("floor").force) > 0.01
    for name in ("tube", "cube"):
        assert np.abs(one.body(name).positions - other.body(name).positions).max() < 1e-10


@pytest.mark.filterwarnings("ignore:.*locking-element")
@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "event-driven"])
@pytest.mark.parametrize(("at", "mass", "zone"), [("-15 -43.2535 45 mm", "2 g", 12), ("-14.2 -43 45 mm", "2 g", 12),
                                                  ("-14.3 -42.9063 46 mm", "3.6 g", 20)])
def test_no_point_overlaps_beyond_the_bound_in_a_solved_step(at, mass, zone, integrator):
    """Twice 2e-4 of a zone, since the gaps of the law are linear."""
    sim = struck_cylinder(["tube", "cube"], at, integrator, mass, aggregate=f"{zone} mm")
    touched = 0
    for _ in range(12):
        sim.step()
        assert sim.report.status == "solved"
        gaps = np.array(sim.contact("floor").gaps)
        touched += (np.array(sim.contact("floor").normal_forces) > 0).any()
        assert np.nanmin(gaps, initial=0.0) >= -2.1 * 2e-4 * zone * 1e-3
    assert touched > 5


def test_what_has_no_zones_says_so():
    scene = pressed("5 mm")
    scene["bodies"]["pad"] = {"type": "rigid", "shape": {"box": "50 50 20 mm"}, "fixed": True,
                              "pose": {"position": "25 25 10 mm"}}
    with pytest.raises(sinew.Error, match="aggregate.*deformable"):
        sinew.load(scene)
    with pytest.raises(sinew.Error, match="positive|> 0|above 0|greater"):
        sinew.load(pressed("0 mm"))
