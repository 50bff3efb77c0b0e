#include "sinew/builder/lid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

#include "sinew/linalg/dense.hpp"

namespace sinew::builder {

namespace {

/// Nodes within this fraction of the size of the rim count as in a plane.
constexpr double kPlane = 1e-4;
/// Planes whose normals span less than this volume do not meet in a point.
constexpr double kParallel = 1e-2;

struct Plane {
  Vector3 normal = Vector3::Zero(), point = Vector3::Zero();
  double distance(const Vector3& x) const { return std::abs(normal.dot(x - point)); }
};

/// The planes of a rim: one, or up to three that bound the body.
class Planes {
 public:
  Planes(const Rim& rim, const Points& body)
      : rim_(rim), body_(body), covered_(rim.corners.size(), 0) {
    double size = 0.0;
    for (const Vector3& x : rim.corners) size = std::max(size, (x - rim.corners[0]).norm());
    tolerance_ = kPlane * size;
    take(find(false));
    if (all_covered()) return;
    planes_.clear();
    covered_.assign(covered_.size(), 0);
    while (planes_.size() < 3 && !all_covered() && take(find(true))) continue;
  }

  bool all_covered() const {
    return std::ranges::all_of(covered_, [](char covered) { return covered != 0; });
  }
  const std::vector<Plane>& found() const { return planes_; }
  bool has(const Plane& plane, const Vector3& x) const { return plane.distance(x) <= tolerance_; }

 private:
  std::size_t count() const { return rim_.corners.size(); }
  const Vector3& corner(std::size_t k) const { return rim_.corners[k % count()]; }
  bool has_edge(const Plane& plane, std::size_t k) const {
    return has(plane, corner(k)) && has(plane, corner(k + 1)) &&
           (rim_.middles.empty() || has(plane, rim_.middles[k]));
  }

  bool take(const Plane& plane) {
    if (plane.normal.isZero(0.0)) return false;
    for (std::size_t k = 0; k < covered_.size(); ++k) {
      if (has_edge(plane, k)) covered_[k] = 1;
    }
    planes_.push_back(plane);
    return true;
  }

  bool bounds_body(const Plane& plane) const {
    const VectorX heights = (body_.rowwise() - plane.point.transpose()) * plane.normal;
    return heights.minCoeff() >= -tolerance_ || heights.maxCoeff() <= tolerance_;
  }

  /// The plane with most edges that no plane has yet, among those through three corners at equal
  /// distances along the rim. @param bounding whether it must bound the body.
  Plane find(bool bounding) const {
    Plane best;
    long most = 0;
    for (std::size_t apart = 1; 2 * apart < count(); apart += 1 + apart / 2) {
      for (std::size_t k = 0; k < count(); ++k) {
        const Vector3 a = corner(k + apart) - corner(k), b = corner(k + 2 * apart) - corner(k);
        const Vector3 across = a.cross(b);
        if (across.norm() <= kParallel * a.norm() * b.norm()) continue;
        const Plane plane{across.normalized(), corner(k)};
        long edges = 0;
        for (std::size_t e = 0; e < count(); ++e) {
          if (covered_[e] == 0 && has_edge(plane, e)) ++edges;
        }
        if (edges <= most || (bounding && !bounds_body(plane))) continue;
        most = edges;
        best = plane;
      }
    }
    return best;
  }

  const Rim& rim_;
  const Points& body_;
  std::vector<char> covered_;
  std::vector<Plane> planes_;
  double tolerance_ = 0.0;
};

std::vector<double> mean_of(const std::vector<char>& chosen) {
  const auto count = static_cast<double>(std::ranges::count(chosen, 1));
  std::vector<double> weights;
  for (const char one : chosen) weights.push_back(one != 0 ? 1.0 / count : 0.0);
  return weights;
}

/// The smallest weights of the held corners with sum 1 and mean `point`: w = B^T (B B^T)^+ r with
/// the columns (x - point, 1) of B and r = (0, 0, 0, 1). Lengths count relative to the rim.
std::optional<std::vector<double>> mean_at(const Rim& rim, const Vector3& point) {
  std::vector<double> weights(rim.corners.size(), 0.0);
  double size = 0.0;
  for (const Vector3& x : rim.corners) size = std::max(size, (x - point).norm());
  MatrixX products = MatrixX::Zero(4, 4);
  const auto column = [&](std::size_t k) {
    VectorX result(4);
    result << (rim.corners[k] - point) / size, 1.0;
    return result;
  };
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (rim.held[k] != 0) products += column(k) * column(k).transpose();
  }
  const VectorX solution = linalg::pseudo_inverse(products).col(3);
  Vector3 at = Vector3::Zero();
  double sum = 0.0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (rim.held[k] == 0) continue;
    weights[k] = column(k).dot(solution);
    sum += weights[k];
    at += weights[k] * (rim.corners[k] - point);
  }
  if (!(std::abs(sum - 1.0) < kPlane) || !(at.norm() < kPlane * size)) return std::nullopt;
  for (double& weight : weights) weight /= sum;
  return weights;
}

std::optional<Vector3> meeting_point(const std::vector<Plane>& planes) {
  Matrix3 normals;
  Vector3 offsets;
  for (int p = 0; p < 3; ++p) {
    const Plane& plane = planes[static_cast<std::size_t>(p)];
    normals.row(p) = plane.normal.transpose();
    offsets[p] = plane.normal.dot(plane.point);
  }
  const double determinant = normals.row(0).dot(normals.row(1).cross(normals.row(2)));
  if (std::abs(determinant) < kParallel) return std::nullopt;
  Vector3 point = Vector3::Zero();
  for (int p = 0; p < 3; ++p) {
    const Vector3 across =
        normals.row((p + 1) % 3).transpose().cross(normals.row((p + 2) % 3).transpose());
    point += offsets[p] / determinant * across;
  }
  return point;
}

}  // namespace

std::optional<std::vector<double>> find_hub(const Rim& rim, const Points& body) {
  const Planes planes(rim, body);
  if (!planes.all_covered()) return std::nullopt;
  std::vector<char> on_all;
  for (const Vector3& x : rim.corners) {
    const bool on = std::ranges::all_of(planes.found(),
                                        [&](const Plane& plane) { return planes.has(plane, x); });
    on_all.push_back(on ? 1 : 0);
  }
  if (std::ranges::count(on_all, 1) > 0) return mean_of(on_all);
  if (planes.found().size() < 3) return std::nullopt;
  const std::optional<Vector3> point = meeting_point(planes.found());
  return point ? mean_at(rim, *point) : std::nullopt;
}

RimShape rim_shape(const Rim& rim) {
  RimShape shape;
  const Vector3& origin = rim.corners.front();
  for (std::size_t k = 0; k < rim.corners.size(); ++k) {
    const Vector3 a = rim.corners[k] - origin,
                  b = rim.corners[(k + 1) % rim.corners.size()] - origin;
    shape.area += 0.5 * a.cross(b);
  }
  const Vector3 normal = shape.area.normalized();
  double low = 0.0, high = 0.0;
  for (const auto* nodes : {&rim.corners, &rim.middles}) {
    for (const Vector3& x : *nodes) {
      low = std::min(low, normal.dot(x - origin));
      high = std::max(high, normal.dot(x - origin));
    }
  }
  shape.rise = high - low;
  return shape;
}

}  // namespace sinew::builder
