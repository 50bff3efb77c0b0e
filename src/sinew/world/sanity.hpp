/// @file
/// Whether a state can be that of a robot at all.
#pragma once

#include <span>
#include <string>

#include "sinew/mechanics/step_system.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::world {

class World;

/// What shows that a state is unphysical, whatever its residual: an element that is turned inside
/// out (det F <= 0), a chamber without volume (V/V_0 <= 0, inside out), a principal stretch above
/// mechanics::kSaneStretch, or a force that is not finite. The laws of material and chambers have
/// solutions there, which equations alone do not exclude: a chamber with a pressure beyond its peak
/// balances at millions of cubic metres. Positions do not matter.
struct Sanity {
  mechanics::SmallestVolume volume;
  mechanics::LargestStretch stretch;
  int stretched_body = -1;      ///< index of Model::bodies()
  int chamber = -1;             ///< index of Model::actuators() of the chamber without volume
  double chamber_volume = 0.0;  ///< m^3, of that chamber
  bool finite = true;           ///< all efforts

  bool sound() const;
};

/// Examines the present state. @param world with rows formed there. @param effort (rows,) N or Pa.
Sanity examine(World& world, std::span<const double> effort);

/// What is unphysical: "chamber 'air' is turned inside out: its volume is -3.2 ml"; empty if
/// nothing is. @param sanity,model of the state.
std::string describe(const Sanity& sanity, const model::Model& model);

}  // namespace sinew::world
