"""A free body about its intermediate axis, and a heavy top."""

import numpy as np
import sinew
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from suite import plots
from suite.case import observed_order

TITLE = "Rotating bodies: a box about its intermediate axis, a heavy top"
SETUP = """- A box of 60 x 40 x 20 mm, 300 g, free of forces, spins for 2 s at 20 rad/s about its intermediate axis and at 0.5 rad/s
  about the others. The axis flips repeatedly (Dzhanibekov effect); the time between two flips is 2 K(m)/p in closed form.
  Momentum and energy should be conserved.
- A disc of 200 g, r = 50 mm, 100 mm from the ball joint at the foot of its axis, is released at 60 degrees from the vertical
  with a spin of 200 rad/s. It falls, precesses and nutates. The reference integrates the equations in Euler's angles with
  their two conserved momenta by DOP853 to 1e-12.

Errors are the largest in the run; drifts are relative."""
SOURCES = {"Landau": "L. D. Landau, E. M. Lifshitz, Mechanics, 3rd ed. 1976, sec. 37: the asymmetrical top in Jacobi's functions",
           "Goldstein": "H. Goldstein, Classical Mechanics, 2nd ed. 1980, sec. 5-7: the heavy symmetrical top; integrated by DOP853 (scipy)",
           "conserved": "momentum and energy of a body without moments"}
COST = 4
G = 9.81
ORDERS = {"backward-euler": 1.0, "bdf2": 2.0, "generalized-alpha": 2.0}
COLORS = {"backward-euler": plots.THIRD, "bdf2": plots.OURS, "generalized-alpha": plots.SECOND}


def turned(quaternion, vectors):
    """Body-fixed vectors (n, 3) in world axes."""
    w, axis = quaternion[0], np.asarray(quaternion[1:])
    return vectors + 2.0 * np.cross(axis, np.cross(axis, vectors) + w * vectors)


BOX, BOX_MASS, SPIN = np.array([0.06, 0.04, 0.02]), 0.3, np.array([0.5, 20.0, 0.5])
INERTIA = BOX_MASS / 12.0 * (BOX @ BOX - BOX**2)


def flips_every():
    """Time between two flips, s."""
    first, second, third = INERTIA
    energy, momentum = INERTIA @ SPIN**2, (INERTIA**2) @ SPIN**2  # 2 E, M^2
    if momentum < energy * second:
        first, third = third, first
    scale = (third - second) * (momentum - energy * first)
    return 2.0 * ellipk((second - first) * (energy * third - momentum) / scale) / np.sqrt(scale / (first * second * third))


def tumbles(integrator, step, duration=2.0):
    """Times at which the intermediate axis is normal to the angular velocity, and relative drifts of momentum and energy."""
    sim = sinew.load({"sinew": 1, "time_step": step, "integrator": integrator,
                      "bodies": {"box": {"type": "rigid", "shape": {"box": list(BOX)}, "mass": BOX_MASS, "velocity": {"angular": list(SPIN)}}}})
    body, middle, momenta, energies = sim.body("box"), [SPIN[1]], [], []
    for _ in range(round(duration / step)):
        sim.step()
        axes = turned(body.rotation, np.eye(3))
        spin = axes @ body.velocity[3:]
        middle.append(spin[1])
        momenta.append((INERTIA * spin) @ axes)
        energies.append(0.5 * INERTIA @ spin**2)
    middle = np.array(middle)
    at = np.flatnonzero(middle[:-1] * middle[1:] < 0.0)
    times = step * (at + middle[at] / (middle[at] - middle[at + 1]))
    drift = np.linalg.norm(np.array(momenta) - INERTIA * SPIN, axis=1).max() / np.linalg.norm(INERTIA * SPIN)
    return times, drift, np.abs(np.array(energies) / (0.5 * INERTIA @ SPIN**2) - 1.0).max(), middle


def boxes(case, convergence, history):
    steps, period = (1e-3, 5e-4, 2.5e-4), flips_every()
    for integrator in ORDERS:
        found, momenta, energies = [], [], []
        for step in steps:
            times, momentum, energy, middle = tumbles(integrator, step)
            found.append((times[-1] - times[0]) / (len(times) - 1))
            momenta.append(momentum)
            energies.append(energy)
        history.plot(steps[-1] * np.arange(len(middle)), middle, color=COLORS[integrator], lw=1, label=integrator)
        color = COLORS[integrator]
        convergence.loglog(steps, momenta, "o-", color=color, label=f"momentum, {integrator}")
        convergence.loglog(steps, energies, "s--", color=color, label=f"energy, {integrator}")
        order = ORDERS[integrator]
        if order > 1.0:
            case.check(f"box, {integrator}, 0.25 ms: time between two flips", found[-1], period, 1e-3, source="Landau", unit="s")
            case.report(f"box, {integrator}: order of that time", observed_order(steps, np.array(found) - period), source="Landau",
                        remark="it depends on the remaining energy, of which BDF2 loses a third-order part")
            case.bound(f"box, {integrator}, 0.25 ms: drift of momentum in 2 s", momenta[-1], 1e-4, source="conserved")
            case.bound(f"box, {integrator}, 0.25 ms: drift of energy in 2 s", energies[-1], 1e-4, source="conserved")
        else:
            case.report(f"box, {integrator}, 0.25 ms: energy lost in 2 s", energies[-1], source="conserved")
        case.check(f"box, {integrator}: order of the drift of momentum", np.log2(momenta[-2] / momenta[-1]), order, 0.3, source="conserved",
                   relative=False)
        case.check(f"box, {integrator}: order of the drift of energy", np.log2(energies[-2] / energies[-1]), order, 0.3, source="conserved",
                   relative=False)
    history.set(xlabel="time (s)", ylabel="spin about the intermediate axis (rad/s), 0.25 ms")
    history.legend(fontsize=7)
    convergence.set(xlabel="time step (s)", ylabel="relative drift in 2 s")
    convergence.legend(fontsize=7)


ARM, DISC, HEIGHT, MASS, LEAN, TURN = 0.1, 0.05, 0.02, 0.2, np.radians(60), 200.0


def top_reference(times):
    """Direction of the axis, (n, 3)."""
    axial, across = 0.5 * MASS * DISC**2, MASS * (0.25 * DISC**2 + HEIGHT**2 / 12.0 + ARM**2)
    own, vertical = axial * TURN, axial * TURN * np.cos(LEAN)  # the two conserved momenta

    def motion(_, state):
        angle, rate, _ = state
        sine, cosine = np.sin(angle), np.cos(angle)
        precession = (vertical - own * cosine) / (across * sine**2)
        return [rate, precession**2 * sine * cosine - own * precession * sine / across + MASS * G * ARM * sine / across, precession]

    lean, _, azimuth = solve_ivp(motion, (0.0, times[-1]), [LEAN, 0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12, t_eval=times).y
    return np.column_stack([np.sin(lean) * np.cos(azimuth), np.sin(lean) * np.sin(azimuth), np.cos(lean)])


def top(integrator, step, duration):
    axis = np.array([np.sin(LEAN), 0.0, np.cos(LEAN)])
    sim = sinew.load({
        "sinew": 1, "time_step": step, "integrator": integrator, "gravity": [0.0, 0.0, -G],
        "bodies": {"disc": {"type": "rigid", "shape": {"cylinder": {"radius": DISC, "height": HEIGHT}}, "mass": MASS,
                            "pose": {"position": list(ARM * axis), "rotation": [0.0, LEAN, 0.0]}, "velocity": {"angular": list(TURN * axis)}}},
        "joints": {"foot": {"type": "ball", "bodies": ["world", "disc"], "point": [0, 0, 0]}}})
    seen = [axis]
    for _ in range(round(duration / step)):
        sim.step()
        seen.append(np.array(sim.body("disc").centre_of_mass) / ARM)
    return np.array(seen)


def tops(case, axis, duration=1.0):
    steps = (4e-4, 2e-4, 1e-4)
    for integrator in ("bdf2", "generalized-alpha"):
        errors = []
        for step in steps:
            seen = top(integrator, step, duration)
            theory = top_reference(step * np.arange(len(seen)))
            errors.append(np.linalg.norm(seen - theory, axis=1).max())
        case.bound(f"top, {integrator}, 0.1 ms: direction of its axis over 1 s (rad)", errors[-1], 1e-3, source="Goldstein")
        case.check(f"top, {integrator}: order", np.log2(errors[-2] / errors[-1]), 2.0, 0.3, source="Goldstein", relative=False)
        lean, wanted = np.degrees(np.arccos(seen[:, 2])), np.degrees(np.arccos(theory[:, 2]))
        case.check(f"top, {integrator}, 0.1 ms: largest inclination", lean.max(), wanted.max(), 1e-3, source="Goldstein", unit="deg")
        azimuth = np.degrees(np.unwrap(np.arctan2(seen[:, 1], seen[:, 0])))
        ahead = np.degrees(np.unwrap(np.arctan2(theory[:, 1], theory[:, 0])))
        case.check(f"top, {integrator}, 0.1 ms: azimuth after 1 s", azimuth[-1], ahead[-1], 2e-3, source="Goldstein", unit="deg")
        axis.plot(azimuth, lean, color=COLORS[integrator], label=integrator)
    axis.plot(ahead, wanted, "--", color=plots.REFERENCE, lw=1, label="Euler's angles")
    axis.invert_yaxis()
    axis.set(xlabel="azimuth (deg)", ylabel="lean (deg)")
    axis.legend(fontsize=7)


def run(case):
    figure, (left, middle, right) = plots.axes(3)
    boxes(case, middle, left)
    tops(case, right)
    case.figure(figure, "Left: spin of the box. Middle: drifts of momentum and energy against time step. Right: the axis of the top, 0.1 ms.")
