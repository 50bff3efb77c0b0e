/// @file
/// The filter of a quasi-static estimator.
#pragma once

#include <span>
#include <vector>

#include "sinew/estimate/estimator_filter.hpp"
#include "sinew/estimate/random_walk_filter.hpp"
#include "sinew/run/state.hpp"

namespace sinew::estimate {

/// The readings h_k(u_k) and their derivative S_k = dh_k/du of step k are those of this step of the
/// robot and its linearisation (StepResponse). With x the unknowns, which wander at random,
///   y = h_k(u_k) + S_k (x_k - u_k) + v
/// is what a sample of step k says; estimate::RandomWalkFilter takes it, with u_k = the estimate
/// before step k. This is the extended Kalman filter (Simon, Optimal State Estimation, Wiley 2006,
/// sec. 13.2) of equilibria along a random walk; a sample that comes late counts for the step in
/// which it was taken. Step and sample agree to the step's tolerance, and S to the change of the
/// tangent by the last Newton correction.
///
/// A stiffness has no row in W. Its column of S is the difference of two steps from the same state,
///   dh/du_k = (h(u + e e_k) - h(u))/e,   with e = 0.01 in the logarithm u_k,
/// accurate to the step's tolerance over e. h varies as exp(-u_k), and by default the stiffness is
/// constant, so an error of the first linearisation would persist. If a stiffness is unknown, each
/// step is therefore repeated about the corrected estimate until the estimate moves by less than a
/// tenth of its standard deviation, at most ten times in all (iterated filter, ibid. sec. 13.3.1).
/// Late samples use the linearisation of their own step.
class EquilibriumFilter : public EstimatorFilter {
 public:
  /// See EstimatorFilter; the robot of the model is quasi-static.
  EquilibriumFilter(const EstimatorModel& model, int threads);

  bool iterates() const override;
  void begin_settling() override;
  VectorX mean() const override { return filter_.mean(); }
  MatrixX covariance() const override { return filter_.covariance(); }
  bool knows(int lag) const override { return at(lag).known; }
  const VectorX& path(int lag) const override { return at(lag).readings; }
  VectorX beyond_path(int lag) const override;
  void correct(int lag, Eigen::Index first, const VectorX& innovation,
               const VectorX& variance) override;
  /// Observability by one sample of each sensor in the last step.
  estimate::Observability observability(const VectorX& variance) const override;

 protected:
  void forget() override;
  void predict(const run::Run& run, double time_step) override;
  bool predict_again(const run::Run& run) override;
  bool predict_rest(const run::Run& run) override;
  void save_own(std::vector<double>& memory) const override;
  bool load_own(std::span<const double>& memory) override;

 private:
  // Linearised measurement model of one step.
  struct Instant {
    bool known = false;
    VectorX unknowns;     // (n,) as they acted, u_k
    VectorX readings;     // (m,) h_k
    MatrixX sensitivity;  // (m, n) S_k
  };

  const Instant& at(int lag) const { return instants_[static_cast<std::size_t>(lag)]; }
  void take_up(const run::Run& run, const VectorX& unknowns, bool settles);
  MatrixX sensitivity();
  bool add_stiffness(const run::Run& run, bool settles);
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);

  estimate::RandomWalkFilter filter_, settled_from_, predicted_;
  run::State start_;                // of the robot before the last step, if it iterates
  std::vector<int> controlled_;     // actuators whose efforts are unknown
  std::vector<Eigen::Index> with_;  // components of these efforts
  std::vector<Instant> instants_;   // (lags + 1,) from now back
};

}  // namespace sinew::estimate
