// Binds the drives of an arm: fluidic actuators, drive cylinders, excitation.
#include <fmt/format.h>

#include "sinew/core/types.hpp"
#include "sinew/pcc/drive_cylinder.hpp"
#include "sinew/pcc/excitation.hpp"
#include "sinew/pcc/fluidic_actuator.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using pcc::DriveCylinder;
using pcc::Excitation;
using pcc::FluidicActuator;

template <typename F>
Array each(const py::object& values, const std::string& place, const std::string& unit,
           const F& function) {
  const Array given = to_array(values, place, "any shape, " + unit);
  Array result(std::vector<py::ssize_t>(given.shape(), given.shape() + given.ndim()));
  for (py::ssize_t i = 0; i < given.size(); ++i) {
    result.mutable_data()[i] = function(given.data()[i]);
  }
  return result;
}

Eigen::Vector2d to_pair(const py::object& value, const std::string& place) {
  return to_vector(value, place, 2, "");
}

DriveCylinder make_cylinder(const py::object& a, const py::object& b, const py::object& c, double d,
                            double sample_time, std::pair<double, double> input_limits,
                            std::pair<double, double> volume_limits) {
  DriveCylinder cylinder;
  const MatrixX matrix = to_matrix(a, "DriveCylinder(a)", "(2, 2)");
  if (matrix.rows() != 2 || matrix.cols() != 2) {
    throw Error(ErrorKind::wrong_shape, {.item = "DriveCylinder(a)"},
                fmt::format("its shape is ({}, {})", matrix.rows(), matrix.cols()), "give (2, 2)");
  }
  cylinder.a = matrix;
  cylinder.b = to_pair(b, "DriveCylinder(b)");
  cylinder.c = to_pair(c, "DriveCylinder(c)").transpose();
  cylinder.d = d;
  cylinder.sample_time = sample_time;
  std::tie(cylinder.lowest_input, cylinder.highest_input) = input_limits;
  std::tie(cylinder.lowest_volume, cylinder.highest_volume) = volume_limits;
  cylinder.check();
  return cylinder;
}

}  // namespace

void bind_drive(py::module_& module) {
  py::class_<FluidicActuator>(module, "FluidicActuator",
                              R"(FluidicActuator(cubic, *, linear=0.0, delay=0.0)

Torque of a fluidic elastomer actuator, ``tau(t) = a V(t - delay) + c V(t - delay)**3``.

Parameters
----------
cubic, linear : float
    c, N m/m^9, and a, N m/m^3; not negative, not both zero.
delay : float
    Delay of the line, s.

Raises
------
Error
    out-of-range, not-finite.)")
      .def(py::init([](double cubic, double linear, double delay) {
             const FluidicActuator actuator{linear, cubic, delay};
             actuator.check();
             return actuator;
           }),
           py::arg("cubic"), py::kw_only(), py::arg("linear") = 0.0, py::arg("delay") = 0.0)
      .def_readonly("cubic", &FluidicActuator::cubic, "float: c, N m/m^9.")
      .def_readonly("linear", &FluidicActuator::linear, "float: a, N m/m^3.")
      .def_readonly("delay", &FluidicActuator::delay, "float: s.")
      .def(
          "torque",
          [](const FluidicActuator& self, const py::object& volume) {
            return each(volume, "torque(volume)", "m^3", [&](double v) { return self.torque(v); });
          },
          py::arg("volume"), R"(torque($self, volume)
--

Torques (N m) of volumes (m^3), in the same shape, without the delay.)")
      .def(
          "volume",
          [](const FluidicActuator& self, const py::object& torque) {
            return each(torque, "volume(torque)", "N m", [&](double t) { return self.volume(t); });
          },
          py::arg("torque"), R"(volume($self, torque)
--

Volumes (m^3) of torques (N m), in the same shape: the inverse of torque().)")
      .def("__repr__", [](const FluidicActuator& self) {
        return fmt::format("<sinew.pcc.FluidicActuator, {:.4g} N m/m^3, {:.4g} N m/m^9, {:.4g} s>",
                           self.linear, self.cubic, self.delay);
      });

  py::class_<DriveCylinder>(module, "DriveCylinder",
                            R"(DriveCylinder(a, b, c, d=0.0, *, sample_time, ...)

A fluid drive cylinder, a discrete system with two states from its command u to its volume y:
``x[k+1] = A x[k] + B u[k]``, ``y[k] = C x[k] + D u[k]``.

Parameters
----------
a, b, c : (2, 2), (2,), (2,)
d : float
sample_time : float
    s.
input_limits, volume_limits : (lowest, highest)
    Limits of the command and of the volume.

Raises
------
Error
    out-of-range (unstable, or a sample time that is not positive), contradictory-limits.)")
      .def(py::init(&make_cylinder), py::arg("a"), py::arg("b"), py::arg("c"), py::arg("d") = 0.0,
           py::kw_only(), py::arg("sample_time"),
           py::arg("input_limits") = std::pair(-kInfinity, kInfinity),
           py::arg("volume_limits") = std::pair(-kInfinity, kInfinity))
      .def_property_readonly(
          "a", [](const DriveCylinder& self) { return reading(MatrixX(self.a)); }, "(2, 2).")
      .def_property_readonly(
          "b", [](const DriveCylinder& self) { return reading(VectorX(self.b)); }, "(2,).")
      .def_property_readonly(
          "c", [](const DriveCylinder& self) { return reading(VectorX(self.c.transpose())); },
          "(2,).")
      .def_readonly("d", &DriveCylinder::d, "float.")
      .def_readonly("sample_time", &DriveCylinder::sample_time, "float: s.")
      .def_property_readonly(
          "input_limits",
          [](const DriveCylinder& self) {
            return std::pair(self.lowest_input, self.highest_input);
          },
          "(lowest, highest) limits of the command.")
      .def_property_readonly(
          "volume_limits",
          [](const DriveCylinder& self) {
            return std::pair(self.lowest_volume, self.highest_volume);
          },
          "(lowest, highest), m^3.")
      .def_property_readonly("gain", &DriveCylinder::gain,
                             "float: static gain, volume per command.")
      .def(
          "simulate",
          [](const DriveCylinder& self, const py::object& command, const py::object& start) {
            const auto list = to_list(command, "simulate(command)", "");
            return copy(self.simulate(
                Eigen::Map<const VectorX>(list.data(), static_cast<Eigen::Index>(list.size())),
                to_pair(start, "simulate(start)")));
          },
          py::arg("command"), py::arg("start") = py::make_tuple(0.0, 0.0),
          R"(simulate($self, command, start=(0.0, 0.0))
--

Volumes (samples,) for commands (samples,), within the limits, from an initial state (2,).)");

  module.def("second_order_cylinder", &DriveCylinder::second_order, py::arg("gain"),
             py::arg("frequency"), py::arg("damping"), py::arg("sample_time"),
             R"(second_order_cylinder(gain, frequency, damping, sample_time)
--

The DriveCylinder ``gain w^2/(s^2 + 2 damping w s + w^2)``, with its command held between samples.

Parameters
----------
gain : float
    Static gain, volume per command.
frequency : float
    w, rad/s.
damping : float
    Damping ratio, not negative.
sample_time : float
    s.)");

  py::class_<Excitation>(
      module, "Excitation",
      R"(Excitation(amplitude, *, peak_frequency=1.0, band=(0.4, 4.0), sines=40, seed=1)

A sum of sines with random frequencies and phases and the energies of Bretschneider's spectrum
``S(w) = (1.25/4) (w_p^4/w^5) zeta^2 exp(-1.25 (w_p/w)^4)``, ``zeta = 2 amplitude``. The same seed
gives the same signal on every machine.

Parameters
----------
amplitude : float
    V_max; the standard deviation of the signal is about half of it.
peak_frequency : float
    Hz.
band : (lowest, highest)
    Hz.
sines : int
seed : int

Raises
------
Error
    out-of-range.)")
      .def(py::init([](double amplitude, double peak, std::pair<double, double> band, int sines,
                       std::uint64_t seed) {
             return Excitation({peak, amplitude, band.first, band.second, sines, seed});
           }),
           py::arg("amplitude"), py::kw_only(), py::arg("peak_frequency") = 1.0,
           py::arg("band") = std::pair(0.4, 4.0), py::arg("sines") = 40, py::arg("seed") = 1)
      .def(
          "at",
          [](const Excitation& self, const py::object& time) {
            return each(time, "at(time)", "s", [&](double t) { return self.at(t); });
          },
          py::arg("time"), R"(at($self, time)
--

The signal at times (s), in the same shape.)");
}

}  // namespace sinew::python
