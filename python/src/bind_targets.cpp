#include <utility>

#include <fmt/format.h>

#include "sinew/control/target.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

using control::Target;

// The Python classes of targets; each is a Target.
struct Circle : Target {};
struct Polyline : Target {};
struct Trajectory : Target {};

void bind_base(py::module_& module) {
  py::class_<Target>(module, "Target",
                     "Target of an effector over time: Circle, Polyline or Trajectory. "
                     "Immutable.")
      .def(
          "at", [](const Target& self, double time) { return copy(self.at(time)); },
          py::arg("time"),
          R"(at($self, time)
--

Target value at a time.

Parameters
----------
time : float
    s.

Returns
-------
(3,) ndarray
    m; for an orientation effector the rotation vector, rad.
)")
      .def_property_readonly(
          "end_time", &Target::end_time,
          "float: end of the first cycle (s): one turn of a circle, or the end of a path.")
      .def("__repr__", [](const py::object& self) {
        return fmt::format("<sinew.{}, ends at {:g} s>",
                           std::string(py::str(py::type::of(self).attr("__name__"))),
                           self.cast<const Target&>().end_time());
      });
}

void bind_circle(py::module_& module) {
  py::class_<Circle, Target>(module, "Circle",
                             R"(Circle(centre, radius, *, period, normal=(0, 0, 1), start_angle=0.0)
--

A circle at constant speed, counter-clockwise about `normal`.

Angles count from the projection of the world's x axis onto the plane of the circle (of the y axis if x is
within 25 degrees of the normal).

Parameters
----------
centre : (3,) array_like
    m.
radius : float
    m, > 0.
period : float
    Time of one turn, s, > 0.
normal : (3,) array_like
    Any non-zero length.
start_angle : float
    rad.
)")
      .def(py::init([](const py::object& centre, const py::object& radius, const py::object& period,
                       const py::object& normal, const py::object& start_angle) {
             control::Circle circle;
             circle.centre = to_vector3(centre, "Circle(centre)", "m");
             circle.radius = to_number(radius, "Circle(radius)", "m");
             circle.period = to_number(period, "Circle(period)", "s");
             circle.normal = to_vector3(normal, "Circle(normal)", "m");
             circle.start_angle = to_number(start_angle, "Circle(start_angle)", "rad");
             return Circle{at_argument("Circle", [&] { return Target::circle(circle); })};
           }),
           py::arg("centre"), py::arg("radius"), py::kw_only(), py::arg("period"),
           py::arg("normal") = py::make_tuple(0.0, 0.0, 1.0), py::arg("start_angle") = 0.0);
}

void bind_paths(py::module_& module) {
  py::class_<Polyline, Target>(module, "Polyline", R"(Polyline(points, *, period, closed=False)
--

Straight lines through points at constant speed.

Parameters
----------
points : (n, 3) array_like
    m, n >= 2.
period : float
    Time for the whole path once, s, > 0.
closed : bool
    Whether to return to the first point and repeat; an open path holds its end.
)")
      .def(py::init([](const py::object& points, const py::object& period, bool closed) {
             return Polyline{at_argument("Polyline", [&] {
               return Target::polyline({to_points(points, "Polyline(points)", "m"),
                                        to_number(period, "Polyline(period)", "s"), closed});
             })};
           }),
           py::arg("points"), py::kw_only(), py::arg("period"), py::arg("closed") = false);
  py::class_<Trajectory, Target>(module, "Trajectory", R"(Trajectory(times, positions)
--

Linear interpolation between samples; constant before the first and after the last one.

Parameters
----------
times : (n,) array_like
    s, increasing, >= 0.
positions : (n, 3) array_like
    m.
)")
      .def(py::init([](const py::object& times, const py::object& positions) {
             return Trajectory{at_argument("Trajectory", [&] {
               return Target::trajectory(to_list(times, "Trajectory(times)", "s"),
                                         to_points(positions, "Trajectory(positions)", "m"));
             })};
           }),
           py::arg("times"), py::arg("positions"));
}

}  // namespace

control::Target to_target(const py::handle& value, const std::string& place) {
  if (py::isinstance<Target>(value)) return value.cast<const Target&>();
  return Target::fixed(to_vector3(value, place, "m"));
}

void bind_targets(py::module_& module) {
  bind_base(module);
  bind_circle(module);
  bind_paths(module);
}

}  // namespace sinew::python
