#include "sinew/sim/held_motions.hpp"

#include <algorithm>
#include <utility>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

HeldMotions::HeldMotions(World& world, std::vector<step::HeldRow> held)
    : world_(world), held_(std::move(held)), negative_(count()) {}

int HeldMotions::count() {
  const int pivots = world_.inertia().negative_pivots;
  const bool as_it_is = pivots == 0 && world_.problem().stiffness.empty();
  if (held_.empty() || as_it_is) return pivots;
  return std::max(0, step::negative_directions(pivots, invert(), held_));
}

// @return negative eigenvalues of S.
int HeldMotions::invert() {
  const auto [matrix, scale] = step::held_compliance(world_.problem(), held_);
  const auto scaled = linalg::spectral_inverse(matrix);
  inverse_ = scale.asDiagonal() * scaled.inverse * scale.asDiagonal();
  return scaled.negative;
}

void HeldMotions::move_rows() {
  const std::size_t rows = world_.numbering().places().size();
  std::vector<double> unit(rows, 0.0);
  VectorX rest, row, solved;
  world_.bodies().imbalance(unit, rest);
  moved_.resize(rest.size(), static_cast<Eigen::Index>(held_.size()));
  for (std::size_t k = 0; k < held_.size(); ++k) {
    double& own = unit[static_cast<std::size_t>(world_.numbering().row_of(held_[k].row))];
    own = 1.0;
    world_.bodies().imbalance(unit, row);
    own = 0.0;
    world_.bodies().solve(row - rest, solved);
    moved_.col(static_cast<Eigen::Index>(k)) = solved;
  }
}

void HeldMotions::solve(const VectorX& right, VectorX& motion) {
  VectorX efforts;
  solve(right, VectorX::Zero(static_cast<Eigen::Index>(held_.size())), motion, efforts);
}

void HeldMotions::solve(const VectorX& right, const VectorX& gap, VectorX& motion,
                        VectorX& efforts) {
  world_.bodies().solve(right, motion);
  efforts.resize(gap.size());
  if (held_.empty()) return;
  if (inverse_.size() == 0) invert();
  if (moved_.size() == 0) move_rows();
  efforts.noalias() = -inverse_ * (moved_.transpose() * right + gap);
  motion.noalias() += moved_ * efforts;
}

}  // namespace sinew::sim
