#include "sinew/statics/path_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/world/row_motions.hpp"
#include "sinew/world/world.hpp"

namespace sinew::statics {

namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

// Regularisation of the points' forces, relative to their compliance: a point that a roller keeps
// from moving also has a force. It acts only on changes, which vanish on convergence.
constexpr double kGives = 1e-9;

// The linearised law of a point's rows, the tangential ones multiplied by its tangential
// compliance.
struct PointLaw {
  Matrix3 by_effort = Matrix3::Zero();  // m/N
  Matrix3 by_motion = Matrix3::Identity();
  Vector3 miss = Vector3::Zero();  // m
};

// Mean tangential compliance of a point, m/N.
double compliance_along(const law::StepProblem& problem, const law::ContactBlock& block) {
  return 0.5 * problem.compliance.diagonal().segment<2>(block.row + 1).sum();
}

bool rubs(const law::StepProblem& problem, const law::ContactBlock& block) {
  return block.friction > 0.0 && compliance_along(problem, block) > 0.0;
}

PointLaw law_of(const world::World& world, const law::ContactBlock& block,
                std::span<const double> effort) {
  PointLaw law;
  const law::StepProblem& problem = world.problem();
  law.miss = problem.delta.segment<3>(block.row);
  if (!rubs(problem, block)) return law;
  const int row = world.numbering().model_row_of(block.row);
  const Eigen::Map<const Vector3> force(&effort[static_cast<std::size_t>(row)]);
  const double along = compliance_along(problem, block);
  const double limit = block.friction * std::max(force[0], 0.0);
  const Vector2 aim = force.tail<2>() - law.miss.tail<2>() / along;
  const double size = aim.norm();
  if (size <= limit) return law;
  const Vector2 direction = aim / size;
  const Matrix2 part = limit / size * (Matrix2::Identity() - direction * direction.transpose());
  law.by_motion.bottomRightCorner<2, 2>() = part;
  law.by_effort.bottomRightCorner<2, 2>() = along * (Matrix2::Identity() - part);
  law.by_effort.bottomLeftCorner<2, 1>() = -along * block.friction * direction;
  law.miss.tail<2>() = along * (force.tail<2>() - limit * direction);
  return law;
}

}  // namespace

PathContacts::PathContacts(world::World& world, world::HeldMotions& joints,
                           std::span<const law::ContactBlock> touching,
                           std::span<const double> effort)
    : world_(world), joints_(joints) {
  std::vector<int> rows;
  for (const law::ContactBlock& block : touching) {
    const int count = rubs(world.problem(), block) ? 3 : 1;
    for (int k = 0; k < count; ++k) rows.push_back(block.row + k);
  }
  if (rows.empty()) return;
  for (const int row : rows) held_.push_back({row, 0.0});
  forces_ = world::row_forces(world, rows);
  compliance_ = joints.compliance(rows);
  ask(touching, effort);
  factorise();
}

// Collects E, F and the residual of all points.
void PathContacts::ask(std::span<const law::ContactBlock> touching,
                       std::span<const double> effort) {
  const auto size = static_cast<Eigen::Index>(held_.size());
  by_effort_.setZero(size, size);
  by_motion_.setZero(size, size);
  miss_.resize(size);
  Eigen::Index row = 0;
  for (const law::ContactBlock& block : touching) {
    const PointLaw law = law_of(world_, block, effort);
    const Eigen::Index count = rubs(world_.problem(), block) ? 3 : 1;
    by_effort_.block(row, row, count, count) = law.by_effort.topLeftCorner(count, count);
    by_motion_.block(row, row, count, count) = law.by_motion.topLeftCorner(count, count);
    miss_.segment(row, count) = law.miss.head(count);
    row += count;
  }
}

void PathContacts::factorise() {
  MatrixX system = by_effort_ + by_motion_ * compliance_;
  scale_ = compliance_.diagonal().cwiseAbs();
  const double least = kGives * scale_.maxCoeff();
  for (double& scale : scale_) scale = 1.0 / std::sqrt(std::max(scale, least));
  system = scale_.asDiagonal() * system * scale_.asDiagonal();
  system.diagonal().array() += kGives;
  factor_.compute(system);
}

void PathContacts::solve(const VectorX& right, bool closes, world::HeldAnswer& answer,
                         VectorX& efforts) {
  const VectorX still = VectorX::Zero(static_cast<Eigen::Index>(joints_.rows().size()));
  joints_.solve(right, closes ? joints_.gaps() : still, answer);
  efforts.resize(static_cast<Eigen::Index>(held_.size()));
  if (held_.empty()) return;
  VectorX lacks = by_motion_ * (forces_.transpose() * answer.motion);
  if (closes) lacks += miss_;
  factor_.solve(scale_.cwiseProduct(lacks), efforts);
  efforts = -scale_.cwiseProduct(efforts);
  world::HeldAnswer pushed;
  joints_.solve(forces_ * efforts, still, pushed);
  answer.motion += pushed.motion;
  answer.efforts += pushed.efforts;
}

double path_miss(const world::World& world, std::span<const law::ContactBlock> touching,
                 std::span<const double> effort) {
  double worst = 0.0;
  for (const law::ContactBlock& block : touching) {
    const Vector3 miss = law_of(world, block, effort).miss;
    const bool along = rubs(world.problem(), block);
    worst = std::max(worst, along ? miss.cwiseAbs().maxCoeff() : std::abs(miss[0]));
  }
  return worst;
}

}  // namespace sinew::statics
