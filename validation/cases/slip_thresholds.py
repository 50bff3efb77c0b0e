"""Friction at its limit: blocks on a slope and on a turntable, slightly below and slightly above the threshold."""

import numpy as np
import sinew
from scipy.integrate import solve_ivp

from suite import plots
from suite.case import observed_order

TITLE = "Slip thresholds: a slope of tan a = 0.5 and a turntable"
SETUP = """- A block of 40 x 40 x 20 mm on a slope of tan a = 0.5 rests if mu > tan a and slides at g (sin a - mu cos a) if mu < tan a.
  It is released for 2 s with mu = 0.505 and 0.495; creep and acceleration are measured in the last second. The acceleration
  comes from only 1 % of the weight's component along the slope, so a relative error of 1e-4 is 1e-6 of the forces that nearly
  cancel. The block is a box on a plane of the world and on a fixed box, in steps of 1 and 10 ms with each integrator; a box
  of triangles and its hull; and damped rubber of 1 MPa in elements of 10 mm. Steps satisfy the laws to 1e-10 of the forces,
  so a block at rest may creep by 1e-9 of its length.
- A box of 4 mm lies at r = 100 mm on a turntable that is turned by a motor or by a prescribed motion; mu = 0.5. It slips if r
  w^2 > mu g; the ratio is 0.99 and 1.01. The outer edge carries more pressure, but all friction is radial, so only the sum
  matters. Above the threshold a point obeys x'' = -mu g u/|u|, u = x' - w e_z x x. The distance moved outwards in 0.4 s is of
  first order with backward Euler; its limit is extrapolated from the two shortest steps. The size of the box changes the
  distance by (4/100)^2 = 1.6e-3 at most."""
SOURCES = {"Coulomb": "C. A. Coulomb, Theorie des machines simples (1785): rest where tan a < mu, else a = g (sin a - mu cos a)",
           "turntable": "a point on a turntable with Coulomb friction: slips where r w^2 > mu g, then by scipy's DOP853 to 1e-11"}
COST = 10
G, LENGTH = 9.81, 0.04
ANGLE = np.arctan(0.5)
REST, SLIDE = 0.505, 0.495
INTEGRATORS = {"backward-euler": "backward-euler", "bdf2": "bdf2", "generalized-alpha": "generalized-alpha",
               "event-driven": {"type": "event-driven", "restitution": 0.0}}


def load(bodies, contacts, step, integrator="backward-euler", gravity=(0.0, 0.0, -G), **more):
    return sinew.load({"sinew": 1, "integrator": integrator, "time_step": step, "gravity": list(gravity), "bodies": bodies,
                       "contacts": contacts, **more})


def write_box(folder, edges):
    """Writes a box of triangles, centred at the origin, as OBJ."""
    corners = 0.5 * np.array(edges) * (2.0 * np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 1.0)
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    path = folder / "block.obj"
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners)
                    + "".join(f"f {a + 1} {b + 1} {c + 1}\nf {a + 1} {c + 1} {d + 1}\n" for a, b, c, d in faces))
    return str(path)


class Slope:
    """A block released on a slope."""

    def __init__(self, block, on_box, friction, step, integrator="backward-euler"):
        self.soft = block["type"] == "fem"
        bodies, contact = {"block": block}, {"body": "block", "surface": {"plane": {}}}
        if on_box:
            bodies["slope"] = {"type": "rigid", "shape": {"box": [4.0, 1.0, 0.02]}, "fixed": True, "pose": {"position": [0, 0, -0.01]}}
            contact = {"between": ["block", "slope"]}
        self.sim = load(bodies, {"floor": {**contact, "friction": friction}}, step, integrator, [G * np.sin(ANGLE), 0.0, -G * np.cos(ANGLE)])

    def state(self):
        """Position and speed along the slope."""
        body = self.sim.body("block")
        if self.soft:
            return float(body.positions[:, 0].mean()), float(body.velocities[:, 0].mean())
        return float(body.position[0]), float(body.velocity[0])

    def watch(self):
        """Creep and acceleration during the second of two seconds."""
        self.sim.run(duration=1.0)
        place, speed = self.state()
        self.sim.run(duration=1.0)
        later = self.state()
        return later[0] - place, later[1] - speed


def slides(case, axis):
    rigid = {"type": "rigid", "mass": 0.1, "pose": {"position": [0.0, 0.0, 0.01]}}
    box = {**rigid, "shape": {"box": [LENGTH, LENGTH, 0.02]}}
    file = write_box(case.scratch, [LENGTH, LENGTH, 0.02])
    surface, hull = ({**rigid, "mesh": {"file": file, "use": use}} for use in ("surface", "convex"))
    soft = {"type": "fem", "element": "hex8", "density": 1000.0, "damping": {"stiffness": 2e-3}, "pose": {"position": [-0.5 * LENGTH, -0.5 * LENGTH, 0.0]},
            "mesh": {"shape": "block", "length": LENGTH, "width": LENGTH, "height": 0.02, "element_size": 0.01},
            "material": {"model": "neo-hookean", "young_modulus": 1e6, "poisson_ratio": 0.3}}
    theory = G * (np.sin(ANGLE) - SLIDE * np.cos(ANGLE))
    for name, integrator in INTEGRATORS.items():
        crept, worst = 0.0, 0.0
        for on_box in (False, True):
            for step in (1e-3, 1e-2):
                crept = max(crept, abs(Slope(box, on_box, REST, step, integrator).watch()[0]))
                worst = max(worst, abs(Slope(box, on_box, SLIDE, step, integrator).watch()[1] / theory - 1.0))
        case.bound(f"box, {name}: creep in 1 s at mu = 0.505 / its length, 1 and 10 ms", crept / LENGTH, 1e-9, source="Coulomb")
        case.check(f"box, {name}: acceleration at mu = 0.495 / (g (sin a - mu cos a)), 1 and 10 ms", 1.0 + worst, 1.0, 1e-4, source="Coulomb")
    for name, block, on_box, step in (("surface of triangles on a box", surface, True, 2e-3), ("hull on a box", hull, True, 2e-3),
                                      ("hull on a plane", hull, False, 2e-3), ("rubber on a plane", soft, False, 5e-3),
                                      ("rubber on a box", soft, True, 5e-3)):
        crept = abs(Slope(block, on_box, REST, step).watch()[0])
        case.bound(f"{name}: creep in 1 s at mu = 0.505 / its length", crept / LENGTH, 1e-9, source="Coulomb")
        case.check(f"{name}: acceleration at mu = 0.495", Slope(block, on_box, SLIDE, step).watch()[1], theory, 1e-4, source="Coulomb",
                   unit="m/s^2")
    frictions = np.concatenate([np.linspace(0.4, 0.49, 7), [SLIDE, REST], np.linspace(0.51, 0.6, 7)])
    axis.plot(frictions, np.maximum(0.0, G * (np.sin(ANGLE) - frictions * np.cos(ANGLE))), color=plots.REFERENCE, lw=1, label="Coulomb")
    axis.plot(frictions, [Slope(box, True, float(mu), 1e-2).watch()[1] for mu in frictions], "o", color=plots.OURS, label="Sinew, box")
    axis.plot([SLIDE, REST], [Slope(soft, True, mu, 5e-3).watch()[1] for mu in (SLIDE, REST)], "s", mfc="none", color=plots.SECOND,
              label="Sinew, rubber")
    axis.set(xlabel="friction on a slope of tan 0.5", ylabel="acceleration (m/s^2)")
    axis.legend()


RADIUS, FRICTION, EDGE, TIME = 0.1, 0.5, 0.004, 0.4


def turned(ratio, step, given=False):
    """Outward displacement of the box after each step."""
    rate = float(np.sqrt(ratio * FRICTION * G / RADIUS))
    plate, more = {"type": "rigid", "shape": {"cylinder": {"radius": 0.3, "height": 0.02}}, "pose": {"position": [0, 0, -0.01]}}, {}
    if given:
        plate["motion"] = {"axis": [0, 0, 1], "angle": {"ramp": {"to": 10.0 * rate, "duration": 10.0}}}
    else:
        plate |= {"mass": 5.0, "velocity": {"angular": [0, 0, rate]}}
        more = {"joints": {"shaft": {"type": "hinge", "bodies": ["world", "plate"], "point": [0, 0, 0], "axis": "z"}},
                "actuators": {"motor": {"type": "motor", "joint": "shaft", "command": {"velocity": rate}}}}
    box = {"type": "rigid", "shape": {"box": [EDGE, EDGE, 0.5 * EDGE]}, "density": 1000.0, "pose": {"position": [RADIUS, 0, 0.25 * EDGE]},
           "velocity": {"linear": [0, rate * RADIUS, 0], "angular": [0, 0, rate]}}
    sim = load({"box": box, "plate": plate}, {"floor": {"between": ["box", "plate"], "friction": FRICTION}}, step, **more)
    seen = []
    for _ in range(round(TIME / step)):
        sim.step()
        seen.append(np.hypot(*sim.body("box").position[:2]) - RADIUS)
    return np.array(seen)


def point_on_turntable(ratio, times):
    rate = np.sqrt(ratio * FRICTION * G / RADIUS)

    def motion(_, state):
        slip = state[2:] - rate * np.array([-state[1], state[0]])
        return [*state[2:], *(-FRICTION * G * slip / np.linalg.norm(slip))]

    # A tiny initial outward velocity determines the slip direction.
    state = solve_ivp(motion, (0.0, TIME), [RADIUS, 0.0, 1e-7, rate * RADIUS], method="DOP853", rtol=1e-11, atol=1e-13, t_eval=times).y
    return np.hypot(state[0], state[1]) - RADIUS


def turntables(case, axis):
    steps = (4e-3, 2e-3, 1e-3)
    for name, given in (("motor", False), ("motion given", True)):
        held = [np.abs(turned(0.99, step, given)).max() for step in steps]
        case.bound(f"turntable, {name}: slip in 0.4 s at r w^2 = 0.99 mu g / r, 1 to 4 ms", max(held) / RADIUS, 1e-7, source="turntable")
        slipped = [turned(1.01, step, given) for step in steps]
        ends = np.array([way[-1] for way in slipped])
        theory = point_on_turntable(1.01, [TIME])[0]
        case.check(f"turntable, {name}: distance moved outwards in 0.4 s at r w^2 = 1.01 mu g, extrapolated to step 0", 2.0 * ends[-1] - ends[-2], theory, 5e-3,
                   source="turntable", unit="m")
        case.check(f"turntable, {name}: order of the distance", observed_order(steps, ends - theory), 1.0, 0.1, source="turntable", relative=False)
    times = np.linspace(0.0, TIME, 81)
    axis.plot(times, 1e3 * point_on_turntable(1.01, times), color=plots.REFERENCE, lw=1, label="point, 1.01")
    for step, way in zip(steps, slipped):
        axis.plot(step * np.arange(1, len(way) + 1), 1e3 * way, "--", label=f"box, 1.01, {1e3 * step:g} ms")
    way = turned(0.99, steps[-1])
    axis.plot(steps[-1] * np.arange(1, len(way) + 1), 1e3 * way, color=plots.THIRD, label="box, 0.99")
    axis.set(xlabel="time (s)", ylabel="distance moved outwards on a turntable (mm)")
    axis.legend(fontsize=8)


def run(case):
    figure, (left, right) = plots.axes(2)
    slides(case, left)
    turntables(case, right)
    case.figure(figure, "Left: acceleration of blocks on a slope against friction. Right: a box on a turntable.")
