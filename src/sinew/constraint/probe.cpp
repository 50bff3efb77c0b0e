#include "sinew/constraint/probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/core/axis_names.hpp"
#include "sinew/core/error.hpp"

namespace sinew::constraint {

namespace {

// Thickness of a set relative to its breadth above which it has no best-fit plane, and breadth
// relative to length below which it is a line.
constexpr double kThickest = 0.9, kNarrowest = 1e-6;
// Cosine between a normal and the line between two faces below which the line does not orient it.
constexpr double kAcross = 0.1;
// Relative to a hull's size: a shorter edge is rounding, two nodes one behind the other.
constexpr double kShortestEdge = 1e-9;

Points positions(const Configuration& configuration,
                 std::span<const mechanics::MaterialPoint> points) {
  Points result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = configuration.position(points[i]).transpose();
  }
  return result;
}

Points centred(const Points& points) { return points.rowwise() - points.colwise().mean(); }

std::vector<ProbeComponent> line_components(std::size_t points) {
  std::vector<ProbeComponent> result = {{"length", "m"}};
  for (std::size_t k = 0; k < points; ++k) {
    for (const char* axis : kAxisNames) result.push_back({fmt::format("{}.{}", k, axis), "m"});
  }
  return result;
}

[[noreturn]] void degenerate(const std::string& name, const std::string& message,
                             const std::string& remedy) {
  throw Error(ErrorKind::degenerate_orientation, {.item = "probe '" + name + "'"}, message, remedy);
}

Vector3 rest_normal(const ProbeFace& face, const std::string& name) {
  const Points about_middle = centred(face.rest);
  const Matrix3 spread = about_middle.transpose() * about_middle;
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(spread);
  const Vector3 size = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();  // ascending
  if (!(size[1] > kNarrowest * size[2])) {
    degenerate(name, fmt::format("a face has {} nodes, which lie on one line", face.rest.rows()),
               "choose three or more that span a plane");
  }
  if (face.normal) return face.normal->normalized();
  if (size[0] > kThickest * size[1]) {
    degenerate(name, "a face's nodes fit no plane better than another",
               "choose a thinner part, or give it by a plane");
  }
  return axes.eigenvectors().col(0);
}

/// Indices of the convex hull's corners, counter-clockwise (Andrew, Inf. Proc. Lett. 9, 1979).
std::vector<std::size_t> convex_hull(const std::vector<Eigen::Vector2d>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].x(), points[a].y()) < std::pair(points[b].x(), points[b].y());
  });
  const auto turn = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Eigen::Vector2d u = points[b] - points[a], v = points[c] - points[a];
    return u.x() * v.y() - u.y() * v.x();
  };
  std::vector<std::size_t> hull;
  const auto add_side = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto it = begin; it != end; ++it) {
      while (hull.size() >= first + 2 && turn(hull[hull.size() - 2], hull.back(), *it) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(*it);
    }
    hull.pop_back();  // it is the first point of the other side
  };
  add_side(order.begin(), order.end());
  add_side(order.rbegin(), order.rend());
  if (hull.empty()) hull = {order.front(), order.back()};
  return hull;
}

}  // namespace

PointProbe::PointProbe(std::string name, mechanics::MaterialPoint point)
    : Probe(std::move(name), {{"x", "m"}, {"y", "m"}, {"z", "m"}}), point_(point) {}

void PointProbe::measure(const Configuration& configuration, std::span<double> values) const {
  const Vector3 position = configuration.position(point_);
  std::copy_n(position.data(), 3, values.begin());
}

Points PointProbe::marks(const Configuration& configuration) const {
  return positions(configuration, {&point_, 1});
}

LineProbe::LineProbe(std::string name, std::vector<mechanics::MaterialPoint> points)
    : Probe(std::move(name), line_components(points.size())), points_(std::move(points)) {}

void LineProbe::measure(const Configuration& configuration, std::span<double> values) const {
  Vector3 before = configuration.position(points_.front());
  values[0] = 0.0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const Vector3 position = configuration.position(points_[k]);
    values[0] += (position - before).norm();
    std::copy_n(position.data(), 3, values.begin() + static_cast<std::ptrdiff_t>(1 + 3 * k));
    before = position;
  }
}

Points LineProbe::marks(const Configuration& configuration) const {
  return positions(configuration, points_);
}

DistanceProbe::DistanceProbe(std::string name, std::array<mechanics::MaterialPoint, 2> points)
    : Probe(std::move(name), {{"", "m"}}), points_(points) {}

void DistanceProbe::measure(const Configuration& configuration, std::span<double> values) const {
  values[0] = (configuration.position(points_[1]) - configuration.position(points_[0])).norm();
}

Points DistanceProbe::marks(const Configuration& configuration) const {
  return positions(configuration, points_);
}

BendProbe::BendProbe(std::string name, std::array<ProbeFace, 2> faces,
                     const std::optional<Vector3>& about)
    : Probe(std::move(name), {{"", "rad"}}), faces_(std::move(faces)) {
  const Vector3 line =
      (faces_[1].rest.colwise().mean() - faces_[0].rest.colwise().mean()).transpose();
  for (std::size_t k = 0; k < 2; ++k) normals_[k] = rest_normal(faces_[k], this->name());
  const auto says = [&](const Vector3& n) { return std::abs(n.dot(line)) > kAcross * line.norm(); };
  if (says(normals_[0]) && normals_[0].dot(line) < 0.0) normals_[0] *= -1.0;
  const bool both = says(normals_[0]) && says(normals_[1]);
  if (normals_[1].dot(both ? line : normals_[0]) < 0.0) normals_[1] *= -1.0;
  if (!about) return;
  about_ = about->normalized();
  for (const Vector3& normal : normals_) {
    if (normal.cross(*about_).norm() > kAcross) continue;
    degenerate(this->name(), "a face's normal lies along the axis",
               "choose an axis across both normals, or none");
  }
}

BendProbe::Pose BendProbe::pose(const Configuration& configuration, std::size_t face) const {
  const Points now = positions(configuration, faces_[face].points);
  const Matrix3 covariance = centred(now).transpose() * centred(faces_[face].rest);
  const Eigen::JacobiSVD<Matrix3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Matrix3 rotation =
      svd.matrixU() * Vector3(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  return {now.colwise().mean().transpose(), rotation * normals_[face]};
}

void BendProbe::measure(const Configuration& configuration, std::span<double> values) const {
  Vector3 a = pose(configuration, 0).normal, b = pose(configuration, 1).normal;
  if (!about_) {
    values[0] = std::atan2(a.cross(b).norm(), a.dot(b));
    return;
  }
  a -= a.dot(*about_) * *about_;
  b -= b.dot(*about_) * *about_;
  values[0] = std::atan2(about_->dot(a.cross(b)), a.dot(b));
}

Points BendProbe::marks(const Configuration& configuration) const {
  Points result(2, 3);
  for (std::size_t k = 0; k < 2; ++k) {
    result.row(static_cast<Eigen::Index>(k)) = pose(configuration, k).middle.transpose();
  }
  return result;
}

ExtentProbe::ExtentProbe(std::string name, std::vector<mechanics::MaterialPoint> points,
                         const Vector3& axis, Way way)
    : Probe(std::move(name), {{"", "m"}}), points_(std::move(points)), axis_(axis), way_(way) {}

ExtentProbe::Span ExtentProbe::largest_span(const Points2& points,
                                            const std::vector<std::size_t>& hull) {
  Span best{0.0, {hull.front(), hull.front()}};
  for (const std::size_t a : hull) {
    for (const std::size_t b : hull) {
      const double reach = (points[b] - points[a]).norm();
      if (reach > best.reach) best = {reach, {a, b}};
    }
  }
  return best;
}

// The smallest extent is normal to an edge of the hull.
ExtentProbe::Span ExtentProbe::smallest_span(const Points2& points,
                                             const std::vector<std::size_t>& hull,
                                             const Span& largest) {
  Span best = largest;
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const std::size_t a = hull[k], b = hull[(k + 1) % hull.size()];
    const Eigen::Vector2d edge = points[b] - points[a];
    if (!(edge.norm() > kShortestEdge * largest.reach)) continue;
    Span farthest{0.0, {a, a}};
    for (const std::size_t c : hull) {
      const Eigen::Vector2d to = points[c] - points[a];
      const double reach = std::abs(edge.x() * to.y() - edge.y() * to.x()) / edge.norm();
      if (reach > farthest.reach) farthest = {reach, {a, c}};
    }
    if (farthest.reach < best.reach) best = farthest;
  }
  return best;
}

ExtentProbe::Span ExtentProbe::span_of(const Configuration& configuration) const {
  const Points now = positions(configuration, points_);
  if (way_ == Way::along) {
    const VectorX height = now * axis_;
    Eigen::Index low = 0, high = 0;
    const double reach = height.maxCoeff(&high) - height.minCoeff(&low);
    return {reach, {static_cast<std::size_t>(low), static_cast<std::size_t>(high)}};
  }
  const Vector3 u = axis_.unitOrthogonal(), v = axis_.cross(u);
  Points2 flat;
  for (Eigen::Index i = 0; i < now.rows(); ++i) flat.emplace_back(now.row(i) * u, now.row(i) * v);
  const std::vector<std::size_t> hull = convex_hull(flat);
  const Span largest = largest_span(flat, hull);
  return way_ == Way::largest_across ? largest : smallest_span(flat, hull, largest);
}

void ExtentProbe::measure(const Configuration& configuration, std::span<double> values) const {
  values[0] = span_of(configuration).reach;
}

Points ExtentProbe::marks(const Configuration& configuration) const {
  const Span span = span_of(configuration);
  return positions(configuration, std::array{points_[span.ends[0]], points_[span.ends[1]]});
}

}  // namespace sinew::constraint
