"""Contact between rigid bodies: slopes, stacks, a grip, a rocking block."""

import numpy as np
import sinew

from suite import plots

TITLE = "Contact between rigid bodies"
SETUP = """Backward Euler, contact between exact shapes.

- *Slopes.* Balls and rollers, r = 20 mm, are released for 0.2 s on a slope, a fixed box. Without slip a = g sin(s)/(1 + k), k
  = I/(m r^2); they slip if mu < tan(s) k/(1 + k). A ball thrown horizontally without spin rolls once its speed has fallen to
  1/(1 + k) of the initial speed.
- *Tipping.* A block of width w and height h on a slope tips if tan(s) > w/h, given enough friction.
- *Stacks.* Ten cubes of 20 mm on each other, and 1 g below 10 kg, for 2 s. The force below each body equals the weight above
  it, and nothing creeps.
- *Grip.* Two balls, pressed by linear motors with the force N on a box beside its centre of mass, carry it if m g < 2 mu N.
- *Rocking.* A block of 20 x 20 x 80 mm rocks from 0.6 of its critical angle: I_o theta'' = -m g R sin(alpha - theta). At each
  landing its angular rate is multiplied by 1 - 3/2 sin(alpha)^2 (Housner 1963), assuming that it continues about its other
  edge. The equation is solved by Runge-Kutta steps."""
SOURCES = {"rolling": "rolling of a rigid round body: g sin(s)/(1 + I/(m r^2))",
           "Coulomb": "statics with Coulomb friction",
           "Housner": "G. W. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seismological Soc. America "
                      "53 (1963) 403-417"}
COST = 20
G = 9.81
KINDS = {"ball": ({"sphere": {"radius": 0.02}}, 0.4), "roller": ({"cylinder": {"radius": 0.02, "height": 0.06}}, 0.5)}


def scene(bodies, contacts, step=1e-3, gravity=(0.0, 0.0, -G), **more):
    return sinew.load({"sinew": 1, "integrator": "backward-euler", "time_step": step, "gravity": list(gravity), "bodies": bodies,
                       "contacts": contacts, **more})


def table(**more):
    return {"type": "rigid", "shape": {"box": [0.4, 2.0, 0.02]}, "fixed": True, "pose": {"position": [0, 0, -0.01]}, **more}


def tilted(angle):
    return 0.0, G * np.sin(angle), -G * np.cos(angle)


def round_body(kind, **more):
    shape, _ = KINDS[kind]
    turned = {} if kind == "ball" else {"rotation": [0.0, 0.5 * np.pi, 0.0]}
    return {"type": "rigid", "shape": shape, "mass": 0.1, "pose": {"position": [0, 0, 0.02], **turned}, **more}


def rolls(case, axis):
    for kind, (_, k) in KINDS.items():
        angle, friction, time = 0.4, 0.3, 0.2
        sim = scene({"it": round_body(kind), "table": table()}, {"floor": {"between": ["it", "table"], "friction": friction}},
                    gravity=tilted(angle))
        sim.run(duration=time)
        case.check(f"{kind}: acceleration on a slope, mu = 0.3", sim.body("it").velocity[1] / time, G * np.sin(angle) / (1 + k), 2e-3,
                   source="rolling", unit="m/s^2")
        friction = 0.8 * np.tan(angle) * k / (1 + k)
        sim = scene({"it": round_body(kind), "table": table()}, {"floor": {"between": ["it", "table"], "friction": friction}},
                    gravity=tilted(angle))
        sim.run(duration=time)
        case.check(f"{kind}: acceleration with slip, mu = 0.8 tan(s) k/(1 + k)", sim.body("it").velocity[1] / time,
                   G * (np.sin(angle) - friction * np.cos(angle)), 2e-3, source="Coulomb", unit="m/s^2")
        sim = scene({"it": round_body(kind, velocity={"linear": [0, 0.5, 0]}), "table": table()},
                    {"floor": {"between": ["it", "table"], "friction": 0.2}})
        speeds = [0.5]
        for _ in range(200):
            sim.step()
            speeds.append(float(sim.body("it").velocity[1]))
        case.check(f"{kind}: speed once it rolls, thrown horizontally at 0.5 m/s", speeds[-1], 0.5 / (1 + k), 1e-3, source="rolling", unit="m/s")
        time = 1e-3 * np.arange(201)
        line = axis.plot(time, speeds, label=kind)[0]
        axis.plot(time, np.maximum(0.5 - 0.2 * G * time, 0.5 / (1 + k)), "--", color=line.get_color(), lw=1)
    axis.set(xlabel="time (s)", ylabel="speed (m/s), thrown horizontally")
    axis.legend()


def topples(case):
    for ratio, falls in ((0.99, False), (1.01, True)):
        angle = np.arctan(ratio * 0.25)
        sim = scene({"block": {"type": "rigid", "shape": {"box": [0.02, 0.02, 0.08]}, "mass": 0.1, "pose": {"position": [0, 0, 0.04]}},
                     "table": table()}, {"floor": {"between": ["block", "table"], "friction": 1.0}}, gravity=tilted(angle))
        sim.run(duration=1.0)
        axis = np.cos(2.0 * np.arccos(min(1.0, sim.body("block").rotation[0])))
        case.check(f"block on a slope of {ratio:g} w/h: it {'falls' if falls else 'stands'}", float(axis < 0.9), float(falls), 0.1,
                   relative=False, source="Coulomb")


def stacks(case):
    for title, masses, edge in (("ten cubes", [0.05] * 10, 0.02), ("10 kg on 1 g", [0.001, 10.0], 0.02)):
        names = [f"cube_{k}" for k in range(len(masses))]
        bodies = {name: {"type": "rigid", "shape": {"box": [edge] * 3}, "mass": mass, "pose": {"position": [0, 0, (k + 0.5) * edge]}}
                  for k, (name, mass) in enumerate(zip(names, masses))}
        below = ["table", *names[:-1]]
        sim = scene({**bodies, "table": table()},
                    {f"on_{k}": {"between": [name, under], "friction": 0.5} for k, (name, under) in enumerate(zip(names, below))},
                    step=5e-3)
        sim.run(duration=0.1)
        start = np.array([sim.body(name).position for name in names])
        sim.run(duration=1.9)
        worst = max(abs(sim.contact(f"on_{k}").normal_force / (G * sum(masses[k:])) - 1.0) for k in range(len(names)))
        case.bound(f"{title}: largest error of a normal force, relative", worst, 1e-6, source="Coulomb")
        moved = np.abs(np.array([sim.body(name).position for name in names]) - start).max()
        case.bound(f"{title}: creep in 2 s / edge", float(moved) / edge, 1e-6, source="Coulomb")


def grips(case):
    force, friction, share = 2.0, 0.4, {}
    for ratio in (0.99, 1.01):
        jaw = lambda x: {"type": "rigid", "shape": {"sphere": {"radius": 0.01}}, "mass": 0.05, "pose": {"position": [x, 0, 0.02]}}
        sim = scene({"left": jaw(-0.03), "right": jaw(0.03),
                     "box": {"type": "rigid", "shape": {"box": [0.04, 0.04, 0.04]}, "mass": ratio * 2 * friction * force / G,
                             "pose": {"position": [0, 0, 0.02]}}},
                    {"a": {"between": ["box", "left"], "friction": friction}, "b": {"between": ["box", "right"], "friction": friction}},
                    joints={name: {"type": "slider", "bodies": ["world", name], "point": [x, 0, 0.02], "axis": [sense, 0, 0]}
                            for name, x, sense in (("left", -0.03, 1.0), ("right", 0.03, -1.0))},
                    actuators={f"press_{name}": {"type": "linear-motor", "joint": name, "command": {"force": force}}
                               for name in ("left", "right")})
        sim.run(duration=0.5)
        share[ratio] = -float(sim.body("box").velocity[2])
    case.bound("box of 0.99 x 2 mu N/g between two balls: speed after 0.5 s", share[0.99], 1e-6, source="Coulomb", unit="m/s")
    case.check("box of 1.01 x 2 mu N/g: speed after 0.5 s", share[1.01], 0.5 * G * (1.0 - 1.0 / 1.01), 0.02, source="Coulomb", unit="m/s")


def rocks(case, axis):
    width, height, mass = 0.02, 0.08, 0.1
    alpha, radius = np.arctan(width / height), 0.5 * np.hypot(width, height)
    inertia = 4.0 / 3.0 * mass * radius**2
    begin, step = 0.6 * alpha, 1e-4

    def slope(state):
        return np.array([state[1], -mass * G * radius * np.sin(alpha - state[0]) / inertia])

    reference, state, landings = [begin], np.array([begin, 0.0]), []
    for k in range(round(0.5 / step)):
        first = slope(state)
        second = slope(state + 0.5 * step * first)
        third = slope(state + 0.5 * step * second)
        state = state + step / 6.0 * (first + 2.0 * second + 2.0 * third + slope(state + step * third))
        if state[0] <= 0.0:
            landings.append(k * step)
            state = np.array([-state[0], -state[1] * (1.0 - 1.5 * np.sin(alpha)**2)])
        reference.append(state[0])
    # The block stands on one edge; its centre is `radius` away from it.
    centre = radius * np.array([0.0, -np.sin(alpha - begin), np.cos(alpha - begin)])
    sim = scene({"block": {"type": "rigid", "shape": {"box": [0.02, width, height]}, "mass": mass,
                           "pose": {"position": list(centre), "rotation": [-begin, 0.0, 0.0]}}, "table": table()},
                {"floor": {"between": ["block", "table"], "friction": 1.0}}, step=step)
    ours = [begin]
    for _ in range(len(reference) - 1):
        sim.step()
        ours.append(2.0 * float(np.arcsin(np.abs(sim.body("block").rotation[1]))))
    ours, reference = np.array(ours), np.array(reference)
    time = step * np.arange(len(ours))
    lows = [k for k in range(1, len(ours) - 1) if ours[k] < ours[k - 1] and ours[k] <= ours[k + 1] and ours[k] < 0.1 * alpha]
    case.check("rocking block: time of the first landing", time[lows[0]], landings[0], 0.01, source="Housner", unit="s")
    between = ours[lows[0]:lows[1]].max()
    theirs = reference[round(landings[0] / step):round(landings[1] / step)].max()
    case.check("rocking block: largest angle afterwards / alpha", between / alpha, theirs / alpha, 0.02, source="Housner")
    axis.plot(time, np.degrees(reference), "--", color=plots.REFERENCE, label="Housner")
    axis.plot(time, np.degrees(ours), color=plots.OURS, label="Sinew")
    axis.set(xlabel="time (s)", ylabel="angle of the rocking block (deg)")
    axis.legend()


def run(case):
    figure, (left, right) = plots.axes(2)
    rolls(case, left)
    topples(case)
    stacks(case)
    grips(case)
    rocks(case, right)
    case.figure(figure, "Left: speed of a ball and a roller thrown horizontally; dashed: Coulomb, then rolling. Right: a rocking block.")
