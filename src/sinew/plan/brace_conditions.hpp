/// @file
/// The three conditions under which an arm may be braced against an object.
#pragma once

#include <array>
#include <limits>
#include <string_view>

#include "sinew/core/types.hpp"

namespace sinew::plan {

/// Range of the coefficient of static friction of a pair of surfaces.
struct FrictionRange {
  std::string_view name;
  double min = 0.0, max = 0.0;
};
inline constexpr FrictionRange kCoatedRigid{"coated-rigid", 0.05, 0.20};
inline constexpr FrictionRange kSiliconeOnSteel{"silicone-on-steel", 0.6, 0.9};
/// The range of this name. Throws Error(unknown-choice).
FrictionRange friction_range(std::string_view name);

/// Stiffness of a body at the point of contact.
struct TouchStiffness {
  double radial = 0.0;     ///< N/m
  double torsional = 0.0;  ///< N m/rad
};
/// Published stiffness of a soft arm: 1 N/mm and 0.2 N m/rad.
inline constexpr TouchStiffness kSoftArm{1000.0, 0.2};
/// Stiffness of a rigid object.
inline constexpr TouchStiffness kRigid{std::numeric_limits<double>::infinity(),
                                       std::numeric_limits<double>::infinity()};

/// The result of checking one condition.
struct BraceCondition {
  enum class Verdict {
    holds,      ///< for all values in the known range
    uncertain,  ///< for some values
    violated,   ///< for no value
  };
  std::string_view name;  ///< "friction", "stiffness" or "kinematic"
  Verdict verdict = Verdict::violated;
  double value = 0.0;  ///< the value that is compared ...
  double limit = 0.0;  ///< ... with this limit
};
/// "holds", "uncertain", "violated".
std::string_view verdict_name(BraceCondition::Verdict verdict);

/// Checks that the point sticks, F_t < mu_s F_n. The value is F_t/F_n, and the limit is the minimum
/// of mu_s; the verdict is uncertain within the range of mu_s.
/// @param normal_force,friction_force N. @param friction of the pair.
BraceCondition check_friction(double normal_force, double friction_force,
                              const FrictionRange& friction);
/// Checks k_O >> k_R, radially and in torsion, so that the arm yields and not the object. The value
/// is the smaller ratio. @param object,arm stiffnesses. @param ratio required at least, > 0.
BraceCondition check_stiffness(const TouchStiffness& object, const TouchStiffness& arm,
                               double ratio);
/// Checks that the braced point touches, that no other point of the skin is inside an object, and
/// that the tip is at its goal. The value is the largest of the three errors, m.
/// @param gap m, of the braced point. @param clearance m, minimum over the other points.
/// @param tip_excess m, distance of the tip from the goal beyond its tolerance.
/// @param tolerance m, > 0, of the errors.
BraceCondition check_kinematics(double gap, double clearance, double tip_excess, double tolerance);

}  // namespace sinew::plan
