/// @file
/// What sensors measure: true values of a run, before any channel.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sinew/constraint/probe.hpp"

namespace sinew::constraint {
class OrientationEffector;
}

namespace sinew::sim {

struct Run;

/// Reads one quantity of a run. It only looks. Rates of change have a memory of the step before.
class SensorSource {
 public:
  virtual ~SensorSource() = default;
  /// What read() writes.
  const std::vector<constraint::ProbeComponent>& components() const { return components_; }
  std::size_t size() const { return components_.size(); }
  /// Where it is read off the shape; null elsewhere.
  virtual const constraint::Probe* probe() const { return nullptr; }

  virtual std::size_t memory_size() const { return 0; }  ///< numbers
  /// As if the run had stood still so far. @param run now. @param memory (memory_size(),),
  /// replaced.
  virtual void begin(const Run& run, std::span<double> memory) const;
  /// After a step. @param run now. @param time_step s. @param memory (memory_size(),), in and out.
  virtual void advance(const Run& run, double time_step, std::span<double> memory) const;
  /// @param run now. @param memory (memory_size(),). @param values (size(),), replaced.
  virtual void read(const Run& run, std::span<const double> memory,
                    std::span<double> values) const = 0;

 protected:
  explicit SensorSource(std::vector<constraint::ProbeComponent> components)
      : components_(std::move(components)) {}

 private:
  std::vector<constraint::ProbeComponent> components_;
};

/// What a probe measures.
class ProbeSource : public SensorSource {
 public:
  explicit ProbeSource(std::unique_ptr<const constraint::Probe> probe)
      : SensorSource(probe->components()), probe_(std::move(probe)) {}
  const constraint::Probe* probe() const override { return probe_.get(); }
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  std::unique_ptr<const constraint::Probe> probe_;
};

/// How something has turned since rest: the rotation vector, rad, about the world's axes.
class RotationSource : public SensorSource {
 public:
  explicit RotationSource(std::shared_ptr<const constraint::OrientationEffector> orientation);
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  std::shared_ptr<const constraint::OrientationEffector> orientation_;
};

/// Its angular velocity in the sensor's own axes, rad/s, those of the world at rest: R^T log(R
/// R_before^T)/h, the mean over a step. Memory: R_before (9), the mean (3).
class GyroscopeSource : public SensorSource {
 public:
  explicit GyroscopeSource(std::shared_ptr<const constraint::OrientationEffector> orientation);
  std::size_t memory_size() const override { return 12; }
  void begin(const Run& run, std::span<double> memory) const override;
  void advance(const Run& run, double time_step, std::span<double> memory) const override;
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  std::shared_ptr<const constraint::OrientationEffector> orientation_;
};

/// Specific force in the same axes, m/s^2: R^T (a - g), at rest against gravity; a is the mean over
/// a step, (v - v_before)/h, of the material points' mean. Memory: v_before (3), a (3).
class AccelerometerSource : public SensorSource {
 public:
  /// @param orientation of the sensor. @param points where it is. @param gravity (3,) m/s^2.
  AccelerometerSource(std::shared_ptr<const constraint::OrientationEffector> orientation,
                      std::vector<mechanics::MaterialPoint> points, const Vector3& gravity);
  std::size_t memory_size() const override { return 6; }
  void begin(const Run& run, std::span<double> memory) const override;
  void advance(const Run& run, double time_step, std::span<double> memory) const override;
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  Vector3 velocity(const Run& run) const;

  std::shared_ptr<const constraint::OrientationEffector> orientation_;
  std::vector<mechanics::MaterialPoint> points_;
  Vector3 gravity_;
};

/// The effort of an actuator, times a factor.
class EffortSource : public SensorSource {
 public:
  /// @param actuator its number. @param factor of its effort. @param unit of the product.
  EffortSource(int actuator, double factor, const char* unit)
      : SensorSource({{"", unit}}), actuator_(actuator), factor_(factor) {}
  int actuator() const { return actuator_; }
  double factor() const { return factor_; }
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  int actuator_;
  double factor_;
};

/// The motion of an actuator.
class MotionSource : public SensorSource {
 public:
  /// @param actuator its number. @param unit of its motion.
  MotionSource(int actuator, const char* unit) : SensorSource({{"", unit}}), actuator_(actuator) {}
  int actuator() const { return actuator_; }
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  int actuator_;
};

/// Flow into a chamber, m^3/s, the mean over a step: of its gas, as volume at ambient pressure, or
/// its liquid; of a chamber with neither the growth of its volume. Memory: the content before, the
/// mean.
class FlowSource : public SensorSource {
 public:
  explicit FlowSource(int actuator) : SensorSource({{"", "m^3/s"}}), actuator_(actuator) {}
  std::size_t memory_size() const override { return 2; }
  void begin(const Run& run, std::span<double> memory) const override;
  void advance(const Run& run, double time_step, std::span<double> memory) const override;
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  double content(const Run& run) const;

  int actuator_;
};

/// The sum of the normal forces of contacts, N, or whether it exceeds a threshold, 1 or 0. With a
/// patch, of the points whose nearest node of a body's mesh belongs to it.
class TouchSource : public SensorSource {
 public:
  struct Patch {
    int body = -1;              ///< of all contacts; -1: everywhere
    std::vector<NodeId> outer;  ///< nodes of the body's surface
    std::vector<char> within;   ///< (outer,) whether they belong to the patch
  };
  /// @param contacts their numbers. @param patch see there. @param threshold N, of a switch; none:
  /// it measures.
  TouchSource(std::vector<int> contacts, Patch patch, const std::optional<double>& threshold);
  void read(const Run& run, std::span<const double> memory,
            std::span<double> values) const override;

 private:
  bool counts(const Run& run, const Vector3& position) const;

  std::vector<int> contacts_;
  Patch patch_;
  std::optional<double> threshold_;
};

}  // namespace sinew::sim
