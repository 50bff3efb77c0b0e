#include "sinew/constraint/effector.hpp"

#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"

namespace sinew::constraint {

namespace {

// A triangle whose height is below this part of its base has no reliable normal.
constexpr double kFlattest = 1e-6;

// Columns e1, e2, e3 of the frame through a, b, c.
Matrix3 triangle_frame(const Vector3& a, const Vector3& b, const Vector3& c) {
  Matrix3 frame;
  frame.col(0) = (b - a).normalized();
  frame.col(2) = (b - a).cross(c - a).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

}  // namespace

const char* effector_kind_name(EffectorKind kind) {
  return kind == EffectorKind::point ? "point" : "orientation";
}

Effector::Effector(std::string name, std::vector<Vector3> directions)
    : Constraint(std::move(name)), directions_(std::move(directions)) {
  if (directions_.empty()) {
    directions_ = {Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  }
  for (auto& direction : directions_) {
    const double length = direction.norm();
    if (!(length > 0.0)) {
      throw Error(ErrorKind::out_of_range, {.item = "effector '" + this->name() + "'"},
                  "a direction has no length", "give directions such as 0 0 1");
    }
    direction /= length;
  }
}

PointEffector::PointEffector(std::string name, mechanics::MaterialPoint point,
                             std::vector<Vector3> directions)
    : Effector(std::move(name), std::move(directions)), point_(point) {}

void PointEffector::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = static_cast<int>(directions_.size());
  for (int k = 0; k < row_count_; ++k) rows.add_row({point_});
}

void PointEffector::linearise(const Configuration& configuration,
                              mechanics::RowValues& values) const {
  const Vector3 position = configuration.position(point_);
  for (int k = 0; k < row_count_; ++k) {
    const Vector3& direction = directions_[static_cast<std::size_t>(k)];
    values.direction[static_cast<std::size_t>(first_entry_ + k)] = direction;
    values.delta[first_row_ + k] = direction.dot(position);
  }
}

Vector3 PointEffector::value(const Configuration& configuration) const {
  return configuration.position(point_);
}

void PointEffector::target_delta(const Configuration&, const Vector3& target,
                                 Eigen::Ref<VectorX> delta) const {
  for (int k = 0; k < row_count_; ++k) {
    delta[k] = directions_[static_cast<std::size_t>(k)].dot(target);
  }
}

Vector3 OrientationEffector::value(const Configuration& configuration) const {
  return rotation_vector(rotation(configuration));
}

void OrientationEffector::target_delta(const Configuration& configuration, const Vector3& target,
                                       Eigen::Ref<VectorX> delta) const {
  // The rows measure the rotation from here on, so the target is the present value plus the
  // remaining rotation vector.
  const Matrix3 now = rotation(configuration);
  delta = value(configuration) + rotation_vector(rotation_matrix(target) * now.transpose());
}

SectionOrientation::SectionOrientation(std::string name, mechanics::Orientation section)
    : OrientationEffector(std::move(name)), section_(section) {}

void SectionOrientation::declare(mechanics::RowPattern& rows,
                                 std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 3;
  for (int k = 0; k < 3; ++k) rows.add_row({section_});
}

void SectionOrientation::linearise(const Configuration& configuration,
                                   mechanics::RowValues& values) const {
  const Vector3 now = value(configuration);
  for (int k = 0; k < 3; ++k) {
    values.direction[static_cast<std::size_t>(first_entry_ + k)] = Vector3::Unit(k);
    values.delta[first_row_ + k] = now[k];
  }
}

Matrix3 SectionOrientation::rotation(const Configuration& configuration) const {
  return configuration.rotation(section_);
}

TriangleOrientation::TriangleOrientation(std::string name,
                                         std::array<mechanics::MaterialPoint, 3> points,
                                         const std::array<Vector3, 3>& rest)
    : OrientationEffector(std::move(name)), points_(points) {
  const Vector3 base = rest[1] - rest[0];
  const double height = base.cross(rest[2] - rest[0]).norm() / base.norm();
  if (!(height > kFlattest * base.norm())) {
    throw Error(ErrorKind::degenerate_orientation, {.item = "effector '" + this->name() + "'"},
                fmt::format("the three points lie on one line (height {:g} m)", height),
                "choose three points that span a triangle");
  }
  rest_frame_ = triangle_frame(rest[0], rest[1], rest[2]);
}

void TriangleOrientation::declare(mechanics::RowPattern& rows,
                                  std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 3;
  for (int k = 0; k < 3; ++k) rows.add_row({points_[0], points_[1], points_[2]});
}

void TriangleOrientation::linearise(const Configuration& configuration,
                                    mechanics::RowValues& values) const {
  const Vector3 a = configuration.position(points_[0]);
  const Vector3 b = configuration.position(points_[1]);
  const Vector3 c = configuration.position(points_[2]);
  const Matrix3 frame = triangle_frame(a, b, c);
  const double length = (b - a).norm();
  const double alpha = frame.col(0).dot(c - a);
  const double beta = frame.col(1).dot(c - a);
  // Components of omega in the frame (e1, e2, e3) as linear forms of the motions of b - a and
  // c - a.
  Matrix3 by_b = Matrix3::Zero();
  Matrix3 by_c = Matrix3::Zero();
  by_b.row(2) = frame.col(1).transpose() / length;
  by_b.row(1) = -frame.col(2).transpose() / length;
  by_b.row(0) = (alpha / beta) * by_b.row(1);
  by_c.row(0) = frame.col(2).transpose() / beta;
  const Matrix3 world_b = frame * by_b;
  const Matrix3 world_c = frame * by_c;
  const Vector3 now = value(configuration);
  for (int k = 0; k < 3; ++k) {
    const auto entry = static_cast<std::size_t>(first_entry_ + 3 * k);
    values.direction[entry + 1] = world_b.row(k);
    values.direction[entry + 2] = world_c.row(k);
    values.direction[entry] = -(world_b.row(k) + world_c.row(k)).transpose();
    values.delta[first_row_ + k] = now[k];
  }
}

Matrix3 TriangleOrientation::rotation(const Configuration& configuration) const {
  return triangle_frame(configuration.position(points_[0]), configuration.position(points_[1]),
                        configuration.position(points_[2])) *
         rest_frame_.transpose();
}

}  // namespace sinew::constraint
