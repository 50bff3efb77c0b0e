"""Impacts of rigid bodies: restitution by event-driven integration."""

import numpy as np
import sinew
from scipy.special import ellipk

from suite import plots
from suite.case import observed_order

TITLE = "Restitution: a bouncing ball, a ball with spin, a pendulum that strikes a wall"
SETUP = """Event-driven integration.

- A ball falls through a vertical distance of h = 0.5 m to a floor that is level or inclined by 0.3 rad; e = 0.5 and 0.9,
  steps of 20 ms. Each flight takes e times as long as the previous one, and all of them together take sqrt(2 h/g) (1 + e)/(1
  - e).
- A ball with spin strikes a floor obliquely, e = 0.6: Newton's law with friction in Moreau's form, sticking and sliding.
- A ball on a rod, hinged at the other end, strikes a wall at its lowest point, e = 0.8: sin(amplitude/2) falls by the factor
  e, and the next impact follows after half the period of that amplitude."""
SOURCES = {"flights": "free fall between impacts that each leave e of the velocity: a geometric series",
           "Moreau": "J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988): one coefficient along and across; "
                     "the inertia of a ball's point is 2/7 m across",
           "pendulum": "period 4 sqrt(L/g) K(sin(amplitude/2)), the complete elliptic integral by scipy"}
COST = 3
G, RADIUS, MASS = 9.81, 0.05, 2.0


def load(bodies, contacts, step, restitution, gravity=(0.0, 0.0, -G), **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": {"type": "event-driven", "restitution": restitution},
                       "gravity": list(gravity), "bodies": bodies, "contacts": contacts, **more})


def ball(at, **more):
    return {"type": "rigid", "shape": {"sphere": {"radius": RADIUS}}, "mass": MASS, "pose": {"position": [float(x) for x in at]}, **more}


def floor(normal=(0.0, 0.0, 1.0), **more):
    return {"floor": {"body": "ball", "surface": {"plane": {"normal": [float(x) for x in normal]}}, **more}}


def bounces(case, axis):
    height = 0.5
    first = np.sqrt(2.0 * height / G)
    for slope in (0.0, 0.3):
        normal, fall = np.array([np.sin(slope), 0.0, np.cos(slope)]), G * np.cos(slope)
        for restitution in (0.5, 0.9):
            begins = first * (1.0 + 2.0 * restitution * (1.0 - restitution ** np.arange(400)) / (1.0 - restitution))
            end = first * (1.0 + restitution) / (1.0 - restitution)
            sim = load({"ball": ball((height * np.cos(slope) + RADIUS) * normal)}, floor(normal), 0.02, restitution)
            times, gaps, errors, rests, last = [], [], [0.0], None, 0.0
            while sim.time < 1.1 * end:
                sim.step()
                body = sim.body("ball")
                gap, rate = normal @ body.position - RADIUS, normal @ body.velocity[:3]
                times.append(sim.time)
                gaps.append(gap)
                if first < sim.time < 0.95 * end:
                    begin = sim.time - (np.sqrt(rate**2 + 2.0 * fall * gap) - rate) / fall
                    errors.append(np.abs(begins - begin).min() / begin)
                # While the ball bounces, the present flight determines the rest of the series.
                speed = np.sqrt(max(rate**2 + 2.0 * fall * gap, 0.0))
                if speed > 1e-6:
                    last = sim.time + (speed + rate) / fall + 2.0 * restitution * speed / fall / (1.0 - restitution)
                elif rests is None:
                    rests = sim.time
            name = f"ball, e = {restitution:g}, {'level' if slope == 0.0 else 'inclined'} floor, 20 ms"
            case.bound(f"{name}: relative error of the impact times", max(errors), 1e-6, source="flights")
            case.check(f"{name}: time at which it comes to rest", last, end, 1e-3, source="flights", unit="s")
            case.bound(f"{name}: rests later than in the step with that time", max(0.0, rests - end - 0.02), 1e-3 * end, source="flights", unit="s")
            if slope == 0.0:
                axis.plot(times, gaps, ".", ms=3, color=plots.OURS if restitution == 0.9 else plots.SECOND, label=f"e = {restitution:g}, Sinew")
    axis.set(xlabel="time (s)", ylabel="height (m)")
    axis.legend(fontsize=7)


def spins(case):
    restitution, before, spin = 0.6, np.array([1.5, 0.5, -3.0]), np.array([20.0, 30.0, 7.0])
    arm = np.array([0.0, 0.0, -RADIUS])
    slip = (before + np.cross(spin, arm)) * [1, 1, 0]
    for friction in (0.1, 0.8):
        sim = load({"ball": ball((0, 0, 0.1), velocity={"linear": list(before), "angular": list(spin)})}, floor(friction=friction), 5e-3,
                   restitution, gravity=(0.0, 0.0, 0.0))
        sim.run(duration=0.04)
        normal = MASS * (1.0 + restitution) * 3.0
        impulse = -2.0 / 7.0 * MASS * (1.0 + restitution) * slip
        impulse *= min(1.0, friction * normal / np.linalg.norm(impulse))
        impulse[2] = normal
        after = np.concatenate([before + impulse / MASS, spin + np.cross(arm, impulse) / (0.4 * MASS * RADIUS**2)])
        error = np.abs(np.array(sim.body("ball").velocity) - after).max() / np.abs(after).max()
        case.bound(f"spinning ball, mu = {friction:g}: error of velocity and spin after the impact / the largest", error, 1e-9, source="Moreau")


def swings(case, axis):
    restitution, start, length = 0.8, 0.8, 0.4
    reduced = length + 0.4 * RADIUS**2 / length
    half = lambda sine: 2.0 * np.sqrt(reduced / G) * ellipk(sine**2)
    sines = np.sin(0.5 * start) * restitution ** np.arange(1, 5)
    moments = 0.5 * half(np.sin(0.5 * start)) + np.concatenate([[0.0], np.cumsum([half(sine) for sine in sines[:-1]])])
    steps, errors = (8e-3, 4e-3, 2e-3, 1e-3), []
    for step in steps:
        at = length * np.array([-np.sin(start), 0.0, -np.cos(start)])
        sim = load({"ball": ball(at)}, {"wall": {"body": "ball", "surface": {"plane": {"point": [RADIUS, 0, 0], "normal": [-1, 0, 0]}}}}, step,
                   restitution, joints={"hinge": {"type": "hinge", "bodies": ["world", "ball"], "point": [0, 0, 0], "axis": "y"}})
        found = []
        while len(found) < len(moments):
            sim.step()
            if sim.report.impacts == 0:
                continue
            body = sim.body("ball")
            found.append(sim.time + np.arctan2(body.position[0], -body.position[2]) / body.velocity[4])
        errors.append(np.abs(np.array(found) / moments - 1.0).max())
    case.bound("pendulum, 1 ms: relative error of four impact times", errors[-1], 1e-5, source="pendulum")
    case.check("pendulum: order of the impact times", observed_order(steps, errors), 2.0, 0.2, source="pendulum", relative=False)
    axis.loglog(steps, errors, "o-", color=plots.OURS, label="impact times")
    axis.set(xlabel="time step (s)", ylabel="relative error")
    axis.legend(fontsize=7)


def run(case):
    figure, (left, right) = plots.axes(2)
    bounces(case, left)
    spins(case)
    swings(case, right)
    case.figure(figure, "Left: the ball's height at the ends of steps of 20 ms. Right: errors of the pendulum's impact times.")
