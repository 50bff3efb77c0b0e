/// @file
/// One contact with Coulomb friction: its cone, and the exact solution of the laws of a single
/// contact. Vectors are (normal, tangential, tangential). Independent of physics beyond the cone.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// State of a contact in the solution.
enum class ContactState : char {
  open,   ///< no effort
  stick,  ///< effort inside the cone, no tangential motion
  slip,   ///< tangential effort at its limit, against the motion
};
/// "open", "stick", "slip".
const char* contact_state_name(ContactState state);

/// Whether friction is at its limit, to within a relative 1e-7, since solutions are iterative.
/// @param effort (3,), normal first. @param friction >= 0.
bool slides(const Vector3& effort, double friction);

/// Whether friction is at or below this limit, to within a relative 1e-7.
/// @param effort (3,), normal first. @param friction >= 0.
bool at_most(const Vector3& effort, double friction);

/// Euclidean projection onto K = {r : |r_t| <= friction r_n}.
/// @param r (3,). @param friction >= 0.
Vector3 project_on_cone(const Vector3& r, double friction);

/// The laws of one contact: Signorini's and Coulomb's, with an isotropic friction disc. solve()
/// returns the solution r of
///   u = W r + q,   0 <= u_n _|_ r_n >= 0,   |r_t| <= mu r_n,   r_t = -mu r_n u_t/|u_t| if u_t !=
///   0.
///
/// Open: r = 0 is the solution if q_n >= 0. Stick: r = -W^-1 q if that lies in the cone. Otherwise
/// the contact slips (q_n < 0): u_n = 0 and u_t = -s r_t with s > 0. Eliminating
/// r_n = -(q_n + w.r_t)/W_nn gives
///   (S + s I) r_t = -b,   S = W_tt - w w^T/W_nn,   b = q_t - w q_n/W_nn,
/// with S symmetric positive definite, and |r_t(s)| = mu r_n(s), which Bonnefon & Daviet (2011)
/// write as a quartic. It has a root: s = 0 is the solution of sticking, outside the cone, where
/// r_t| > mu r_n; and
///   s_max = |b| (W_nn + mu |w|)/(mu |q_n|)
/// has |r_t| <= mu r_n, since |r_t| <= |b|/s and r_n >= (|q_n| - |w| |r_t|)/W_nn. Both sides are
/// continuous, and any root has r_n = |r_t|/mu >= 0. It is found in the eigenbasis of S by Newton's
/// method on 1/|r_t| - 1/(mu r_n), which is nearly linear in s, safeguarded by the bracket.
class ConeEquation {
 public:
  /// @param w (3, 3), symmetric positive definite. @param friction mu >= 0.
  void set(const Matrix3& w, double friction);
  /// @param q (3,). @return r (3,).
  Vector3 solve(const Vector3& q) const;
  const Matrix3& matrix() const { return w_; }
  double friction() const { return friction_; }

 private:
  Vector3 slip(const Vector3& q) const;

  Eigen::Matrix2d directions_;  // columns: eigenvectors of S
  Eigen::Vector2d coupling_;    // w in the eigenbasis of S
  Eigen::Vector2d values_;      // eigenvalues of S
  double friction_ = 0.0;
  Matrix3 w_, inverse_;
};

}  // namespace sinew::qp
