/// @file
/// Force, moment and motion of a joint.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::sim {

class Simulation;

/// Resultant of a joint's rows on its second body; the first body takes the opposite. Motors,
/// limits and friction are not included.
struct JointLoad {
  Vector3 centre = Vector3::Zero();  ///< (3,) m, on the second body; of a weld, the mean point
  Vector3 force = Vector3::Zero();   ///< (3,) N, on the second body
  Vector3 moment = Vector3::Zero();  ///< (3,) N m, about the centre
  double gap = 0.0;                  ///< m, largest distance of two points that should coincide
};

/// The load after the last step. @param simulation of the model.
/// @param joint index of Model::joints().
JointLoad joint_load(const Simulation& simulation, int joint);

/// Motion of the second body relative to the first, 0 at rest; an angle counts full turns.
/// @param simulation,joint as for joint_load(). @param motion index in JointModel::motions.
/// @return rad or m.
double joint_motion(const Simulation& simulation, int joint, std::size_t motion);

/// Effort of the limits of a motion in the last step, on the second body and in the direction of a
/// growing motion: negative at an upper limit. Zero without limits, and between them.
/// @param simulation,joint,motion as for joint_motion(). @return N m or N.
double joint_limit_effort(const Simulation& simulation, int joint, std::size_t motion);

/// Effort of the joint's friction in the last step, with the same sign; it opposes the motion. Zero
/// without friction. @param simulation,joint as for joint_load(). @return N m or N.
double joint_friction_effort(const Simulation& simulation, int joint);

}  // namespace sinew::sim
