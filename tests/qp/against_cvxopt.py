"""Solves our random quadratic programs with cvxopt and compares status, objective and x.

usage: against_cvxopt.py DUMP_PROGRAM

DUMP_PROGRAM FILE writes the problems with our solutions. Infeasible problems are compared with the
linear programs that minimise the largest and the summed violation, solved by SciPy's HiGHS.
Semidefinite problems are compared with Tikhonov regularisation. Fails if cvxopt or SciPy is missing.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import cvxopt
import numpy as np
from cvxopt import matrix, solvers
from scipy.optimize import linprog

solvers.options.update(show_progress=False, abstol=1e-11, reltol=1e-11, feastol=1e-11, maxiters=200)


def limits(values, default):
    return np.array([default if v is None else v for v in values], dtype=float)


def one_sided(problem, row_share):
    """Bounds and rows as A x <= b; the columns of `row_share` are slack variables that relax the rows."""
    n = len(problem["gradient"])
    extra = row_share.shape[1]
    blocks, right = [], []
    for a, low, high, share in (
        (np.eye(n), problem["lower"], problem["upper"], np.zeros((n, extra))),
        (np.array(problem["rows"]), problem["row_lower"], problem["row_upper"], row_share),
    ):
        low, high = limits(low, -np.inf), limits(high, np.inf)
        for sign, limit in ((1.0, high), (-1.0, low)):
            keep = np.isfinite(limit)
            blocks.append(np.hstack([sign * a, -share])[keep])
            right.append(sign * limit[keep])
    return np.vstack(blocks), np.concatenate(right)


def unit_scale(problem):
    """Scale that makes the nonzero entries of the Hessian's diagonal one."""
    diagonal = np.diag(np.array(problem["hessian"]))
    return np.where(diagonal > 0.0, np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)), 1.0)


def reference(problem, shift=0.0):
    """Solution x of the quadratic program, computed with a unit diagonal. Equalities are passed
    separately, without dependent ones, because pairs of inequalities have no interior. `shift` is
    added to the scaled diagonal."""
    a, b = one_sided(problem, np.zeros((len(problem["rows"]), 0)))
    scale = 1.0 / unit_scale(problem)
    a = a * scale
    length = np.linalg.norm(a, axis=1)
    a, b = a / length[:, None], b / length
    equal = np.zeros(len(b), dtype=bool)
    for i in range(len(b)):
        equal[i] = np.any((np.abs(a + a[i]).max(axis=1) < 1e-12) & (np.abs(b + b[i]) < 1e-12))
    e, f = [], []
    for row, value in zip(a[equal], b[equal]):
        if np.linalg.matrix_rank(np.array(e + [row]), tol=1e-9) > len(e):
            e.append(row)
            f.append(value)
    hessian = np.array(problem["hessian"]) * np.outer(scale, scale) + shift * np.eye(len(scale))
    size = max(1.0, np.abs(np.array(problem["gradient"]) * scale).max())
    arguments = [matrix(hessian), matrix(np.array(problem["gradient"]) * scale / size),
                 matrix(a[~equal]), matrix(b[~equal] / size)]
    if e:
        arguments += [matrix(np.array(e)), matrix(np.array(f) / size)]
    solution = solvers.qp(*arguments)
    return np.array(solution["x"]).ravel() * size * scale


def least_violation(problem, measure):
    """Smallest violation, by a simplex method: interior-point methods are too inaccurate for these
    degenerate linear programs."""
    m, n = len(problem["rows"]), len(problem["gradient"])
    share = np.eye(m) if measure == "sum" else np.ones((m, 1))
    a, b = one_sided(problem, share)
    k = share.shape[1]
    cost = np.concatenate([np.zeros(n), np.ones(k)])
    bounds = [(None, None)] * n + [(0.0, None)] * k
    solution = linprog(cost, A_ub=a, b_ub=b, bounds=bounds, method="highs-ds")
    assert solution.status == 0, solution.message
    return solution.fun


def objective(problem, x):
    return 0.5 * x @ np.array(problem["hessian"]) @ x + np.array(problem["gradient"]) @ x


def compare_feasible(problem, report):
    theirs = reference(problem)
    ours = np.array(problem["x"])
    scale = np.sqrt(np.diag(np.array(problem["hessian"])))
    size = np.linalg.norm(scale * ours) + 1e-9
    gap = objective(problem, ours) - objective(problem, theirs)
    magnitude = abs(objective(problem, ours)) + 0.5 * size**2
    distance = np.linalg.norm(scale * (ours - theirs)) / size
    report("objective", abs(gap) / magnitude, 1e-9)
    report("x", distance, 1e-5 if problem["kind"] == "badly_scaled" else 1e-6)


def compare_semidefinite(problem, report):
    """The optimum is not unique. Tikhonov's solution is never longer than the one of minimum norm and
    converges to it as the shift goes to zero, at a rate that depends on the problem."""
    theirs = reference(problem, shift=1e-5)
    ours = np.array(problem["x"])
    scale = unit_scale(problem)
    size = np.linalg.norm(scale * ours) + 1e-2
    magnitude = abs(objective(problem, ours)) + 0.5 * size**2
    report("objective", max(0.0, objective(problem, ours) - objective(problem, theirs)) / magnitude, 1e-9)
    longer = np.linalg.norm(scale * theirs) - np.linalg.norm(scale * ours)
    report("effort above Tikhonov's", max(0.0, longer) / size, 1e-5)
    report("x", np.linalg.norm(scale * (ours - theirs)) / size, 3e-3)


def compare_infeasible(problem, report):
    for measure in ("worst", "sum"):
        answer = problem[measure]
        if answer["status"] != "relaxed":
            report(measure + " status " + answer["status"], 1.0, 0.0)
            continue
        violation = np.abs(np.array(answer["violation"]))
        ours = violation.max() if measure == "worst" else violation.sum()
        theirs = least_violation(problem, measure)
        report(measure, abs(ours - theirs) / (1.0 + abs(theirs)), 1e-9)


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "problems.json"
        subprocess.run([sys.argv[1], str(path)], check=True)
        problems = json.loads(path.read_text())
    failures, worst = [], {}
    for number, problem in enumerate(problems):

        def report(what, value, allowed):
            key = problem["kind"], what
            worst[key] = max(worst.get(key, 0.0), value)
            if not value <= allowed:
                failures.append(f"problem {number} ({problem['kind']}): {what} {value:.2e} > {allowed:.0e}")

        feasible = problem["kind"] != "infeasible"
        expected = "optimal" if feasible else "infeasible"
        report("status " + problem["status"], float(problem["status"] != expected), 0.0)
        compare = {"infeasible": compare_infeasible, "semidefinite": compare_semidefinite}
        compare.get(problem["kind"], compare_feasible)(problem, report)
    for (kind, what), value in worst.items():
        print(f"{kind:16s} {what:20s} {value:.2e}")
    print(f"{len(problems)} problems against cvxopt {cvxopt.__version__}, {len(failures)} differences")
    print("\n".join(failures[:20]))
    return 1 if failures or len(problems) < 200 else 0


if __name__ == "__main__":
    sys.exit(main())
