/// @file
/// Sources of sensors: true values of a run, before any channel.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sinew/constraint/probe.hpp"

namespace sinew::constraint {
enum class EffectorKind;
class OrientationEffector;
}  // namespace sinew::constraint

namespace sinew::run {
struct Run;
}

namespace sinew::sense {

/// Reads one quantity of a run, without changing the run. Sources of rates keep a memory of the
/// previous step.
class SensorSource {
 public:
  virtual ~SensorSource() = default;
  /// The components that read() writes.
  const std::vector<constraint::ProbeComponent>& components() const { return components_; }
  std::size_t size() const { return components_.size(); }
  /// The probe for a quantity measured on the shape; null for other quantities.
  virtual const constraint::Probe* probe() const { return nullptr; }
  /// The kind of effectors that have the same value where they have the same place; none: no kind.
  virtual std::optional<constraint::EffectorKind> effector_kind() const { return std::nullopt; }

  virtual std::size_t memory_size() const { return 0; }  ///< number of values
  /// Initialises the memory as if the run had been at rest. @param run at its present time.
  /// @param memory (memory_size(),), overwritten.
  virtual void begin(const run::Run& run, std::span<double> memory) const;
  /// Updates the memory after a step. @param run at its present time. @param time_step s.
  /// @param memory (memory_size(),), in and out.
  virtual void advance(const run::Run& run, double time_step, std::span<double> memory) const;
  /// Reads the quantity. @param run at its present time. @param memory (memory_size(),).
  /// @param values (size(),), overwritten.
  virtual void read(const run::Run& run, std::span<const double> memory,
                    std::span<double> values) const = 0;

 protected:
  explicit SensorSource(std::vector<constraint::ProbeComponent> components)
      : components_(std::move(components)) {}

 private:
  std::vector<constraint::ProbeComponent> components_;
};

/// The value of a probe.
class ProbeSource : public SensorSource {
 public:
  explicit ProbeSource(std::unique_ptr<const constraint::Probe> probe)
      : SensorSource(probe->components()), probe_(std::move(probe)) {}
  const constraint::Probe* probe() const override { return probe_.get(); }
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  std::unique_ptr<const constraint::Probe> probe_;
};

/// The position of a point.
class PositionSource : public ProbeSource {
 public:
  explicit PositionSource(std::unique_ptr<const constraint::PointProbe> probe)
      : ProbeSource(std::move(probe)) {}
  std::optional<constraint::EffectorKind> effector_kind() const override;
};

/// Rotation since rest: the rotation vector, rad, in world axes.
class RotationSource : public SensorSource {
 public:
  explicit RotationSource(std::shared_ptr<const constraint::OrientationEffector> orientation);
  std::optional<constraint::EffectorKind> effector_kind() const override;
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  std::shared_ptr<const constraint::OrientationEffector> orientation_;
};

/// Angular velocity in the sensor's axes, which are the world axes at rest, rad/s: R^T log(R
/// R_before^T)/h, the mean over a step. Memory: R_before (9), the mean (3).
class GyroscopeSource : public SensorSource {
 public:
  explicit GyroscopeSource(std::shared_ptr<const constraint::OrientationEffector> orientation);
  std::size_t memory_size() const override { return 12; }
  void begin(const run::Run& run, std::span<double> memory) const override;
  void advance(const run::Run& run, double time_step, std::span<double> memory) const override;
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  std::shared_ptr<const constraint::OrientationEffector> orientation_;
};

/// Specific force in the sensor's axes, m/s^2: R^T (a - g), opposite to gravity at rest; a is the
/// mean acceleration (v - v_before)/h over a step of the mean of the material points. Memory:
/// v_before (3), a (3).
class AccelerometerSource : public SensorSource {
 public:
  /// @param orientation of the sensor. @param points whose mean is its position.
  /// @param gravity (3,) m/s^2.
  AccelerometerSource(std::shared_ptr<const constraint::OrientationEffector> orientation,
                      std::vector<mechanics::MaterialPoint> points, const Vector3& gravity);
  std::size_t memory_size() const override { return 6; }
  void begin(const run::Run& run, std::span<double> memory) const override;
  void advance(const run::Run& run, double time_step, std::span<double> memory) const override;
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  Vector3 velocity(const run::Run& run) const;

  std::shared_ptr<const constraint::OrientationEffector> orientation_;
  std::vector<mechanics::MaterialPoint> points_;
  Vector3 gravity_;
};

/// The effort of an actuator, times a factor.
class EffortSource : public SensorSource {
 public:
  /// @param actuator index. @param factor of its effort. @param unit of the product.
  EffortSource(int actuator, double factor, const char* unit)
      : SensorSource({{"", unit}}), actuator_(actuator), factor_(factor) {}
  int actuator() const { return actuator_; }
  double factor() const { return factor_; }
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  int actuator_;
  double factor_;
};

/// The motion of an actuator.
class MotionSource : public SensorSource {
 public:
  /// @param actuator index. @param unit of its motion.
  MotionSource(int actuator, const char* unit) : SensorSource({{"", unit}}), actuator_(actuator) {}
  int actuator() const { return actuator_; }
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  int actuator_;
};

/// Flow into a chamber, m^3/s, the mean over a step: of gas, as volume at ambient pressure, or of
/// liquid; without either, the rate of the chamber's volume. Memory: the content at the previous
/// step, the mean.
class FlowSource : public SensorSource {
 public:
  explicit FlowSource(int actuator) : SensorSource({{"", "m^3/s"}}), actuator_(actuator) {}
  std::size_t memory_size() const override { return 2; }
  void begin(const run::Run& run, std::span<double> memory) const override;
  void advance(const run::Run& run, double time_step, std::span<double> memory) const override;
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  double content(const run::Run& run) const;

  int actuator_;
};

/// The sum of the normal forces of contacts, N, or whether it exceeds a threshold, 1 or 0. With a
/// patch, only contact points count whose nearest surface node of a body belongs to the patch.
class TouchSource : public SensorSource {
 public:
  struct Patch {
    int body = -1;              ///< takes part in all contacts; -1: no restriction
    std::vector<NodeId> outer;  ///< nodes of the body's surface
    std::vector<char> within;   ///< (outer,) whether each belongs to the patch
  };
  /// @param contacts indices. @param patch restriction to a part of a surface.
  /// @param threshold N, for a switch; none: the force is measured.
  TouchSource(std::vector<int> contacts, Patch patch, const std::optional<double>& threshold);
  void read(const run::Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  bool counts(const run::Run& run, const Vector3& position) const;

  std::vector<int> contacts_;
  Patch patch_;
  std::optional<double> threshold_;
};

}  // namespace sinew::sense
