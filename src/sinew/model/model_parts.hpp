/// @file
/// The parts of a model on which its motion depends: their hashes, and their parameters.
#pragma once

#include <vector>

#include "sinew/core/part_visitor.hpp"

namespace sinew::model {

struct ModelData;

/// Hashes of everything that affects how a state evolves, in the order of the model: time step and
/// integrator, bodies, actuators, loads, contacts, joints, motions of bases, effectors. Not
/// included: inputs, initial commands, and solver settings.
std::vector<NamedHash> list_parts(const ModelData& data);

/// The parameters among them, in the same order.
std::vector<Parameter> list_parameters(const ModelData& data);

/// Names the first few parts in which two models differ: "body 'trunk': material, actuator
/// 'long_0'".
std::string describe_difference(const std::vector<NamedHash>& saved,
                                const std::vector<NamedHash>& present);

}  // namespace sinew::model
