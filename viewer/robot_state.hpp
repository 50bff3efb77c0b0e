/// @file
/// A simulation with its controllers and what a browser has done to it; makes frames of it. Not
/// thread-safe: one thread owns it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/fem/nodal_fields.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/simulation.hpp"

#include "describe.hpp"
#include "frame.hpp"
#include "message.hpp"

namespace sinew::viewer {

/// Why a run ended before its time.
struct StoppedRun {
  std::int64_t step = 0;
  std::string kind, message, remedy;
};

/// A moment of a recorded run.
struct RecordedState {
  std::vector<Points> positions;         ///< (n, 3) m a body, in the model's order
  std::vector<double> efforts, motions;  ///< (actuators,) N and m
  std::int64_t step = 0;
};

class RobotState {
 public:
  /// @param robot is simulated. @param controller as for LiveSettings.
  RobotState(scene::Robot robot, const std::string& controller);

  const Description& description() const { return description_; }
  const sim::Simulation& simulation() const { return *simulation_; }
  double time_step() const { return simulation_->model().step().time_step; }
  const std::optional<StoppedRun>& stopped() const { return stopped_; }

  /// One step; what it throws is kept as stopped().
  void step();
  void reset();
  void settle();
  void command(const SetCommand& command);
  void choose_controller(const std::optional<std::string>& name);
  void set_target(const SetTarget& target);
  /// Puts a recorded moment in place of the present one; velocities are zero.
  void show(const RecordedState& recorded);
  void pull(const Pull& pull);
  void release();

  /// Everything that is to be seen now.
  /// @param wanted which fields are. @param real_time_factor is among the signals.
  std::shared_ptr<const Frame> frame(const std::array<bool, kFieldCount>& wanted,
                                     double real_time_factor);
  /// JSON of the status message without what the source itself knows: controller, commands,
  /// targets, troubles, stopped.
  std::string status_members() const;

 private:
  void attach(const std::string& name, const inverse::InverseSettings& settings);
  void detach();
  int task_of(int effector) const;
  void fill_signals(Frame& frame, double real_time_factor);
  void fill_body(std::size_t index, const std::array<bool, kFieldCount>& wanted, BodyFrame& frame);
  void fill_points(Frame& frame) const;

  scene::Robot robot_;
  Description description_;
  std::unique_ptr<sim::Simulation> simulation_;
  std::unique_ptr<inverse::InverseController> controller_;
  std::string controller_name_;
  std::string first_controller_;
  std::vector<std::unique_ptr<fem::NodalFields>> fields_;
  std::vector<double> nodal_;
  std::map<std::string, Vector3> targets_;
  std::optional<int> pulled_;  ///< body
  std::optional<StoppedRun> stopped_;
  std::uint64_t shape_ = 0;
};

}  // namespace sinew::viewer
