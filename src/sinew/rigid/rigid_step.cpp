#include "sinew/rigid/rigid_step.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sinew/core/rotation.hpp"
#include "sinew/linalg/positive_part.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/rigid/rigid_nodes.hpp"

namespace sinew::rigid {

namespace {

// Lower bound of the force scale of residuals: an acceleration of this many body radii per second
// squared.
constexpr double kMinAcceleration = 1e-6;

}  // namespace

RigidStep::RigidStep(RigidState& state)
    : DenseStep(state.model.is_free() ? 6 : 0, state.model.own_rows(), state.memory),
      state_(state),
      loads_(state),
      from_(state.pose) {}

void RigidStep::begin_step() {
  begin_query();
  state_.follow_base();
}

void RigidStep::begin_query() {
  state_.start = state_.pose;
  forget_surface_rows();
}

double RigidStep::form(const mechanics::LinearisationRequest& request, VectorX& right,
                       MatrixX& matrix) {
  const RigidBodyModel& model = state_.model;
  if (!model.is_free()) return 1.0;
  const Vector3 weight = model.mass() * model.settings().gravity;
  right.setZero();
  right.head<3>() = weight;
  matrix.setZero();
  if (request.weights.dynamic()) add_inertia(request.weights, right, matrix);
  const double loads = loads_.add(request, right, matrix);
  const double least = kMinAcceleration * model.mass() * model.turning_radius();
  return least + loads + weight.norm() + (right.head<3>() - weight).norm() + right.tail<3>().norm();
}

void RigidStep::add_inertia(const mechanics::StepWeights& weights, VectorX& right,
                            MatrixX& matrix) const {
  const RigidBodyModel& model = state_.model;
  const double s = model.turning_radius();
  const Vector6 rate = state_.combine(weights.velocity);
  const Vector6 acceleration = state_.combine(weights.acceleration);
  const Matrix3 turned = state_.pose.rotation.toRotationMatrix();
  const Matrix3 inertia = turned * model.inertia() * turned.transpose();
  const Vector3 omega = rate.tail<3>() / s, alpha = acceleration.tail<3>() / s;
  const Vector3 momentum = inertia * omega, pushed = inertia * alpha;
  right.head<3>() -= model.mass() * acceleration.head<3>();
  right.tail<3>() -= (pushed + omega.cross(momentum)) / s;

  matrix.topLeftCorner<3, 3>().diagonal().setConstant(model.mass() * weights.acceleration.motion);
  const Matrix3 turning = rotation_vector_rate(state_.motion().tail<3>() / s);
  const Matrix3 spin = cross_matrix(omega), carried = inertia * spin - cross_matrix(momentum);
  const Matrix3 by_pose = inertia * cross_matrix(alpha) - cross_matrix(pushed) + spin * carried;
  const Matrix3 by_turn = weights.acceleration.motion * inertia +
                          weights.velocity.motion * (spin * inertia - cross_matrix(momentum));
  matrix.bottomRightCorner<3, 3>() = (by_turn * turning + by_pose) / (s * s);
}

// Lever from the centre of mass at rest, m.
Vector3 RigidStep::arm_of(const mechanics::Patch& patch) const {
  return patch.mean(state_.model.rest_surface_nodes()) - state_.model.centre();
}

// A force f at r = R r_0 has the moment r x f, which changes by (w x r) x f = [f] [r] w. A moment
// keeps its axis.
//
// The derivative of the moment M of a potential with respect to rotation is symmetric except for
// [M]/2 (Simo, Comput. Methods Appl. Mech. Eng. 96, 1992, 189). These halves of all forces, moments
// and the inertia sum to that of the residual, which vanishes; those of the moments themselves are
// not in A. The remaining skew parts would only slow the iteration, since W takes symmetric parts
// (add_compliance): a bracket of a gram under newtons took tens of iterations. A single
// linearisation keeps the exact derivative, on which its order depends. So does a body without
// loads, for its gyroscopic moment.
//
// A body that is squeezed between others has a negative stiffness -f r against turning, which
// friction outweighs: but a law of friction needs A > 0 without its own rows.
void RigidStep::add_row_stiffness(MatrixX& matrix) {
  const RigidBodyModel& model = state_.model;
  if (!model.is_free()) return;
  const double square = model.turning_radius() * model.turning_radius();
  const auto turned = [&](const Vector3& force, const Vector3& arm) -> Matrix3 {
    return cross_matrix(force) * cross_matrix(state_.pose.rotation * arm) / square;
  };
  auto block = matrix.bottomRightCorner<3, 3>();
  const auto& entries = model.own_rows().entries;
  bool loaded = false;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const double effort = state_.memory.effort[entries[e].row];
    loaded = loaded || effort != 0.0;
    const auto& site = model.attachment(entries[e].site);
    if (effort == 0.0 || site.kind == RigidBodyModel::Attachment::Kind::orientation) continue;
    block -= turned(effort * state_.memory.directions[e], site.arm);
  }
  Matrix3 pressed = Matrix3::Zero();
  for (const SurfaceRow& row : surface_rows()) {
    loaded = loaded || row.effort != 0.0;
    if (row.effort != 0.0) pressed -= turned(row.effort * row.direction, arm_of(row.patch));
  }
  if (projected()) {
    const Matrix3 symmetric = 0.5 * (pressed + pressed.transpose());
    pressed = linalg::positive_part(symmetric);
  }
  block += pressed;
  if (loaded && iterating()) block = (0.5 * (block + block.transpose())).eval();
}

void RigidStep::site_jacobian(int site, MatrixX& result) const {
  const RigidBodyModel& model = state_.model;
  if (!model.is_free()) return;
  const auto& at = model.attachment(site);
  const double s = model.turning_radius();
  if (at.kind == RigidBodyModel::Attachment::Kind::orientation) {
    result << Matrix3::Zero(), Matrix3::Identity() / s;
  } else {
    result << Matrix3::Identity(), -cross_matrix(state_.pose.rotation * at.arm) / s;
  }
}

void RigidStep::patch_jacobian(const mechanics::Patch& patch, MatrixX& result) const {
  if (!state_.model.is_free()) return;
  result << Matrix3::Identity(),
      -cross_matrix(state_.pose.rotation * arm_of(patch)) / state_.model.turning_radius();
}

void RigidStep::add_proposed_motion(Points& nodes) const {
  if (size() == 0) return;
  const Vector3 turn = motion().tail<3>() / state_.model.turning_radius();
  place_nodes(state_.model, state_.model.rest_surface_nodes(),
              from_.moved(motion().head<3>(), turn), nodes);
}

mechanics::Wrench RigidStep::unbalanced(std::span<const double> effort, const Vector3& about) {
  if (size() == 0) return {};
  Vector6 left;
  residual(effort, {left.data(), 6});
  const Vector3 force = left.head<3>();
  return {force, left.tail<3>() * state_.model.turning_radius() +
                     (state_.pose.centre - about).cross(force)};
}

// Positions are accurate to eps |x|, and rotations to eps.
double RigidStep::rounding_floor() const {
  if (size() == 0) return 0.0;
  const double at =
      std::max(state_.pose.centre.cwiseAbs().maxCoeff(), state_.model.turning_radius());
  return kEpsilon * at * matrix().cwiseAbs().rowwise().sum().norm();
}

double RigidStep::proposed_move() const {
  return size() == 0 ? 0.0 : motion().cwiseAbs().maxCoeff();
}

mechanics::MotionReport RigidStep::apply_motion(double scale) {
  if (size() == 0) return {};
  const Vector6 moved = scale * motion();
  state_.pose = from_.moved(moved.head<3>(), moved.tail<3>() / state_.model.turning_radius());
  mechanics::MotionReport report;
  report.largest_move = moved.cwiseAbs().maxCoeff();
  report.finite = moved.allFinite() && state_.pose.centre.allFinite();
  return report;
}

void RigidStep::find_acceleration(const mechanics::StepWeights& weights,
                                  std::span<double> acceleration) {
  if (size() == 0) return;
  Eigen::Map<Vector6>(acceleration.data()) = state_.combine(weights.acceleration);
}

void RigidStep::apply_mass(std::span<const double> motion, std::span<double> result) {
  if (size() == 0) return;
  const RigidBodyModel& model = state_.model;
  const Matrix3 turned = state_.pose.rotation.toRotationMatrix();
  const Eigen::Map<const Vector6> from(motion.data());
  Eigen::Map<Vector6> to(result.data());
  to.head<3>() = model.mass() * from.head<3>();
  to.tail<3>() = turned * model.inertia() * turned.transpose() * from.tail<3>() /
                 (model.turning_radius() * model.turning_radius());
}

mechanics::StepEnd RigidStep::end_step(const mechanics::StepWeights& weights) {
  using Jump = mechanics::StepWeights::Jump;
  mechanics::StepEnd end;
  end.moved_from_outside = size() == 0 && !(state_.motion().isZero(0.0) && state_.rate.isZero(0.0));
  if (size() > 0) loads_.count_work(weights, end);
  if (!weights.dynamic()) {
    state_.rate.setZero();
    for (Vector6& kept : state_.history) kept.setZero();
    return end;
  }
  const Vector6 rate = state_.combine(weights.velocity);
  const auto size_of = [](const Vector6& jump) { return jump.cwiseAbs().maxCoeff(); };
  double jump = 0.0;
  if (weights.error_of == Jump::velocity) jump = size_of(rate - state_.rate);
  if (!state_.history.empty()) {
    const Vector6 first = state_.combine(weights.first), second = state_.combine(weights.second);
    if (weights.error_of == Jump::first) jump = size_of(first - state_.history[0]);
    if (weights.error_of == Jump::acceleration) {
      const Vector6 before = (state_.rate - state_.history[1]) / weights.step_before;
      jump = size_of(state_.combine(weights.acceleration) - before);
    }
    state_.history[0] = first;
    state_.history[1] = second;
  }
  state_.rate = rate;
  if (size() == 0) return end;  // its motion is prescribed
  end.error = weights.error_jump * jump;
  return end;
}

void RigidStep::scale_motion(double factor) {
  if (size() == 0) return;
  const Vector6 moved = factor * state_.motion();
  state_.pose =
      state_.start.moved(moved.head<3>(), moved.tail<3>() / state_.model.turning_radius());
}

void RigidStep::add_velocity(std::span<const double> change) {
  if (size() > 0) state_.rate += Eigen::Map<const Vector6>(change.data());
}

}  // namespace sinew::rigid
