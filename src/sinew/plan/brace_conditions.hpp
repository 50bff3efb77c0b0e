/// @file
/// When an arm may be braced against an object: three conditions, each a check with its numbers.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// Coulomb's coefficient of static friction of a pair of surfaces, as a range.
struct FrictionRange {
  std::string_view name;
  double min = 0.0, max = 0.0;
};
inline constexpr FrictionRange kCoatedRigid{"coated-rigid", 0.05, 0.20};
inline constexpr FrictionRange kSiliconeOnSteel{"silicone-on-steel", 0.6, 0.9};
/// A range by its name. Throws Error(unknown-choice).
FrictionRange friction_range(std::string_view name);

/// How a body yields where it is touched.
struct TouchStiffness {
  double radial = 0.0;     ///< N/m
  double torsional = 0.0;  ///< N m/rad
};
/// A soft arm's, as published: 1 N/mm and 0.2 N m/rad.
inline constexpr TouchStiffness kSoftArm{1000.0, 0.2};
/// An object that does not yield.
inline constexpr TouchStiffness kRigid{std::numeric_limits<double>::infinity(),
                                       std::numeric_limits<double>::infinity()};

struct BraceCondition {
  enum class Verdict {
    holds,      ///< for every value within what is known
    uncertain,  ///< for some
    violated,   ///< for none
  };
  std::string_view name;  ///< "friction", "stiffness" or "kinematic"
  Verdict verdict = Verdict::violated;
  double value = 0.0;  ///< what is compared
  double limit = 0.0;  ///< with what
};
/// "holds", "uncertain", "violated".
std::string_view verdict_name(BraceCondition::Verdict verdict);

/// F_t < mu_s F_n: it sticks. value F_t/F_n, limit the range's least. Uncertain within the range.
/// @param normal_force,friction_force N. @param friction of the pair.
BraceCondition check_friction(double normal_force, double friction_force,
                              const FrictionRange& friction);
/// k_O >> k_R, radially and in torsion: the arm yields, not the object. value: the lesser ratio.
/// @param object,arm their stiffnesses. @param ratio from which on the one is much more, > 0.
BraceCondition check_stiffness(const TouchStiffness& object, const TouchStiffness& arm,
                               double ratio);
/// The braced point touches, no other point of the skin is inside an object, and the tip is where
/// it is to be. value: the largest of the three errors, m.
/// @param gap m, of the braced point. @param clearance m, the least of the other points.
/// @param tip_excess m, by which the tip is farther from the goal than it may be.
/// @param tolerance m, > 0.
BraceCondition check_kinematics(double gap, double clearance, double tip_excess, double tolerance);

}  // namespace sinew::plan
