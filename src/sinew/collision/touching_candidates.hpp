/// @file
/// All points at which two shapes may touch, before they are reduced to a few.
#pragma once

#include <array>

#include "sinew/collision/separation.hpp"
#include "sinew/collision/touching_points.hpp"

namespace sinew::collision {

/// Stands for a round side in place of a facet's number.
inline constexpr int kRoundSide = 7;

/// A name for a touching point; 0 is left for the nearest pair of no facets.
/// @param first_facet,second_facet below 8. @param source below 16: which point of one of them.
int feature_of(int first_facet, int second_facet, bool of_first, int source);

/// A list of fixed capacity without repetitions.
class TouchingCandidates {
 public:
  /// @param size m, of both shapes. @param margin m: pairs with larger gaps are left out.
  TouchingCandidates(double size, double margin) : same_(kSame * size), margin_(margin) {}

  /// Points that are nearer to each other are one, m.
  double same() const { return same_; }

  void add(const Vector3& on_first, const Vector3& on_second, const Vector3& normal, int feature);
  /// The pair that has the gap of the shapes, after all others. One that clipping found beside it,
  /// up to what iterations leave, gives way to it.
  void add_nearest(const Separation& nearest);
  /// The deepest one, and those farthest from each other.
  TouchingPoints reduced() const;

 private:
  static constexpr std::size_t kMost = 96;
  static constexpr double kSame = 1e-9;  // relative to the size

  std::size_t farthest(const std::array<double, kMost>& far) const;

  std::array<TouchingPoint, kMost> points_;
  std::size_t size_ = 0;
  double same_, margin_;
  double least_ = kInfinity;
};

}  // namespace sinew::collision
