"""Semicircular arches of rigid stones: which stand and which fall."""

import numpy as np
import sinew
from scipy.optimize import linprog

from suite import plots

TITLE = "Arches of 25 stones: least thickness and least friction"
SETUP = """A semicircular arch of 25 equal stones stands on a fixed plate. The radius to the middle of the ring is R = 250 mm,
the density 2300 kg/m^3. The stones are triangle hulls with flat faces and radial joints, so their rims touch. Steps are 10
ms, backward Euler.

The reference is a linear program with three forces per joint. It looks for forces that balance every stone, press each joint
within its height and lie in the friction cone. If there are none, the arch must fall. If there are some and the joints are
not about to slip, the arch stands (Heyman's safe theorem). The program gives the least t/R, with t the thickness. For many
equal stones it tends to Milankovitch's 0.1075. With 25 stones it is slightly smaller, because hinges can open only at joints.

An arch stands if it creeps by less than 1e-6 R between 0.1 s and ten seconds, and falls if it moves by 0.05 R in that time.
The least friction of a thick arch is bracketed in the same way. Coulomb's friction is not associated, so the program is
certain only about the fall below this value. With mu = 0.2, the largest overlap of the stones is recorded during 30 ms of
falling in steps of 1 ms."""
SOURCES = {"Milankovitch": "M. Milankovitch, Theorie der Druckkurven, Z. Math. Phys. 55 (1907) 1-27: t/R = 0.1075",
           "limit analysis": "J. Heyman, The stone skeleton, Int. J. Solids Struct. 2 (1966) 249-279; R. K. Livesley, Limit analysis of "
                             "structures formed from rigid blocks, Int. J. Numer. Meth. Eng. 12 (1978) 1853-1871: the linear program",
           "Coulomb": "contact with friction: no creep at rest, no overlap"}
COST = 20
G, RADIUS, COUNT, DEPTH, DENSITY = 9.81, 0.25, 25, 0.05, 2300.0


def corners(k, count, thickness):
    """Corners (4, 2) of a stone: x and z in m, counter-clockwise seen along y."""
    angles = np.pi * np.array([k, k + 1]) / count
    ray = np.column_stack([np.cos(angles), np.sin(angles)])
    inner, outer = RADIUS - 0.5 * thickness, RADIUS + 0.5 * thickness
    return np.array([inner * ray[0], outer * ray[0], outer * ray[1], inner * ray[1]])


def area_and_centre(points):
    following = np.roll(points, -1, axis=0)
    cross = points[:, 0] * following[:, 1] - following[:, 0] * points[:, 1]
    return 0.5 * cross.sum(), ((points + following) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum())


def admissible(thickness, friction, count=COUNT):
    """Whether joint forces exist that balance all stones. Unknowns per joint: pressures at its inner and outer end, shear."""
    joints = count + 1
    balance, weight = np.zeros((3 * count, 3 * joints)), np.zeros(3 * count)
    for k in range(count):
        area, centre = area_and_centre(corners(k, count, thickness))
        weight[3 * k + 1] = area
        for joint, sense in ((k, 1.0), (k + 1, -1.0)):
            angle = np.pi * joint / count
            ray, along = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
            # All stones are equally thick.
            half = 0.5 * thickness
            for column, at, force in ((0, (RADIUS - half) * ray, along), (1, (RADIUS + half) * ray, along), (2, RADIUS * ray, ray)):
                lever = at - centre
                balance[3 * k:3 * k + 3, 3 * joint + column] += sense * np.array([*force, lever[0] * force[1] - lever[1] * force[0]])
    cone = np.zeros((2 * joints, 3 * joints))
    for row in range(2 * joints):
        at = 3 * (row // 2)
        cone[row, at:at + 3] = [-friction, -friction, 1.0 if row % 2 else -1.0]
    scale = weight.max()
    return linprog(np.zeros(3 * joints), A_ub=cone, b_ub=np.zeros(2 * joints), A_eq=balance, b_eq=weight / scale,
                   bounds=[(0, None), (0, None), (None, None)] * joints, method="highs").status == 0


def least(stands, low, high):
    for _ in range(25):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if stands(middle) else (middle, high)
    return high


def write_stone(path, points, depth):
    """Writes a prism over (4, 2) points as OBJ."""
    nodes = [(x, y, z) for y in (-0.5 * depth, 0.5 * depth) for x, z in points]
    triangles = [(0, 1, 2), (0, 2, 3), (4, 6, 5), (4, 7, 6)]
    for k in range(4):
        after = (k + 1) % 4
        triangles += [(k, 4 + k, 4 + after), (k, 4 + after, after)]
    path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in np.array(nodes).tolist())
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles))
    return str(path)


class Arch:
    def __init__(self, folder, thickness, friction, step=1e-2):
        self.shapes = [corners(k, COUNT, thickness) for k in range(COUNT)]
        self.names = [f"stone_{k}" for k in range(COUNT)]
        bodies = {name: {"type": "rigid", "density": DENSITY,
                         "mesh": {"file": write_stone(folder / f"{name}.obj", self.shapes[k], DEPTH), "use": "convex"}}
                  for k, name in enumerate(self.names)}
        bodies["plate"] = {"type": "rigid", "shape": {"box": [4 * RADIUS, 4 * RADIUS, 0.1]}, "fixed": True, "pose": {"position": [0, 0, -0.05]}}
        row = ["plate", *self.names, "plate"]
        self.sim = sinew.load({"sinew": 1, "integrator": "backward-euler", "time_step": step, "gravity": [0.0, 0.0, -G], "bodies": bodies,
                               "contacts": {f"joint_{k}": {"between": [row[k], row[k + 1]], "friction": friction} for k in range(COUNT + 1)}})
        self.first = self.places()

    def places(self):
        return np.array([self.sim.body(name).centre_of_mass for name in self.names])

    def watch(self, duration):
        """Creep since 0.1 s and displacement since the start, both divided by R. Ends early if the arch falls."""
        settled, crept, moved = None, 0.0, 0.0
        while self.sim.time < duration - 1e-6 and moved < 0.05:
            self.sim.run(duration=0.1)
            now = self.places()
            settled = now if settled is None else settled
            crept = max(crept, np.abs(now - settled).max() / RADIUS)
            moved = np.abs(now - self.first).max() / RADIUS
        return float(crept), float(moved)

    def outlines(self):
        """Present corners (4, 2) of every stone."""
        drawn = []
        for name, shape in zip(self.names, self.shapes):
            body = self.sim.body(name)
            w, x, y, z = body.rotation
            turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * z + w * y)], [2 * (x * z - w * y), 1 - 2 * (x * x + y * y)]])
            drawn.append(shape @ turn.T + np.array(body.position)[[0, 2]])
        return drawn

    def overlap(self):
        """Overlap of neighbours / R: the largest depth of a corner behind the plane of the other stone's joint face."""
        outlines, deepest = self.outlines(), 0.0
        for one, following in zip(outlines, outlines[1:]):
            for stone, face, points in ((one, one[[2, 3]], following[[0, 1]]), (following, following[[0, 1]], one[[2, 3]])):
                along = (face[1] - face[0]) / np.linalg.norm(face[1] - face[0])
                inwards = np.array([along[1], -along[0]])
                inwards *= np.sign((stone.mean(axis=0) - face[0]) @ inwards)
                for place in points - face[0]:
                    if 0.0 <= place @ along <= np.linalg.norm(face[1] - face[0]):
                        deepest = max(deepest, float(place @ inwards))
        return deepest / RADIUS


def draw(axis, arch, color, label):
    for k, outline in enumerate(arch.outlines()):
        axis.plot(*np.vstack([outline, outline[:1]]).T, color=color, lw=1, label=label if k == 0 else None)


def thicknesses(case, axis):
    for count, tolerance in ((25, None), (101, 1e-3), (401, 1e-3)):
        theory = least(lambda t: admissible(t * RADIUS, 0.5, count), 0.05, 0.3)
        if tolerance is None:
            case.report(f"linear program, {count} equal stones: least t/R", theory, source="limit analysis", reference=0.1075)
        else:
            case.check(f"linear program, {count} equal stones: least t/R", theory, 0.1075, tolerance, source="Milankovitch")
    bound = least(lambda t: admissible(t * RADIUS, 0.5), 0.05, 0.3)
    case.report("linear program, these 25 stones: least t/R", bound, source="limit analysis", reference=0.1075)
    for share in (1.01, 1.03):
        crept, _ = Arch(case.scratch, share * bound * RADIUS, 0.5).watch(10.0)
        case.bound(f"{share:g} of the least thickness: creep in ten seconds / R", crept, 1e-6, source="limit analysis")
    for share, color in ((0.99, plots.SECOND), (0.97, plots.THIRD)):
        arch = Arch(case.scratch, share * bound * RADIUS, 0.5)
        case.agree(f"{share:g} of the least thickness: it falls", arch.watch(10.0)[1] >= 0.05, True, source="limit analysis")
        if share == 0.99:
            draw(axis, arch, color, f"0.99 of the least thickness, {arch.sim.time:.1f} s")
    axis.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")


def frictions(case, axis, thickness=0.2 * RADIUS):
    bound = least(lambda mu: admissible(thickness, mu), 0.1, 0.6)
    case.report("linear program, t = 0.2 R: least friction", bound, source="limit analysis")
    arch = Arch(case.scratch, thickness, 0.5)
    case.bound("t = 0.2 R, mu = 0.5: creep in ten seconds / R", arch.watch(10.0)[0], 1e-6, source="Coulomb")
    draw(axis, arch, plots.OURS, "t = 0.2 R, mu = 0.5, ten seconds")
    crept, _ = Arch(case.scratch, thickness, 1.01 * bound).watch(10.0)
    case.bound("t = 0.2 R, 1.01 of the least friction: creep in ten seconds / R", crept, 1e-6, source="limit analysis")
    _, moved = Arch(case.scratch, thickness, 0.99 * bound).watch(10.0)
    case.agree("t = 0.2 R, 0.99 of the least friction: it falls", moved >= 0.05, True, source="limit analysis")
    arch = Arch(case.scratch, thickness, 0.2)
    case.agree("t = 0.2 R, mu = 0.2: it falls", arch.watch(10.0)[1] >= 0.05, True, source="limit analysis")
    draw(axis, arch, plots.SECOND, f"t = 0.2 R, mu = 0.2, {arch.sim.time:.1f} s")
    axis.set(xlabel="x (m)", ylabel="z (m)", aspect="equal")


def overlaps(case, thickness=0.2 * RADIUS):
    arch, deepest = Arch(case.scratch, thickness, 0.2, step=1e-3), 0.0
    for _ in range(30):
        arch.sim.step()
        deepest = max(deepest, arch.overlap())
    case.bound("t = 0.2 R, mu = 0.2: largest overlap in 30 ms of falling / R", deepest, 1e-6, source="Coulomb")


def run(case):
    figure, (left, right) = plots.axes(2)
    thicknesses(case, left)
    frictions(case, right)
    overlaps(case)
    for axis in (left, right):
        axis.legend(fontsize=7, loc="lower center")
    case.figure(figure, "Left: an arch that is 1 % too thin, as it falls. Right: a thick arch with enough friction and with too little.")
