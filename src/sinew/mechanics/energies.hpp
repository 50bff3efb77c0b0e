/// @file
/// Energies of a body, or summed over bodies.
#pragma once

namespace sinew::mechanics {

/// Energies, J. Gravity energy is measured from the rest position.
struct Energies {
  double strain = 0.0, kinetic = 0.0, gravity = 0.0;

  double total() const { return strain + kinetic + gravity; }
  Energies& operator+=(const Energies& other) {
    strain += other.strain;
    kinetic += other.kinetic;
    gravity += other.gravity;
    return *this;
  }
};

}  // namespace sinew::mechanics
