/// @file
/// Constants of the certificates of continuous collision detection.
#pragma once

namespace sinew::collision {

/// A time beyond the end of every motion.
inline constexpr double kNever = 2.0;
/// A bound on what products of coordinates lose to underflow.
inline constexpr double kUnderflow = 1e-300;

}  // namespace sinew::collision
