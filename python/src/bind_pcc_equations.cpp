// Binds sizes, positions and equations of motion of constant-curvature arms.
#include <utility>

#include <fmt/format.h>

#include "sinew/pcc/arm.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"

namespace sinew::python {

namespace {

void bind_sizes(PccArmClass& arm) {
  arm.def_property_readonly(
         "segments", [](const PccArm& self) { return self.arm->segments(); }, "int.")
      .def_property_readonly(
          "coordinates", [](const PccArm& self) { return self.arm->coordinates(); },
          "int: number of coordinates.")
      .def_property_readonly(
          "length", [](const PccArm& self) { return self.arm->length(); },
          "float: length of the straight arm, m.")
      .def_property_readonly(
          "stiffness", [](const PccArm& self) { return reading(self.arm->stiffness()); },
          "(coordinates,) N m; N/m for an extension.")
      .def_property_readonly(
          "damping", [](const PccArm& self) { return reading(self.arm->damping()); },
          "(coordinates,) N m s; N s/m for an extension.");
}

void bind_dynamics(PccArmClass& arm) {
  arm.def(
         "acceleration",
         [](PccArm& self, const py::object& theta, const py::object& rate,
            const py::object& torque) {
           return copy(self.equations.acceleration(
               self.angles(theta, "acceleration(theta)", "rad"),
               self.angles(rate, "acceleration(theta_dot)", "rad/s"),
               to_vector(torque, "acceleration(torque)", self.arm->inputs(), "N m")));
         },
         py::arg("theta"), py::arg("theta_dot"), py::arg("torque"),
         R"(acceleration($self, theta, theta_dot, torque)
--

Forward dynamics.

Parameters
----------
theta, theta_dot : (coordinates,) rad, rad/s
torque : (inputs,) N m

Returns
-------
(coordinates,) rad/s^2)")
      .def(
          "inverse_dynamics",
          [](PccArm& self, const py::object& theta, const py::object& rate,
             const py::object& acceleration) {
            return copy(self.equations.residual(
                self.angles(theta, "inverse_dynamics(theta)", "rad"),
                self.angles(rate, "inverse_dynamics(theta_dot)", "rad/s"),
                self.angles(acceleration, "inverse_dynamics(theta_ddot)", "rad/s^2")));
          },
          py::arg("theta"), py::arg("theta_dot"), py::arg("theta_ddot"),
          R"(inverse_dynamics($self, theta, theta_dot, theta_ddot)
--

(coordinates,) N m: H theta_ddot + C theta_dot + G + b theta_dot, the required value of B torque.)");
}

void bind_matrices(PccArmClass& arm) {
  arm.def(
         "mass_matrix",
         [](PccArm& self, const py::object& theta) {
           return copy(self.equations.mass_matrix(self.angles(theta, "mass_matrix(theta)", "rad")));
         },
         py::arg("theta"), R"(mass_matrix($self, theta)
--

H (coordinates, coordinates), kg m^2.)")
      .def(
          "coriolis_matrix",
          [](PccArm& self, const py::object& theta, const py::object& rate) {
            return copy(self.equations.coriolis_matrix(
                self.angles(theta, "coriolis_matrix(theta)", "rad"),
                self.angles(rate, "coriolis_matrix(theta_dot)", "rad/s")));
          },
          py::arg("theta"), py::arg("theta_dot"), R"(coriolis_matrix($self, theta, theta_dot)
--

C (coordinates, coordinates) from Christoffel symbols, N m s: dH/dt - 2C is skew-symmetric.)");
}

void bind_derivatives(PccArmClass& arm) {
  arm.def(
      "linearise",
      [](PccArm& self, const py::object& theta, const py::object& rate, const py::object& torque) {
        const auto& forward = self.equations.forward_derivatives(
            self.angles(theta, "linearise(theta)", "rad"),
            self.angles(rate, "linearise(theta_dot)", "rad/s"),
            to_vector(torque, "linearise(torque)", self.arm->inputs(), "N m"));
        return py::make_tuple(copy(forward.acceleration), copy(forward.by_position),
                              copy(forward.by_rate), copy(forward.by_torque));
      },
      py::arg("theta"), py::arg("theta_dot"), py::arg("torque"),
      R"(linearise($self, theta, theta_dot, torque)
--

Forward dynamics with exact derivatives.

Returns
-------
tuple
    Acceleration (n,) rad/s^2, and its derivatives with respect to theta (n, n), theta_dot (n, n) and torque
    (n, inputs).)");
}

void bind_points(PccArmClass& arm) {
  arm.def(
         "endpoints",
         [](PccArm& self, const py::object& theta) {
           return copy(self.equations.endpoints(self.angles(theta, "endpoints(theta)", "rad")));
         },
         py::arg("theta"), R"(endpoints($self, theta)
--

(N, 3) m: ends of the segments.)")
      .def(
          "point",
          [](PccArm& self, const py::object& theta, int segment, double fraction,
             const std::pair<double, double>& offset) {
            const VectorX q = self.angles(theta, "point(theta)", "rad");
            return copy(Vector3(
                self.equations.point(self.place(segment, fraction, offset), q, 0.0 * q).position));
          },
          py::arg("theta"), py::arg("segment"), py::arg("fraction") = 1.0, py::kw_only(),
          py::arg("offset") = std::pair(0.0, 0.0),
          R"(point($self, theta, segment, fraction=1.0, *, offset=(0.0, 0.0))
--

Position of a point of the arm.

Parameters
----------
theta : (coordinates,) rad
segment, fraction : int, float
    Index of the segment, and fraction of its arc length, 0 to 1.
offset : (2,) m
    Offset from the axis, in the section.

Returns
-------
(3,) m)");
}

void bind_jacobian(PccArmClass& arm) {
  arm.def(
      "jacobian",
      [](PccArm& self, const py::object& theta, int segment, double fraction,
         const std::pair<double, double>& offset) {
        const VectorX q = self.angles(theta, "jacobian(theta)", "rad");
        return copy(MatrixX(
            self.equations.point(self.place(segment, fraction, offset), q, 0.0 * q).jacobian));
      },
      py::arg("theta"), py::arg("segment"), py::arg("fraction") = 1.0, py::kw_only(),
      py::arg("offset") = std::pair(0.0, 0.0),
      R"(jacobian($self, theta, segment, fraction=1.0, *, offset=(0.0, 0.0))
--

(3, coordinates) m: derivative of point() with respect to theta.)");
}

void bind_energies(PccArmClass& arm) {
  arm.def(
         "energy",
         [](PccArm& self, const py::object& theta, const py::object& rate) {
           return self.equations
               .energy(self.angles(theta, "energy(theta)", "rad"),
                       self.angles(rate, "energy(theta_dot)", "rad/s"))
               .total();
         },
         py::arg("theta"), py::arg("theta_dot"), R"(energy($self, theta, theta_dot)
--

float: sum of kinetic, strain and gravity energy (relative to the height of the base), J.)")
      .def(
          "energies",
          [](PccArm& self, const py::object& theta, const py::object& rate) {
            const auto energy =
                self.equations.energy(self.angles(theta, "energies(theta)", "rad"),
                                      self.angles(rate, "energies(theta_dot)", "rad/s"));
            py::dict result;
            result["kinetic"] = energy.kinetic;
            result["strain"] = energy.strain;
            result["gravity"] = energy.gravity;
            return result;
          },
          py::arg("theta"), py::arg("theta_dot"), R"(energies($self, theta, theta_dot)
--

dict: "kinetic", "strain" and "gravity", J.)");
}

}  // namespace

pcc::ArmPoint PccArm::place(int segment, double fraction,
                            const std::pair<double, double>& offset) const {
  if (segment < 0 || segment >= arm->segments()) {
    throw Error(ErrorKind::out_of_range, {.item = "segment"},
                fmt::format("there is no segment {}", segment),
                fmt::format("give 0 to {}", arm->segments() - 1));
  }
  if (!(fraction >= 0.0 && fraction <= 1.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "fraction"},
                fmt::format("{:g} is not on the segment", fraction), "give 0 to 1");
  }
  return {segment, fraction, offset.first, offset.second, 0.0};
}

void bind_arm_equations(PccArmClass& arm) {
  bind_sizes(arm);
  bind_dynamics(arm);
  bind_matrices(arm);
  bind_derivatives(arm);
  bind_points(arm);
  bind_jacobian(arm);
  bind_energies(arm);
}

}  // namespace sinew::python
