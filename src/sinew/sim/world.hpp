/// @file
/// All bodies of a simulation and the rows between them, as one linear system a step.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/constraint/placement.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/step/step_problem.hpp"

namespace sinew::constraint {
struct SurfaceApproach;
}
namespace sinew::step {
class Controller;
class StepSolver;
}  // namespace sinew::step

namespace sinew::sim {

class StageClock;

/// Data of one simulation below the level of commands and laws. Nothing allocates after
/// construction, but for the first use of curvature.
class World {
 public:
  /// @param model shared. @param pool must outlive the world.
  World(std::shared_ptr<const Model> model, ThreadPool& pool);

  /// @param from,to s, when the step begins and ends: where surfaces stand then. @param effort
  ///   (rows,) N of the last step: points with a force are near, whatever their gap.
  void begin_step(double from, double to, std::span<const double> effort);
  /// For a look at the present state: every contact point takes part, and no base moves.
  /// @param at s, when surfaces are looked at.
  void begin_query(double at);
  /// m: the farthest that any touching point's gap is from that of its tangent plane, at the pose
  /// that surfaces have at a time. @param effort (rows,) N; who touches. @param time s.
  double contact_drift(std::span<const double> effort, double time) const;
  /// m, >= 0: how deep the deepest point without a normal force is in its surface's tangent plane.
  /// @param effort (rows,) N.
  double deepest_free_point(std::span<const double> effort) const;
  /// Assembly: every body at its current state.
  void linearise(const mechanics::LinearisationRequest& request);
  /// H and delta at the current placement, handed to the bodies. condense() adds the curvature of
  /// `curved` constraints at `effort`: as it is, or, where the linearisation's tangent is not
  /// exact, what is never less and positive semi-definite.
  void form_rows(std::span<const double> effort, std::span<const int> curved);
  /// |b + H^T effort| (N) and the scale (N) to judge it by.
  double residual(std::span<const double> effort);
  double force_scale() const;
  /// N: what rounding leaves of residual(), see mechanics::Body.
  double rounding_floor() const;
  /// For load stepping: see mechanics::Body.
  void hold_imbalance(std::span<const double> effort);
  void set_imbalance_share(double share);
  /// Of all bodies, at the last condensation and the last linearisation: see mechanics::Body.
  int negative_pivots() const;
  bool is_unsymmetric() const;
  /// Whether the robot is stable with its drives and held rows, as far as its linearisation tells.
  /// @param status of condense().
  bool is_stable(linalg::FactorStatus status) const;
  /// Whether a majorant of curvature stands in A, which is then no derivative.
  bool has_majorant() const { return majorant_; }
  /// W and delta_free of the step's problem. The worst status of any body.
  linalg::FactorStatus condense();
  /// Efforts that obey all blocks, and dq of all bodies, which apply_motion() takes. As long as
  /// that motion leads a point that was left out into its surface, or a point is pushed by a
  /// tangent plane that is not that of its way, this is mended and the problem solved again, of the
  /// same factorisation: see correct_contacts().
  /// @param solver,controller see step::StepSolver. @param effort (rows,) N, in and out. @param
  /// clock gets the times of the law and of the motion.
  step::LawStatus solve_step(step::StepSolver& solver, step::Controller* controller,
                             std::span<double> effort, StageClock& clock);
  /// After a motion was solved: mends what the step guessed of contacts, of the same factorisation.
  /// - Points that were left out are taken in where the motion leads into their surface.
  /// - A point that is pushed by the tangent plane of a curved surface gets the plane of the way
  ///   that it would go without its own force (constraint::Contact), if that is another one: where
  ///   that way misses the surface it is pushed no more.
  /// Whether there was anything to mend; W and delta_free are then new. Planes change in a bounded
  /// number of rounds a step, after which they stay as they are.
  /// @param effort (rows,) N, of that motion.
  bool correct_contacts(std::span<const double> effort);
  /// Whether correct_contacts() could find anything.
  bool guesses_contacts() const { return left_out_ || curved_; }
  bool leaves_points_out() const { return left_out_; }
  /// Whether a point has a force that had none when the step began. @param effort (rows,) N.
  bool gap_closed(std::span<const double> effort) const;
  /// The same by hand, see mechanics::Body: (all bodies' motion_size(),), one behind the other.
  void imbalance(std::span<const double> effort, VectorX& result);
  void solve(const VectorX& right, VectorX& result);
  void propose_motion(const VectorX& motion);
  /// Moves all bodies to where their velocities lead in `time_step`, unless an element would turn
  /// inside out there.
  void drift(double time_step);
  /// The worst report of any body.
  mechanics::MotionReport apply_motion(double scale);
  mechanics::SmallestVolume smallest_volume();
  /// The largest error estimate of any body, m.
  double end_step(const mechanics::StepWeights& weights);

  /// m: how far `effort` and the present placement are from obeying all laws, points that are left
  /// out included; see step::violation(). @param effort (rows,) N.
  double violation(std::span<const double> effort);

  /// The step's problem. Actuators are the caller's to write; capstans' grip, contacts and all
  /// numbers of rows are the world's. Its rows are those of the model, in their order, without
  /// those of points that are left out of the step. Contacts stand behind all others, whose numbers
  /// are therefore the same in both.
  step::StepProblem& problem() { return problem_; }
  const step::StepProblem& problem() const { return problem_; }
  /// Of the problem's rows, of those of the model. @param effort (rows,) N.
  linalg::AlignedNumbers gather(std::span<const double> effort) const;
  /// The model's row that a row of the problem is.
  int row_of(int row) const { return row_of_[static_cast<std::size_t>(row)]; }
  /// From where cables stick to their guides in this step. @param delta (rows,) m.
  void hold_capstans(const VectorX& delta);
  const MatrixX& compliance() const { return problem_.compliance; }  ///< W of the problem, m/N
  const VectorX& delta_free() const { return problem_.delta_free; }  ///< of the problem, m
  const VectorX& delta() const { return rows_.delta; }               ///< (rows,) m, as last formed
  /// delta at the current placement, without forming the rows anew for the bodies.
  const VectorX& measure_delta();
  const mechanics::RowValues& rows() const { return rows_; }
  /// (rows,) m: delta of contacts when the step began.
  const VectorX& contact_start() const { return contact_start_; }

  const constraint::Placement& placement() const { return placement_; }
  std::span<const std::unique_ptr<mechanics::Body>> bodies() const { return bodies_; }
  mechanics::Body& body(int index) { return *bodies_[static_cast<std::size_t>(index)]; }
  const mechanics::Body& body(int index) const { return *bodies_[static_cast<std::size_t>(index)]; }

  /// Every body at rest, as after construction.
  void restart();
  /// Normal and tangents of every contact point, as of the last step, 9 numbers each: what the
  /// efforts of its rows mean.
  std::size_t frames_size() const;
  void save_frames(std::vector<double>& frames) const;
  void load_frames(std::span<const double> frames);
  std::size_t bytes() const;

 private:
  void place_contacts(double from, double to);
  void choose_present(std::span<const double> effort, double time_step);
  void set_present(const constraint::Contact& contact, std::size_t point, bool present);
  bool take_in(const constraint::Contact& contact, std::size_t point,
               const Eigen::Isometry3d& pose);
  bool follow_way(const constraint::Contact& contact, std::size_t point,
                  const Eigen::Isometry3d& pose);
  void turn(const constraint::Contact& contact, std::size_t point,
            const constraint::SurfaceApproach& plane);
  void gather(std::span<const double> effort, linalg::AlignedNumbers& result) const;
  void number_rows();
  void form_compliance();
  void add_curvatures();
  void add_anchors();
  void couple(const mechanics::RowCurvature& pair);
  void add_majorant(const mechanics::RowCurvature& pair);

  std::shared_ptr<const Model> model_;
  std::vector<std::unique_ptr<mechanics::Body>> bodies_;
  constraint::Placement placement_;
  mechanics::RowValues rows_;
  std::vector<mechanics::RowCurvature> curvatures_;
  step::StepProblem problem_;
  VectorX contact_start_;
  std::vector<double> curving_effort_;  // (rows,) N, at which constraints curve
  std::span<const int> curving_;        // whose curvature the next condensation adds
  mechanics::Tangent tangent_ = mechanics::Tangent::real_time;
  bool majorant_ = false;                  // of curvature, in A
  std::size_t anchor_rows_ = 0;            // of problem_.stiffness; behind them those of couplings
  bool left_out_ = false;                  // some point
  bool curved_ = false;                    // some surface
  double end_ = 0.0;                       // s, of the step: where surfaces stand
  int turns_left_ = 0;                     // rounds of this step in which planes may change
  std::vector<char> touched_;              // (rows,) normal rows with a force when the step began
  std::vector<double> effort_before_;      // (rows,) N, of the last step or iteration
  std::vector<int> place_;                 // (rows,) in the problem, -1: left out
  std::vector<int> row_of_;                // (rows of the problem,) of the model
  linalg::AlignedNumbers problem_effort_;  // (rows of the problem,) N, of the last solution
  linalg::AlignedNumbers scratch_;         // (rows of the problem,)
};

}  // namespace sinew::sim
