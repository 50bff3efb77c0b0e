#include "sinew/run/surroundings.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mechanics/rigid_base.hpp"
#include "sinew/model/model.hpp"
#include "sinew/world/bodies.hpp"

namespace sinew::run {

namespace {

mechanics::Body& body_of(const world::Bodies& bodies, int index) {
  return *bodies.all()[static_cast<std::size_t>(index)];
}

}  // namespace

Surroundings::Surroundings(const model::Model& model, world::Bodies& bodies)
    : model_(model), bodies_(bodies) {
  factors_.resize(model_.loads().size());
  applied_.resize(factors_.size());
  restart();
}

void Surroundings::set_factor(int load, model::Signal factor) {
  factors_.at(static_cast<std::size_t>(load)) = std::move(factor);
}

void Surroundings::move_bases(double time) {
  for (const model::BaseMotion& motion : model_.base_motions()) {
    mechanics::as<mechanics::HasBase>(body_of(bodies_, motion.body))
        ->move_base(mechanics::rigid_displacement(motion.translation_at(time),
                                                  motion.rotation_at(time), motion.centre));
  }
}

void Surroundings::put_bases(double time) {
  move_bases(time);
  for (const model::BaseMotion& motion : model_.base_motions()) {
    auto* rigid = mechanics::as<mechanics::HasRigidBase>(body_of(bodies_, motion.body));
    if (rigid != nullptr) rigid->follow_base();
  }
}

void Surroundings::set_base_rates(double time, model::Signal::Side side) {
  for (const model::BaseMotion& motion : model_.base_motions()) {
    mechanics::Body& body = body_of(bodies_, motion.body);
    auto* rigid = mechanics::as<mechanics::HasRigidBase>(body);
    if (rigid == nullptr) continue;
    const model::BaseMotion::Rate rate = motion.rate(time, side);
    const Vector3 centre = mechanics::as<mechanics::HasPose>(body)->centre_of_mass();
    rigid->set_base_rate(rate.at(centre), rate.angular);
  }
}

void Surroundings::move_base(int body, const Vector3& translation, const Vector3& rotation,
                             const Vector3& centre) {
  auto* base = mechanics::as<mechanics::HasBase>(body_of(bodies_, body));
  const std::string& name = model_.body(body).name();
  const Location place{.item = fmt::format("base of body '{}'", name)};
  if (std::ranges::any_of(model_.base_motions(),
                          [&](const model::BaseMotion& motion) { return motion.body == body; })) {
    throw Error(
        ErrorKind::bad_argument, place, "the scene moves this base",
        "leave `motion` out of the scene to move it from a script, or write the motion there "
        "as signals");
  }
  if (base == nullptr) {
    throw Error(ErrorKind::wrong_type, place, "this body has no base that can be moved",
                "name a finite-element body or a rigid body that is fixed");
  }
  if (!base->base_can_move()) {
    throw Error(ErrorKind::nothing_fixed, place, "the body has no fixed node to move",
                "fix the region that moves");
  }
  base->move_base(mechanics::rigid_displacement(translation, rotation, centre));
}

void Surroundings::apply(double time) {
  for (std::size_t k = 0; k < factors_.size(); ++k) apply(k, factors_[k].value(time));
}

void Surroundings::apply(std::size_t load, double factor) {
  applied_[load] = factor;
  const model::LoadModel& model = model_.loads()[load];
  for (const int number : model.numbers) {
    mechanics::as<mechanics::TakesLoads>(body_of(bodies_, model.body))
        ->set_load_factor(number, factor);
  }
}

void Surroundings::restart() {
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    factors_[k] = model_.loads()[k].factor;
    apply(k, 0.0);  // as in a state that is restored from before the first step
  }
}

}  // namespace sinew::run
