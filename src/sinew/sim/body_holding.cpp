#include "sinew/sim/body_holding.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/sim/anchors.hpp"
#include "sinew/sim/model_data.hpp"

namespace sinew::sim {

namespace {

// Smaller singular values, relative to the largest, belong to free rigid motions.
constexpr double kFree = 1e-6;

// Group of each body; bodies that joints connect have the same.
std::vector<int> groups_of(const ModelData& data) {
  std::vector<int> group(data.bodies.size());
  std::iota(group.begin(), group.end(), 0);
  for (const JointModel& joint : data.joints) {
    if (joint.first == kWorld || joint.second == kWorld) continue;
    const int from = group[static_cast<std::size_t>(joint.second)];
    const int to = group[static_cast<std::size_t>(joint.first)];
    std::ranges::replace(group, from, to);
  }
  return group;
}

// Normal matrix of the rows d(delta)/d(translation, rotation) of some bodies.
class RigidMotions {
 public:
  RigidMotions(const ModelData& data, const std::vector<int>& bodies)
      : data_(data), column_(data.bodies.size(), -1) {
    for (const int body : bodies) {
      column_[static_cast<std::size_t>(body)] = columns_;
      columns_ += 6;
    }
    normal_.setZero(columns_, columns_);
  }

  // Adds the fixed nodes and held axes of a body; bodies without elements are free or fixed as a
  // whole.
  void hold_own(int body) {
    if (data_.body(body).is_free()) return;
    const auto* material = mechanics::as<const fem::HasElements>(data_.body(body));
    if (material == nullptr) {
      normal_.diagonal().segment<6>(column_[static_cast<std::size_t>(body)]).array() += 1.0;
      return;
    }
    const fem::FemModelSettings& own = material->settings().elements;
    const Points& nodes = data_.body(body).mesh().nodes;
    const auto add = [&](NodeId node, int axis) {
      begin_row();
      fill(body, nodes.row(node).transpose(), Vector3::Unit(axis), 1.0);
      end_row();
    };
    for (const NodeId node : own.fixed_nodes) {
      for (int axis = 0; axis < 3; ++axis) add(node, axis);
    }
    for (const fem::HeldAxis& held : own.held_axes) add(held.node, held.axis);
  }
  void hold(const constraint::Tie::Pair& pair) {
    for (int axis = 0; axis < 3; ++axis) {
      begin_row();
      fill(pair.first.body, rest_of(pair.first), Vector3::Unit(axis), -1.0);
      fill(pair.second.body, rest_of(pair.second), Vector3::Unit(axis), 1.0);
      end_row();
    }
  }
  void hold(const constraint::Joint& joint) {
    const std::vector<Vector3> directions = joint.rest_directions();
    for (std::size_t k = 0; k < directions.size(); ++k) {
      add_row(joint, directions[k], static_cast<int>(k) >= joint.displacements());
    }
  }
  // Adds the free motion of a hinge or slider, which a motor or friction holds.
  void hold_rest(const constraint::Joint& joint) {
    add_row(joint, joint.place().axes().col(2), constraint::turns_about_axis(joint.type()));
  }
  // Whether no rigid motion is free.
  bool all_held() const {
    const VectorX values = linalg::symmetric_eigenvalues(normal_);
    return values[0] > kFree * kFree * values[columns_ - 1];
  }

 private:
  Vector3 rest_of(const mechanics::MaterialPoint& point) const {
    return data_.body(point.body).rest_position(point.number);
  }
  void begin_row() { row_.setZero(columns_); }
  int column_of(int body) const { return body < 0 ? -1 : column_[static_cast<std::size_t>(body)]; }
  // Motion along a direction of a point at x on a body that translates and rotates: d.(s + w x x),
  // with rotations scaled by the robot's size.
  void fill(int body, const Vector3& at, const Vector3& direction, double sign) {
    const int column = column_of(body);
    if (column < 0) return;
    row_.segment<3>(column) += sign * direction;
    row_.segment<3>(column + 3) += sign * (at / data_.size).cross(direction);
  }
  void turn(int body, const Vector3& axis, double sign) {
    const int column = column_of(body);
    if (column >= 0) row_.segment<3>(column + 3) += sign * axis;
  }
  // Row of the second side's motion relative to the first: a rotation about a direction, or a
  // displacement along it.
  void add_row(const constraint::Joint& joint, const Vector3& direction, bool is_turn) {
    begin_row();
    double sign = -1.0;
    for (const constraint::JointSide& side : joint.place().sides()) {
      if (is_turn) {
        turn(side.orientation.body, direction, sign);
      } else {
        fill(side.point.body, side.rest, direction, sign);
      }
      sign = 1.0;
    }
    end_row();
  }
  void end_row() { normal_.noalias() += row_ * row_.transpose(); }

  const ModelData& data_;
  std::vector<int> column_;  // of each body; -1: not among the bodies
  int columns_ = 0;
  VectorX row_;
  MatrixX normal_;
};

bool is_held_alone(const ModelData& data, int body) {
  RigidMotions motions(data, {body});
  motions.hold_own(body);
  return motions.all_held();
}

bool has_motor(const ModelData& data, const JointModel& joint) {
  return std::ranges::any_of(data.actuators, [&](const ActuatorModel& actuator) {
    return actuator.joint >= 0 && &data.joints[static_cast<std::size_t>(actuator.joint)] == &joint;
  });
}

// Whether joints prevent every rigid motion of the bodies that are not held.
// @param bodies one group.
bool joints_hold(const ModelData& data, const std::vector<int>& bodies,
                 const std::vector<char>& held) {
  std::vector<int> loose;
  for (const int body : bodies) {
    if (held[static_cast<std::size_t>(body)] == 0) loose.push_back(body);
  }
  RigidMotions motions(data, loose);
  for (const int body : loose) motions.hold_own(body);
  for (const JointModel& link : data.joints) {
    const constraint::Constraint& rows = data.constraint(link.constraint);
    if (const auto* tie = dynamic_cast<const constraint::Tie*>(&rows)) {
      for (const constraint::Tie::Pair& pair : tie->pairs()) motions.hold(pair);
    } else if (const auto* joint = dynamic_cast<const constraint::Joint*>(&rows)) {
      motions.hold(*joint);
      if (link.friction > 0.0 || has_motor(data, link)) motions.hold_rest(*joint);
    }
  }
  return motions.all_held();
}

bool is_joined(const ModelData& data, int body) {
  return std::ranges::any_of(data.joints, [&](const JointModel& joint) {
    return joint.first == body || joint.second == body;
  });
}

[[noreturn]] void throw_loose(const ModelData& data, std::size_t body, Location place,
                              bool joined) {
  if (place.item.empty()) place.item = "body '" + data.bodies[body]->name() + "'";
  const auto* material = mechanics::as<const fem::HasElements>(*data.bodies[body]);
  const bool bare = material == nullptr || (material->settings().elements.fixed_nodes.empty() &&
                                            material->settings().elements.held_axes.empty());
  if (joined) {
    throw Error(ErrorKind::nothing_fixed, place,
                "its joints leave it free to move, so it has no static equilibrium",
                "fix a region of one of the joined bodies, weld three points that are not on one "
                "line, give a hinge or slider a motor, or choose a dynamic integrator");
  }
  throw Error(ErrorKind::nothing_fixed, place,
              bare ? "nothing holds this body, so it has no static equilibrium"
                   : "what is fixed leaves it free to move, so it has no static equilibrium",
              "fix a region of it, weld it to a body that is held, or choose a dynamic integrator");
}

}  // namespace

void hold_bodies(ModelData& data, const std::vector<Location>& places) {
  const std::vector<int> group = groups_of(data);
  std::vector<char> held;
  for (std::size_t b = 0; b < data.bodies.size(); ++b) {
    held.push_back(is_held_alone(data, static_cast<int>(b)) ? 1 : 0);
  }
  for (std::size_t b = 0; b < held.size(); ++b) {
    if (held[b] != 0) continue;
    std::vector<int> connected;
    for (std::size_t other = 0; other < group.size(); ++other) {
      if (group[other] == group[b]) connected.push_back(static_cast<int>(other));
    }
    if (joints_hold(data, connected, held)) {
      add_anchors(data, static_cast<int>(b));
    } else if (!data.step.dynamic()) {
      throw_loose(data, b, places[b], is_joined(data, static_cast<int>(b)));
    }
  }
}

}  // namespace sinew::sim
