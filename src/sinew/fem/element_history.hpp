/// @file
/// Strain history at the quadrature points of hyperelastic elements: linear viscoelasticity as a
/// Prony series, and softening.
///
/// The energy psi of the law is the long-term one. With S(C) = 2 dpsi_iso/dC, scaled to unit
/// volume, S~ = J^(2/3) S, and beta_k = g_k / (1 - sum g),
///   S~_total(t) = S~(t) + sum_k beta_k h_k(t),   h_k(t) = integral of exp(-(t - s)/tau_k) dS~(s),
///   P = F J^(-2/3) DEV(S~_total) + p cof F,      DEV(H) = H - 1/3 (H : C) C^-1,
/// so only the isochoric stress relaxes, from 1/(1 - sum g) times that of the law to that of the
/// law itself. (Saint Venant-Kirchhoff is not split: all of its S relaxes, without J and DEV.)
/// In a step h in which S~ changes at a constant rate, with x = h/tau and a = (1 - exp(-x))/x,
///   h_k <- exp(-x) h_k + a (S~_new - S~_old),
///   S~_total = (1 + sum beta_k a_k) S~_new + H,   H = sum beta_k (exp(-x_k) h_k - a_k S~_old),
/// H is constant during the step, so its force derives from the energy 1/2 J^(-2/3) H : C, and the
/// tangent is symmetric. The scheme is objective, since the stresses refer to the material frame,
/// and h may change from step to step. In statics h_k = 0, and S~ is that of the law.
///
/// Softening (material::MullinsEffect) keeps W_m, the largest energy psi_iso reached so far, and
/// acts on psi and S before they relax. W_m is constant during a step; energies above it are first
/// loading.
///
/// Sources: Simo, CMAME 60, 1987, sections 2 and 4; Simo, Hughes, "Computational Inelasticity",
/// 1998, section 10.3 (with a midpoint in place of a); the recurrence: Taylor, Pister, Goudreau,
/// Int. J. Numer. Meth. Engng 2, 1970.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/fem/solid_kernel.hpp"

namespace sinew::fem {

/// Strain history of one body, a part of its state. Empty if no law relaxes or softens.
class ElementHistory {
 public:
  /// @param groups of the body; must outlive this.
  explicit ElementHistory(std::span<const SolidGroup> groups);

  bool empty() const { return state_.empty(); }

  /// Computes H for a step of `time_step` (s, > 0), or for statics (0).
  void begin_step(double time_step);
  /// H, 1 + sum beta_k a_k and W_m, for the forces of the step that begin_step() began.
  /// @param group position among the groups of the body.
  /// @param softened false: without softening, as if no earlier strain had been larger.
  PointHistory of_step(std::size_t group, bool softened) const;
  /// The current history, for stresses outside of steps. @param group position among the groups.
  /// @param overstress memory for sum beta_k h_k; must outlive the result.
  PointHistory present(std::size_t group, std::vector<LaneRow>& overstress) const;

  /// Ends the step that begin_step() began, for batches begin .. end-1 of a group.
  /// @param group position among the groups of the body. @param begin,end which batches.
  /// @param points (n, 4) m, positions padded to four.
  void end_step(std::size_t group, int begin, int end, const double* points);

  /// Resets to the unstrained state at rest.
  void reset();
  std::size_t size() const { return material::kLanes * state_.size(); }
  void save(std::span<double> state) const;  ///< (size(),)
  void load(std::span<const double> state);  ///< (size(),)

 private:
  const LaneRow* peak(std::size_t group) const;

  /// Position of the data of a group.
  struct Part {
    std::size_t points = 0;         ///< of all its batches; 0: no history
    std::size_t first = 0;          ///< in state_: S~, then h_1, h_2, ... of each point
    std::size_t first_peak = 0;     ///< in state_: W_m of each point
    std::size_t first_carried = 0;  ///< in carried_
    bool relaxes = false, softens = false;
    double factor = 1.0;
    std::vector<double> weight, time;  ///< beta_k, tau_k
    std::vector<double> decay, rise;   ///< exp(-x_k), a_k of the step
  };

  std::span<const SolidGroup> groups_;
  std::vector<Part> parts_;
  std::vector<LaneRow> state_, carried_;
  bool relaxed_ = true;  ///< in statics
};

}  // namespace sinew::fem
