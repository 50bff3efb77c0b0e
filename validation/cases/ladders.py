"""Rigid bodies that lean, slide and lose contact: ladders, a card tent, balls on a sphere."""

import numpy as np
import sinew
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from suite import plots
from suite.case import observed_order

TITLE = "Ladders, a card tent, and balls that leave a sphere"
SETUP = """- *Ladder with friction.* A capsule of l = 300 mm between the centres of its ends, r = 2 mm, 100 g, leans on a wall with mu =
  0.2 or 0.4 and a floor with mu = 0.4 or 0.3. Balance with both contacts at their limits gives the least angle. The ladder
  stands 0.1 degrees above it and slides 0.1 degrees below.
- *Tent.* Two cards of 100 x 1 mm at 60 degrees stand if mu on the floor exceeds cot(60)/2, minus a small correction because
  thick cards stand on corners. Where corner meets corner, the normal may have any direction between those of the faces. Sinew
  takes the normal of a face, 30 degrees from the force, which mu = 0.9 between the cards can carry.
- *Ladder without friction*, released at 75 degrees: (m l^2/4 + I) theta'' = -m g l/2 cos(theta), until the force on the wall
  vanishes at sin(theta) = 2/3 sin(75); then it keeps its horizontal speed.
- *Ball*, r = 20 mm, released 0.2 rad from the top of a fixed sphere, R = 80 mm. Without friction it leaves at cos = 2/3
  cos(0.2). With mu = 100 it rolls and leaves at 10/17 cos(0.2). The angle at which the normal force vanishes is interpolated
  linearly between two steps."""
SOURCES = {"Coulomb": "statics with Coulomb friction at its limits",
           "ladder": "energy: theta'^2 = 3 g/l (sin(start) - sin(theta)), leaves where sin(theta) = 2/3 sin(start)",
           "sphere": "energy and centripetal force: m v^2/(R + r) = m g cos, with v^2 = 2 g (R + r)(cos(start) - cos)/(1 + k), k = 0 or 2/5"}
COST = 3
G, LENGTH, RADIUS, MASS = 9.81, 0.3, 0.002, 0.1


def load(bodies, contacts, step, integrator="backward-euler"):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": [0.0, 0.0, -G], "bodies": bodies, "contacts": contacts})


def box(at, size, **more):
    return {"type": "rigid", "shape": {"box": list(size)}, "pose": {"position": list(at), **more.pop("pose", {})}, **more}


FLOOR = box([0.0, 0.0, -0.05], [2.0, 2.0, 0.1], fixed=True)
WALL = box([-0.05, 0.0, 0.5], [0.1, 2.0, 1.2], fixed=True)


def ladder(angle, step, wall, floor, integrator="backward-euler"):
    """A ladder that leans on the plane x = 0, with its foot at x > 0."""
    foot = np.array([RADIUS + LENGTH * np.cos(angle), 0.0, RADIUS])
    top = np.array([RADIUS, 0.0, RADIUS + LENGTH * np.sin(angle)])
    body = {"type": "rigid", "shape": {"capsule": {"radius": RADIUS, "length": LENGTH}}, "mass": MASS,
            "inertia": [MASS * LENGTH**2 / 12.0] * 2 + [0.5 * MASS * RADIUS**2],
            "pose": {"position": list(0.5 * (foot + top)), "rotation": [0.0, angle - 0.5 * np.pi, 0.0]}}
    return load({"ladder": body, "floor": FLOOR, "wall": WALL}, {"on_floor": {"between": ["ladder", "floor"], "friction": floor},
                                                                 "on_wall": {"between": ["ladder", "wall"], "friction": wall}}, step, integrator)


def least_angle(wall, floor):
    def balance(angle):
        weight = 0.5 * (1.0 + wall * floor) * LENGTH * np.cos(angle)
        return weight - floor * (RADIUS + LENGTH * np.sin(angle) + wall * (RADIUS + LENGTH * np.cos(angle)))

    return brentq(balance, 0.1, 1.5)


def leans(case):
    for wall, floor in ((0.2, 0.4), (0.4, 0.3)):
        least = least_angle(wall, floor)
        for aside in (0.1, -0.1):
            sim = ladder(least + np.radians(aside), 2e-3, wall, floor)
            start = np.array(sim.body("ladder").position)
            sim.run(duration=1.0)
            moved = np.linalg.norm(np.array(sim.body("ladder").position) - start) / LENGTH
            name = f"ladder, mu = {wall:g} and {floor:g}, {abs(aside)} degrees {'above' if aside > 0 else 'below'} {np.degrees(least):.2f}"
            if aside > 0.0:
                case.bound(f"{name}: motion in 1 s / length", moved, 1e-6, source="Coulomb")
            else:
                case.agree(f"{name}: it slides", bool(moved > 1e-3), True, source="Coulomb")


def tents(case, length=0.1, thick=0.001, lean=np.radians(60)):
    along, across = np.array([np.cos(lean), 0.0, np.sin(lean)]), np.array([-np.sin(lean), 0.0, np.cos(lean)])
    # The left card leans to the right: it stands on the corner at -along, -across, and meets the other one at +along, -across.
    foot, head = -0.5 * length * along - 0.5 * thick * across, 0.5 * length * along - 0.5 * thick * across
    least = abs(foot[0]) / (head[2] - foot[2])  # moment balance about the foot: weight against the other card
    for ratio in (1.01, 0.99):
        cards = {}
        for name, side in (("left", 1.0), ("right", -1.0)):
            cards[name] = box([-side * head[0], 0.0, -foot[2]], [length, 0.06, thick], mass=0.01,
                              pose={"rotation": [0.0, -lean if side > 0 else lean, 0.0]})
        sim = load({**cards, "floor": FLOOR}, {"a": {"between": ["left", "floor"], "friction": ratio * least},
                                               "b": {"between": ["right", "floor"], "friction": ratio * least},
                                               "head": {"between": ["left", "right"], "friction": 0.9}}, 2e-3)
        start = np.array(sim.body("left").position)
        sim.run(duration=1.0)
        moved = np.linalg.norm(np.array(sim.body("left").position) - start) / length
        if ratio > 1.0:
            case.bound(f"card tent, mu = {ratio:g} x {least:.5f}: motion in 1 s / card length", moved, 1e-6, source="Coulomb")
        else:
            case.agree(f"card tent, mu = {ratio:g} x {least:.5f}: it falls", bool(moved > 1e-2), True, source="Coulomb")


def leaves(sim, contact, angle, step, duration):
    """Angles over time, and the angle at which the normal force, extrapolated from two steps, vanishes."""
    angles, forces = [], []
    for _ in range(round(duration / step)):
        sim.step()
        angles.append(angle())
        forces.append(sim.contact(contact).normal_force)
    last = np.flatnonzero(np.array(forces) > 0.0)[-1]
    share = forces[last] / (forces[last - 1] - forces[last])
    return np.array(angles), angles[last] + share * (angles[last] - angles[last - 1])


def slides(case, history, convergence, start=np.radians(75)):
    steps, duration = (4e-3, 2e-3, 1e-3, 5e-4), 0.36
    leave = np.arcsin(2.0 / 3.0 * np.sin(start))
    for integrator, order, color in (("backward-euler", 1.0, plots.THIRD), ("bdf2", 2.0, plots.OURS)):
        errors = []
        for step in steps:
            sim = ladder(start, step, 0.0, 0.0, integrator)
            body = sim.body("ladder")
            angles, left = leaves(sim, "on_wall", lambda: 0.5 * np.pi - 2.0 * np.arcsin(abs(body.rotation[2])), step, duration)
            errors.append(abs(left / leave - 1.0))
        case.check(f"falling ladder, {integrator}, 0.5 ms: angle at which it leaves the wall", np.degrees(left), np.degrees(leave), 5e-3,
                   source="ladder", unit="deg")
        case.check(f"falling ladder, {integrator}, 0.5 ms: horizontal speed afterwards", body.velocity[0],
                   np.sqrt(G * LENGTH) * np.sin(start)**1.5 / 3.0, 5e-3, source="ladder", unit="m/s")
        case.check(f"falling ladder, {integrator}: order of the angle", observed_order(steps, errors), order, 0.3, source="ladder", relative=False)
        convergence.loglog(steps, errors, "o-", color=color, label=f"ladder, {integrator}")
        history.plot(step * (1 + np.arange(len(angles))), np.degrees(angles), color=color, label=integrator)

    def wall_is_left(_, state):
        return state[0] - leave

    wall_is_left.terminal = True
    fall = solve_ivp(lambda _, state: [state[1], -1.5 * G / LENGTH * np.cos(state[0])], (0.0, 2.0), [start, 0.0], method="DOP853", rtol=1e-10,
                     atol=1e-12, events=wall_is_left, max_step=5e-3)
    history.plot(fall.t, np.degrees(fall.y[0]), "--", color=plots.REFERENCE, label="until it leaves")
    history.set(xlabel="time (s)", ylabel="angle of the ladder (degrees)")
    history.legend()


def balls(case, convergence, start=0.2, large=0.08, small=0.02):
    steps = (2e-3, 1e-3, 5e-4, 2.5e-4)
    for name, friction, share in (("sliding", 0.0, 2.0 / 3.0), ("rolling", 100.0, 10.0 / 17.0)):
        leave = np.arccos(share * np.cos(start))
        for integrator, color in (("backward-euler", plots.THIRD), ("bdf2", plots.OURS)):
            errors = []
            for step in steps:
                at = (large + small) * np.array([np.sin(start), 0.0, np.cos(start)])
                sim = load({"ball": {"type": "rigid", "shape": {"sphere": {"radius": small}}, "mass": MASS, "pose": {"position": list(at)}},
                            "dome": {"type": "rigid", "shape": {"sphere": {"radius": large}}, "fixed": True}},
                           {"touch": {"between": ["ball", "dome"], "friction": friction}}, step, integrator)
                body = sim.body("ball")
                _, left = leaves(sim, "touch", lambda: np.arctan2(body.position[0], body.position[2]), step, 0.5)
                errors.append(abs(left / leave - 1.0))
            case.check(f"{name} ball, {integrator}, 0.25 ms: angle at which it leaves the sphere", np.degrees(left), np.degrees(leave), 5e-3,
                       source="sphere", unit="deg")
            case.report(f"{name} ball, {integrator}: order of this angle", observed_order(steps, errors), source="sphere")
            convergence.loglog(steps, errors, "s--" if friction else "^:", color=color, label=f"{name} ball, {integrator}")


def run(case):
    figure, (left, right) = plots.axes(2)
    leans(case)
    tents(case)
    slides(case, left, right)
    balls(case, right)
    right.set(xlabel="time step (s)", ylabel="relative error of the angle at which it leaves")
    right.legend(fontsize=7)
    case.figure(figure, "Left: the ladder without friction; the dashed line ends where it leaves the wall. Right: errors against time step.")
