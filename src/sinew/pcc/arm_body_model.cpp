#include "sinew/pcc/arm_body_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/pcc/arm_body.hpp"

namespace sinew::pcc {

namespace {

constexpr int kSkinLayersASegment = 8;

}  // namespace

ArmBodyModel::ArmBodyModel(std::shared_ptr<const Arm> arm) : arm_(std::move(arm)) { make_skin(); }

ArmBodyModel::ArmBodyModel(ArmSettings settings)
    : ArmBodyModel(std::make_shared<const Arm>(std::move(settings))) {}

ArmPoint ArmBodyModel::locate(const Vector3& rest_position, mesh::Outside outside,
                              const std::string& what) const {
  const ArmSettings& settings = arm_->settings();
  if (!rest_position.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = what}, "the point is not finite",
                "give three numbers");
  }
  const Vector3 local = settings.frame.transpose() * (rest_position - settings.base);
  const double length = arm_->length(), slack = mesh::kOnSurface * length;
  const double beyond = std::max(-local.z(), local.z() - length);
  const double aside = std::hypot(local.x(), local.y()) - settings.radius;
  if (outside == mesh::Outside::error && (beyond > slack || aside > slack)) {
    throw Error(ErrorKind::point_outside_mesh, {.item = what},
                fmt::format("the point ({:.6g}, {:.6g}, {:.6g}) m lies {:.3g} m outside arm '{}'",
                            rest_position.x(), rest_position.y(), rest_position.z(),
                            std::hypot(std::max(beyond, 0.0), std::max(aside, 0.0)), name()),
                "move it inside, give the arm its radius, or write `outside: nearest`");
  }
  double from = 0.0, turn = 0.0;
  for (int n = 0;; ++n) {
    const Segment& segment = settings.segments[static_cast<std::size_t>(n)];
    turn += segment.gamma;
    const double begin = from + segment.dead_length, end = begin + segment.length;
    if (local.z() > end && n + 1 < arm_->segments()) {
      from = end;
      continue;
    }
    ArmPoint point;
    point.segment = n;
    point.fraction = std::clamp((local.z() - begin) / segment.length, 0.0, 1.0);
    point.x = std::cos(turn) * local.x() + std::sin(turn) * local.y();
    point.y = std::cos(turn) * local.y() - std::sin(turn) * local.x();
    point.z = local.z() - begin - point.fraction * segment.length;
    return point;
  }
}

int ArmBodyModel::attach(const Vector3& rest_position, mesh::Outside outside,
                         const std::string& what) {
  return add({.point = locate(rest_position, outside, what)});
}

// Sections are rigid, so the mean of a ball is its centre, except for the bend within the ball.
int ArmBodyModel::attach_ball(const Vector3& centre, double, mesh::Outside outside,
                              const std::string& what) {
  return attach(centre, outside, what);
}

int ArmBodyModel::attach_nodes(std::span<const NodeId>, std::span<const double>) {
  throw Error(ErrorKind::wrong_type, {.item = "body '" + name() + "'"},
              "a constant-curvature arm has no nodes or faces", "name points of it");
}

int ArmBodyModel::attach_mean(const Points& points, mesh::Outside outside,
                              const std::string& what) {
  ArmPoint mean;
  const double share = 1.0 / static_cast<double>(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const ArmPoint one = locate(points.row(i), outside, fmt::format("point {} of {}", i, what));
    if (i == 0) {
      mean = one;
      mean.x = mean.y = mean.z = 0.0;
    }
    if (one.segment != mean.segment || std::abs(one.fraction - mean.fraction) > mesh::kOnSurface) {
      throw Error(ErrorKind::wrong_type, {.item = what},
                  fmt::format("the points lie in several cross-sections of arm '{}', which has no "
                              "site for their mean",
                              name()),
                  "give one point, or several in one cross-section");
    }
    mean.x += share * one.x;
    mean.y += share * one.y;
    mean.z += share * one.z;
  }
  return add({.point = mean});
}

std::vector<int> ArmBodyModel::attach_anchors(std::span<const NodeId>) {
  std::vector<int> anchors;
  for (int n = 0; n < arm_->segments(); ++n) {
    ArmPoint end;
    end.segment = n;
    end.fraction = 1.0;
    anchors.push_back(add({.point = end}));
  }
  return anchors;
}

std::vector<mechanics::HeldDirection> ArmBodyModel::held_directions() const {
  return mechanics::held_as_a_whole(arm_->settings().base);
}

// Of the stiffest section: the force at its end that bends it, per motion of the end.
double ArmBodyModel::stiffness_scale() const {
  double most = 0.0;
  for (const Segment& segment : arm_->settings().segments) {
    most = std::max(most, segment.stiffness / (segment.length * segment.length));
  }
  return most > 0.0 ? most : 1.0;
}

int ArmBodyModel::attach_coordinate(int coordinate) {
  if (coordinate < 0 || coordinate >= arm_->coordinates()) {
    throw Error(ErrorKind::index_out_of_range, {.item = "body '" + name() + "'"},
                fmt::format("it has no coordinate {}", coordinate),
                fmt::format("name 0 to {}", arm_->coordinates() - 1));
  }
  return add({.kind = Attachment::Kind::coordinate, .coordinate = coordinate});
}

int ArmBodyModel::attach_orientation(const Vector3& rest_position, mesh::Outside outside,
                                     const std::string& what) {
  const ArmPoint point = locate(rest_position, outside, what);
  return add({.kind = Attachment::Kind::orientation,
              .point = point,
              .rest_rotation = plain(at_rest().rotation(point))});
}

int ArmBodyModel::add(const Attachment& attachment) {
  attachments_.push_back(attachment);
  return static_cast<int>(attachments_.size()) - 1;
}

ArmDynamics<double> ArmBodyModel::at_rest() const {
  ArmDynamics<double> dynamics(arm_);
  const std::vector<double> still(static_cast<std::size_t>(arm_->coordinates()));
  dynamics.place(still);
  return dynamics;
}

Vector3 ArmBodyModel::rest_position(int point) const {
  return plain(at_rest().position(attachment(point).point));
}

void ArmBodyModel::finish(int body, const mechanics::RowPattern& rows,
                          std::span<const mechanics::StiffnessPair>) {
  own_rows_ = mechanics::OwnRows(body, rows);
}

std::unique_ptr<mechanics::Body> ArmBodyModel::create(ThreadPool&, bool, int histories) const {
  return std::make_unique<ArmBody>(*this, histories);
}

void ArmBodyModel::make_skin() {
  const ArmSettings& settings = arm_->settings();
  mesh::CylinderShape shape;
  shape.radius = settings.radius;
  shape.height = arm_->length();
  shape.rings = 2;
  shape.layers = kSkinLayersASegment * arm_->segments();
  skin_ = mesh::cylinder(shape, mesh::Cells::hexahedra);
  skin_.name = name();
  for (Eigen::Index i = 0; i < skin_.nodes.rows(); ++i) {
    const Vector3 at = settings.base + settings.frame * skin_.nodes.row(i).transpose();
    skin_.nodes.row(i) = at.transpose();
    skin_points_.push_back(locate(at, mesh::Outside::nearest, name()));
  }
}

}  // namespace sinew::pcc
