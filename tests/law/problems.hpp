/// @file
/// Random step problems with a positive definite W and blocks of every kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "sinew/law/step_problem.hpp"

#include "../qp/random_problem.hpp"

namespace sinew::law::testing {

using qp::Random;

/// A drive with effort = rest - slope motion - cubic motion^3, which stiffens with the motion.
class CubicDrive : public Drive {
 public:
  CubicDrive(double rest, double slope, double cubic) : rest_(rest), slope_(slope), cubic_(cubic) {}
  int state_size() const override { return 0; }
  void rest(std::span<double>) const override {}
  QuantityName input() const override { return {}; }
  bool acts_on(CommandKind) const override { return true; }
  bool controllable() const override { return false; }
  Response respond(const Step&, double motion) const override {
    return {rest_ - motion * (slope_ + cubic_ * motion * motion),
            -slope_ - 3.0 * cubic_ * motion * motion};
  }
  void advance(const Step&, double, double, std::span<double>) const override {}
  void describe(PartVisitor&) const override {}

 private:
  double rest_, slope_, cubic_;
};

/// A problem together with the drives that it refers to.
struct RandomProblem {
  StepProblem problem;
  std::vector<std::unique_ptr<Drive>> drives;

  VectorX motion(const std::vector<double>& effort) const {
    return problem.delta_free +
           problem.compliance * Eigen::Map<const VectorX>(effort.data(), problem.delta_free.size());
  }
};

/// Number of blocks of each kind. Actuators are made in this order.
struct BlockCounts {
  int owned = 0, commanded_efforts = 0, stopped_efforts = 0, motions = 0, held = 0, drives = 0;
  int capstans = 0;  ///< on the cable of the first motion, or of the first owned effort
  int contacts = 0, bilaterals = 0, effectors = 0;
};

inline RandomProblem random_problem(const BlockCounts& counts, Random& random) {
  RandomProblem result;
  StepProblem& problem = result.problem;
  const int actuators = counts.owned + counts.commanded_efforts + counts.stopped_efforts +
                        counts.motions + counts.held + counts.drives;
  const int rows =
      actuators + counts.capstans + 3 * counts.contacts + counts.bilaterals + counts.effectors;
  const MatrixX root = random.matrix(rows, rows + 4);
  problem.compliance = root * root.transpose() / static_cast<double>(rows);
  problem.delta_free = random.vector(rows);
  problem.delta = problem.delta_free;
  problem.effort_before.assign(static_cast<std::size_t>(rows), 0.0);
  int row = 0;
  const auto add = [&](CommandKind kind, double value) -> ActuatorBlock& {
    ActuatorBlock block;
    block.row = row++;
    block.kind = kind;
    block.value = value;
    block.effort_min = 0.0;
    block.effort_max = kInfinity;
    block.motion_min = -kInfinity;
    block.motion_max = kInfinity;
    return problem.actuators.emplace_back(block);
  };
  for (int i = 0; i < counts.owned; ++i) add(CommandKind::effort, 0.0).owned = true;
  for (int i = 0; i < counts.commanded_efforts; ++i) {
    add(CommandKind::effort, random.uniform(0.0, 1.0));
  }
  for (int i = 0; i < counts.stopped_efforts; ++i) {
    ActuatorBlock& block = add(CommandKind::effort, random.uniform(0.2, 1.0));
    block.motion_min = random.uniform(-0.4, 0.0);
    block.motion_max = random.uniform(0.0, 0.4);
  }
  for (int i = 0; i < counts.motions; ++i) {
    add(CommandKind::motion, random.uniform(-0.5, 0.5)).effort_max = random.uniform(0.5, 2.0);
  }
  for (int i = 0; i < counts.held; ++i) {
    add(CommandKind::motion, random.uniform(-0.5, 0.5)).effort_min = -kInfinity;
  }
  for (int i = 0; i < counts.drives; ++i) {
    result.drives.push_back(std::make_unique<CubicDrive>(
        random.uniform(-1.0, 1.0), random.uniform(0.1, 2.0), random.uniform(0.0, 2.0)));
    add(CommandKind::effort, 0.0).drive = result.drives.back().get();
  }
  const int cable =
      counts.motions > 0 ? counts.owned + counts.commanded_efforts + counts.stopped_efforts : 0;
  for (int i = 0; i < counts.capstans; ++i) {
    problem.capstans.push_back({row, cable, random.uniform(0.05, 0.3), random.uniform(-0.2, 0.2)});
    ++row;
  }
  for (int i = 0; i < counts.contacts; ++i, row += 3) {
    problem.contacts.push_back({row, random.uniform(0.0, 0.8)});
    problem.delta_free[row] -= 0.5;  // most contacts are compressed
  }
  for (int i = 0; i < counts.bilaterals; ++i, ++row) {
    problem.bilaterals.push_back({row, random.uniform(-0.3, 0.3), 1.0});
  }
  return result;
}

}  // namespace sinew::law::testing
