"""The watch of the energy of dynamic runs."""

import math
import warnings

import numpy as np
import sinew

from suite import plots

TITLE = "Energy: right runs are not flagged, runs that gain energy are"
SETUP = """Random robots of six families: a mass on a slider with a periodic motor force; a pendulum with a motor torque or a motor
that follows a periodic angle; a soft block that a periodic force shakes; a soft block on a base that shakes it; a soft block that
a cable and a pressure load pull; a rigid box and a ball that fall on a plane and slide. Integrators, periods, loads and
steps are random; steps divide the period by 12 to 120. A run counts as right if its motion agrees with that of a quarter of the
step within 5 % of its amplitude. Robots are drawn until 300 runs are right. No step of a right run should say `gaining-energy`; 1 % of
these runs may.

Runs that gain energy are soft bars that spin freely, with the generalized-alpha method, radii of 0.9 to 1 and 8 to 30 steps a turn:
their steps are solved, and the method itself puts energy in. A run counts if its energy is twice that of the start for two steps; it
should be flagged by then. Another 30 are soft beams that swing with one corotated linearisation in each step. It leaves most of the
forces out of balance, and the run stops."""
SOURCES = {"ledger": "work of the integrator's own quadrature, run/work_ledger.hpp",
           "Simo": "J. C. Simo, N. Tarnow, The discrete energy-momentum method, ZAMP 43 (1992) 757-792: Newmark's method and its kin gain "
                   "energy in nonlinear elastodynamics",
           "Hairer": "E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), sections VI.4, IX"}
COST = 500
RUNS, SWINGS, SPINS = 300, 30, 30
G = 9.81


def sine(quantity, amplitude, period, phase=0.0):
    return {quantity: {"sine": {"amplitude": amplitude, "period": period, "phase": phase}}}


def integrator_of(random):
    kind = random.choice(["bdf2", "generalized-alpha", "backward-euler", "bdf2", "generalized-alpha"])
    if kind != "generalized-alpha":
        return str(kind)
    return {"type": "generalized-alpha", "spectral_radius": float(random.choice([0.0, 0.5, 0.8, 0.95]))}


def block(random, **more):
    modulus = float(10 ** random.uniform(4.5, 6.0))
    return {"type": "fem", "mesh": {"shape": "block", "length": 0.02, "width": 0.02, "height": 0.08, "element_size": 0.02},
            "element": "hex8", "material": {"model": "neo-hookean", "young_modulus": modulus, "poisson_ratio": 0.4}, "density": 1000.0,
            "damping": {"stiffness": float(random.choice([0.0, 1e-4, 2e-3]))}, "fixed": [{"set": "z_min"}], **more}


def slider(random, period):
    return {"bodies": {"b": {"type": "rigid", "shape": {"box": [0.02] * 3}, "mass": 0.2}},
            "joints": {"j": {"type": "slider", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": "x"}},
            "actuators": {"m": {"type": "linear-motor", "joint": "j",
                                "command": sine("force", float(random.uniform(0.1, 3)), period, float(random.uniform(0, 6)))}}}


def pendulum(random, period):
    length = float(random.uniform(0.1, 0.4))
    angle = random.random() < 0.4
    command = (sine("angle", float(random.uniform(0.1, 0.9)), period) if angle
               else sine("torque", float(random.uniform(0.01, 0.12)), period))
    return {"gravity": [0, 0, -G],
            "bodies": {"b": {"type": "rigid", "shape": {"box": [0.02, 0.02, length]}, "mass": 0.2, "pose": {"position": [0, 0, -length / 2]}}},
            "joints": {"j": {"type": "hinge", "bodies": ["world", "b"], "point": [0, 0, 0], "axis": "y",
                             **({"friction": 0.005} if random.random() < 0.3 else {})}},
            "actuators": {"m": {"type": "motor", "joint": "j", "command": command}}}


def shaken(random, period):
    return {"gravity": [0, 0, float(random.choice([0.0, -G]))], "bodies": {"b": block(random)},
            "actuators": {"f": {"type": "force", "body": "b", "point": [0.01, 0.01, 0.08], "direction": [1, 0, 0],
                                "command": sine("force", float(random.uniform(0.005, 0.05)), period)}}}


def carried(random, period):
    motion = {"x": {"sine": {"amplitude": float(random.uniform(0.001, 0.01)), "period": period}}}
    return {"gravity": [0, 0, float(random.choice([0.0, -G]))], "bodies": {"b": block(random, motion=motion)}}


def pulled(random, period):
    points = [[0.017, 0.01, z] for z in (0.0, 0.04, 0.08)]
    size = float(random.uniform(0.05, 0.4))
    cable = {"type": "cable", "body": "b", "points": points,
             "command": {"tension": {"sine": {"amplitude": size, "period": period, "mean": size}}}}
    loads = {"p": {"type": "pressure", "body": "b", "surface": {"set": "x_min"},
                   "pressure": {"sine": {"amplitude": float(random.uniform(5, 60)), "period": 0.7 * period}}}}
    return {"bodies": {"b": block(random)}, "actuators": {"c": cable}, "loads": loads}


def falling(random, period):
    ball = random.random() < 0.5
    shape = {"sphere": {"radius": 0.02}} if ball else {"box": [0.04, 0.03, 0.02]}
    return {"gravity": [0, 0, -G],
            "bodies": {"b": {"type": "rigid", "shape": shape, "mass": 0.1, "pose": {"position": [0, 0, 0.02 + float(random.uniform(0.01, 0.1))]},
                             "velocity": {"linear": [float(random.uniform(0, 1)), 0, 0]}}},
            "contacts": {"floor": {"body": "b", "friction": float(random.choice([0.0, 0.3, 0.8])), "surface": {"plane": {}}}}}


FAMILIES = (slider, pendulum, shaken, carried, pulled, falling)


def scene_of(seed):
    random = np.random.default_rng(seed)
    family = FAMILIES[seed % len(FAMILIES)]
    period = float(random.uniform(0.2, 1.0))
    scene = {"sinew": 1, "integrator": integrator_of(random), **family(random, period)}
    scene["time_step"] = period / int(10 ** random.uniform(math.log10(12), math.log10(120)))
    return scene, 4.0 * period


def motion(scene, duration, divide=1):
    """Positions of the body at the steps of the undivided run, the number of flagged steps, and the largest gain of energy."""
    step = scene["time_step"] / divide
    sim = sinew.load({**scene, "time_step": step})
    body = sim.body("b")
    path, flagged = [], 0
    for k in range(1, divide * round(duration / scene["time_step"]) + 1):
        sim.step()
        flagged += sim.report.status == "gaining-energy"
        if k % divide == 0:
            path.append(np.array(body.positions if body.positions.size else body.position).ravel())
    return np.array(path), flagged


def judge(seed):
    """Whether a run is right, and how many of its steps are flagged."""
    scene, duration = scene_of(seed)
    path, flagged = motion(scene, duration)
    fine, _ = motion(scene, duration, 4)
    return bool(np.abs(path - fine).max() <= 0.05 * np.abs(fine - fine[0]).max()), flagged


def spin(seed):
    """Whether a spinning bar's energy doubles for two steps or more, and whether a step was flagged by then."""
    random = np.random.default_rng(2000 + seed)
    speed = float(random.uniform(20, 120))
    sim = sinew.load({
        "sinew": 1, "gravity": [0, 0, 0], "time_step": float(random.uniform(0.2, 0.8)) / speed,
        "integrator": {"type": "generalized-alpha", "spectral_radius": float(random.uniform(0.9, 1.0))},
        "bodies": {"b": {"type": "fem", "density": 1000.0, "element": str(random.choice(["hex8", "tet4"])), "pose": {"position": [-0.05, -0.01, -0.01]},
                         "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.02},
                         "material": {"model": "neo-hookean", "young_modulus": float(10 ** random.uniform(5.0, 6.5)), "poisson_ratio": 0.3},
                         "velocity": {"angular": [0, 0, speed]}}}})
    body, flagged, above = sim.body("b"), False, 0
    start = body.kinetic_energy
    for _ in range(200):
        try:
            sim.step()
        except sinew.RunError:
            return False, flagged
        flagged = flagged or sim.report.status == "gaining-energy"
        above = above + 1 if body.kinetic_energy + body.strain_energy > 2.0 * start else 0
        if above == 2:
            return True, flagged
    return False, flagged


def swing(seed):
    """Whether a swing whose steps put energy in is flagged, or stopped."""
    random = np.random.default_rng(1000 + seed)
    scene = {"sinew": 1, "gravity": [0, 0, -G], "integrator": str(random.choice(["bdf2", "generalized-alpha"])),
             "time_step": float(random.uniform(0.015, 0.025)), "solver": {"method": "one-linearisation", "tangent": "corotated"},
             "bodies": {"b": {"type": "fem", "density": 1000.0, "element": "tet4",
                              "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
                              "material": {"model": "corotational", "young_modulus": float(10 ** random.uniform(5.0, 6.0)),
                                           "poisson_ratio": 0.4},
                              "fixed": [{"box": [-1e-6, -1, -1e-6, 1e-6, 1, 1e-6]}]}}}
    sim = sinew.load(scene)
    try:
        for _ in range(100):
            sim.step()
            if sim.report.status == "gaining-energy":
                return True
    except sinew.RunError:
        return True
    return False


def run(case):
    warnings.simplefilter("ignore", sinew.SinewWarning)
    seed, share = 0, []
    while len(share) < RUNS:
        agrees, flagged = judge(seed)
        if agrees:
            share.append(flagged)
        seed += 1
    case.report(f"random runs of which {RUNS} are right", seed, source="ledger")
    case.bound(f"of {RUNS} right runs, those with a flagged step", sum(flagged > 0 for flagged in share), 3, source="ledger")
    seed, gaining, told = 0, 0, 0
    while gaining < SPINS:
        gains, flagged = spin(seed)
        gaining += gains
        told += gains and flagged
        seed += 1
    case.check(f"spinning bars whose energy doubles and that are flagged by then, of {SPINS}", told, SPINS, 0.0, source="Simo")
    caught = sum(swing(seed) for seed in range(SWINGS))
    case.check(f"swings that gain energy and are flagged or stopped, of {SWINGS}", caught, SWINGS, 0.0, source="Hairer")
    figure, axis = plots.axes(1)
    axis.hist(share, bins=np.arange(0, max(share) + 2), color=plots.OURS)
    axis.set(xlabel="flagged steps of a right run", ylabel="runs", yscale="log")
    case.figure(figure, "Flagged steps of the right runs.")
