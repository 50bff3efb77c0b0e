"""Forces that equilibrium leaves open: grips, tables, ropes."""

import numpy as np
import pytest
import sinew

GRIP = """
sinew: 1
time_step: 5 ms
integrator: {integrator}
gravity: 0 0 -9.81 m/s^2
bodies:
  {cube}: {{type: rigid, shape: {{box: 40 40 40 mm}}, mass: 100 g, pose: {{position: 0 0 100 mm}}}}
  {left}: {{type: rigid, shape: {{box: 10 {width} 60 mm}}, mass: 50 g, pose: {{position: -25 0 100 mm}}}}
  {right}: {{type: rigid, shape: {{box: 10 {width} 60 mm}}, mass: 50 g, pose: {{position: 25 0 100 mm}}}}
joints:
  a: {{type: slider, bodies: [world, {left}], point: -25 0 100 mm, axis: x}}
  b: {{type: slider, bodies: [world, {right}], point: 25 0 100 mm, axis: x}}
actuators:
  fa: {{type: linear-motor, joint: a, command: {{force: {force} N}}}}
  fb: {{type: linear-motor, joint: b, command: {{force: -{force} N}}}}
contacts:
  l: {{between: [{left}, {cube}], friction: 0.5}}
  r: {{between: [{right}, {cube}], friction: 0.5}}
"""
NEEDED = 0.1 * 9.81 / 2 / 0.5


def grip(factor, width=20, integrator="backward-euler", names=("cube", "left", "right")):
    cube, left, right = names
    return sinew.loads(
        GRIP.format(integrator=integrator, cube=cube, left=left, right=right, width=width, force=factor * NEEDED)
    )


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
@pytest.mark.parametrize("width", [20, 60])
@pytest.mark.parametrize("factor", [1.02, 1.1, 1.5, 4])
def test_a_symmetric_grip_holds(integrator, width, factor):
    """Before, whether friction held followed from rounding: the cube turned by up to 137 degrees."""
    simulation = grip(factor, width, integrator)
    corners = None
    for _ in range(100):
        simulation.step()
        own = np.sort([force for force in simulation.contact("l").normal_forces if force > 0])
        if corners is None:
            corners = own
            np.testing.assert_allclose(own, factor * NEEDED / 4, rtol=1e-9)
        np.testing.assert_allclose(own, corners, rtol=1e-9)
    cube = simulation.body("cube")
    assert abs(cube.position[2] - 0.1) < 1e-9
    assert np.linalg.norm(cube.rotation[1:]) < 1e-9


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
@pytest.mark.parametrize("width", [20, 60])
@pytest.mark.parametrize("factor", [1.02, 1.1, 2, 4])
def test_a_symmetric_grip_holds_for_ten_seconds(integrator, width, factor):
    """With large steps: in one of 50 ms, a cube that falls has fallen by 12 mm."""
    text = GRIP.format(integrator=integrator, cube="cube", left="left", right="right", width=width, force=factor * NEEDED)
    simulation = sinew.loads(text.replace("time_step: 5 ms", "time_step: 50 ms"))
    cube = simulation.body("cube")
    for _ in range(20):
        simulation.step(10)
        assert simulation.report.status == "solved"
        assert np.abs(cube.position - [0, 0, 0.1]).max() < 1e-4
        assert 2 * np.degrees(np.arcsin(np.linalg.norm(cube.rotation[1:]))) < 0.1
    assert simulation.time == pytest.approx(10)


def test_a_weak_grip_lets_the_cube_fall_straight():
    simulation = grip(0.8)
    for _ in range(15):  # 6 mm: the faces still overlap as at the start
        simulation.step()
    cube = simulation.body("cube")
    time = simulation.time
    assert 0.1 - cube.position[2] == pytest.approx(0.2 * 9.81 * time * (time + 0.005) / 2, rel=1e-6)
    assert np.linalg.norm(cube.rotation[1:]) < 1e-6


def test_names_and_order_do_not_matter():
    one, other = grip(1.05), grip(1.05, names=("z", "b", "a"))
    for _ in range(5):
        one.step()
        other.step()
    np.testing.assert_allclose(one.contact("l").normal_forces, other.contact("l").normal_forces, rtol=1e-9)


def test_a_restored_grip_goes_on_bit_for_bit(tmp_path):
    simulation = grip(1.05)
    for _ in range(5):
        simulation.step()
    simulation.save_state(tmp_path / "state.h5")
    again = grip(1.05)
    again.load_state(tmp_path / "state.h5")
    for _ in range(5):
        simulation.step()
        again.step()
        assert np.array_equal(simulation.contact("l").normal_forces, again.contact("l").normal_forces)


ROPES = """
sinew: 1
time_step: 5 ms
integrator: {integrator}
gravity: 0 0 -9.81 m/s^2
bodies:
  frame: {{type: rigid, shape: {{box: 2 2 0.02 m}}, fixed: true, pose: {{position: 0 0 1 m}}}}
  plate: {{type: rigid, shape: {{box: 200 200 20 mm}}, mass: 2 kg, pose: {{position: 0 0 0 m}}}}
actuators:
  c1: {{type: cable, body: frame, points: [0.9 0.9 0.99 m, {{body: plate, point: 100 100 10 mm}}], command: {{displacement: 0 mm}}}}
  c2: {{type: cable, body: frame, points: [-0.9 0.9 0.99 m, {{body: plate, point: -100 100 10 mm}}], command: {{displacement: 0 mm}}}}
  c3: {{type: cable, body: frame, points: [-0.9 -0.9 0.99 m, {{body: plate, point: -100 -100 10 mm}}], command: {{displacement: 0 mm}}}}
  c4: {{type: cable, body: frame, points: [0.9 -0.9 0.99 m, {{body: plate, point: 100 -100 10 mm}}], command: {{displacement: 0 mm}}}}
"""


@pytest.mark.parametrize("integrator", ["backward-euler", "bdf2", "generalized-alpha"])
def test_four_ropes_share_the_load(integrator):
    """Before, they went from 7.49 N each to 8.91 and 6.07."""
    simulation = sinew.loads(ROPES.format(integrator=integrator))
    expected = 2 * 9.81 / 4 / (0.98 / np.linalg.norm([0.8, 0.8, 0.98]))
    for _ in range(300):
        simulation.step()
        tensions = [simulation.actuator(f"c{k}").tension for k in (1, 2, 3, 4)]
        np.testing.assert_allclose(tensions, expected, rtol=1e-9)


TABLE = """
sinew: 1
time_step: 2 ms
integrator: backward-euler
gravity: 0 0 -9.81 m/s^2
bodies:
  floor: {{type: rigid, shape: {{plane: {{}}}}, fixed: true}}
  {bodies}
contacts:
  all: {{between: all, friction: 0.5}}
"""


def box(name, z, mass=1):
    return f"{name}: {{type: rigid, shape: {{box: 100 100 100 mm}}, mass: {mass} kg, pose: {{position: 0 0 {z} mm}}}}"


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 0, 1), (1, 2, 0)])
def test_a_stack_stands_on_its_corners_alike(order):
    bodies = [box(name, 50 + 100 * k) for k, name in enumerate("abc")]
    simulation = sinew.loads(TABLE.format(bodies="\n  ".join(bodies[k] for k in order)))
    for _ in range(200):
        simulation.step()
        carried = []
        for contact in simulation.contacts.values():
            forces = [force for force in contact.normal_forces if force > 0]
            if not forces:
                continue
            assert len(forces) == 4
            carried.append(forces[0])
            np.testing.assert_allclose(forces, forces[0], rtol=1e-9)
        np.testing.assert_allclose(sorted(carried), np.array([1, 2, 3]) * 9.81 / 4, rtol=1e-9)


def test_a_table_with_a_load_aside_has_a_linear_pressure():
    """Least norm under a plate is the pressure of equal springs: N = a + b x + c y."""
    simulation = sinew.loads(
        """
sinew: 1
time_step: 2 ms
integrator: backward-euler
gravity: 0 0 -9.81 m/s^2
bodies:
  top: {type: rigid, shape: {box: 400 400 20 mm}, mass: 4 kg, pose: {position: 0 0 10 mm}}
  load: {type: rigid, shape: {box: 20 20 20 mm}, mass: 1 kg, pose: {position: 50 30 30 mm}}
contacts:
  floor:
    body: top
    surface: {plane: {}}
    points: [-200 -200 0 mm, 200 -200 0 mm, -200 200 0 mm, 200 200 0 mm, 0 -200 0 mm, 0 200 0 mm]
    friction: 0.3
joints:
  glued: {type: weld, bodies: [top, load]}
"""
    )
    for _ in range(5):
        simulation.step()
    at = np.array(simulation.contact("floor").positions)[:, :2]
    rows = np.column_stack([np.ones(len(at)), at])
    load = 9.81 * np.array([4 + 1, 0.05, 0.03])
    expected = rows @ np.linalg.solve(rows.T @ rows, load)
    np.testing.assert_allclose(simulation.contact("floor").normal_forces, expected, rtol=1e-9)
