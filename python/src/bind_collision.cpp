// Binds triangle surfaces and queries of points.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/collision/penetration.hpp"
#include "sinew/collision/point_query.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "collision_surface.hpp"
#include "columns.hpp"

namespace sinew::python {

namespace {

std::vector<collision::Triangle> to_triangles(const py::object& value) {
  py::array any = py::array::ensure(value);
  if (!any) PyErr_Clear();
  const char kind = any ? any.dtype().kind() : 'O';
  if (kind != 'i' && kind != 'u') {
    throw Error(ErrorKind::wrong_type, {.item = "Surface(triangles)"}, "these are not node numbers",
                "give an integer array of shape (m, 3)");
  }
  if (any.ndim() != 2 || any.shape(1) != 3) {
    throw Error(ErrorKind::wrong_shape, {.item = "Surface(triangles)"},
                "triangles have three nodes each", "give an array of shape (m, 3)");
  }
  using Numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
  const Numbers numbers = Numbers::ensure(any);
  std::vector<collision::Triangle> triangles(static_cast<std::size_t>(any.shape(0)));
  const std::int64_t* from = numbers.data();
  for (collision::Triangle& triangle : triangles) {
    for (NodeId& node : triangle) {
      const std::int64_t number = *from++;
      const bool fits = number == static_cast<NodeId>(number);
      node = fits ? static_cast<NodeId>(number) : -1;  // invalid, hence rejected later
    }
  }
  return triangles;
}

SharedSurface make_surface(const py::object& points, const py::object& triangles) {
  const Points nodes = to_points(points, "Surface(points)", "m");
  auto list = to_triangles(triangles);
  const py::gil_scoped_release others;
  const auto topology = std::make_shared<const collision::SurfaceTopology>(
      std::move(list), static_cast<int>(nodes.rows()));
  CollisionSurface surface{topology, collision::SurfaceTree(topology)};
  ThreadPool pool;
  surface.tree.move(nodes, pool);
  return std::make_shared<CollisionSurface>(std::move(surface));
}

SharedSurface moved(const CollisionSurface& self, const py::object& points) {
  const Points nodes = to_points(points, "moved(points)", "m", self.topology->node_count());
  const py::gil_scoped_release others;
  CollisionSurface surface(self);
  ThreadPool pool;
  surface.tree.move(nodes, pool);
  return std::make_shared<CollisionSurface>(std::move(surface));
}

SharedSurface swept(const CollisionSurface& self, const py::object& end) {
  const Points nodes = to_points(end, "swept(end)", "m", self.topology->node_count());
  const py::gil_scoped_release others;
  CollisionSurface surface(self);
  ThreadPool pool;
  surface.tree.sweep(self.tree.positions(), nodes, pool);
  return std::make_shared<CollisionSurface>(std::move(surface));
}

struct NearestPoints {
  Array distances, points, weights;
  py::array_t<int> triangles;
};

NearestPoints nearest(const CollisionSurface& self, const py::object& points,
                      const py::object& reach) {
  const double farthest = reach.is_none() ? kInfinity : to_number(reach, "nearest(reach)", "m");
  using Found = collision::NearestOnSurface;
  const Points from = to_points(points, "nearest(points)", "m");
  std::vector<Found> found(static_cast<std::size_t>(from.rows()));
  {
    const py::gil_scoped_release others;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Vector3 point = from.row(static_cast<Eigen::Index>(k)).transpose();
      found[k] = collision::nearest_on_surface(self.tree, point, farthest);
    }
  }
  return {numbers<double>(found, [](const Found& at) { return at.distance; }),
          vectors(found, [](const Found& at) { return at.point; }),
          vectors(found, [](const Found& at) { return at.weights; }),
          numbers<int>(found, [](const Found& at) { return at.triangle; })};
}

py::array_t<int> winding_numbers(const CollisionSurface& self, const py::object& points) {
  const Points at = to_points(points, "winding_numbers(points)", "m");
  std::vector<int> found(static_cast<std::size_t>(at.rows()));
  {
    const py::gil_scoped_release others;
    collision::require_closed(*self.topology, "winding_numbers()");
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Vector3 point = at.row(static_cast<Eigen::Index>(k)).transpose();
      found[k] = collision::winding_number(self.tree, point);
    }
  }
  return numbers<int>(found, [](int count) { return count; });
}

using SurfaceType = py::class_<CollisionSurface, SharedSurface>;

void bind_arrays(SurfaceType& type) {
  const auto self_of = [](const py::object& self) -> const CollisionSurface& {
    return self.cast<const CollisionSurface&>();
  };
  type.def_property_readonly(
          "points",
          [=](const py::object& self) {
            const Points& points = self_of(self).tree.positions();
            return view(points.data(), points.rows(), 3, self);
          },
          "(n, 3) ndarray, read-only: nodes (m); for a swept surface, their start.")
      .def_property_readonly(
          "end_points",
          [=](const py::object& self) {
            const Points& points = self_of(self).tree.end_positions();
            return view(points.data(), points.rows(), 3, self);
          },
          "(n, 3) ndarray, read-only: end of a swept surface (m); otherwise `points`.")
      .def_property_readonly(
          "triangles",
          [=](const py::object& self) {
            const auto& all = self_of(self).topology->triangles();
            return view(all.front().data(), static_cast<py::ssize_t>(all.size()), 3, self);
          },
          "(m, 3) ndarray of int, read-only: counter-clockwise seen from outside.")
      .def_property_readonly(
          "edges",
          [=](const py::object& self) {
            const auto& all = self_of(self).topology->edges();
            return view(all.front().data(), static_cast<py::ssize_t>(all.size()), 2, self);
          },
          "(e, 2) ndarray of int, read-only: the nodes of each edge, ascending.")
      .def_property_readonly(
          "closed", [](const CollisionSurface& self) { return self.topology->closed(); },
          "bool: whether every edge belongs to two triangles that traverse it in opposite "
          "directions.");
}

void bind_moves(SurfaceType& type) {
  type.def("moved", &moved, py::arg("points"), R"(moved($self, points)
--

The surface with its nodes at other positions. Cheaper than creating a new one.

Parameters
----------
points : (n, 3) array_like
    m.

Returns
-------
Surface
)")
      .def("swept", &swept, py::arg("end"), R"(swept($self, end)
--

The surface in motion: every node moves on a straight line from `points` to `end` while time runs from 0 to 1.
For impacts().

Parameters
----------
end : (n, 3) array_like
    m.

Returns
-------
Surface
)");
}

void bind_queries(SurfaceType& type) {
  type.def("nearest", &nearest, py::arg("points"), py::arg("reach") = py::none(),
           R"(nearest($self, points, reach=None)
--

Nearest point of the surface for each of the given points.

Parameters
----------
points : (k, 3) array_like
    m.
reach : float, optional
    Search distance (m). Beyond it, the distance is inf and the triangle -1.

Returns
-------
NearestPoints
)")
      .def("winding_numbers", &winding_numbers, py::arg("points"),
           R"(winding_numbers($self, points)
--

Winding numbers of a closed surface around points: 0 outside, 1 inside, more where it overlaps itself.
Exact.

Parameters
----------
points : (k, 3) array_like
    m.

Returns
-------
(k,) ndarray of int

Raises
------
Error
    surface-not-closed.
)");
}

}  // namespace

void bind_collision(py::module_& module) {
  SurfaceType type(module, "Surface", R"(Surface(points, triangles)
--

A triangle surface with a tree of bounding boxes. Immutable: threads may share it.

Parameters
----------
points : (n, 3) array_like
    m.
triangles : (m, 3) array_like of int
    Nodes, counter-clockwise seen from outside.

Raises
------
Error
    wrong-shape, not-finite, wrong-type, empty-region (no triangle), index-out-of-range,
    repeated-node-in-element.
)");
  type.def(py::init(&make_surface), py::arg("points"), py::arg("triangles"));
  bind_arrays(type);
  bind_moves(type);
  bind_queries(type);
  type.def("__repr__", [](const CollisionSurface& self) {
    return fmt::format("<sinew.collision.Surface: {} triangles, {} nodes, {}>",
                       self.topology->triangles().size(), self.topology->node_count(),
                       self.topology->closed() ? "closed" : "open");
  });
  py::class_<NearestPoints>(module, "NearestPoints", "Result of Surface.nearest().")
      .def_readonly("distances", &NearestPoints::distances, "(k,) ndarray: m.")
      .def_readonly("points", &NearestPoints::points,
                    "(k, 3) ndarray: nearest points on the surface (m).")
      .def_readonly(
          "triangles", &NearestPoints::triangles,
          "(k,) ndarray of int: triangle of the point, the lowest index if several are equally "
          "near; -1: none within reach.")
      .def_readonly("weights", &NearestPoints::weights,
                    "(k, 3) ndarray: weights of the triangle's corners, >= 0, sum 1.");
  bind_collision_pairs(module);
  bind_collision_primitives(module);
}

}  // namespace sinew::python
