// Synthetic motion capture of arms.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "sinew/core/random.hpp"
#include "sinew/identify/arm_motion.hpp"

namespace sinew::identify::testing {

struct Capture {
  double duration = 3.0, rate = 50.0;  // s, Hz
  double noise = 1e-3;                 // m
  double gaps = 0.02;                  // fraction of marker positions that are missing
  double jitter = 0.3;                 // of the frames' times, as a fraction of their distance
  double time_step = 5e-3;             // s, of the simulation
};

/// A camera record of an arm that is released from a bent pose.
inline MotionRecord release(const ArmModel& model, const VectorX& pose, const Capture& capture,
                            std::uint64_t seed, MatrixX inputs = {}, std::string name = "release") {
  Random random(seed);
  MotionRecord record;
  record.name = std::move(name);
  const auto samples = static_cast<Eigen::Index>(capture.duration * capture.rate) + 1;
  record.time.resize(samples);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const bool inner = i > 0 && i + 1 < samples;
    record.time[i] =
        (static_cast<double>(i) + (inner ? capture.jitter * (random.uniform() - 0.5) : 0.0)) /
        capture.rate;
  }
  record.input = inputs.rows() == samples ? std::move(inputs) : MatrixX(samples, 0);
  record.position = predict_motion(model, record, {pose, VectorX::Zero(pose.size())},
                                   {.time_step = capture.time_step});
  for (Eigen::Index i = 0; i < samples; ++i) {
    for (Eigen::Index k = 0; k < record.position.cols(); k += 3) {
      for (Eigen::Index axis = k; axis < k + 3; ++axis) {
        record.position(i, axis) += capture.noise * random.normal();
      }
      if (random.uniform() >= capture.gaps) continue;
      record.position.block(i, k, 1, 3).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return record;
}

}  // namespace sinew::identify::testing
