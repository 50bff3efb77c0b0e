/// @file
/// Diagnosis of cables that have folded.
#pragma once

#include <span>
#include <string>

namespace sinew::constraint {
class Configuration;
}

namespace sinew::model {
class Model;
}

namespace sinew::world {

/// A taut cable pulls its points together. Where two of them meet, its force changes direction and
/// no equilibrium exists. Reports the cable segment that has shrunk most, if to less than a tenth
/// of the mean segment length:
/// ", and piece 4 of cable 'east' is down to 0.2 mm: ..."; empty if there is none.
/// @param model with the cables. @param configuration of its points. @param effort (rows,) N.
std::string describe_folded_cable(const model::Model& model,
                                  const constraint::Configuration& configuration,
                                  std::span<const double> effort);

}  // namespace sinew::world
