// Batches: many simulations that are stepped by one call.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "arrays.hpp"
#include "batch.hpp"
#include "bindings.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

// A selection of simulations: an array of bools, and a view of it.
struct Choice {
  py::array_t<bool, py::array::c_style> array;
  std::span<const bool> which;
};

Choice to_choice(const py::object& value, const std::string& place, std::size_t size) {
  if (value.is_none()) return {};
  Choice choice;
  const auto array = py::array::ensure(value);
  if (!array || !array.dtype().is(py::dtype::of<bool>()) || array.ndim() != 1 ||
      array.shape(0) != static_cast<py::ssize_t>(size)) {
    throw Error(ErrorKind::wrong_shape, {.item = place},
                "it does not say of each simulation whether it takes part",
                fmt::format("give an array of {} bools", size));
  }
  choice.array = array;
  choice.which = {choice.array.data(), size};
  return choice;
}

void command_rows(Batch& self, const std::string& quantity, const py::object& values,
                  const py::object& which) {
  const Array array = to_array(values, "Batch.command(values)", "(simulations, actuators)");
  if (array.ndim() != 2 || array.shape(0) != static_cast<py::ssize_t>(self.size())) {
    throw Error(ErrorKind::wrong_shape, {.item = "Batch.command(values)"},
                fmt::format("it does not have {} rows", self.size()),
                "give an array (simulations, actuators)");
  }
  const Choice choice = to_choice(which, "Batch.command(which)", self.size());
  self.command(quantity, Eigen::Map<const Rows>(array.data(), array.shape(0), array.shape(1)),
               choice.which);
}

py::list step(Batch& self, const py::object& n, const py::object& which) {
  const std::int64_t count = to_count(n, "Batch.step(n)");
  if (count < 0) {
    throw Error(ErrorKind::out_of_range, {.item = "Batch.step(n)"}, fmt::format("n is {}", count),
                "give zero or more steps");
  }
  const Choice choice = to_choice(which, "Batch.step(which)", self.size());
  py::list failures;
  for (const auto& failure : self.step(count, choice.which)) {
    failures.append(failure ? to_python(*failure) : py::none());
  }
  return failures;
}

Array read_rows(Batch& self, const std::vector<std::string>& names) {
  const Rows rows = self.read(names);
  return Array({rows.rows(), rows.cols()}, rows.data());
}

}  // namespace

void bind_batch(py::module_& module) {
  py::class_<Batch>(module, "Batch",
                    R"(Batch(simulations, *, threads=1)
--

Many simulations that are stepped, commanded and read by one call each. Use it if a step takes only microseconds.

Each thread has a contiguous block of simulations and does not need the interpreter lock. Results are the same as for each
simulation alone, bit for bit, for any number of threads. Between calls, each simulation may also be used by itself.

Parameters
----------
simulations : list of Simulation
    n different simulations: `sim.clone()` makes more. They may be of different robots.
threads : int
    1 or more.

Raises
------
Error
    empty-list, bad-argument, out-of-range.)")
      .def(py::init([](std::vector<std::shared_ptr<Session>> simulations, int threads) {
             return std::make_unique<Batch>(std::move(simulations), threads);
           }),
           py::arg("simulations"), py::kw_only(), py::arg("threads") = 1, "See help(sinew.Batch).")
      .def("__len__", &Batch::size)
      .def("__getitem__", &Batch::at, py::arg("index"))
      .def_property_readonly("threads", &Batch::threads, "int: as given.")
      .def("command", &command_rows, py::arg("quantity"), py::arg("values"),
           py::arg("which") = py::none(),
           R"(command($self, quantity, values, which=None)
--

Commands a constant for every actuator, like assigning to its quantity.

Parameters
----------
quantity : str
    Quantity of every actuator: "tension", "torque", ...
values : (n, actuators)
    N, m, ...; actuators in the order of `sim.actuators`.
which : (n,) of bool, optional
    Simulations to command; all by default.

Raises
------
Error
    wrong-shape, wrong-type, not-finite, wrong-actuator-type, out-of-range, actuator-owned.)")
      .def("step", &step, py::arg("n") = 1, py::arg("which") = py::none(),
           R"(step($self, n=1, which=None)
--

Advances by n time steps, in threads, without the interpreter lock. Ctrl-C ends the present steps; simulations may then be
at different times. Issues the same warnings as Simulation.step().

Parameters
----------
n : int
    0 or more.
which : (n,) of bool, optional
    Simulations to advance; all by default.

Returns
-------
list of RunError or None
    For each simulation the error that ended its steps, as raised by Simulation.step(). It is then in the state before the step that failed.

Raises
------
Error
    out-of-range, wrong-shape; not-finite for external forces that are not; simulation-busy.)")
      .def("read", &read_rows, py::arg("names"),
           R"(read($self, names)
--

Present observables of all simulations.

Parameters
----------
names : list of str
    As in run.csv and Simulation.run: "tip.position", "long_0.tension".

Returns
-------
(n, numbers) ndarray
    A row for each simulation; the numbers of one name follow those of the previous one. SI units.

Raises
------
Error
    unknown-name, with a suggestion; wrong-shape if simulations differ in the shape of a name.)")
      .def("__repr__", [](const Batch& self) {
        return fmt::format("<sinew.Batch of {} simulations, {} threads>", self.size(),
                           self.threads());
      });
}

}  // namespace sinew::python
