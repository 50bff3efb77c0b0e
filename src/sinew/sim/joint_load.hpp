/// @file
/// What a joint carries, and how far it has moved.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::sim {

class Simulation;

/// What a joint's rows put on its second body, as one; the first body gets the opposite. Motors,
/// limits and friction act beside them.
struct JointLoad {
  Vector3 centre = Vector3::Zero();  ///< (3,) m, of the joint on its second body; of a weld of
                                     ///< points their mean
  Vector3 force = Vector3::Zero();   ///< (3,) N, on the second body
  Vector3 moment = Vector3::Zero();  ///< (3,) N m, about the centre
  double gap = 0.0;                  ///< m, largest distance of two points that should be one
};

/// After the last step. @param simulation of the model. @param joint of Model::joints().
JointLoad joint_load(const Simulation& simulation, int joint);

/// Of the second body in the first one's frame, 0 at rest; whole turns count.
/// @param simulation,joint as for joint_load(). @param motion of JointModel::motions.
/// @return rad or m.
double joint_motion(const Simulation& simulation, int joint, std::size_t motion);

}  // namespace sinew::sim
