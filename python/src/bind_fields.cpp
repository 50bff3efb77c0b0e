// Binds tensors, fields and reactions of elements and nodes.
#include <algorithm>

#include <fmt/format.h>

#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/element_states.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/of_elements.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const fem::HasMaterial& body(const Body& self) {
  return fem::of_elements<const fem::HasMaterial>(self.session->simulation().body(self.index));
}
const fem::FemModel& elements(const Body& self) { return body(self).material().elements(); }

// An array (m, 3, 3) of tensors.
Array tensors(const std::vector<Matrix3>& list) {
  Array result({static_cast<Eigen::Index>(list.size()), Eigen::Index{3}, Eigen::Index{3}});
  double* to = result.mutable_data();
  for (const Matrix3& m : list) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) *to++ = m(r, c);
    }
  }
  return result;
}

template <typename Get>
auto of_elements(Get get) {
  return [get](const Body& self) {
    const Session::Use use(*self.session);
    return get(fem::element_states(body(self)));
  };
}

Array numbers(const std::vector<double>& values) {
  return copy(
      VectorX(Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()))));
}

Array element_field(const Body& self, const std::string& field) {
  const Session::Use use(*self.session);
  return numbers(fem::element_field(body(self), fem::element_field_of(field)));
}

Array nodal_field(const Body& self, const std::string& field) {
  const Session::Use use(*self.session);
  const fem::NodalMean mean(elements(self));
  return numbers(mean(fem::element_field(body(self), fem::element_field_of(field))));
}

// A field of a recorded moment: at given positions, at rest, as the view computes it.
Array nodal_field_at(const Body& self, const std::string& field, const py::object& positions) {
  const Points at =
      to_points(positions, "nodal_field_at(positions)", "m", body(self).positions().rows());
  const Session::Use use(*self.session);
  sim::Simulation& simulation = self.session->simulation();
  const run::State before = simulation.state();
  run::State shown = before;
  std::vector<double>& own = shown.bodies[static_cast<std::size_t>(self.index)];
  std::ranges::fill(own, 0.0);
  std::copy_n(at.data(), at.size(), own.begin());
  simulation.restore(shown);
  const fem::NodalMean mean(elements(self));
  const Array result = numbers(mean(fem::element_field(body(self), fem::element_field_of(field))));
  simulation.restore(before);
  return result;
}

// Averages element values (m, ...) to node values (n, ...).
py::array nodal_means(const Body& self, const py::array_t<double, py::array::c_style>& values) {
  const auto count = fem::ElementList(elements(self).mesh()).count();
  if (values.ndim() == 0 || values.shape(0) != count) {
    throw Error(ErrorKind::wrong_shape, {.item = "nodal_means(values)"},
                fmt::format("there are {} elements", count), "give one row for every element");
  }
  const auto width = static_cast<std::size_t>(values.size()) / static_cast<std::size_t>(count);
  const fem::NodalMean mean(elements(self));
  const std::vector<double> result =
      mean({values.data(), static_cast<std::size_t>(values.size())}, width);
  std::vector<py::ssize_t> shape(values.shape(), values.shape() + values.ndim());
  shape[0] = body(self).positions().rows();
  return py::array_t<double>(shape, result.data());
}

Array support_forces(const Body& self) {
  const Session::Use use(*self.session);
  sim::Simulation& simulation = self.session->simulation();
  simulation.world().measure_delta();  // rows at the current state
  return reading(fem::reactions(body(self), fem::element_states(body(self)), simulation.efforts(),
                                simulation.world().rows(), simulation.model().rows(), self.index));
}

}  // namespace

void bind_fields(py::module_& module, py::class_<Body>& type) {
  module.def("_element_fields", [] {
    py::dict all;
    for (const fem::ElementFieldInfo& info : fem::element_fields()) {
      all[info.name] = py::make_tuple(info.unit, info.description);
    }
    return all;
  });
  type.def("_nodal_field_at", &nodal_field_at, py::arg("field"), py::arg("positions"));
  type.def_property_readonly(
          "deformation_gradients", of_elements([](const fem::ElementStates& s) {
            return read_only(tensors(s.deformation));
          }),
          "(m, 3, 3) ndarray: F = dx/dX of every element, tetrahedra before hexahedra, the mean "
          "over its integration points. See `sinew.fields` for strains.")
      .def_property_readonly(
          "piola_stresses",
          of_elements([](const fem::ElementStates& s) { return read_only(tensors(s.piola)); }),
          "(m, 3, 3) ndarray: first Piola-Kirchhoff stress of every element (Pa), force per area "
          "at rest.")
      .def_property_readonly(
          "cauchy_stresses",
          of_elements([](const fem::ElementStates& s) { return read_only(tensors(s.cauchy)); }),
          "(m, 3, 3) ndarray: Cauchy stress of every element (Pa), force per present area.")
      .def_property_readonly(
          "element_volumes", of_elements([](const fem::ElementStates& s) {
            const auto count = static_cast<Eigen::Index>(s.volume.size());
            return reading(VectorX(Eigen::Map<const VectorX>(s.volume.data(), count)));
          }),
          "(m,) ndarray: volume of every element at rest (m^3).")
      .def("element_field", &element_field, py::arg("field"),
           R"(element_field($self, field)
--

One number for every element, tetrahedra before hexahedra: the mean over its integration points.

Parameters
----------
field : str
    A name of `sinew.fields.FIELDS`, such as 'von_mises_stress'.

Returns
-------
(m,) ndarray
    In the unit given by FIELDS.
)")
      .def("nodal_field", &nodal_field, py::arg("field"),
           R"(nodal_field($self, field)
--

Nodal values of a field: volume-weighted means of element_field(), as shown in the view and written by `sinew run --vtk`.

Parameters
----------
field : str
    A name of `sinew.fields.FIELDS`.

Returns
-------
(n,) ndarray
    NaN at nodes that belong to no element.
)")
      .def("nodal_means", &nodal_means, py::arg("values"),
           R"(nodal_means($self, values)
--

Averages element values at the nodes, weighted by the rest volumes of the adjacent elements.

Parameters
----------
values : (m, ...) array_like
    One row for every element, tetrahedra before hexahedra.

Returns
-------
(n, ...) ndarray
    NaN at nodes that belong to no element.
)")
      .def_property_readonly(
          "reactions", &support_forces,
          "(n, 3) ndarray: forces of the supports on fixed nodes and along fixed axes (N), which "
          "balance elements, membranes, gravity, external forces, contacts, joints and actuators; "
          "zero "
          "elsewhere.");
}

}  // namespace sinew::python
