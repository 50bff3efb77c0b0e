/// @file
/// Commands of drive cylinders and what comes of them: volumes, and the torques on the arm.
#pragma once

#include <array>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/plan/drive_channel.hpp"

namespace sinew::plan {

/// Weights of four equally spaced samples for a value at `fraction` of the way from the second to
/// the third: cubic Hermite with the slopes of parabolas through three neighbours (Catmull & Rom
/// 1974), which is how records of volumes are read.
std::array<double, 4> sample_weights(double fraction);

/// Commands begin at time 0, torques are wanted from `lead` on. Columns are inputs.
struct DriveRun {
  std::vector<DriveChannel> channels;
  double lead = 0.0;  ///< s
  VectorX times;      ///< (samples,) s, from 0
  MatrixX command;    ///< (samples, inputs)
  MatrixX volume;     ///< (samples, inputs) m^3, that the cylinders give

  /// Throws what check_channels() throws and Error(wrong-length): too few samples, or columns that
  /// are not the channels'.
  /// @param channels of the inputs. @param command (samples, inputs). @param lead s.
  /// @param rest (inputs,) command at which the cylinders rest before; empty: zero.
  DriveRun(std::vector<DriveChannel> channels, MatrixX command, double lead, VectorX rest = {});

  /// (inputs,) N m on the arm. @param time s, from the lead on: what the volume was at time + lead
  /// less the delay.
  VectorX torque(double time) const;
};

}  // namespace sinew::plan
