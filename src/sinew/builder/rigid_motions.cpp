#include "sinew/builder/rigid_motions.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include "sinew/constraint/joint.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

namespace {

// Smaller singular values, relative to the largest, belong to free rigid motions.
constexpr double kFree = 1e-6;
// Least part of a unit motion that counts as a motion of a part.
constexpr double kPartMoves = 1e-3;
// A mesh with more parts is taken as one: the matrix of a step tells which of them are loose.
constexpr std::size_t kMostParts = 150;

}  // namespace

BodyParts::BodyParts(const model::ModelData& data, int body) : parts_(1) {
  const mechanics::BodyModel& model = data.body(body);
  if (mechanics::as<const mechanics::MovesByNodes>(model) == nullptr) return;
  std::vector<mesh::RigidPart> parts = mesh::rigid_parts(model.mesh());
  if (parts.size() < 2 || parts.size() > kMostParts) return;
  parts_ = std::move(parts);
  of_node_ = mesh::parts_of_nodes(model.mesh(), parts_);
}

RigidMotions::RigidMotions(const model::ModelData& data, const std::vector<BodyParts>& parts,
                           const std::vector<int>& bodies)
    : data_(data), parts_(parts), columns_(data.bodies.size()) {
  Eigen::Index count = 0;
  for (const int body : bodies) {
    for (const mesh::RigidPart& part : parts[static_cast<std::size_t>(body)].all()) {
      Column column{.first = count, .centre = Vector3::Zero(), .radius = data.size};
      if (part.nodes.empty()) {
        // About a held point, a body that lies far from the origin is as surely held as another.
        const auto held = data.body(body).held_directions();
        if (!held.empty()) column.centre = held.front().at;
      } else {
        const Points own = data.body(body).mesh().nodes(part.nodes, Eigen::all);
        column.centre = own.colwise().mean().transpose();
        column.radius = (own.rowwise() - column.centre.transpose()).rowwise().norm().maxCoeff();
      }
      columns_[static_cast<std::size_t>(body)].push_back(column);
      count += 6;
    }
  }
  normal_.setZero(count, count);
}

const RigidMotions::Column* RigidMotions::column_of(int body, int part) const {
  if (body < 0) return nullptr;
  const auto& columns = columns_[static_cast<std::size_t>(body)];
  return columns.empty() ? nullptr : &columns[static_cast<std::size_t>(part)];
}

int RigidMotions::part_of(const mechanics::MaterialPoint& point) const {
  if (point.body < 0) return 0;
  const BodyParts& parts = parts_[static_cast<std::size_t>(point.body)];
  if (!parts.several()) return 0;
  const auto& model = *mechanics::as<const mechanics::MovesByNodes>(data_.body(point.body));
  const std::vector<NodeId>& nodes = model.attachment(point.number).nodes;
  return nodes.empty() ? 0 : parts.of_node(nodes.front()).front();
}

void RigidMotions::hold_own(int body) {
  const mechanics::BodyModel& model = data_.body(body);
  const BodyParts& parts = parts_[static_cast<std::size_t>(body)];
  const auto hold = [&](int part, const mechanics::HeldDirection& held) {
    begin_row();
    if (held.turn) {
      turn(column_of(body, part), held.direction, 1.0);
    } else {
      fill(column_of(body, part), held.at, held.direction, 1.0);
    }
    end_row();
  };
  for (const mechanics::HeldDirection& held : model.held_directions()) {
    if (parts.several() && held.node >= 0) {
      const std::vector<int>& own = parts.of_node(held.node);
      if (!own.empty()) hold(own.front(), held);  // else a node of no element
      continue;
    }
    for (std::size_t part = 0; part < parts.count(); ++part) hold(static_cast<int>(part), held);
  }
  if (!parts.several()) return;
  const Points& nodes = model.mesh().nodes;
  for (NodeId node = 0; node < static_cast<NodeId>(nodes.rows()); ++node) {
    const std::vector<int>& own = parts.of_node(node);
    for (std::size_t k = 1; k < own.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        begin_row();
        fill(column_of(body, own[0]), nodes.row(node).transpose(), Vector3::Unit(axis), 1.0);
        fill(column_of(body, own[k]), nodes.row(node).transpose(), Vector3::Unit(axis), -1.0);
        end_row();
      }
    }
  }
}

void RigidMotions::hold(const mechanics::MaterialPoint& first,
                        const mechanics::MaterialPoint& second) {
  for (int axis = 0; axis < 3; ++axis) {
    begin_row();
    double sign = -1.0;
    for (const mechanics::MaterialPoint& point : {first, second}) {
      const Vector3 at = data_.body(point.body).rest_position(point.number);
      fill(column_of(point.body, part_of(point)), at, Vector3::Unit(axis), sign);
      sign = 1.0;
    }
    end_row();
  }
}

void RigidMotions::hold(const constraint::Joint& joint) {
  const std::vector<Vector3> directions = joint.rest_directions();
  for (std::size_t k = 0; k < directions.size(); ++k) {
    add_row(joint, directions[k], static_cast<int>(k) >= joint.displacements());
  }
}

void RigidMotions::hold_rest(const constraint::Joint& joint) {
  add_row(joint, joint.place().axes().col(2), constraint::turns_about_axis(joint.type()));
}

// Motion along a direction of a point at x on a part that translates and rotates: d.(s + w x r),
// with rotations scaled by the radius of the part.
void RigidMotions::fill(const Column* column, const Vector3& at, const Vector3& direction,
                        double sign) {
  if (column == nullptr) return;
  row_.segment<3>(column->first) += sign * direction;
  row_.segment<3>(column->first + 3) +=
      sign * ((at - column->centre) / column->radius).cross(direction);
}

void RigidMotions::turn(const Column* column, const Vector3& axis, double sign) {
  if (column != nullptr) {
    row_.segment<3>(column->first + 3) += sign * axis * (data_.size / column->radius);
  }
}

// Row of the second side's motion relative to the first: a rotation about a direction, or a
// displacement along it.
void RigidMotions::add_row(const constraint::Joint& joint, const Vector3& direction, bool is_turn) {
  begin_row();
  double sign = -1.0;
  for (const constraint::JointSide& side : joint.place().sides()) {
    if (is_turn) {
      turn(column_of(side.orientation.body, 0), direction, sign);
    } else {
      fill(column_of(side.point.body, part_of(side.point)), side.rest, direction, sign);
    }
    sign = 1.0;
  }
  end_row();
}

MatrixX RigidMotions::free_motions() const {
  if (normal_.size() == 0) return MatrixX(0, 0);
  const linalg::SymmetricSpectrum spectrum(normal_);
  const double least = kFree * kFree * spectrum.values().tail<1>()[0];
  const Eigen::Index count = (spectrum.values().array() <= least).count();
  return spectrum.vectors().leftCols(count);
}

std::vector<char> RigidMotions::moving_parts(int body, const MatrixX& free) const {
  std::vector<char> result;
  for (const Column& column : columns_[static_cast<std::size_t>(body)]) {
    result.push_back(free.cols() > 0 && free.middleRows(column.first, 6).norm() > kPartMoves);
  }
  return result;
}

}  // namespace sinew::builder
