// Pressure-dependent modulus of bending actuators.
#include <fmt/format.h>

#include "arrays.hpp"
#include "bending.hpp"
#include "bindings.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

using pcc::BendingModulus;

BendingModulus make_modulus(const py::object& coefficients, const std::string& kind,
                            const std::optional<std::pair<double, double>>& range,
                            const std::string& outside) {
  const char* place = "BendingModulus()";
  const Array given = to_array(coefficients, place, "a number or (n,)");
  return at_argument(place, [&] {
    if (given.ndim() == 0) return BendingModulus(given.data()[0], pcc::to_modulus_kind(kind));
    if (given.ndim() != 1 || !range) {
      throw Error(ErrorKind::missing_key, {.item = "pressure_range"},
                  "a polynomial holds for the pressures that it was fitted to",
                  "give pressure_range=(lowest, highest) in Pa, or one number for a constant");
    }
    return BendingModulus({given.data(), given.data() + given.size()}, pcc::to_modulus_kind(kind),
                          range->first, range->second, pcc::to_outside_range(outside));
  });
}

py::object pressure_range(const BendingModulus& self) {
  if (self.is_constant()) return py::none();
  return py::make_tuple(self.lowest_pressure(), self.highest_pressure());
}

}  // namespace

void bind_bending_modulus(py::module_& module) {
  py::class_<BendingModulus>(
      module, "BendingModulus",
      R"(BendingModulus(coefficients, *, kind='shear', pressure_range=None, outside='refuse')
--

Modulus of a bending actuator's silicone: a constant, or a polynomial in the pressure.

Parameters
----------
coefficients : float or (n,) array_like
    Pa, or Pa/Pa^k from k = 0 on.
kind : {'shear', 'young', 'bending'}
    Kind of modulus: G, the uniaxial E = 3 G, or E of theta = M L/(E I), which is 4 G because fibres keep the
    width.
pressure_range : tuple of float, optional
    Pressure range of the fit of a polynomial, Pa.
outside : {'refuse', 'hold'}
    Behaviour of a polynomial outside this range: an Error, or the value at the nearer end.

Raises
------
Error
    out-of-range if it is not positive within its range, missing-key for a polynomial without
    a range.
)")
      .def(py::init(&make_modulus), py::arg("coefficients"), py::kw_only(),
           py::arg("kind") = "shear", py::arg("pressure_range") = py::none(),
           py::arg("outside") = "refuse")
      .def(
          "value",
          [](const BendingModulus& self, const py::object& pressure) {
            return for_each<1>("value(pressure)", {pressure},
                               [&](double p) { return self.value(p); });
          },
          py::arg("pressure"), R"(value($self, pressure)
--

The modulus, of its own kind, at a pressure.

Parameters
----------
pressure : float or array_like
    Pa.

Returns
-------
float or ndarray
    Pa.
)")
      .def(
          "shear",
          [](const BendingModulus& self, const py::object& pressure) {
            return for_each<1>("shear(pressure)", {pressure},
                               [&](double p) { return self.shear(p); });
          },
          py::arg("pressure"), R"(shear($self, pressure)
--

The corresponding shear modulus.

Parameters
----------
pressure : float or array_like
    Pa.

Returns
-------
float or ndarray
    G, Pa.
)")
      .def_property_readonly(
          "kind",
          [](const BendingModulus& self) {
            return std::string(pcc::modulus_kind_name(self.kind()));
          },
          "str: 'shear', 'young' or 'bending'.")
      .def_property_readonly(
          "coefficients",
          [](const BendingModulus& self) {
            const std::vector<double>& c = self.coefficients();
            return Array(static_cast<py::ssize_t>(c.size()), c.data());
          },
          "(n,) ndarray: Pa/Pa^k from k = 0 on.")
      .def_property_readonly("pressure_range", &pressure_range,
                             "tuple or None: pressure range in which a polynomial is valid, Pa.")
      .def_property_readonly(
          "outside",
          [](const BendingModulus& self) {
            return std::string(pcc::outside_range_name(self.outside()));
          },
          "str: 'refuse' or 'hold'.")
      .def("__repr__", [](const BendingModulus& self) {
        if (self.is_constant()) {
          return fmt::format("<sinew.pcc.BendingModulus, {} {:.4g} Pa>",
                             pcc::modulus_kind_name(self.kind()), self.value(0.0));
        }
        return fmt::format("<sinew.pcc.BendingModulus, {} of degree {}, {:.4g} to {:.4g} Pa>",
                           pcc::modulus_kind_name(self.kind()), self.coefficients().size() - 1,
                           self.lowest_pressure(), self.highest_pressure());
      });
  module.def(
      "published_modulus",
      [](const std::string& outside) {
        return BendingModulus::published(pcc::to_outside_range(outside));
      },
      py::arg("outside") = "refuse", R"(published_modulus(outside='refuse')
--

Published fit to a water-driven silicone actuator, 10 to 110 kPa, of kind 'bending' and degree 5.

Parameters
----------
outside : {'refuse', 'hold'}
    Behaviour at other pressures.

Returns
-------
BendingModulus
)");
}

}  // namespace sinew::python
