// Binds high-rate loops, by numbers; python/sinew/high_rate.py adds names.
#include <memory>
#include <string>
#include <vector>

#include "sinew/core/whole.hpp"
#include "sinew/high_rate/high_rate_loop.hpp"
#include "sinew/high_rate/snapshot.hpp"
#include "sinew/high_rate/udp_device.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

using namespace high_rate;

// A clock without real time: a period takes no time, and sleeping sets the time.
class IdealClock : public Clock {
 public:
  double now() override { return time_; }
  void sleep_until(double time) override { time_ = time; }

 private:
  double time_ = 0.0;
};

struct NativeLoop {
  std::shared_ptr<UdpDevice> device;  // null without a socket
  std::unique_ptr<HighRateLoop> loop;
  IdealClock clock;
};

// Converts rows of a table that Python has checked and that may contain infinities.
template <typename Row, typename Make>
std::vector<Row> to_rows(const Array& table, Make&& make) {
  std::vector<Row> rows;
  for (py::ssize_t i = 0; i < table.shape(0); ++i) {
    rows.push_back(make([&](py::ssize_t column) { return table.at(i, column); }));
  }
  return rows;
}

HighRateSettings to_settings(const py::dict& given) {
  const auto table = [&](const char* name) { return given[name].cast<Array>(); };
  const auto number = [&](const char* name) { return given[name].cast<double>(); };
  HighRateSettings settings;
  settings.driven = to_rows<DrivenRow>(table("driven"), [](const auto& at) {
    return DrivenRow{at(0), at(1), at(2), at(3), at(4), at(5)};
  });
  settings.unknown = to_rows<UnknownRow>(table("unknown"), [](const auto& at) {
    return UnknownRow{at(0), at(1), at(2)};
  });
  settings.hands = to_rows<HandRow>(table("hands"), [](const auto& at) {
    return HandRow{at(0), at(1)};
  });
  settings.sensors = to_rows<SensorRow>(table("sensors"), [](const auto& at) {
    return SensorRow{whole<int>(at(0)), at(1)};
  });
  settings.tasks = to_rows<TaskRow>(table("tasks"), [](const auto& at) {
    return TaskRow{whole<int>(at(0)), at(1) != 0.0 ? TaskKind::effort : TaskKind::motion, at(2),
                   at(3) != 0.0};
  });
  settings.observed = given["observed"].cast<int>();
  settings.max_contacts = given["max_contacts"].cast<int>();
  settings.period = number("period");
  settings.blend = number("blend");
  settings.stale_after = number("stale_after");
  settings.release_time = number("release_time");
  settings.epsilon = number("epsilon");
  settings.largest_step = number("largest_step");
  settings.passivity = {given["passivity"].cast<bool>(), number("reserve"),
                        number("damping_limit")};
  return settings;
}

std::unique_ptr<NativeLoop> make(const py::dict& given, const py::object& udp) {
  auto self = std::make_unique<NativeLoop>();
  const HighRateSettings settings = to_settings(given);
  check(settings);
  if (!udp.is_none()) {
    const auto [address, port] = udp.cast<std::pair<std::string, int>>();
    self->device = std::make_shared<UdpDevice>(settings, address, port);
  }
  self->loop = std::make_unique<HighRateLoop>(settings, self->device);
  return self;
}

VectorX to_numbers(const Array& list) {
  VectorX numbers(list.size());
  for (py::ssize_t k = 0; k < list.size(); ++k) numbers[k] = list.data()[k];
  return numbers;
}

void publish(NativeLoop& self, const Array& compliance, const Array& free, const Array& effort,
             const std::vector<double>& friction, double time, double size) {
  Snapshot snapshot;
  snapshot.compliance = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      compliance.data(), compliance.shape(0), compliance.shape(1));
  snapshot.free = to_numbers(free);
  snapshot.effort = to_numbers(effort);
  snapshot.friction = friction;
  snapshot.time = time;
  snapshot.size = size;
  self.loop->publish(std::move(snapshot));
}

Snapshot take(Session& session, const SnapshotRows& rows, int max_contacts, bool statics) {
  const Session::Use use(session);
  const py::gil_scoped_release others;
  return take_snapshot(session.simulation(), rows, max_contacts, statics);
}

SnapshotRows to_names(const py::dict& names) {
  const auto list = [&](const char* key) { return names[key].cast<std::vector<std::string>>(); };
  return {list("driven"), list("unknown"), list("effectors"), list("hands")};
}

py::dict snapshot_numbers(const Snapshot& snapshot) {
  py::dict result;
  result["compliance"] = copy(snapshot.compliance);
  result["free"] = copy(snapshot.free);
  result["effort"] = copy(snapshot.effort);
  result["friction"] = py::cast(snapshot.friction);
  result["time"] = snapshot.time;
  result["size"] = snapshot.size;
  return result;
}

void set_input(NativeLoop& self, const Array& sensors, const Array& hands, const Array& targets,
               const Array& driven) {
  self.loop->set_input(
      {to_numbers(sensors), to_numbers(hands), to_numbers(targets), to_numbers(driven)});
}

py::dict output(NativeLoop& self) {
  const HighRateOutput output = self.loop->output();
  py::dict result;
  result["driven"] = copy(output.driven);
  result["driven_motion"] = copy(output.driven_motion);
  result["unknown"] = copy(output.unknown);
  result["deviation"] = copy(output.deviation);
  result["hands"] = copy(output.hands);
  result["tasks"] = copy(output.tasks);
  result["contacts"] = copy(output.contacts);
  result["state"] = std::string(high_rate_state_name(output.state));
  result["cause"] = std::string(stale_cause_name(output.cause));
  result["limits_conflict"] = output.limits_conflict;
  result["failed"] = output.failed;
  result["law_residual"] = output.law_residual;
  result["snapshot_time"] = output.snapshot_time;
  result["snapshot_age"] = output.snapshot_age;
  result["jump"] = output.jump;
  result["damping"] = output.damping;
  result["energy_created"] = output.energy_created;
  result["period"] = output.period;
  return result;
}

py::dict report(const NativeLoop& self) {
  const HighRateReport report = self.loop->report();
  py::dict result;
  result["periods"] = report.periods;
  result["snapshots"] = report.snapshots;
  result["missed"] = report.missed;
  result["limits_conflicts"] = report.limits_conflicts;
  result["failures"] = report.failures;
  result["real_time"] = report.real_time;
  result["scheduling"] = report.scheduling;
  return result;
}

py::object udp_report(const NativeLoop& self) {
  if (self.device == nullptr) return py::none();
  const UdpReport report = self.device->report();
  py::dict result;
  result["port"] = self.device->port();
  result["received"] = report.received;
  result["invalid"] = report.invalid;
  result["outdated"] = report.outdated;
  result["sent"] = report.sent;
  result["not_sent"] = report.not_sent;
  return result;
}

py::tuple times(const TimeHistogram& histogram) {
  return py::make_tuple(histogram.counts(), histogram.longest());
}

}  // namespace

void bind_high_rate(py::module_& module) {
  py::class_<NativeLoop>(module, "_HighRateLoop",
                         "Implementation of sinew.HighRateLoop with rows by index.")
      .def(py::init(&make), py::arg("settings"), py::arg("udp"))
      .def("publish", &publish)
      .def("set_input", &set_input)
      .def("output", &output)
      .def("report", &report)
      .def("udp_report", &udp_report)
      .def("lateness", [](const NativeLoop& self) { return times(self.loop->lateness()); })
      .def("work", [](const NativeLoop& self) { return times(self.loop->work()); })
      .def("start", [](NativeLoop& self) { self.loop->start(); })
      .def(
          "stop", [](NativeLoop& self) { self.loop->stop(); },
          py::call_guard<py::gil_scoped_release>())
      .def("running", [](const NativeLoop& self) { return self.loop->running(); })
      .def(
          "advance",
          [](NativeLoop& self, std::int64_t periods) { self.loop->run(self.clock, periods); },
          py::call_guard<py::gil_scoped_release>());
  module.def("_take_snapshot",
             [](Session& session, const py::dict& names, int max_contacts, bool statics) {
               return snapshot_numbers(take(session, to_names(names), max_contacts, statics));
             });
}

}  // namespace sinew::python
