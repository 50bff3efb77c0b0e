#include "sinew/collision/nearest_cores.hpp"

#include <array>

#include <Eigen/Geometry>

#include "sinew/collision/closest_points.hpp"

namespace sinew::collision {

namespace {

// A vertex of the Minkowski difference of the two solids, and its two points.
struct Vertex {
  Vector3 difference, on_first, on_second;
};

// The nearest point of a simplex to the origin.
class Simplex {
 public:
  bool has(const Vector3& difference) const {
    for (std::size_t k = 0; k < count_; ++k) {
      if (vertices_[k].difference == difference) return true;
    }
    return false;
  }
  void add(const Vertex& vertex) { vertices_[count_++] = vertex; }

  // Drops the vertices without weight. Returns false if the origin is inside.
  bool reduce() {
    if (count_ == 4 && holds_origin()) return false;
    std::array<double, 4> weights{};
    if (count_ == 1) {
      weights[0] = 1.0;
    } else if (count_ == 2) {
      weights[1] = closest_on_edge(Vector3::Zero(), at(0), at(1)).share;
      weights[0] = 1.0 - weights[1];
    } else {
      weights = over_faces();
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      if (!(weights[k] > 0.0)) continue;
      vertices_[kept] = vertices_[k];
      weights_[kept++] = weights[k];
    }
    count_ = kept;
    return true;
  }

  Vector3 nearest() const { return mix(&Vertex::difference); }
  Vector3 on_first() const { return mix(&Vertex::on_first); }
  Vector3 on_second() const { return mix(&Vertex::on_second); }

 private:
  const Vector3& at(std::size_t k) const { return vertices_[k].difference; }

  Vector3 mix(Vector3 Vertex::*part) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 0; k < count_; ++k) sum += weights_[k] * (vertices_[k].*part);
    return sum;
  }

  bool holds_origin() const {
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3 &a = at((k + 1) % 4), &b = at((k + 2) % 4), &c = at((k + 3) % 4);
      const Vector3 normal = (b - a).cross(c - a);
      if (!(normal.dot(at(k) - a) * normal.dot(-a) > 0.0)) return false;
    }
    return true;
  }

  std::array<double, 4> over_faces() const {
    std::array<double, 4> weights{};
    double least = kInfinity;
    for (std::size_t left_out = 3; left_out < 4; left_out = count_ == 4 ? left_out - 1 : 4) {
      std::array<std::size_t, 3> face{};
      for (std::size_t k = 0, n = 0; k < count_; ++k) {
        if (k != left_out) face[n++] = k;
      }
      const OnTriangle on =
          closest_on_triangle(Vector3::Zero(), at(face[0]), at(face[1]), at(face[2]));
      if (!(on.point.squaredNorm() < least)) continue;
      least = on.point.squaredNorm();
      weights.fill(0.0);
      for (std::size_t k = 0; k < 3; ++k)
        weights[face[k]] = on.weights[static_cast<Eigen::Index>(k)];
    }
    return weights;
  }

  std::array<Vertex, 4> vertices_;
  std::array<double, 4> weights_{};
  std::size_t count_ = 0;
};

}  // namespace

NearestCores nearest_cores(const SymmetricSolid& first, const SymmetricSolid& second,
                           const Vector3& shift) {
  constexpr int kMax = 100;
  constexpr double kTolerance = 1e-14;
  const auto farthest = [&](const Vector3& towards) {
    const Vector3 a = first.core_support(-towards) + shift, b = second.core_support(towards);
    return Vertex{a - b, a, b};
  };
  const Vector3 between = first.centre + shift - second.centre;
  Simplex simplex, before;
  simplex.add(farthest(between.squaredNorm() > 0.0 ? between : Vector3::UnitX().eval()));
  double least = kInfinity;
  bool apart = false;  // known from a plane between
  for (int k = 0; k < kMax; ++k) {
    const bool outside = simplex.reduce();
    const Vector3 nearest = outside ? simplex.nearest() : Vector3::Zero().eval();
    const double square = nearest.squaredNorm();
    if (!apart && !(square > 0.0)) return {};
    // A simplex that is flat to rounding gets no nearer, or seems to contain the origin although a
    // plane separates it.
    if (!(square > 0.0 && square < least)) {
      simplex = before;
      break;
    }
    least = square;
    before = simplex;
    const Vertex next = farthest(nearest);
    apart = apart || nearest.dot(next.difference) > 0.0;
    if (square - nearest.dot(next.difference) <= kTolerance * square) break;
    if (simplex.has(next.difference)) break;
    simplex.add(next);
  }
  return {simplex.on_first(), simplex.on_second(), true};
}

}  // namespace sinew::collision
