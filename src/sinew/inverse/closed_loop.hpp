/// @file
/// Feedback on measured effectors: resolved rate and PI, with the delay of sensors made up for.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/inverse/rate_program.hpp"
#include "sinew/inverse/target_controller.hpp"
#include "sinew/sim/commander.hpp"

namespace sinew::inverse {

/// What a computer beside the robot does: before each step of T seconds it takes the samples y that
/// its sensors have delivered, asks effectors with targets r for the velocity
///   v = dr/dt + gain e + integral (time integral of e),   e = r - y - (motion since the sample),
/// and commands actuators delta_a + W_aa u, chambers and other pressures lambda + u, where
/// choose_change() finds the changes of efforts u for W_ea u = v T within all limits. W is the
/// compliance of equilibrium at the robot's present state (sim::controlled_response()), without
/// inertia: d delta_e = J d delta_a with J = W_ea W_aa^+ (Zhang, Dequidt, Kruszewski, Largilliere
/// and Duriez, IROS 2016).
///
/// The motion since the sample was taken is the sum of W_ea u of the steps since then (Smith, Chem.
/// Eng. Prog. 53 (1957) 217): with an exact W a delay leaves the gain's limit of stability where it
/// is, 2/T. Nothing else of the simulation's state is used, so outside forces show in the samples
/// alone.
///
/// What limits keep from the effectors is taken off the integral (back-calculation).
///
/// While a sample is older than its sensor's delay and Feedback::timeout, or than the sensor's own
/// timeout, and before the first one, all commands and the integral are held: `holding`.
class ClosedLoop : public TargetController, public sim::Commander {
 public:
  /// @param simulation must outlive the controller. @param settings with feedback.
  /// Throws what check_settings() does, and Error: wrong-length (sensors), wrong-type (a sensor
  /// that does not measure what the effector is), out-of-range (gain, integral, timeout; a sensor
  /// whose samples are farther apart than the timeout).
  ClosedLoop(sim::Simulation& simulation, InverseSettings settings);
  ~ClosedLoop() override;

  void detach() override;
  /// Those that the actuators have.
  VectorX efforts() const override;
  double measured_error(int task) const override;
  std::string conflict() const override;

  void command() override;
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
  InverseStatus judge(const RateChoice& choice, const VectorX& wanted, const VectorX& moved) const;
  template <class Self, class Visitor>
  static void visit_memory(Self& self, Visitor&& visitor);

  bool attached_ = false;
  double time_step_ = 0.0;           // s
  std::vector<Eigen::Index> first_;  // (tasks,) rows
  VectorX weights_;                  // (rows,) Q
  VectorX integral_;                 // (rows,) of the error, m s
  MatrixX foreseen_;                 // (rows, k): W_ea u of the last k steps, step n in n mod k
  VectorX commands_;                 // (actuators,)
  VectorX
      silent_;  // (tasks,) s, how old a sample that was too old was; 0: none, -1: there was none
  bool started_ = false;  // whether it has commanded
};

}  // namespace sinew::inverse
