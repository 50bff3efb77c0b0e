#include "sinew/model/model_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "sinew/constraint/constraint.hpp"
#include "sinew/mechanics/bears_loads.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::model {

namespace {

constexpr std::size_t kNamedDifferences = 4;

// Adds a constraint, and the sites of the bodies on which its rows act.
void add_constraint(ValueHash& hash, const ModelData& data, int index) {
  const constraint::Constraint& constraint = data.constraint(index);
  constraint.add_to(hash);
  const mechanics::RowPattern& rows = data.rows;
  const auto first = static_cast<std::size_t>(constraint.first_row());
  const auto last = first + static_cast<std::size_t>(constraint.row_count());
  for (auto e = rows.row_start[first]; e < rows.row_start[last]; ++e) {
    const mechanics::Site& site = rows.site[static_cast<std::size_t>(e)];
    hash.add(site.body, data.body(site.body).site_hash(site.number));
  }
}

void add_limits(ValueHash& hash, const Limits& limits) {
  hash.add(limits.min, limits.max, limits.rate);
}

void add_motion(ValueHash& hash, const BaseMotion& motion) {
  hash.add(motion.translation, motion.angle, motion.axis, motion.centre);
}

std::uint64_t actuator_hash(const ModelData& data, std::size_t index) {
  const ActuatorModel& actuator = data.actuators[index];
  ValueHash hash;
  const ActuatorKind& kind = *actuator.kind;
  kind.number >= 0 ? hash.add(static_cast<std::uint64_t>(kind.number))
                   : hash.add(std::string(kind.word));
  hash.add(actuator.motion_scale, actuator.drive != nullptr);
  add_limits(hash, actuator.effort_limits(CommandKind::motion));
  add_limits(hash, actuator.motion);
  if (actuator.vacuum && *actuator.vacuum != -kAtmosphere) hash.add(*actuator.vacuum);
  if (actuator.drive != nullptr) actuator.drive->add_to(hash);
  add_constraint(hash, data, actuator.constraint);
  for (const GuideModel& guide : data.guides) {
    if (guide.actuator == static_cast<int>(index)) hash.add(guide.via, guide.friction);
  }
  return hash.value();
}

std::uint64_t load_hash(const ModelData& data, const LoadModel& load) {
  ValueHash hash;
  const auto* body = mechanics::as<const mechanics::BearsLoads>(data.body(load.body));
  for (const int number : load.numbers) hash.add(load.body, body->load_hash(number));
  return hash.value();
}

std::uint64_t contact_hash(const ModelData& data, const ContactModel& contact) {
  ValueHash hash;
  add_constraint(hash, data, contact.constraint);
  if (contact.motion) add_motion(hash, *contact.motion);
  if (contact.strikes) hash.add(contact.restitution);
  if (contact.aggregate > 0.0) hash.add(contact.aggregate);
  return hash.value();
}

std::uint64_t constraint_hash(const ModelData& data, int index) {
  ValueHash hash;
  add_constraint(hash, data, index);
  return hash.value();
}

std::uint64_t joint_hash(const ModelData& data, const JointModel& joint) {
  ValueHash hash;
  add_constraint(hash, data, joint.constraint);
  for (const Limits& limits : joint.limits) {
    if (std::isfinite(limits.min) || std::isfinite(limits.max)) add_limits(hash, limits);
  }
  if (joint.friction > 0.0) hash.add(joint.friction);
  return hash.value();
}

std::uint64_t motion_hash(const BaseMotion& motion) {
  ValueHash hash;
  add_motion(hash, motion);
  return hash.value();
}

}  // namespace

std::vector<NamedHash> list_parts(const ModelData& data) {
  const StepSettings& step = data.step;
  const bool alpha = step.integrator == mechanics::Integrator::generalized_alpha;
  std::vector<NamedHash> parts{
      {"time step", ValueHash().add(step.time_step).value()},
      {"integrator", ValueHash().add(step.integrator, alpha ? step.spectral_radius : 0.0).value()}};
  const auto add = [&](const char* kind, const std::string& name, std::uint64_t hash) {
    parts.push_back({fmt::format("{} '{}'", kind, name), hash});
  };
  for (const auto& body : data.bodies) {
    for (const NamedHash& part : body->parts()) {
      parts.push_back({fmt::format("body '{}': {}", body->name(), part.name), part.hash});
    }
  }
  for (std::size_t i = 0; i < data.actuators.size(); ++i) {
    add("actuator", data.actuators[i].name, actuator_hash(data, i));
  }
  for (const LoadModel& load : data.loads) add("load", load.name, load_hash(data, load));
  for (const ContactModel& contact : data.contacts) {
    add("contact", contact.name, contact_hash(data, contact));
  }
  for (const JointModel& joint : data.joints) add("joint", joint.name, joint_hash(data, joint));
  for (const BaseMotion& motion : data.base_motions) {
    parts.push_back({fmt::format("body '{}': motion of the base", data.body(motion.body).name()),
                     motion_hash(motion)});
  }
  for (const EffectorModel& effector : data.effectors) {
    add("effector", effector.name, constraint_hash(data, effector.constraint));
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

}  // namespace sinew::model
