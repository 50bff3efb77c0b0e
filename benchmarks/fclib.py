"""Solves frictional contact problems of other simulators (FCLIB) with sinew.qp.solve_cones and, if installed, Siconos.

    PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/fclib.py ../shared/data/fclib [name ...]

Times are processor times of one thread: the median of several calls from a cold start, for the symmetric part of W, to 1e-8 in
the natural map. For Siconos, the best of seven solvers counts. Its package (python3-siconos, Apache-2.0) is needed for this
comparison only.
"""

import pathlib
import statistics
import sys
import time

import numpy as np
import sinew
from scipy.sparse import bsr_matrix, csc_matrix

try:
    import siconos.numerics as siconos
except ImportError:
    siconos = None

TOLERANCE = 1e-8
SOLVERS = ["NSGS", "NSN_AC", "PROX", "ADMM", "VI_EG", "ACLMFP", "VI_FPP"]


def read(path):
    """Sparse W (3n, 3n), q (3n,) and friction (n,) from FCLIB's HDF5 or a text file (dense by columns, or 3x3 blocks by rows)."""
    if path.suffix == ".hdf5":
        problem = sinew.qp.read_fclib(path)
        return csc_matrix(0.5 * (problem.W + problem.W.T)), problem.q, problem.friction
    numbers = iter(path.read_text().split())
    take = lambda count: np.array([float(next(numbers)) for _ in range(count)])
    _, contacts, kind = take(3).astype(int)
    rows = 3 * contacts
    if kind == 0:
        take(4)
        w = csc_matrix(take(rows * rows).reshape(rows, rows).T)
    else:
        _, _, blocks, _, _ = take(5).astype(int)
        take(2 * contacts)
        sizes = take(2).astype(int)
        start, column = take(sizes[0]).astype(int), take(sizes[1]).astype(int)
        values = take(10 * blocks).reshape(blocks, 10)[:, 1:].reshape(blocks, 3, 3).transpose(0, 2, 1)
        w = csc_matrix(bsr_matrix((values, column, start), shape=(rows, rows)))
    return csc_matrix(0.5 * (w + w.T)), take(rows), take(contacts)


def natural_map(w, q, friction, r):
    """Error |r - P_K(r - v)|/|q|, v = (u_n + mu |u_t|, u_t)."""
    r, u = r.reshape(-1, 3), (w @ r + q).reshape(-1, 3)
    z = r - u
    z[:, 0] -= friction * np.hypot(u[:, 1], u[:, 2])
    across = np.hypot(z[:, 1], z[:, 2])
    along = np.maximum(0.0, (z[:, 0] + friction * across) / (1.0 + friction**2))
    on_ray = np.column_stack([along, (friction * along / np.maximum(across, 1e-300))[:, None] * z[:, 1:]])
    nearest = np.where((across <= friction * z[:, 0])[:, None], z, on_ray)
    return np.linalg.norm(r - nearest) / np.linalg.norm(q)


def median_time(call):
    """Median time of a call, ms, and the result of the last one."""
    times = []
    while len(times) < 3 or (sum(times) < 300.0 and len(times) < 31):
        begin = time.thread_time()
        result = call()
        times.append(1e3 * (time.thread_time() - begin))
    return statistics.median(times), result


def by_siconos(w, q, friction, name):
    """Efforts by one of Siconos' solvers."""
    options = siconos.SolverOptions(getattr(siconos, "SICONOS_FRICTION_3D_" + name))
    options.iparam[0] = 3000 if name in ("NSGS", "VI_EG", "VI_FPP") else 300
    options.dparam[0] = TOLERANCE
    matrix = w.toarray() if len(friction) < 9 else w
    problem = siconos.FrictionContactProblem(3, len(friction), matrix, q, friction)
    r, u = np.zeros(len(q)), np.zeros(len(q))
    siconos.fc3d_driver(problem, r, u, options)
    return r


def best_of_siconos(w, q, friction):
    """Shortest time, ms, and name of the solver, among those that solve the problem."""
    found = [(float("inf"), "none")]
    for name in SOLVERS:
        once = time.thread_time()
        r = by_siconos(w, q, friction, name)
        once = 1e3 * (time.thread_time() - once)
        if natural_map(w, q, friction, r) > 1.01 * TOLERANCE or once > 10.0 * min(found)[0] + 1.0:
            continue
        found.append((median_time(lambda: by_siconos(w, q, friction, name))[0], name))
    return min(found)


def main():
    folder, *names = sys.argv[1:]
    print("| problem | contacts | sinew ms | iterations | error | Siconos ms | its solver |\n|---|---|---|---|---|---|---|")
    paths = [path for path in pathlib.Path(folder).iterdir() if path.suffix in (".dat", ".hdf5")]
    for path in sorted(paths, key=lambda p: p.stat().st_size):
        if names and path.stem not in names:
            continue
        w, q, friction = read(path)
        matrix = w.toarray() if len(friction) < 9 else w
        took, solution = median_time(lambda: sinew.qp.solve_cones(matrix, q, friction, TOLERANCE))
        error = natural_map(w, q, friction, solution.x)
        other = best_of_siconos(w, q, friction) if siconos else (float("nan"), "not installed")
        print(f"| {path.stem} | {len(friction)} | {took:.3g} | {solution.iterations} | {error:.0e} "
              f"| {other[0]:.3g} | {other[1]} |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
