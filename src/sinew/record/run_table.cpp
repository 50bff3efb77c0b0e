#include "sinew/record/run_table.hpp"

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"

namespace sinew::record {

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

void add_vector(std::vector<double>& values, const Vector3& vector) {
  values.insert(values.end(), vector.data(), vector.data() + 3);
}

}  // namespace

RunTable::RunTable(const std::filesystem::path& path, sim::Simulation& simulation,
                   const inverse::InverseController* controller)
    : simulation_(simulation),
      controller_(controller),
      writer_(path, names(simulation, controller)) {}

std::vector<std::string> RunTable::names(const sim::Simulation& simulation,
                                         const inverse::InverseController* controller) {
  const sim::Model& model = simulation.model();
  std::vector<std::string> names = {"time [s]"};
  for (const sim::ActuatorModel& actuator : model.actuators()) {
    for (const auto& [name, unit] : {actuator.effort_name(), actuator.motion_name()}) {
      names.push_back(fmt::format("{}.{} [{}]", actuator.name, name, unit));
    }
  }
  const auto unit = [&](std::size_t effector) {
    return std::string(model.effector(static_cast<int>(effector)).unit());
  };
  const auto axis = [&](std::size_t effector, const char* name) {
    return (unit(effector) == "rad" ? "r" : "") + std::string(name);
  };
  for (std::size_t e = 0; e < model.effectors().size(); ++e) {
    for (const char* name : kAxes) {
      names.push_back(fmt::format("{}.{} [{}]", model.effectors()[e].name, axis(e, name), unit(e)));
    }
  }
  for (const sim::ContactModel& contact : model.contacts()) {
    for (const char* name : {"force_x [N]", "force_y [N]", "force_z [N]", "normal_force [N]",
                             "friction_force [N]", "gap [m]", "sticking", "slipping"}) {
      names.push_back(fmt::format("{}.{}", contact.name, name));
    }
  }
  if (controller != nullptr) {
    for (const inverse::Task& task : controller->settings().tasks) {
      const auto e = static_cast<std::size_t>(task.effector);
      const std::string& effector = model.effectors()[e].name;
      for (const char* name : kAxes) {
        names.push_back(fmt::format("{}.target_{} [{}]", effector, axis(e, name), unit(e)));
      }
      names.push_back(fmt::format("{}.error [{}]", effector, unit(e)));
    }
  }
  for (const char* name : {"strain_energy [J]", "kinetic_energy [J]", "gravity_energy [J]",
                           "actuator_work [J]", "outside_work [J]", "dissipation [J]",
                           "numerical_loss [J]", "residual [N]", "relative_residual", "iterations",
                           "scale", "smallest_volume_ratio", "status", "controller"}) {
    names.emplace_back(name);
  }
  return names;
}

void RunTable::collect() {
  const sim::Model& model = simulation_.model();
  values_.clear();
  values_.push_back(simulation_.time());
  for (std::size_t a = 0; a < model.actuators().size(); ++a) {
    const sim::ActuatorState& state = simulation_.actuator(static_cast<int>(a));
    values_.push_back(state.effort);
    values_.push_back(state.motion);
  }
  for (std::size_t e = 0; e < model.effectors().size(); ++e) {
    add_vector(values_, simulation_.effector_value(static_cast<int>(e)));
  }
  for (std::size_t c = 0; c < model.contacts().size(); ++c) {
    const sim::ContactSum sum = simulation_.contact_sum(static_cast<int>(c));
    add_vector(values_, sum.force);
    values_.insert(values_.end(),
                   {sum.normal_force, sum.friction_force, sum.smallest_gap,
                    static_cast<double>(sum.sticking), static_cast<double>(sum.slipping)});
  }
  if (controller_ != nullptr) {
    const auto& tasks = controller_->settings().tasks;
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      add_vector(values_, tasks[t].target.at(simulation_.time()));
      values_.push_back(controller_->error(static_cast<int>(t)));
    }
  }
  collect_energies();
  const sim::StepReport& report = simulation_.report();
  values_.insert(values_.end(),
                 {report.residual, report.relative_residual, static_cast<double>(report.iterations),
                  report.scale, report.smallest_volume_ratio});
}

// What actuators have put in since the first row is in the bodies or lost: to damping, and to the
// integrator.
void RunTable::collect_energies() {
  const auto [strain, kinetic, gravity] = simulation_.energies();
  const double energy = strain + kinetic + gravity;
  if (!started_) {
    first_energy_ = energy;
    first_work_ = simulation_.actuator_work();
    first_outside_ = simulation_.outside_work();
    first_dissipation_ = simulation_.dissipation();
    started_ = true;
  }
  const double work = simulation_.actuator_work() - first_work_;
  const double outside = simulation_.outside_work() - first_outside_;
  const double dissipation = simulation_.dissipation() - first_dissipation_;
  const double lost = work + outside - dissipation - (energy - first_energy_);
  values_.insert(values_.end(), {strain, kinetic, gravity, work, outside, dissipation, lost});
}

void RunTable::write() {
  collect();
  const bool started = simulation_.steps() > 0;
  words_[0] = started ? sim::step_status_name(simulation_.report().status) : "start";
  words_[1] = controller_ == nullptr ? "none"
              : started              ? inverse::inverse_status_name(controller_->status())
                                     : "start";
  writer_.write_row(values_, words_);
}

namespace {

std::vector<std::string> probe_headings(const sim::Model& model) {
  std::vector<std::string> names = {"time [s]"};
  for (const auto& probe : model.probes()) {
    for (const constraint::ProbeComponent& part : probe->components()) {
      names.push_back(fmt::format("{}{}{} [{}]", probe->name(), part.name.empty() ? "" : ".",
                                  part.name, part.unit));
    }
  }
  return names;
}

}  // namespace

ProbeTable::ProbeTable(const std::filesystem::path& path, const sim::Simulation& simulation)
    : simulation_(simulation), writer_(path, probe_headings(simulation.model())) {}

void ProbeTable::write() {
  std::vector<double> row = {simulation_.time()};
  for (std::size_t p = 0; p < simulation_.model().probes().size(); ++p) {
    const std::vector<double> values = simulation_.probe_values(static_cast<int>(p));
    row.insert(row.end(), values.begin(), values.end());
  }
  writer_.write_row(row);
}

}  // namespace sinew::record
