/// @file
/// The block of a plan's program for its drives: volumes and commands at the samples of the
/// cylinders.
#pragma once

#include <array>
#include <vector>

#include "sinew/plan/drive_run.hpp"
#include "sinew/plan/nonlinear_program.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// A linear combination of a few unknowns: sum over i < count of weight[i] x[at[i]].
struct LinearForm {
  std::array<int, 4> at{};
  std::array<double, 4> weight{};
  int count = 0;
  double of(const VectorX& x) const;
};

/// Transcribes the channels of a drive. The unknowns of a channel are its volumes y_0 ... y_M at
/// the samples, then its commands u_0 ... u_M. The time of a sample is the time at which its volume
/// acts, begin + j T, so the delay is only a shift of time. Eliminating the states by the
/// Cayley-Hamilton theorem leaves one row per sample,
///
///     y_j - tr A y_(j-1) + det A y_(j-2)
///         = D u_j + (C B - tr A D) u_(j-1) + (C A B - tr A C B + det A D) u_(j-2)
///
/// Limits of volume and torque are bounds on y, since torque increases with volume. Before the plan
/// everything is at rest. An input whose limits allow only one volume is not driven and has no
/// rows. The cost of commands is weight sum_j (k (u_j - u_(j-1))/T)^2 T, where k is the torque per
/// command at the largest volume within the limits.
class DriveTranscription {
 public:
  /// @param task completed(), with a drive. @param torque typical torque, N m.
  /// @param variable,row first unknown and constraint of the block.
  DriveTranscription(const PlanTask& task, double torque, int variable, int row);

  int variables() const { return variables_; }
  int rows() const { return static_cast<int>(row_bounds_.lower.size()); }
  /// Volume of an input that acts at a time in the plan. @param input index. @param time s.
  LinearForm volume(int input, double time) const;

  /// Bounds and scales of the variables and rows of this block.
  const Bounds& variable_bounds() const { return variable_bounds_; }
  const Bounds& row_bounds() const { return row_bounds_; }
  const VectorX& variable_scale() const { return variable_scale_; }
  const VectorX& row_scale() const { return row_scale_; }

  /// A matrix entry. Indices are those of the whole program.
  struct Entry {
    int row, column;
    double value;
  };
  const std::vector<Entry>& jacobian() const { return entries_; }
  const std::vector<Entry>& cost_hessian() const { return cost_; }  ///< lower; cost = x'Hx/2

  /// Converts a run to the unknowns of this block. Commands start at time 0, `lead` before the
  /// plan.
  /// @param run of the task's drive.
  VectorX pack(const DriveRun& run) const;
  /// Converts unknowns to a run. @param x of the whole program.
  DriveRun unpack(const VectorX& x) const;

 private:
  struct Channel {
    DriveChannel drive;
    int volume = 0, command = 0;  ///< first unknowns
    int count = 0;                ///< of samples
    int offset = 0;               ///< index of its first sample, counted from the first command
    double begin = 0.0;           ///< s, time at which that sample acts
    int at_rest = 0;              ///< index of its last volume at rest
    double rest_volume = 0.0, rest_command = 0.0;
    double lower = 0.0, upper = 0.0, scale = 0.0;  ///< m^3
    bool driven() const { return lower < upper; }
  };
  Channel channel(const PlanTask& task, int input, double torque) const;
  void add_bounds(const Channel& of);
  void add_rows(const Channel& of, int row);
  void add_rate_rows(const Channel& of, int row, double limit);
  void add_cost(const Channel& of, double weight);

  DriveTrain drive_;
  double step_ = 0.0, duration_ = 0.0;  // s
  int first_ = 0, variables_ = 0;
  std::vector<Channel> channels_;
  Bounds variable_bounds_, row_bounds_;
  VectorX variable_scale_, row_scale_;
  std::vector<Entry> entries_, cost_;
};

}  // namespace sinew::plan
