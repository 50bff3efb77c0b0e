/// @file
/// Static equilibrium of an arm that one point of its skin braces against a smooth piece of a
/// surface, as a nonlinear program.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/nonlinear_program.hpp"
#include "sinew/plan/point_derivatives.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// A smooth piece of a surface: a plane n . (p - c) = 0, or |P (p - c)| = R with P the identity (of
/// a ball) or the projection across an axis (of a cylinder). On it the outward normal N(p) =
/// P (p - c)/R is linear in p, so that derivatives of every order are simple.
struct SurfacePatch {
  Matrix3 projection = Matrix3::Zero();        ///< P; of a plane zero
  Vector3 centre = Vector3::Zero();            ///< c, m
  Vector3 normal = Vector3::Zero();            ///< of a plane; else zero
  double radius = 1.0;                         ///< R, m; of a plane any
  Vector3 axis = Vector3::UnitX();             ///< unit length: the piece ends where ...
  double lower = -kNoBound, upper = kNoBound;  ///< ... axis . p leaves these, m

  Vector3 normal_at(const Vector3& p) const { return normal + projection * (p - centre) / radius; }
  /// (|P (p - c)|^2 - R^2)/(2 R), the signed distance to first order; of a plane exactly that.
  double gap(const Vector3& p) const;
};
/// One for a plane or a sphere, three for a capsule: the cylinder and two half balls.
std::vector<SurfacePatch> patches_of(const constraint::SmoothSurface& surface);
/// Second derivative of constraint::distance().
Matrix3 distance_hessian(const constraint::SmoothSurface& surface, const Vector3& point);

/// See BraceProgram.
struct BraceProblem {
  ArmLimits limits;                           ///< completed_limits()
  double turn_lower = 0.0, turn_upper = 0.0;  ///< rad, of the base about the arm's axis
  Vector3 goal = Vector3::Zero();             ///< m
  double tolerance = 2e-3;                    ///< m, > 0
  pcc::ArmPoint point;                        ///< that is braced
  SurfacePatch patch;
  /// Orthonormal directions (3, any) along which the point stays at a place (m); none: it is
  /// anywhere on the patch.
  MatrixX held = MatrixX(3, 0);
  Vector3 place = Vector3::Zero();
  double friction = 0.0;                         ///< mu
  double reserve = 0.0;                          ///< r, N, >= 0, see BraceProgram
  double min_force = 0.0, max_force = kNoBound;  ///< N
  double force_weight = 0.0;                     ///< w_f, 1/N^2
  double tip_weight = 10.0, hold_weight = 10.0;  ///< w_e, w_h
  std::vector<pcc::ArmPoint> clear_points;       ///< that keep ...
  double clearance = 0.0;                        ///< m, away from ...
  std::vector<constraint::SmoothSurface> surfaces;
};

/// min |tau|^2/s^2 + w_f |f|^2 + w_e |e|^2/d^2 - w_h h over x = (q, gamma, tau, h, f), s the
/// largest limit on a torque, e the tip's error and d its tolerance, so that
///   K q + G(q) = B tau + J(q)^T f,
///   gap(p) = 0, p within the patch,   F_n = N(p) . f within its limits,
///   |f|^2 <= F_n^2 + (mu F_n - h r)^2, mu F_n >= h r,    which is |f_t| + h r <= mu F_n,
///   sqrt(|e|^2 + d^2) <= sqrt(2) d,   0 <= h <= 1,
/// and the other points of the skin outside every object. h is how much of the friction's reserve r
/// is there: as much as can be. Where the point is held, u . (p - place) = 0 along every direction
/// u stands for the gap. f (N) is in the frame of the base before it turns by gamma, in which
/// neither the equilibrium nor J knows gamma; p, N and e are the world's, with R(gamma) f in place
/// of f.
class BraceProgram final : public NonlinearProgram {
 public:
  BraceProgram(const std::shared_ptr<const pcc::Arm>& arm, BraceProblem problem);

  int variables() const { return force_ + 3; }
  int turn_index() const { return turn_; }
  int torque_index() const { return torque_; }
  int hold_index() const { return hold_; }
  const BraceProblem& problem() const { return problem_; }

  double objective(const VectorX& x) override;
  void gradient(const VectorX& x, VectorX& result) override;
  void constraints(const VectorX& x, VectorX& result) override;
  void jacobian(const VectorX& x, double* values) override;
  void hessian(const VectorX& x, double factor, const VectorX& multipliers,
               double* values) override;

 private:
  /// Tip, braced point, then those that keep clear, by (q, gamma) in the world; the braced point's
  /// by q before the turn.
  void look(const VectorX& x);
  void add_hessian(const VectorDerivatives& of, const Vector3& weights);
  void add_force_hessian(double by_force, double by_cone, double left);
  /// mu F_n - h r.
  double spare(const VectorX& x) const;
  /// dF_n/dx.
  VectorX force_gradient() const;

  std::shared_ptr<const pcc::Arm> arm_;
  pcc::ArmEquations equations_;
  PointDerivatives points_, velocity_;
  BraceProblem problem_;
  int n_, turn_, torque_, hold_, force_, first_held_, first_clear_;
  double torque_scale_, tip_factor_ = 0.0;
  VectorX still_;
  std::vector<pcc::ArmPoint> looked_at_;

  VectorX looked_;            // x of what follows
  VectorDerivatives braced_;  // before the turn, by q
  std::vector<VectorDerivatives> world_;
  Matrix3 rotation_, spin_;  // R(gamma); [a]x
  Vector3 world_force_, normal_;
  double normal_force_ = 0.0;
  MatrixX dense_;
};

}  // namespace sinew::plan
