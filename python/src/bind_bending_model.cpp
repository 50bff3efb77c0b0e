// Binds the equations of a bending actuator.
#include "sinew/pcc/bending_motion.hpp"

#include "arrays.hpp"
#include "bending.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using pcc::BendingActuator;

py::object energies(const BendingActuator& self, const py::object& theta, const py::object& rate,
                    const py::object& pressure) {
  py::dict result;
  const auto part = [&](const char* name, double pcc::BendingEnergy::*member) {
    result[name] =
        for_each<3>("energies()", {theta, rate, pressure},
                    [&](double q, double v, double p) { return self.energy(q, v, p).*member; });
  };
  part("strain", &pcc::BendingEnergy::strain);
  part("gravity", &pcc::BendingEnergy::gravity);
  part("kinetic", &pcc::BendingEnergy::kinetic);
  return result;
}

py::object point(const BendingActuator& self, const py::object& theta, const py::object& fraction) {
  const auto axis = [&](int k) {
    return for_each<2>("point()", {theta, fraction},
                       [&](double q, double u) { return self.point(q, u)[k]; });
  };
  return py::module_::import("numpy").attr("stack")(py::make_tuple(axis(0), axis(1)),
                                                    py::arg("axis") = -1);
}

py::dict taylor_error(const BendingActuator& self, double lowest, double highest, double pressure) {
  const pcc::BendingError error = self.taylor_error(lowest, highest, pressure);
  py::dict result;
  result["strain"] = error.strain;
  result["gravity"] = error.gravity;
  result["inertia"] = error.inertia;
  result["torque"] = error.torque;
  return result;
}

void bind_energies(BendingActuatorClass& type) {
  type.def(
          "energy",
          [](const BendingActuator& self, const py::object& theta, const py::object& rate,
             const py::object& pressure) {
            return for_each<3>(
                "energy()", {theta, rate, pressure},
                [&](double q, double v, double p) { return self.energy(q, v, p).total(); });
          },
          py::arg("theta"), py::arg("theta_dot"), py::arg("pressure"),
          R"(energy($self, theta, theta_dot, pressure)
--

Sum of strain, gravity and kinetic energy. Arguments broadcast.

Parameters
----------
theta, theta_dot, pressure : float or array_like
    rad, rad/s, Pa.

Returns
-------
float or ndarray
    J.
)")
      .def("energies", &energies, py::arg("theta"), py::arg("theta_dot"), py::arg("pressure"),
           R"(energies($self, theta, theta_dot, pressure)
--

The separate energies. Arguments broadcast.

Parameters
----------
theta, theta_dot, pressure : float or array_like
    rad, rad/s, Pa.

Returns
-------
dict
    'strain', 'gravity' (0 for a centre as high as the base) and 'kinetic', J.
)");
}

void bind_acceleration(BendingActuatorClass& type) {
  type.def(
      "acceleration",
      [](const BendingActuator& self, const py::object& theta, const py::object& rate,
         const py::object& pressure) {
        return for_each<3>(
            "acceleration()", {theta, rate, pressure},
            [&](double q, double v, double p) { return self.acceleration(q, v, p); });
      },
      py::arg("theta"), py::arg("theta_dot"), py::arg("pressure"),
      R"(acceleration($self, theta, theta_dot, pressure)
--

Second derivative of the angle. Arguments broadcast.

Parameters
----------
theta, theta_dot, pressure : float or array_like
    rad, rad/s, Pa.

Returns
-------
float or ndarray
    rad/s^2.
)");
}

void bind_stiffness(BendingActuatorClass& type) {
  type.def(
          "inertia",
          [](const BendingActuator& self, const py::object& theta) {
            return for_each<1>("inertia(theta)", {theta},
                               [&](double q) { return self.terms(q).inertia.value; });
          },
          py::arg("theta"), R"(inertia($self, theta)
--

Generalised inertia I in the kinetic energy I theta'^2/2.

Parameters
----------
theta : float or array_like
    rad.

Returns
-------
float or ndarray
    kg m^2.
)")
      .def(
          "stiffness",
          [](const BendingActuator& self, const py::object& theta, const py::object& pressure) {
            return for_each<2>("stiffness()", {theta, pressure},
                               [&](double q, double p) { return self.stiffness(q, p); });
          },
          py::arg("theta"), py::arg("pressure"), R"(stiffness($self, theta, pressure)
--

Second derivative of strain and gravity energy with respect to the angle. Arguments broadcast.

Parameters
----------
theta, pressure : float or array_like
    rad, Pa.

Returns
-------
float or ndarray
    N m/rad.
)");
}

void bind_equilibrium(BendingActuatorClass& type) {
  type.def(
      "equilibrium",
      [](const BendingActuator& self, const py::object& pressure, double start) {
        return for_each<1>("equilibrium(pressure)", {pressure},
                           [&](double p) { return self.equilibrium(p, start); });
      },
      py::arg("pressure"), py::arg("start") = 0.0, R"(equilibrium($self, pressure, start=0.0)
--

Stable equilibrium angle under a pressure.

Parameters
----------
pressure : float or array_like
    Pa.
start : float
    Initial guess of Newton's method, rad.

Returns
-------
float or ndarray
    rad.

Raises
------
RunError
    not-converged if there is none within a full turn.
)");
}

void bind_linear_angle(BendingActuatorClass& type) {
  type.def(
      "linear_angle",
      [](const BendingActuator& self, const py::object& pressure) {
        return for_each<1>("linear_angle(pressure)", {pressure},
                           [&](double p) { return self.linear_angle(p); });
      },
      py::arg("pressure"), R"(linear_angle($self, pressure)
--

Angle of linear theory, theta = M L/(E I) with E = 4 G, for small angles and without weight.

Parameters
----------
pressure : float or array_like
    Pa.

Returns
-------
float or ndarray
    rad.
)");
}

void bind_geometry(BendingActuatorClass& type) {
  type.def(
          "chamber_volume",
          [](const BendingActuator& self, const py::object& theta) {
            return for_each<1>("chamber_volume(theta)", {theta},
                               [&](double q) { return self.chamber_volume(q); });
          },
          py::arg("theta"), R"(chamber_volume($self, theta)
--

Volume of the chamber, pi r^2 (L + (r + r_t) theta).

Parameters
----------
theta : float or array_like
    rad.

Returns
-------
float or ndarray
    m^3.
)")
      .def("point", &point, py::arg("theta"), py::arg("fraction") = 1.0,
           R"(point($self, theta, fraction=1.0)
--

A point of the inextensible layer, by default the tip. Arguments broadcast.

Parameters
----------
theta : float or array_like
    rad.
fraction : float or array_like
    Fraction of the arc length, 0 to 1.

Returns
-------
(..., 2) ndarray
    Lateral coordinate x and height relative to the base, m. At the inclination 0 the straight actuator's tip is (0, -L).
)");
}

void bind_taylor_error(BendingActuatorClass& type) {
  type.def("taylor_error", &taylor_error, py::arg("lowest"), py::arg("highest"),
           py::arg("pressure"), R"(taylor_error($self, lowest, highest, pressure)
--

Bounds on the truncation error of the Taylor polynomials over a range of angles; zeros for an exact model.

Parameters
----------
lowest, highest : float
    rad.
pressure : float
    Pa, for the modulus.

Returns
-------
dict
    'strain' and 'gravity' energy, J; 'inertia', kg m^2; 'torque' of both energies, N m.
)");
}

}  // namespace

void bind_bending_model(BendingActuatorClass& type) {
  bind_energies(type);
  bind_acceleration(type);
  bind_stiffness(type);
  bind_equilibrium(type);
  bind_linear_angle(type);
  bind_geometry(type);
  bind_taylor_error(type);
}

}  // namespace sinew::python
