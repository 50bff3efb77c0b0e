#include "sinew/sim/model_parts.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::sim {

namespace {

constexpr std::size_t kNamedDifferences = 4;

// What a constraint is, and which points of which bodies its rows touch.
void add_constraint(ValueHash& hash, const Model& model, int index) {
  const auto& constraint = *model.constraints()[static_cast<std::size_t>(index)];
  constraint.add_to(hash);
  const mechanics::RowPattern& rows = model.rows();
  const auto first = static_cast<std::size_t>(constraint.first_row());
  const auto last = first + static_cast<std::size_t>(constraint.row_count());
  for (auto e = rows.row_start[first]; e < rows.row_start[last]; ++e) {
    const mechanics::MaterialPoint& point = rows.point[static_cast<std::size_t>(e)];
    hash.add(point.body,
             model.bodies()[static_cast<std::size_t>(point.body)]->point_hash(point.point));
  }
}

void add_limits(ValueHash& hash, const Limits& limits) {
  hash.add(limits.min, limits.max, limits.rate);
}

void add_motion(ValueHash& hash, const BaseMotion& motion) {
  hash.add(motion.translation, motion.angle, motion.axis, motion.centre);
}

}  // namespace

std::vector<NamedHash> list_parts(const Model& model) {
  const StepSettings& step = model.step();
  const bool alpha = step.integrator == mechanics::Integrator::generalized_alpha;
  std::vector<NamedHash> parts{
      {"time step", ValueHash().add(step.time_step).value()},
      {"integrator", ValueHash().add(step.integrator, alpha ? step.spectral_radius : 0.0).value()}};
  for (const auto& body : model.bodies()) {
    for (NamedHash& part : body->parts()) {
      parts.push_back({fmt::format("body '{}': {}", body->name(), part.name), part.hash});
    }
  }
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const ActuatorModel& actuator = model.actuators()[i];
    ValueHash hash;
    hash.add(actuator.type, actuator.motion_scale, actuator.drive != nullptr);
    add_limits(hash, actuator.effort);
    add_limits(hash, actuator.motion);
    if (actuator.drive != nullptr) actuator.drive->add_to(hash);
    add_constraint(hash, model, actuator.constraint);
    for (const GuideModel& guide : model.guides()) {
      if (guide.actuator == static_cast<int>(i)) hash.add(guide.via, guide.friction);
    }
    parts.push_back({fmt::format("actuator '{}'", actuator.name), hash.value()});
  }
  for (const LoadModel& load : model.loads()) {
    ValueHash hash;
    const auto& body = *model.bodies()[static_cast<std::size_t>(load.body)];
    const auto* fem = dynamic_cast<const fem::FemBodyModel*>(&body);
    for (const int number : load.numbers) hash.add(load.body, fem->load_hash(number));
    parts.push_back({fmt::format("load '{}'", load.name), hash.value()});
  }
  for (const ContactModel& contact : model.contacts()) {
    ValueHash hash;
    add_constraint(hash, model, contact.constraint);
    if (contact.motion) add_motion(hash, *contact.motion);
    parts.push_back({fmt::format("contact '{}'", contact.name), hash.value()});
  }
  for (const WeldModel& weld : model.welds()) {
    ValueHash hash;
    add_constraint(hash, model, weld.constraint);
    parts.push_back({fmt::format("joint '{}'", weld.name), hash.value()});
  }
  for (const BaseMotion& motion : model.base_motions()) {
    ValueHash hash;
    add_motion(hash, motion);
    const auto& body = *model.bodies()[static_cast<std::size_t>(motion.body)];
    parts.push_back({fmt::format("body '{}': motion of the base", body.name()), hash.value()});
  }
  for (const EffectorModel& effector : model.effectors()) {
    ValueHash hash;
    add_constraint(hash, model, effector.constraint);
    parts.push_back({fmt::format("effector '{}'", effector.name), hash.value()});
  }
  return parts;
}

std::string describe_difference(const std::vector<NamedHash>& saved,
                                const std::vector<NamedHash>& present) {
  const auto by_name = [](const std::vector<NamedHash>& parts, const std::string& name) {
    return std::ranges::find(parts, name, &NamedHash::name);
  };
  std::vector<std::string> differences;
  for (const NamedHash& part : saved) {
    const auto here = by_name(present, part.name);
    if (here == present.end()) differences.push_back(part.name + " (not in this robot)");
    if (here != present.end() && here->hash != part.hash) differences.push_back(part.name);
  }
  for (const NamedHash& part : present) {
    if (by_name(saved, part.name) == saved.end()) {
      differences.push_back(part.name + " (not in the saved one)");
    }
  }
  if (differences.empty()) return "the order of bodies, actuators or effectors";
  const std::size_t named = std::min(kNamedDifferences, differences.size());
  std::string text =
      fmt::format("{}", fmt::join(differences.begin(),
                                  differences.begin() + static_cast<std::ptrdiff_t>(named), ", "));
  if (named < differences.size()) text += fmt::format(" and {} more", differences.size() - named);
  return text;
}

}  // namespace sinew::sim
