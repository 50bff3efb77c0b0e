"""Rigid bodies that skid, roll, and slide on a spring."""

import numpy as np
import sinew
from scipy.optimize import brentq

from suite import plots
from suite.case import observed_order

TITLE = "Rolling and sliding: a skidding ball, a turntable, a leaning disc, friction oscillators"
SETUP = """Backward Euler or BDF2. The rolling point is located where the shapes touch at the end of each step, so rolling is of the order of
the integrator.

- A ball, r = 20 mm, 100 g, is thrown along x at 0.6 m/s with a spin of (25, 10, 0) rad/s, mu = 0.2, and skids sideways. The
  direction of the slip u is constant, and so is friction. The path is a parabola until t = 2 |u|/(7 mu g); then the ball
  rolls at v - 2/7 u. No moment acts about the vertical.
- The ball rolls on a turntable of 1 m at 7 rad/s. Seen from the world, it moves on a circle at 2/7 of that rate, at any
  velocity.
- A disc, r = 30 mm, 4 mm thick, rolls on its rim in a circle at 4 rad/s, leaning by 15 degrees. By Euler's equations its
  steady spin is 11.1 rad/s about its axis. Lean and energy should be constant; they are recorded for 0.2 s.
- A box of 1 kg on a spring of 100 N/m is pulled out by 50 mm, mu = 0.05. Each half period reduces the amplitude by 2 mu m g/k
  until the box rests. Then a force of 2 N sin(w t) acts, with w from 0.45 to 1.4 of the natural frequency, mu = 0.06; the
  reference is Den Hartog's amplitude of motion without stops, after 25 periods."""
SOURCES = {"Coulomb": "skidding of a homogeneous ball with Coulomb friction: constant deceleration, then rolling",
           "turntable": "R. H. Romer, Motion of a sphere on a tilted turntable, Am. J. Phys. 49 (1981) 985: 2/7 of the table's rate",
           "Euler": "steady motion of a rolling disc: d/dt of the angular momentum in the frame that precesses; the root by scipy's brentq",
           "oscillator": "free vibration with dry friction: 2 mu N/k a half period",
           "Den Hartog": "J. P. Den Hartog, Forced vibrations with combined Coulomb and viscous friction, Trans. ASME 53 (1931) 107: X = F/k "
                         "sqrt(V^2 - (mu N/F)^2 U^2), V = 1/(1 - b^2), U = sin(pi/b)/(b (1 + cos(pi/b)))"}
COST = 15
G, RADIUS, MASS = 9.81, 0.02, 0.1


def load(bodies, contacts, step, integrator, **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": [0.0, 0.0, -G], "bodies": bodies,
                       "contacts": contacts, **more})


def table():
    return {"type": "rigid", "shape": {"box": [4.0, 4.0, 0.02]}, "fixed": True, "pose": {"position": [0, 0, -0.01]}}


def ball(at, speed, spin):
    return {"type": "rigid", "shape": {"sphere": {"radius": RADIUS}}, "mass": MASS, "pose": {"position": [*at, RADIUS]},
            "velocity": {"linear": [*speed, 0.0], "angular": [*spin, 0.0]}}


def skids(case, axis, convergence):
    friction, speed, spin, duration = 0.2, np.array([0.6, 0.0]), np.array([25.0, 10.0]), 0.2
    slip = speed - RADIUS * np.array([spin[1], -spin[0]])
    size = np.linalg.norm(slip)
    rolls, last = 2.0 * size / (7.0 * friction * G), speed - 2.0 / 7.0 * slip

    def way(time):
        skidding = np.minimum(time, rolls)[:, None]
        return speed * skidding - 0.5 * friction * G * slip / size * skidding**2 + last * np.maximum(time - rolls, 0.0)[:, None]

    steps = (4e-3, 2e-3, 1e-3, 5e-4)
    for integrator, color in (("backward-euler", plots.THIRD), ("bdf2", plots.OURS)):
        errors, spins = [], []
        for step in steps:
            sim = load({"ball": ball([0.0, 0.0], speed, spin), "table": table()}, {"floor": {"between": ["ball", "table"], "friction": friction}},
                       step, integrator)
            seen, stuck = [np.zeros(2)], None
            for _ in range(round(duration / step)):
                sim.step()
                seen.append(np.array(sim.body("ball").position[:2]))
                if stuck is None and "stick" in sim.contact("floor").states:
                    stuck = sim.time
            theory = way(step * np.arange(len(seen)))
            errors.append(np.abs(seen[-1] - theory[-1]).max() / np.linalg.norm(theory[-1]))
            spins.append(abs(float(sim.body("ball").velocity[5])))
        order = 1.0 if integrator == "backward-euler" else 2.0
        name = f"skidding ball, {integrator}, 0.5 ms"
        case.check(f"{name}: time at which it rolls", stuck, rolls, 2.0 * steps[-1] / rolls, source="Coulomb", unit="s")
        case.bound(f"{name}: velocity then / initial velocity", np.abs(np.array(sim.body("ball").velocity[:2]) - last).max() / 0.6, 1e-4,
                   source="Coulomb")
        case.bound(f"{name}: error of the position after 0.2 s / distance", errors[-1], 1e-3, source="Coulomb")
        case.check(f"skidding ball, {integrator}: order of the position", observed_order(steps, errors), order, 0.3, source="Coulomb", relative=False)
        case.bound(f"{name}: spin about the vertical", spins[-1], 1e-6, source="Coulomb", unit="rad/s")
        convergence.loglog(steps, errors, "o-", color=color, label=f"skid, {integrator}")
    axis.plot(*(1e3 * theory.T), color=plots.REFERENCE, lw=1, label="skid: parabola, then straight")
    axis.plot(*(1e3 * np.array(seen)[::20].T), "o", ms=3, color=plots.OURS, label="skid, Sinew")


def circles(case, axis, convergence):
    turn, at, speed = 7.0, np.array([0.1, 0.0]), np.array([0.05, 0.1])
    slip = turn * np.array([-at[1], at[0]]) - speed
    duration = 7.0 * np.pi / turn
    centre, radius = at + np.array([-speed[1], speed[0]]) * 3.5 / turn, np.linalg.norm(speed) * 3.5 / turn
    plate = {"type": "rigid", "shape": {"cylinder": {"radius": 0.5, "height": 0.02}}, "mass": 5.0, "pose": {"position": [0, 0, -0.01]},
             "velocity": {"angular": [0, 0, turn]}}
    steps = (2e-3, 1e-3, 5e-4, 2.5e-4)
    for integrator, color in (("backward-euler", plots.THIRD), ("bdf2", plots.OURS)):
        errors = []
        for step in steps:
            sim = load({"ball": ball(at, speed, [slip[1] / RADIUS, -slip[0] / RADIUS]), "plate": plate},
                       {"floor": {"between": ["ball", "plate"], "friction": 0.8}}, step, integrator,
                       joints={"shaft": {"type": "hinge", "bodies": ["world", "plate"], "point": [0, 0, 0], "axis": "z"}},
                       actuators={"motor": {"type": "motor", "joint": "shaft", "command": {"velocity": turn}}},
                       solver={"tolerance": 1e-12})  # what iterations leave adds up over 12 600 steps
            seen = []
            for _ in range(round(duration / step)):
                sim.step()
                seen.append(np.array(sim.body("ball").position[:2]) - centre)
            seen = np.array(seen)
            angle = np.unwrap(np.arctan2(seen[:, 1], seen[:, 0]))
            ahead = 2.0 / 7.0 * turn * step * len(seen)
            exact = np.array([[np.cos(ahead), -np.sin(ahead)], [np.sin(ahead), np.cos(ahead)]]) @ (at - centre)
            errors.append(np.linalg.norm(seen[-1] - exact) / radius)
        rate = (angle[-1] - angle[0]) / (step * (len(angle) - 1))
        case.check(f"turntable, {integrator}, 0.25 ms: rate of the ball / rate of the table", rate / turn, 2.0 / 7.0, 1e-3, source="turntable")
        case.check(f"turntable, {integrator}, 0.25 ms: radius after a turn / initial radius", np.linalg.norm(seen[-1]) / radius, 1.0, 0.01,
                   source="turntable")
        # With the finest step, what iterations leave is a tenth of the error.
        case.check(f"turntable, {integrator}: order of the position", np.log2(errors[-3] / errors[-2]), 2.0, 0.2, source="turntable",
                   relative=False)
        convergence.loglog(steps, errors, "s--", color=color, label=f"turntable, {integrator}")
    fine = np.linspace(0.0, 2.0 * np.pi, 200)
    axis.plot(*(1e3 * (centre[:, None] + radius * np.array([np.cos(fine), np.sin(fine)]))), "--", color=plots.REFERENCE, lw=1,
              label="turntable: circle")
    axis.plot(*(1e3 * (centre + seen)[::400].T), "s", ms=3, color=plots.SECOND, label="turntable, Sinew")
    axis.set(xlabel="x (mm)", ylabel="y (mm)", aspect="equal")
    axis.legend(fontsize=7)


class Disc:
    """A disc that rolls on its rim at a steady lean."""

    def __init__(self, step, integrator, turn=4.0, radius=0.03, height=0.004, mass=0.05):
        self.mass, lean, up = mass, np.radians(75), np.array([0.0, 0.0, 1.0])
        self.across, self.axial = mass * (3.0 * radius**2 + height**2) / 12.0, 0.5 * mass * radius**2
        axis = np.array([np.sin(lean), 0.0, np.cos(lean)])
        dip = up - up @ axis * axis
        lever = radius * dip / np.linalg.norm(dip) + 0.5 * height * axis  # from the floor to the centre

        def steady(own):
            spin = turn * up + own * axis
            speed = np.cross(spin, lever)
            force = mass * (turn * np.cross(up, speed) + G * up)
            momentum = self.across * spin + (self.axial - self.across) * (spin @ axis) * axis
            return spin, speed, (np.cross(-lever, force) - turn * np.cross(up, momentum))[1]

        spin, speed, _ = steady(brentq(lambda own: steady(own)[2], -30.0, 0.0))
        disc = {"type": "rigid", "shape": {"cylinder": {"radius": radius, "height": height}}, "mass": mass,
                "pose": {"position": [0.0, 0.0, lever[2]], "rotation": [0.0, lean, 0.0]}, "velocity": {"linear": list(speed), "angular": list(spin)}}
        self.sim = load({"disc": disc, "table": table()}, {"floor": {"between": ["disc", "table"], "friction": 0.9}}, step, integrator)

    def state(self):
        """Lean of the axis (degrees) and energy (J)."""
        body = self.sim.body("disc")
        w, x, y, z = body.rotation
        axis, velocity = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]), np.array(body.velocity)
        own = velocity[3:] @ axis
        energy = 0.5 * self.mass * velocity[:3] @ velocity[:3] + 0.5 * self.across * (velocity[3:] @ velocity[3:] - own**2)
        return np.degrees(np.arccos(axis[2])), energy + 0.5 * self.axial * own**2 + self.mass * G * body.position[2]


def discs(case, convergence):
    steps = (5e-4, 2.5e-4, 1.25e-4)
    for integrator, color in (("backward-euler", plots.THIRD), ("bdf2", plots.OURS)):
        leans, gains = [], []
        for step in steps:
            disc = Disc(step, integrator)
            first = disc.state()[1]
            disc.sim.run(duration=0.2)
            lean, energy = disc.state()
            leans.append(abs(lean - 75.0))
            gains.append(energy / first - 1.0)
        case.check(f"leaning disc, {integrator}, 0.125 ms: lean of its axis after 0.2 s", lean, 75.0, 0.01, source="Euler", unit="deg")
        case.bound(f"leaning disc, {integrator}, 0.125 ms: energy gained in 0.2 s, relative", max(0.0, gains[-1]), 1e-9, source="Euler")
        case.check(f"leaning disc, {integrator}: order of the change of its energy", observed_order(steps, gains),
                   1.0 if integrator == "backward-euler" else 2.0, 0.1, source="Euler", relative=False)
        convergence.loglog(steps, np.abs(gains), "^:", color=color, label=f"disc's energy, {integrator}")


SPRING, WEIGHT = 100.0, 1.0


def sprung(friction, pulled, step, integrator, **more):
    """A box of 1 kg on a spring along x, at rest `pulled` m beyond its free length."""
    box = {"type": "rigid", "shape": {"box": [0.04, 0.04, 0.02]}, "mass": WEIGHT, "pose": {"position": [0, 0, 0.01]}}
    spring = {"type": "spring", "body": "box", "pull": "world", "points": [[-1.0, 0, 0.01], [0, 0, 0.01]], "stiffness": SPRING,
              "free_length": 1.0 - pulled}
    return load({"box": box, "table": table()}, {"floor": {"between": ["box", "table"], "friction": friction}}, step, integrator,
                actuators={"spring": spring, **more})


def decays(case, axis, convergence, pulled=0.05, friction=0.05):
    natural, drop = np.sqrt(SPRING / WEIGHT), 2.0 * friction * WEIGHT * G / SPRING
    halves = int(np.ceil((pulled - 0.5 * drop) / drop))
    rest = (-1.0)**halves * (pulled - halves * drop)
    steps = (4e-3, 2e-3, 1e-3, 5e-4)
    for integrator, color in (("backward-euler", plots.THIRD), ("bdf2", plots.OURS)):
        errors = []
        for step in steps:
            sim = sprung(friction, pulled, step, integrator)
            seen = [pulled]
            for _ in range(round(2.0 / step)):
                sim.step()
                seen.append(pulled + float(sim.body("box").position[0]))
            errors.append(abs(seen[-1] - rest) / pulled)
        moving = step * (1 + np.flatnonzero(np.abs(np.diff(seen)) > 1e-12)[-1])
        case.check(f"oscillator, {integrator}, 0.5 ms: time at which it stops", moving, halves * np.pi / natural, 5e-3, source="oscillator", unit="s")
        if integrator == "bdf2":
            case.bound("oscillator, bdf2, 0.5 ms: position at rest / initial position", errors[-1], 1e-3, source="oscillator")
        else:
            case.check("oscillator, backward-euler: order of the position at rest", observed_order(steps[1:], errors[1:]), 1.0, 0.2,
                       source="oscillator", relative=False)
        case.bound(f"oscillator, {integrator}: creep in the last 0.1 s", abs(seen[-1] - seen[-201]), 1e-12, source="oscillator", unit="m")
        convergence.loglog(steps, errors, "x-", color=color, label=f"rest, {integrator}")
    time = step * np.arange(len(seen))
    half = np.minimum((time * natural / np.pi).astype(int), halves)
    theory = np.where(half < halves, (pulled - (half + 0.5) * drop) * np.cos(natural * time) + (-1.0)**half * 0.5 * drop, rest)
    axis.plot(time, 1e3 * theory, color=plots.REFERENCE, lw=1, label="closed form")
    axis.plot(time[::40], 1e3 * np.array(seen)[::40], "o", ms=3, color=plots.OURS, label="Sinew, free")
    axis.set(xlabel="time (s)", ylabel="x (mm)")
    axis.legend()


def forced(case, force=2.0, friction=0.06, step=1e-3):
    natural, worst, ratios = np.sqrt(SPRING / WEIGHT), 0.0, (0.45, 0.6, 0.75, 1.2, 1.4)
    for ratio in ratios:
        period = 2.0 * np.pi / (ratio * natural)
        sim = sprung(friction, 0.0, step, "bdf2", shaker={"type": "force", "body": "box", "point": [0, 0, 0.01], "direction": [1, 0, 0],
                                                          "command": {"force": {"sine": {"amplitude": force, "period": period}}}})
        sim.run(duration=25.0 * period)
        seen = []
        for _ in range(round(period / step)):
            sim.step()
            seen.append(float(sim.body("box").position[0]))
        gain = 1.0 / (1.0 - ratio**2)
        hold = np.sin(np.pi / ratio) / (ratio * (1.0 + np.cos(np.pi / ratio)))
        theory = force / SPRING * np.sqrt(gain**2 - (friction * WEIGHT * G / force * hold)**2)
        worst = max(worst, abs(max(seen) / theory - 1.0))
    case.check(f"forced oscillator, bdf2, 1 ms: amplitude / Den Hartog's, worst of {len(ratios)}", 1.0 + worst, 1.0, 0.01, source="Den Hartog")


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    skids(case, left, middle)
    circles(case, left, middle)
    discs(case, middle)
    decays(case, right, middle)
    forced(case)
    middle.set(xlabel="time step (s)", ylabel="relative error")
    middle.legend(fontsize=6)
    case.figure(figure, "Left: paths of the skidding ball and of the ball on the turntable, with the finest steps. Middle: errors against time "
                        "step. Right: the box on its spring comes to rest.")
