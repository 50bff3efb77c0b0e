/// @file
/// Cables whose points have met.
#pragma once

#include <span>
#include <string>

namespace sinew::constraint {
class Configuration;
}

namespace sinew::sim {

class Model;

/// A taut cable draws its points together. Where two of them meet, its force turns round and no
/// state balances it. Says which piece of which cable is down to a tenth of the mean one:
/// ", and piece 4 of cable 'east' is down to 0.2 mm: ..."; empty where none is.
/// @param model with the cables. @param configuration of its points. @param effort (rows,) N.
std::string describe_folded_cable(const Model& model,
                                  const constraint::Configuration& configuration,
                                  std::span<const double> effort);

}  // namespace sinew::sim
