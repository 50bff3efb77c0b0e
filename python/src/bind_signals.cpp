#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/model/signal.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

using model::Signal;

// The Python classes of signals; each is a Signal.
struct Ramp : Signal {};
struct Sine : Signal {};
struct Steps : Signal {};
struct Samples : Signal {};

double number(const py::handle& value, const char* place) {
  return to_number(value, place, "SI units");
}

std::vector<std::pair<double, double>> to_pairs(const py::handle& value, const char* place) {
  const Array table = to_array(value, place, "(n, 2): time in s, value");
  if (table.ndim() != 2 || table.shape(1) != 2) {
    throw Error(ErrorKind::wrong_shape, {.item = place}, "the table does not have two columns",
                "give an array of shape (n, 2): time in s, value");
  }
  std::vector<std::pair<double, double>> pairs;
  for (py::ssize_t i = 0; i < table.shape(0); ++i) {
    pairs.emplace_back(table.at(i, 0), table.at(i, 1));
  }
  return pairs;
}

Signal samples(const py::handle& value, const char* place) {
  std::vector<double> times, values;
  for (const auto& [time, sample] : to_pairs(value, place)) {
    times.push_back(time);
    values.push_back(sample);
  }
  return at_argument(place, [&] { return Signal::sampled(std::move(times), std::move(values)); });
}

void bind_base(py::module_& module) {
  py::class_<Signal>(module, "Signal",
                     "A command over time: Ramp, Sine, Steps or Samples. Immutable.")
      .def("value", &Signal::value, py::arg("time"),
           R"(value($self, time)
--

Value at a time.

Parameters
----------
time : float
    s.

Returns
-------
float
    In the unit of the commanded quantity: N or m.
)")
      .def_property_readonly(
          "end_time", &Signal::end_time,
          "float: end of the signal or of its first period (s); 0 for a constant.")
      .def_property_readonly("is_constant", &Signal::is_constant,
                             "bool: whether the value is constant.")
      .def("__repr__", [](const py::object& self) {
        return fmt::format("<sinew.{} {:g} at 0 s, ends at {:g} s>",
                           std::string(py::str(py::type::of(self).attr("__name__"))),
                           self.cast<const Signal&>().value(0.0),
                           self.cast<const Signal&>().end_time());
      });
}

void bind_smooth(py::module_& module) {
  py::class_<Ramp, Signal>(module, "Ramp", R"(Ramp(from_, to, *, start=0.0, duration=1.0)
--

`from_` until `start`, then linearly to `to` within `duration`, then constant.

Parameters
----------
from_, to : float
    N or m.
start : float
    s, >= 0.
duration : float
    s, > 0.
)")
      .def(py::init([](const py::object& from, const py::object& to, const py::object& start,
                       const py::object& duration) {
             return Ramp{at_argument("Ramp", [&] {
               return Signal::ramp({number(from, "Ramp(from_)"), number(to, "Ramp(to)"),
                                    number(start, "Ramp(start)"),
                                    number(duration, "Ramp(duration)")});
             })};
           }),
           py::arg("from_"), py::arg("to"), py::kw_only(), py::arg("start") = 0.0,
           py::arg("duration") = 1.0);
  py::class_<Sine, Signal>(module, "Sine", R"(Sine(amplitude, period, *, mean=0.0, phase=0.0)
--

mean + amplitude sin(2 pi t / period + phase).

Parameters
----------
amplitude, mean : float
    N or m.
period : float
    s, > 0.
phase : float
    rad.
)")
      .def(
          py::init([](const py::object& amplitude, const py::object& period, const py::object& mean,
                      const py::object& phase) {
            return Sine{at_argument("Sine", [&] {
              return Signal::sine({number(mean, "Sine(mean)"), number(amplitude, "Sine(amplitude)"),
                                   number(period, "Sine(period)"), number(phase, "Sine(phase)")});
            })};
          }),
          py::arg("amplitude"), py::arg("period"), py::kw_only(), py::arg("mean") = 0.0,
          py::arg("phase") = 0.0);
}

void bind_tables(py::module_& module) {
  py::class_<Steps, Signal>(module, "Steps", R"(Steps(steps)
--

A step function: each value holds from its time to the next one's, the last one from then on.

Parameters
----------
steps : (n, 2) array_like
    Time (s; the first is 0, increasing) and value (N or m).
)")
      .def(py::init([](const py::object& steps) {
             return Steps{
                 at_argument("Steps", [&] { return Signal::steps(to_pairs(steps, "Steps")); })};
           }),
           py::arg("steps"));
  py::class_<Samples, Signal>(module, "Samples", R"(Samples(samples)
--

Linear interpolation between samples; constant before the first and after the last one.

Parameters
----------
samples : (n, 2) array_like
    Time (s; increasing, >= 0) and value (N or m).
)")
      .def(py::init([](const py::object& table) { return Samples{samples(table, "Samples")}; }),
           py::arg("samples"));
}

}  // namespace

model::Signal to_signal(const py::handle& value, const std::string& place,
                        const std::string& unit) {
  if (py::isinstance<Signal>(value)) return value.cast<const Signal&>();
  if (py::isinstance<py::function>(value)) {
    throw Error(ErrorKind::wrong_type, {.item = place}, "a command cannot be a function",
                "assign a number before every step, or give a signal such as sinew.Ramp");
  }
  const bool table = py::isinstance<py::sequence>(value) && !py::isinstance<py::str>(value);
  const bool array =
      py::isinstance<py::array>(value) && py::reinterpret_borrow<py::array>(value).ndim() > 0;
  if (table || array) return samples(value, place.c_str());
  return Signal::constant(to_number(value, place, unit));
}

void bind_signals(py::module_& module) {
  bind_base(module);
  bind_smooth(module);
  bind_tables(module);
}

}  // namespace sinew::python
