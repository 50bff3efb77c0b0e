// Pairs of rigid shapes for tests of contact between shapes.
#pragma once

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/collision/touching_points.hpp"

#include "surfaces.hpp"

namespace sinew::collision::testing {

inline Shape moved(const Shape& shape, const Matrix3& turn, const Vector3& shift) {
  const auto at = [&](const Vector3& x) -> Vector3 { return turn * x + shift; };
  if (const auto* own = std::get_if<Plane>(&shape))
    return Plane{at(own->point), turn * own->normal};
  if (const auto* own = std::get_if<Sphere>(&shape)) return Sphere{at(own->centre), own->radius};
  if (const auto* own = std::get_if<Capsule>(&shape)) {
    return Capsule{at(own->from), at(own->to), own->radius};
  }
  if (const auto* own = std::get_if<Cylinder>(&shape)) {
    return Cylinder{at(own->from), at(own->to), own->radius};
  }
  const auto& own = std::get<OrientedBox>(shape);
  return OrientedBox{at(own.centre), turn * own.axes, own.half_size};
}

inline constexpr int kKinds = 5;

// A shape about 1 m wide, near the origin.
inline Shape random_shape(Random& random, int kind) {
  const auto size = [&] { return random.uniform(0.1, 0.6); };
  const Vector3 half = size() * Vector3::UnitZ();
  Shape shape;
  if (kind == 0) shape = Plane{};
  if (kind == 1) shape = Sphere{Vector3::Zero(), size()};
  if (kind == 2) shape = Capsule{-half, half, size()};
  if (kind == 3) shape = Cylinder{-half, half, size()};
  if (kind == 4)
    shape = OrientedBox{Vector3::Zero(), Matrix3::Identity(), {size(), size(), half[2]}};
  return moved(shape, random_rotation(random), random_point(random, 0.05));
}

inline double least_gap(const TouchingPoints& points) {
  double least = kInfinity;
  for (const TouchingPoint& at : points) least = std::min(least, at.gap);
  return least;
}

inline const TouchingPoint& deepest(const TouchingPoints& points) {
  return *std::min_element(points.begin(), points.end(),
                           [](const auto& a, const auto& b) { return a.gap < b.gap; });
}

// Two shapes of given kinds, the second at a distance `far` from the origin.
struct Pair {
  Shape first, second;
};
inline Pair random_pair(Random& random, int first, int second, double far) {
  Pair pair{random_shape(random, first), random_shape(random, second)};
  Vector3 way = random_point(random).normalized();
  if (first == 0) {  // outside the half space, since it would be deep inside otherwise
    const Vector3 up = std::get<Plane>(pair.first).normal;
    if (way.dot(up) < 0.0) way = -way;
  }
  pair.second = moved(pair.second, Matrix3::Identity(), far * way);
  return pair;
}

// Calls test(pair) for random poses of every pair of kinds.
template <class Test>
void with_every_pair(std::uint64_t seed, int trials, const Test& test) {
  Random random(seed);
  for (int i = 0; i < kKinds; ++i) {
    for (int j = std::max(1, i); j < kKinds; ++j) {
      SCOPED_TRACE(::testing::Message() << "kinds " << i << ' ' << j);
      for (int trial = 0; trial < trials; ++trial) {
        test(random_pair(random, i, j, random.uniform(0.3, 1.5)));
      }
    }
  }
}

// Extent of a shape along a direction, from its definition.
inline double highest(const Shape& shape, const Vector3& up) {
  if (const auto* own = std::get_if<Sphere>(&shape)) return up.dot(own->centre) + own->radius;
  if (const auto* own = std::get_if<Capsule>(&shape)) {
    return std::max(up.dot(own->from), up.dot(own->to)) + own->radius;
  }
  if (const auto* own = std::get_if<Cylinder>(&shape)) {
    const Vector3 axis = (own->to - own->from).normalized();
    return std::max(up.dot(own->from), up.dot(own->to)) + own->radius * axis.cross(up).norm();
  }
  if (const auto* own = std::get_if<OrientedBox>(&shape)) {
    return up.dot(own->centre) + (own->axes.transpose() * up).cwiseAbs().dot(own->half_size);
  }
  const auto& plane = std::get<Plane>(shape);
  return (up - plane.normal).norm() < 1e-9 ? up.dot(plane.point) : kInfinity;
}
// Distance by which the first shape must move along a direction to clear the second; negative if
// apart.
inline double push(const Pair& pair, const Vector3& way) {
  return highest(pair.first, -way) + highest(pair.second, way);
}

}  // namespace sinew::collision::testing
