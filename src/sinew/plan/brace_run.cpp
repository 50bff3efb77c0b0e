#include "sinew/plan/brace_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/torque_settings.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/pcc/arm_body_model.hpp"
#include "sinew/plan/reach.hpp"
#include "sinew/plan/uniform.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::plan {

namespace {

void check(const BraceRunSettings& settings) {
  const auto positive = [](double value, const char* item) {
    if (value > 0.0 && std::isfinite(value)) return;
    throw Error(ErrorKind::out_of_range, {.item = item}, fmt::format("{:g} s", value),
                "give a positive time");
  };
  positive(settings.time_step, "time_step");
  positive(settings.approach, "approach");
  positive(settings.press, "press");
  positive(settings.move, "move");
  positive(settings.settle, "settle");
  positive(settings.hold, "hold");
  const Disturbance& of = settings.disturbance;
  if (!(of.force >= 0.0) || !(of.min_frequency > 0.0) || !(of.max_frequency >= of.min_frequency) ||
      of.sines < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "disturbance"},
                fmt::format("{:g} N, {:g} to {:g} Hz, {} sines", of.force, of.min_frequency,
                            of.max_frequency, of.sines),
                "give a force of zero or more, positive frequencies, the least first, and a sine");
  }
  if (!(settings.proportional >= 0.0) || !(settings.derivative >= 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "gains"}, "one is negative", "give zero or more");
  }
}

class Sines {
 public:
  explicit Sines(const Disturbance& settings) {
    Uniform draw(settings.seed);
    amplitude_ = settings.force * std::sqrt(2.0 / settings.sines);
    for (auto& axis : sines_) {
      for (int k = 0; k < settings.sines; ++k) {
        axis.push_back(
            {2.0 * std::numbers::pi * draw(settings.min_frequency, settings.max_frequency),
             draw(0.0, 2.0 * std::numbers::pi)});
      }
    }
  }
  double force(std::size_t axis, double time) const {
    double sum = 0.0;
    for (const auto& [frequency, phase] : sines_[axis]) sum += std::sin(frequency * time + phase);
    return amplitude_ * sum;
  }

 private:
  double amplitude_ = 0.0;
  std::array<std::vector<std::pair<double, double>>, 3> sines_;
};

/// A smooth step from 0 to 1, with zero slope at both ends.
double smooth(double fraction) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  return fraction * fraction * (3.0 - 2.0 * fraction);
}

/// A simulation of the arm with its objects, which drives and records it.
class Bench {
 public:
  Bench(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
        const BraceRunSettings& settings, double turn, bool with_objects)
      : arm_(arm), task_(task), settings_(settings), sines_(settings.disturbance) {
    pcc::ArmSettings body = arm->settings();
    body.segments[0].gamma += turn;
    equations_.emplace(std::make_shared<const pcc::Arm>(body));
    points_ = skin_points(*arm, task);
    model::StepSettings step;
    step.time_step = settings.time_step;
    step.integrator = mechanics::Integrator::backward_euler;
    builder::ModelBuilder builder(step);
    builder.add_body<pcc::ArmBodyModel>(body);
    for (int segment = 0; segment < arm->segments(); ++segment) {
      const auto& of = arm->settings().segments[static_cast<std::size_t>(segment)];
      for (int along = 0; along < of.coordinates(); ++along) {
        builder::TorqueSettings torque;
        torque.name = fmt::format("torque {}.{}", segment, along);
        torque.segment = segment;
        torque.towards = static_cast<builder::TorqueSettings::Towards>(along);
        torques_.push_back(builder.add_torque(torque));
      }
    }
    const VectorX straight = VectorX::Zero(arm->coordinates());
    const pcc::ArmPoint end{.segment = arm->segments() - 1};
    for (int axis = 0; axis < 3; ++axis) {
      builder::ForceSettings force;
      force.name = fmt::format("force {}", axis);
      force.point = equations_->point(end, straight, straight).position;
      force.direction = Vector3::Unit(axis);
      force.outside = mesh::Outside::nearest;
      forces_.push_back(builder.add_force(force));
    }
    if (with_objects) {
      Points rest(static_cast<Eigen::Index>(points_.size()), 3);
      for (std::size_t p = 0; p < points_.size(); ++p) {
        rest.row(static_cast<Eigen::Index>(p)) =
            equations_->point(points_[p], straight, straight).position;
      }
      for (std::size_t k = 0; k < task.objects.size(); ++k) {
        builder::ContactSettings contact;
        contact.name = fmt::format("object {}", k);
        std::visit([&](const auto& surface) { contact.surface = surface; },
                   task.objects[k].surface);
        contact.points = rest;
        contact.outside = mesh::Outside::nearest;
        contact.friction = settings.friction.value_or(task.objects[k].friction.min);
        builder.add_contact(contact);
      }
    }
    simulation_.emplace(builder.build());
  }

  double time() const { return simulation_->time(); }
  const VectorX& angles() const { return body().coordinates(); }
  const VectorX& torque() const { return efforts_.back(); }

  /// Selects the point to be recorded.
  void watch(int object, const pcc::ArmPoint& point) {
    object_ = object;
    for (std::size_t p = 0; p < points_.size(); ++p) {
      if (points_[p].segment == point.segment && points_[p].fraction == point.fraction &&
          points_[p].x == point.x && points_[p].y == point.y) {
        point_ = p;
      }
    }
  }

  /// Advances one step. @param torque (inputs,) N m. @param reference (coordinates,) of the PD
  /// feedback; empty: none. @param disturbed whether the disturbance acts on the tip.
  void step(const VectorX& torque, const VectorX& reference, bool disturbed) {
    VectorX drive = torque;
    if (reference.size() > 0) {
      drive += arm_->actuation().transpose() * (settings_.proportional * (reference - angles()) -
                                                settings_.derivative * body().rates());
      drive = drive.cwiseMax(task_.limits.torque_lower).cwiseMin(task_.limits.torque_upper);
    }
    if (times_.empty()) note(drive);
    const VectorX effort = arm_->actuation() * drive;
    for (std::size_t k = 0; k < torques_.size(); ++k) {
      tell(torques_[k], effort[static_cast<Eigen::Index>(k)]);
    }
    const double end = time() + settings_.time_step;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tell(forces_[axis], disturbed ? sines_.force(axis, end) : 0.0);
    }
    simulation_->step();
    note(drive);
    residual_ = std::max(residual_, simulation_->report().contact_residual);
  }

  bool touches() const {
    return object_ >= 0 && simulation_->contacts().point(object_, point_).normal_force > 0.0;
  }
  bool sticks() const {
    return object_ >= 0 &&
           simulation_->contacts().point(object_, point_).state == qp::ContactState::stick;
  }

  void finish(BraceRun& run, double disturbed_from) const {
    const auto rows = static_cast<Eigen::Index>(times_.size());
    run.times = VectorX::Map(times_.data(), rows);
    run.position.resize(rows, arm_->coordinates());
    run.torque.resize(rows, arm_->inputs());
    run.tip.resize(rows, 3);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      run.position.row(i) = positions_[at];
      run.torque.row(i) = efforts_[at];
      run.tip.row(i) = tips_[at];
    }
    run.normal_force = VectorX::Map(normal_.data(), rows);
    run.friction_force = VectorX::Map(friction_.data(), rows);
    run.cone_residual = cone_;
    run.contact_residual = residual_;
    run.disturbed_from = disturbed_from;
    const Eigen::Index held = (run.times.array() > disturbed_from + 1e-9).count();
    const Points part = run.tip.bottomRows(held);
    const Vector3 mean = part.colwise().mean().transpose();
    run.offset = (mean - task_.goal).norm();
    run.mean_error = (part.rowwise() - task_.goal.transpose()).rowwise().norm().mean();
    run.spread = std::sqrt((part.rowwise() - mean.transpose()).rowwise().squaredNorm().mean());
  }

 private:
  const mechanics::HasCoordinates& body() const {
    return *mechanics::as<const mechanics::HasCoordinates>(simulation_->body(0));
  }
  void tell(int actuator, double value) {
    simulation_->command(actuator, {model::CommandKind::effort, model::Signal::constant(value)});
  }
  void note(const VectorX& torque) {
    times_.push_back(time());
    positions_.push_back(angles());
    efforts_.push_back(torque);
    const Points ends = equations_->endpoints(angles());
    tips_.push_back(ends.row(ends.rows() - 1));
    contact::ContactPoint touch;
    if (object_ >= 0) touch = simulation_->contacts().point(object_, point_);
    normal_.push_back(touch.normal_force);
    friction_.push_back(touch.friction_force.norm());
    const auto contacts = object_ >= 0 ? task_.objects.size() : 0;
    for (std::size_t k = 0; k < contacts; ++k) {
      const double friction = settings_.friction.value_or(task_.objects[k].friction.min);
      for (const auto& point : simulation_->contacts().points(static_cast<int>(k))) {
        cone_ = std::max(cone_, point.friction_force.norm() - friction * point.normal_force);
      }
    }
  }

  std::shared_ptr<const pcc::Arm> arm_;
  const BraceTask& task_;
  const BraceRunSettings& settings_;
  Sines sines_;
  mutable std::optional<pcc::ArmEquations> equations_;
  std::vector<pcc::ArmPoint> points_;
  std::optional<sim::Simulation> simulation_;
  std::vector<int> torques_, forces_;
  int object_ = -1;
  std::size_t point_ = 0;
  std::vector<double> times_, normal_, friction_;
  std::vector<VectorX> positions_, efforts_;
  std::vector<Vector3> tips_;
  double cone_ = 0.0, residual_ = 0.0;
};

long steps_in(double time, const BraceRunSettings& settings) {
  return whole_count<long>(std::max(1.0, std::round(time / settings.time_step)), 1e9,
                           "time steps of a run", "increase the time step");
}

}  // namespace

std::string_view status_name(BraceRunStatus status) {
  switch (status) {
    case BraceRunStatus::held:
      return "held";
    case BraceRunStatus::slipped:
      return "slipped";
    case BraceRunStatus::no_contact:
      return "no-contact";
    case BraceRunStatus::not_planned:
      break;
  }
  return "not-planned";
}

BraceRun run_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& given,
                   const Brace& brace, const BraceRunSettings& settings) {
  check(settings);
  const BraceTask task = completed(*arm, given);
  BraceRun run;
  run.before = brace;
  if (!brace.found()) return run;
  Bench bench(arm, task, settings, brace.turn, true);
  bench.watch(brace.object, brace.point);
  const VectorX start = bench.angles();
  const auto touch = [&] {
    if (run.contact_time == 0.0 && bench.touches()) run.contact_time = bench.time();
  };
  const long approach = steps_in(settings.approach, settings);
  for (long k = 1; k <= approach; ++k) {
    const double fraction = smooth(static_cast<double>(k) / static_cast<double>(approach));
    bench.step(fraction * brace.torque, start + fraction * (brace.position - start), false);
    touch();
  }
  for (long k = steps_in(settings.press, settings); k > 0; --k) {
    bench.step(brace.torque, brace.position, false);
    touch();
  }
  run.measured = bench.angles();
  run.replan_time = bench.time();
  if (!bench.touches()) {
    run.status = BraceRunStatus::no_contact;
    bench.finish(run, run.replan_time - settings.time_step);
    return run;
  }
  run.after = replan_brace(arm, task, brace, run.measured);
  if (!run.after.found()) {
    bench.finish(run, run.replan_time - settings.time_step);
    return run;
  }
  // Starts at the current torque. The PD feedback fades out on the way, so that at the goal only
  // the torque of the plan holds the arm.
  const VectorX pressing = bench.torque();
  const long move = steps_in(settings.move, settings);
  for (long k = 1; k <= move; ++k) {
    const double fraction = smooth(static_cast<double>(k) / static_cast<double>(move));
    const VectorX angles = run.measured + fraction * (run.after.position - run.measured);
    const VectorX torque = pressing + fraction * (run.after.torque - pressing);
    bench.step(torque,
               fraction < 1.0
                   ? VectorX(bench.angles() + (1.0 - fraction) * (angles - bench.angles()))
                   : VectorX(),
               false);
  }
  for (long k = steps_in(settings.settle, settings); k > 0; --k) {
    bench.step(run.after.torque, {}, false);
  }
  const double from = bench.time();
  for (long k = steps_in(settings.hold, settings); k > 0; --k) {
    bench.step(run.after.torque, {}, true);
    if (!bench.sticks()) ++run.slips;
  }
  run.status = run.slips == 0 ? BraceRunStatus::held : BraceRunStatus::slipped;
  bench.finish(run, from);
  return run;
}

BraceRun run_free(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& given,
                  const BraceRunSettings& settings) {
  check(settings);
  const BraceTask task = completed(*arm, given);
  const NearestReach reach = nearest_reach(arm, task.limits, task.goal, 20, task.seed);
  BraceRun run;
  if (!reach.found) return run;
  Bench bench(arm, task, settings, 0.0, false);
  const long approach = steps_in(settings.approach + settings.press + settings.move, settings);
  for (long k = 1; k <= approach; ++k) {
    bench.step(smooth(static_cast<double>(k) / static_cast<double>(approach)) * reach.torque, {},
               false);
  }
  for (long k = steps_in(settings.settle, settings); k > 0; --k)
    bench.step(reach.torque, {}, false);
  const double from = bench.time();
  for (long k = steps_in(settings.hold, settings); k > 0; --k) bench.step(reach.torque, {}, true);
  run.status = BraceRunStatus::held;
  run.measured = bench.angles();
  bench.finish(run, from);
  return run;
}

}  // namespace sinew::plan
