"""A uniform pressure between blocks of distorted elements and rigid surfaces."""

import meshio
import numpy as np
import sinew
from scipy.optimize import brentq

from reference import shapes
from suite import plots
from suite.robots import SOLVER

TITLE = "Contact patch test: uniform pressure under a rigid plate, and between two blocks"
SETUP = """A block of 40 x 40 x 20 mm with 5 x 5 x 3 distorted cells stands on rollers. A rigid surface presses on it from
above without friction: a plane that moves down by 2 mm, then a rigid plate on a slider, pressed by a motor with 20 N. The
Saint Venant-Kirchhoff law, E = 100 kPa, nu = 0.3, gives uniform stress: F = A E l (l^2 - 1)/2 with the stretch l. The nodal
forces should be the consistent loads of a uniform pressure on the element faces: a third of a triangle's area to each corner
(tet4) or to each mid-edge (tet10, none to the corners).

Two blocks of 40 x 40 x 20 mm lie on each other, nu = 0, mu = 0.3. The top of the upper one moves down by 4 mm. Their contact
faces have 4 x 4 cells each, or 4 x 4 and 5 x 5, or 6 x 6 and 7 x 7, which do not match anywhere. The displacements should be
linear."""
SOURCES = {"patch": "uniform stress; consistent loads of a pressure: O. C. Zienkiewicz, R. L. Taylor, The Finite Element Method, 6th ed. 2005, "
                    "sec. 3.3; R. L. Taylor, P. Papadopoulos, On a patch test for contact problems, 1991"}
COST = 12
POINTS = "quadratic faces make contact as four flat triangles"
SIZE, CELLS, YOUNG = np.array([0.04, 0.04, 0.02]), (5, 5, 3), 1e5


def distorted(case, element):
    """A block with randomly displaced nodes; nodes on faces stay in their faces."""
    counts = np.array(CELLS)
    grid = np.stack(np.meshgrid(*[np.arange(n + 1) for n in counts], indexing="ij"), axis=-1).reshape(-1, 3)
    inside = (grid > 0) & (grid < counts)
    points = (grid + np.where(inside, np.random.default_rng(7).uniform(-0.2, 0.2, grid.shape), 0.0)) / counts * SIZE
    number = np.arange(len(grid)).reshape(counts + 1)
    corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    cells = [[number[i + a, j + b, k + c] for a, b, c in corners]
             for i in range(counts[0]) for j in range(counts[1]) for k in range(counts[2])]
    path = shapes.write_hexahedra(case.scratch / "block.vtu", points, cells, {"top": grid[:, 2] == counts[2]})
    return path if element == "hex8" else shapes.split_into_tetrahedra(case.scratch / "split.vtu", path)


def plane_of(axis, height=0.0):
    normal = [float(axis == name) for name in "xyz"]
    return {"point": list(height * np.array(normal)), "normal": normal, "within": 1e-9}


def block(case, element):
    return {"type": "fem", "mesh": {"file": str(distorted(case, element)), "unit": "m"}, "element": element,
            "fixed": [{"plane": plane_of(axis), "axes": axis} for axis in "xyz"],
            "material": {"model": "saint-venant-kirchhoff", "young_modulus": YOUNG, "poisson_ratio": 0.3}}


def consistent(case, element, at):
    """(n,) m^2: the part of the top face at rest that belongs to each contact point, found by its position at rest."""
    path = case.scratch / ("block.vtu" if element == "hex8" else "split.vtu")
    mesh = meshio.read(path)
    top = mesh.points[:, 2] > SIZE[2] * (1.0 - 1e-9)
    outward = ((4, 5, 6, 7),) if element == "hex8" else ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))
    shares: dict[tuple, float] = {}

    def add(point, area):
        key = tuple(np.round(point[:2], 9))
        shares[key] = shares.get(key, 0.0) + area

    def cross(first, second):
        return first[0] * second[1] - first[1] * second[0]

    gauss = np.array([-1.0, 1.0]) / np.sqrt(3.0)
    for cell in mesh.cells[0].data:
        for local in outward:
            nodes = cell[list(local)]
            if not top[nodes].all():
                continue
            x = mesh.points[nodes, :2]
            if element == "hex8":
                for s in gauss:
                    for t in gauss:
                        shape = np.array([(1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t)]) / 4.0
                        along = np.array([-(1 - t), 1 - t, 1 + t, -(1 + t)]) @ x / 4.0
                        across = np.array([-(1 - s), -(1 + s), 1 + s, 1 - s]) @ x / 4.0
                        for k in range(4):
                            add(x[k], shape[k] * cross(along, across))
                continue
            area = 0.5 * abs(cross(x[1] - x[0], x[2] - x[0]))
            for k in range(3):
                add(x[k] if element == "tet4" else 0.5 * (x[k] + x[(k + 1) % 3]), area / 3.0)
    return np.array([shares.get(tuple(np.round(point[:2], 9)), 0.0) for point in at])


def force_of(stretch):
    return SIZE[0] * SIZE[1] * YOUNG * stretch * (1.0 - stretch**2) / 2.0


def scene(case, element):
    return {"sinew": 1, "time_step": 0.25, "solver": {**SOLVER, "tolerance": 1e-10}, "bodies": {"block": block(case, element)}}


TOP = {"plane": plane_of("z", SIZE[2])}


def under_a_plane(case, element):
    """Areas (m^2) and forces (N) of the nodes."""
    sim = sinew.load({**scene(case, element), "contacts": {"press": {
        "body": "block", "nodes": TOP, "surface": {"plane": {"point": [0, 0, SIZE[2]], "normal": [0, 0, -1]}},
        "motion": {"z": {"ramp": {"to": -0.1 * SIZE[2], "duration": 1.0}}}}}})
    contact = sim.contact("press")
    share = consistent(case, element, np.asarray(contact.positions))
    sim.step(4)
    forces, wanted = np.asarray(contact.normal_forces), force_of(0.9)
    case.identity(f"{element}: force under the plane / closed form - 1", abs(forces.sum() / wanted - 1.0), 1e-8, source="patch")
    case.identity(f"{element}: largest error of a nodal force / largest force",
                  np.abs(forces - share * wanted / share.sum()).max() / forces.max(), 1e-7, source="patch")
    return share, forces


def under_a_plate(case, element, force=20.0):
    plate = {"type": "rigid", "shape": {"box": [0.1, 0.1, 0.01]}, "mass": 0.1, "pose": {"position": [0.02, 0.02, 0.025]}}
    start = scene(case, element)
    sim = sinew.load({
        **start, "bodies": {**start["bodies"], "plate": plate},
        "joints": {"guide": {"type": "slider", "bodies": ["world", "plate"], "point": [0.02, 0.02, 0.025], "axis": [0, 0, -1]}},
        "actuators": {"motor": {"type": "linear-motor", "joint": "guide", "command": {"force": {"ramp": {"to": force, "duration": 1.0}}}}},
        "contacts": {"press": {"between": ["block", "plate"], "nodes": TOP}}})
    sim.step(4)
    way = sim.joint("guide").displacement
    stretch = brentq(lambda stretch: force_of(stretch) - force, 0.7, 1.0)
    case.identity(f"{element}: displacement of the plate under its motor / closed form - 1", abs(way / ((1.0 - stretch) * SIZE[2]) - 1.0), 1e-8,
                  source="patch")
    uneven = float(np.ptp(np.asarray(sim.contact("press").positions)[:, 2]))
    case.bound(f"{element}: unevenness of the face under the plate / displacement", uneven / way, 1e-8, source="patch")


def half(element, cells, height, face, **more):
    return {"type": "fem", "element": element, "density": 1000.0, "pose": {"position": [0, 0, height]}, "fixed": {"set": face}, **more,
            "mesh": {"shape": "block", "length": SIZE[0], "width": SIZE[1], "height": SIZE[2], "element_size": SIZE[0] / cells},
            "material": {"model": "saint-venant-kirchhoff", "young_modulus": YOUNG, "poisson_ratio": 0.0}}


def between_blocks(case, element):
    """Errors of the displacement / displacement of the top, for non-matching meshes."""
    way, errors = 0.2 * SIZE[2], []
    for cells in ((4, 4), (4, 5), (6, 7)):
        sim = sinew.load({
            "sinew": 1, "time_step": 0.25, "solver": {**SOLVER, "tolerance": 1e-10},
            "bodies": {"low": half(element, cells[0], 0.0, "z_min"),
                       "up": half(element, cells[1], SIZE[2], "z_max", motion={"z": {"ramp": {"to": -way, "duration": 1.0}}})},
            "contacts": {"cut": {"between": ["low", "up"], "friction": 0.3}}})
        sim.step(4)
        displaced, spread = 0.0, 0.0
        for name in ("low", "up"):
            body = sim.body(name)
            rest = np.asarray(body.rest_positions)
            displaced = max(displaced, np.abs(body.positions[:, 2] - 0.9 * rest[:, 2]).max() / way)
            stress = np.asarray(body.element_field("von_mises_stress"))
            spread = max(spread, np.abs(stress / stress.mean() - 1.0).max())
        known = POINTS if element == "tet10" and cells != (4, 4) else ""
        name = f"{element}, {cells[0]} x {cells[0]} on {cells[1]} x {cells[1]} cells"
        case.bound(f"{name}: error of the displacement / imposed displacement", displaced, 1e-6, source="patch", known_miss=known)
        case.bound(f"{name}: spread of the stress / its mean", spread, 1e-6, source="patch", known_miss=known)
        case.identity(f"{name}: force / closed form - 1", abs(sim.contact("cut").normal_force / force_of(0.9) - 1.0), 2e-6,
                      source="patch", known_miss=known)
        errors.append(displaced)
    return errors


def run(case):
    figure, (axis, blocks) = plots.axes(2)
    for element, color in (("hex8", plots.OURS), ("tet10", plots.SECOND), ("tet4", plots.THIRD)):
        share, forces = under_a_plane(case, element)
        under_a_plate(case, element)
        axis.plot(1e6 * share, forces, "o", ms=3, color=color, label=element)
        blocks.semilogy(range(3), between_blocks(case, element), "o-", ms=4, color=color, label=element)
    area = np.linspace(0.0, 1.1 * share.max(), 2)
    axis.plot(1e6 * area, area * force_of(0.9) / (SIZE[0] * SIZE[1]), color=plots.REFERENCE, lw=1, label="uniform pressure")
    axis.set(xlabel="area of a node (mm^2)", ylabel="its force (N)")
    axis.legend()
    blocks.axhline(1e-6, color=plots.REFERENCE, lw=1, label="asked")
    blocks.set(xticks=range(3), xticklabels=("4 on 4", "4 on 5", "6 on 7"), xlabel="cells along a side", ylabel="error of the displacement / imposed displacement")
    blocks.legend()
    case.figure(figure, "Left: nodal forces under a plane against the areas of the nodes. Right: blocks on each other.")
