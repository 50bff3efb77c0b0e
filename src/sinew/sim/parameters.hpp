/// @file
/// The named numbers on which the motion of a simulation depends.
#pragma once

#include <string_view>
#include <vector>

#include "sinew/core/part_visitor.hpp"

namespace sinew::sim {

class Simulation;

/// The parameters of the model (model::Model::parameters()), followed by its inputs at present:
/// `actuators.NAME.command.QUANTITY` of constant commands, `loads.NAME.factor` of constant factors,
/// and `bodies.NAME.stiffness_factor` of bodies whose stiffness can be scaled.
std::vector<Parameter> parameters(const Simulation& simulation);

/// Sets one of the inputs among the parameters from the next step on. Other parameters belong to
/// the model, which simulations share: change them in the scene, or in the settings from which the
/// model is built. @param simulation whose input. @param path as in parameters(). @param value in
/// its unit. Throws Error: unknown-name (with a suggestion), bad-argument (a parameter of the
/// model), and the errors of Simulation::command() and set_stiffness_factor().
void set_parameter(Simulation& simulation, std::string_view path, double value);

}  // namespace sinew::sim
