/// @file
/// All points at which two shapes may touch, before they are reduced to a few.
#pragma once

#include <array>

#include "sinew/collision/separation.hpp"
#include "sinew/collision/touching_points.hpp"

namespace sinew::collision {

/// What is at a touching point on one of the shapes. Whichever facets are clipped, names are the
/// same.
namespace part {
inline constexpr int kInside = 127;  ///< of a facet, or a place that nothing marks
/// An edge of a box or a line, or one corner of it, twice. @param a,b corners' names.
constexpr int edge(int a, int b) { return a < b ? a + 8 * b : b + 8 * a; }
/// A point of a cylinder's rim. @param end 0 or 1. @param source below 16.
constexpr int rim(int end, int source) { return 64 + 16 * end + source; }
/// The end of a round side beside another one.
constexpr int side_end(int end) { return 96 + end; }
/// The inside of a box's face. @param face below 6.
constexpr int face(int face) { return 100 + face; }
}  // namespace part

/// A name for a touching point; 0 is left for the nearest pair of no such parts.
constexpr int feature_of(int first_part, int second_part) {
  return 1 + first_part + 128 * second_part;
}

/// A list of fixed capacity without repetitions.
class TouchingCandidates {
 public:
  /// @param size m, of both shapes. @param nearest m, the gap of the shapes: what seems to be
  /// deeper by more than iterations leave is no point of theirs. @param margin m: pairs with larger
  /// gaps are left out.
  TouchingCandidates(double size, double nearest, double margin)
      : same_(kSame * size), deepest_(nearest - kNear * same_), margin_(margin) {}

  /// Points that are nearer to each other are one, m.
  double same() const { return same_; }

  void add(const Vector3& on_first, const Vector3& on_second, const Vector3& normal, int feature);
  /// The pair that has the gap of the shapes, after all others. One that clipping found beside it,
  /// up to what iterations leave, gives way to it.
  void add_nearest(const Separation& nearest);
  /// The deepest one, and those farthest from each other.
  TouchingPoints reduced() const;

 private:
  static constexpr std::size_t kMax = 96;
  static constexpr double kSame = 1e-9;  // relative to the size
  static constexpr double kNear = 1e4;   // times same()

  std::size_t farthest(const std::array<double, kMax>& far) const;

  std::array<TouchingPoint, kMax> points_;
  std::size_t size_ = 0;
  double same_, deepest_, margin_;
  double least_ = kInfinity;
};

}  // namespace sinew::collision
