// Simulation.run: steps, and writes what was asked for into arrays.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/mechanics/body.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

// A column of the result: `width` numbers a moment.
struct Column {
  std::string name;
  std::vector<py::ssize_t> shape;  // of one moment; empty for a number
  bool by_default = true;
  std::function<void(Session&, double*)> write;
  std::vector<double> values;

  std::size_t width() const {
    std::size_t size = 1;
    for (const auto length : shape) size *= static_cast<std::size_t>(length);
    return size;
  }
};

void add_actuators(const Session& session, std::vector<Column>& columns) {
  const auto& actuators = session.model().actuators();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    const auto index = static_cast<int>(i);
    columns.push_back(
        {actuators[i].name + "." + actuators[i].effort_name().name,
         {},
         true,
         [index](Session& s, double* to) { *to = s.simulation().actuator(index).effort; },
         {}});
    columns.push_back(
        {actuators[i].name + "." + actuators[i].motion_name().name,
         {},
         true,
         [index](Session& s, double* to) { *to = s.simulation().actuator(index).motion; },
         {}});
  }
}

void add_effectors(const Session& session, std::vector<Column>& columns) {
  const auto& effectors = session.model().effectors();
  for (std::size_t i = 0; i < effectors.size(); ++i) {
    const auto index = static_cast<int>(i);
    const bool turns = std::string_view(session.model().effector(index).unit()) == "rad";
    columns.push_back({effectors[i].name + (turns ? ".rotation" : ".position"),
                       {3},
                       true,
                       [index](Session& s, double* to) {
                         const Vector3 value = s.simulation().effector_value(index);
                         std::copy_n(value.data(), 3, to);
                       },
                       {}});
  }
}

// A point's or a number; of a line its length, and its points.
void add_probes(const Session& session, std::vector<Column>& columns) {
  const auto& probes = session.model().probes();
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const auto index = static_cast<int>(i);
    const auto* line = dynamic_cast<const constraint::LineProbe*>(probes[i].get());
    const auto count = static_cast<py::ssize_t>(line ? 1 : probes[i]->components().size());
    const auto put = [index](std::size_t from) {
      return [index, from](Session& s, double* to) {
        const std::vector<double> values = s.simulation().probe_values(index);
        std::copy(values.begin() + static_cast<std::ptrdiff_t>(from), values.end(), to);
      };
    };
    const auto first = [index](Session& s, double* to) {
      *to = s.simulation().probe_values(index).front();
    };
    const std::string& name = probes[i]->name();
    if (line != nullptr) {
      columns.push_back({name + ".value", {}, true, first, {}});
      columns.push_back({name + ".positions",
                         {static_cast<py::ssize_t>(line->mark_count()), 3},
                         true,
                         put(1),
                         {}});
    } else {
      const auto shape = count == 1 ? std::vector<py::ssize_t>{} : std::vector<py::ssize_t>{count};
      columns.push_back({name + ".value", shape, true, put(0), {}});
    }
  }
}

void add_contacts(const Session& session, std::vector<Column>& columns) {
  const auto& contacts = session.model().contacts();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const auto index = static_cast<int>(i);
    const auto add = [&](const char* what, double sim::ContactSum::*member) {
      columns.push_back({contacts[i].name + what,
                         {},
                         true,
                         [index, member](Session& s, double* to) {
                           *to = s.simulation().contact_sum(index).*member;
                         },
                         {}});
    };
    columns.push_back({contacts[i].name + ".force",
                       {3},
                       true,
                       [index](Session& s, double* to) {
                         const Vector3 force = s.simulation().contact_sum(index).force;
                         std::copy_n(force.data(), 3, to);
                       },
                       {}});
    add(".normal_force", &sim::ContactSum::normal_force);
    add(".gap", &sim::ContactSum::smallest_gap);
  }
}

void add_bodies(Session& session, std::vector<Column>& columns) {
  for (std::size_t i = 0; i < session.model().bodies().size(); ++i) {
    const auto index = static_cast<int>(i);
    const auto nodes = session.simulation().world().body(index).positions().rows();
    columns.push_back({session.model().bodies()[i]->name() + ".positions",
                       {nodes, 3},
                       false,
                       [index](Session& s, double* to) {
                         const Points& points = s.simulation().world().body(index).positions();
                         std::copy_n(points.data(), points.size(), to);
                       },
                       {}});
  }
}

std::vector<Column> all_columns(Session& session) {
  std::vector<Column> columns;
  columns.push_back(
      {"time", {}, true, [](Session& s, double* to) { *to = s.simulation().time(); }, {}});
  add_actuators(session, columns);
  add_effectors(session, columns);
  add_probes(session, columns);
  add_contacts(session, columns);
  columns.push_back({"residual",
                     {},
                     true,
                     [](Session& s, double* to) { *to = s.simulation().report().residual; },
                     {}});
  if (session.controller()) {
    columns.push_back(
        {"error",
         {},
         true,
         [](Session& s, double* to) { *to = s.controller() ? s.controller()->law->error() : NAN; },
         {}});
  }
  add_bodies(session, columns);
  return columns;
}

std::vector<Column> choose_columns(Session& session, const py::object& record) {
  std::vector<Column> all = all_columns(session);
  std::vector<Column> chosen;
  if (record.is_none()) {
    for (Column& column : all) {
      if (column.by_default) chosen.push_back(std::move(column));
    }
    return chosen;
  }
  if (py::isinstance<py::str>(record) || !py::isinstance<py::iterable>(record)) {
    throw Error(ErrorKind::wrong_type, {.item = "run(record)"},
                fmt::format("{} is no list of names", std::string(py::repr(record))),
                "give a list such as ['tip.position']");
  }
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Column& column : all) names.push_back(column.name);
  chosen.push_back(all.front());  // time
  for (const auto& item : record) {
    const std::string name = py::str(item);
    if (name == "time") continue;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      const std::string near = nearest_word(name, names);
      throw Error(ErrorKind::unknown_name, {.item = "run(record)"},
                  fmt::format("there is no '{}' to record", name),
                  near.empty() ? fmt::format("one of {}", fmt::join(names, ", "))
                               : fmt::format("did you mean '{}'?", near));
    }
    chosen.push_back(all[static_cast<std::size_t>(found - names.begin())]);
  }
  return chosen;
}

void write_moment(Session& session, std::vector<Column>& columns) {
  const Session::Use use(session);
  for (Column& column : columns) {
    column.values.resize(column.values.size() + column.width());
    column.write(session, column.values.data() + column.values.size() - column.width());
  }
}

py::dict to_arrays(const std::vector<Column>& columns) {
  py::dict result;
  for (const Column& column : columns) {
    std::vector<py::ssize_t> shape = {
        static_cast<py::ssize_t>(column.values.size() / column.width())};
    shape.insert(shape.end(), column.shape.begin(), column.shape.end());
    result[column.name.c_str()] = Array(shape, column.values.data());
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
  if (steps > 1e9) {
    throw Error(ErrorKind::out_of_range, {.item = "run(duration)"},
                fmt::format("{:g} s are {:g} steps", seconds, steps), "give a shorter duration");
  }
  return static_cast<std::int64_t>(steps);
}

void advance_and_record(Session& session, std::int64_t steps, std::int64_t every,
                        const py::object& progress, std::vector<Column>& columns) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kPause = std::chrono::milliseconds(100);
  auto told = Clock::now();
  write_moment(session, columns);
  for (std::int64_t done = 0; done < steps;) {
    const std::int64_t part = std::min(every, steps - done);
    session.advance(part);
    done += part;
    write_moment(session, columns);
    if (!progress.is_none() && (done == steps || Clock::now() - told > kPause)) {
      progress(done, steps);
      told = Clock::now();
    }
  }
}

}  // namespace

py::dict run(const std::shared_ptr<Session>& session, const py::object& duration,
             const py::object& record, std::int64_t every, const py::object& progress) {
  if (every < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "run(every)"}, fmt::format("every is {}", every),
                "give 1 or more");
  }
  if (!progress.is_none() && PyCallable_Check(progress.ptr()) == 0) {
    throw Error(ErrorKind::wrong_type, {.item = "run(progress)"}, "it cannot be called",
                "give a function of (steps done, all steps)");
  }
  const std::int64_t steps = count_steps(*session, duration);
  std::vector<Column> columns;
  {
    const Session::Use use(*session);
    columns = choose_columns(*session, record);
  }
  try {
    advance_and_record(*session, steps, every, progress, columns);
  } catch (const Error& error) {
    const py::object exception = to_python(error);
    exception.attr("recorded") = to_arrays(columns);
    PyErr_SetObject(py::type::of(exception).ptr(), exception.ptr());
    throw py::error_already_set();
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_KeyboardInterrupt)) {
      error.value().attr("recorded") = to_arrays(columns);
    }
    throw;
  }
  return to_arrays(columns);
}

}  // namespace sinew::python
