/// @file
/// What the motion of a robot depends on, by name.
#pragma once

#include <vector>

#include "sinew/core/named_hash.hpp"

namespace sinew::sim {

struct ModelData;

/// Everything that changes how a state goes on, in the order of the model: time step and
/// integrator, bodies, actuators, loads, contacts, joints, motions of bases, effectors. Not part of
/// it: inputs, where a run begins, and how exactly and by which way steps are solved.
std::vector<NamedHash> list_parts(const ModelData& data);

/// "body 'trunk': material, actuator 'long_0'": the parts in which two models differ, the first few
/// of them.
std::string describe_difference(const std::vector<NamedHash>& saved,
                                const std::vector<NamedHash>& present);

}  // namespace sinew::sim
