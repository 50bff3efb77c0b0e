#include "sinew/identify/arm_motion.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/pcc/arm_sensitivity.hpp"

namespace sinew::identify {

namespace {

/// The torques of the inputs at a time, and their derivatives.
class RecordedDrive {
 public:
  RecordedDrive(const ArmModel& model, const MotionRecord& record)
      : model_(model), signal_(record), torque_(VectorX::Zero(model.arm->inputs())) {
    const Eigen::Index inputs = record.input.cols();
    passive_ = inputs == 0;
    if (!passive_ && inputs != model.arm->inputs()) {
      throw Error(ErrorKind::wrong_length, {.item = record.name},
                  fmt::format("it has {} inputs, the arm {}", inputs, model.arm->inputs()),
                  "give one for each column of the arm's actuation");
    }
    if (!model.actuators.empty() &&
        static_cast<Eigen::Index>(model.actuators.size()) != model.arm->inputs()) {
      throw Error(ErrorKind::wrong_length, {.item = "actuators"},
                  fmt::format("there are {}, the arm has {} inputs", model.actuators.size(),
                              model.arm->inputs()),
                  "give one for each input");
    }
  }

  const VectorX& torque(double time) {
    for (Eigen::Index i = 0; i < torque_.size() && !passive_; ++i) {
      if (model_.actuators.empty()) {
        torque_[i] = signal_.at(i, time).value;
      } else {
        const auto& actuator = model_.actuators[static_cast<std::size_t>(i)];
        torque_[i] = actuator.torque(signal_.at(i, time - actuator.delay).value);
      }
    }
    return torque_;
  }

  /// Subtracts B dtau/dp.
  void subtract_derivative(double time, const ArmParameterMap& map, MatrixX& result) const {
    if (passive_ || model_.actuators.empty()) return;
    for (Eigen::Index i = 0; i < torque_.size(); ++i) {
      const auto& actuator = model_.actuators[static_cast<std::size_t>(i)];
      const auto volume = signal_.at(i, time - actuator.delay);
      const double by_delay = -actuator.slope(volume.value) * volume.rate;
      const auto& b = model_.arm->actuation().col(i);
      result.noalias() -= b * (std::pow(volume.value, 3) * map.cubic.row(i));
      result.noalias() -= b * (by_delay * map.delay.transpose());
    }
  }

 private:
  const ArmModel& model_;
  InputSignal signal_;
  bool passive_ = true;
  VectorX torque_;
};

/// Cubic Hermite weights of (value, slope) at both ends.
struct Hermite {
  double a, da, b, db;
  Hermite(double s, double h)
      : a((1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s)),
        da(h * s * (1.0 - s) * (1.0 - s)),
        b(s * s * (3.0 - 2.0 * s)),
        db(h * s * s * (s - 1.0)) {}
  template <typename T>
  T mix(const T& x0, const T& v0, const T& x1, const T& v1) const {
    return a * x0 + da * v0 + b * x1 + db * v1;
  }
};

}  // namespace

ArmParameterMap::ArmParameterMap(const pcc::Arm& arm, Eigen::Index parameters) {
  mass = MatrixX::Zero(arm.segments(), parameters);
  stiffness = damping = position = rate = MatrixX::Zero(arm.coordinates(), parameters);
  cubic = MatrixX::Zero(arm.inputs(), parameters);
  delay = VectorX::Zero(parameters);
}

MatrixX predict_motion(const ArmModel& model, const MotionRecord& record, const ArmStart& start,
                       const pcc::ArmStepSettings& settings, const ArmParameterMap* map,
                       MatrixX* jacobian) {
  const pcc::Arm& arm = *model.arm;
  const Eigen::Index n = arm.coordinates(), wide = 3 * arm.segments();
  const Eigen::Index parameters = map != nullptr ? map->delay.size() : 0;
  RecordedDrive drive(model, record);
  const double begin = record.time[0], duration = record.time[record.samples() - 1] - begin;
  const auto steps =
      whole_count<Eigen::Index>(std::max(1.0, std::ceil(duration / settings.time_step - 1e-9)), 1e9,
                                "time steps of a recorded motion", "increase the time step");
  pcc::ArmStepSettings even = settings;
  even.time_step = duration / static_cast<double>(steps);
  pcc::ArmSimulation simulation(model.arm, even);
  simulation.set_state(start.position, start.rate, begin);
  pcc::ArmEquations& equations = simulation.equations();
  pcc::ArmSensitivity sensitivity(n, parameters);
  MatrixX by_parameter = MatrixX::Zero(n, parameters), position_before, rate_before;
  if (map != nullptr) {
    sensitivity.start(map->position, map->rate);
    jacobian->resize(record.samples() * wide, parameters);
  }
  MatrixX result(record.samples(), wide);
  VectorX before = start.position, speed_before = start.rate, q(n);
  Eigen::Index sample = 0;
  for (Eigen::Index k = 1; k <= steps; ++k) {
    before = simulation.position();
    speed_before = simulation.rate();
    const double time = begin + static_cast<double>(k) * even.time_step;
    simulation.step(drive.torque(time));
    if (map != nullptr) {
      position_before = sensitivity.position();
      rate_before = sensitivity.rate();
      by_parameter.noalias() = equations.mass_regressor(simulation.position(), simulation.rate(),
                                                        simulation.acceleration()) *
                               map->mass;
      by_parameter.noalias() += simulation.position().asDiagonal() * map->stiffness;
      by_parameter.noalias() += simulation.rate().asDiagonal() * map->damping;
      drive.subtract_derivative(time, *map, by_parameter);
      sensitivity.follow(simulation, by_parameter);
    }
    for (; sample < record.samples() && (record.time[sample] <= time || k == steps); ++sample) {
      const double s = std::clamp(1.0 - (time - record.time[sample]) / even.time_step, 0.0, 1.0);
      const Hermite hermite(s, even.time_step);
      q = hermite.mix(before, speed_before, simulation.position(), simulation.rate());
      const Points ends = equations.endpoints(q);
      result.row(sample) = Eigen::Map<const Eigen::RowVectorXd>(ends.data(), wide);
      if (map == nullptr) continue;
      jacobian->middleRows(sample * wide, wide).noalias() =
          equations.endpoint_jacobian(q) * hermite.mix<MatrixX>(position_before, rate_before,
                                                                sensitivity.position(),
                                                                sensitivity.rate());
    }
  }
  return result;
}

ArmStart first_pose(const pcc::Arm& arm, const MotionRecord& record) {
  const Eigen::Index n = arm.coordinates(), wide = record.position.cols();
  VectorX seen = VectorX::Zero(wide), weight = VectorX::Zero(wide);
  for (Eigen::Index k = 0; k < wide; ++k) {
    for (Eigen::Index row = 0; row < record.samples() && weight[k] == 0.0; ++row) {
      if (std::isnan(record.position(row, k))) continue;
      seen[k] = record.position(row, k);
      weight[k] = 1.0;
    }
  }
  // Gauss-Newton, damped so that segments without markers stay straight.
  pcc::ArmEquations equations(std::make_shared<const pcc::Arm>(arm));
  VectorX q = VectorX::Zero(n);
  const double damping = 1e-6 * arm.length() * arm.length();
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Points ends = equations.endpoints(q);
    const VectorX error =
        weight.asDiagonal() * (seen - Eigen::Map<const VectorX>(ends.data(), wide));
    const MatrixX& jacobian = equations.endpoint_jacobian(q);
    const MatrixX normal =
        jacobian.transpose() * weight.asDiagonal() * jacobian + damping * MatrixX::Identity(n, n);
    VectorX move = linalg::solve_symmetric(normal, jacobian.transpose() * error - damping * q);
    move *= std::min(1.0, 1.0 / std::max(1e-300, move.cwiseAbs().maxCoeff()));
    q += move;
    if (move.cwiseAbs().maxCoeff() < 1e-10) break;
  }
  return {q, VectorX::Zero(n)};
}

}  // namespace sinew::identify
