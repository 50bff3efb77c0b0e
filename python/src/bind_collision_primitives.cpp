// Binds batches of small queries: nearest points, rigid shapes, exact intersection, impacts.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/collision/closest_points.hpp"
#include "sinew/collision/impact.hpp"
#include "sinew/collision/shape.hpp"
#include "sinew/collision/triangle_intersection.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "columns.hpp"

namespace sinew::python {

namespace {

/// An array (n, count, 3) in the memory of the caller.
class PointGroups {
 public:
  /// @param value array from Python. @param place argument name. @param count points per query.
  PointGroups(const py::object& value, const std::string& place, py::ssize_t count)
      : count_(count) {
    const std::string wanted = fmt::format("(n, {}, 3) m", count);
    array_ = to_array(value, place, wanted);
    if (array_.ndim() == 3 && array_.shape(1) == count && array_.shape(2) == 3) return;
    throw Error(ErrorKind::wrong_shape, {.item = place}, "the array has another shape",
                "give an array of shape " + wanted);
  }
  std::size_t size() const { return static_cast<std::size_t>(array_.shape(0)); }
  Vector3 at(std::size_t query, py::ssize_t point) const {
    const auto row = static_cast<py::ssize_t>(query) * count_ + point;
    return Eigen::Map<const Vector3>(array_.data() + 3 * row);
  }

 private:
  py::ssize_t count_;
  Array array_;
};

void check_same_length(std::size_t first, std::size_t second, const char* item) {
  if (first == second) return;
  throw Error(ErrorKind::wrong_shape, {.item = item},
              fmt::format("the arguments have {} and {} entries", first, second),
              "give as many of each");
}

// Runs each query without the GIL.
template <typename Result, typename Query>
std::vector<Result> answers(std::size_t count, Query query) {
  const py::gil_scoped_release others;
  std::vector<Result> list(count);
  for (std::size_t k = 0; k < count; ++k) list[k] = query(k);
  return list;
}

py::tuple closest_on_triangles(const py::object& points, const py::object& triangles) {
  using collision::OnTriangle;
  const Points from = to_points(points, "closest_on_triangles(points)", "m");
  const PointGroups corners(triangles, "closest_on_triangles(triangles)", 3);
  check_same_length(static_cast<std::size_t>(from.rows()), corners.size(),
                    "closest_on_triangles()");
  const auto found = answers<OnTriangle>(corners.size(), [&](std::size_t k) {
    return collision::closest_on_triangle(from.row(static_cast<Eigen::Index>(k)).transpose(),
                                          corners.at(k, 0), corners.at(k, 1), corners.at(k, 2));
  });
  return py::make_tuple(vectors(found, [](const OnTriangle& on) { return on.point; }),
                        vectors(found, [](const OnTriangle& on) { return on.weights; }));
}

py::tuple closest_on_edges(const py::object& first, const py::object& second) {
  using collision::OnEdges;
  const PointGroups a(first, "closest_on_edges(first)", 2);
  const PointGroups b(second, "closest_on_edges(second)", 2);
  check_same_length(a.size(), b.size(), "closest_on_edges()");
  const auto found = answers<OnEdges>(a.size(), [&](std::size_t k) {
    return collision::closest_on_edges(a.at(k, 0), a.at(k, 1), b.at(k, 0), b.at(k, 1));
  });
  const auto shares = [](const OnEdges& on) { return std::array{on.first, on.second}; };
  return py::make_tuple(vectors(found, [](const OnEdges& on) { return on.first_point; }),
                        vectors(found, [](const OnEdges& on) { return on.second_point; }),
                        rows<double, 2>(found, shares));
}

py::array_t<bool> triangles_meet(const py::object& first, const py::object& second) {
  const PointGroups a(first, "triangles_meet(first)", 3);
  const PointGroups b(second, "triangles_meet(second)", 3);
  check_same_length(a.size(), b.size(), "triangles_meet()");
  const auto corners = [](const PointGroups& of, std::size_t k) {
    return collision::Corners{of.at(k, 0), of.at(k, 1), of.at(k, 2)};
  };
  const auto found = answers<char>(a.size(), [&](std::size_t k) {
    return static_cast<char>(collision::triangles_meet(corners(a, k), corners(b, k)));
  });
  return numbers<bool>(found, [](char meet) { return meet != 0; });
}

using ImpactQuery = std::optional<double> (*)(const collision::FourPoints&,
                                              const collision::FourPoints&, double);

py::tuple impact_times(const py::object& queries, const py::object& separation,
                       const std::string& name, ImpactQuery query) {
  const PointGroups points(queries, name + "(queries)", 8);
  const double apart = to_number(separation, name + "(separation)", "m");
  if (apart < 0.0) {
    throw Error(ErrorKind::out_of_range, {.item = name + "(separation)"},
                fmt::format("it is {:g} m", apart), "give zero or more");
  }
  const auto times = answers<double>(points.size(), [&](std::size_t k) {
    collision::FourPoints start, end;
    for (py::ssize_t i = 0; i < 4; ++i) {
      start[static_cast<std::size_t>(i)] = points.at(k, i);
      end[static_cast<std::size_t>(i)] = points.at(k, 4 + i);
    }
    return query(start, end, apart).value_or(kInfinity);
  });
  return py::make_tuple(numbers<bool>(times, [](double time) { return time < kInfinity; }),
                        numbers<double>(times, [](double time) { return time; }));
}

/// Wraps a variant, which pybind11 would otherwise convert to one of its types.
struct RigidShape {
  collision::Shape shape;
};

py::tuple distance(const RigidShape& self, const py::object& points) {
  using collision::ShapeDistance;
  const Points from = to_points(points, "distance(points)", "m");
  const auto found =
      answers<ShapeDistance>(static_cast<std::size_t>(from.rows()), [&](std::size_t k) {
        return collision::distance(self.shape, from.row(static_cast<Eigen::Index>(k)).transpose());
      });
  return py::make_tuple(numbers<double>(found, [](const ShapeDistance& at) { return at.gap; }),
                        vectors(found, [](const ShapeDistance& at) { return at.nearest; }),
                        vectors(found, [](const ShapeDistance& at) { return at.normal; }));
}

Matrix3 to_axes(const py::object& value) {
  const MatrixX axes = to_matrix(value, "box(axes)", "(3, 3)");
  if (axes.rows() != 3 || axes.cols() != 3) {
    throw Error(ErrorKind::wrong_shape, {.item = "box(axes)"}, "the array has another shape",
                "give an array of shape (3, 3)");
  }
  return axes;
}

template <typename Kind>
RigidShape make_shape(const Kind& kind) {
  return {collision::checked(kind)};
}

void bind_round_shapes(py::class_<RigidShape>& type) {
  type.def_static(
          "plane",
          [](const py::object& point, const py::object& normal) {
            return make_shape(collision::Plane{to_vector3(point, "plane(point)", "m"),
                                               to_vector3(normal, "plane(normal)", "")});
          },
          py::arg("point"), py::arg("normal"),
          "plane(point, normal)\n"
          "--\n"
          "\n"
          "A solid half space; the normal points out of it.")
      .def_static(
          "sphere",
          [](const py::object& centre, double radius) {
            return make_shape(collision::Sphere{to_vector3(centre, "sphere(centre)", "m"), radius});
          },
          py::arg("centre"), py::arg("radius"), "sphere(centre, radius)\n--\n\nA solid ball (m).")
      .def_static(
          "capsule",
          [](const py::object& start, const py::object& end, double radius) {
            return make_shape(collision::Capsule{to_vector3(start, "capsule(start)", "m"),
                                                 to_vector3(end, "capsule(end)", "m"), radius});
          },
          py::arg("start"), py::arg("end"), py::arg("radius"),
          "capsule(start, end, radius)\n--\n\nAll points within a radius of a segment (m).");
}

void bind_angular_shapes(py::class_<RigidShape>& type) {
  type.def_static(
          "cylinder",
          [](const py::object& start, const py::object& end, double radius) {
            return make_shape(collision::Cylinder{to_vector3(start, "cylinder(start)", "m"),
                                                  to_vector3(end, "cylinder(end)", "m"), radius});
          },
          py::arg("start"), py::arg("end"), py::arg("radius"),
          "cylinder(start, end, radius)\n--\n\nA solid cylinder with flat ends (m).")
      .def_static(
          "box",
          [](const py::object& centre, const py::object& half_size, const py::object& axes) {
            const Matrix3 turn = axes.is_none() ? Matrix3::Identity() : to_axes(axes);
            return make_shape(collision::OrientedBox{to_vector3(centre, "box(centre)", "m"), turn,
                                                     to_vector3(half_size, "box(half_size)", "m")});
          },
          py::arg("centre"), py::arg("half_size"), py::arg("axes") = py::none(),
          "box(centre, half_size, axes=None)\n--\n\nA solid box (m). The columns of axes (3, 3) "
          "are "
          "the directions of its sides; by default those of the world.");
}

void bind_shape(py::module_& module) {
  py::class_<RigidShape> type(
      module, "Shape",
      "A rigid shape in closed form, created by one of the functions below. They raise Error "
      "(out-of-range) for sizes that are not positive.");
  bind_round_shapes(type);
  bind_angular_shapes(type);
  type.def("distance", &distance, py::arg("points"), R"(distance($self, points)
--

Distances of points from the shape: points = nearest + gap normal.

Parameters
----------
points : (n, 3) array_like
    m.

Returns
-------
gap : (n,) ndarray
    Signed distance (m), negative inside.
nearest : (n, 3) ndarray
    Nearest point on the surface (m); one of them if there are several.
normal : (n, 3) ndarray
    Unit vector out of the shape: the gradient of the gap.
)");
}

void bind_closest(py::module_& module) {
  module.def("closest_on_triangles", &closest_on_triangles, py::arg("points"), py::arg("triangles"),
             R"(closest_on_triangles(points, triangles)
--

Nearest point of each triangle to a given point. Flat triangles count as their edges.

Parameters
----------
points : (n, 3) array_like
    m.
triangles : (n, 3, 3) array_like
    Corners (m).

Returns
-------
nearest : (n, 3) ndarray
    m.
weights : (n, 3) ndarray
    Weights of the corners, >= 0, sum 1.
)");
  module.def("closest_on_edges", &closest_on_edges, py::arg("first"), py::arg("second"),
             R"(closest_on_edges(first, second)
--

Nearest points of pairs of edges. For parallel edges, which have many, one end is returned.

Parameters
----------
first, second : (n, 2, 3) array_like
    Ends (m).

Returns
-------
first_points, second_points : (n, 3) ndarray
    m.
shares : (n, 2) ndarray
    Fractions, 0 to 1, along the first and the second edge.
)");
  module.def("triangles_meet", &triangles_meet, py::arg("first"), py::arg("second"),
             R"(triangles_meet(first, second)
--

Whether pairs of triangles have a common point. Exact; touching counts.

Parameters
----------
first, second : (n, 3, 3) array_like
    Corners (m). Coordinates should be zero or between 1e-90 and 1e90 in magnitude.

Returns
-------
(n,) ndarray of bool
)");
}

void bind_impacts(py::module_& module) {
  const std::string text = R"(

All points move on straight lines while time runs from 0 to 1. The answer is conservative: a query without a hit
stays farther apart than the separation, in spite of rounding; touching counts.

Parameters
----------
queries : (n, 8, 3) array_like
    {} at the start, then the same at the end (m).
separation : float
    Distance that counts as a meeting (m), >= 0.

Returns
-------
hit : (n,) ndarray of bool
time : (n,) ndarray
    Lower bound of the time of the first meeting; inf if there is none.
)";
  const auto bind = [&](const std::string& name, const std::string& what, const char* points,
                        ImpactQuery query) {
    const std::string doc =
        name + "(queries, separation=0.0)\n--\n\n" + what + fmt::format(fmt::runtime(text), points);
    module.def(
        name.c_str(),
        [name, query](const py::object& queries, const py::object& separation) {
          return impact_times(queries, separation, name, query);
        },
        py::arg("queries"), py::arg("separation") = 0.0, doc.c_str());
  };
  bind("vertex_face_impacts", "When vertices meet triangles.",
       "The vertex and the triangle's three corners", collision::vertex_face_impact);
  bind("edge_edge_impacts", "When edges meet edges.", "Both ends of one edge and of the other",
       collision::edge_edge_impact);
}

}  // namespace

void bind_collision_primitives(py::module_& module) {
  bind_closest(module);
  bind_impacts(module);
  bind_shape(module);
}

}  // namespace sinew::python
