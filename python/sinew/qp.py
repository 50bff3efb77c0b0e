"""Solvers for quadratic programs and for contact problems with Coulomb friction.

    found = sinew.qp.solve_quadratic(G, g, lower, upper, C, row_lower, row_upper)
    found.x, found.status

    solution = sinew.qp.solve_cones(W, q, friction)
    solution.x, solution.status, solution.residual

    problem = sim.contact_problem()                    # of the last step
    sinew.qp.write_fclib("step.hdf5", problem.W, problem.q, problem.friction, problem.r)
"""

from ._core import (
    ConeSolution,
    ContactProblem,
    QuadraticSolution,
    read_fclib,
    solve_cones,
    solve_quadratic,
    write_fclib,
)

__all__ = [
    "ConeSolution",
    "ContactProblem",
    "QuadraticSolution",
    "read_fclib",
    "solve_cones",
    "solve_quadratic",
    "write_fclib",
]

ConeSolution.__module__ = "sinew.qp"
ContactProblem.__module__ = "sinew.qp"
QuadraticSolution.__module__ = "sinew.qp"
