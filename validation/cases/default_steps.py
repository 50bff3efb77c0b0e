"""Steps with default settings compared with equilibrium and conservation of energy."""

import pathlib
import warnings

import numpy as np
import sinew

from suite import plots

TITLE = "Default steps: cables, hanging strips, random robots and swings with default settings"
SETUP = """No scene in this case has a `solver` key.

- One long cable pulls the example trunk at 20 mm/s, the others are slack. The tip is compared with the equilibrium that
  `solve_static` finds from the same state, relative to the tip's travel.
- A strip of 100 x 10 x 4 mm, 100 kPa, hangs and gets its weight at once.
- 60 random robots: blocks of 60 to 200 mm, 30 kPa to 3 MPa, tet4 or hex8, corotational or neo-Hookean, with gravity along any
  axis or none, and one to three cables with or without friction, pulled or tensioned at once or within 0.2 to 2 s to 80 % of
  their limits. A step is right if its tip is within 0.5 % of its travel from the equilibrium that is found from there. A step
  that is not right must be flagged, or the run must stop.
- A beam of 100 x 20 x 20 mm, 1 MPa, hinged at an edge, is released level and swings for 1 s. Its energy beyond the initial
  energy is compared with that of the swing, and the time at which it time at which it passes below its hinge with that of a rigid plate."""
SOURCES = {"statics": "Newton's method to a residual of 1e-10 (`solve_static`), checked against independent finite elements",
           "energy": "conservation of energy",
           "pendulum": "compound pendulum released level: the angle divided by its rate from conservation of energy, by quadrature"}
COST = 90
TRUNK = pathlib.Path(__file__).resolve().parents[2] / "examples" / "trunk" / "trunk.yaml"
RIGHT = 5e-3


def pull_trunk(case, axis):
    for pulled in (0.015, 0.03, 0.06):
        sim = sinew.load(str(TRUNK))
        for actuator in sim.actuators.values():
            actuator.tension = 0.0
        sim.actuator("long_0").displacement = sinew.Ramp(0.0, pulled, duration=pulled / 0.02)
        start = sim.effector("tip").position.copy()
        path = [start]
        while sim.time < pulled / 0.02 - 1e-9:
            sim.step()
            path.append(sim.effector("tip").position.copy())
        sim.solve_static()
        travel = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
        off = np.linalg.norm(path[-1] - sim.effector("tip").position)
        case.bound(f"trunk pulled {1e3 * pulled:.0f} mm: distance of the tip from equilibrium / travel", off / travel, RIGHT, source="statics")
    path = 1e3 * np.array(path)
    axis.plot(np.hypot(path[:, 0], path[:, 1]), path[:, 2], color=plots.OURS, label="steps")
    tip = 1e3 * sim.effector("tip").position
    axis.plot(np.hypot(tip[0], tip[1]), tip[2], "o", mfc="none", color=plots.REFERENCE, label="equilibrium")
    axis.set(xlabel="distance of the tip from the axis (mm)", ylabel="height (mm)")
    axis.legend()


def hang_strip(case):
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "bodies": {"strip": {
        "type": "fem", "density": 1000.0, "mesh": {"shape": "block", "length": 0.01, "width": 0.004, "height": 0.1, "element_size": 0.004},
        "material": {"young_modulus": 1e5, "poisson_ratio": 0.4}, "fixed": [{"set": "z_max"}]}},
        "effectors": {"tip": {"body": "strip", "point": [0.005, 0.002, 0.0]}}})
    sim.step(2)
    stepped = sim.effector("tip").position.copy()
    sim.solve_static()
    equilibrium = sim.effector("tip").position
    case.bound("hanging strip after two steps: distance of the tip from equilibrium / sag",
               np.linalg.norm(stepped - equilibrium) / abs(equilibrium[2]), RIGHT, source="statics")


def random_robot(rng):
    """A random scene, and the duration of its commands (s)."""
    length = rng.uniform(0.06, 0.2)
    width, height = length * rng.uniform(0.08, 0.3, 2)
    modulus = 10.0 ** rng.uniform(4.5, 6.5)
    element = str(rng.choice(["tet4", "tet4", "hex8"]))
    model = "neo-hookean" if element == "hex8" else str(rng.choice(["corotational", "neo-hookean"]))
    down = np.array([[0, 0, -1], [0, -1, 0], [-1, 0, 0], [1, 0, 0]])[rng.integers(4)] * 9.81 * rng.integers(2)
    block = {"type": "fem", "density": rng.uniform(500, 1500), "element": element, "fixed": [{"set": "x_min"}],
             "mesh": {"shape": "block", "length": length, "width": width, "height": height,
                      "element_size": min(width, height) / rng.choice([1.0, 2.0])},
             "material": {"model": model, "young_modulus": modulus, "poisson_ratio": rng.uniform(0.2, 0.45)}}
    cables, lasts = {}, 0.3
    for k in range(rng.integers(1, 4)):
        angle, end = rng.uniform(0, 2 * np.pi), length * rng.uniform(0.5, 1.0)
        y, z = width * (0.5 + 0.4 * np.cos(angle)), height * (0.5 + 0.4 * np.sin(angle))
        cable = {"type": "cable", "body": "block", "points": [[x, y, z] for x in np.linspace(0.0, end, rng.integers(3, 9))]}
        if rng.random() < 0.2:
            cable["friction"] = rng.uniform(0.05, 0.3)
        motion, tension = length * rng.uniform(0.05, 0.35), modulus * width * height * rng.uniform(0.02, 0.15)
        if rng.random() < 0.6:
            cable["limits"] = {"tension": {"max": 3.0 * tension}, "displacement": {"max": motion}}
            quantity, value = "displacement", 0.8 * motion
        else:
            cable["limits"] = {"tension": {"max": tension}}
            quantity, value = "tension", 0.8 * tension
        duration = float(rng.choice([0.2, 0.5, 1.0, 2.0]))
        if rng.random() < 0.8:
            value = {"ramp": {"to": value, "duration": duration}}
            lasts = max(lasts, duration)
        cable["command"] = {quantity: value}
        cables[f"cable_{k}"] = cable
    scene = {"sinew": 1, "gravity": down.tolist(), "bodies": {"block": block}, "actuators": cables,
             "effectors": {"tip": {"body": "block", "point": [length, width / 2, height / 2]}}}
    return to_plain(scene), lasts


def to_plain(tree):
    if isinstance(tree, dict):
        return {key: to_plain(value) for key, value in tree.items()}
    if isinstance(tree, list):
        return [to_plain(value) for value in tree]
    return tree.item() if isinstance(tree, np.generic) else tree


def run_robot(seed):
    """'right', 'wrong', 'flagged' (and wrong), 'flagged though right' or 'stopped', and the error relative to the travel."""
    scene, lasts = random_robot(np.random.default_rng(seed))
    sim = sinew.load(scene)
    start, travel = sim.effector("tip").position.copy(), 0.0
    try:
        while sim.time < lasts - 1e-9:
            sim.step()
            travel = max(travel, float(np.linalg.norm(sim.effector("tip").position - start)))
    except sinew.RunError:
        return "stopped", np.nan
    flagged, end = sim.report.flagged, sim.effector("tip").position.copy()
    try:
        sim.solve_static()
        error = float(np.linalg.norm(sim.effector("tip").position - end)) / max(travel, 1e-9)
    except sinew.RunError:
        error = np.inf
    if error <= RIGHT:
        return "flagged though right" if flagged else "right", error
    return "flagged" if flagged else "wrong", error


def random_robots(case, axis, count=60):
    outcomes, errors = {}, []
    for seed in range(count):
        outcome, error = run_robot(seed)
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
        if outcome == "right":
            errors.append(error)
    seen = ", ".join(f"{number} {outcome}" for outcome, number in sorted(outcomes.items()))
    told = outcomes.get("flagged", 0) + outcomes.get("stopped", 0) + outcomes.get("flagged though right", 0)
    case.bound(f"{count} random robots: wrong without a flag", outcomes.get("wrong", 0) / count, 0.0, source="statics", remark=seen)
    case.bound(f"{count} random robots: flagged or stopped", told / count, 0.05, source="statics")
    case.bound(f"{count} random robots: flagged though right", outcomes.get("flagged though right", 0) / count, 0.0, source="statics")
    axis.hist(np.log10(np.maximum(errors, 1e-16)), bins=30, color=plots.OURS)
    axis.axvline(np.log10(RIGHT), color=plots.REFERENCE, ls="--")
    axis.set(xlabel="log10 of distance from equilibrium / travel", ylabel="robots")


def swing(integrator, element, model):
    """Largest energy gain relative to the energy of the swing, time at which the tip passes below the hinge (s), heights over time."""
    sim = sinew.load({"sinew": 1, "gravity": [0, 0, -9.81], "integrator": integrator, "bodies": {"beam": {
        "type": "fem", "density": 1000.0, "element": element,
        "mesh": {"shape": "block", "length": 0.1, "width": 0.02, "height": 0.02, "element_size": 0.01},
        "material": {"model": model, "young_modulus": 1e6, "poisson_ratio": 0.45}, "fixed": [{"box": [-1e-6, -1, -1e-6, 1e-6, 1, 1e-6]}]}},
        "effectors": {"tip": {"body": "beam", "point": [0.1, 0.01, 0.01]}}})
    body, tip = sim.body("beam"), sim.effector("tip")
    gained = held = 0.0
    before, passed, heights = float(tip.position[0]), None, []
    while sim.time < 1.0 - 1e-9:
        sim.step()
        energy = body.kinetic_energy + body.strain_energy
        held, gained = max(held, energy), max(gained, energy + body.gravity_energy)
        now = float(tip.position[0])
        if passed is None and now < 0.0:
            passed = sim.time - sim.time_step * now / (now - before)
        before = now
        heights.append(float(tip.position[2]))
    return gained / held, passed, heights


def quarter_period():
    """Time (s) in which a rigid plate, 100 x 20 mm, hinged at its lower edge, swings from level until its tip is below the hinge."""
    arm = np.hypot(0.05, 0.01)
    moment = (0.1**2 + 0.02**2) / 12.0 + arm**2
    tilt = np.arctan2(0.01, 0.05)  # elevation of the centre
    down = 0.5 * np.pi + np.arctan2(0.01, 0.1)  # rotation until the tip is below the hinge
    turned = down * np.linspace(0.0, 1.0, 200001)[1:] ** 2  # fine near the start from rest
    rate = np.sqrt(np.maximum(2.0 * 9.81 * arm / moment * (np.sin(tilt) - np.sin(tilt - turned)), 1e-30))
    return float(np.sum(np.diff(np.concatenate([[0.0], turned])) / rate))


def swings(case, axis):
    for element, model in (("tet4", "corotational"), ("hex8", "neo-hookean")):
        for integrator in ("backward-euler", "bdf2", "generalized-alpha"):
            gained, passed, heights = swing(integrator, element, model)
            case.bound(f"swing, {element}, {integrator}, 10 ms: energy gained / swing energy", gained, 0.01, source="energy")
            case.check(f"swing, {element}, {integrator}, 10 ms: time at which it passes below its hinge", passed, quarter_period(),
                       0.1 if integrator == "backward-euler" else 0.05, source="pendulum", unit="s")
        axis.plot(0.01 * np.arange(1, len(heights) + 1), 1e3 * np.array(heights), label=element)
    axis.set(xlabel="time (s)", ylabel="height of the tip (mm), generalized-alpha")
    axis.legend()


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sinew.SinewWarning)
        pull_trunk(case, left)
        hang_strip(case)
        random_robots(case, middle)
        swings(case, right)
    case.figure(figure, "Left: tip of the trunk pulled by 60 mm. Middle: 60 random robots. Right: swings of a hinged beam.")
