#include "sinew/plan/drive_inversion.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::plan {

namespace {

constexpr const char* kPlace = "drive inversion";

/// The volume y without commands.
VectorX free_response(const pcc::DriveCylinder& cylinder, Eigen::Vector2d x, Eigen::Index count) {
  VectorX response(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    response[k] = cylinder.c.dot(x);
    x = cylinder.a * x;
  }
  return response;
}

/// Impulse response h_0 = D, h_k = C A^(k-1) B.
VectorX impulse_response(const pcc::DriveCylinder& cylinder, Eigen::Index count) {
  VectorX response(count);
  response << cylinder.d, free_response(cylinder, cylinder.b, count - 1);
  return response;
}

/// The lower triangular Toeplitz matrix T_kj = h_{k-j}.
MatrixX toeplitz(const VectorX& response) {
  const Eigen::Index count = response.size();
  MatrixX matrix = MatrixX::Zero(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    matrix.col(j).tail(count - j) = response.head(count - j);
  }
  return matrix;
}

void check(const pcc::DriveCylinder& cylinder, const VectorX& volume,
           const CylinderInversionSettings& settings) {
  cylinder.check();
  if (volume.size() < 2) {
    throw Error(ErrorKind::too_few_points, {.item = kPlace},
                fmt::format("{} volumes are given", volume.size()), "give two or more");
  }
  if (!volume.allFinite() || !settings.start.allFinite()) {
    throw Error(ErrorKind::not_finite, {.item = kPlace}, "a volume or the start is not finite",
                "give numbers");
  }
  if (!(settings.smoothing > 0.0) || !std::isfinite(settings.smoothing)) {
    throw Error(ErrorKind::out_of_range, {.item = kPlace},
                fmt::format("the smoothing is {:g}", settings.smoothing), "give more than zero");
  }
  if (cylinder.gain() == 0.0) {
    throw Error(ErrorKind::out_of_range, {.item = kPlace}, "the cylinder's gain at rest is zero",
                "give one whose command moves the volume");
  }
}

/// Volumes V (samples,) required for one input. Before the plan, its first torque is used.
VectorX wanted_volume(const Plan& plan, const pcc::FluidicActuator& actuator, Eigen::Index input,
                      const VectorX& times, double lead) {
  VectorX volume(times.size());
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    volume[k] = actuator.volume(plan.torque(times[k] - lead + actuator.delay)[input]);
  }
  return volume;
}

}  // namespace

CylinderInversion invert_cylinder(const pcc::DriveCylinder& cylinder, const VectorX& volume,
                                  const CylinderInversionSettings& settings) {
  check(cylinder, volume, settings);
  const Eigen::Index count = volume.size();
  const double gain = cylinder.gain();
  const VectorX free = free_response(cylinder, settings.start, count);
  // The unknowns are z = g u/scale, and volumes are divided by scale, so that values are about one.
  double scale = std::max(volume.cwiseAbs().maxCoeff(), free.cwiseAbs().maxCoeff());
  if (scale == 0.0) scale = 1.0;
  const MatrixX response = toeplitz(impulse_response(cylinder, count) / gain);

  const bool limited =
      std::isfinite(cylinder.lowest_volume) || std::isfinite(cylinder.highest_volume);
  // Without feedthrough, the first volume is that of the initial state, which no command changes.
  const Eigen::Index first = cylinder.d == 0.0 ? 1 : 0;
  const Eigen::Index rows = limited ? count - first : 0;
  auto program = qp::QuadraticProgram::sized(static_cast<int>(count), static_cast<int>(rows));
  program.hessian = response.transpose() * response;
  program.gradient = response.transpose() * (free - volume) / scale;
  for (Eigen::Index k = 1; k < count; ++k) {
    program.hessian(k, k) += settings.smoothing;
    program.hessian(k - 1, k - 1) += settings.smoothing;
    program.hessian(k, k - 1) -= settings.smoothing;
    program.hessian(k - 1, k) -= settings.smoothing;
  }
  const double low = cylinder.lowest_input * gain / scale;
  const double high = cylinder.highest_input * gain / scale;
  program.lower.setConstant(std::min(low, high));
  program.upper.setConstant(std::max(low, high));
  if (limited) {
    program.rows = response.bottomRows(rows);
    program.row_lower = (cylinder.lowest_volume - free.tail(rows).array()) / scale;
    program.row_upper = (cylinder.highest_volume - free.tail(rows).array()) / scale;
  }
  qp::QpSolver solver(static_cast<int>(count), static_cast<int>(rows));
  const qp::QpResult& found = solver.solve(program);
  return {.status = found.status,
          .command = found.x * (scale / gain),
          .volume = free + scale * (response * found.x)};
}

DriveInversion invert_drive(const Plan& plan, const std::vector<DriveChannel>& channels,
                            double lead, const CylinderInversionSettings& settings) {
  check_channels(channels, plan.knots.torque.cols(), lead, kPlace);
  const pcc::DriveCylinder& first = channels.front().cylinder;
  const Eigen::Index count = sample_count(first, lead + plan.duration());
  const auto inputs = static_cast<Eigen::Index>(channels.size());
  DriveInversion result;
  result.times = VectorX::LinSpaced(count, 0.0, static_cast<double>(count - 1) * first.sample_time);
  result.command = result.wanted = result.volume = MatrixX(count, inputs);
  result.found = true;
  for (Eigen::Index i = 0; i < inputs; ++i) {
    const DriveChannel& channel = channels[static_cast<std::size_t>(i)];
    const VectorX wanted = wanted_volume(plan, channel.actuator, i, result.times, lead);
    const CylinderInversion inverse = invert_cylinder(channel.cylinder, wanted, settings);
    result.wanted.col(i) = wanted;
    result.command.col(i) = inverse.command;
    result.volume.col(i) = inverse.volume;
    result.status.push_back(inverse.status);
    result.found = result.found && inverse.status == qp::QpStatus::optimal;
  }
  return result;
}

}  // namespace sinew::plan
