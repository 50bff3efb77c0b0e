#include "sinew/sim/model.hpp"

#include <fmt/format.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/cavity.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"

namespace sinew::sim {

namespace {

template <typename List, typename NameOf>
int find_by_name(const List& list, std::string_view name, const char* what, NameOf name_of) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (name_of(list[i]) == name) return static_cast<int>(i);
    names.push_back(name_of(list[i]));
  }
  const std::string near = nearest_word(name, names);
  const std::string remedy = !near.empty()   ? fmt::format("did you mean '{}'?", near)
                             : names.empty() ? fmt::format("the robot has no {}", what)
                                             : fmt::format("there are: {}", fmt::join(names, ", "));
  throw Error(ErrorKind::unknown_name, {.item = std::string(name)},
              fmt::format("no {} is called '{}'", what, name), remedy);
}

}  // namespace

Eigen::Isometry3d ContactModel::pose(double time) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!motion) return pose;
  const Vector3 turn = motion->rotation_at(time);
  if (const double angle = turn.norm(); angle > 0.0) {
    pose.rotate(Eigen::AngleAxisd(angle, turn / angle));
  }
  pose.pretranslate(
      Vector3(motion->translation_at(time) + motion->centre - pose.linear() * motion->centre));
  return pose;
}

Model::Model() = default;
Model::~Model() = default;

int Model::body_index(std::string_view name) const {
  return find_by_name(bodies_, name, "body", [](const auto& b) { return b->name(); });
}

int Model::actuator_index(std::string_view name) const {
  return find_by_name(actuators_, name, "actuator", [](const auto& a) { return a.name; });
}

int Model::effector_index(std::string_view name) const {
  return find_by_name(effectors_, name, "effector", [](const auto& e) { return e.name; });
}

int Model::contact_index(std::string_view name) const {
  return find_by_name(contacts_, name, "contact", [](const auto& c) { return c.name; });
}

int Model::weld_index(std::string_view name) const {
  return find_by_name(welds_, name, "joint", [](const auto& w) { return w.name; });
}

int Model::load_index(std::string_view name) const {
  return find_by_name(loads_, name, "load", [](const auto& l) { return l.name; });
}

int Model::mass_index(std::string_view name) const {
  return find_by_name(masses_, name, "mass", [](const auto& m) { return m.name; });
}

int Model::probe_index(std::string_view name) const {
  return find_by_name(probes_, name, "probe", [](const auto& p) { return p->name(); });
}

const constraint::Effector& Model::effector(int index) const {
  const auto& model = effectors_.at(static_cast<std::size_t>(index));
  return dynamic_cast<const constraint::Effector&>(
      *constraints_[static_cast<std::size_t>(model.constraint)]);
}

const constraint::Contact& Model::contact(int index) const {
  const auto& model = contacts_.at(static_cast<std::size_t>(index));
  return dynamic_cast<const constraint::Contact&>(
      *constraints_[static_cast<std::size_t>(model.constraint)]);
}

const constraint::Tie& Model::weld(int index) const {
  const auto& model = welds_.at(static_cast<std::size_t>(index));
  return dynamic_cast<const constraint::Tie&>(
      *constraints_[static_cast<std::size_t>(model.constraint)]);
}

const constraint::Cable* Model::cable(int actuator) const {
  const auto& model = actuators_.at(static_cast<std::size_t>(actuator));
  return dynamic_cast<const constraint::Cable*>(
      constraints_[static_cast<std::size_t>(model.constraint)].get());
}

const constraint::Cavity* Model::cavity(int actuator) const {
  const auto& model = actuators_.at(static_cast<std::size_t>(actuator));
  return dynamic_cast<const constraint::Cavity*>(
      constraints_[static_cast<std::size_t>(model.constraint)].get());
}

}  // namespace sinew::sim
