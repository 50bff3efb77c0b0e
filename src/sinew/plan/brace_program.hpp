/// @file
/// Static equilibrium of an arm that is braced by one point of its skin against a smooth piece of a
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

/// A smooth piece of a surface: a plane n . (p - c) = 0, or |P (p - c)| = R where P is the identity
/// (sphere) or the projection perpendicular to an axis (cylinder). Its outward normal
/// N(p) = P (p - c)/R is linear in p, so derivatives of all orders are simple.
struct SurfacePatch {
  Matrix3 projection = Matrix3::Zero();        ///< P; zero for a plane
  Vector3 centre = Vector3::Zero();            ///< c, m
  Vector3 normal = Vector3::Zero();            ///< of a plane; otherwise zero
  double radius = 1.0;                         ///< R, m; any value for a plane
  Vector3 axis = Vector3::UnitX();             ///< unit length; the piece is bounded by ...
  double lower = -kNoBound, upper = kNoBound;  ///< ... lower <= axis . p <= upper, m

  Vector3 normal_at(const Vector3& p) const { return normal + projection * (p - centre) / radius; }
  /// The gap (|P (p - c)|^2 - R^2)/(2 R), the signed distance to first order; for a plane it is
  /// exact.
  double gap(const Vector3& p) const;
};
/// The smooth pieces of a surface: one for a plane or sphere, three for a capsule (cylinder and two
/// hemispheres).
std::vector<SurfacePatch> patches_of(const constraint::SmoothSurface& surface);
/// Second derivative of the gap of constraint::distance().
Matrix3 distance_hessian(const constraint::SmoothSurface& surface, const Vector3& point);

/// The data of a BraceProgram.
struct BraceProblem {
  ArmLimits limits;                           ///< completed_limits()
  double turn_lower = 0.0, turn_upper = 0.0;  ///< rad, of the base about the arm's axis
  Vector3 goal = Vector3::Zero();             ///< m
  double tolerance = 2e-3;                    ///< m, > 0
  pcc::ArmPoint point;                        ///< the braced point
  SurfacePatch patch;
  /// Orthonormal directions (3, any) along which the point is held at `place` (m). None: the point
  /// may be anywhere on the patch.
  MatrixX held = MatrixX(3, 0);
  Vector3 place = Vector3::Zero();
  double friction = 0.0;                         ///< mu
  double reserve = 0.0;                          ///< r, N, >= 0, see BraceProgram
  double min_force = 0.0, max_force = kNoBound;  ///< N
  double force_weight = 0.0;                     ///< w_f, 1/N^2
  double tip_weight = 10.0, hold_weight = 10.0;  ///< w_e, w_h
  std::vector<pcc::ArmPoint> clear_points;       ///< points that keep at least ...
  double clearance = 0.0;                        ///< m, from the surfaces
  std::vector<constraint::SmoothSurface> surfaces;
};

/// Minimises |tau|^2/s^2 + w_f |f|^2 + w_e |e|^2/d^2 - w_h h over x = (q, gamma, tau, h, f), where
/// s is the largest limit on a torque, e the error of the tip and d its tolerance, subject to
///   K q + G(q) = B tau + J(q)^T f,
///   gap(p) = 0, p within the patch,   F_n = N(p) . f within its limits,
///   |f|^2 <= F_n^2 + (mu F_n - h r)^2, mu F_n >= h r,    that is |f_t| + h r <= mu F_n,
///   sqrt(|e|^2 + d^2) <= sqrt(2) d,   0 <= h <= 1,
/// with the other skin points outside every object. h is the available fraction of the friction
/// reserve r, and is maximised. If the point is held, u . (p - place) = 0 for every direction u
/// replaces the gap. f (N) is in the frame of the base before its rotation by gamma, so that
/// neither the equilibrium nor J depends on gamma. p, N and e are in the world frame, where the
/// force is R(gamma) f.
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
  /// Evaluates points at x: in the world by (q, gamma), the tip, the braced point and the clear
  /// points; and before the rotation by q, the braced point.
  void look(const VectorX& x);
  void add_hessian(const VectorDerivatives& of, const Vector3& weights);
  void add_force_hessian(double by_force, double by_cone, double left);
  /// The spare friction mu F_n - h r.
  double spare(const VectorX& x) const;
  /// The gradient dF_n/dx.
  VectorX force_gradient() const;

  std::shared_ptr<const pcc::Arm> arm_;
  pcc::ArmEquations equations_;
  PointDerivatives points_, velocity_;
  BraceProblem problem_;
  int n_, turn_, torque_, hold_, force_, first_held_, first_clear_;
  double torque_scale_, tip_factor_ = 0.0;
  VectorX still_;
  std::vector<pcc::ArmPoint> looked_at_;

  VectorX looked_;            // x of the results below
  VectorDerivatives braced_;  // before the rotation, by q
  std::vector<VectorDerivatives> world_;
  Matrix3 rotation_, spin_;  // R(gamma); [a]x
  Vector3 world_force_, normal_;
  double normal_force_ = 0.0;
  MatrixX dense_;
};

}  // namespace sinew::plan
