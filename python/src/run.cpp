// Simulation.run: steps a simulation, and records requested observables in arrays.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/control/controller_observables.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/scene/watched_cables.hpp"
#include "sinew/sim/observables.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

// One array of the result.
struct Column {
  std::size_t observable;  // index in the list
  std::vector<double> values;
  std::string name;  // as asked for
};

// The recorded observables and their values.
struct Recording {
  sim::Observables observables;
  std::vector<Column> columns;
};

sim::Observables list_observables(Session& session) {
  sim::Observables list(session.simulation());
  const auto controller = [&session]() -> const control::TargetController* {
    return session.controller() ? session.controller()->law.get() : nullptr;
  };
  const auto effectors = control::steered_effectors(controller());
  if (!effectors.empty()) control::add_controller(list, controller, effectors);
  return list;
}

// Whether an observable is recorded by default: not large arrays, observables that evaluate all
// elements, or those that differ from run to run.
bool is_default(const run::Observable& observable) {
  switch (observable.kind) {
    case run::ObservableKind::body:
    case run::ObservableKind::contact_point:
    case run::ObservableKind::energy:
    case run::ObservableKind::ledger:
    case run::ObservableKind::timing:
      return false;
    default:
      return true;
  }
}

std::vector<Column> choose_columns(const sim::Observables& observables, const py::object& record) {
  const std::vector<run::Observable>& list = observables.list();
  std::vector<Column> chosen;
  if (record.is_none()) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (is_default(list[k])) chosen.push_back({k, {}, list[k].name});
    }
    return chosen;
  }
  if (py::isinstance<py::str>(record) || !py::isinstance<py::iterable>(record)) {
    throw Error(ErrorKind::wrong_type, {.item = "run(record)"},
                fmt::format("{} is not a list of names", std::string(py::repr(record))),
                "give a list such as ['tip.position']");
  }
  chosen.push_back({observables.find("time"), {}, "time"});
  for (const auto& item : record) {
    const std::string name = py::str(item);
    if (name == "time") continue;
    chosen.push_back({observables.find(name, {.item = "run(record)"}), {}, name});
  }
  return chosen;
}

void write_moment(const Session& session, Recording& recording) {
  const Session::Use use(session);
  recording.observables.refresh();
  for (Column& column : recording.columns) {
    const std::span<const double> numbers = recording.observables.read(column.observable);
    column.values.insert(column.values.end(), numbers.begin(), numbers.end());
  }
}

py::object to_array(const run::Observable& observable, const std::vector<double>& values) {
  if (!observable.words.empty() && observable.shape.empty()) {
    py::list words;
    for (const double value : values) words.append(py::str(std::string(observable.word(value))));
    return py::module_::import("numpy").attr("array")(words, "U");
  }
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(values.size() / observable.size())};
  shape.insert(shape.end(), observable.shape.begin(), observable.shape.end());
  return Array(shape, values.data());
}

py::dict to_arrays(const Recording& recording) {
  py::dict result;
  for (const Column& column : recording.columns) {
    const run::Observable& observable = recording.observables.list()[column.observable];
    result[column.name.c_str()] = to_array(observable, column.values);
  }
  return result;
}

std::int64_t count_steps(const Session& session, const py::object& duration) {
  const double seconds = duration.is_none() ? session.robot().robot.description.run_duration()
                                            : to_number(duration, "run(duration)", "s");
  if (duration.is_none() && seconds <= 0.0) {
    throw Error(ErrorKind::missing_key, {.item = "run(duration)"},
                "the scene has neither a duration nor a signal that ends",
                "give the duration in s: sim.run(5.0)");
  }
  if (seconds < 0.0) {
    throw Error(ErrorKind::out_of_range, {.item = "run(duration)"},
                fmt::format("the duration is {:g} s", seconds), "give zero or more");
  }
  const double steps = std::round(seconds / session.model().step().time_step);
  if (!(steps <= 1e9)) {
    throw Error(ErrorKind::out_of_range, {.item = "run(duration)"},
                fmt::format("{:g} s are {:g} steps", seconds, steps), "give a shorter duration");
  }
  return whole<std::int64_t>(steps);
}

void advance_and_record(Session& session, std::int64_t steps, std::int64_t every,
                        const py::object& progress, sim::OnFailure on_failure,
                        Recording& recording) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kPause = std::chrono::milliseconds(100);
  constexpr std::int64_t kMany = 10;           // steps of which something can be said of its cables
  constexpr std::int64_t kStrainSamples = 64;  // states whose strains are looked at
  auto told = Clock::now();
  std::optional<sim::CableWatch> cables;
  if (steps >= kMany) {
    cables.emplace(session.simulation(), scene::watched_cables(session.robot().robot));
  }
  write_moment(session, recording);
  scene::StrainWatch strains(session.robot().robot);
  const std::int64_t stride = std::max<std::int64_t>(steps / kStrainSamples, 1);
  std::int64_t seen = 0;
  for (std::int64_t done = 0; done < steps;) {
    const std::int64_t part = std::min(every, steps - done);
    session.advance(part, on_failure, cables ? &*cables : nullptr);
    done += part;
    write_moment(session, recording);
    if (done - seen >= stride || done == steps) {
      const Session::Use use(session);
      strains.see(session.simulation());
      seen = done;
    }
    if (!progress.is_none() && (done == steps || Clock::now() - told > kPause)) {
      progress(done, steps);
      told = Clock::now();
    }
  }
  if (steps > 1) session.warn_units();
  if (cables) session.warn_cables(*cables);
  session.warn_strains(strains);
}

}  // namespace

py::dict run(const std::shared_ptr<Session>& session, const py::object& duration,
             const py::object& record, const py::object& every, const py::object& progress,
             bool keep_going) {
  const std::int64_t pace = to_count(every, "run(every)");
  if (pace < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "run(every)"}, fmt::format("every is {}", pace),
                "give 1 or more");
  }
  if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) {
    throw Error(ErrorKind::wrong_type, {.item = "run(progress)"}, "it cannot be called",
                "give a function of (steps done, all steps)");
  }
  const std::int64_t steps = count_steps(*session, duration);
  Recording recording = [&] {
    const Session::Use use(*session);
    sim::Observables observables = list_observables(*session);
    std::vector<Column> columns = choose_columns(observables, record);
    return Recording{std::move(observables), std::move(columns)};
  }();
  try {
    const auto on_failure = keep_going ? sim::OnFailure::keep_going : sim::OnFailure::stop;
    advance_and_record(*session, steps, pace, progress, on_failure, recording);
  } catch (const Error& error) {
    const py::object exception = to_python(error);
    exception.attr("recorded") = to_arrays(recording);
    PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr());
    throw py::error_already_set();
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_KeyboardInterrupt)) {
      error.value().attr("recorded") = to_arrays(recording);
    }
    throw;
  }
  return to_arrays(recording);
}

}  // namespace sinew::python
