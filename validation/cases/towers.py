"""Rigid bodies on each other: a tower of ten, a pile in a pit, and masses up to a million times that of the body below."""

import numpy as np
import sinew

from suite import plots

TITLE = "Towers and piles: ten seconds of rest, mass ratios to 1e6"
SETUP = """Friction is 0.5, and steps are 5 ms, backward Euler, unless stated otherwise.

- *Tower.* Ten cubes of 20 mm stand for ten seconds. The forces equal the weights above, and nothing creeps after the first
  0.1 s. The cubes are boxes, in steps of 2, 5 and 10 ms and with other integrators; triangle hulls, face on face; and hulls
  that are displaced alternately along x by 1 mm, so that their sides lie in common planes.
- *Pile.* Ten blocks of 30 x 25 x 20 mm fall in random orientations into a pit of 100 x 100 mm, twice. Friction allows many
  states of rest; a pile must stay in the one that it has found. Creep is recorded for ten seconds after the first two. Balls
  are no test, because nothing stops a ball that rolls or spins.
- *Mass ratios.* A cube carries another one that is r times heavier: the forces are r m g and (1 + r) m g, and their
  difference is m g. Then seven cubes, each ten times as heavy as the one below. Steps satisfy the laws to 1e-10 of the larger
  forces, which are up to r times the weight that they move. The remaining error of 1e-10 r is at most 1e-4; the tolerance is
  1e-5.
- *Pad.* A rubber pad, 80 x 40 x 20 mm, 100 kPa, carries a cube of 0.5 kg and one that is a million times lighter: beside each
  other, connected by a ball joint, and the heavy one on the light one. After two seconds they rest, and forces balance
  weights. The joint must hold to 1e-9 of the edge."""
SOURCES = {"statics": "balance of forces: a contact carries what is above; rest is exact",
           "Coulomb": "friction within its cone at a velocity of zero: no creep"}
COST = 40
G, EDGE, MASS = 9.81, 0.02, 0.05
INTEGRATORS = ("backward-euler", "bdf2", "generalized-alpha")


def load(bodies, contacts, step=5e-3, integrator="backward-euler", **more):
    return sinew.load({"sinew": 1, "integrator": integrator, "time_step": step, "gravity": [0.0, 0.0, -G], "bodies": bodies,
                       "contacts": contacts, **more})


def plate(size, at, **more):
    return {"type": "rigid", "shape": {"box": size}, "fixed": True, "pose": {"position": at}, **more}


def cube(mass, at, shape=None):
    return {"type": "rigid", **(shape or {"shape": {"box": [EDGE] * 3}}), "mass": mass, "pose": {"position": at}}


def write_cube(path):
    corners = EDGE * (np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners)
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\nf {a + 1} {c + 1} {d + 1}\n" for a, b, c, d in faces))
    return {"mesh": {"file": str(path), "use": "convex"}}


class Tower:
    """Stacked cubes on a fixed plate."""

    def __init__(self, masses, step=5e-3, integrator="backward-euler", shape=None, offset=0.0):
        self.masses, self.names = masses, [f"cube_{k}" for k in range(len(masses))]
        bodies = {name: cube(mass, [offset * (k % 2), 0, (k + 0.5) * EDGE], shape) for k, (name, mass) in enumerate(zip(self.names, masses))}
        self.sim = load({**bodies, "table": plate([0.4, 0.4, 0.02], [0, 0, -0.01])},
                        {f"on_{k}": {"between": [name, under], "friction": 0.5}
                         for k, (name, under) in enumerate(zip(self.names, ["table", *self.names]))}, step, integrator)

    def places(self):
        return np.array([self.sim.body(name).position for name in self.names])

    def forces(self):
        """Largest relative error of a normal force."""
        return max(abs(self.sim.contact(f"on_{k}").normal_force / (G * sum(self.masses[k:])) - 1.0) for k in range(len(self.names)))

    def watch(self, duration):
        """Times, and the creep since 0.1 s / edge."""
        self.sim.run(duration=0.1)
        start, times, crept = self.places(), [], []
        while self.sim.time < duration - 1e-6:
            self.sim.run(duration=0.1)
            times.append(self.sim.time)
            crept.append(np.abs(self.places() - start).max() / EDGE)
        return np.array(times), np.maximum.accumulate(crept)


def stands(case, axis):
    hull = write_cube(case.scratch / "cube.obj")
    runs = [(f"boxes, {name}, {1e3 * step:g} ms", Tower([MASS] * 10, step, name))
            for name, step in (("backward-euler", 2e-3), ("backward-euler", 5e-3), ("backward-euler", 1e-2), ("bdf2", 5e-3),
                               ("generalized-alpha", 5e-3))]
    runs.append(("hulls", Tower([MASS] * 10, shape=hull)))
    runs.append(("hulls displaced alternately", Tower([MASS] * 10, shape=hull, offset=1e-3)))
    for name, tower in runs:
        times, crept = tower.watch(10.0)
        case.bound(f"tower of ten, {name}: creep in ten seconds / edge", float(crept[-1]), 1e-6, source="Coulomb")
        case.bound(f"tower of ten, {name}: largest error of a normal force, relative", tower.forces(), 1e-6, source="statics")
        axis.semilogy(times, np.maximum(crept, 1e-16), label=name)
    axis.axhline(1e-6, color=plots.REFERENCE, ls="--", lw=1)
    axis.set(xlabel="time (s)", ylabel="creep of the tower / edge", ylim=(1e-13, 1e-4))
    axis.legend(fontsize=7)


def piles(case, axis):
    half, size = 0.05, [0.03, 0.025, 0.02]
    pit = {"floor": plate([0.2, 0.2, 0.02], [0, 0, -0.01])}
    for k, (x, y) in enumerate(((1, 0), (-1, 0), (0, 1), (0, -1))):
        pit[f"wall_{k}"] = plate([0.02 if x else 0.14, 0.02 if y else 0.14, 0.3], [(half + 0.01) * x, (half + 0.01) * y, 0.15])
    for seed in (1, 2):
        random = np.random.default_rng(seed)
        blocks = {f"block_{k}": {"type": "rigid", "shape": {"box": size}, "density": 1000.0,
                                 "pose": {"position": [*random.uniform(-0.02, 0.02, 2).tolist(), 0.03 + 0.04 * k],
                                          "rotation": random.uniform(-1.0, 1.0, 3).tolist()}} for k in range(10)}
        sim = load({**pit, **blocks}, {"all": {"between": "all", "friction": 0.5}})
        places = lambda: np.array([sim.body(name).position for name in blocks])
        times, moved, last = [], [], places()
        while sim.time < 12.0 - 1e-6:
            sim.run(duration=0.25)
            times.append(sim.time)
            moved.append(np.abs(places() - last).max() / size[0])
            last = places()
            if len(times) == 8:
                settled = last
        weight = sum(sim.body(name).mass for name in blocks) * G
        carried = -sum(sim.contact(f"all-{part}-{name}").force[2] for part in pit for name in blocks)
        case.bound(f"pile {seed}: creep from 2 to 12 s / length of a block", float(np.abs(last - settled).max()) / size[0], 1e-6,
                   source="Coulomb")
        case.bound(f"pile {seed}: floor and walls carry the weight, relative error", carried / weight - 1.0, 1e-6,
                   source="statics")
        axis.semilogy(times, np.maximum(moved, 1e-16), "o-", ms=3, label=f"pile {seed}")
    axis.set(xlabel="time (s)", ylabel="motion in 0.25 s / length of a block")
    axis.legend()


def ratios(case):
    for ratio in (1e2, 1e4, 1e6):
        for integrator in INTEGRATORS[:2]:
            tower = Tower([1e-3, 1e-3 * ratio], integrator=integrator)
            crept = tower.watch(2.0)[1][-1]
            name = f"{ratio:.0e} times heavier on 1 g, {integrator}"
            upper, lower = (tower.sim.contact(f"on_{k}").normal_force for k in (1, 0))
            case.bound(f"{name}: largest error of a normal force, relative", tower.forces(), 1e-5, source="statics")
            case.bound(f"{name}: error of the force left for the light one / (m g)", (lower - upper) / (1e-3 * G) - 1.0, max(1e-6, 1e-10 * ratio),
                       source="statics")
            case.bound(f"{name}: creep in 2 s / edge", float(crept), 1e-6, source="Coulomb")
            overlap = max(0.0, -min(tower.sim.contact(f"on_{k}").gap for k in (0, 1)))
            case.bound(f"{name}: overlap / edge", overlap / EDGE, 1e-6, source="statics")
    tower = Tower([1e-3 * 10.0**k for k in range(7)])
    crept = tower.watch(2.0)[1][-1]
    case.bound("seven cubes of 1 g to 1 t: largest error of a normal force, relative", tower.forces(), 1e-5, source="statics")
    case.bound("seven cubes of 1 g to 1 t: creep in 2 s / edge", float(crept), 1e-6, source="Coulomb")


def pads(case, heavy=0.5, ratio=1e6):
    light = heavy / ratio
    pad = {"type": "fem", "element": "hex8", "density": 1000.0, "damping": {"stiffness": 5e-3}, "pose": {"position": [-0.04, -0.02, -0.02]},
           "fixed": [{"set": "z_min"}], "mesh": {"shape": "block", "length": 0.08, "width": 0.04, "height": 0.02, "element_size": 0.01},
           "material": {"model": "neo-hookean", "young_modulus": 1e5, "poisson_ratio": 0.4}}
    beside = {"heavy": cube(heavy, [-0.02, 0, 0.01]), "light": cube(light, [0.02, 0, 0.01])}
    above = {"light": cube(light, [0, 0, 0.01]), "heavy": cube(heavy, [0, 0, 0.03])}
    pin = {"joints": {"pin": {"type": "ball", "bodies": ["heavy", "light"], "point": [0, 0, 0.01]}}}
    for name, bodies, under, more in (("beside it", beside, "pad", {}), ("beside it, with a joint", beside, "pad", pin), ("below it", above, "light", {})):
        sim = load({"pad": pad, **bodies}, {"l": {"between": ["light", "pad"], "friction": 0.5}, "h": {"between": ["heavy", under], "friction": 0.5}},
                   **more)
        sim.run(duration=2.0)
        on_light, on_heavy = (abs(sim.contact(key).force[2]) for key in "lh")
        title = f"cube of 0.5 kg on a pad, a cube 1e6 times lighter {name}"
        if name == "below it":
            case.bound(f"{title}: error of the force on the pad, relative", on_light / ((light + heavy) * G) - 1.0, 1e-6, source="statics")
            case.bound(f"{title}: error of the force between them, relative", on_heavy / (heavy * G) - 1.0, 1e-6, source="statics")
        elif more:
            pull = float(sim.joint("pin").force[2])
            case.bound(f"{title}: force imbalance of the light one / its weight", (on_light + pull) / (light * G) - 1.0, 1e-6, source="statics")
            case.bound(f"{title}: force imbalance of the heavy one / its weight", (on_heavy - pull) / (heavy * G) - 1.0, 1e-6, source="statics")
            case.bound(f"{title}: gap of the joint / edge", sim.joint("pin").gap / EDGE, 1e-9, source="statics")
        else:
            case.bound(f"{title}: error of the light one's force, relative", on_light / (light * G) - 1.0, 1e-6, source="statics")
            case.bound(f"{title}: error of the heavy one's force, relative", on_heavy / (heavy * G) - 1.0, 1e-6, source="statics")
        case.bound(f"{title}: overlap / edge", max(0.0, -min(sim.contact(key).gap for key in "lh")) / EDGE, 1e-6, source="statics")
        speed = max(float(np.abs(sim.body(body).velocity[:3]).max()) for body in bodies)
        case.bound(f"{title}: speed at the end", speed, 1e-6, source="Coulomb", unit="m/s")


def run(case):
    figure, (left, right) = plots.axes(2)
    stands(case, left)
    piles(case, right)
    ratios(case)
    pads(case)
    case.figure(figure, "Left: creep of the tower of ten; dashed: the bound. Right: piles come to rest.")
