#include "sinew/qp/quadratic_program.hpp"

#include <array>

#include "sinew/core/types.hpp"

namespace sinew::qp {

QuadraticProgram QuadraticProgram::sized(int variables, int constraints) {
  QuadraticProgram problem;
  problem.hessian = MatrixX::Zero(variables, variables);
  problem.gradient = VectorX::Zero(variables);
  problem.lower = VectorX::Constant(variables, -kInfinity);
  problem.upper = VectorX::Constant(variables, kInfinity);
  problem.rows = MatrixX::Zero(constraints, variables);
  problem.row_lower = VectorX::Constant(constraints, -kInfinity);
  problem.row_upper = VectorX::Constant(constraints, kInfinity);
  return problem;
}

std::string_view qp_status_name(QpStatus status) {
  constexpr std::array<std::string_view, 6> kNames = {
      "optimal", "infeasible", "unbounded", "not-convex", "iteration-limit", "not-finite"};
  return kNames.at(static_cast<std::size_t>(status));
}

}  // namespace sinew::qp
