/// @file
/// Keeps what hands feel from creating energy: a passivity observer and controller in time.
#pragma once

#include "sinew/control/high_rate_settings.hpp"
#include "sinew/core/types.hpp"

namespace sinew::control {

/// A force that is read at a place x_k and held until the next one lags by half a period on
/// average: pressing takes less work than letting go gives back. Of a spring K, a period in which
/// the hand moves by d creates K d^2/2, as a damping of -K T/2 would; a device is passive with a
/// damping b > K T/2 of its own (Colgate & Schenkel, J. Robotic Systems 14 (1997) 37, of a spring
/// alone).
///
/// The observer counts what hands have put in with the force that they really felt (Hannaford &
/// Ryu, IEEE T-RA 18 (2002) 1; by x_k - x_{k-1}, in which it is exact: Ryu, Kim & Hannaford, IEEE
/// T-RO 20 (2004) 772). It is held against the energy that hands would get back now, so that
/// damping comes while energy is created and not at the end (a reference energy, as in Ryu,
/// Preusche, Hannaford & Hirzinger, IEEE T-CST 13 (2005) 737):
///   budget_k = sum of r_{i-1}.(x_i - x_{i-1}) - stored_k.
/// With d the last motion of the hands, foreseen for the next period, the controller adds
///   r_d = need d/|d|^2,   need = (1 + reserve) d^T K d/2 - budget,
/// where need > 0: at constant speed it takes `need` out of the next period. r_d is a damping of at
/// most damping_limit times K T/2; it acts on hands that are held, and never beyond their limits. A
/// hand at rest feels none of it. A surplus ends when nothing is touched any more; what is missing
/// stays.
class PassivityController {
 public:
  /// @param settings outlive it.
  explicit PassivityController(const HighRateSettings& settings);

  /// Takes what hands did in the last period. @param places (hands,) m; not finite: not there.
  /// @param stored J, see TouchLaw::stored().
  void observe(const VectorX& places, double stored);
  /// Adds damping, and remembers the forces that hands now feel. @param stiffness (hands, hands)
  /// N/m, see TouchLaw::hand_stiffness(). @param force (hands,) N, of the hands on the robot, in
  /// and out.
  void damp(const MatrixX& stiffness, Eigen::Ref<VectorX> force);

  double created() const { return created_; }  ///< J, by what hands felt, since construction
  double budget() const { return budget_; }    ///< J
  double damping() const { return damping_; }  ///< N s/m, that was added last
  /// N s/m: mean over the periods in which a hand touched and moved.
  double mean_damping() const { return touched_ > 0 ? damping_sum_ / double(touched_) : 0.0; }

 private:
  const HighRateSettings& settings_;
  VectorX before_, motion_, force_;  // (hands,) m, m, N
  double stored_ = 0.0, budget_ = 0.0, created_ = 0.0, damping_ = 0.0, damping_sum_ = 0.0;
  long touched_ = 0;
};

}  // namespace sinew::control
