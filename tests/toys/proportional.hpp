/// @file
/// A controller that the library does not know: it descends the error of its first effector. Before
/// each step it changes the efforts of its actuators by
///   u = gain W^T e / |W|^2,
/// where e is the error, (rows,), and W the compliance of the effector to these efforts; products
/// and norms are weighted by the task.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/constraint/effector.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/actuation.hpp"
#include "sinew/run/commander.hpp"
#include "sinew/sim/controlled_response.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::testing {

struct ProportionalSettings {
  std::string name = "follow";  ///< of its observables
  double gain = 0.5;
};

class Proportional : public control::TargetController, public run::Commander {
 public:
  using Settings = ProportionalSettings;

  Proportional(sim::Simulation& simulation, control::TargetSettings settings, Settings own)
      : TargetController(simulation, std::move(settings)),
        own_(std::move(own)),
        change_{run::observable_of(run::ObservableKind::controller, own_.name, "change", "N")},
        memory_(VectorX::Zero(std::ssize(settings_.actuators) + 2)) {
    simulation_.attach(*this, settings_.actuators);
    attached_ = true;
  }
  ~Proportional() override { Proportional::detach(); }

  void detach() override {
    if (attached_) simulation_.detach(*this);
    attached_ = false;
  }
  control::ControllerSettings all_settings() const override {
    return control::settings_for<Proportional>(settings_, own_);
  }
  const std::vector<run::Observable>& observables() const override { return change_; }
  void read(std::span<double> to) const override { to[0] = memory_[1]; }

  // The products are loops: the linker may take a kernel of Eigen that is compiled here, without
  // the library's optimisation, for all of the program, which then rounds differently.
  void command() override {
    const MatrixX w = sim::controlled_response(simulation_, settings_.actuators).effectors[own()];
    const VectorX gap = this->gap();
    double size = 1e-300;
    for (Eigen::Index r = 0; r < w.rows(); ++r) {
      for (Eigen::Index k = 0; k < w.cols(); ++k) size += weight(r) * w(r, k) * w(r, k);
    }
    memory_[1] = 0.0;
    for (Eigen::Index k = 0; k < w.cols(); ++k) {
      const int index = settings_.actuators[static_cast<std::size_t>(k)];
      const model::ActuatorModel& model =
          simulation_.model().actuators()[static_cast<std::size_t>(index)];
      const double before = memory_[k + 2];
      double wanted = 0.0;
      for (Eigen::Index r = 0; r < w.rows(); ++r) {
        wanted += own_.gain / size * weight(r) * w(r, k) * gap[r];
      }
      const run::Interval may =
          run::reachable(model.effort, before, simulation_.model().step().time_step);
      const double least = model.kind->pulls_only ? std::max(0.0, may.min) : may.min;
      memory_[k + 2] = std::clamp(before + wanted, least, std::max(least, may.max));
      memory_[1] = std::max(memory_[1], std::abs(memory_[k + 2] - before));
    }
    tell();
    set(error() <= settings_.tolerance ? control::ControllerStatus::on_target
                                       : control::ControllerStatus::moving);
  }
  void hold_back() override { set(control::ControllerStatus::held_back); }

  std::size_t memory_size() const override { return static_cast<std::size_t>(memory_.size()); }
  void save_memory(std::span<double> memory) const override {
    std::ranges::copy(memory_, memory.begin());
  }
  void load_memory(std::span<const double> memory) override {
    std::ranges::copy(memory, memory_.begin());
    status_ = control::controller_status_of(memory_[0]);
  }
  void forget() override {
    memory_.setZero();
    set(control::ControllerStatus::not_started);
  }

 private:
  std::size_t own() const { return static_cast<std::size_t>(settings_.tasks.front().effector); }
  double weight(Eigen::Index row) const { return settings_.tasks.front().weight(row); }
  VectorX gap() const {
    const constraint::Effector& effector = simulation_.model().effector(static_cast<int>(own()));
    const auto& present = simulation_.configuration();
    VectorX goal(effector.row_count()), now(effector.row_count());
    const Vector3 target = settings_.tasks.front().target.at(simulation_.time());
    effector.target_delta(present, target, goal);
    effector.target_delta(present, effector.value(present), now);
    return goal - now;
  }
  void tell() {
    for (std::size_t k = 0; k < settings_.actuators.size(); ++k) {
      const double effort = memory_[static_cast<Eigen::Index>(k) + 2];
      simulation_.command(settings_.actuators[k],
                          {model::CommandKind::effort, model::Signal::constant(effort)}, this);
    }
  }
  void set(control::ControllerStatus status) {
    status_ = status;
    memory_[0] = static_cast<double>(status);
  }

  Settings own_;
  std::vector<run::Observable> change_;
  VectorX memory_;  // status, largest change of the last step, commands
  bool attached_ = false;
};

}  // namespace sinew::testing
