/// @file
/// Feedback control on measured effectors: resolved-rate and PI control with delay compensation.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sinew/control/closed_loop_settings.hpp"
#include "sinew/control/rate_program.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/core/types.hpp"
#include "sinew/run/commander.hpp"

namespace sinew::control {

/// Closed-loop controller, as it runs on a computer beside the robot. Before each step of T seconds
/// it takes the samples y that its sensors have delivered. For effectors with targets r it asks for
/// the velocity
///   v = dr/dt + gain e + integral (time integral of e),   e = r - y - (motion since the sample).
/// choose_change() finds the changes of efforts u that give W_ea u = v T within all limits.
/// Chambers are commanded lambda + u, and all other actuators delta_a + W_aa u. W is the compliance
/// of equilibrium at the robot's present state (sim::controlled_response()), without inertia: d
/// delta_e = J d delta_a with J = W_ea W_aa^+ (Zhang, Dequidt, Kruszewski, Largilliere and Duriez,
/// IROS 2016).
///
/// The motion since the sample was taken is the sum of W_ea u over the steps since then (Smith
/// predictor, Chem. Eng. Prog. 53 (1957) 217). With an exact W, a delay therefore does not change
/// the stability limit of the gain, 2/T. Nothing else of the simulation's state is used, so
/// external forces show in the samples only.
///
/// Anti-windup: the part of the motion that limits prevent is subtracted from the integral
/// (back-calculation).
///
/// All commands and the integral are held (status `holding`) before the first sample, and while a
/// sample is older than its sensor's delay plus ClosedLoopSettings::timeout, or than the sensor's
/// own timeout.
class ClosedLoop : public TargetController, public run::Commander {
 public:
  using Settings = ClosedLoopSettings;

  /// @param simulation must outlive the controller. @param settings tasks and actuators.
  /// @param own sensors and gains.
  /// Throws what check_settings() throws, and Error: no-effectors, wrong-length (sensors),
  /// wrong-type (a sensor of another kind than its effector), out-of-range (gain, integral,
  /// timeout; a sensor whose sampling period exceeds the timeout).
  ClosedLoop(sim::Simulation& simulation, TargetSettings settings, ClosedLoopSettings own);
  ~ClosedLoop() override;

  void detach() override;
  ControllerSettings all_settings() const override {
    return settings_for<ClosedLoop>(settings_, own_);
  }
  /// The settings that only a closed loop has.
  const ClosedLoopSettings& own_settings() const { return own_; }
  int sensor(int task) const override { return own_.sensors.at(static_cast<std::size_t>(task)); }
  double measured_error(int task) const override;
  std::string conflict() const override;

  void command() override;
  void hold_back() override;
  std::size_t memory_size() const override;
  void save_memory(std::span<double> memory) const override;
  void load_memory(std::span<const double> memory) override;
  void forget() override;

 private:
  bool note_silence();
  bool is_told_motion(std::size_t actuator) const;
  Vector3 difference(int task, double time, const Vector3& from) const;
  VectorX along(int task, const Vector3& difference) const;
  VectorX error_now() const;
  VectorX lead() const;
  RateLimits limits() const;
  void tell(const VectorX& change, const MatrixX& w_aa);
  void push_commands();
  ControllerStatus judge(const RateChoice& choice, const VectorX& wanted,
                         const VectorX& moved) const;
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);

  ClosedLoopSettings own_;
  bool attached_ = false;
  double time_step_ = 0.0;           // s
  std::vector<Eigen::Index> first_;  // (tasks,) rows
  VectorX weights_;                  // (rows,) Q
  VectorX integral_;                 // (rows,) of the error, m s
  MatrixX foreseen_;  // (rows, k): W_ea u of the last k steps, step n in column n mod k
  VectorX commands_;  // (actuators,)
  VectorX
      silent_;  // (tasks,) s, age of a sample that is too old; 0: not too old, -1: no sample yet
  bool started_ = false;  // whether it has sent a command
};

}  // namespace sinew::control
