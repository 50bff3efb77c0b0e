/// @file
/// Loads on a rigid body.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/rigid/rigid_state.hpp"

namespace sinew::rigid {

/// A force of constant direction and magnitude at a point of the body, at a load factor of 1. It is
/// the resultant of any DeadLoad whose forces have one direction.
struct PointForce {
  Vector3 force = Vector3::Zero();  ///< N
  Vector3 arm = Vector3::Zero();    ///< m, from the centre of mass, at rest in the world's axes
};

/// Evaluates the loads of one body in its steps. With x_i = c + r_i, r_i = R r_0i, the forces f_i
/// on points or nodes of its surface, as a function of positions and their rates, enter b as
///   J_i^T f_i,   J_i = [1, -[r_i]/s],
/// where s is the turning radius, and A as
///   J_i^T K_i J_i,   K_i = -d f_i/d x_i,
///   -[f_i] [r_i]/s^2 for rotations, since the moment r x f changes with r (see RigidStep), or, for
///   a force that turns with the body, [f_i]/s (forces) and [r_i x f_i]/s^2 (moments).
///
/// Iterations take a symmetric A: that of all forces on the body is exact at a solution if they
/// have a potential, and motions that joints leave free are judged by it. The derivative of rates
/// with respect to a rotation within the step is taken to be that of its start, which costs
/// iterations but no accuracy.
class RigidLoads {
 public:
  /// @param state must outlive this.
  explicit RigidLoads(const RigidState& state) : state_(state) {}

  /// Adds the forces to b, and their stiffness to A.
  /// @param request tangent and weights. @param right (6,). @param matrix (6, 6).
  /// @return N, the size of the forces.
  double add(const mechanics::LinearisationRequest& request, VectorX& right, MatrixX& matrix);
  /// Evaluates the loads at the end of the step, and adds their work and what drag dissipates.
  void count_work(const mechanics::StepWeights& weights, mechanics::StepEnd& end);

  /// Sum of the forces, N, and of their moments about the centre of mass, N m, of the last
  /// evaluation.
  const mechanics::Wrench& resultant() const { return resultant_; }
  std::size_t bytes() const;

 private:
  // Sums of forces f, N, and of dyads r f^T, N m, with the arms r from the centre of mass.
  struct Sum {
    Vector3 force = Vector3::Zero();
    Matrix3 dyads = Matrix3::Zero();

    void add(const Vector3& own, const Vector3& arm) {
      force += own;
      dyads += arm * own.transpose();
    }
    Sum operator+(const Sum& other) const { return {force + other.force, dyads + other.dyads}; }
    // sum r x f
    Vector3 moment() const {
      return {dyads(1, 2) - dyads(2, 1), dyads(2, 0) - dyads(0, 2), dyads(0, 1) - dyads(1, 0)};
    }
  };

  void evaluate(const mechanics::LinearisationRequest& request);
  void evaluate_faces(const mechanics::LinearisationRequest& request);
  void refuse_open_pressure() const;
  Matrix6 symmetric_stiffness() const;
  void find_rates(const mechanics::LinearisationRequest& request);
  void add_slope(const Matrix3& slope, const Vector3& arm);
  Vector3 rate_at(const Vector6& rate, const Vector3& arm) const;

  const RigidState& state_;
  mechanics::Wrench resultant_;
  Matrix6 stiffness_ = Matrix6::Zero();
  Sum steady_, turning_, drag_;  // of forces that keep their direction, or turn with the body
  std::vector<double> factors_;  // of the loads on faces
  Points positions_;             // (n, 3) m, of the nodes of faces
  Points rates_, gaps_, accelerations_;  // (n, 3)
};

}  // namespace sinew::rigid
