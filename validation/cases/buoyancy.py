"""Bodies in water: buoyancy, drag and added mass."""

import numpy as np
import sinew

from suite import plots

TITLE = "Buoyancy, drag and added mass"
SETUP = """Unsupported bodies of E = 200 kPa in water of 1000 kg/m^3 under gravity:

- a block of 20 x 20 x 20 mm with the density of water, released from rest;
- a slab of 40 x 40 x 10 mm and 600 kg/m^3, released at the surface, which settles; its draught is compared relative to its
  height;
- a cylinder of 20 mm diameter and 200 mm length, 1400 kg/m^3, quadratic tetrahedra, which sinks across its axis; its initial
  acceleration follows from weight, buoyancy and added mass, its final speed from drag.

The ends of the cylinder have their own drag and added mass, which the references neglect. The water pressure acts face by
face; integration points above the surface carry none."""
SOURCES = {"Archimedes": "weight of the displaced water",
           "Lamb": "H. Lamb, Hydrodynamics, 6th ed. 1932, art. 68: added mass of a cylinder across the flow is that of the "
                   "water that it displaces",
           "drag": "1/2 rho C_d v^2 d L with C_d = 4/3 c_n = 1.2"}
COST = 12
G, WATER = 9.81, 1000.0


def scene(mesh, density, step, **water):
    return sinew.load({
        "sinew": 1, "gravity": [0, 0, -G], "time_step": step, "integrator": "backward-euler",
        "solver": {"method": "newton", "tolerance": 1e-9},
        "bodies": {"body": {"type": "fem", "density": density, "mesh": mesh, "element": "tet10",
                            "material": {"model": "neo-hookean", "young_modulus": 200e3, "poisson_ratio": 0.45},
                            "damping": {"stiffness": 0.002}}},
        "loads": {"sea": {"type": "water", "body": "body", **water}}})


def height(sim):
    body = sim.body("body")
    return (np.array(body.positions) - np.array(body.rest_positions))[:, 2].mean()


def run(case):
    cube = {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.02, "element_size": 0.01}
    sim = scene(cube, WATER, 0.01)
    sim.step(100)
    case.check("as heavy as water: motion in 1 s / (1/2 g t^2)", height(sim) / (0.5 * G), 0.0, 1e-6, relative=False,
               source="Archimedes")

    # A flat slab floats upright; a cube of this density would float on an edge.
    slab = {"shape": "block", "length": 0.04, "width": 0.04, "height": 0.01, "element_size": 0.0034}
    sim = scene(slab, 600.0, 0.01, level=0.005, normal_drag=3.0)
    sim.step(200)
    body = sim.body("body")
    bottom = np.array(body.rest_positions)[:, 2] < 1e-9
    draught = 0.005 - np.array(body.positions)[bottom, 2].mean()
    case.check("slab of 600 kg/m^3: draught / height", draught / 0.01, 0.6, 0.02, source="Archimedes")
    load = np.array(body.load_forces).sum(axis=0)[2]
    case.check("slab of 600 kg/m^3: buoyancy / weight", load / (600 * 16e-6 * G), 1.0, 0.01,
               source="Archimedes")

    length, diameter, density = 0.2, 0.02, 1400.0
    # The cylinder's axis is z: with gravity along x it sinks broadside.
    sim = sinew.load({
        "sinew": 1, "gravity": [-G, 0, 0], "time_step": 0.001, "integrator": "backward-euler",
        "solver": {"method": "newton", "tolerance": 1e-9},
        "bodies": {"body": {"type": "fem", "density": density, "element": "tet10",
                            "mesh": {"shape": "cylinder", "radius": diameter / 2, "height": length, "element_size": 0.008},
                            "material": {"model": "neo-hookean", "young_modulus": 2e6, "poisson_ratio": 0.45}}},
        "loads": {"sea": {"type": "water", "body": "body", "tangential_drag": 0}}})
    body = sim.body("body")
    times, speeds = [0.0], [0.0]
    for _ in range(600):
        sim.step()
        times.append(sim.time)
        speeds.append(-np.array(body.velocities)[:, 0].mean())
    first = speeds[5] / times[5]
    expected = (density - WATER) * G / (density + WATER)
    case.check("sinking cylinder: initial acceleration", first, expected, 0.05, unit="m/s^2", source="Lamb")
    last = np.sqrt((density - WATER) * G * np.pi / 4 * diameter / (0.5 * WATER * 1.2))
    case.check("sinking cylinder: final speed", speeds[-1], last, 0.05, unit="m/s", source="drag")
    figure, axis = plots.axes()
    axis.plot(times, speeds, color=plots.OURS, label="sinking cylinder")
    rate = expected / last
    axis.plot(times, last * np.tanh(rate * np.array(times)), "--", color=plots.REFERENCE, label="rigid, by hand")
    axis.set(xlabel="time (s)", ylabel="speed (m/s)")
    axis.legend()
    case.figure(figure, "A cylinder sinks: v = v_final tanh(a t/v_final).")
