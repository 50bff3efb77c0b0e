#include "trial.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <regex>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/control/controller_observables.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/run_file.hpp"
#include "sinew/record/run_layout.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state_io.hpp"

#include "random.hpp"
#include "scene_draft.hpp"
#include "step_check.hpp"

namespace sinew::combine {

namespace {

constexpr int kSteps = 6;
constexpr int kHalf = 3;
// Tolerances relative to the robot's size. Another order of bodies sums forces in another order.
// With adaptive steps, rounding may decide whether a substep is accepted, and runs then differ by a
// fraction of its error.
constexpr double kOrderTolerance = 1e-9;
constexpr double kPartOfError = 0.1;
// A gap below 1e-9 of the size counts as closed. Rounding may decide whether it closes now or later
// in the step, and impacts amplify the difference.
constexpr double kEventTolerance = 1e-7;
// The regularisation that decides between redundant actuators weighs 1e-5 of the task
// (InverseSettings::epsilon times relaxation), so a choice amplifies rounding by as much.
constexpr double kChoiceTolerance = 1e-8;
// Of opposite nodes, relative to the robot's size, and of opposite forces, relative to them. Sums
// of forces have another order on both sides.
constexpr double kSymmetry = 1e-8, kForceSymmetry = 1e-6;
constexpr double kEnergyTolerance = 1e-10;  // relative to an energy
// Energy of bodies at rest due to rounding, J.
constexpr double kNoEnergy = 1e-15;

// A simulation with the controllers of its scene.
class Run {
  std::unique_ptr<sim::Simulation> own_;

 public:
  explicit Run(const scene::Robot& robot, int threads = 1)
      : Run(robot, std::make_unique<sim::Simulation>(robot.model, threads)) {}
  Run(const scene::Robot& robot, std::unique_ptr<sim::Simulation> begun)
      : own_(std::move(begun)), simulation(*own_) {
    for (const auto& controller : robot.controllers) {
      controllers_.push_back(control::make_controller(simulation, controller.settings));
    }
  }

  // Makes steps and appends the state after each one.
  void advance(int steps) {
    for (int k = 0; k < steps && error_.empty(); ++k) {
      try {
        simulation.step();
        condition = std::max(condition, simulation.report().status);
        choice_held = choice_held || simulation.report().choice_held;
      } catch (const Error& error) {
        error_ = error.what();
      }
      states.push_back(simulation.state());
    }
  }

  const std::string& error() const { return error_; }
  sim::Observables observables() {
    sim::Observables list(simulation);
    control::add_controller(list, controllers_.empty() ? nullptr : controllers_.front().get());
    return list;
  }
  void forget() {
    states.clear();
    error_.clear();
  }

  sim::Simulation& simulation;
  std::vector<run::State> states;
  run::StepStatus condition = run::StepStatus::solved;
  bool choice_held = false;

 private:
  std::vector<std::unique_ptr<control::TargetController>> controllers_;
  std::string error_;
};

scene::Robot build(const std::string& text) {
  return scene::build(scene::parse_scene_text(text, "scene.yaml", {}));
}

// Names all numbers: "body at 12", "volume ratio".
std::vector<std::pair<std::string, double>> numbers_of(const run::State& state) {
  std::vector<std::pair<std::string, double>> numbers;
  run::State::visit(state, [&](std::string_view name, const auto& part) {
    if constexpr (requires { part.size(); }) {
      for (std::size_t k = 0; k < part.size(); ++k) {
        numbers.emplace_back(fmt::format("{} at {}", name, k), part[k]);
      }
    } else {
      numbers.emplace_back(name, part);
    }
  });
  return numbers;
}

bool is_finite(const run::State& state) {
  return std::ranges::all_of(numbers_of(state),
                             [](const auto& number) { return std::isfinite(number.second); });
}

// Relative to the robot's size.
double order_tolerance(const scene::Robot& robot) {
  const model::StepSettings& step = robot.model->step();
  if (step.event_driven()) return kEventTolerance;
  if (step.adaptive) return kPartOfError * step.adaptive->tolerance;
  return robot.controllers.empty() ? kOrderTolerance : kChoiceTolerance;
}

// Distance between the nodes of two runs with bodies in opposite orders, m.
double largest_distance(const sim::Simulation& one, const sim::Simulation& other) {
  double largest = 0.0;
  const auto count = static_cast<int>(one.model().bodies().size());
  for (int i = 0; i < count; ++i) {
    const Points difference = one.body(i).positions() - other.body(count - 1 - i).positions();
    largest = std::max(largest, difference.rowwise().norm().maxCoeff());
  }
  return largest;
}

// The name of the first number that differs.
std::string first_difference(const run::State& one, const run::State& other) {
  const auto mine = numbers_of(one), theirs = numbers_of(other);
  for (std::size_t k = 0; k < std::min(mine.size(), theirs.size()); ++k) {
    if (std::bit_cast<std::uint64_t>(mine[k].second) !=
        std::bit_cast<std::uint64_t>(theirs[k].second)) {
      return fmt::format("{} ({:g} for {:g})", mine[k].first, mine[k].second, theirs[k].second);
    }
  }
  return "the count of numbers or steps";
}

bool same_bits(std::span<const double> one, std::span<const double> other) {
  return std::ranges::equal(one, other, [](double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  });
}

// A run that is recorded, with the values that the record must contain.
class Record {
 public:
  explicit Record(Run& run) : list(run.observables()), run_(run), check_(run.simulation) {
    record::RecordSettings settings;
    settings.folder = folder_;
    recorder_ = std::make_unique<record::RunRecorder>(run.observables(), settings);
    look();
  }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() { std::filesystem::remove_all(folder_); }

  void advance(int steps) {
    for (int k = 0; k < steps && run_.error().empty(); ++k) {
      check_.begin();
      run_.advance(1);
      if (!run_.error().empty()) return;
      if (unsound.empty()) unsound = check_.end();
      recorder_->after_step();
      look();
    }
  }

  // Ends the record, and returns its file.
  std::filesystem::path close() {
    recorder_.reset();
    return folder_ / "run.h5";
  }

  sim::Observables list;
  std::vector<std::vector<double>> seen;  // values by observable, for all frames in turn
  std::string unsound;                    // the first requirement on a step that was not met

 private:
  void look() {
    list.refresh();
    seen.resize(list.list().size());
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::span<const double> numbers = list.read(k);
      seen[k].insert(seen[k].end(), numbers.begin(), numbers.end());
    }
  }

  Run& run_;
  StepCheck check_;
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("sinew_trial_{}", ::getpid());
  std::unique_ptr<record::RunRecorder> recorder_;
};

class Trial {
 public:
  explicit Trial(const SceneDraft& draft) : draft_(draft) {}

  Outcome run() {
    std::optional<scene::Robot> robot;
    std::unique_ptr<Run> first;
    try {
      robot = build(write_scene(draft_));
      first = std::make_unique<Run>(*robot);
    } catch (const Error& error) {
      return {Outcome::Kind::refused, error.what(), ""};
    }
    const run::State start = first->simulation.state();
    Record record(*first);
    record.advance(kHalf);
    const std::string half = sim::format_state(first->simulation);
    std::unique_ptr<sim::Simulation> copy = first->simulation.clone();
    const run::State state = first->simulation.state();
    const bool halfway = first->error().empty();
    record.advance(kSteps - kHalf);
    reference_ = first->states;
    if (!is_finite(first->simulation.state())) fail("a state is not finite");
    if (!record.unsound.empty()) fail(record.unsound);
    if (!first->error().empty()) check_failure(*robot, first->simulation.report());
    check_record(*robot, *first, record);

    Run threaded(*robot, 2);
    threaded.advance(kSteps);
    compare("two threads", threaded.states, 0);
    if (halfway) {
      Run resumed(*robot);
      sim::parse_state(resumed.simulation, half, "state");
      resumed.advance(kSteps - kHalf);
      compare("a saved state", resumed.states, kHalf);
      Run cloned(*robot, std::move(copy));
      cloned.simulation.restore(state);  // again, for the memory of controllers
      cloned.advance(kSteps - kHalf);
      compare("a clone", cloned.states, kHalf);
    }
    {
      Run renamed(build(write_scene(draft_, {.renamed = true})));
      renamed.advance(kSteps);
      for (std::size_t k = 0; k < std::min(renamed.states.size(), reference_.size()); ++k) {
        renamed.states[k].instruments = reference_[k].instruments;  // random numbers have names
      }
      compare("other names", renamed.states, 0);
    }
    // A flagged step may have diverged, and an active set that did not converge may depend on
    // rounding.
    if (!run::is_flagged(first->condition) && !first->choice_held) {
      double distance = distance_of_order({.reversed = true}, first->simulation);
      const double tolerance = order_tolerance(*robot) * robot->model->size();
      if (!(distance <= tolerance)) {
        // The residual that a quasi-static step leaves to the next one may depend on rounding.
        Run converged(build(write_scene(draft_, {.converged = true})));
        converged.advance(kSteps);
        distance = distance_of_order({.reversed = true, .converged = true}, converged.simulation);
      }
      if (!(distance <= tolerance)) {
        fail(fmt::format("another order moves nodes by {:.1e} m", distance));
      }
    }
    const std::string condition(run::step_status_name(first->condition));
    const std::string error = first->error();
    first->forget();
    first->simulation.reset();
    if (first->simulation.state() != start) {
      fail("reset() leaves another " + first_difference(first->simulation.state(), start));
    }
    first->advance(kSteps);
    compare("reset()", first->states, 0);
    if (!wrong_.empty()) return {Outcome::Kind::wrong, wrong_, condition};
    if (!error.empty()) return {Outcome::Kind::stopped, error, condition};
    return {Outcome::Kind::ran, "", condition};
  }

 private:
  // Largest distance of a node after kSteps, m.
  double distance_of_order(const Layout& layout, const sim::Simulation& from) const {
    Run reversed(build(write_scene(draft_, layout)));
    reversed.advance(kSteps);
    return largest_distance(from, reversed.simulation);
  }

  // A step that stops a run names its failure, and so do all steps of a run that keeps going.
  void check_failure(const scene::Robot& robot, const run::StepReport& report) {
    if (!run::is_failure(report.status)) fail("a run stops without a failure");
    Run kept(robot);
    bool failed = false;
    try {
      for (int k = 0; k < kSteps; ++k) {
        const run::StepStatus status = kept.simulation.step(sim::OnFailure::keep_going).status;
        if (failed && !run::is_flagged(status)) fail("a step after a failure is not flagged");
        failed = failed || run::is_failure(status);
      }
    } catch (const Error&) {
      failed = true;  // a state that cannot be evaluated
    }
    if (!failed) fail("a run that keeps going does not report the failure");
  }

  // A record reads back bit for bit, and a copy of the simulation has the same observables.
  void check_record(const scene::Robot& robot, Run& run, Record& record) {
    const std::vector<run::Observable>& observables = record.list.list();
    const record::RunFile file(record.close());
    for (std::size_t k = 0; k < observables.size(); ++k) {
      const std::string dataset = record::dataset_of(observables[k]);
      if (dataset.empty() || same_bits(file.series(dataset), record.seen[k])) continue;
      fail(fmt::format("{} is not recorded as it was", dataset));
    }
    if (!run.error().empty()) return;
    Run copy(robot, run.simulation.clone());
    copy.simulation.restore(run.simulation.state());
    sim::Observables theirs = copy.observables();
    for (std::size_t k = 0; k < observables.size(); ++k) {
      const run::Observable& one = observables[k];
      // Work since the first read, and the report of the last step, are not part of a state.
      if (one.kind >= run::ObservableKind::ledger) {
        continue;
      }
      // A step sums energies in another order than their evaluation over elements.
      const bool same = one.kind == run::ObservableKind::energy
                            ? std::abs(record.list.number(k) - theirs.number(k)) <=
                                  kEnergyTolerance * std::abs(record.list.number(k)) + kNoEnergy
                            : same_bits(record.list.read(k), theirs.read(k));
      if (same) continue;
      fail(fmt::format("a copy shows another {} ({} for {})", one.name, theirs.number(k),
                       record.list.number(k)));
    }
  }

  void fail(const std::string& what) { wrong_ += (wrong_.empty() ? "" : "; ") + what; }

  // Compares states. @param states of the steps from `from` on.
  void compare(const char* way, const std::vector<run::State>& states, std::size_t from) {
    const std::size_t expected = reference_.size() - std::min(from, reference_.size());
    for (std::size_t k = 0; k < std::min(states.size(), expected); ++k) {
      const run::State& reference = reference_[from + k];
      if (states[k].hash() == reference.hash()) continue;
      return fail(fmt::format("{}: step {} differs in {}", way, from + k + 1,
                              first_difference(states[k], reference)));
    }
    if (states.size() != expected) fail(fmt::format("{}: another number of steps", way));
  }

  const SceneDraft& draft_;
  std::vector<run::State> reference_;
  std::string wrong_;
};

// The node opposite to each node of a body at rest; empty if its mesh is not symmetric.
std::vector<Eigen::Index> opposite_nodes(const Points& rest, double size) {
  std::vector<Eigen::Index> result;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const Eigen::RowVector3d mirrored(rest(i, 0), 2.0 * kMiddle - rest(i, 1), rest(i, 2));
    Eigen::Index nearest = 0;
    const double off = (rest.rowwise() - mirrored).rowwise().norm().minCoeff(&nearest);
    if (off > 1e-9 * size) return {};
    result.push_back(nearest);
  }
  return result;
}

// What is not symmetric after the steps of a symmetric robot; empty if all is.
std::string find_asymmetry(const sim::Simulation& simulation) {
  const double size = simulation.model().size();
  for (int b = 0; b < simulation.bodies(); ++b) {
    const Points& now = simulation.body(b).positions();
    const std::string& name = simulation.model().body(b).name();
    const auto opposite = opposite_nodes(simulation.body(b).model().mesh().nodes, size);
    if (opposite.empty()) return fmt::format("the mesh of '{}' is not symmetric", name);
    double off = 0.0;
    for (Eigen::Index i = 0; i < now.rows(); ++i) {
      const auto other = now.row(opposite[static_cast<std::size_t>(i)]);
      off = std::max(off, std::hypot(now(i, 0) - other[0], now(i, 1) + other[1] - 2.0 * kMiddle,
                                     now(i, 2) - other[2]));
    }
    if (!(off <= kSymmetry * size))
      return fmt::format("'{}' is unsymmetric by {:.1e} m", name, off);
  }
  for (std::size_t c = 0; c < simulation.model().contacts().size(); ++c) {
    const auto resultant = simulation.contacts().resultant(static_cast<int>(c));
    if (std::abs(resultant.force.y()) <= kForceSymmetry * resultant.normal_force) continue;
    return fmt::format("a contact pushes sideways with {:.1e} of {:.1e} N", resultant.force.y(),
                       resultant.normal_force);
  }
  std::optional<double> first;
  for (std::size_t i = 0; i < simulation.model().actuators().size(); ++i) {
    if (!simulation.model().actuators()[i].kind->pulls_only) continue;
    const double tension = simulation.actuator(static_cast<int>(i)).effort;
    if (!first) first = tension;
    if (std::abs(tension - *first) <= kForceSymmetry * std::abs(*first)) continue;
    return fmt::format("opposite cables have {:.9g} and {:.9g} N", *first, tension);
  }
  return {};
}

}  // namespace

const char* outcome_name(Outcome::Kind kind) {
  switch (kind) {
    case Outcome::Kind::ran:
      return "ran";
    case Outcome::Kind::refused:
      return "refused";
    case Outcome::Kind::stopped:
      return "stopped";
    case Outcome::Kind::wrong:
      return "wrong";
  }
  return "";
}

Outcome try_scene(const Selection& selection, std::uint64_t seed) {
  return Trial(draft_scene(selection, seed)).run();
}

Outcome try_symmetric_scene(const Selection& selection, std::uint64_t seed) {
  try {
    Run run(build(write_scene(draft_symmetric_scene(selection, seed), {.converged = true})));
    Record record(run);
    record.advance(kSteps);
    const std::string condition(run::step_status_name(run.condition));
    if (!run.error().empty()) return {Outcome::Kind::stopped, run.error(), condition};
    std::string wrong = record.unsound;
    if (wrong.empty() && !run::is_flagged(run.condition)) wrong = find_asymmetry(run.simulation);
    return {wrong.empty() ? Outcome::Kind::ran : Outcome::Kind::wrong, wrong, condition};
  } catch (const Error& error) {
    return {Outcome::Kind::refused, error.what(), ""};
  }
}

std::string try_changed_number(const Selection& selection, std::uint64_t seed) {
  const std::string text = write_scene(draft_scene(selection, seed));
  // Group 4 is a number of the robot. The alternatives before it in the pattern are inputs,
  // settings, and an estimator with its sensor, which do not act on the robot.
  static const std::regex number(
      "(command|factor|pressure|target|rotation): (\\{[^}]*\\}[^}]*\\}|[^,}]*)|"
      "(?:seen|guess|solver): [^\\n]*|sinew: 1|time_step: [^\\n]*|fixed: [^\\n,]*|"
      "([ \\[])([0-9]+\\.?[0-9]*)(?=[ ,}\\]])");
  std::vector<std::smatch> numbers;
  for (auto at = std::sregex_iterator(text.begin(), text.end(), number);
       at != std::sregex_iterator(); ++at) {
    if ((*at)[4].matched) numbers.push_back(*at);
  }
  if (numbers.empty()) return {};
  Random random(seed);
  const std::smatch& chosen =
      numbers[static_cast<std::size_t>(random.below(static_cast<int>(numbers.size())))];
  std::string changed = text;
  changed.replace(static_cast<std::size_t>(chosen.position(4)),
                  static_cast<std::size_t>(chosen.length(4)),
                  fmt::format("{:.8g}", 1.03 * std::stod(chosen[4].str())));
  const auto line = static_cast<std::size_t>(chosen.position(4));
  const std::string where =
      fmt::format("'{}' changed by 3 %", text.substr(line > 60 ? line - 60 : 0, 70));
  try {
    const scene::Robot robot = build(text), other = build(changed);
    Run first(robot), second(other);
    first.advance(kHalf);
    if (!first.error().empty()) return {};
    sim::parse_state(second.simulation, sim::format_state(first.simulation), "state");
    first.advance(kSteps - kHalf);
    second.advance(kSteps - kHalf);
    if (first.states.back().hash() != second.states.back().hash()) {
      return where + ": a state was accepted and goes on differently";
    }
  } catch (const Error&) {
    return {};  // rejected
  }
  return {};
}

}  // namespace sinew::combine
