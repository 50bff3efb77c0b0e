/// @file
/// A motion of the robot that nothing resists: it names what makes a tangent singular.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/statics/free_motion_error.hpp"

namespace sinew::statics {

class StaticSearch;

/// Linearises at the present state with the tangent A + sigma M and condenses it. The inertia M
/// makes A regular where bodies move freely; sigma is so small that it matters to neutral motions
/// only. Begins a motion.
/// @return sigma, 1/s^2; 0 if there is no mass, or if the tangent stays singular.
double condense_nearly_at_rest(StaticSearch& search);

/// Searches a motion v != 0 with v^T K v = 0, where K is the tangent at the present state on the
/// motions that held rows (joints, commanded cables, touching points) leave free. K may be
/// singular, so the search uses the shifted tangent, with T = (K + sigma M)^-1 and inertia M: the
/// power method on T (Golub & Van Loan 2013, sec. 7.3) converges to the motions of least stiffness,
/// and sigma is so small that only rounding lies below it. All motions are searched at once from a
/// vector without symmetry, so the result is a combination of all free motions of similar inertia.
/// Bodies that only turn about their own centres are left out of the search if another one moves.
class FreeMotion {
 public:
  /// @param search of the present state, which does not change; its bodies get linearised.
  explicit FreeMotion(StaticSearch& search);

  /// Whether there is such a motion.
  bool exists() const { return exists_; }
  /// Whether it moves the centre of a body, or deforms it. If not, bodies only turn about their
  /// own centres of mass, on which weight and contact at a sphere do no work: a ball in a bowl.
  bool moves_centres() const { return moves_centres_; }
  /// Indices of the bodies that move.
  const std::vector<std::size_t>& moving() const { return moving_; }
  /// (all bodies' size(),), scaled to a largest entry of 1; empty if there is none.
  const VectorX& motion() const { return motion_; }
  /// Names the bodies and nodes that move, and how: "body 'bar' turns freely about the axis through
  /// (0, 0, 0) m along (0, 1, 0)". Empty if there is no such motion.
  const std::string& text() const { return text_; }
  /// How the nodes of all bodies move; empty if there is no such motion.
  const std::vector<BodyMotion>& bodies() const { return bodies_; }

 private:
  VectorX find(StaticSearch& search);
  void describe(StaticSearch& search, const VectorX& motion);
  void clear();
  void leave_out_spins(VectorX& motion) const;

  std::vector<VectorX> spins_;  // motions that move no centre, orthonormal
  VectorX motion_;
  std::vector<std::size_t> moving_;
  bool exists_ = false, moves_centres_ = false;
  std::string text_;
  std::vector<BodyMotion> bodies_;
};

}  // namespace sinew::statics
