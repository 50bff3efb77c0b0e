/// @file
/// Requirements on contact forces as rows of a controller's quadratic program.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "sinew/control/contact_task.hpp"
#include "sinew/core/types.hpp"

namespace sinew::law {
class Response;
struct ContactBlock;
struct StepProblem;
}  // namespace sinew::law

namespace sinew::control {

/// Rows for the contact forces of a controller's tasks. Each task has one row for its normal force.
/// A reserve of friction adds eight rows: the octagon around a circle of radius (1 - reserve) mu
/// cos(pi/8) F_n, whose corners lie on the requested cone. As a function of the controlled efforts
/// lambda_c, a row is
///   lower <= offset + slope . lambda_c <= upper,
/// in m: forces are multiplied by the compliance W_nn of one point of the contact, its reference.
/// An open contact is assigned the normal force -gap/W_nn of that point, so that its shortfall from
/// a requested force includes what closes the gap. A contact without points near the surface has no
/// rows; only targets bring it there.
///
/// A contact that slips has friction at its limit whatever its normal force, and letting go would
/// satisfy the reserve. Let d be the mean motion along the surface in the step, over the points
/// that carried force before and weighted by these forces. The rows of a reserve therefore limit
///   F_t - kSlip d/W_nn
/// in place of F_t, as an estimate of the friction that would hold the contact: pressing harder
/// helps if it reduces the slip, and letting go does not. If all points stick, it equals F_t.
///
/// A violation v of the limits costs kForceWeight w v^2/2, where w is the largest weight of a
/// target.
class ForceRows {
 public:
  ForceRows() = default;
  /// @param tasks each of another contact. @param weight w, see the class.
  ForceRows(std::vector<ContactTask> tasks, double weight);

  const std::vector<ContactTask>& tasks() const { return tasks_; }
  /// Number of rows of all tasks.
  Eigen::Index count() const { return lower_.size(); }
  /// Factor of v^2/2, see the class; dimensionless.
  double weight() const { return weight_; }

  /// Forms the limits for all choices of one step. The limits change a force by no more than what
  /// moves its point by `largest`. @param problem of the step. @param largest m.
  void begin(const law::StepProblem& problem, double largest);
  /// Forms the rows. @param problem,response of the step, the same problem as in begin().
  void form(const law::StepProblem& problem, const law::Response& response);
  const MatrixX& slope() const { return slope_; }    ///< (count, controlled) m/N
  const VectorX& offset() const { return offset_; }  ///< (count,) m
  const VectorX& lower() const { return lower_; }    ///< (count,) m
  const VectorX& upper() const { return upper_; }    ///< (count,) m

  /// Cost of the violation of the limits of begin(). @param problem of the step.
  /// @param motion (rows,) m. @param effort (rows,) N.
  double cost(const law::StepProblem& problem, const VectorX& motion,
              std::span<const double> effort) const;
  /// Largest violation of the task's own limits, N.
  /// @param task index in tasks(). @param problem,motion,effort as for cost().
  double miss(std::size_t task, const law::StepProblem& problem, const VectorX& motion,
              std::span<const double> effort) const;

 private:
  struct Reference {
    int row = -1;             // of the normal; -1: no point is near
    double compliance = 0.0;  // W_nn, m/N
    double friction = 0.0;
    double carried = 0.0;                 // N, total normal force before the step
    Matrix3 frame = Matrix3::Identity();  // normal, two tangents
  };

  void choose_reference(const law::StepProblem& problem, std::size_t task);
  double normal_force(std::size_t task, const law::StepProblem& problem, const VectorX& motion,
                      std::span<const double> effort) const;
  Vector3 resultant(std::size_t task, const law::StepProblem& problem, const VectorX& motion,
                    std::span<const double> effort) const;
  double carries(std::size_t task, const law::StepProblem& problem,
                 const law::ContactBlock& block) const;
  Vector3 slip(std::size_t task, const law::StepProblem& problem, const VectorX& motion) const;
  void form_friction(const law::StepProblem& problem, const law::Response& response,
                     std::size_t task, const law::ContactBlock& block);
  void clear_rounding(const law::StepProblem& problem, const law::Response& response,
                      std::size_t task);
  Vector3 cone_side(std::size_t task, int side) const;

  std::vector<ContactTask> tasks_;
  std::vector<Reference> references_;  // (tasks,)
  std::vector<Eigen::Index> first_;    // (tasks,) rows
  MatrixX slope_;
  VectorX offset_, lower_, upper_;
  double weight_ = 0.0;
};

}  // namespace sinew::control
