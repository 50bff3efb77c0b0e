#include "sinew/rigid/rigid_loads.hpp"

#include <Eigen/Geometry>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/linalg/positive_part.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/rigid/rigid_nodes.hpp"

namespace sinew::rigid {

namespace {

// A majorant of a symmetric matrix of 3 x 3 blocks, see fem::BodyLoads.
Matrix6 majorant(const Matrix6& symmetric) {
  const double coupling = symmetric.topRightCorner<3, 3>().norm();
  Matrix6 result = coupling * Matrix6::Identity();
  result.topLeftCorner<3, 3>() += linalg::positive_part(Matrix3(symmetric.topLeftCorner<3, 3>()));
  result.bottomRightCorner<3, 3>() +=
      linalg::positive_part(Matrix3(symmetric.bottomRightCorner<3, 3>()));
  return result;
}

}  // namespace

double RigidLoads::add(const mechanics::LinearisationRequest& request, VectorX& right,
                       MatrixX& matrix) {
  if (state_.model.load_count() == 0) return 0.0;
  evaluate(request);
  const double s = state_.model.turning_radius();
  const double size = resultant_.force.norm() + resultant_.moment.norm() / s;
  right.head<3>() += resultant_.force;
  right.tail<3>() += resultant_.moment / s;
  if (!request.iterating && request.tangent == mechanics::Tangent::exact) {
    matrix += stiffness_;
    return size;
  }
  const Matrix6 symmetric = symmetric_stiffness();
  matrix += request.tangent == mechanics::Tangent::exact ? symmetric : majorant(symmetric);
  return size;
}

// The moment that a translation changes is that of the potential of a liquid. The force that a
// rotation changes has quadrature errors where the surface of the liquid cuts faces, and is not
// symmetric to the former for a pressure that turns with the body.
Matrix6 RigidLoads::symmetric_stiffness() const {
  Matrix6 result = 0.5 * (stiffness_ + stiffness_.transpose());
  result.bottomLeftCorner<3, 3>() = stiffness_.bottomLeftCorner<3, 3>();
  result.topRightCorner<3, 3>() = stiffness_.bottomLeftCorner<3, 3>().transpose();
  return result;
}

// A pressure on an open surface of a body turns with it and has no potential: whether a body that
// joints alone hold is stable under it cannot be told body by body.
void RigidLoads::refuse_open_pressure() const {
  const RigidBodyModel& model = state_.model;
  for (const int load : model.face_load_numbers()) {
    if (state_.load_factors[static_cast<std::size_t>(load)] != 0.0 && model.is_open(load)) {
      throw Error(ErrorKind::surface_not_closed, {.item = "body '" + model.name() + "'"},
                  "a pressure on an open part of the surface of a rigid body turns with it and has "
                  "no potential, so equilibria under it are not searched for",
                  "give a traction, which keeps its direction, or choose a dynamic integrator");
    }
  }
}

void RigidLoads::evaluate(const mechanics::LinearisationRequest& request) {
  const RigidBodyModel& model = state_.model;
  steady_ = turning_ = drag_ = {};
  stiffness_.setZero();
  for (std::size_t k = 0; k < model.load_count(); ++k) {
    const auto& [force, arm] = model.point_forces()[k];
    steady_.add(state_.load_factors[k] * force, state_.pose.rotation * arm);
  }
  if (model.face_loads() != nullptr) evaluate_faces(request);
  const double s = model.turning_radius();
  const Sum kept = steady_ + drag_;
  resultant_ = {kept.force + turning_.force, kept.moment() + turning_.moment()};
  // sum [f] [r] = sum r f^T - (r . f) 1
  const Matrix3 levers = kept.dyads - kept.dyads.trace() * Matrix3::Identity();
  stiffness_.bottomRightCorner<3, 3>() += (cross_matrix(turning_.moment()) - levers) / (s * s);
  stiffness_.topRightCorner<3, 3>() += cross_matrix(turning_.force) / s;
}

Vector3 RigidLoads::rate_at(const Vector6& rate, const Vector3& arm) const {
  return rate.head<3>() + rate.tail<3>().cross(arm) / state_.model.turning_radius();
}

void RigidLoads::find_rates(const mechanics::LinearisationRequest& request) {
  const Vector6 now = state_.combine(request.weights.velocity);
  const Vector6 about = request.iterating ? now : state_.rate;
  const Vector6 acceleration = state_.combine(request.weights.acceleration);
  const Vector3 spin = now.tail<3>() / state_.model.turning_radius();
  for (Eigen::Index i = 0; i < positions_.rows(); ++i) {
    const Vector3 arm = positions_.row(i).transpose() - state_.pose.centre;
    rates_.row(i) = rate_at(about, arm).transpose();
    gaps_.row(i) = rate_at(now - about, arm).transpose();
    accelerations_.row(i) = (rate_at(acceleration, arm) + spin.cross(spin.cross(arm))).transpose();
  }
}

void RigidLoads::evaluate_faces(const mechanics::LinearisationRequest& request) {
  const RigidBodyModel& model = state_.model;
  const mechanics::LoadSet& loads = *model.face_loads();
  const Points& rest = model.load_mesh().nodes;
  place_nodes(model, rest, state_.pose, positions_);
  for (Points* of_nodes : {&rates_, &gaps_, &accelerations_}) of_nodes->setZero(rest.rows(), 3);
  const auto& weights = request.weights;
  if (!weights.dynamic()) refuse_open_pressure();
  if (loads.moves() && weights.dynamic()) find_rates(request);
  factors_.clear();
  for (const int load : model.face_load_numbers()) {
    factors_.push_back(state_.load_factors[static_cast<std::size_t>(load)]);
  }
  loads.visit_points({positions_, rates_, gaps_, accelerations_, weights.velocity.motion,
                      weights.acceleration.motion},
                     factors_, [&](const mechanics::PointAction& action) {
                       const Vector3 arm = action.at - state_.pose.centre;
                       turning_.add(action.turning, arm);
                       steady_.add(action.steady, arm);
                       drag_.add(action.drag, arm);
                       add_slope(action.slope, arm);
                     });
}

// J^T slope J
void RigidLoads::add_slope(const Matrix3& slope, const Vector3& arm) {
  const Matrix3 lever = cross_matrix(arm) / state_.model.turning_radius();
  const Matrix3 by_turn = -slope * lever;
  stiffness_.topLeftCorner<3, 3>() += slope;
  stiffness_.topRightCorner<3, 3>() += by_turn;
  stiffness_.bottomLeftCorner<3, 3>() += lever * slope;
  stiffness_.bottomRightCorner<3, 3>() += lever * by_turn;
}

void RigidLoads::count_work(const mechanics::StepWeights& weights, mechanics::StepEnd& end) {
  const RigidBodyModel& model = state_.model;
  if (model.load_count() == 0) return;
  mechanics::LinearisationRequest request;
  request.weights = weights;
  request.iterating = true;
  evaluate(request);
  // A point at r moves by d + (1 - B) r, with B the rotation back to the start.
  const Matrix3 turn =
      Matrix3::Identity() -
      (state_.start.rotation * state_.pose.rotation.conjugate()).toRotationMatrix();
  const Vector3 moved = state_.pose.centre - state_.start.centre;
  const auto work = [&](const Sum& sum) {
    return sum.force.dot(moved) + (turn * sum.dyads).trace();
  };
  end.external_work += work(steady_ + turning_);
  end.damped -= work(drag_);
  if (!weights.dynamic()) return;
  const Vector6 rate = state_.combine(weights.velocity);
  const auto power = [&](const Sum& sum) {
    return sum.force.dot(rate.head<3>()) +
           sum.moment().dot(rate.tail<3>()) / model.turning_radius();
  };
  end.power += power(steady_ + turning_);
  end.damping -= power(drag_);
}

std::size_t RigidLoads::bytes() const {
  Eigen::Index numbers = 0;
  for (const Points* of_nodes : {&positions_, &rates_, &gaps_, &accelerations_}) {
    numbers += of_nodes->size();
  }
  return sizeof(double) * static_cast<std::size_t>(numbers);
}

}  // namespace sinew::rigid
