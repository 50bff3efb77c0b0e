/// @file
/// Cables whose points have met.
#pragma once

#include <string>

namespace sinew::sim {

class Simulation;

/// A taut cable draws its points together. Where two of them meet, its force turns round and no
/// state balances it. Says which piece of which cable is down to a tenth of the mean one:
/// ", and piece 4 of cable 'east' is down to 0.2 mm: ..."; empty where none is.
std::string describe_folded_cable(const Simulation& simulation);

}  // namespace sinew::sim
