#include "sinew/model/model_parts.hpp"

#include <algorithm>
#include <array>
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

// Visits a constraint, and the sites of the bodies on which its rows act.
void visit_constraint(PartVisitor& visitor, const ModelData& data, int index) {
  const constraint::Constraint& constraint = data.constraint(index);
  constraint.describe(visitor);
  const mechanics::RowPattern& rows = data.rows;
  const auto first = static_cast<std::size_t>(constraint.first_row());
  const auto last = first + static_cast<std::size_t>(constraint.row_count());
  for (auto e = rows.row_start[first]; e < rows.row_start[last]; ++e) {
    const mechanics::Site& site = rows.site[static_cast<std::size_t>(e)];
    visitor.add(site.body, data.body(site.body).site_hash(site.number));
  }
}

// Hashes all limits, and lists those that limit.
void visit_limits(PartVisitor& visitor, const Limits& limits, const QuantityName& of,
                  const std::string& path) {
  visitor.add(limits.min, limits.max, limits.rate);
  const std::string unit = of.unit;
  const auto list = [&](const char* name, double value, const std::string& in) {
    if (std::isfinite(value)) visitor.list(fmt::format("{}.{}", path, name), in, value);
  };
  list("min", limits.min, unit);
  list("max", limits.max, unit);
  list("rate", limits.rate, unit + "/s");
}

void visit_motion(PartVisitor& visitor, const BaseMotion& motion) {
  visitor.add(motion.translation, motion.angle, motion.axis, motion.centre);
}

void visit_actuator(PartVisitor& visitor, const ModelData& data, std::size_t index) {
  const ActuatorModel& actuator = data.actuators[index];
  const ActuatorKind& kind = *actuator.kind;
  kind.number >= 0 ? visitor.add(static_cast<std::uint64_t>(kind.number))
                   : visitor.add(std::string(kind.word));
  visitor.add(actuator.motion_scale, actuator.drive != nullptr);
  visit_limits(visitor, actuator.effort_limits(CommandKind::motion), kind.effort,
               fmt::format("limits.{}", kind.effort.name));
  visit_limits(visitor, actuator.motion, kind.motion, fmt::format("limits.{}", kind.motion.name));
  if (actuator.vacuum && *actuator.vacuum != -kAtmosphere) visitor.add(*actuator.vacuum);
  if (actuator.vacuum && actuator.drive == nullptr) {
    visitor.list("ambient_pressure", "Pa", -*actuator.vacuum);
  }
  if (actuator.drive != nullptr) actuator.drive->describe(visitor);
  visit_constraint(visitor, data, actuator.constraint);
  bool listed = false;  // all guides of a cable have the same friction
  for (const GuideModel& guide : data.guides) {
    if (guide.actuator != static_cast<int>(index)) continue;
    visitor.add(guide.via, guide.friction);
    if (!listed) visitor.list("friction", "", guide.friction);
    listed = true;
  }
}

void visit_load(PartVisitor& visitor, const ModelData& data, const LoadModel& load) {
  const auto* body = mechanics::as<const mechanics::BearsLoads>(data.body(load.body));
  for (const int number : load.numbers) {
    PartVisitor own = visitor.same();
    body->describe_load(number, own);
    visitor.add(load.body, own.hash());
  }
}

void visit_contact(PartVisitor& visitor, const ModelData& data, const ContactModel& contact) {
  visit_constraint(visitor, data, contact.constraint);
  if (contact.motion) visit_motion(visitor, *contact.motion);
  if (contact.strikes) visitor.number("restitution", "", contact.restitution);
  if (contact.aggregate > 0.0) visitor.number("aggregate", "m", contact.aggregate);
}

void visit_joint(PartVisitor& visitor, const ModelData& data, const JointModel& joint) {
  constexpr std::array<QuantityName, 2> kMotions{{{"angle", "rad"}, {"displacement", "m"}}};
  visit_constraint(visitor, data, joint.constraint);
  for (std::size_t k = 0; k < joint.limits.size(); ++k) {
    const Limits& limits = joint.limits[k];
    if (!std::isfinite(limits.min) && !std::isfinite(limits.max)) continue;
    visit_limits(visitor, limits, kMotions[k], fmt::format("limits.{}", kMotions[k].name));
  }
  if (joint.friction > 0.0) {
    visitor.number("friction", joint.motions[0] >= 0 ? "N m" : "N", joint.friction);
  }
}

void visit_parts(const ModelData& data, PartsVisitor& parts) {
  const StepSettings& step = data.step;
  const bool alpha = step.integrator == mechanics::Integrator::generalized_alpha;
  parts.part("time step").number("time_step", "s", step.time_step);
  parts.part("integrator").add(step.integrator, alpha ? step.spectral_radius : 0.0);
  for (const auto& body : data.bodies) {
    parts.enter(fmt::format("body '{}': ", body->name()), fmt::format("bodies.{}", body->name()));
    body->describe(parts);
  }
  parts.enter({}, {});
  const auto part = [&](const char* kind, const char* section, const std::string& name) -> auto& {
    return parts.part(fmt::format("{} '{}'", kind, name), fmt::format("{}.{}", section, name));
  };
  for (std::size_t i = 0; i < data.actuators.size(); ++i) {
    visit_actuator(part("actuator", "actuators", data.actuators[i].name), data, i);
  }
  for (const LoadModel& load : data.loads) {
    visit_load(part("load", "loads", load.name), data, load);
  }
  for (const ContactModel& contact : data.contacts) {
    visit_contact(part("contact", "contacts", contact.name), data, contact);
  }
  for (const JointModel& joint : data.joints) {
    visit_joint(part("joint", "joints", joint.name), data, joint);
  }
  for (const BaseMotion& motion : data.base_motions) {
    const std::string& name = data.body(motion.body).name();
    visit_motion(parts.part(fmt::format("body '{}': motion of the base", name)), motion);
  }
  for (const EffectorModel& effector : data.effectors) {
    visit_constraint(part("effector", "effectors", effector.name), data, effector.constraint);
  }
}

}  // namespace

std::vector<NamedHash> list_parts(const ModelData& data) {
  PartsVisitor parts;
  visit_parts(data, parts);
  return parts.hashes();
}

std::vector<Parameter> list_parameters(const ModelData& data) {
  std::vector<Parameter> parameters;
  PartsVisitor parts(&parameters);
  visit_parts(data, parts);
  return parameters;
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
