// Bending actuators with a single angle, without a scene.
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "sinew/pcc/bending_motion.hpp"

#include "arrays.hpp"
#include "bending.hpp"
#include "bindings.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

using pcc::BendingActuator;
using pcc::BendingModulus;
using pcc::BendingParameters;
using Shared = std::shared_ptr<BendingActuator>;

pcc::MassLine to_mass_line(const std::string& name) {
  if (name == "layer") return pcc::MassLine::layer;
  if (name == "section") return pcc::MassLine::section;
  throw Error(ErrorKind::unknown_choice, {.item = "mass_line"},
              fmt::format("there is no '{}'", name), "use 'layer' or 'section'");
}

BendingModulus to_modulus(const py::object& value) {
  if (py::isinstance<BendingModulus>(value)) return value.cast<BendingModulus>();
  return BendingModulus(to_number(value, "modulus", "Pa"));
}

Shared make_actuator(double length, double chamber_radius, double wall_thickness,
                     const py::object& modulus, std::optional<double> outer_radius,
                     double silicone_density, double filling_density, double surroundings_density,
                     double inclination, double gravity, double mass_damping,
                     double stiffness_damping, std::optional<int> order,
                     const std::string& mass_line) {
  return at_argument("BendingActuator()", [&] {
    return std::make_shared<BendingActuator>(
        BendingParameters{.length = length,
                          .chamber_radius = chamber_radius,
                          .wall_thickness = wall_thickness,
                          .outer_radius = outer_radius,
                          .modulus = to_modulus(modulus),
                          .silicone_density = silicone_density,
                          .filling_density = filling_density,
                          .surroundings_density = surroundings_density,
                          .inclination = inclination,
                          .gravity = gravity,
                          .mass_damping = mass_damping,
                          .stiffness_damping = stiffness_damping,
                          .order = order,
                          .mass_line = to_mass_line(mass_line)});
  });
}

py::dict parameters(const BendingActuator& self) {
  const BendingParameters& p = self.parameters();
  py::dict result;
  result["length"] = p.length;
  result["chamber_radius"] = p.chamber_radius;
  result["wall_thickness"] = p.wall_thickness;
  result["modulus"] = p.modulus;
  result["outer_radius"] = p.outer();
  result["silicone_density"] = p.silicone_density;
  result["filling_density"] = p.filling_density;
  result["surroundings_density"] = p.surroundings_density;
  result["inclination"] = p.inclination;
  result["gravity"] = p.gravity;
  result["mass_damping"] = p.mass_damping;
  result["stiffness_damping"] = p.stiffness_damping;
  result["order"] = p.order;
  result["mass_line"] = p.mass_line == pcc::MassLine::layer ? "layer" : "section";
  return result;
}

void bind_constants(BendingActuatorClass& type) {
  type.def_property_readonly(
          "parameters", &parameters,
          "dict: constructor arguments; BendingActuator(**parameters) is an equal actuator.")
      .def_property_readonly("mass", &BendingActuator::mass,
                             "float: mass of silicone and filling at rest, kg.")
      .def_property_readonly("net_weight", &BendingActuator::net_weight,
                             "float: weight minus buoyancy at rest, N; negative if it floats.")
      .def_property_readonly(
          "second_moment", &BendingActuator::second_moment,
          "float: second moment of area of the wall's section about the inextensible layer, m^4.")
      .def_property_readonly("moment_per_pressure", &BendingActuator::moment_per_pressure,
                             "float: volume per angle of the chamber, pi r^2 (r + r_t), m^3.")
      .def_property_readonly(
          "angle_range",
          [](const BendingActuator& self) {
            return py::make_tuple(self.energies().lowest_angle(), self.energies().highest_angle());
          },
          "tuple of float: range of angles in which the model is valid, rad.");
}

constexpr const char* kActuatorDoc =
    R"(BendingActuator(length, chamber_radius, wall_thickness, modulus, *, outer_radius=None, silicone_density=1070.0, filling_density=1.2, surroundings_density=1.2, inclination=0.0, gravity=9.81, mass_damping=0.0, stiffness_damping=0.0, order=5, mass_line='layer')
--

A fibre-reinforced silicone tube with an inextensible layer, bent by pressure, with a single angle.
docs/bending_actuator.md has the equations. Immutable; threads may share it.

Parameters
----------
length : float
    Length of the layer, m.
chamber_radius, wall_thickness : float
    r, and r_t between chamber and layer, m.
modulus : float or BendingModulus
    A number is the shear modulus, Pa.
outer_radius : float, optional
    r_o, m, at least r + r_t (the default).
silicone_density, filling_density, surroundings_density : float
    kg/m^3; 1.2 is air, 1000 water.
inclination : float
    Inclination of the base, rad: 0 hangs, pi/2 is level and bends upwards, pi stands.
gravity : float
    m/s^2.
mass_damping, stiffness_damping : float
    Rayleigh's alpha (1/s) and beta (s).
order : int or None
    Order of the energies in theta, 2 to 20; None: exact, by quadrature.
mass_line : {'layer', 'section'}
    Whether the mass is concentrated on the layer, as published, or distributed over the section.

Raises
------
Error
    out-of-range or not-finite, naming the parameter.
)";

void bind_actuator_type(py::module_& module) {
  BendingActuatorClass type(module, "BendingActuator", kActuatorDoc);
  type.def(py::init(&make_actuator), py::arg("length"), py::arg("chamber_radius"),
           py::arg("wall_thickness"), py::arg("modulus"), py::kw_only(),
           py::arg("outer_radius") = py::none(), py::arg("silicone_density") = 1070.0,
           py::arg("filling_density") = 1.2, py::arg("surroundings_density") = 1.2,
           py::arg("inclination") = 0.0, py::arg("gravity") = 9.81, py::arg("mass_damping") = 0.0,
           py::arg("stiffness_damping") = 0.0, py::arg("order") = 5,
           py::arg("mass_line") = "layer");
  bind_constants(type);
  bind_bending_model(type);
  bind_bending_history(type);
  type.def("__repr__", [](const BendingActuator& self) {
    const BendingParameters& p = self.parameters();
    return fmt::format("<sinew.pcc.BendingActuator, {:.4g} mm, {}>", 1e3 * p.length,
                       p.order ? fmt::format("order {}", *p.order) : "exact");
  });
}

}  // namespace

void bind_bending(py::module_& module) {
  bind_bending_modulus(module);
  bind_actuator_type(module);
  bind_bending_motion(module);
}

}  // namespace sinew::python
