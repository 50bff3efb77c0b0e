// Binds the parser of quantities, as in scenes.
#include <array>

#include <fmt/format.h>

#include "sinew/core/heading.hpp"
#include "sinew/core/quantity.hpp"

#include "bindings.hpp"

namespace sinew::python {

namespace {

constexpr std::array kDimensions = {
    dimension::kNone,         dimension::kLength,      dimension::kArea,
    dimension::kVolume,       dimension::kMass,        dimension::kTime,
    dimension::kFrequency,    dimension::kVelocity,    dimension::kAcceleration,
    dimension::kForce,        dimension::kPressure,    dimension::kEnergy,
    dimension::kPower,        dimension::kDensity,     dimension::kStiffness,
    dimension::kDamping,      dimension::kViscosity,   dimension::kVolumeRate,
    dimension::kPressureRate, dimension::kConductance, dimension::kTemperature,
    dimension::kHeatCapacity, dimension::kHeatLoss};

// Parses a quantity of any dimension that scenes use.
py::tuple quantity(const std::string& text) {
  for (const Dimension& one : kDimensions) {
    try {
      const double value = parse_quantity(text, one, {.item = text});
      return py::make_tuple(value, py::make_tuple(one.length, one.mass, one.time, one.temperature));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::wrong_dimension) throw;
    }
  }
  throw Error(ErrorKind::wrong_dimension, {.item = text}, "no key of a scene has this unit",
              "give a unit of the key, such as 'kPa' for a modulus");
}

}  // namespace

void bind_quantity(py::module_& module) {
  module.def(
      "_heading",
      [](const std::string& text) {
        const Heading heading = parse_heading(text);
        return py::make_tuple(heading.name, heading.unit);
      },
      py::arg("text"), R"(_heading(text)
--

Name and unit of the heading of a table, 'x [mm]' or 'x (mm)': ('x', 'mm'); None without a unit.
)");
  module.def("_quantity", &quantity, py::arg("text"),
             R"(_quantity(text)
--

Converts a quantity such as '300 kPa' to SI, with the exponents of its dimension: (300000.0, (-1, 1, -2, 0))
for length, mass, time and temperature. A bare number is SI and has none.

Raises
------
Error
    not-a-number, not-finite, unknown-unit, wrong-length; wrong-dimension if no key of a scene has
    such a dimension.
)");
}

}  // namespace sinew::python
