/// @file
/// Rows whose effort follows a drive, or is whatever holds a commanded motion, taken out of the
/// step's problem before a law sees it.
#pragma once

#include <vector>

#include "sinew/sim/law.hpp"

namespace sinew::sim {

/// With a driven row's curve linearised, lambda_d = e + s (delta_d - m), s <= 0, the row is
/// eliminated from delta = delta_free + W lambda: the other rows see
///   W_ij + g W_id W_dj and delta_free_i + W_id h,
///   g = s/(1 - s W_dd), h = (e + s (delta_free_d - m))/(1 - s W_dd),
/// and the law solves for their efforts; then the curve is linearised anew where the row came out
/// (Newton on a falling curve), until it stays there. A row held at a motion m by an effort without
/// limits is the case of an infinitely steep curve: g = -1/W_dd, h = -(delta_free_d - m)/W_dd. W
/// keeps its symmetry, and any law, direct or inverse, works unchanged. What remains is positive
/// definite where the robot with its drives is stable, even if the robot alone is not: an inflated
/// balloon beyond its pressure's peak, held at its volume.
class DrivenLaw : public Law {
 public:
  /// @param rows of H. @param ranges of the model, see Model::range_count().
  DrivenLaw(int rows, int ranges);

  /// Whether the row is taken out.
  static bool takes(const ActuatorRange& range);
  /// Whether the robot is stable together with its drives although A has negative pivots: by
  /// Sylvester's law of inertia it is when W + C over the rows taken out, C = -1/s, has as many
  /// negative eigenvalues (Haynsworth 1968).
  static bool stabilised(const LawProblem& problem, int negative_pivots);
  /// The law that chooses all other efforts.
  DrivenLaw& around(Law& law) {
    law_ = &law;
    return *this;
  }
  LawStatus solve(const LawProblem& problem, std::span<double> effort) override;
  double violation(const LawProblem& problem, std::span<const double> effort) const override;
  void begin_step() override {}

 private:
  void linearise(const LawProblem& problem);
  void eliminate();
  void round_off(const LawProblem& problem);
  double close(const LawProblem& problem, std::span<double> effort);

  struct Row {
    int actuator = 0, row = 0;
    bool held = false;
    double motion = 0.0;  // where the curve is linearised, or what is held
    Drive::Response at;
    double gain = 0.0, offset = 0.0;  // g, h
  };

  Law* law_ = nullptr;
  std::vector<Row> driven_;
  std::vector<ActuatorRange> ranges_;
  std::vector<double> before_;  // (rows,) efforts of the last step
  MatrixX compliance_,
      coupling_;  // what the law sees; W_d of each driven row when it was taken out
  VectorX delta_free_;
};

}  // namespace sinew::sim
