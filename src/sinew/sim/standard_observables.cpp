// The standard observables of a simulation: see the constructor of Observables.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/axis_names.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/instruments.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/joint_load.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

// An observable of the whole robot.
run::Observable number(run::ObservableKind kind, const char* name, const char* unit = "") {
  return {name, unit, {}, kind, {}, name, {name}, {}};
}

// Pose of a rigid body's frame, and velocity of its centre of mass.
void add_pose(Observables& list, const std::string& name, const mechanics::HasPose& body) {
  std::vector<run::Observable> parts;
  const auto add = [&](const char* quantity, const char* unit, std::string_view axes) {
    parts.push_back(observable_of(run::ObservableKind::body, name, quantity, unit, {axes.size()}));
    for (const char axis : axes) {
      parts.back().components.push_back(fmt::format("{}.{}_{}", name, quantity, axis));
    }
  };
  add("position", "m", "xyz");
  add("rotation", "", "wxyz");
  add("velocity", "m/s", "xyz");
  add("angular_velocity", "rad/s", "xyz");
  list.add(std::move(parts), [&body](std::span<double> all) {
    run::Numbers to(all);
    to.put(body.origin());
    for (const double part : unit_quaternion(body.axes())) to.put(part);
    to.put(body.linear_velocity());
    to.put(body.angular_velocity());
  });
}

void add_bodies(Observables& list) {
  const Simulation& simulation = list.simulation();
  const bool moving = simulation.model().step().integrator != mechanics::Integrator::quasi_static;
  for (int i = 0; i < simulation.bodies(); ++i) {
    const mechanics::Body& body = simulation.body(i);
    const std::string& name = body.model().name();
    const std::vector<std::size_t> shape = {static_cast<std::size_t>(body.positions().rows()), 3};
    const auto add = [&](const char* quantity, const char* unit, auto numbers,
                         const std::vector<std::size_t>& extent) {
      list.add_view({observable_of(run::ObservableKind::body, name, quantity, unit, extent)},
                    [&body, numbers] {
                      const auto& array = numbers(body);
                      return std::span<const double>(array.data(),
                                                     static_cast<std::size_t>(array.size()));
                    });
    };
    add(
        "positions", "m", [](const mechanics::Body& b) -> const Points& { return b.positions(); },
        shape);
    if (moving) {
      add(
          "velocities", "m/s",
          [](const mechanics::Body& b) -> const Points& { return b.velocities(); }, shape);
    }
    if (const auto* rigid = mechanics::as<const mechanics::HasPose>(body)) {
      add_pose(list, name, *rigid);
    }
    if (const auto* arm = mechanics::as<const mechanics::HasCoordinates>(body)) {
      add("coordinates", "rad",
          [arm](const mechanics::Body&) -> const VectorX& { return arm->coordinates(); },
          {static_cast<std::size_t>(arm->coordinates().size())});
      if (moving) {
        add("rates", "rad/s",
            [arm](const mechanics::Body&) -> const VectorX& { return arm->rates(); },
            {static_cast<std::size_t>(arm->rates().size())});
      }
    }
  }
}

void add_actuators(Observables& list) {
  const Simulation& simulation = list.simulation();
  const auto& actuators = simulation.model().actuators();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const model::ActuatorModel& actuator = actuators[i];
    std::vector<run::Observable> parts;
    const auto add = [&](const model::QuantityName& quantity, const char* suffix,
                         const char* role) {
      parts.push_back(observable_of(run::ObservableKind::actuator, actuator.name,
                                    fmt::format("{}{}", quantity.name, suffix), quantity.unit));
      parts.back().quantity = fmt::format("{}{}", role, suffix);
    };
    const auto role = [](model::CommandKind kind) {
      return kind == model::CommandKind::effort   ? "effort"
             : kind == model::CommandKind::motion ? "motion"
                                                  : "input";
    };
    add(actuator.kind->effort, "", role(model::CommandKind::effort));
    add(actuator.kind->motion, "", role(model::CommandKind::motion));
    const std::vector<model::CommandKind> kinds = command_kinds(actuator);
    for (const model::CommandKind kind : kinds)
      add(actuator.quantity(kind), "_command", role(kind));
    list.add(std::move(parts), [&simulation, kinds, i, row = actuator.row](std::span<double> all) {
      run::Numbers to(all);
      const auto index = static_cast<int>(i);
      to.put(end_effort(simulation, row));
      to.put(simulation.actuator(index).motion);
      for (const model::CommandKind kind : kinds) to.put(commanded(simulation, index, kind));
    });
  }
}

void add_effectors(Observables& list) {
  const Simulation& simulation = list.simulation();
  const model::Model& model = simulation.model();
  for (std::size_t i = 0; i < model.effectors().size(); ++i) {
    const auto index = static_cast<int>(i);
    const std::string& name = model.effectors()[i].name;
    const constraint::Effector& effector = model.effector(index);
    const bool turns = effector.kind() == constraint::EffectorKind::orientation;
    run::Observable one = observable_of(run::ObservableKind::effector, name,
                                        turns ? "rotation" : "position", effector.unit(), {3});
    one.quantity = "position";
    for (const char* axis : kAxisNames) {
      one.components.push_back(fmt::format("{}.{}{}", name, turns ? "r" : "", axis));
    }
    list.add({std::move(one)}, [&simulation, index](std::span<double> to) {
      run::Numbers(to).put(simulation.effector_value(index));
    });
  }
}

void add_probes(Observables& list) {
  const Simulation& simulation = list.simulation();
  for (const constraint::Probe& probe : simulation.model().probes()) {
    const bool line = dynamic_cast<const constraint::LineProbe*>(&probe) != nullptr;
    const auto& numbers = probe.components();
    const std::size_t first = line ? 1 : numbers.size();
    const auto part = [&](const char* quantity, std::vector<std::size_t> shape, std::size_t from,
                          std::size_t to) {
      run::Observable one = observable_of(run::ObservableKind::probe, probe.name(), quantity,
                                          numbers[from].unit, std::move(shape));
      one.components.clear();
      for (std::size_t k = from; k < to; ++k) {
        const std::string& own = numbers[k].name;
        one.components.push_back(own.empty() ? probe.name()
                                             : fmt::format("{}.{}", probe.name(), own));
      }
      return one;
    };
    std::vector<run::Observable> parts;
    parts.push_back(part("value",
                         first == 1 ? std::vector<std::size_t>{} : std::vector<std::size_t>{first},
                         0, first));
    if (line) parts.push_back(part("positions", {probe.mark_count(), 3}, 1, numbers.size()));
    list.add(std::move(parts), [&simulation, &probe](std::span<double> to) {
      probe.measure(simulation.configuration(), to);
    });
  }
}

void put_contact(const Simulation& simulation, int index, std::span<double> all) {
  const std::size_t n = simulation.model().contact(index).size();
  using Pose = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const auto part = [&all](std::size_t size) {
    run::Numbers numbers(all.first(size));
    all = all.subspan(size);
    return numbers;
  };
  const Eigen::Isometry3d pose = simulation.contacts().pose(index);
  Eigen::Map<Pose>(all.data()) = pose.affine();
  part(12);
  run::Numbers position = part(3 * n), gap = part(n), normal = part(3 * n), normal_force = part(n),
               friction_force = part(3 * n), state = part(n), sums = part(9);
  contact::ContactResultant resultant;
  for (std::size_t k = 0; k < n; ++k) {
    const contact::ContactPoint point = simulation.contacts().point(index, k, pose);
    position.put(point.position);
    gap.put(point.gap);
    normal.put(point.normal);
    normal_force.put(point.normal_force);
    friction_force.put(point.friction_force);
    state.put(static_cast<double>(point.state));
    resultant.add(point);
  }
  sums.put(resultant.force);
  sums.put(resultant.normal_force);
  sums.put(resultant.friction_force);
  const contact::ContactGap whole = simulation.contacts().gap(index, resultant);
  sums.put(whole.value);
  sums.put(whole.above);
  sums.put(resultant.sticking);
  sums.put(resultant.slipping);
}

void add_contacts(Observables& list) {
  const Simulation& simulation = list.simulation();
  const model::Model& model = simulation.model();
  for (std::size_t c = 0; c < model.contacts().size(); ++c) {
    const auto index = static_cast<int>(c);
    const std::string& name = model.contacts()[c].name;
    const std::size_t n = model.contact(index).size();
    std::vector<run::Observable> parts;
    const auto add_point = [&](const char* quantity, const char* unit,
                               std::vector<std::size_t> shape) {
      parts.push_back(observable_of(run::ObservableKind::contact_point, name, quantity, unit,
                                    std::move(shape)));
      parts.back().name = fmt::format("{}.points.{}", name, quantity);
    };
    const auto add_sum = [&](const char* quantity, const char* unit) {
      parts.push_back(observable_of(run::ObservableKind::contact, name, quantity, unit));
    };
    add_point("pose", "1, m", {3, 4});
    parts.back().name = name + ".pose";
    add_point("position", "m", {n, 3});
    add_point("gap", "m", {n});
    add_point("normal", "", {n, 3});
    add_point("normal_force", "N", {n});
    add_point("friction_force", "N", {n, 3});
    add_point("state", "", {n});
    for (const auto state :
         {qp::ContactState::open, qp::ContactState::stick, qp::ContactState::slip}) {
      parts.back().words.push_back({static_cast<int>(state), qp::contact_state_name(state)});
    }
    add_sum("force", "N");
    parts.back().shape = {3};
    parts.back().components.clear();
    for (const char* axis : kAxisNames) {
      parts.back().components.push_back(fmt::format("{}.force_{}", name, axis));
    }
    add_sum("normal_force", "N");
    add_sum("friction_force", "N");
    add_sum("gap", "m");
    add_sum("gap_above", "m");
    add_sum("sticking", "");
    add_sum("slipping", "");
    list.add(std::move(parts),
             [&simulation, index](std::span<double> to) { put_contact(simulation, index, to); });
  }
}

void add_joints(Observables& list) {
  const Simulation& simulation = list.simulation();
  const model::Model& model = simulation.model();
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const model::JointModel& joint = model.joints()[j];
    const std::string& name = joint.name;
    std::vector<run::Observable> parts;
    const auto add_vector = [&](const char* quantity, const char* unit) {
      parts.push_back(observable_of(run::ObservableKind::joint, name, quantity, unit, {3}));
      for (const char* axis : kAxisNames) {
        parts.back().components.push_back(fmt::format("{}.{}_{}", name, quantity, axis));
      }
    };
    add_vector("force", "N");
    add_vector("moment", "N m");
    parts.push_back(observable_of(run::ObservableKind::joint, name, "gap", "m"));
    if (joint.motions[0] >= 0)
      parts.push_back(observable_of(run::ObservableKind::joint, name, "angle", "rad"));
    if (joint.motions[1] >= 0)
      parts.push_back(observable_of(run::ObservableKind::joint, name, "displacement", "m"));
    list.add(std::move(parts), [&simulation, &joint, j](std::span<double> all) {
      const auto index = static_cast<int>(j);
      const JointLoad load = joint_load(simulation, index);
      run::Numbers to(all);
      to.put(load.force);
      to.put(load.moment);
      to.put(load.gap);
      for (std::size_t motion = 0; motion < 2; ++motion) {
        if (joint.motions[motion] >= 0) to.put(joint_motion(simulation, index, motion));
      }
    });
  }
}

void add_instruments(Observables& list) {
  for (const auto& instrument : list.simulation().instruments().all()) {
    for (run::Reading& reading : instrument->readings()) {
      list.add(std::move(reading.parts), std::move(reading.fill));
    }
  }
}

// Energies, work and losses since the first reading. The work of actuators and loads since then is
// stored in the bodies, dissipated, or lost by the integrator.
class Ledger {
 public:
  explicit Ledger(Simulation& simulation) : simulation_(simulation) {}

  void operator()(std::span<double> all) {
    run::Numbers to(all);
    const mechanics::Energies energies = simulation_.energies();
    const Balance now{energies.total(), simulation_.ledger().actuators,
                      simulation_.ledger().outside, simulation_.ledger().dissipated};
    if (!first_) first_ = now;
    const double work = now.work - first_->work, outside = now.outside - first_->outside,
                 dissipation = now.dissipation - first_->dissipation;
    for (const double part : {energies.strain, energies.kinetic, energies.gravity}) to.put(part);
    to.put(work);
    to.put(outside);
    to.put(dissipation);
    to.put(work + outside - dissipation - (now.energy - first_->energy));
  }

 private:
  struct Balance {
    double energy, work, outside, dissipation;  // J
  };
  Simulation& simulation_;
  std::optional<Balance> first_;
};

void add_energies(Observables& list) {
  std::vector<run::Observable> parts;
  for (const char* name : {"strain_energy", "kinetic_energy", "gravity_energy"}) {
    parts.push_back(number(run::ObservableKind::energy, name, "J"));
  }
  for (const char* name : {"actuator_work", "outside_work", "dissipation", "numerical_loss"}) {
    parts.push_back(number(run::ObservableKind::ledger, name, "J"));
  }
  list.add(std::move(parts), Ledger(list.simulation()));
}

constexpr int kStart = -1;  // the status before any step

// The words of a step's status by the number that stands for them in recordings, so that recordings
// of older versions keep their meaning.
constexpr std::array kStatusByCode = {run::StepStatus::solved,
                                      run::StepStatus::limits_conflict,
                                      run::StepStatus::command_not_reached,
                                      run::StepStatus::cut_back,
                                      run::StepStatus::not_in_equilibrium,
                                      run::StepStatus::gaining_energy,
                                      run::StepStatus::after_failure,
                                      run::StepStatus::cavitates,
                                      run::StepStatus::unphysical};
static_assert(kStatusByCode.size() == static_cast<std::size_t>(run::kLastStepStatus) + 1);

int code_of(run::StepStatus status) {
  return static_cast<int>(std::ranges::find(kStatusByCode, status) - kStatusByCode.begin());
}

void add_report(Observables& list) {
  const Simulation& simulation = list.simulation();
  std::vector<run::Observable> parts = {number(run::ObservableKind::report, "residual", "N"),
                                        number(run::ObservableKind::report, "relative_residual"),
                                        number(run::ObservableKind::report, "distance", "m")};
  for (const char* name : {"iterations", "substeps", "scale", "smallest_volume_ratio", "snapped"}) {
    parts.push_back(number(run::ObservableKind::report, name));
  }
  const bool touches = !simulation.model().contacts().empty();
  if (touches) {
    parts.push_back(number(run::ObservableKind::report, "contact_residual"));
    parts.push_back(number(run::ObservableKind::report, "contact_signorini", "m"));
    parts.push_back(number(run::ObservableKind::report, "contact_coulomb", "m"));
  }
  const bool zones = std::ranges::any_of(
      simulation.model().contacts(), [](const auto& contact) { return contact.aggregate > 0.0; });
  if (zones) parts.push_back(number(run::ObservableKind::report, "contact_aggregation"));
  parts.push_back(number(run::ObservableKind::status, "status"));
  parts.back().words = {{kStart, "start"}};
  for (const run::StepStatus status : kStatusByCode) {
    parts.back().words.push_back({code_of(status), step_status_name(status)});
  }
  list.add(std::move(parts), [&simulation, touches, zones](std::span<double> all) {
    const run::StepReport& report = simulation.report();
    run::Numbers to(all);
    to.put(report.residual);
    to.put(report.relative_residual);
    to.put(report.distance);
    to.put(report.iterations);
    to.put(report.substeps);
    to.put(report.scale);
    to.put(report.smallest_volume_ratio);
    to.put(report.snapped ? 1.0 : 0.0);
    if (touches) {
      to.put(report.contact_residual);
      to.put(report.contact_signorini);
      to.put(report.contact_coulomb);
    }
    if (zones) to.put(report.contact_aggregation);
    to.put(simulation.steps() > 0 ? code_of(report.status) : kStart);
  });
}

void add_timing(Observables& list) {
  const Simulation& simulation = list.simulation();
  std::vector<run::Observable> parts = {
      observable_of(run::ObservableKind::timing, "time", "step", "s")};
  for (const char* stage : world::kStageNames) {
    parts.push_back(observable_of(run::ObservableKind::timing, "time", stage, "s"));
  }
  list.add(std::move(parts), [&simulation](std::span<double> all) {
    const world::StageTimes& times = simulation.report().times;
    run::Numbers to(all);
    to.put(times.total);
    for (const double seconds : times.seconds) to.put(seconds);
  });
}

}  // namespace

void list_standard_observables(Observables& list) {
  const Simulation& simulation = list.simulation();
  list.add({number(run::ObservableKind::time, "time", "s")},
           [&simulation](std::span<double> to) { to[0] = simulation.time(); });
  add_bodies(list);
  add_actuators(list);
  add_effectors(list);
  add_probes(list);
  add_contacts(list);
  add_joints(list);
  add_instruments(list);
  add_energies(list);
  add_report(list);
  add_timing(list);
}

}  // namespace sinew::sim
