"""Complementarity problems by themselves: contacts with Coulomb friction.

    solution = sinew.qp.solve_cones(W, q, friction)
    solution.x, solution.status, solution.residual
"""

from ._core import ConeSolution, solve_cones

__all__ = ["ConeSolution", "solve_cones"]

ConeSolution.__module__ = "sinew.qp"
