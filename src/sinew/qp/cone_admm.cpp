// The alternating direction method of multipliers on a sparse part: with D the diagonal of the w
// and one factorisation of W + rho D,
//   (W + rho D) x = rho D (z - y) - offset - mu |v_t| n,   z = P(x + y),   y <- x + y - z,
// v = -rho D y, where P projects onto cones and boxes (for contacts: Acary, Bremond & Huber 2018,
// ch. 10, and Carpentier, Le Lidec & Montaut 2024; the normal part of De Saxce's change of
// variables is one iteration behind). If most contacts stick, as in towers, a few iterations
// achieve what Newton's method needs as many factorisations for. Elsewhere the method is slow and
// stops at once.
#include <algorithm>
#include <cmath>

#include "sinew/qp/cone_island.hpp"

namespace sinew::qp {

namespace {

constexpr double kPenalty = 1e-3;  // rho, of the diagonal
constexpr int kMaxAlternations = 12;
constexpr double kSlow = 0.5;  // stop if an iteration leaves more of the residual

}  // namespace

bool ConeIsland::alternate(const ConePart& part) {
  const ConeProblem& problem = part.problem;
  if (judge(part) <= settings_.tolerance) return true;
  if (!factorise_proximal(part, kPenalty)) return false;
  std::copy_n(x_.data(), x_.size(), best_.data());
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    if (!usable(k)) continue;
    const int row = problem.cones[k].row;
    Vector3 v = motion_.segment<3>(row);
    v[0] += problem.cones[k].friction * v.tail<2>().norm();
    const Vector3 y = -v / (kPenalty * scale_[k]);
    dual_.segment<3>(row) = y - project_on_cone(y, problem.cones[k].friction);
  }
  for (const auto& box : problem.boxes) dual_[box.row] = 0.0;
  double before = kInfinity;
  for (int k = 0; k < kMaxAlternations; ++k) {
    solve_proximal(part);
    project_and_update(problem);
    measure_motion(part);
    const double residual = judge(part);
    ++result_.sweeps;
    if (residual <= settings_.tolerance) return true;
    if (!(residual <= kSlow * before) && k > 0) break;
    before = residual;
  }
  std::copy_n(best_.data(), x_.size(), x_.data());
  measure_motion(part);
  return false;
}

// Rows and columns times 1/sqrt(w), as in Newton's method; what cannot move is left out.
double ConeIsland::node_scale(std::size_t node) const {
  const double w = node < box_scale_.size() ? box_scale_[node] : scale_[node - box_scale_.size()];
  return w > 0.0 ? 1.0 / std::sqrt(w) : 0.0;
}

bool ConeIsland::factorise_proximal(const ConePart& part, double penalty) {
  const BlockMatrix& w = *part.blocks;
  for (int j = 0; j < w.nodes(); ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (int e = w.starts()[column]; e < w.starts()[column + 1]; ++e) {
      const auto row = static_cast<std::size_t>(w.rows()[static_cast<std::size_t>(e)]);
      Eigen::Map<Matrix3> block(part.lu->block(e));
      const double scale = node_scale(row) * node_scale(column);
      block = scale * w.block(e);
      if (row == column) block.diagonal().array() += scale > 0.0 ? penalty : 1.0;
    }
  }
  return part.lu->factorise();
}

// x of the method, into step_.
void ConeIsland::solve_proximal(const ConePart& part) {
  const ConeProblem& problem = part.problem;
  const std::size_t boxes = problem.boxes.size();
  for (std::size_t k = 0; k < boxes; ++k) {
    const BoxBlock& box = problem.boxes[k];
    const double pull = kPenalty * box_scale_[k] * (x_[box.row] - dual_[box.row]);
    step_[box.row] = node_scale(k) * (pull - problem.offset[box.row] + box.target);
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    const int row = problem.cones[k].row;
    const Vector3 y = dual_.segment<3>(row);
    Vector3 right =
        kPenalty * scale_[k] * (x_.segment<3>(row) - y) - problem.offset.segment<3>(row);
    right[0] -= problem.cones[k].friction * kPenalty * scale_[k] * y.tail<2>().norm();
    step_.segment<3>(row) = node_scale(boxes + k) * right;
  }
  part.lu->solve(step_.head(x_.size()));
  for (std::size_t k = 0; k < boxes; ++k) step_[problem.boxes[k].row] *= node_scale(k);
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    step_.segment<3>(problem.cones[k].row) *= node_scale(boxes + k);
  }
}

void ConeIsland::project_and_update(const ConeProblem& problem) {
  for (const BoxBlock& box : problem.boxes) {
    const double sum = step_[box.row] + dual_[box.row];
    x_[box.row] = std::clamp(sum, box.lower, box.upper);
    dual_[box.row] = sum - x_[box.row];
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    if (!usable(k)) continue;
    const int row = problem.cones[k].row;
    const Vector3 sum = step_.segment<3>(row) + dual_.segment<3>(row);
    const Vector3 nearest = project_on_cone(sum, problem.cones[k].friction);
    x_.segment<3>(row) = nearest;
    dual_.segment<3>(row) = sum - nearest;
  }
}

}  // namespace sinew::qp
