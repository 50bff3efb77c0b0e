/// @file
/// Contact forces as rows of a controller's program.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/inverse/contact_task.hpp"

namespace sinew::step {
class Response;
struct ContactBlock;
struct StepProblem;
}  // namespace sinew::step

namespace sinew::inverse {

/// One row for the normal force of each task, and eight for a reserve of friction: the octagon
/// around a circle of radius (1 - reserve) mu cos(pi/8) F_n, whose corners lie on the cone that is
/// asked for. As a function of the controlled efforts lambda_c a row is
///   lower <= offset + slope . lambda_c <= upper,
/// in m: forces are multiplied by the compliance W_nn of a point of the contact, its reference. A
/// contact that is open has the normal force -gap/W_nn of that point: it is less than any that is
/// asked for by what closes the gap. A contact without points near the surface has no rows, and
/// only targets bring it there.
///
/// A contact that slips has friction at its limit whatever its normal force is, and letting go
/// would meet the reserve. With d the motion along the surface in the step, the mean over the
/// points that carried force before, by their forces, the rows of a reserve hold therefore
///   F_t - kSlip d/W_nn
/// in place of F_t, the force that would hold the contact: more pull serves where it lessens the
/// slip, and letting go does not. Where all points stick, it is F_t.
///
/// What lies beyond the limits by v costs kForceWeight w v^2/2, w the largest weight of a target.
class ForceRows {
 public:
  ForceRows() = default;
  /// @param tasks of different contacts. @param weight w, see the class.
  ForceRows(std::vector<ContactTask> tasks, double weight);

  const std::vector<ContactTask>& tasks() const { return tasks_; }
  /// How many rows all tasks have.
  Eigen::Index count() const { return lower_.size(); }
  /// Of v^2/2, see the class; 1 (no unit).
  double weight() const { return weight_; }

  /// What is asked in all choices of a law's solution: forces change by no more than what moves
  /// their points by a length. @param problem of the step. @param largest m.
  void begin(const step::StepProblem& problem, double largest);
  /// @param problem,response of the step, the same problem as in begin().
  void form(const step::StepProblem& problem, const step::Response& response);
  const MatrixX& slope() const { return slope_; }    ///< (count, controlled) m/N
  const VectorX& offset() const { return offset_; }  ///< (count,) m
  const VectorX& lower() const { return lower_; }    ///< (count,) m
  const VectorX& upper() const { return upper_; }    ///< (count,) m

  /// The cost of what lies beyond the limits of begin(). @param problem as there.
  /// @param motion (rows,) m. @param effort (rows,) N.
  double cost(const step::StepProblem& problem, const VectorX& motion,
              std::span<const double> effort) const;
  /// N: how far a task's forces are beyond the limits of the task itself, the farthest.
  /// @param task position in tasks(). @param problem,motion,effort as for cost().
  double miss(std::size_t task, const step::StepProblem& problem, const VectorX& motion,
              std::span<const double> effort) const;

 private:
  struct Reference {
    int row = -1;             // of the normal; none: no point is near
    double compliance = 0.0;  // W_nn, m/N
    double friction = 0.0;
    double carried = 0.0;                 // N, by all points of the contact before
    Matrix3 frame = Matrix3::Identity();  // normal, two tangents
  };

  void choose_reference(const step::StepProblem& problem, std::size_t task);
  double normal_force(std::size_t task, const step::StepProblem& problem, const VectorX& motion,
                      std::span<const double> effort) const;
  Vector3 resultant(std::size_t task, const step::StepProblem& problem, const VectorX& motion,
                    std::span<const double> effort) const;
  double carries(std::size_t task, const step::StepProblem& problem,
                 const step::ContactBlock& block) const;
  Vector3 slip(std::size_t task, const step::StepProblem& problem, const VectorX& motion) const;
  void form_friction(const step::StepProblem& problem, const step::Response& response,
                     std::size_t task, const step::ContactBlock& block);
  void clear_rounding(const step::StepProblem& problem, const step::Response& response,
                      std::size_t task);
  Vector3 cone_side(std::size_t task, int side) const;

  std::vector<ContactTask> tasks_;
  std::vector<Reference> references_;  // (tasks,)
  std::vector<Eigen::Index> first_;    // (tasks,) rows
  MatrixX slope_;
  VectorX offset_, lower_, upper_;
  double weight_ = 0.0;
};

}  // namespace sinew::inverse
