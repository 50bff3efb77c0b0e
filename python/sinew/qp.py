"""Complementarity problems by themselves: contacts with Coulomb friction.

    solution = sinew.qp.solve_cones(W, q, friction)
    solution.x, solution.status, solution.residual

    problem = sim.contact_problem()                    # of the last step
    sinew.qp.write_fclib("step.hdf5", problem.W, problem.q, problem.friction, problem.r)
"""

from ._core import ConeSolution, ContactProblem, read_fclib, solve_cones, write_fclib

__all__ = ["ConeSolution", "ContactProblem", "read_fclib", "solve_cones", "write_fclib"]

ConeSolution.__module__ = "sinew.qp"
ContactProblem.__module__ = "sinew.qp"
