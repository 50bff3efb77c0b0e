#include "sinew/constraint/joint.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "sinew/constraint/configuration.hpp"

namespace sinew::constraint {

namespace {

constexpr std::array<std::array<int, 2>, 3> kTurns{{{2, 0}, {2, 1}, {0, 1}}};

std::span<const std::array<int, 2>> turns_of(JointType type) {
  switch (type) {
    case JointType::ball:
      return {};
    case JointType::universal:
      return std::span(kTurns).first(1);
    case JointType::hinge:
    case JointType::cylindrical:
      return std::span(kTurns).first(2);
    case JointType::weld:
    case JointType::slider:
      break;
  }
  return kTurns;
}

bool is_body(const mechanics::Site& site) { return site.body >= 0; }

}  // namespace

const char* joint_type_name(JointType type) {
  switch (type) {
    case JointType::ball:
      return "ball";
    case JointType::universal:
      return "universal";
    case JointType::hinge:
      return "hinge";
    case JointType::weld:
      return "weld";
    case JointType::slider:
      return "slider";
    case JointType::cylindrical:
      return "cylindrical";
  }
  return "";
}

double JointFrames::angle() const {
  const Vector3 turned = axes[1].col(0);
  return std::atan2(turned.dot(axes[0].col(1)), turned.dot(axes[0].col(0)));
}

JointPlace::JointPlace(const JointSide& first, const JointSide& second, const Matrix3& axes)
    : sides_{first, second}, axes_(axes) {}

JointFrames JointPlace::frames(const Configuration& configuration) const {
  JointFrames frames;
  for (std::size_t s = 0; s < 2; ++s) {
    const JointSide& side = sides_[s];
    frames.origin[s] = is_body(side.point) ? configuration.position(side.point) : side.rest;
    frames.axes[s] = axes_;
    if (is_body(side.orientation))
      frames.axes[s] = configuration.rotation(side.orientation) * axes_;
  }
  return frames;
}

int JointPlace::add_row(mechanics::RowPattern& rows, bool points, bool orientations) const {
  std::vector<mechanics::Site> sites;
  for (const std::size_t s : {1U, 0U}) {
    if (points && is_body(sides_[s].point)) sites.push_back(sides_[s].point);
  }
  for (const std::size_t s : {1U, 0U}) {
    if (orientations && is_body(sides_[s].orientation)) sites.push_back(sides_[s].orientation);
  }
  return rows.add_row(sites);
}

Vector3* JointPlace::write_points(Vector3* entry, const Vector3& direction) const {
  if (is_body(sides_[1].point)) *entry++ = direction;
  if (is_body(sides_[0].point)) *entry++ = -direction;
  return entry;
}

Vector3* JointPlace::write_turns(Vector3* entry, const Vector3& second,
                                 const Vector3& first) const {
  if (is_body(sides_[1].orientation)) *entry++ = second;
  if (is_body(sides_[0].orientation)) *entry++ = first;
  return entry;
}

Joint::Joint(std::string name, JointType type, const JointPlace& place)
    : Constraint(std::move(name)),
      type_(type),
      place_(place),
      displacements_(slides_along_axis(type) ? 2 : 3),
      turns_(turns_of(type)) {}

void Joint::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = displacements_ + static_cast<int>(turns_.size());
  for (int k = 0; k < displacements_; ++k) place_.add_row(rows, true, slides_along_axis(type_));
  for (std::size_t k = 0; k < turns_.size(); ++k) place_.add_row(rows, false, true);
}

Vector3 Joint::direction(const JointFrames& frames, int row) const {
  const auto& [a, b] = frames.axes;
  if (row < displacements_) {
    return slides_along_axis(type_) ? Vector3(a.col(row)) : Vector3(Vector3::Unit(row));
  }
  const auto& [i, j] = turns_[static_cast<std::size_t>(row - displacements_)];
  return b.col(j).cross(a.col(i));
}

void Joint::linearise(const Configuration& configuration, mechanics::RowValues& values) const {
  const JointFrames frames = place_.frames(configuration);
  const auto& [a, b] = frames.axes;
  const Vector3 offset = frames.offset();
  Vector3* entry = values.direction.data() + first_entry_;
  int row = 0;
  for (; row < displacements_; ++row) {
    const Vector3 axis = direction(frames, row);
    entry = place_.write_points(entry, axis);
    if (slides_along_axis(type_)) {
      entry = place_.write_turns(entry, Vector3::Zero(), axis.cross(offset));
    }
    values.delta[first_row_ + row] = axis.dot(offset);
  }
  for (const auto& [i, j] : turns_) {
    const Vector3 about = direction(frames, row);
    entry = place_.write_turns(entry, about, -about);
    values.delta[first_row_ + row++] = a.col(i).dot(b.col(j));
  }
}

std::vector<Vector3> Joint::rest_directions() const {
  const JointFrames frames{.axes = {place_.axes(), place_.axes()}};
  std::vector<Vector3> result;
  for (int row = 0; row < row_count_; ++row) result.push_back(direction(frames, row));
  return result;
}

void Joint::describe(PartVisitor& visitor) const {
  visitor.add(static_cast<int>(type_));
  place_.describe(visitor);
}

Joint::Load Joint::load(const Configuration& configuration, std::span<const double> effort) const {
  const JointFrames frames = place_.frames(configuration);
  Load load;
  for (int row = 0; row < row_count_; ++row) {
    Vector3& sum = row < displacements_ ? load.force : load.moment;
    sum += effort[static_cast<std::size_t>(row)] * direction(frames, row);
  }
  return load;
}

double Joint::gap(const Configuration& configuration) const {
  const JointFrames frames = place_.frames(configuration);
  const Vector3 offset = frames.offset();
  return (slides_along_axis(type_) ? Vector3(offset - frames.slide() * frames.axes[0].col(2))
                                   : offset)
      .norm();
}

JointMotion::JointMotion(std::string name, Kind kind, const JointPlace& place)
    : Constraint(std::move(name)), kind_(kind), place_(place) {}

void JointMotion::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_entry_ = rows.entries();
  first_row_ = place_.add_row(rows, kind_ == Kind::displacement, true);
  row_count_ = 1;
}

void JointMotion::linearise(const Configuration& configuration,
                            mechanics::RowValues& values) const {
  const JointFrames frames = place_.frames(configuration);
  const Vector3 axis = frames.axes[0].col(2);
  Vector3* entry = values.direction.data() + first_entry_;
  if (kind_ == Kind::angle) {
    place_.write_turns(entry, axis, -axis);
    values.delta[first_row_] = frames.angle();
    return;
  }
  entry = place_.write_points(entry, axis);
  place_.write_turns(entry, Vector3::Zero(), axis.cross(frames.offset()));
  values.delta[first_row_] = frames.slide();
}

void JointMotion::describe(PartVisitor& visitor) const {
  visitor.add(static_cast<int>(kind_));
  place_.describe(visitor);
}

}  // namespace sinew::constraint
