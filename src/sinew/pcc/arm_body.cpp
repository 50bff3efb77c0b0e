#include "sinew/pcc/arm_body.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/pcc/arm_pose.hpp"
#include "sinew/pcc/arm_state.hpp"
#include "sinew/pcc/arm_step.hpp"

namespace sinew::pcc {

ArmBody::ArmBody(const ArmBodyModel& model, int histories)
    : model_(model),
      state_(std::make_unique<ArmState>(model.arm().coordinates(), model.own_rows(), histories)),
      pose_(std::make_unique<ArmPose>(model, *state_)),
      step_(std::make_unique<ArmStep>(model, *state_, *pose_)),
      rest_gravity_energy_(pose_->dynamics().gravity_energy()) {}

ArmBody::~ArmBody() = default;

const mechanics::BodyModel& ArmBody::model() const { return model_; }
Vector3 ArmBody::position(int point) const { return pose_->position(point); }
Vector3 ArmBody::velocity(int site) const { return pose_->velocity(site); }
const Points& ArmBody::positions() const { return pose_->skin(); }
const Points& ArmBody::velocities() const { return pose_->skin_velocities(); }

mechanics::Energies ArmBody::energies() {
  const ArmDynamics<double>& now = pose_->dynamics();
  return {now.strain_energy(), now.kinetic_energy(), now.gravity_energy() - rest_gravity_energy_};
}

void ArmBody::restart() {
  state_->restart();
  pose_->moved();
}

std::size_t ArmBody::state_size() const { return state_->size(); }
void ArmBody::save_state(std::span<double> state) const { state_->save(state); }

void ArmBody::load_state(std::span<const double> state) {
  state_->load(state);
  pose_->moved();
}

mechanics::StepSystem& ArmBody::system() { return *step_; }
const mechanics::StepSystem& ArmBody::system() const { return *step_; }

std::size_t ArmBody::bytes() const { return step_->bytes() + pose_->bytes(); }

Matrix3 ArmBody::rotation(int orientation) const { return pose_->rotation(orientation); }

double ArmBody::coordinate(int site) const { return state_->q[model_.attachment(site).coordinate]; }

const VectorX& ArmBody::coordinates() const { return state_->q; }
const VectorX& ArmBody::rates() const { return state_->rate; }

void ArmBody::set_coordinates(const VectorX& q, const VectorX& rate) {
  const Eigen::Index size = state_->q.size();
  if (q.size() != size || rate.size() != size) {
    throw Error(ErrorKind::wrong_shape, {.item = "body '" + model_.name() + "'"},
                fmt::format("{} coordinates and {} rates", q.size(), rate.size()),
                fmt::format("give {} of each", size));
  }
  restart();
  state_->q = q;
  state_->rate = rate;
}

}  // namespace sinew::pcc
