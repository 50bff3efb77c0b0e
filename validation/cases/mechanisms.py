"""Linkages of rigid bodies and hinges."""

import numpy as np
import sinew
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from suite import plots
from suite.case import observed_order

TITLE = "Mechanisms: four-bar linkage, slider-crank, double pendulum and hanging chain"
SETUP = """Links are boxes of 5 x 5 mm section and 100 g that turn on hinges in the x-y plane, with gravity along -y.
Integrators are BDF2 and generalized-alpha unless stated otherwise.

- A four-bar linkage, crank 40, coupler 120, rocker 80, ground link 100 mm. All joints are hinges about z (three redundant
  rows). The crank turns at 10 rad/s. Positions follow from two circles, the motor's torque from the power, M w = d/dt (T +
  V), with T and V in closed form.
- A slider-crank, 50 and 150 mm, piston 200 g, starts from rest under a torque of 50 mN m and gravity: I(theta) theta'' + I'
  theta'^2/2 + V' = M, with one unknown, integrated by DOP853 to 1e-12.
- Two bars of 200 mm are released from the horizontal for 1 s; the reference is integrated likewise.
- A chain of 12 bars of 50 mm, whose masses grow from 20 to 86 g, hangs between two points at equal height. The reference
  solves the statics for two unknowns, the force at one end. Sinew reaches the equilibrium with backward Euler steps of 50 ms,
  which damp the swing."""
SOURCES = {"geometry": "plane kinematics in closed form",
           "Lagrange": "Lagrange's equations in minimal coordinates, integrated by E. Hairer's DOP853 (scipy) to 1e-12",
           "statics": "each bar in balance: tan(angle) = (V_left + V_right)/(2 H); two unknowns by scipy's fsolve"}
COST = 5
G, MASS, THICK = 9.81, 0.1, 0.005
SECOND_ORDER = ("bdf2", "generalized-alpha")


def link(start, end, mass=MASS):
    start, end = np.asarray(start), np.asarray(end)
    along = end - start
    return {"type": "rigid", "shape": {"box": [float(np.linalg.norm(along)), THICK, THICK]}, "mass": mass,
            "pose": {"position": [*(0.5 * (start + end)), 0.0], "rotation": [0.0, 0.0, float(np.arctan2(along[1], along[0]))]}}


def hinge(first, second, point):
    return {"type": "hinge", "bodies": [first, second], "point": [*point, 0.0], "axis": "z"}


def load(bodies, joints, step, integrator, **more):
    return sinew.load({"sinew": 1, "time_step": step, "integrator": integrator, "gravity": [0.0, -G, 0.0], "bodies": bodies,
                       "joints": joints, **more})


def bar_energy(start, end, rate_start, rate_end, mass=MASS):
    """Kinetic and gravity energy of a bar, from its end points."""
    length = np.linalg.norm(np.subtract(end, start))
    centre, turn = 0.5 * np.add(rate_start, rate_end), np.subtract(rate_end, rate_start) / length
    inertia = mass * (length**2 + THICK**2) / 12.0
    return 0.5 * mass * centre @ centre + 0.5 * inertia * turn @ turn, mass * G * 0.5 * (start[1] + end[1])


def rates(points, angle):
    """Derivatives of a linkage's points with respect to its angle, by central differences accurate to about 1e-10."""
    step = 1e-5
    return [(b - a) / (2.0 * step) for a, b in zip(points(angle - step), points(angle + step))]


def reduced(points, bars, angle):
    """Inertia I and potential V of a linkage with one degree of freedom; `bars` are (first point, second point, mass)."""
    at, rate = points(angle), rates(points, angle)
    energies = [bar_energy(at[i], at[j], rate[i], rate[j], mass) for i, j, mass in bars]
    return 2.0 * sum(e[0] for e in energies), sum(e[1] for e in energies)


def slopes(points, bars, angle, step=1e-4):
    """Derivatives of I and V with respect to the angle."""
    first, second = reduced(points, bars, angle - step), reduced(points, bars, angle + step)
    return [(b - a) / (2.0 * step) for a, b in zip(first, second)]


CRANK, COUPLER, ROCKER, GROUND, START, RATE = 0.04, 0.12, 0.08, 0.10, 0.7, 10.0


def four_bar(angle):
    """Positions of shaft, knee, pin and post."""
    knee, post = CRANK * np.array([np.cos(angle), np.sin(angle)]), np.array([GROUND, 0.0])
    across = post - knee
    far = np.linalg.norm(across)
    along = (COUPLER**2 - ROCKER**2 + far**2) / (2.0 * far)
    unit = across / far
    pin = knee + along * unit + np.sqrt(COUPLER**2 - along**2) * np.array([-unit[1], unit[0]])
    return [np.zeros(2), knee, pin, post]


def turns(case, axis):
    bars = [(0, 1, MASS), (1, 2, MASS), (3, 2, MASS)]
    shaft, knee, pin, post = four_bar(START)
    bodies = {"crank": link(shaft, knee), "coupler": link(knee, pin), "rocker": link(post, pin)}
    joints = {"shaft": hinge("world", "crank", shaft), "knee": hinge("crank", "coupler", knee), "pin": hinge("coupler", "rocker", pin),
              "post": hinge("world", "rocker", post)}
    for integrator, color in zip(SECOND_ORDER, (plots.OURS, plots.SECOND)):
        steps, errors, apart, slower = (4e-3, 2e-3, 1e-3), [], 0.0, 0.0
        for step in steps:
            sim = load(bodies, joints, step, integrator,
                       actuators={"motor": {"type": "motor", "joint": "shaft", "command": {"velocity": RATE}}})
            angles, torques = [], []
            for _ in range(round(1.1 / step)):
                sim.step()
                angle = START + sim.joint("shaft").angle
                points, rate = four_bar(angle), rates(four_bar, angle)
                apart = max(apart, np.abs(sim.body("coupler").position[:2] - 0.5 * (points[1] + points[2])).max())
                if sim.time > 0.4:  # the transient of the start has decayed
                    wanted = RATE * 0.5 * (rate[1] + rate[2])
                    slow = np.abs(sim.body("coupler").velocity[:2] - wanted).max()
                    angles.append(angle)
                    torques.append(sim.actuator("motor").torque)
            slower = slow if step == steps[0] else slower
            theory = []
            for angle in angles:
                inertia, weight = slopes(four_bar, bars, angle)
                theory.append(0.5 * RATE**2 * inertia + weight)
            errors.append(np.abs(np.array(torques) - theory).max() / np.abs(theory).max())
        case.identity(f"four-bar, {integrator}: error of the coupler's position in a turn / ground link", apart / GROUND, 1e-9, source="geometry")
        case.bound(f"four-bar, {integrator}, 1 ms: largest error of the motor's torque / largest torque", errors[-1], 5e-3, source="Lagrange")
        case.check(f"four-bar, {integrator}: order of the torque", np.log2(errors[-2] / errors[-1]), 2.0, 0.25, source="Lagrange",
                   relative=False)
        case.check(f"four-bar, {integrator}: order of the coupler's speed", np.log2(slower / slow) / 2.0, 2.0, 0.25, source="geometry",
                   relative=False)
        axis.plot(angles, 1e3 * np.array(torques), "o", ms=2, color=color, label=integrator)
    axis.plot(angles, 1e3 * np.array(theory), color=plots.REFERENCE, lw=1, label="closed form")
    axis.set(xlabel="angle of the crank (rad)", ylabel="torque (mN m), four-bar")
    axis.legend()


def slider_crank(angle, crank=0.05, rod=0.15):
    """Positions of shaft, knee and pin."""
    knee = crank * np.array([np.cos(angle), np.sin(angle)])
    return [np.zeros(2), knee, np.array([knee[0] + np.sqrt(rod**2 - knee[1]**2), 0.0])]


def pistons(case, axis, torque=0.05, mass=0.2, duration=0.5):
    bars, begin = [(0, 1, MASS), (1, 2, MASS)], 0.3

    def motion(_, state):
        angle, rate = state
        pin = rates(slider_crank, angle)[2][0]
        inertia = reduced(slider_crank, bars, angle)[0] + mass * pin**2
        step = 1e-4
        bend = (rates(slider_crank, angle + step)[2][0] - rates(slider_crank, angle - step)[2][0]) / (2.0 * step)
        change, weight = slopes(slider_crank, bars, angle)
        return [rate, (torque - weight - 0.5 * (change + 2.0 * mass * pin * bend) * rate**2) / inertia]

    end = solve_ivp(motion, (0.0, duration), [begin, 0.0], method="DOP853", rtol=1e-9, atol=1e-9).y[0, -1]
    shaft, knee, pin = slider_crank(begin)
    bodies = {"crank": link(shaft, knee), "rod": link(knee, pin),
              "piston": {"type": "rigid", "shape": {"box": [0.02, 0.02, 0.02]}, "mass": mass, "pose": {"position": [*pin, 0.0]}}}
    joints = {"shaft": hinge("world", "crank", shaft), "knee": hinge("crank", "rod", knee), "pin": hinge("rod", "piston", pin),
              "guide": {"type": "slider", "bodies": ["world", "piston"], "point": [*pin, 0.0], "axis": "x"}}
    for integrator, color in zip(SECOND_ORDER, (plots.OURS, plots.SECOND)):
        steps, errors = (2e-3, 1e-3, 5e-4), []
        for step in steps:
            sim = load(bodies, joints, step, integrator,
                       actuators={"motor": {"type": "motor", "joint": "shaft", "command": {"torque": torque}}})
            sim.run(duration=duration)
            errors.append(abs(begin + sim.joint("shaft").angle - end))
        converges(case, axis, f"slider-crank, {integrator}", steps, errors, end - begin, color, "s--")


def converges(case, axis, name, steps, errors, size, color, mark):
    case.bound(f"{name}: angle at the end, {1e3 * steps[-1]:g} ms, relative to the angle travelled", errors[-1] / size, 2e-3, source="Lagrange")
    case.check(f"{name}: order", observed_order(steps, errors), 2.0, 0.25, source="Lagrange", relative=False)
    axis.loglog(steps, np.array(errors) / size, mark, color=color, label=name)


def pendulums(case, axis, length=0.2, duration=1.0):
    inertia = MASS * (length**2 + THICK**2) / 12.0

    def motion(_, state):
        first, second, rate, other = state
        mixed, outer = 0.5 * MASS * length**2 * np.cos(first - second), inertia + 0.25 * MASS * length**2
        twist = 0.5 * MASS * length**2 * np.sin(first - second)
        right = [-twist * other**2 - 1.5 * MASS * G * length * np.sin(first), twist * rate**2 - 0.5 * MASS * G * length * np.sin(second)]
        return [rate, other, *np.linalg.solve([[outer + MASS * length**2, mixed], [mixed, outer]], right)]

    quarter = 0.5 * np.pi
    end = solve_ivp(motion, (0.0, duration), [quarter, quarter, 0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    bodies = {"upper": link([0.0, 0.0], [length, 0.0]), "lower": link([length, 0.0], [2.0 * length, 0.0])}
    joints = {"top": hinge("world", "upper", [0.0, 0.0]), "middle": hinge("upper", "lower", [length, 0.0])}
    for integrator, color in zip(SECOND_ORDER, (plots.OURS, plots.SECOND)):
        steps, errors = (1e-3, 5e-4, 2.5e-4), []
        for step in steps:
            sim = load(bodies, joints, step, integrator)
            sim.run(duration=duration)
            first = quarter + sim.joint("top").angle
            errors.append(max(abs(first - end[0]), abs(first + sim.joint("middle").angle - end[1])))
        converges(case, axis, f"double pendulum, {integrator}", steps, errors, np.pi, color, "o-")


def chains(case, axis, count=12, length=0.05, span=0.4):
    masses = 0.02 * (1.0 + 0.3 * np.arange(count))

    def drawing(unknown):
        across, left = unknown
        lift = left - np.concatenate([[0.0], np.cumsum(masses * G)])  # upward force at each joint on the rest of the chain
        angles = np.arctan2(-0.5 * (lift[:-1] + lift[1:]), across)
        steps = length * np.column_stack([np.cos(angles), np.sin(angles)])
        return np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])

    weight = masses.sum() * G
    found = fsolve(lambda unknown: drawing(unknown)[-1] - [span, 0.0], [0.3 * weight, 0.4 * weight], xtol=1e-13)
    theory = drawing(found)
    slack = fsolve(lambda k: length * np.cos(k * np.linspace(-1, 1, count)).sum() - span, 1.0)[0]
    bend = slack * np.linspace(-1, 1, count)
    at = np.concatenate([[[0.0, 0.0]], np.cumsum(length * np.column_stack([np.cos(bend), np.sin(bend)]), axis=0)])
    names = ["world", *(f"bar_{k}" for k in range(count)), "world"]
    bodies = {name: link(at[k], at[k + 1], masses[k]) for k, name in enumerate(names[1:-1])}
    joints = {f"joint_{k}": hinge(names[k], names[k + 1], at[k]) for k in range(count)}
    joints["end"] = hinge("world", names[-2], at[-1])
    sim = load(bodies, joints, 0.05, "backward-euler")
    sim.step(2000)
    middles = np.array([sim.body(name).position[:2] for name in names[1:-1]])
    wanted = 0.5 * (theory[:-1] + theory[1:])
    case.bound("chain of 12 bars: largest distance of a bar from its reference position / span", np.abs(middles - wanted).max() / span, 1e-6,
               source="statics")
    force = np.asarray(sim.joint("joint_0").force)
    case.check("chain of 12 bars: horizontal force", abs(force[0]), found[0], 1e-6, source="statics", unit="N")
    case.check("chain of 12 bars: vertical force at the left end", force[1], found[1], 1e-6, source="statics", unit="N")
    axis.plot(*theory.T, color=plots.REFERENCE, lw=1, label="statics")
    axis.plot(*middles.T, "o", color=plots.OURS, label="bars, Sinew")
    axis.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
    axis.legend()


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    turns(case, left)
    pistons(case, middle)
    pendulums(case, middle)
    middle.set(xlabel="time step (s)", ylabel="relative error of the angle at the end")
    middle.legend(fontsize=7)
    chains(case, right)
    case.figure(figure, "Left: torque that turns the four-bar linkage. Middle: errors against time step. Right: the chain at rest.")
