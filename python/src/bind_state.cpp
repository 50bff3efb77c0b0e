#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "sinew/run/state.hpp"

#include "bindings.hpp"
#include "session.hpp"

namespace py = pybind11;

namespace sinew::python {

void bind_state(py::module_& module) {
  py::class_<SavedState>(
      module, "State",
      "State of a run. State and inputs together determine how the run continues. From "
      "Simulation.state(); states of one robot can be compared, copied and pickled.")
      .def_property_readonly("steps", &SavedState::steps, "int: number of steps since the start.")
      .def_property_readonly(
          "bytes", [](const SavedState& self) { return py::bytes(self.bytes()); },
          "bytes: content of the file that Simulation.save_state() writes.")
      .def("__eq__",
           [](const SavedState& a, const SavedState& b) { return a.bytes() == b.bytes(); })
      .def("__eq__", [](const SavedState&, const py::object&) { return false; })
      .def("__hash__",
           [](const SavedState& self) { return std::hash<std::string>{}(self.bytes()); })
      .def("__copy__", [](const SavedState& self) { return self; })
      .def("__deepcopy__", [](const SavedState& self, const py::dict&) { return self; })
      .def("__repr__",
           [](const SavedState& self) {
             return fmt::format("<sinew.State after {} steps, {} bytes>", self.steps(),
                                self.bytes().size());
           })
      .def(
          py::pickle([](const SavedState& self) { return py::make_tuple(py::bytes(self.bytes())); },
                     [](const py::tuple& parts) {
                       SavedState state(parts[0].cast<std::string>());
                       state.steps();  // throws if it is not a state
                       return state;
                     }));
}

}  // namespace sinew::python
