#include "sinew/world/stability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/qp/friction_cone.hpp"
#include "sinew/world/world.hpp"

namespace sinew::world {

namespace {

constexpr int kMaxDirections = 80;  // of Lanczos' method
constexpr double kRitzTolerance = 1e-2;
// A direction is neutral if a motion along it by the robot's size changes forces by at most this
// multiple of their rounding error.
constexpr double kNeutral = 10.0;

}  // namespace

// Steele, Lea, Flood, OOPSLA 2014: SplitMix64.
VectorX scattered(Eigen::Index size) {
  VectorX result(size);
  std::uint64_t state = 0;
  for (double& value : result) {
    state += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    value = static_cast<double>(z >> 11U) * 0x1p-52 - 1.0;
  }
  return result;
}

void append_touching(const law::StepProblem& problem, std::span<const double> effort,
                     std::vector<law::HeldRow>& held) {
  for (const law::ContactBlock& block : problem.contacts) {
    const double* force = effort.data() + block.row;
    if (!(force[0] > 0.0)) continue;
    held.push_back({block.row, 0.0});
    if (qp::slides(Eigen::Map<const Vector3>(force), block.friction)) continue;
    held.push_back({block.row + 1, 0.0});
    held.push_back({block.row + 2, 0.0});
  }
}

std::vector<law::HeldRow> held_rows(const law::StepProblem& problem,
                                    std::span<const double> effort) {
  std::vector<law::HeldRow> held;
  for (const law::ActuatorBlock& range : problem.actuators) {
    if (range.row < 0) continue;
    if (range.drive != nullptr) {
      const auto at = range.drive->respond(range.drive_step, problem.delta[range.row]);
      if (at.slope < 0.0) held.push_back({range.row, -1.0 / at.slope});
    } else if (range.held(effort[static_cast<std::size_t>(range.row)])) {
      held.push_back({range.row, 0.0});
    }
  }
  append_touching(problem, effort, held);
  law::append_joints(problem, held);
  return held;
}

std::vector<law::HeldRow> held_rows(const World& world, std::span<const double> effort) {
  linalg::AlignedNumbers gathered;
  world.numbering().gather_efforts(effort, gathered);
  return held_rows(world.problem(), gathered);
}

Stability::Stability(World& world, std::span<const double> effort)
    : world_(world),
      motions_(world, held_rows(world, effort)),
      negative_(motions_.negative_pivots()) {
  if (negative_ == 0) return;
  const VectorX direction = find_mode();
  if (direction.size() == 0) return;
  motions_.solve(direction, mode_);
  curvature_ = direction.dot(mode_);
  scale_mode();
  const double force = -curvature_ / mode_.norm() * world_.problem().size;
  if (force <= kNeutral * world_.bodies().rounding_floor()) negative_ = 0;
}

// Lanczos' method on T with full reorthogonalisation (Parlett, The Symmetric Eigenvalue Problem,
// 1998, ch. 13). The negative eigenvalues of T lie at one end of its spectrum, so few directions
// suffice; the one nearest to zero belongs to the lowest eigenvalue of the tangent. For a Ritz
// vector y with theta < 0, v = T y has v^T A v = y^T T y = theta: the curvature along v is
// negative, however accurate y is.
VectorX Stability::find_mode() {
  const Eigen::Index all = static_cast<Eigen::Index>(world_.bodies().size());
  const Eigen::Index most = std::min<Eigen::Index>(kMaxDirections, all);
  VectorX next, ritz;
  motions_.solve(scattered(all), next);  // projects onto the free motions
  MatrixX basis(all, 0);
  MatrixX projected = MatrixX::Zero(most, most);
  for (Eigen::Index size = 1; size <= most && next.norm() > 0.0; ++size) {
    basis.conservativeResize(Eigen::NoChange, size);
    basis.col(size - 1) = next.normalized();
    motions_.solve(basis.col(size - 1), next);
    for (int pass = 0; pass < 2; ++pass) {  // the second removes rounding errors
      const VectorX along = basis.transpose() * next;
      next.noalias() -= basis * along;
      projected.col(size - 1).head(size) += along;
    }
    const MatrixX part = projected.topLeftCorner(size, size).selfadjointView<Eigen::Upper>();
    const linalg::SymmetricSpectrum spectrum(part);
    const Eigen::Index found = (spectrum.values().array() < 0.0).count();
    if (found == 0) continue;
    ritz = spectrum.vectors().col(found - 1);  // eigenvalues ascend
    const double left = next.norm() * std::abs(ritz[size - 1]);
    const bool sharp = left <= kRitzTolerance * std::abs(spectrum.values()[found - 1]);
    if (sharp && found >= negative_) break;
  }
  if (ritz.size() == 0) return {};
  return basis.leftCols(ritz.size()) * ritz;
}

// Scales the largest entry to 1, which also fixes the sign.
void Stability::scale_mode() {
  Eigen::Index largest = 0;
  mode_.cwiseAbs().maxCoeff(&largest);
  const double peak = mode_[largest];
  mode_ /= peak;
  curvature_ /= peak * peak;
}

}  // namespace sinew::world
