/// @file
/// Passivity observer and controller in the time domain: keeps the forces on hands from creating
/// energy.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/high_rate/high_rate_settings.hpp"

namespace sinew::high_rate {

/// Passivity controller of the hands. A force that is computed at a position x_k and held until the
/// next one lags by half a period on average, so pressing takes less work than letting go returns.
/// For a spring K, a period in which the hand moves by d creates K d^2/2, as a damping of -K T/2
/// would; a device with a damping b > K T/2 of its own is passive (Colgate & Schenkel, J. Robotic
/// Systems 14 (1997) 37, for a spring alone).
///
/// The observer integrates the work that hands have done against the forces that they felt
/// (Hannaford & Ryu, IEEE T-RA 18 (2002) 1; with x_k - x_{k-1}, for which it is exact: Ryu, Kim &
/// Hannaford, IEEE T-RO 20 (2004) 772). It subtracts the energy that hands would now get back, so
/// that damping acts while energy is created and not only at the end (a reference energy, as in
/// Ryu, Preusche, Hannaford & Hirzinger, IEEE T-CST 13 (2005) 737):
///   budget_k = sum of r_{i-1}.(x_i - x_{i-1}) - stored_k.
/// With d the last motion of the hands, taken as the prediction for the next period, the controller
/// adds
///   r_d = need d/|d|^2,   need = (1 + reserve) d^T K d/2 - budget,
/// if need > 0. At constant speed, this dissipates `need` in the next period. r_d is a damping of
/// at most damping_limit times K T/2. It acts on held hands only, never beyond their limits, and
/// not on a hand at rest. A surplus is discarded when nothing is touched any more; a deficit stays.
class PassivityController {
 public:
  /// @param settings must outlive this object.
  explicit PassivityController(const HighRateSettings& settings);

  /// Updates the budget with the motion of the hands in the last period.
  /// @param places (hands,) m; not finite: no hand. @param stored J, see TouchLaw::stored().
  void observe(const VectorX& places, double stored);
  /// Adds damping, and remembers the forces that hands now feel.
  /// @param stiffness (hands, hands) N/m, see TouchLaw::hand_stiffness().
  /// @param force (hands,) N, of the hands on the robot; damping is added in place.
  void damp(const MatrixX& stiffness, Eigen::Ref<VectorX> force);

  double created() const { return created_; }  ///< J, by the forces felt, since construction
  double budget() const { return budget_; }    ///< J
  double damping() const { return damping_; }  ///< N s/m, added last
  /// Mean damping over the periods in which a hand touched and moved, N s/m.
  double mean_damping() const { return touched_ > 0 ? damping_sum_ / double(touched_) : 0.0; }

 private:
  const HighRateSettings& settings_;
  VectorX before_, motion_, force_;  // (hands,) m, m, N
  double stored_ = 0.0, budget_ = 0.0, created_ = 0.0, damping_ = 0.0, damping_sum_ = 0.0;
  long touched_ = 0;
};

}  // namespace sinew::high_rate
