// Constant-curvature arms by themselves, without a scene.
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_simulation.hpp"
#include "sinew/pcc/published.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"

namespace sinew::python {

namespace {

using mechanics::Integrator;
using pcc::ArmEquations;

/// (n,) from an array of that length or one number for all.
VectorX spread(const py::handle& value, const std::string& place, Eigen::Index n,
               const std::string& unit) {
  const Array array = to_array(value, place, fmt::format("({},) {}", n, unit));
  if (array.ndim() == 0) return VectorX::Constant(n, array.data()[0]);
  return to_vector(value, place, n, unit);
}

template <typename T>
T choose(const std::string& word, const std::string& place,
         std::initializer_list<std::pair<const char*, T>> choices) {
  std::string names;
  for (const auto& [name, value] : choices) {
    if (word == name) return value;
    names += (names.empty() ? "'" : ", '") + std::string(name) + "'";
  }
  throw Error(ErrorKind::unknown_choice, {.item = place}, fmt::format("there is no '{}'", word),
              "use one of " + names);
}

Vector3 to_gravity(const py::handle& value) {
  const Array array = to_array(value, "Arm(gravity)", "a magnitude or (3,) m/s^2");
  if (array.ndim() == 0) return {0.0, 0.0, -array.data()[0]};
  return to_vector3(value, "Arm(gravity)", "m/s^2");
}

std::unique_ptr<PccArm> make_arm(const py::object& lengths, const py::object& masses,
                                 const py::object& stiffness, const py::object& damping,
                                 const std::string& centre, const py::object& gravity,
                                 const py::object& gamma, const py::object& dead_lengths,
                                 const std::string& bending, const py::object& axial_stiffness,
                                 const py::object& axial_damping, const py::object& base,
                                 const py::object& actuation, int mass_points) {
  using pcc::Bending;
  using pcc::MassCentre;
  const std::vector<double> length = to_list(lengths, "Arm(lengths)", "m");
  const auto n = static_cast<Eigen::Index>(length.size());
  pcc::ArmSettings settings;
  settings.centre = choose<MassCentre>(centre, "Arm(centre)",
                                       {{"arc", MassCentre::arc},
                                        {"chord", MassCentre::chord},
                                        {"distributed", MassCentre::distributed}});
  settings.gravity = to_gravity(gravity);
  settings.base = to_vector3(base, "Arm(base)", "m");
  settings.mass_points = mass_points;
  const Bending kind = choose<Bending>(
      bending, "Arm(bending)", {{"planar", Bending::planar}, {"spatial", Bending::spatial}});
  const VectorX m = to_vector(masses, "Arm(masses)", n, "kg");
  const VectorX k = spread(stiffness, "Arm(stiffness)", n, "N m");
  const VectorX b = spread(damping, "Arm(damping)", n, "N m s");
  const VectorX turn = spread(gamma, "Arm(gamma)", n, "rad");
  const VectorX dead = spread(dead_lengths, "Arm(dead_lengths)", n, "m");
  const bool extensible = !axial_stiffness.is_none();
  VectorX ka, ba;
  if (extensible) {
    ka = spread(axial_stiffness, "Arm(axial_stiffness)", n, "N/m");
    ba = spread(axial_damping, "Arm(axial_damping)", n, "N s/m");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    pcc::Segment& segment = settings.segments.emplace_back();
    segment.length = length[static_cast<std::size_t>(i)];
    segment.mass = m[i];
    segment.stiffness = k[i];
    segment.damping = b[i];
    segment.gamma = turn[i];
    segment.dead_length = dead[i];
    segment.bending = kind;
    segment.extensible = extensible;
    if (extensible) {
      segment.axial_stiffness = ka[i];
      segment.axial_damping = ba[i];
    }
  }
  if (!actuation.is_none()) settings.actuation = to_matrix(actuation, "Arm(actuation)", "");
  return std::make_unique<PccArm>(std::make_shared<const pcc::Arm>(std::move(settings)));
}

std::unique_ptr<PccArm> published(const py::object& lengths, const std::string& centre) {
  using pcc::MassCentre;
  const auto where = choose<MassCentre>(centre, "published_arm(centre)",
                                        {{"arc", MassCentre::arc},
                                         {"chord", MassCentre::chord},
                                         {"distributed", MassCentre::distributed}});
  VectorX length;
  if (!lengths.is_none()) length = to_vector(lengths, "published_arm(lengths)", 4, "m");
  return std::make_unique<PccArm>(
      std::make_shared<const pcc::Arm>(pcc::published_arm(where, length)));
}

py::tuple simulate(PccArm& self, const py::object& theta, const py::object& theta_dot,
                   const py::object& torque, double time_step, const std::string& integrator,
                   double spectral_radius) {
  const Eigen::Index n = self.arm->coordinates();
  pcc::ArmStepSettings settings;
  settings.time_step = time_step;
  settings.spectral_radius = spectral_radius;
  settings.integrator = choose<Integrator>(integrator, "simulate(integrator)",
                                           {{"backward-euler", Integrator::backward_euler},
                                            {"bdf2", Integrator::bdf2},
                                            {"generalized-alpha", Integrator::generalized_alpha}});
  const VectorX start = to_vector(theta, "simulate(theta)", n, "rad");
  const VectorX speed = to_vector(theta_dot, "simulate(theta_dot)", n, "rad/s");
  const MatrixX drive = to_matrix(torque, "simulate(torque)", "(steps, inputs) N m");
  if (drive.cols() != self.arm->inputs()) {
    throw Error(
        ErrorKind::wrong_shape, {.item = "simulate(torque)"},
        fmt::format("it has {} columns, the arm {} inputs", drive.cols(), self.arm->inputs()),
        "give an array (steps, inputs) N m");
  }
  MatrixX positions(drive.rows() + 1, n), rates(drive.rows() + 1, n);
  {
    const py::gil_scoped_release release;
    pcc::ArmSimulation simulation(self.arm, settings);
    simulation.set_state(start, speed);
    positions.row(0) = start.transpose();
    rates.row(0) = speed.transpose();
    VectorX input(drive.cols());
    for (Eigen::Index i = 0; i < drive.rows(); ++i) {
      input = drive.row(i).transpose();
      simulation.step(input);
      positions.row(i + 1) = simulation.position().transpose();
      rates.row(i + 1) = simulation.rate().transpose();
    }
  }
  return py::make_tuple(copy(positions), copy(rates));
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

void bind_pcc(py::module_& module) {
  py::class_<PccArm>(module, "Arm", R"(Arm(lengths, masses, stiffness, damping, *, ...)

A soft arm of N segments of constant curvature, hanging along -z at rest; a positive angle bends
towards +x. Coordinates are one angle a segment; with ``bending="spatial"`` two (u towards x, v
towards y), with `axial_stiffness` also the extension e in m.

Parameters
----------
lengths, masses : (N,) m, kg
stiffness, damping : (N,) or float
    N m and N m s: torque ``-k theta - b theta_dot``.
centre : str
    Where a segment's mass sits: "arc" (half-way along the axis), "chord" (half-way along the
    chord) or "distributed" (Gauss points along the axis).
gravity : float or (3,)
    m/s^2; a magnitude points along -z.
gamma : (N,) or float
    Turn about the axis before each segment, rad.
dead_lengths : (N,) or float
    Rigid length before each bend, m.
bending : str
    "planar" or "spatial".
axial_stiffness, axial_damping : (N,) or float
    N/m and N s/m; makes spatial segments extensible.
base : (3,) m
actuation : (coordinates, inputs), optional
    B of the generalised forces B tau; the identity when left out.
mass_points : int
    Gauss points a segment of distributed mass.

Raises
------
Error
    out-of-range, not-finite, wrong-shape, unknown-choice.)")
      .def(py::init(&make_arm), py::arg("lengths"), py::arg("masses"), py::arg("stiffness"),
           py::arg("damping"), py::kw_only(), py::arg("centre") = "arc", py::arg("gravity") = 9.81,
           py::arg("gamma") = 0.0, py::arg("dead_lengths") = 0.0, py::arg("bending") = "planar",
           py::arg("axial_stiffness") = py::none(), py::arg("axial_damping") = 0.0,
           py::arg("base") = py::make_tuple(0.0, 0.0, 0.0), py::arg("actuation") = py::none(),
           py::arg("mass_points") = 3)
      .def_property_readonly(
          "segments", [](const PccArm& self) { return self.arm->segments(); }, "int.")
      .def_property_readonly(
          "coordinates", [](const PccArm& self) { return self.arm->coordinates(); },
          "int: the length of theta.")
      .def_property_readonly(
          "length", [](const PccArm& self) { return self.arm->length(); },
          "float: of the straight arm, m.")
      .def_property_readonly(
          "stiffness", [](const PccArm& self) { return copy(self.arm->stiffness()); },
          "(coordinates,) N m; of an extension N/m.")
      .def_property_readonly(
          "damping", [](const PccArm& self) { return copy(self.arm->damping()); },
          "(coordinates,) N m s; of an extension N s/m.")
      .def(
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

(coordinates,) N m: H theta_ddot + C theta_dot + G + b theta_dot, what B torque must be.)")
      .def(
          "mass_matrix",
          [](PccArm& self, const py::object& theta) {
            return copy(
                self.equations.mass_matrix(self.angles(theta, "mass_matrix(theta)", "rad")));
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

C (coordinates, coordinates) of Christoffel's symbols, N m s: dH/dt - 2C is skew.)")
      .def(
          "endpoints",
          [](PccArm& self, const py::object& theta) {
            return copy(self.equations.endpoints(self.angles(theta, "endpoints(theta)", "rad")));
          },
          py::arg("theta"), R"(endpoints($self, theta)
--

(N, 3) m: where the segments end.)")
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

Where a point of the arm is.

Parameters
----------
theta : (coordinates,) rad
segment, fraction : int, float
    Which segment, and at what part of its arc, 0 to 1.
offset : (2,) m
    Aside from the axis, in the section.

Returns
-------
(3,) m)")
      .def(
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

(3, coordinates) m: derivative of point() by theta.)")
      .def(
          "energy",
          [](PccArm& self, const py::object& theta, const py::object& rate) {
            return self.equations
                .energy(self.angles(theta, "energy(theta)", "rad"),
                        self.angles(rate, "energy(theta_dot)", "rad/s"))
                .total();
          },
          py::arg("theta"), py::arg("theta_dot"), R"(energy($self, theta, theta_dot)
--

float: kinetic, strain and gravity's energy (against the base's height), J.)")
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

dict: "kinetic", "strain" and "gravity", J.)")
      .def(
          "linearise",
          [](PccArm& self, const py::object& theta, const py::object& rate,
             const py::object& torque) {
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

Forward dynamics with its exact derivatives.

Returns
-------
tuple
    Acceleration (n,) rad/s^2, and its derivatives by theta (n, n), theta_dot (n, n) and torque
    (n, inputs).)")
      .def(
          "equilibrium",
          [](PccArm& self, const py::object& torque, const py::object& start) {
            const VectorX from = start.is_none() ? VectorX(VectorX::Zero(self.arm->coordinates()))
                                                 : self.angles(start, "equilibrium(start)", "rad");
            return copy(pcc::find_equilibrium(
                            self.equations,
                            to_vector(torque, "equilibrium(torque)", self.arm->inputs(), "N m"),
                            from)
                            .position);
          },
          py::arg("torque"), py::arg("start") = py::none(),
          R"(equilibrium($self, torque, start=None)
--

(coordinates,) rad: the equilibrium that a descent from `start` (straight) ends in.

Raises
------
RunError
    not-converged.)")
      .def(
          "simulate", &simulate, py::arg("theta"), py::arg("theta_dot"), py::arg("torque"),
          py::kw_only(), py::arg("time_step") = 1e-3, py::arg("integrator") = "generalized-alpha",
          py::arg("spectral_radius") = 0.8,
          R"(simulate($self, theta, theta_dot, torque, *, time_step=0.001, integrator='generalized-alpha', spectral_radius=0.8)
--

Motion under given torques, by implicit steps; the GIL is released.

Parameters
----------
theta, theta_dot : (coordinates,) rad, rad/s
    The start.
torque : (steps, inputs) N m
    At the end of each step.
time_step : float
    s.
integrator : str
    "generalized-alpha", "bdf2" or "backward-euler".
spectral_radius : float
    Of generalized-alpha, 0 to 1.

Returns
-------
tuple of (steps + 1, coordinates)
    theta in rad and theta_dot in rad/s, the start included.

Raises
------
RunError
    not-converged, diverged.)");
  module.def("published_arm", &published, py::arg("lengths") = py::none(),
             py::arg("centre") = "arc",
             R"(published_arm(lengths=None, centre='arc')
--

The identified four-segment fluidic arm: masses, stiffness and damping as published; the lengths
(4,) m, which are not published, 0.14 each when left out. An Arm.)");
  module.def(
      "published_torque_limits", [] { return copy(pcc::published_torque_limits()); },
      R"(published_torque_limits()
--

(4,) N m, either way, of that arm; its first segment is not actuated.)");
  module.def(
      "channel_stiffness",
      [](double first, const py::object& lengths) {
        const std::vector<double> values = to_list(lengths, "channel_stiffness(lengths)", "m");
        return copy(pcc::channel_stiffness(
            first,
            Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()))));
      },
      py::arg("first"), py::arg("lengths"), R"(channel_stiffness(first, lengths)
--

(N,) N m: k_i = k_1 L_i / L_1, as published for fluidic segments of like channels.)");
  module.def(
      "beam_stiffness",
      [](double bending, const py::object& lengths) {
        const std::vector<double> values = to_list(lengths, "beam_stiffness(lengths)", "m");
        return copy(pcc::beam_stiffness(
            bending,
            Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()))));
      },
      py::arg("bending"), py::arg("lengths"), R"(beam_stiffness(bending, lengths)
--

(N,) N m: k_i = EI / L_i, with EI = `bending` in N m^2.)");
}

}  // namespace sinew::python
