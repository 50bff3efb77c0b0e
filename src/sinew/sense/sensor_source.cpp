#include "sinew/sense/sensor_source.hpp"

#include <limits>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/run.hpp"
#include "sinew/world/end_efforts.hpp"

namespace sinew::sense {

namespace {

std::vector<constraint::ProbeComponent> axes(const char* unit, const char* prefix = "") {
  const std::string p = prefix;
  return {{p + "x", unit}, {p + "y", unit}, {p + "z", unit}};
}

Matrix3 rotation_of(const constraint::OrientationEffector& orientation, const run::Run& run) {
  return rotation_matrix(orientation.value(run.world.configuration()));
}

void put(const Vector3& vector, std::span<double> to) { std::copy_n(vector.data(), 3, to.begin()); }

const model::ActuatorState& actuator_of(const run::Run& run, int actuator) {
  return run.actuation.states()[static_cast<std::size_t>(actuator)];
}

}  // namespace

void SensorSource::begin(const run::Run& /*run*/, std::span<double> /*memory*/) const {}
void SensorSource::advance(const run::Run& /*run*/, double /*time_step*/,
                           std::span<double> /*memory*/) const {}

void ProbeSource::read(const run::Run& run, std::span<const double> /*memory*/,
                       std::span<double> values) const {
  probe_->measure(run.world.configuration(), values);
}

std::optional<constraint::EffectorKind> PositionSource::effector_kind() const {
  return constraint::EffectorKind::point;
}

RotationSource::RotationSource(std::shared_ptr<const constraint::OrientationEffector> orientation)
    : SensorSource(axes("rad", "r")), orientation_(std::move(orientation)) {}

std::optional<constraint::EffectorKind> RotationSource::effector_kind() const {
  return constraint::EffectorKind::orientation;
}

void RotationSource::read(const run::Run& run, std::span<const double> /*memory*/,
                          std::span<double> values) const {
  put(orientation_->value(run.world.configuration()), values);
}

GyroscopeSource::GyroscopeSource(std::shared_ptr<const constraint::OrientationEffector> orientation)
    : SensorSource(axes("rad/s")), orientation_(std::move(orientation)) {}

void GyroscopeSource::begin(const run::Run& run, std::span<double> memory) const {
  Eigen::Map<Matrix3>(memory.data()) = rotation_of(*orientation_, run);
  put(Vector3::Zero(), memory.subspan(9));
}

void GyroscopeSource::advance(const run::Run& run, double time_step,
                              std::span<double> memory) const {
  Eigen::Map<Matrix3> before(memory.data());
  const Matrix3 now = rotation_of(*orientation_, run);
  const Vector3 turn = rotation_vector(now * before.transpose());
  put(now.transpose() * turn / time_step, memory.subspan(9));
  before = now;
}

void GyroscopeSource::read(const run::Run& /*run*/, std::span<const double> memory,
                           std::span<double> values) const {
  std::ranges::copy(memory.subspan(9), values.begin());
}

AccelerometerSource::AccelerometerSource(
    std::shared_ptr<const constraint::OrientationEffector> orientation,
    std::vector<mechanics::MaterialPoint> points, const Vector3& gravity)
    : SensorSource(axes("m/s^2")),
      orientation_(std::move(orientation)),
      points_(std::move(points)),
      gravity_(gravity) {}

Vector3 AccelerometerSource::velocity(const run::Run& run) const {
  Vector3 sum = Vector3::Zero();
  for (const mechanics::MaterialPoint& point : points_) {
    sum += run.world.configuration().velocity(point);
  }
  return sum / static_cast<double>(points_.size());
}

void AccelerometerSource::begin(const run::Run& run, std::span<double> memory) const {
  put(velocity(run), memory);
  put(Vector3::Zero(), memory.subspan(3));
}

void AccelerometerSource::advance(const run::Run& run, double time_step,
                                  std::span<double> memory) const {
  const Vector3 now = velocity(run);
  put((now - Eigen::Map<const Vector3>(memory.data())) / time_step, memory.subspan(3));
  put(now, memory);
}

void AccelerometerSource::read(const run::Run& run, std::span<const double> memory,
                               std::span<double> values) const {
  const Eigen::Map<const Vector3> acceleration(&memory[3]);
  put(rotation_of(*orientation_, run).transpose() * (acceleration - gravity_), values);
}

void EffortSource::read(const run::Run& run, std::span<const double> /*memory*/,
                        std::span<double> values) const {
  const int row = run.model->actuators()[static_cast<std::size_t>(actuator_)].row;
  values[0] = factor_ * run.world.end_efforts().at_end(run.effort, row);
}

void MotionSource::read(const run::Run& run, std::span<const double> /*memory*/,
                        std::span<double> values) const {
  values[0] = actuator_of(run, actuator_).motion;
}

double FlowSource::content(const run::Run& run) const {
  const std::span<const double> filled = run.actuation.drive_state(actuator_);
  return filled.empty() ? actuator_of(run, actuator_).motion : filled.front();
}

void FlowSource::begin(const run::Run& run, std::span<double> memory) const {
  memory[0] = content(run);
  memory[1] = 0.0;
}

void FlowSource::advance(const run::Run& run, double time_step, std::span<double> memory) const {
  const double now = content(run);
  memory[1] = (now - memory[0]) / time_step;
  memory[0] = now;
}

void FlowSource::read(const run::Run& /*run*/, std::span<const double> memory,
                      std::span<double> values) const {
  values[0] = memory[1];
}

TouchSource::TouchSource(std::vector<int> contacts, Patch patch,
                         const std::optional<double>& threshold)
    : SensorSource({{"", threshold ? "" : "N"}}),
      contacts_(std::move(contacts)),
      patch_(std::move(patch)),
      threshold_(threshold) {}

bool TouchSource::counts(const run::Run& run, const Vector3& position) const {
  if (patch_.body < 0) return true;
  const Points& nodes =
      run.world.bodies().all()[static_cast<std::size_t>(patch_.body)]->positions();
  double nearest = std::numeric_limits<double>::infinity();
  bool within = false;
  for (std::size_t k = 0; k < patch_.outer.size(); ++k) {
    const double distance = (nodes.row(patch_.outer[k]).transpose() - position).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    within = patch_.within[k] != 0;
  }
  return within;
}

void TouchSource::read(const run::Run& run, std::span<const double> /*memory*/,
                       std::span<double> values) const {
  const run::ContactReader reader(run);
  double sum = 0.0;
  for (const int index : contacts_) {
    const constraint::Contact& contact = run.model->contact(index);
    const Eigen::Isometry3d pose = reader.pose(index);
    for (std::size_t k = 0; k < contact.size(); ++k) {
      const double force = run.effort[static_cast<std::size_t>(contact.row(k))];
      if (force > 0.0 && counts(run, reader.point(index, k, pose).position)) sum += force;
    }
  }
  values[0] = !threshold_ ? sum : sum > *threshold_ ? 1.0 : 0.0;
}

}  // namespace sinew::sense
