"""Forces of contact at rest depend neither on the time step nor on the order of a mesh's nodes and elements."""

import itertools

import meshio
import numpy as np
import pytest
import sinew

GRAVITY = 9.81
STEPS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)  # s
CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
TURNS = ((0, 1, 2, 3), (1, 2, 0, 3), (2, 0, 1, 3), (1, 0, 3, 2), (3, 2, 1, 0))  # even permutations of a tetrahedron's nodes


def grid(size, origin, cells, kind):
    """Nodes and elements of a block (m) of hexahedra, or of six tetrahedra per cell."""
    lines = [np.linspace(0.0, length, count + 1) for length, count in zip(size, cells)]
    points = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3) + origin
    number = np.arange(len(points)).reshape(np.add(cells, 1))
    elements = []
    for cell in itertools.product(*map(range, cells)):
        if kind == "hexahedron":
            elements.append([number[tuple(np.add(cell, corner))] for corner in CORNERS])
            continue
        for way in itertools.permutations(np.eye(3, dtype=int)):
            path = [np.array(cell), *(np.cumsum(way, axis=0) + cell)]
            nodes = [number[tuple(at)] for at in path]
            even = np.linalg.det(np.array(way)) > 0
            elements.append(nodes if even else [nodes[0], nodes[2], nodes[1], nodes[3]])
    return points, np.array(elements)


def write(path, size, origin, cells, kind="tetra", seed=None):
    """Writes a grid() with shuffled nodes and elements. Returns the original node numbers in the order of the file."""
    points, elements = grid(size, origin, cells, kind)
    order = np.arange(len(points))
    if seed is not None:
        random = np.random.default_rng(seed)
        order = random.permutation(len(points))
        elements = np.argsort(order)[elements][random.permutation(len(elements))]
        if kind == "tetra":
            turns = np.array(TURNS)[random.integers(len(TURNS), size=len(elements))]
            elements = np.take_along_axis(elements, turns, axis=1)
    meshio.write_points_cells(path, points[order], [(kind, elements)])
    return order


def body(path, young, element="tet4", **more):
    return {"type": "fem", "element": element, "mesh": {"file": str(path), "unit": "m"}, "density": 1000.0,
            "material": {"model": "neo-hookean", "young_modulus": young, "poisson_ratio": 0.3}, **more}


def held(height):
    return [{"plane": {"point": [0, 0, height], "normal": [0, 0, 1], "within": 1e-9}}]


def at_rest(folder, step, on, friction, slope, **more):
    """A cube of 5 mm at rest; critical damping takes less than 1 ms. `more` are settings of the cube."""
    write(folder / "top.vtu", (5e-3, 5e-3, 5e-3), (1.3e-3, 1.7e-3, 0.0), (2, 2, 2))
    damping = {"damping": {"stiffness": 3e-4}}
    bodies = {"top": body(folder / "top.vtu", 1e6, **damping, **more)}
    contact = {"body": "top", "surface": {"plane": {}}, "friction": friction}
    if on == "block":
        write(folder / "low.vtu", (8e-3, 8e-3, 3e-3), (0.0, 0.0, -3e-3), (3, 3, 1))
        bodies["low"] = body(folder / "low.vtu", 1e6, fixed=held(-3e-3), **damping)
        contact = {"between": ["top", "low"], "friction": friction}
    angle = np.arctan(slope)
    sim = sinew.load({"sinew": 1, "time_step": step, "integrator": "backward-euler", "solver": {"ordering": "amd"}, "bodies": bodies,
                      "contacts": {"rest": contact}, "gravity": [GRAVITY * np.sin(angle), 0.0, -GRAVITY * np.cos(angle)]}, threads=1)
    sim.step(max(40, round(8e-3 / step)))
    return sim


@pytest.mark.parametrize("on, tolerance", [("plane", 1e-7), ("block", 1e-6)])
def test_friction_at_rest_is_the_same_for_any_time_step(tmp_path, on, tolerance):
    """A block sticks on a slope of 0.3. The tolerance, relative to the weight, is for its remaining motion."""
    angle = np.arctan(0.3)
    for step in STEPS:
        sim = at_rest(tmp_path, step, on, 0.5, 0.3)
        weight = sim.body("top").mass * GRAVITY
        force = sim.contact("rest").force
        assert np.abs(force / weight - [-np.sin(angle), 0.0, np.cos(angle)]).max() < tolerance, step
        assert "stick" in sim.contact("rest").states
        assert np.abs(sim.body("top").velocities).max() < 1e-6


@pytest.mark.parametrize("on", ["plane", "block"])
def test_normal_forces_and_shape_at_rest_are_the_same_for_any_time_step(tmp_path, on):
    """Without friction, the shape at rest is unique if the block cannot slide: its top is guided along z."""
    reference, guided = None, {"fixed": [{"plane": {"point": [0, 0, 5e-3], "normal": [0, 0, 1], "within": 1e-9}, "axes": ["x", "y"]}]}
    for step in STEPS[::-1]:
        sim = at_rest(tmp_path, step, on, 0.0, 0.0, **guided)
        top = sim.body("top")
        weight = top.mass * GRAVITY
        loads = top.internal_forces()[:, 2] / weight
        assert sim.contact("rest").force[2] == pytest.approx(weight, rel=1e-6)
        if reference is None:
            reference = loads, top.positions[:, 2]
        assert loads == pytest.approx(reference[0], abs=1e-6)
        assert top.positions[:, 2] == pytest.approx(reference[1], abs=1e-6 * 8e-8)  # the block sinks by 80 nm
    # The forces differ from node to node; equal nodal forces would pass trivially.
    assert np.ptp(reference[0]) > 0.05


class Dragged:
    """A block that is pressed on a wider one, or on a plane, and dragged over it; a seed shuffles the meshes."""

    def __init__(self, folder, kind, friction, on, seed=None):
        self.orders = {"top": write(folder / "top.vtu", (0.02, 0.02, 0.02), (0.0073, 0.0091, 0.0201), (4, 4, 4), kind, seed)}
        motion = {"z": {"ramp": {"to": -1.5e-3, "duration": 0.1}}, "x": {"ramp": {"to": 1e-3, "start": 0.1, "duration": 0.1}}}
        element = "hex8" if kind == "hexahedron" else "tet4"
        bodies = {"top": body(folder / "top.vtu", 2e5, element, fixed=held(0.0401), motion=motion)}
        contact = {"body": "top", "surface": {"plane": {"point": [0, 0, 0.02]}}, "friction": friction}
        if on == "block":
            self.orders["low"] = write(folder / "low.vtu", (0.04, 0.04, 0.02), (0.0, 0.0, 0.0), (5, 5, 3), kind, None if seed is None else seed + 100)
            bodies["low"] = body(folder / "low.vtu", 2e5, element, fixed=held(0.0))
            contact = {"between": ["low", "top"], "friction": friction}
        self.sim = sinew.load({"sinew": 1, "time_step": 0.01, "solver": {"ordering": "amd", "tolerance": 1e-12}, "bodies": bodies,
                               "contacts": {"press": contact}}, threads=1)

    def results(self):
        """Contact force, and nodal positions and forces in the original order, when pressed and after sliding has begun."""
        found = []
        for steps in (10, 10):
            self.sim.step(steps)
            at, force = [], []
            for name, order in self.orders.items():
                back = np.argsort(order)
                at.append(self.sim.body(name).positions[back])
                force.append(self.sim.body(name).internal_forces()[back])
            found.append((np.array(self.sim.contact("press").force), np.vstack(at), np.vstack(force)))
        return found


def differences(one, other):
    """Largest differences of contact force, nodal positions and nodal forces, relative to the force and to 1.5 mm."""
    size = np.linalg.norm(one[0])
    return np.abs(one[0] - other[0]).max() / size, np.abs(one[1] - other[1]).max() / 1.5e-3, np.abs(one[2] - other[2]).max() / size


@pytest.mark.parametrize("on", ["plane", "block"])
@pytest.mark.parametrize("friction", [0.0, 0.5])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_order_of_nodes_and_elements_changes_nothing(tmp_path, on, friction, seed):
    """The contact law is solved to 1e-10, and friction accumulates the differences."""
    given, shuffled = (Dragged(tmp_path, "tetra", friction, on, number) for number in (None, seed))
    assert not np.array_equal(shuffled.orders["top"], given.orders["top"])
    for one, other in zip(given.results(), shuffled.results()):
        assert np.linalg.norm(one[0]) > 1.0
        assert max(differences(one, other)) < 1e-9


@pytest.mark.parametrize("on, tolerance", [("plane", 1e-8), ("block", 1e-8)])
def test_the_order_of_hexahedra_changes_nothing(tmp_path, on, tolerance):
    """Quadrilaterals are split by geometry (the shorter diagonal), not by node order. Differences: ten laws, each solved to 1e-10."""
    given, shuffled = (Dragged(tmp_path, "hexahedron", 0.5, on, number) for number in (None, 2))
    for one, other in zip(given.results(), shuffled.results()):
        force, position, _ = differences(one, other)
        assert force < tolerance
        assert position < tolerance
