#include "sinew/collision/separation.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "sinew/collision/nearest_cores.hpp"

namespace sinew::collision {

namespace {

// Slabs whose thickness differs by less than this, relative to the solids' reach, count as equal:
// faces then come before pairs of edges, and these before iterated directions.
constexpr double kAlike = 1e-12;
// Cores nearer than this, relative to their reach, count as overlapping: the difference of their
// points has too few digits for a normal.
constexpr double kTouching = 1e-9;

bool has_faces(const SymmetricSolid& solid) { return solid.half_size.minCoeff() > 0.0; }

// Looks for the thickest slab among given directions.
class SlabSearch {
 public:
  SlabSearch(const SymmetricSolid& first, const SymmetricSolid& second)
      : first_(first), second_(second), reach_(first.reach() + second.reach()) {}

  double reach() const { return reach_; }
  const Separation& best() const { return best_; }

  bool consider(const Vector3& direction) {
    const double length = direction.norm();
    if (!(length > kAlike * reach_)) return false;
    Vector3 normal = direction / length;
    if (normal.dot(first_.centre - second_.centre) < 0.0) normal = -normal;
    const double gap = slab(first_, second_, normal);
    if (!(gap > best_.gap + kAlike * reach_)) return false;
    best_.gap = gap;
    best_.normal = normal;
    return true;
  }
  // Sets the points from those of the cores, at any shift along the normal. Both share the
  // iteration error.
  void set_points(const Vector3& on_first, const Vector3& on_second) {
    const Vector3 middle =
        0.5 * (on_first - first_.radius * best_.normal + on_second + second_.radius * best_.normal);
    best_.on_first = middle + 0.5 * best_.gap * best_.normal;
    best_.on_second = middle - 0.5 * best_.gap * best_.normal;
  }

  void faces(const SymmetricSolid& solid) {
    if (solid.rim > 0.0) consider(reach_ * solid.axis());
    if (!has_faces(solid)) return;
    for (int k = 0; k < 3; ++k) consider(reach_ * solid.axes.col(k));
  }
  void edge_pairs() {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (!(first_.half_size[i] > 0.0 && second_.half_size[j] > 0.0)) continue;
        const Vector3 across = first_.axes.col(i).cross(second_.axes.col(j));
        if (across.norm() > 1e-7) consider(reach_ * across);
      }
    }
  }
  // Directions from a cylinder's axis through the other solid's corners.
  void radii(const SymmetricSolid& round, const SymmetricSolid& other) {
    if (!(round.rim > 0.0)) return;
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
      const Vector3 out =
          other.centre + other.axes * side.cwiseProduct(other.half_size) - round.centre;
      consider(out - round.axis().dot(out) * round.axis());
    }
  }

 private:
  const SymmetricSolid& first_;
  const SymmetricSolid& second_;
  double reach_;
  Separation best_;
};

// Newton's method for the thickest slab, on the unit sphere or on its circle normal to an edge.
class SlabNewton {
 public:
  SlabNewton(const SymmetricSolid& first, const SymmetricSolid& second)
      : first_(first), second_(second) {}

  Vector3 on_sphere(Vector3 normal) const {
    Eigen::Matrix<double, 3, 2> tangents;
    for (int k = 0; k < kMax; ++k) {
      tangents.col(0) = normal.unitOrthogonal();
      tangents.col(1) = normal.cross(tangents.col(0));
      normal = stepped(normal, tangents);
    }
    return normal;
  }
  Vector3 on_circle(Vector3 normal, const Vector3& edge) const {
    normal = (normal - edge.dot(normal) * edge).normalized();
    for (int k = 0; k < kMax; ++k) normal = stepped(normal, edge.cross(normal).eval());
    return normal;
  }

 private:
  static constexpr int kMax = 5;  // each doubles the digits

  // The slope of the slab is that of the supports, its curvature that of the rims and of the
  // sphere. If the curvature does not belong to a maximum, the normal is kept.
  template <int N>
  Vector3 stepped(const Vector3& normal, const Eigen::Matrix<double, 3, N>& tangents) const {
    using Square = Eigen::Matrix<double, N, N>;
    const Vector3 slope = first_.centre - second_.centre -
                          (first_.core_support(normal) - first_.centre) -
                          (second_.core_support(normal) - second_.centre);
    Square curvature = normal.dot(slope) * Square::Identity();
    for (const SymmetricSolid* solid : {&first_, &second_}) {
      const Vector3 around = solid->axis().cross(normal);
      const double across = around.norm();
      if (!(solid->rim > 0.0 && across > 0.0)) continue;
      const Eigen::Matrix<double, N, 1> along = tangents.transpose() * around / across;
      curvature += solid->rim / across * along * along.transpose();
    }
    if (!(curvature(0, 0) > 0.0 && curvature.determinant() > 0.0)) return normal;
    const Eigen::Matrix<double, N, 1> step = curvature.inverse() * (tangents.transpose() * slope);
    if (!(step.norm() < 0.1)) return normal;
    return (normal + tangents * step).normalized();
  }

  const SymmetricSolid& first_;
  const SymmetricSolid& second_;
};

// Considers a direction, and what Newton's method makes of it.
void consider_polished(const SymmetricSolid& first, const SymmetricSolid& second,
                       const Vector3& direction, SlabSearch& search) {
  constexpr double kNear = 0.01;  // sine
  search.consider(direction);
  if (!(first.rim > 0.0 || second.rim > 0.0)) return;
  const SlabNewton newton(first, second);
  const Vector3 start = direction.normalized();
  search.consider(search.reach() * newton.on_sphere(start));
  for (const SymmetricSolid* solid : {&first, &second}) {
    for (int k = 0; k < 3; ++k) {
      const Vector3 edge = solid->axes.col(k);
      if (!(solid->half_size[k] > 0.0 && std::abs(edge.dot(start)) < kNear)) continue;
      search.consider(search.reach() * newton.on_circle(start, edge));
    }
  }
}

// The normal and the nearest points of overlapping cores, from those of the same cores moved apart.
void turn_to_least_overlap(const SymmetricSolid& first, const SymmetricSolid& second,
                           SlabSearch& search) {
  constexpr int kMax = 20;
  constexpr double kParted = 1e-2;  // the smaller, the fewer turns; bounded by rounding
  const double balls = first.radius + second.radius;
  for (int k = 0; k <= kMax; ++k) {
    const Separation before = search.best();
    const Vector3 shift = (kParted * search.reach() - before.gap - balls) * before.normal;
    const NearestCores nearest = nearest_cores(first, second, shift);
    search.set_points(nearest.on_first - shift, nearest.on_second);
    if (k == kMax || !(first.rim > 0.0 || second.rim > 0.0)) return;
    consider_polished(first, second, nearest.on_first - nearest.on_second, search);
    if (!(search.best().gap > before.gap)) return;
  }
}

}  // namespace

double slab(const SymmetricSolid& first, const SymmetricSolid& second, const Vector3& direction) {
  return direction.dot(first.centre - second.centre) - first.extent(direction) -
         second.extent(direction);
}

Separation separation(const SymmetricSolid& first, const SymmetricSolid& second, double margin) {
  SlabSearch search(first, second);
  search.faces(first);
  search.faces(second);
  search.edge_pairs();
  search.radii(first, second);
  search.radii(second, first);
  if (search.best().gap > margin) return search.best();
  const NearestCores nearest = nearest_cores(first, second);
  const Vector3 between = nearest.on_first - nearest.on_second;
  if (nearest.apart && between.norm() > kTouching * search.reach()) {
    consider_polished(first, second, between, search);
    search.set_points(nearest.on_first, nearest.on_second);
  } else {
    if (search.best().gap == -kInfinity) search.consider(search.reach() * Vector3::UnitZ());
    turn_to_least_overlap(first, second, search);
  }
  return search.best();
}

}  // namespace sinew::collision
