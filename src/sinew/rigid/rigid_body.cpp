#include "sinew/rigid/rigid_body.hpp"

#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/rigid/rigid_nodes.hpp"
#include "sinew/rigid/rigid_state.hpp"
#include "sinew/rigid/rigid_step.hpp"

namespace sinew::rigid {

RigidBody::RigidBody(const RigidBodyModel& model, int histories)
    : model_(model),
      state_(std::make_unique<RigidState>(model, histories)),
      step_(std::make_unique<RigidStep>(*state_)),
      skin_(std::make_unique<RigidNodes>(*state_, model.mesh().nodes)),
      surface_(std::make_unique<RigidNodes>(*state_, model.rest_surface_nodes())) {}

RigidBody::~RigidBody() = default;

const mechanics::BodyModel& RigidBody::model() const { return model_; }

Vector3 RigidBody::position(int point) const {
  return state_->pose.centre + state_->pose.rotation * model_.attachment(point).arm;
}

Vector3 RigidBody::velocity(int site) const {
  const auto& at = model_.attachment(site);
  if (at.kind == RigidBodyModel::Attachment::Kind::orientation) return angular_velocity();
  return linear_velocity() + angular_velocity().cross(state_->pose.rotation * at.arm);
}

const Points& RigidBody::positions() const { return skin_->positions(); }
const Points& RigidBody::velocities() const { return skin_->velocities(); }
const Points& RigidBody::surface_nodes() const { return surface_->positions(); }
const Points& RigidBody::surface_node_velocities() const { return surface_->velocities(); }

// What moves a fixed body also provides its energy.
mechanics::Energies RigidBody::energies() {
  if (model_.has_base()) return {};
  const Matrix3 turn = state_->pose.rotation.toRotationMatrix();
  const Vector3 spin = turn.transpose() * angular_velocity();
  const Vector3 fallen = state_->pose.centre - model_.centre();
  mechanics::Energies energies;
  energies.kinetic =
      0.5 * (model_.mass() * linear_velocity().squaredNorm() + spin.dot(model_.inertia() * spin));
  energies.gravity = -model_.mass() * model_.settings().gravity.dot(fallen);
  return energies;
}

void RigidBody::restart() { state_->restart(); }
std::size_t RigidBody::state_size() const { return state_->size(); }
void RigidBody::save_state(std::span<double> state) const { state_->save(state); }
void RigidBody::load_state(std::span<const double> state) { state_->load(state); }
mechanics::StepSystem& RigidBody::system() { return *step_; }
const mechanics::StepSystem& RigidBody::system() const { return *step_; }

std::size_t RigidBody::bytes() const {
  return step_->bytes() + sizeof(double) * state_->size() + skin_->bytes() + surface_->bytes();
}

bool RigidBody::base_can_move() const { return model_.has_base(); }

void RigidBody::move_base(const std::optional<mechanics::AffineField>& displacement) {
  state_->asked = displacement;
}

const std::optional<mechanics::AffineField>& RigidBody::base_input() const { return state_->asked; }

bool RigidBody::base_moved() const {
  return model_.has_base() && !(state_->motion().isZero(0.0) && state_->rate.isZero(0.0));
}

mechanics::HasBase::Carried RigidBody::carried(int site, const mechanics::Patch* patch) const {
  const auto& at = model_.attachment(site);
  if (patch == nullptr && at.kind == RigidBodyModel::Attachment::Kind::orientation) {
    return {state_->motion().tail<3>() / model_.turning_radius(), angular_velocity()};
  }
  const Vector3 arm = patch == nullptr
                          ? at.arm
                          : Vector3(patch->mean(model_.rest_surface_nodes()) - model_.centre());
  const RigidPose &now = state_->pose, &start = state_->start;
  const Vector3 lever = now.rotation * arm;
  return {now.centre + lever - start.centre - start.rotation * arm,
          linear_velocity() + angular_velocity().cross(lever)};
}

void RigidBody::follow_base() { state_->follow_base(); }

void RigidBody::set_base_rate(const Vector3& linear, const Vector3& angular) {
  if (model_.has_base()) state_->rate << linear, model_.turning_radius() * angular;
}

void RigidBody::set_load_factor(int load, double factor) {
  state_->load_factors[static_cast<std::size_t>(load)] = factor;
}

Vector3 RigidBody::load_force() const { return step_->loads().force; }
Vector3 RigidBody::load_moment() const { return step_->loads().moment; }

Matrix3 RigidBody::rotation(int) const { return state_->pose.rotation.toRotationMatrix(); }

Vector3 RigidBody::origin() const {
  return state_->pose.centre +
         state_->pose.rotation * (model_.settings().position - model_.centre());
}

Vector3 RigidBody::centre_of_mass() const { return state_->pose.centre; }
Matrix3 RigidBody::axes() const { return rotation(0) * model_.settings().rotation; }
Vector3 RigidBody::linear_velocity() const { return state_->rate.head<3>(); }

void RigidBody::put_pose(const Vector3& origin, const Eigen::Quaterniond& axes,
                         std::span<double> state) const {
  RigidState shown(model_, static_cast<int>(state_->history.size()));
  const RigidSettings& rest = model_.settings();
  shown.pose.rotation = axes * Eigen::Quaterniond(rest.rotation).conjugate();
  shown.pose.rotation.normalize();
  shown.pose.centre = origin - shown.pose.rotation * (rest.position - model_.centre());
  shown.rate.setZero();
  shown.save(state);
}

Vector3 RigidBody::angular_velocity() const {
  return state_->rate.tail<3>() / model_.turning_radius();
}

}  // namespace sinew::rigid
