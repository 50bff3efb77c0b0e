#include "sinew/builder/body_holding.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/anchors.hpp"
#include "sinew/builder/rigid_motions.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

namespace {

// Group of each body; bodies that joints connect have the same.
std::vector<int> groups_of(const model::ModelData& data) {
  std::vector<int> group(data.bodies.size());
  std::iota(group.begin(), group.end(), 0);
  for (const model::JointModel& joint : data.joints) {
    if (joint.first == model::kWorld || joint.second == model::kWorld) continue;
    const int from = group[static_cast<std::size_t>(joint.second)];
    const int to = group[static_cast<std::size_t>(joint.first)];
    std::ranges::replace(group, from, to);
  }
  return group;
}

bool has_motor(const model::ModelData& data, const model::JointModel& joint) {
  return std::ranges::any_of(data.actuators, [&](const model::ActuatorModel& actuator) {
    return actuator.joint >= 0 && &data.joints[static_cast<std::size_t>(actuator.joint)] == &joint;
  });
}

// What fixed nodes and joints leave free.
class Holding {
 public:
  explicit Holding(const model::ModelData& data) : data_(data), group_(groups_of(data)) {
    const int count = static_cast<int>(data.bodies.size());
    for (int body = 0; body < count; ++body) parts_.emplace_back(data, body);
    for (int body = 0; body < count; ++body) {
      RigidMotions motions(data, parts_, {body});
      motions.hold_own(body);
      alone_.push_back(motions.free_motions().cols() == 0 ? 1 : 0);
    }
  }

  bool held_alone(std::size_t body) const { return alone_[body] != 0; }
  const BodyParts& parts(std::size_t body) const { return parts_[body]; }

  // (parts,) whether fixed nodes, held axes and joints leave each part of a body free.
  std::vector<char> free_parts(std::size_t body) {
    const auto [found, added] = groups_.try_emplace(group_[body]);
    if (added) found->second.emplace(motions_of(body));
    const auto& [motions, free] = *found->second;
    return motions.moving_parts(static_cast<int>(body), free);
  }

  // Whether something else may hold the free parts of a body: cables and springs that act on them,
  // contacts, or weight and loads on a mechanism of joints. Whether they do depends on the forces,
  // so a step decides.
  bool may_be_held(std::size_t body, const std::vector<char>& free) const {
    const BodyParts& parts = parts_[body];
    for (std::size_t part = 0; part < parts.count(); ++part) {
      if (free[part] != 0 && !is_touched(body, parts.several() ? static_cast<int>(part) : -1)) {
        return !parts.several() && group_is_touched(body);
      }
    }
    return true;
  }

 private:
  struct Group {
    RigidMotions motions;
    MatrixX free;
  };

  Group motions_of(std::size_t body) const {
    std::vector<int> loose;
    for (std::size_t other = 0; other < group_.size(); ++other) {
      if (group_[other] == group_[body] && !held_alone(other)) {
        loose.push_back(static_cast<int>(other));
      }
    }
    RigidMotions motions(data_, parts_, loose);
    for (const int other : loose) motions.hold_own(other);
    for (const model::JointModel& link : data_.joints) add(link, motions);
    const MatrixX free = motions.free_motions();
    return {std::move(motions), free};
  }

  void add(const model::JointModel& link, RigidMotions& motions) const {
    const constraint::Constraint& rows = data_.constraint(link.constraint);
    if (const auto* tie = dynamic_cast<const constraint::Tie*>(&rows)) {
      for (const constraint::Tie::Pair& pair : tie->pairs()) motions.hold(pair.first, pair.second);
    } else if (const auto* joint = dynamic_cast<const constraint::Joint*>(&rows)) {
      motions.hold(*joint);
      if (link.friction > 0.0 || has_motor(data_, link)) motions.hold_rest(*joint);
    }
  }

  // Whether a cable, a spring or a contact acts on a part of a body. @param part -1: on any.
  bool is_touched(std::size_t body, int part) const {
    for (const model::ContactModel& model : data_.contacts) {
      const auto& contact =
          static_cast<const constraint::Contact&>(data_.constraint(model.constraint));
      if (contact.body() == contact.other_body()) continue;
      const int index = static_cast<int>(body);
      if (contact.body() == index || contact.other_body() == index) return true;
    }
    return std::ranges::any_of(data_.actuators, [&](const model::ActuatorModel& actuator) {
      return actuator.kind->is_line && acts_on(data_.constraint(actuator.constraint), body, part);
    });
  }

  // A body without joints hangs on ropes that end on it. A line along it is its own tendon, which
  // bends it; a body whose fixed region was forgotten has such lines.
  bool acts_on(const constraint::Constraint& line, std::size_t body, int part) const {
    std::set<std::int32_t> points;
    for (int k = 0; k < line.row_count(); ++k) {
      const auto row = static_cast<std::size_t>(line.first_row() + k);
      for (auto e = data_.rows.row_start[row]; e < data_.rows.row_start[row + 1]; ++e) {
        const mechanics::Site& site = data_.rows.site[static_cast<std::size_t>(e)];
        if (site.body != static_cast<std::int32_t>(body)) continue;
        if (part < 0 || lies_on(site, part)) points.insert(site.number);
      }
    }
    return part < 0 && !is_jointed(body) ? points.size() == 1 : !points.empty();
  }

  bool lies_on(const mechanics::Site& point, int part) const {
    const auto* body = mechanics::as<const mechanics::MovesByNodes>(data_.body(point.body));
    if (body == nullptr) return false;
    const std::vector<NodeId>& nodes = body->attachment(point.number).nodes;
    return std::ranges::any_of(nodes, [&](NodeId node) {
      const auto& own = parts_[static_cast<std::size_t>(point.body)].of_node(node);
      return std::ranges::find(own, part) != own.end();
    });
  }

  // Whether a joint acts on a body, in contrast to welded points.
  bool is_jointed(std::size_t body) const {
    return std::ranges::any_of(data_.joints, [&](const model::JointModel& link) {
      const bool own =
          link.first == static_cast<int>(body) || link.second == static_cast<int>(body);
      return own && dynamic_cast<const constraint::Joint*>(&data_.constraint(link.constraint));
    });
  }

  // Whether something acts on a body that joints connect with this one, or weight or loads act on
  // a mechanism of joints. Welded points alone are no mechanism that anyone intends.
  bool group_is_touched(std::size_t body) const {
    bool touched = false, loaded = false, jointed = false;
    for (std::size_t other = 0; other < group_.size(); ++other) {
      if (group_[other] != group_[body]) continue;
      touched = touched || is_touched(other, -1);
      loaded = loaded || data_.body(static_cast<int>(other)).is_loaded();
      jointed = jointed || is_jointed(other);
    }
    return touched || (loaded && jointed);
  }

  const model::ModelData& data_;
  std::vector<int> group_;
  std::vector<BodyParts> parts_;
  std::vector<char> alone_;
  std::map<int, std::optional<Group>> groups_;  // by number, when first needed
};

bool is_joined(const model::ModelData& data, int body) {
  return std::ranges::any_of(data.joints, [&](const model::JointModel& joint) {
    return joint.first == body || joint.second == body;
  });
}

// Parts of a mesh that hang on the others by a node or an edge.
[[noreturn]] void throw_loose_part(const model::ModelData& data, std::size_t body,
                                   const std::vector<char>& free, Location place) {
  const mesh::Mesh& mesh = data.bodies[body]->mesh();
  const auto& parts = *mechanics::as<const mechanics::MovesByNodes>(*data.bodies[body]);
  const std::vector<mesh::LooseJoint> loose = mesh::loose_joints(mesh, parts.held_axes());
  std::string named;
  if (!loose.empty()) named = ": " + mesh::describe(loose.back(), mesh);
  if (loose.size() > 1) named += fmt::format(" ({} such parts in all)", loose.size());
  throw Error(
      ErrorKind::nothing_fixed, place,
      fmt::format("{} of the {} parts of its mesh can move without deforming, so it has no "
                  "static equilibrium{}",
                  std::ranges::count(free, 1), free.size(), named),
      "remove the loose elements or join them by whole faces, fix them, or choose a dynamic "
      "integrator");
}

[[noreturn]] void throw_loose(const model::ModelData& data, std::size_t body, Location place,
                              bool joined) {
  const bool held = !data.bodies[body]->held_directions().empty();
  if (joined) {
    throw Error(ErrorKind::nothing_fixed, place,
                "its joints leave it free to move, and neither weight nor a cable, spring or "
                "contact could hold it, so it has no static equilibrium",
                "fix a region of one of the joined bodies, weld three points that are not on one "
                "line, give a hinge or slider a motor, or choose a dynamic integrator");
  }
  throw Error(ErrorKind::nothing_fixed, place,
              !held ? "nothing holds this body, so it has no static equilibrium"
                    : "what is fixed leaves it free to move, so it has no static equilibrium",
              "fix a region of it, weld it to a body that is held, or choose a dynamic integrator");
}

}  // namespace

void hold_bodies(model::ModelData& data, const std::vector<Location>& places) {
  Holding holding(data);
  std::vector<int> anchored;
  for (std::size_t b = 0; b < data.bodies.size(); ++b) {
    if (holding.held_alone(b)) continue;
    const std::vector<char> free = holding.free_parts(b);
    const bool held = std::ranges::count(free, 0) == std::ssize(free);
    if (held || !data.step.dynamic()) anchored.push_back(static_cast<int>(b));
    if (held) continue;
    data.loose = true;
    if (data.step.dynamic() || holding.may_be_held(b, free)) continue;
    Location place = places[b];
    if (place.item.empty()) place.item = "body '" + data.bodies[b]->name() + "'";
    if (holding.parts(b).several()) throw_loose_part(data, b, free, place);
    throw_loose(data, b, place, is_joined(data, static_cast<int>(b)));
  }
  for (const int body : anchored) {
    for (const mesh::RigidPart& part : holding.parts(static_cast<std::size_t>(body)).all()) {
      add_anchors(data, body, part.nodes);
    }
  }
}

}  // namespace sinew::builder
