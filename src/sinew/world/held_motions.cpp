#include "sinew/world/held_motions.hpp"

#include <algorithm>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/world/row_motions.hpp"
#include "sinew/world/world.hpp"

namespace sinew::world {

HeldMotions::HeldMotions(World& world, std::vector<law::HeldRow> held)
    : world_(world), held_(std::move(held)), negative_(count()) {}

int HeldMotions::count() {
  if (!world_.inertia().is_counted()) {
    throw Error(ErrorKind::not_in_this_version, {.item = "solver.factorisation"},
                "whether an equilibrium is stable is not known with a solver that does not count "
                "negative eigenvalues",
                "choose `factorisation: block`, or approach the load through time steps");
  }
  const int pivots = world_.inertia().at_least();
  const bool has_less =
      std::ranges::any_of(held_, [](const law::HeldRow& row) { return row.compliance < 0.0; });
  if (held_.empty() || (pivots == 0 && !has_less)) return pivots;
  return std::max(0, law::negative_directions(pivots, invert(), held_));
}

// @return the number of negative eigenvalues of S.
int HeldMotions::invert() {
  const auto [matrix, scale] = law::held_compliance(world_.problem(), held_);
  const auto scaled = linalg::spectral_inverse(matrix);
  inverse_ = scale.asDiagonal() * scaled.inverse * scale.asDiagonal();
  return scaled.negative;
}

void HeldMotions::move_rows() {
  std::vector<int> rows;
  for (const law::HeldRow& row : held_) rows.push_back(row.row);
  const MatrixX forces = row_forces(world_, rows);
  moved_.resize(forces.rows(), forces.cols());
  VectorX solved;
  for (Eigen::Index k = 0; k < forces.cols(); ++k) {
    world_.bodies().solve(forces.col(k), solved);
    moved_.col(k) = solved;
  }
}

VectorX HeldMotions::gaps() const {
  VectorX result = VectorX::Zero(static_cast<Eigen::Index>(held_.size()));
  for (std::size_t k = 0; k < held_.size(); ++k) {
    if (held_[k].compliance != 0.0) continue;
    result[static_cast<Eigen::Index>(k)] = world_.problem().delta[held_[k].row];
  }
  return result;
}

MatrixX HeldMotions::compliance(const std::vector<int>& rows) {
  const MatrixX& whole = world_.problem().compliance;
  MatrixX result = whole(rows, rows);
  if (held_.empty()) return result;
  if (inverse_.size() == 0) invert();
  std::vector<int> own;
  for (const law::HeldRow& row : held_) own.push_back(row.row);
  const MatrixX across = whole(own, rows);
  result.noalias() -= across.transpose() * inverse_ * across;
  return result;
}

void HeldMotions::solve(const VectorX& right, VectorX& motion) {
  HeldAnswer answer;
  solve(right, VectorX::Zero(static_cast<Eigen::Index>(held_.size())), answer);
  motion = std::move(answer.motion);
}

void HeldMotions::solve(const VectorX& right, const VectorX& gap, HeldAnswer& answer) {
  world_.bodies().solve(right, answer.motion);
  answer.efforts.resize(gap.size());
  if (held_.empty()) return;
  if (inverse_.size() == 0) invert();
  if (moved_.size() == 0) move_rows();
  answer.efforts.noalias() = -inverse_ * (moved_.transpose() * right + gap);
  answer.motion.noalias() += moved_ * answer.efforts;
}

}  // namespace sinew::world
