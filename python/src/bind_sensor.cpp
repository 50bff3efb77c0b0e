#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "sinew/model/model.hpp"
#include "sinew/sense/channel.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

using sense::Channel;
using sense::ChannelSettings;

const sense::SensorModel& model(const Sensor& self) {
  return sense::sensors_of(self.session->model())[static_cast<std::size_t>(self.index)];
}

// A number for one component, an array for several.
py::object number_or_array(std::span<const double> values) {
  if (values.size() == 1) return py::float_(values.front());
  const auto count = static_cast<Eigen::Index>(values.size());
  return reading(VectorX(Eigen::Map<const VectorX>(values.data(), count)));
}

// Converts a number or an array (size,), which may be NaN.
std::vector<double> to_value(const py::object& value, const std::string& place) {
  const auto array = Array::ensure(value);
  if (!array || array.ndim() > 1) {
    PyErr_Clear();
    throw Error(ErrorKind::wrong_type, {.item = place},
                "this is neither a number nor a list of numbers",
                "give a number, or an array of the sensor's numbers");
  }
  return {array.data(), array.data() + array.size()};
}

template <class Get>
auto of_channel(Get get) {
  return [get](const Sensor& self) {
    const Session::Use use(*self.session);
    const sim::Simulation& simulation = self.session->simulation();
    return get(sense::sensors_of(simulation).channel(self.index), simulation);
  };
}

void feed(const Sensor& self, const py::object& value, const std::optional<double>& time) {
  const std::string place = fmt::format("sensor('{}').feed", model(self).name);
  const std::vector<double> numbers = to_value(value, place);
  const Session::Use use(*self.session);
  sim::Simulation& simulation = self.session->simulation();
  try {
    sense::sensors_of(simulation).feed(self.index, time.value_or(simulation.time()), numbers);
  } catch (const Error& error) {
    throw Error(error.kind(), {.item = place}, error.message(), error.remedy());
  }
}

void bind_sensor_type(py::module_& module) {
  py::class_<Sensor>(
      module, "Sensor",
      "A sensor of the scene; it does not affect the robot. From Simulation.sensor() or "
      "Simulation.sensors.")
      .def_property_readonly(
          "name", [](const Sensor& self) { return model(self).name; }, "str: name in the scene.")
      .def_property_readonly(
          "kind", [](const Sensor& self) { return model(self).kind; },
          "str: its type in the scene, such as 'marker' or 'cable-length'.")
      .def_property_readonly(
          "unit", [](const Sensor& self) { return model(self).source->components().front().unit; },
          "str: SI unit of its numbers; 'dB' for an attenuation; empty for a strain and a switch.")
      .def_property_readonly(
          "size", [](const Sensor& self) { return model(self).source->size(); },
          "int: number of components of a sample.")
      .def_property_readonly(
          "observable", [](const Sensor& self) { return model(self).observable; },
          "str: the observable that it reads, such as 'long_0.displacement'; 'NAME.true' if there "
          "is no such observable.")
      .def_property_readonly(
          "std", [](const Sensor& self) { return model(self).channel.standard_deviation(); },
          "float: standard deviation of one sample, sqrt(noise^2 + quantum^2/12), in its unit; "
          "without bias and drift.")
      .def_property_readonly(
          "rate",
          [](const Sensor& self) -> py::object {
            const double rate = model(self).channel.rate;
            return rate > 0.0 ? py::object(py::float_(rate)) : py::none();
          },
          "float or None: samples per second; None: one every step.")
      .def_property_readonly(
          "delay", [](const Sensor& self) { return model(self).channel.delay; },
          "float: time from taking a sample to its delivery (s).")
      .def_property_readonly(
          "value", of_channel([](const Channel& channel, const sim::Simulation&) {
            return number_or_array(channel.value());
          }),
          "float, or (size,) ndarray: last delivered sample, in its unit; nan before the first.")
      .def_property_readonly(
          "time",
          of_channel([](const Channel& channel, const sim::Simulation&) { return channel.time(); }),
          "float: time at which that sample was taken (s); nan before the first.")
      .def_property_readonly(
          "fresh", of_channel([](const Channel& channel, const sim::Simulation&) {
            return channel.fresh();
          }),
          "bool: whether it was delivered in the last step, by the last search for an equilibrium, "
          "or by feed() since the step before the last.")
      .def_property_readonly(
          "valid", of_channel([](const Channel& channel, const sim::Simulation& simulation) {
            return channel.valid(simulation.time());
          }),
          "bool: whether there is a sample not older than the scene's `timeout`.")
      .def_property_readonly(
          "missing", of_channel([](const Channel& channel, const sim::Simulation&) {
            return channel.missing();
          }),
          "int: number of samples since the start that were lost or fed with a nan.")
      .def_property_readonly(
          "true_value",
          [](const Sensor& self) {
            const Session::Use use(*self.session);
            return number_or_array(sense::sensors_of(self.session->simulation()).truth(self.index));
          },
          "float, or (size,) ndarray: present value without errors and delay.")
      .def("feed", &feed, py::arg("value"), py::arg("time") = py::none(),
           R"(feed($self, value, time=None)
--

Feeds a sample of a real sensor, which replaces the simulated ones until reset().

Parameters
----------
value : float, or (size,) array-like
    In its unit. A sample with a nan is missing: the previous one remains, and `missing` counts it.
time : float, optional
    Time at which it was taken (s); by default the present time of the simulation.

Raises
------
Error
    wrong-type; wrong-length; not-finite for infinite numbers; non-monotonic-time for a sample
    before the last.
)")
      .def("__repr__", [](const Sensor& self) {
        return fmt::format("<sinew.Sensor '{}', {}>", model(self).name, model(self).kind);
      });
}

Channel make_channel(double noise, double bias, double drift, double quantum, double rate,
                     double delay, double dropout,
                     const std::optional<std::pair<double, double>>& range,
                     const std::optional<double>& timeout, std::int64_t seed, std::int64_t size) {
  ChannelSettings settings;
  settings.noise = noise;
  settings.bias = bias;
  settings.drift = drift;
  settings.quantum = quantum;
  settings.rate = rate;
  settings.delay = delay;
  settings.dropout = dropout;
  if (range) {
    settings.min = range->first;
    settings.max = range->second;
  }
  if (timeout) settings.timeout = *timeout;
  settings.seed = static_cast<std::uint64_t>(seed);
  if (size < 1 || size > 1'000'000) {
    throw Error(ErrorKind::out_of_range, {.item = "size"}, fmt::format("size is {}", size),
                "give 1 or more");
  }
  return Channel(settings, static_cast<std::size_t>(size));
}

void bind_channel_type(py::module_& module) {
  py::class_<Channel>(module, "Channel",
                      R"(Channel(*, noise=0, bias=0, drift=0, quantum=0, rate=0, delay=0, dropout=0,
        range=None, timeout=None, seed=0, size=1)
--

Channel of a sensor: adds errors, sampling and delay to values that are offered to it.
Sample k of a true value x, taken at t_k, is

    y = clamp(round((x + bias + w_k + noise n_k)/quantum) quantum, range)
    w_k = w_(k-1) + drift sqrt(t_k - t_(k-1)) m_k,  w_0 = 0

with standard normal n_k and m_k. Sample k draws n_k (component c) from words 0 and 1 and m_k from words 2
and 3 of block (k, c, 0, 0) of Philox4x64-10 (Salmon et al., SC'11) with the key (seed, 0), and
whether it is lost from word 0 of block (k, 2^64 - 1, 0, 0): the same bits for any number of threads.

Parameters
----------
noise, bias, drift, quantum : float
    In the value's unit; drift: standard deviation of the random walk after 1 s; quantum 0: no
    rounding.
rate : float
    Samples per second; 0: every offered value.
delay : float
    Time from taking a sample to its delivery (s).
dropout : float
    Probability that a sample is lost.
range : (float, float), optional
    Limits at which values saturate.
timeout : float, optional
    Age from which a sample is no longer valid (s).
seed : int
    Random seed.
size : int
    Number of components of a value.

Raises
------
Error
    out-of-range.
)")
      .def(py::init(&make_channel), py::kw_only(), py::arg("noise") = 0.0, py::arg("bias") = 0.0,
           py::arg("drift") = 0.0, py::arg("quantum") = 0.0, py::arg("rate") = 0.0,
           py::arg("delay") = 0.0, py::arg("dropout") = 0.0, py::arg("range") = py::none(),
           py::arg("timeout") = py::none(), py::arg("seed") = 0, py::arg("size") = 1)
      .def(
          "offer",
          [](Channel& self, double time, const py::object& value) {
            const std::vector<double> numbers = to_value(value, "offer");
            if (numbers.size() != self.size()) {
              throw Error(
                  ErrorKind::wrong_length, {.item = "offer"},
                  fmt::format("{} numbers for a channel of {}", numbers.size(), self.size()),
                  fmt::format("give {}", self.size()));
            }
            self.offer(time, numbers);
            return self.fresh();
          },
          py::arg("time"), py::arg("value"),
          R"(offer($self, time, value)
--

Offers the true value at a time (s), not before the last one. Takes a sample if one is due, and delivers due
samples. Returns whether a sample was delivered. Raises Error: wrong-type, wrong-length.
)")
      .def(
          "receive",
          [](Channel& self, double time, const py::object& value) {
            self.receive(time, to_value(value, "receive"));
          },
          py::arg("time"), py::arg("value"),
          R"(receive($self, time, value)
--

Feeds a sample of a real sensor; from then on offered values are not sampled. A sample with a nan is
missing. Raises Error: wrong-type, wrong-length, not-finite, non-monotonic-time.
)")
      .def("restart", &Channel::restart,
           "restart($self)\n"
           "--\n"
           "\n"
           "Returns to the initial state.\n")
      .def(
          "valid", [](const Channel& self, double now) { return self.valid(now); }, py::arg("now"),
          "valid($self, now)\n"
          "--\n"
          "\n"
          "Whether there is a sample not older than the timeout at a time (s).\n")
      .def_property_readonly(
          "value", [](const Channel& self) { return number_or_array(self.value()); },
          "float, or (size,) ndarray: last delivered sample; nan before the first.")
      .def_property_readonly("time", &Channel::time,
                             "float: time at which it was taken (s); nan before the first.")
      .def_property_readonly("fresh", &Channel::fresh,
                             "bool: whether the last offer() delivered a sample.")
      .def_property_readonly("samples", &Channel::samples,
                             "int: number of samples taken, including lost ones.")
      .def_property_readonly("missing", &Channel::missing,
                             "int: number of samples lost, or with a nan.")
      .def_property_readonly(
          "std", [](const Channel& self) { return self.settings().standard_deviation(); },
          "float: standard deviation of one sample, sqrt(noise^2 + quantum^2/12), without bias and "
          "drift.")
      .def("__copy__", [](const Channel& self) { return Channel(self); })
      .def("__deepcopy__", [](const Channel& self, const py::dict&) { return Channel(self); });
}

}  // namespace

void bind_sensor(py::module_& module) {
  bind_sensor_type(module);
  bind_channel_type(module);
}

}  // namespace sinew::python
