// Binds the linear equations of motion.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "sinew/sim/linear_model.hpp"

#include "arrays.hpp"
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

/// As a scipy.sparse.csc_matrix, a copy.
py::object sparse(const sim::LinearModel::Matrix& matrix) {
  sim::LinearModel::Matrix packed = matrix;
  packed.makeCompressed();
  const auto entries = static_cast<py::ssize_t>(packed.nonZeros());
  const auto columns = static_cast<py::ssize_t>(packed.cols());
  return py::module_::import("scipy.sparse")
      .attr("csc_matrix")(py::make_tuple(py::array_t<double>(entries, packed.valuePtr()),
                                         py::array_t<int>(entries, packed.innerIndexPtr()),
                                         py::array_t<int>(columns + 1, packed.outerIndexPtr())),
                          py::arg("shape") = py::make_tuple(packed.rows(), packed.cols()));
}

template <sim::LinearModel::Matrix sim::LinearModel::*member>
py::object sparse_of(const sim::LinearModel& self) {
  return sparse(self.*member);
}

template <class Own>
auto array_of(Own sim::LinearModel::*member) {
  return [member](const sim::LinearModel& self) { return reading(self.*member); };
}

}  // namespace

void bind_linear_model(py::module_& module) {
  using sim::LinearModel;
  py::class_<LinearModel>(
      module, "LinearModel",
      "Linear equations of small motions x of all coordinates from one state, M x'' + D x' + K x = "
      "B u + J.T mu + f, y = C x, J x = 0, with changes u of the actuators' efforts. From "
      "Simulation.linear_model().")
      .def_property_readonly("M", &sparse_of<&LinearModel::mass>,
                             "(n, n) scipy.sparse.csc_matrix: mass matrix (kg).")
      .def_property_readonly("D", &sparse_of<&LinearModel::damping>,
                             "(n, n) scipy.sparse.csc_matrix: damping matrix (N s/m).")
      .def_property_readonly("K", &sparse_of<&LinearModel::stiffness>,
                             "(n, n) scipy.sparse.csc_matrix: tangent stiffness (N/m) at the "
                             "present efforts.")
      .def_property_readonly("B", array_of(&LinearModel::input),
                             "(n, actuators) ndarray: force on the coordinates per unit of effort.")
      .def_property_readonly("C", array_of(&LinearModel::output),
                             "(outputs, n) ndarray: motions of the effectors.")
      .def_property_readonly("J", array_of(&LinearModel::held),
                             "(m, n) ndarray: motions that joints and welds hold.")
      .def_property_readonly("f", array_of(&LinearModel::imbalance),
                             "(n,) ndarray: unbalanced forces (N), zero at an equilibrium.")
      .def_readonly("outputs", &LinearModel::outputs, "list of str: 'tip.x', rows of C.")
      .def_readonly("first", &LinearModel::first,
                    "list of int, (bodies + 1,): first coordinate of each body, in the order of "
                    "Simulation.bodies.")
      .def("__repr__", [](const LinearModel& self) {
        return fmt::format("<sinew.LinearModel of {} coordinates, {} inputs, {} outputs>",
                           self.imbalance.size(), self.input.cols(), self.output.rows());
      });
}

void bind_simulation_linear_model(SimulationType& type) {
  type.def(
      "linear_model",
      [](Session& self) {
        const Session::Use use(self);
        return sim::linear_model(self.simulation());
      },
      R"(linear_model($self)
--

Linear equations of motion near the present state, which is not changed: mass, damping and stiffness
matrices, the forces of actuators and the motions of effectors, as control and modal analysis need them.

    linear = sim.linear_model()
    w2, modes = scipy.sparse.linalg.eigsh(linear.K, 4, linear.M, sigma=0)

Coordinates are the displacements (m) of the free nodes of finite-element bodies, x, y, z of each in their
order; the angles (rad) of arms; displacements and rotations of rigid bodies. Coordinates that a region
holds are left out. The stiffness includes that of loaded cables and chambers at the present efforts.
Drives, springs, contacts and friction are not part of it; materials with viscosity have their
instantaneous stiffness.

Returns
-------
LinearModel
    `M`, `D`, `K` (sparse), `B`, `C`, `J`, `f`, `outputs`, `first`.
)");
}

}  // namespace sinew::python
