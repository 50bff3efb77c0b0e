"""A block on an incline."""

import numpy as np
import sinew

from suite import plots
from suite.robots import SOLVER

TITLE = "Contact with friction: a block on an incline, a slide and a dropped block"
SETUP = """A rubber block of 40 x 40 x 20 mm, E = 1 MPa, 1000 kg/m^3, with damping, lies on a plane with mu = 0.5. Instead of
the plane, gravity is inclined by theta. Backward Euler steps of 1 ms. The speed of the block is the
mean over its nodes (lumped masses), its acceleration the mean over the last 0.4 s of 1 s. Below tan theta = mu the block
sticks, and its motion in the last 0.5 s is compared with zero.

Then a block starts at 0.5 m/s on level ground and stops after v^2/(2 mu g), with smaller and smaller steps; the error of the
integrator is of first order. Finally, a block of 100 kPa without damping is dropped by 5 mm, and its energy is checked in
every step."""
SOURCES = {"Coulomb": "C. A. Coulomb, Theorie des machines simples, Mem. Math. Phys. Acad. Sci. 10 (1785); a = g (sin theta - mu cos theta)",
           "Moreau": "J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, in: Nonsmooth mechanics and "
                     "applications, Springer (1988): balance of forces; impacts without rebound dissipate"}
COST = 20
MU, G = 0.5, 9.81
MASS = 1000.0 * 0.04 * 0.04 * 0.02


def block(theta=0.0, step=1e-3, height=0.0, modulus=1e6, damping=0.002, friction=MU, size=0.01):
    return sinew.load({
        "sinew": 1, "integrator": "backward-euler", "time_step": step, "solver": SOLVER,
        "gravity": [G * np.sin(theta), 0.0, -G * np.cos(theta)],
        "bodies": {"block": {
            "type": "fem", "density": 1000.0, "damping": {"stiffness": damping},
            "material": {"model": "corotational", "young_modulus": modulus, "poisson_ratio": 0.3},
            "mesh": {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.02, "element_size": size}}},
        "contacts": {"floor": {"body": "block", "nodes": {"set": "z_min"}, "friction": friction,
                               "surface": {"plane": {"point": [0.0, 0.0, -height]}}}}})


def slides(case, axis):
    worst, crept, held = 0.0, 0.0, 0.0
    angles = np.radians([5, 15, 20, 25, 26, 27, 28, 30, 40, 55, 70])
    seen = []
    for theta in angles:
        sim = block(theta)
        sim.step(600)
        speed = sim.body("block").velocities[:, 0].mean()
        at = sim.body("block").positions.mean(axis=0)
        sim.step(400)
        seen.append((sim.body("block").velocities[:, 0].mean() - speed) / 0.4)
        theory = G * (np.sin(theta) - MU * np.cos(theta))
        floor = sim.contact("floor")
        held = max(held, abs(floor.normal_force / (MASS * G * np.cos(theta)) - 1.0))
        if theory > 0.0:
            worst = max(worst, abs(seen[-1] / theory - 1.0))
        else:
            crept = max(crept, float(np.linalg.norm(sim.body("block").positions.mean(axis=0) - at)))
    case.check("acceleration / (g (sin theta - mu cos theta)), worst of 6 angles, 27 to 70 degrees", 1.0 + worst, 1.0, 1e-3,
               source="Coulomb")
    case.bound("creep in 0.4 s below the friction angle (m), worst of 5 angles up to 26 degrees", crept, 1e-9, source="Coulomb")
    case.bound("sum of normal forces / normal component of the weight - 1, all angles", held, 1e-4, source="Moreau")
    fine = np.linspace(0.0, 1.3, 200)
    axis.plot(np.degrees(fine), np.maximum(0.0, G * (np.sin(fine) - MU * np.cos(fine))), "-", color=plots.REFERENCE, lw=1,
              label="g (sin - mu cos)")
    axis.plot(np.degrees(angles), seen, "o", color=plots.OURS, label="block")
    axis.set(xlabel="angle (degrees)", ylabel="acceleration (m/s^2)")
    axis.legend()


def stops(case, axis):
    start, theory = 0.5, 0.5**2 / (2.0 * MU * G)
    steps, errors = [2e-3, 1e-3, 5e-4, 2.5e-4], []
    for step in steps:
        sim = block(step=step, modulus=1e7)
        sim.step(round(0.1 / step))  # comes to rest
        push = sim.body("block")
        # A force of m v/h in one step gives all nodes the speed v.
        mass = np.full(len(push.positions), 0.0)
        mass[:] = nodal_mass(sim)
        before = push.positions[:, 0].mean()
        push.external_forces = np.outer(mass * (start / step + MU * G), [1.0, 0.0, 0.0])
        sim.step()
        push.external_forces = np.zeros_like(push.positions)
        sim.step(round(0.3 / step))
        errors.append(float(push.positions[:, 0].mean() - before) / theory - 1.0)
    order = np.polyfit(np.log(steps), np.log(np.abs(errors)), 1)[0]
    case.check("stopping distance / (v^2/(2 mu g)), step 0.25 ms", 1.0 + errors[-1], 1.0, 5e-3, source="Coulomb")
    case.check("order of the error in the step", float(order), 1.0, 0.15, source="Coulomb")
    axis.loglog(steps, np.abs(errors), "o-", color=plots.OURS, label="stopping distance")
    axis.loglog(steps, np.abs(errors[0]) * np.array(steps) / steps[0], "--", color=plots.REFERENCE, lw=1, label="order 1")
    axis.set(xlabel="time step (s)", ylabel="relative error")
    axis.legend()


def nodal_mass(sim):
    """Lumped masses (n,) in kg: a quarter of the mass of each adjacent tetrahedron."""
    points = sim.body("block").positions
    tetrahedra = sim.body("block").tetrahedra
    edges = points[tetrahedra[:, 1:]] - points[tetrahedra[:, :1]]
    mass = np.zeros(len(points))
    np.add.at(mass, tetrahedra, 1000.0 * np.abs(np.linalg.det(edges))[:, None] / 24.0)
    return mass


def drops(case, axis):
    sim = block(np.radians(15), height=0.005, modulus=1e5, damping=0.0)
    energies = []
    for _ in range(400):
        sim.step()
        ledger = sim.ledger
        energies.append(ledger["strain_energy"] + ledger["kinetic_energy"] + ledger["gravity_energy"])
    fall = MASS * G * 0.005
    case.bound("largest energy gain in a step of an impact / (m g h)", max(0.0, float(np.max(np.diff(energies)))) / fall, 1e-9,
               source="Moreau")
    case.report("remaining fraction of m g h after 0.4 s", 1.0 + energies[-1] / fall, source="Moreau")
    axis.plot(1e-3 * np.arange(1, 401), np.array(energies) / fall, "-", color=plots.OURS)
    axis.set(xlabel="time (s)", ylabel="energy / (m g h)")


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    slides(case, left)
    stops(case, middle)
    drops(case, right)
    case.figure(figure, "Left: acceleration against the angle of the incline. Middle: error of the stopping distance. Right: energy of a dropped block.")
