/// @file
/// The filter of a quasi-static estimator.
#pragma once

#include <span>
#include <vector>

#include "sinew/estimate/random_walk_filter.hpp"
#include "sinew/sim/estimator_filter.hpp"

namespace sinew::sim {

/// An extended Kalman filter (Simon, Optimal State Estimation, Wiley 2006, sec. 13.2) for
/// equilibria whose unknowns x follow a random walk. The readings h_k(u_k) of step k and their
/// derivative S_k = dh_k/du are those of the robot's step k and its linearisation (StepResponse).
/// The measurement equation of a sample of step k is
///   y = h_k(u_k) + S_k (x_k - u_k) + v,
/// where u_k is the estimate before step k; estimate::RandomWalkFilter processes it. A late sample
/// counts for the step in which it was taken. The readings are exact to the tolerance of the step,
/// and S to the change of the tangent in the last Newton correction.
class EquilibriumFilter : public EstimatorFilter {
 public:
  /// See EstimatorFilter; the robot of the model is quasi-static.
  EquilibriumFilter(const EstimatorModel& model, int threads);

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
  void predict(const Run& run, double time_step) override;
  void predict_rest(const Run& run) override;
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
  void take_up(const Run& run, bool settles);
  MatrixX sensitivity();
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);

  estimate::RandomWalkFilter filter_, settled_from_;
  std::vector<int> controlled_;    // (n,) actuators of the unknowns
  std::vector<Instant> instants_;  // (lags + 1,) newest first
};

}  // namespace sinew::sim
