#include "sinew/plan/brace_program.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "sinew/collision/principal_frame.hpp"
#include "sinew/core/rotation.hpp"

namespace sinew::plan {

namespace {

constexpr double kLengthScale = 0.01;  // m

/// A point after the rotation of the base, p_w = b + R (p - b), as a function of (q, gamma).
VectorDerivatives turned(const VectorDerivatives& local, const Vector3& base,
                         const Matrix3& rotation, const Matrix3& spin) {
  const Eigen::Index n = local.jacobian.cols();
  VectorDerivatives result;
  const Vector3 arm = rotation * (local.value - base);
  result.value = base + arm;
  result.jacobian.resize(3, n + 1);
  result.jacobian.leftCols(n) = rotation * local.jacobian;
  result.jacobian.col(n) = spin * arm;
  const MatrixX mixed = spin * result.jacobian.leftCols(n);
  const Vector3 twice = spin * spin * arm;
  for (std::size_t x = 0; x < 3; ++x) {
    const auto row = static_cast<Eigen::Index>(x);
    MatrixX& hessian = result.hessian[x];
    hessian.resize(n + 1, n + 1);
    hessian.topLeftCorner(n, n) = rotation(row, 0) * local.hessian[0] +
                                  rotation(row, 1) * local.hessian[1] +
                                  rotation(row, 2) * local.hessian[2];
    hessian.col(n).head(n) = mixed.row(row).transpose();
    hessian.row(n).head(n) = mixed.row(row);
    hessian(n, n) = twice[row];
  }
  return result;
}

}  // namespace

double SurfacePatch::gap(const Vector3& p) const {
  if (projection.isZero()) return normal.dot(p - centre);
  return ((projection * (p - centre)).squaredNorm() - radius * radius) / (2.0 * radius);
}

std::vector<SurfacePatch> patches_of(const constraint::SmoothSurface& surface) {
  const auto ball = [](const Vector3& centre, double radius) {
    SurfacePatch patch;
    patch.projection = Matrix3::Identity();
    patch.centre = centre;
    patch.radius = radius;
    return patch;
  };
  if (const auto* plane = std::get_if<constraint::Plane>(&surface)) {
    SurfacePatch patch;
    patch.centre = plane->point;
    patch.normal = plane->normal;
    return {patch};
  }
  if (const auto* sphere = std::get_if<constraint::Sphere>(&surface)) {
    return {ball(sphere->centre, sphere->radius)};
  }
  const auto& capsule = std::get<constraint::Capsule>(surface);
  const Vector3 along = capsule.to - capsule.from;
  if (!(along.norm() > 0.0)) return {ball(capsule.from, capsule.radius)};
  SurfacePatch side = ball(capsule.from, capsule.radius);
  side.axis = along.normalized();
  side.projection -= side.axis * side.axis.transpose();
  side.lower = side.axis.dot(capsule.from);
  side.upper = side.axis.dot(capsule.to);
  SurfacePatch first = ball(capsule.from, capsule.radius), last = ball(capsule.to, capsule.radius);
  first.axis = last.axis = side.axis;
  first.upper = side.lower;
  last.lower = side.upper;
  return {side, first, last};
}

Matrix3 distance_hessian(const constraint::SmoothSurface& surface, const Vector3& point) {
  const collision::PrincipalFrame at = principal_frame(surface, point);
  return at.frame * at.curvature.asDiagonal() * at.frame.transpose();
}

BraceProgram::BraceProgram(const std::shared_ptr<const pcc::Arm>& arm, BraceProblem problem)
    : arm_(arm),
      equations_(arm),
      points_(arm),
      velocity_(arm),
      problem_(std::move(problem)),
      n_(arm->coordinates()),
      turn_(n_),
      torque_(n_ + 1),
      hold_(n_ + 1 + arm->inputs()),
      force_(hold_ + 1),
      first_held_(n_ + 6),
      first_clear_(first_held_ + static_cast<int>(problem_.held.cols())),
      still_(VectorX::Zero(n_)),
      spin_(cross_matrix(arm->settings().frame.col(2))) {
  const ArmLimits& limits = problem_.limits;
  torque_scale_ = std::max(
      {limits.torque_upper.cwiseAbs().maxCoeff(), limits.torque_lower.cwiseAbs().maxCoeff(), 1e-6});
  tip_factor_ = problem_.tip_weight / (problem_.tolerance * problem_.tolerance);
  const int inputs = arm_->inputs(), size = variables();
  variable_bounds_ = {VectorX::Constant(size, -kNoBound), VectorX::Constant(size, kNoBound)};
  variable_bounds_.lower.head(n_) = limits.angle_lower;
  variable_bounds_.upper.head(n_) = limits.angle_upper;
  variable_bounds_.lower[turn_] = problem_.turn_lower;
  variable_bounds_.upper[turn_] = problem_.turn_upper;
  variable_bounds_.lower.segment(torque_, inputs) = limits.torque_lower;
  variable_bounds_.upper.segment(torque_, inputs) = limits.torque_upper;
  variable_bounds_.lower[hold_] = 0.0;
  variable_bounds_.upper[hold_] = 1.0;
  variable_scale_ = VectorX::Ones(size);
  variable_scale_.segment(torque_, inputs).setConstant(torque_scale_);

  const auto clear =
      static_cast<Eigen::Index>(problem_.clear_points.size() * problem_.surfaces.size());
  constraint_bounds_ = {VectorX::Zero(first_clear_ + clear), VectorX::Zero(first_clear_ + clear)};
  constraint_scale_ = VectorX::Constant(first_clear_ + clear, kLengthScale);
  constraint_scale_.head(n_).setConstant(torque_scale_);
  const bool touches = problem_.held.cols() == 0;
  if (!touches) constraint_bounds_.lower[n_] = -kNoBound, constraint_bounds_.upper[n_] = kNoBound;
  constraint_bounds_.lower[n_ + 1] = touches ? problem_.patch.lower : -kNoBound;
  constraint_bounds_.upper[n_ + 1] = touches ? problem_.patch.upper : kNoBound;
  constraint_bounds_.lower[n_ + 2] = problem_.min_force;
  constraint_bounds_.upper[n_ + 2] = problem_.max_force;
  constraint_scale_[n_ + 2] = constraint_scale_[n_ + 3] = 1.0;
  constraint_bounds_.upper[n_ + 3] = kNoBound;
  constraint_bounds_.lower[n_ + 4] = -kNoBound;
  constraint_bounds_.upper[n_ + 4] = std::sqrt(2.0) * problem_.tolerance;
  constraint_bounds_.upper[n_ + 5] = kNoBound;
  constraint_scale_[n_ + 5] = 1.0;
  constraint_bounds_.lower.tail(clear).setConstant(problem_.clearance);
  constraint_bounds_.upper.tail(clear).setConstant(kNoBound);
  for (int row = 0; row < constraint_bounds_.lower.size(); ++row) {
    for (int column = 0; column < size; ++column) jacobian_pattern_.push_back({row, column});
  }
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) hessian_pattern_.push_back({i, j});
  }
  looked_at_ = {{.segment = arm_->segments() - 1}, problem_.point};
  looked_at_.insert(looked_at_.end(), problem_.clear_points.begin(), problem_.clear_points.end());
}

void BraceProgram::look(const VectorX& x) {
  if (looked_.size() == x.size() && looked_ == x) return;
  looked_ = x;
  rotation_ =
      Eigen::AngleAxisd(x[turn_], arm_->settings().frame.col(2).normalized()).toRotationMatrix();
  const auto& local = points_.positions(x.head(n_), looked_at_);
  braced_ = local[1];
  world_.clear();
  for (const VectorDerivatives& point : local) {
    world_.push_back(turned(point, arm_->settings().base, rotation_, spin_));
  }
  world_force_ = rotation_ * x.tail<3>();
  normal_ = problem_.patch.normal_at(world_[1].value);
  normal_force_ = normal_.dot(world_force_);
}

double BraceProgram::spare(const VectorX& x) const {
  return problem_.friction * normal_force_ - problem_.reserve * x[hold_];
}

double BraceProgram::objective(const VectorX& x) {
  look(x);
  return x.segment(torque_, arm_->inputs()).squaredNorm() / (torque_scale_ * torque_scale_) +
         problem_.force_weight * x.tail<3>().squaredNorm() +
         tip_factor_ * (world_[0].value - problem_.goal).squaredNorm() -
         problem_.hold_weight * x[hold_];
}

void BraceProgram::gradient(const VectorX& x, VectorX& result) {
  result.setZero(variables());
  const Eigen::Index inputs = arm_->inputs();
  result.segment(torque_, inputs) =
      2.0 / (torque_scale_ * torque_scale_) * x.segment(torque_, inputs);
  look(x);
  result.head(n_ + 1) =
      2.0 * tip_factor_ * world_[0].jacobian.transpose() * (world_[0].value - problem_.goal);
  result[hold_] = -problem_.hold_weight;
  result.tail<3>() = 2.0 * problem_.force_weight * x.tail<3>();
}

void BraceProgram::constraints(const VectorX& x, VectorX& result) {
  look(x);
  const Vector3 force = x.tail<3>();
  result.resize(constraint_bounds_.lower.size());
  result.head(n_) = equations_.residual(x.head(n_), still_, still_) -
                    arm_->actuation() * x.segment(torque_, arm_->inputs()) -
                    braced_.jacobian.transpose() * force;
  result[n_] = problem_.patch.gap(world_[1].value);
  result[n_ + 1] = problem_.patch.axis.dot(world_[1].value);
  result[n_ + 2] = normal_force_;
  const double left = spare(x);
  result[n_ + 3] = normal_force_ * normal_force_ + left * left - force.squaredNorm();
  result[n_ + 4] = std::hypot((world_[0].value - problem_.goal).norm(), problem_.tolerance);
  result[n_ + 5] = left;
  result.segment(first_held_, problem_.held.cols()) =
      problem_.held.transpose() * (world_[1].value - problem_.place);
  Eigen::Index row = first_clear_;
  for (std::size_t p = 2; p < world_.size(); ++p) {
    for (const constraint::SmoothSurface& surface : problem_.surfaces) {
      result[row++] = constraint::distance(surface, world_[p].value).gap;
    }
  }
}

VectorX BraceProgram::force_gradient() const {
  VectorX result = VectorX::Zero(force_ + 3);
  const SurfacePatch& patch = problem_.patch;
  result.head(n_ + 1) =
      world_[1].jacobian.transpose() * (patch.projection * world_force_) / patch.radius;
  result[turn_] += normal_.dot(spin_ * world_force_);
  result.tail<3>() = rotation_.transpose() * normal_;
  return result;
}

void BraceProgram::jacobian(const VectorX& x, double* values) {
  look(x);
  dense_.setZero(constraint_bounds_.lower.size(), variables());
  const Vector3 force = x.tail<3>();
  dense_.topLeftCorner(n_, n_) = equations_.linearise(x.head(n_), still_, still_).by_position;
  for (std::size_t k = 0; k < 3; ++k) {
    dense_.topLeftCorner(n_, n_) -= force[static_cast<Eigen::Index>(k)] * braced_.hessian[k];
  }
  dense_.block(0, torque_, n_, arm_->inputs()) = -arm_->actuation();
  dense_.topRightCorner(n_, 3) = -braced_.jacobian.transpose();
  dense_.row(n_).head(n_ + 1) = normal_.transpose() * world_[1].jacobian;
  dense_.row(n_ + 1).head(n_ + 1) = problem_.patch.axis.transpose() * world_[1].jacobian;
  const VectorX by_force = force_gradient();
  dense_.row(n_ + 2) = by_force.transpose();
  const double left = spare(x);
  dense_.row(n_ + 5) = problem_.friction * by_force.transpose();
  dense_(n_ + 5, hold_) -= problem_.reserve;
  dense_.row(n_ + 3) = 2.0 * normal_force_ * by_force.transpose() + 2.0 * left * dense_.row(n_ + 5);
  dense_.row(n_ + 3).tail<3>() -= 2.0 * force.transpose();
  dense_.block(first_held_, 0, problem_.held.cols(), n_ + 1) =
      problem_.held.transpose() * world_[1].jacobian;
  const Vector3 error = world_[0].value - problem_.goal;
  dense_.row(n_ + 4).head(n_ + 1) =
      error.transpose() * world_[0].jacobian / std::hypot(error.norm(), problem_.tolerance);
  Eigen::Index row = first_clear_;
  for (std::size_t p = 2; p < world_.size(); ++p) {
    for (const constraint::SmoothSurface& surface : problem_.surfaces) {
      dense_.row(row++).head(n_ + 1) =
          constraint::distance(surface, world_[p].value).normal.transpose() * world_[p].jacobian;
    }
  }
  for (const SparseEntry& entry : jacobian_pattern_) *values++ = dense_(entry.row, entry.column);
}

void BraceProgram::add_hessian(const VectorDerivatives& of, const Vector3& weights) {
  const Eigen::Index size = n_ + 1;
  for (std::size_t k = 0; k < 3; ++k) {
    dense_.topLeftCorner(size, size) += weights[static_cast<Eigen::Index>(k)] * of.hessian[k];
  }
}

/// Adds the Hessian of by_force F_n + by_cone (F_n^2 + s^2 - |f|^2), where s = mu F_n - h r,
/// F_n = N(p) . R f, and dN = P dp/R.
void BraceProgram::add_force_hessian(double by_force, double by_cone, double left) {
  const double factor = by_force + 2.0 * by_cone * (normal_force_ + problem_.friction * left);
  const Matrix3 bend = problem_.patch.projection / problem_.patch.radius;
  const auto& moved = world_[1].jacobian;
  const Eigen::Index size = n_ + 1;
  add_hessian(world_[1], factor * bend * world_force_);
  const VectorX by_turn = factor * moved.transpose() * (bend * (spin_ * world_force_));
  dense_.col(turn_).head(size) += by_turn;
  dense_.row(turn_).head(size) += by_turn.transpose();
  dense_(turn_, turn_) += factor * normal_.dot(spin_ * spin_ * world_force_);
  const MatrixX mixed = factor * moved.transpose() * bend * rotation_;
  const Vector3 twist = factor * (spin_ * rotation_).transpose() * normal_;
  dense_.block(0, force_, size, 3) += mixed;
  dense_.block(force_, 0, 3, size) += mixed.transpose();
  dense_.block<1, 3>(turn_, force_) += twist.transpose();
  dense_.block<3, 1>(force_, turn_) += twist;
  VectorX slope = force_gradient();
  dense_ += 2.0 * by_cone * slope * slope.transpose();
  slope *= problem_.friction;
  slope[hold_] -= problem_.reserve;
  dense_ += 2.0 * by_cone * slope * slope.transpose();
  dense_.bottomRightCorner<3, 3>().diagonal().array() -= 2.0 * by_cone;
}

void BraceProgram::hessian(const VectorX& x, double factor, const VectorX& multipliers,
                           double* values) {
  look(x);
  const Eigen::Index size = n_ + 1, inputs = arm_->inputs();
  dense_.setZero(variables(), variables());
  dense_.block(torque_, torque_, inputs, inputs).diagonal().array() +=
      2.0 * factor / (torque_scale_ * torque_scale_);
  dense_.bottomRightCorner<3, 3>().diagonal().array() += 2.0 * factor * problem_.force_weight;

  // lambda . J^T f is f . v, where v is the velocity of the braced point at the rate lambda.
  const Vector3 force = x.tail<3>();
  const VectorX balance = multipliers.head(n_);
  dense_.topLeftCorner(n_, n_) +=
      equations_.curvature(balance, x.head(n_), still_, still_).topLeftCorner(n_, n_);
  const VectorDerivatives& velocity = velocity_.velocity(x.head(n_), balance, problem_.point);
  for (std::size_t k = 0; k < 3; ++k) {
    dense_.topLeftCorner(n_, n_) -=
        force[static_cast<Eigen::Index>(k)] * velocity.hessian[k].topLeftCorner(n_, n_);
  }
  dense_.block(0, force_, n_, 3) -= velocity.jacobian.leftCols(n_).transpose();
  dense_.block(force_, 0, 3, n_) -= velocity.jacobian.leftCols(n_);

  const double by_gap = multipliers[n_];
  add_hessian(world_[1], by_gap * normal_ + multipliers[n_ + 1] * problem_.patch.axis);
  dense_.topLeftCorner(size, size) += by_gap / problem_.patch.radius *
                                      world_[1].jacobian.transpose() * problem_.patch.projection *
                                      world_[1].jacobian;
  add_force_hessian(multipliers[n_ + 2] + problem_.friction * multipliers[n_ + 5],
                    multipliers[n_ + 3], spare(x));
  add_hessian(world_[1], problem_.held * multipliers.segment(first_held_, problem_.held.cols()));

  const Vector3 error = world_[0].value - problem_.goal;
  const double length = std::hypot(error.norm(), problem_.tolerance);
  const double by_tip = multipliers[n_ + 4] / length;
  const VectorX slope = world_[0].jacobian.transpose() * error / length;
  const double by_square = by_tip + 2.0 * factor * tip_factor_;
  add_hessian(world_[0], by_square * error);
  dense_.topLeftCorner(size, size) +=
      by_square * world_[0].jacobian.transpose() * world_[0].jacobian -
      by_tip * slope * slope.transpose();
  Eigen::Index row = first_clear_;
  for (std::size_t p = 2; p < world_.size(); ++p) {
    for (const constraint::SmoothSurface& surface : problem_.surfaces) {
      const double weight = multipliers[row++];
      add_hessian(world_[p], weight * constraint::distance(surface, world_[p].value).normal);
      dense_.topLeftCorner(size, size) += weight * world_[p].jacobian.transpose() *
                                          distance_hessian(surface, world_[p].value) *
                                          world_[p].jacobian;
    }
  }
  for (const SparseEntry& entry : hessian_pattern_) *values++ = dense_(entry.row, entry.column);
}

}  // namespace sinew::plan
