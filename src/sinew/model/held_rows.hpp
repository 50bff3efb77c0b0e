/// @file
/// Whether the integrator can hold motions.
#pragma once

#include <string>

#include "sinew/model/step_settings.hpp"

namespace sinew::model {

struct ModelData;

/// Largest spectral radius of generalized-alpha with which a motion can be held.
inline constexpr double kMaxHeldRadius = 0.95;

/// Whether errors of the efforts of held rows would persist, see check_held_radius().
bool keeps_effort_errors(const StepSettings& step);

/// Refuses generalized-alpha with a spectral radius above kMaxHeldRadius for a robot with a held
/// row, whose effort is whatever keeps its motion at a given value: a joint, a weld, a motor, a
/// cable of commanded length.
///
/// With d = 0 on such a row, the step's formulas (mechanics::step_weights) leave for errors of v h,
/// a' h^2 and a h^2 from step to step
///   a' <- -((1/2 - beta)/beta) a' - v/beta,   v <- v + (1 - gamma) a' + gamma a'_new,
///   (1 - alpha_f) a_new = (1 - alpha_m) a'_new + alpha_m a' - alpha_f a,
/// whose three eigenvalues are -rho (Arnold & Bruels, Multibody Syst. Dyn. 18, 2007, sec. 3). The
/// effort inherits the error of a times the mass. At rho = 1, errors alternate and grow with the
/// square of the number of steps; at 0.95 they are gone after a few hundred steps. Impacts are no
/// such rows: their steps restart the formula.
/// Throws Error(out_of_range), with the place of the integrator.
/// @param step settings of the robot. @param held what holds a motion, as "joint 'elbow' holds".
void check_held_radius(const StepSettings& step, const std::string& held);

/// The same for the joints of a model and the commands with which its actuators start.
void check_held_radius(const ModelData& data);

}  // namespace sinew::model
