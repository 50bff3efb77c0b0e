"""Inverse control of the trunk: tracking, bias, and a target out of reach."""

import numpy as np
import scipy.optimize
import sinew

from suite import plots
from suite.robots import own_trunk, published_trunk

TITLE = "Inverse control of the trunk: tracking, bias, out of reach"
SETUP = """The trunk of examples/trunk (and the published one if its mesh is present) with eight cables.

- A circle of 30 mm radius around z = 180 mm in 2 s, with steps of 10 ms: the distance of the tip from the target after the
  first turn.
- A target at rest: the bias that each regularisation leaves.
- A target that no cable pull reaches (tension at most 3 N): the tip must come to rest, the status must report it, and the
  distance must be the smallest that SciPy finds over static equilibria."""
SOURCES = {
    "aim": "our aim: under 0.5 mm moving, under 0.05 mm at rest",
    "Coevoet 2017": "E. Coevoet, A. Escande, C. Duriez, Optimization-based inverse model of soft "
                    "robots with contact handling, IEEE RA-L 2(3) 2017, 1413-1419, "
                    "doi:10.1109/LRA.2017.2669367 (eps = 1e-3, efforts penalised)",
    "SciPy": "scipy.optimize.minimize (L-BFGS-B) over solve_static, tensions in [0, 3] N",
}
COST = 5
CIRCLE = dict(centre=(0, 0, 0.18), radius=0.03, period=2.0)


def track(scene, outside=None):
    if outside:
        scene["effectors"]["tip"]["outside"] = outside
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": sinew.Circle(**CIRCLE)})
    times, errors = [], []
    for _ in range(600):
        ik.step()
        times.append(sim.time)
        errors.append(ik.error)
    return np.array(times), np.array(errors), sim.report.relative_residual


def bias(regularisation, epsilon):
    sim = sinew.load(own_trunk())
    ik = sinew.InverseController(sim, targets={"tip": [0.03, 0.0, 0.18]},
                                 regularisation=regularisation, epsilon=epsilon)
    for _ in range(300):
        ik.step()
    return ik.error


def out_of_reach(case):
    scene = own_trunk()
    for actuator in scene["actuators"].values():
        actuator["limits"] = {"tension": {"min": 0, "max": 3}}
    goal = np.array([0.10, 0.06, 0.16])
    sim = sinew.load(scene)
    ik = sinew.InverseController(sim, targets={"tip": goal})
    distances, tips = [], []
    for _ in range(600):
        ik.step()
        distances.append(ik.error)
        tips.append(np.array(sim.effector("tip").position))
    case.agree("status at a target out of reach", ik.status, "out-of-reach", source="aim")
    spread = np.ptp(np.array(tips[-100:]), axis=0).max()
    case.bound("motion of the tip in the last 100 steps", 1e6 * spread, 1.0, unit="um", source="aim")

    probe = sinew.load(scene)
    names = list(probe.actuators)

    def distance(tensions):
        for name, tension in zip(names, tensions):
            probe.actuator(name).tension = float(tension)
        probe.solve_static()
        offset = np.array(probe.effector("tip").position) - goal
        w = np.array(probe.compliance())
        tip = [k for k, row in enumerate(probe.rows) if row.startswith("tip")]
        gradient = 2e4 * offset @ w[np.ix_(tip, range(len(names)))]
        return 1e4 * offset @ offset, gradient

    start = np.clip([probe_tension for probe_tension in ik.efforts], 0, 3) * 0.5
    best = scipy.optimize.minimize(distance, start, jac=True, bounds=[(0, 3)] * len(names),
                                   method="L-BFGS-B", options={"ftol": 1e-14, "gtol": 1e-8})
    case.check("smallest distance to the target", 1e3 * distances[-1], 1e3 * np.sqrt(best.fun / 1e4),
               1e-3, unit="mm", source="SciPy")
    return distances


def run(case):
    times, errors, residual = track(own_trunk())
    moving = errors[times > 2.0]
    case.bound("own trunk: largest distance after the first turn", 1e3 * moving.max(), 0.5,
               unit="mm", source="aim")
    case.report("own trunk: mean distance after the first turn", 1e3 * moving.mean(), unit="mm",
                source="aim")
    figure, panels = plots.axes(2)
    panels[0].semilogy(times, 1e3 * errors, color=plots.OURS, label="own trunk")
    scene = published_trunk()
    if scene is None:
        case.skip("published trunk: largest distance after the first turn",
                  "the published mesh is not present", source="aim")
    else:
        times, errors, residual = track(scene, "nearest")
        case.bound("published trunk: largest distance after the first turn",
                   1e3 * errors[times > 2.0].max(), 0.5, unit="mm", source="aim")
        panels[0].semilogy(times, 1e3 * errors, color=plots.SECOND, label="published trunk")
    case.bound("bias at rest, changes penalised (default)", 1e3 * bias("change", 1e-3), 0.05, unit="mm",
               source="aim")
    case.report("bias at rest, efforts penalised, eps 1e-3 as published",
                1e3 * bias("effort", 1e-3), unit="mm", source="Coevoet 2017")
    case.report("bias at rest, efforts penalised, eps 1e-5", 1e3 * bias("effort", 1e-5),
                unit="mm", source="Coevoet 2017")
    distances = out_of_reach(case)
    panels[0].set(xlabel="time (s)", ylabel="distance to target (mm)")
    panels[0].legend()
    panels[1].plot(0.01 * np.arange(len(distances)), 1e3 * np.array(distances), color=plots.OURS)
    panels[1].set(xlabel="time (s)", ylabel="distance to a target out of reach (mm)", ylim=(0, None))
    case.figure(figure, "Following a circle; approaching a target that cannot be reached.")
