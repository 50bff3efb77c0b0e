/// @file
/// Excitation signals for identification: sums of sines with the spectrum of ocean waves.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::pcc {

/// Bretschneider's spectrum (C. L. Bretschneider, US Army Beach Erosion Board TM-118, 1959, in the
/// form of the ITTC), one-sided, per rad/s:
///   S(w) = (1.25/4) (w_p^4/w^5) zeta^2 exp(-1.25 (w_p/w)^4),
/// whose integral over all frequencies is zeta^2/16.
struct BretschneiderSpectrum {
  double peak = 6.283185307179586;  ///< w_p, rad/s, > 0
  double height = 0.0;              ///< zeta, > 0: "significant height", four standard deviations

  double density(double frequency) const;  ///< S, unit^2 s/rad. @param frequency rad/s, > 0.
  /// Integral of S from 0 to w, zeta^2/16 exp(-1.25 (w_p/w)^4). @param frequency w, rad/s, >= 0.
  double energy(double frequency) const;
};

struct ExcitationSettings {
  double peak_frequency = 1.0;  ///< Hz, w_p / 2 pi
  double amplitude = 1.0;       ///< V_max > 0; zeta = 2 V_max, so the standard deviation is V_max/2
  double lowest = 0.4, highest = 4.0;  ///< Hz, band of the sines
  int sines = 40;
  std::uint64_t seed = 1;
};

/// The signal sum_i A_i sin(w_i t + phi_i). The band is divided into parts of equal width, one for
/// each sine. w_i is drawn uniformly from its part and phi_i uniformly from a full turn. A_i^2/2 is
/// the energy of the spectrum in the part, so that the sum has this energy for every draw.
class Excitation {
 public:
  struct Sine {
    double amplitude = 0.0, frequency = 0.0, phase = 0.0;  ///< unit, rad/s, rad
  };

  /// Throws Error(out-of-range) for an invalid amplitude, frequency or number of sines.
  explicit Excitation(const ExcitationSettings& settings);

  const std::vector<Sine>& sines() const { return sines_; }
  double at(double time) const;                ///< @param time s
  VectorX sample(const VectorX& times) const;  ///< @param times s

 private:
  std::vector<Sine> sines_;
};

}  // namespace sinew::pcc
