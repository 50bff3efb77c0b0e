"""Wheels that roll down an incline, and bodies that spin freely."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Rolling: wheels of points on an incline, and the angular momentum of a spinning block"
SETUP = """- A wheel, r = 20 mm, 10 mm wide, with N mesh points around its rim, stands on a facet on a plane inclined by 10 degrees, mu =
  0.6. It is released for 0.4 s (Newton's method); the compared quantity is 2 x/t^2. A round rigid wheel accelerates by g
  sin(a)/(1 + k), k = I/(m r^2). A rigid wheel of N points turns about the point on which it stands, (1 + k) r theta'' = g
  sin(theta), with theta from the vertical, and keeps the fraction (k + cos b)/(1 + k), b = 2 pi/N, of its rate when the next
  point lands and stops (McGeer 1990). This equation is solved by Runge-Kutta steps between landings, with k and r of the
  mesh. With 10 MPa and backward Euler the facets stay flat and vibrations decay, so the wheel should behave like the rigid
  wheel of points. Soft wheels of 100 kPa with BDF2, whose footprint is as long as their facets, are compared with the round
  wheel.
- A free block of 40 x 20 x 20 mm, 1 MPa, spins at 20 rad/s for 0.5 s. Second-order integrators should conserve its angular
  momentum up to their error. Backward Euler should lose as much as with a rigid body, for which the rotations D of successive
  steps obey 2 sin(D_f) = sin(D_f + D_i) (see the case backward_euler), L = I sin(D)/h."""
SOURCES = {"round": "rolling of a rigid round wheel: g sin(a)/(1 + I/(m r^2))",
           "McGeer": "T. McGeer, Passive dynamic walking, Int. J. Robotics Research 9 (1990) 62-82: the rimless wheel; "
                     "doi:10.1177/027836499000900206",
           "momentum": "angular momentum of a free body",
           "Hairer 1996": "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, section IV.3"}
COST = 60
G, INCLINE, RADIUS, TIME = 9.81, np.radians(10), 0.02, 0.4


class Wheel:
    """A wheel with 6 `rings` rim points, whose lowest facet lies on the incline."""

    def __init__(self, case, rings, modulus, step, integrator):
        path = case.scratch / f"wheel_{rings}.vtu"
        mesh = sinew.mesh.cylinder(radius=RADIUS, height=0.01, rings=rings, layers=1)
        mesh.write(str(path))
        rim = mesh.nodes[mesh.node_sets["side"]]
        angles = np.unique(np.round(np.arctan2(rim[:, 1], rim[:, 0]), 9))
        self.points, self.radius = len(angles), np.hypot(rim[0, 0], rim[0, 1])
        down = 0.5 * (angles[0] + angles[1])  # midpoint of a facet
        normal = -np.array([np.cos(down), np.sin(down), 0.0])
        self.downhill = np.array([normal[1], -normal[0], 0.0])
        self.sim = sinew.load({
            "sinew": 1, "integrator": integrator, "time_step": step, "solver": {**SOLVER, "method": "newton"},
            "gravity": list(G * (np.sin(INCLINE) * self.downhill - np.cos(INCLINE) * normal)),
            "bodies": {"wheel": {"type": "fem", "density": 1000.0, "mesh": {"file": str(path), "unit": "m"},
                                 "material": {"model": "corotational", "young_modulus": modulus, "poisson_ratio": 0.3}}},
            "contacts": {"floor": {"body": "wheel", "nodes": {"set": "side"}, "friction": 0.6,
                                   "surface": {"plane": {"point": list(-self.radius * np.cos(np.pi / self.points) * normal),
                                                         "normal": list(normal)}}}}})
        mass = np.asarray(self.sim.body("wheel").node_masses)
        self.share = mass / mass.sum()
        self.inertia = float(self.share @ (mesh.nodes[:, :2]**2).sum(axis=1)) / self.radius**2  # k

    def way(self):
        """Displacement of the centre of mass (m) after every step, and the largest energy gain in a step / energy of the whole descent."""
        body, energies, ways = self.sim.body("wheel"), [], [0.0]
        while self.sim.time < TIME - 1e-9:
            self.sim.step()
            ways.append(float(self.share @ (np.asarray(body.positions) - np.asarray(body.rest_positions)) @ self.downhill))
            energies.append(body.kinetic_energy + body.strain_energy + body.gravity_energy)
        drop = ways[-1] * np.sin(INCLINE) * G * np.asarray(body.node_masses).sum()
        return np.array(ways), max(0.0, float(np.max(np.diff([0.0, *energies])))) / drop

    def rolled_round(self):
        return G * np.sin(INCLINE) / (1.0 + self.inertia)

    def rolled_rigid(self, step=2e-5):
        """Mean acceleration 2 x/t^2 of a rigid wheel with the same points."""
        k, r, facet = self.inertia, self.radius, 2.0 * np.pi / self.points

        def slope(state):
            return np.array([state[1], G * np.sin(state[0] + INCLINE) / ((1.0 + k) * r)])

        state, landed = np.array([-0.5 * facet, 0.0]), 0
        for _ in range(round(TIME / step)):
            first = slope(state)
            second = slope(state + 0.5 * step * first)
            third = slope(state + 0.5 * step * second)
            state = state + step / 6.0 * (first + 2.0 * second + 2.0 * third + slope(state + step * third))
            if state[0] >= 0.5 * facet:
                state = np.array([state[0] - facet, state[1] * (k + np.cos(facet)) / (1.0 + k)])
                landed += 1
        way = r * (2.0 * landed * np.sin(0.5 * facet) + np.sin(state[0]) + np.sin(0.5 * facet))
        return 2.0 * way / TIME**2


def rolls(case, axis, right):
    seen = {"stiff": [], "soft": [], "rigid": [], "points": []}
    gains = {"stiff": 0.0, "soft": 0.0}
    for rings in (4, 8, 12):
        for kind, modulus, step, integrator in (("stiff", 1e7, 5e-4, "backward-euler"), ("soft", 1e5, 5e-4, "bdf2")):
            wheel = Wheel(case, rings, modulus, step, integrator)
            ways, gain = wheel.way()
            seen[kind].append(2.0 * ways[-1] / TIME**2 / wheel.rolled_round())
            gains[kind] = max(gains[kind], gain)
            if kind == "soft":
                right.plot(np.linspace(0.0, TIME, len(ways)), 1e3 * ways, label=f"{wheel.points} points")
        seen["rigid"].append(wheel.rolled_rigid() / wheel.rolled_round())
        seen["points"].append(wheel.points)
    for points, ours, rigid in zip(seen["points"], seen["stiff"], seen["rigid"]):
        case.check(f"{points} points, 10 MPa: acceleration / a round wheel's", ours, rigid, 0.05, source="McGeer")
    case.check(f"{points} points, 100 kPa: acceleration / a round wheel's", seen["soft"][-1], 1.0, 0.02, source="round")
    case.report("24 points, 100 kPa: acceleration / a round wheel's", seen["soft"][0], source="round")
    case.bound("largest energy gain in a backward Euler step / energy of the descent", gains["stiff"], 1e-4, source="round",
               remark="not zero: the energy of compressed elements is not convex in the rotation")
    case.bound("largest energy gain in a BDF2 step / energy of the descent", gains["soft"], 1e-4, source="round")
    axis.plot(seen["points"], seen["rigid"], "s--", color=plots.REFERENCE, label="rigid wheel of points")
    axis.plot(seen["points"], seen["stiff"], "o-", color=plots.OURS, label="10 MPa")
    axis.plot(seen["points"], seen["soft"], "o-", color=plots.SECOND, label="100 kPa")
    axis.set(xlabel="points around", ylabel="acceleration / a round wheel's", ylim=(0.6, 1.02))
    axis.legend()
    right.set(xlabel="time (s)", ylabel="distance (mm), 100 kPa")
    right.legend()


def spin(integrator, step, rate=20.0, duration=0.5, start=0.05):
    """Angular momentum over time, relative to its first value after a spin-up of `start` s, and the initial rate, rad/s."""
    sim = sinew.load({
        "sinew": 1, "integrator": integrator, "time_step": step, "solver": {**SOLVER, "method": "newton"},
        "bodies": {"block": {"type": "fem", "density": 1000.0,
                             "mesh": {"shape": "block", "length": 0.04, "width": 0.02, "height": 0.02, "element_size": 0.01},
                             "material": {"model": "corotational", "young_modulus": 1e6, "poisson_ratio": 0.3}}}})
    body = sim.body("block")
    mass = np.asarray(body.node_masses)
    centre = mass @ np.asarray(body.positions) / mass.sum()

    def state():
        arm, velocity = np.asarray(body.positions) - centre, np.asarray(body.velocities)
        return arm, float(mass @ (arm[:, 0] * velocity[:, 1] - arm[:, 1] * velocity[:, 0]))

    for _ in range(round(start / step)):
        arm = state()[0]
        body.external_forces = mass[:, None] * rate / start * np.column_stack([-arm[:, 1], arm[:, 0], 0.0 * arm[:, 0]])
        sim.step()
    body.external_forces = np.zeros_like(body.positions)
    sim.step(10)  # transient of a two-step formula after the end of the torque
    arm, first = state()
    seen = [1.0]
    for _ in range(round(duration / step)):
        sim.step()
        seen.append(state()[1] / first)
    return np.array(seen), first / float(mass @ (arm[:, :2]**2).sum(axis=1))


def rigid_spin(step, rate, count):
    """The same for a rigid body under backward Euler, `count` steps from its initial rate."""
    turn, seen = np.arcsin(rate * step), []
    for _ in range(count):
        seen.append(np.sin(turn))
        new = turn
        for _ in range(30):
            new -= (2.0 * np.sin(new) - np.sin(new + turn)) / (2.0 * np.cos(new) - np.cos(new + turn))
        turn = new
    return np.array(seen) / seen[0]


def spins(case, axis):
    step = 1e-3
    for integrator, tolerance in (("bdf2", 2e-4), ("generalized-alpha", 2e-5)):
        kept, _ = spin(integrator, step)
        case.bound(f"angular momentum lost in 0.5 s at 20 rad/s, {integrator}, 1 ms", float(np.abs(kept - 1.0).max()), tolerance,
                   source="momentum")
    ours, rate = spin("backward-euler", step)
    rigid = rigid_spin(step, rate, len(ours))
    case.check("angular momentum lost in 0.5 s at 20 rad/s, backward Euler, 1 ms", 1.0 - ours[-1], 1.0 - rigid[-1], 0.02,
               source="Hairer 1996")
    time = step * np.arange(len(ours))
    axis.plot(time, ours, color=plots.OURS, label="block")
    axis.plot(time, rigid, "--", color=plots.REFERENCE, lw=1, label="rigid, same method")
    axis.set(xlabel="time (s)", ylabel="angular momentum, backward Euler")
    axis.legend()


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    rolls(case, left, middle)
    spins(case, right)
    case.figure(figure, "Left: acceleration against the number of points around the wheel. Middle: distance rolled by soft wheels. Right: angular momentum of a "
                        "spinning block.")
