/// @file
/// Candidates for the contact points of two shapes, before they are reduced to a few.
#pragma once

#include <array>

#include "sinew/collision/separation.hpp"
#include "sinew/collision/touching_points.hpp"

namespace sinew::collision {

/// Names of the parts of a shape at a contact point. They do not depend on which facets are
/// clipped.
namespace part {
inline constexpr int kInside = 127;  ///< the interior of a facet, or an unmarked point
/// An edge of a box or a line; a corner, if both names are equal. @param a,b names of corners.
constexpr int edge(int a, int b) { return a < b ? a + 8 * b : b + 8 * a; }
/// A point of a cylinder's rim. @param end 0 or 1. @param source below 16.
constexpr int rim(int end, int source) { return 64 + 16 * end + source; }
/// The end of a round side next to another one.
constexpr int side_end(int end) { return 96 + end; }
/// The interior of a box's face. @param face below 6.
constexpr int face(int face) { return 100 + face; }
}  // namespace part

/// Name of a contact point; 0 is reserved for the nearest pair if it has no such parts.
constexpr int feature_of(int first_part, int second_part) {
  return 1 + first_part + 128 * second_part;
}

/// A list of candidates without repetitions, of fixed capacity.
class TouchingCandidates {
 public:
  /// @param size m, of both shapes. @param nearest m, the gap of the shapes: pairs that appear
  ///   deeper by more than iteration errors are rejected. @param margin m: pairs with larger gaps
  ///   are omitted.
  TouchingCandidates(double size, double nearest, double margin)
      : same_(kSame * size), deepest_(nearest - kNear * same_), margin_(margin) {}

  /// Points within this distance of each other count as one, m.
  double same() const { return same_; }

  void add(const Vector3& on_first, const Vector3& on_second, const Vector3& normal, int feature);
  /// Adds the pair that has the gap of the shapes, after all others. It replaces a clipped
  /// candidate at the same place, up to iteration errors.
  void add_nearest(const Separation& nearest);
  /// The deepest point, and those farthest from each other.
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
