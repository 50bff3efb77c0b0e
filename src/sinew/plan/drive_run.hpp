/// @file
/// Commands of drive cylinders, with the resulting volumes and torques on the arm.
#pragma once

#include <array>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/plan/drive_channel.hpp"

namespace sinew::plan {

/// Weights of four equally spaced samples that interpolate at `fraction` of the interval from the
/// second to the third: cubic Hermite interpolation with the slopes of parabolas through three
/// neighbours (Catmull & Rom 1974). Records of volumes are read with it.
std::array<double, 4> sample_weights(double fraction);

/// A run of the drive. Commands start at time 0, and torques are needed from `lead` on. Columns are
/// inputs.
struct DriveRun {
  std::vector<DriveChannel> channels;
  double lead = 0.0;  ///< s
  VectorX times;      ///< (samples,) s, from 0
  MatrixX command;    ///< (samples, inputs)
  MatrixX volume;     ///< (samples, inputs) m^3, delivered by the cylinders

  /// Simulates the cylinders. Throws what check_channels() throws, and Error(wrong-length) for too
  /// few samples or not one column per channel.
  /// @param channels of the inputs. @param command (samples, inputs). @param lead s.
  /// @param rest (inputs,) commands at which the cylinders rest initially; empty: zero.
  DriveRun(std::vector<DriveChannel> channels, MatrixX command, double lead, VectorX rest = {});

  /// Torques (inputs,) on the arm, N m, from the volumes at time + lead - delay.
  /// @param time s, counted from the lead on.
  VectorX torque(double time) const;
};

}  // namespace sinew::plan
