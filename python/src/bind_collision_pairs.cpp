// Binds queries of two triangle surfaces, or one with itself: near pairs, crossings, interiors,
// overlap, impacts.
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/collision/overlap_volume.hpp"
#include "sinew/collision/penetration.hpp"
#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_impacts.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "collision_surface.hpp"
#include "columns.hpp"

namespace sinew::python {

namespace {

using collision::FeatureKind;
using collision::ProximityPair;
using collision::SurfaceImpact;
using collision::SurfacePoint;

const char* kind_name(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::vertex:
      return "vertex";
    case FeatureKind::edge:
      return "edge";
    case FeatureKind::face:
      return "face";
  }
  return "";
}

template <typename Entry, typename Get>
std::vector<std::string> kinds(const std::vector<Entry>& list, Get get) {
  std::vector<std::string> names;
  for (const Entry& entry : list) names.emplace_back(kind_name(get(entry)));
  return names;
}

double to_length(const py::object& value, const char* place) {
  const double length = to_number(value, place, "m");
  if (length >= 0.0) return length;
  throw Error(ErrorKind::out_of_range, {.item = place}, fmt::format("it is {:g} m", length),
              "give zero or more");
}

// Calls find(pool, copy) without the GIL.
template <typename Entry, typename Find>
std::vector<Entry> list_of(int threads, Find find) {
  const py::gil_scoped_release others;
  ThreadPool pool(threads);
  std::vector<Entry> list;
  find(pool, [&](std::span<const Entry> found) { list.assign(found.begin(), found.end()); });
  return list;
}

py::array_t<int> crossing(const CollisionSurface& first, const SharedSurface& second, int threads) {
  using Pair = collision::TrianglePair;
  const auto pairs = list_of<Pair>(threads, [&](ThreadPool& pool, const auto& take) {
    collision::Penetration finder(pool);
    take(second ? finder.crossing(first.tree, second->tree) : finder.crossing_within(first.tree));
  });
  return rows<int, 2>(pairs, [](const Pair& pair) { return std::array{pair.first, pair.second}; });
}

/// Array of one side of all pairs.
struct ProximityPoints {
  std::vector<std::string> kinds;
  py::array_t<int> nodes;
  Array weights, points;
};

struct ProximityPairs {
  Array distances, normals;
  ProximityPoints first, second;
};

ProximityPoints points_of(const std::vector<ProximityPair>& pairs,
                          SurfacePoint ProximityPair::*side) {
  return {kinds(pairs, [=](const ProximityPair& pair) { return (pair.*side).kind; }),
          rows<NodeId, 3>(pairs, [=](const ProximityPair& pair) { return (pair.*side).nodes; }),
          vectors(pairs, [=](const ProximityPair& pair) { return (pair.*side).weights; }),
          vectors(pairs, [=](const ProximityPair& pair) { return (pair.*side).point; })};
}

ProximityPairs proximity(const CollisionSurface& first, const SharedSurface& second,
                         const py::object& distance, double slack, bool facing, int threads) {
  const collision::ProximitySettings settings{
      .distance = to_length(distance, "proximity(distance)"), .slack = slack, .facing = facing};
  if (!(slack >= 0.0 && slack <= 1.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "proximity(slack)"},
                fmt::format("the sine of an angle is {:g}", slack), "give a number from 0 to 1");
  }
  const auto pairs = list_of<ProximityPair>(threads, [&](ThreadPool& pool, const auto& take) {
    collision::Proximity finder(pool);
    take(second ? finder.between(first.tree, second->tree, settings)
                : finder.within(first.tree, settings));
  });
  return {numbers<double>(pairs, [](const ProximityPair& pair) { return pair.distance; }),
          vectors(pairs, [](const ProximityPair& pair) { return pair.normal; }),
          points_of(pairs, &ProximityPair::first), points_of(pairs, &ProximityPair::second)};
}

struct InsideVertices {
  py::array_t<int> nodes, triangles;
  Array depths, normals, points;
};

InsideVertices penetration(const CollisionSurface& first, const CollisionSurface& second,
                           int threads) {
  using Vertex = collision::InsideVertex;
  const auto inside = list_of<Vertex>(threads, [&](ThreadPool& pool, const auto& take) {
    collision::Penetration finder(pool);
    take(finder.inside(first.tree, second.tree));
  });
  return {numbers<int>(inside, [](const Vertex& at) { return at.node; }),
          numbers<int>(inside, [](const Vertex& at) { return at.nearest.triangle; }),
          numbers<double>(inside, [](const Vertex& at) { return at.depth; }),
          vectors(inside, [](const Vertex& at) { return at.normal; }),
          vectors(inside, [](const Vertex& at) { return at.nearest.point; })};
}

struct Overlap {
  double volume;
  Points first_gradient, second_gradient;
};

Overlap overlap(const CollisionSurface& first, const CollisionSurface& second, int threads) {
  const py::gil_scoped_release others;
  ThreadPool pool(threads);
  collision::OverlapVolume both(first.topology, second.topology, pool);
  both.compute(first.tree.positions(), second.tree.positions());
  return {both.volume(), both.first_gradient(), both.second_gradient()};
}

struct SurfaceImpacts {
  std::vector<std::string> first_kinds, second_kinds;
  py::array_t<int> first, second;
  Array times;
};

SurfaceImpacts impacts(const CollisionSurface& first, const SharedSurface& second,
                       const py::object& separation, int threads) {
  const double apart = to_length(separation, "impacts(separation)");
  const auto found = list_of<SurfaceImpact>(threads, [&](ThreadPool& pool, const auto& take) {
    collision::SurfaceImpacts finder(pool);
    take(second ? finder.between(first.tree, second->tree, apart)
                : finder.within(first.tree, apart));
  });
  return {kinds(found, [](const SurfaceImpact& at) { return at.first_kind; }),
          kinds(found, [](const SurfaceImpact& at) { return at.second_kind; }),
          numbers<int>(found, [](const SurfaceImpact& at) { return at.first; }),
          numbers<int>(found, [](const SurfaceImpact& at) { return at.second; }),
          numbers<double>(found, [](const SurfaceImpact& at) { return at.time; })};
}

template <typename Type>
void bind_side(Type& type, const std::string& side, ProximityPoints ProximityPairs::*of) {
  const auto bind = [&](const char* what, auto member, const std::string& text) {
    type.def_property_readonly((side + "_" + what).c_str(),
                               [=](const ProximityPairs& self) { return (self.*of).*member; },
                               text.c_str());
  };
  bind("kinds", &ProximityPoints::kinds, "list of str: 'vertex', 'edge' or 'face'.");
  bind("nodes", &ProximityPoints::nodes,
       "(k, 3) ndarray of int: the nodes that carry the " + side + " point; -1: no further one.");
  bind("weights", &ProximityPoints::weights, "(k, 3) ndarray: of these nodes, sum 1.");
  bind("points", &ProximityPoints::points, "(k, 3) ndarray: on the " + side + " surface (m).");
}

void bind_results(py::module_& module) {
  py::class_<ProximityPairs> near(module, "ProximityPairs", "Result of proximity().");
  near.def_readonly("distances", &ProximityPairs::distances, "(k,) ndarray: m.")
      .def_readonly("normals", &ProximityPairs::normals,
                    "(k, 3) ndarray: unit vectors from the second point to the first.");
  bind_side(near, "first", &ProximityPairs::first);
  bind_side(near, "second", &ProximityPairs::second);
  py::class_<InsideVertices>(module, "InsideVertices", "Result of penetration().")
      .def_readonly("nodes", &InsideVertices::nodes,
                    "(k,) ndarray of int: vertices of the first surface.")
      .def_readonly("depths", &InsideVertices::depths,
                    "(k,) ndarray: their depths below the second surface (m), >= 0.")
      .def_readonly("normals", &InsideVertices::normals,
                    "(k, 3) ndarray: unit vectors along the shortest way out.")
      .def_readonly("points", &InsideVertices::points,
                    "(k, 3) ndarray: end points of this way (m).")
      .def_readonly(
          "triangles", &InsideVertices::triangles,
          "(k,) ndarray of int: triangles of the second surface that contain these points.");
  py::class_<Overlap>(module, "Overlap", "Result of overlap().")
      .def_readonly("volume", &Overlap::volume, "float: m^3.")
      .def_property_readonly(
          "first_gradient", [](const Overlap& self) { return reading(self.first_gradient); },
          "(n, 3) ndarray: its derivative with respect to the first surface's nodes (m^2).")
      .def_property_readonly(
          "second_gradient", [](const Overlap& self) { return reading(self.second_gradient); },
          "(n, 3) ndarray: its derivative with respect to the second surface's nodes (m^2).");
  py::class_<SurfaceImpacts>(module, "SurfaceImpacts", "Result of impacts().")
      .def_readonly("first_kinds", &SurfaceImpacts::first_kinds,
                    "list of str: 'vertex', 'edge' or 'face'.")
      .def_readonly("second_kinds", &SurfaceImpacts::second_kinds, "list of str: likewise.")
      .def_readonly(
          "first", &SurfaceImpacts::first,
          "(k,) ndarray of int: node, row of edges or of triangles, of the first surface.")
      .def_readonly("second", &SurfaceImpacts::second,
                    "(k,) ndarray of int: likewise, of the second surface.")
      .def_readonly(
          "times", &SurfaceImpacts::times,
          "(k,) ndarray: lower bound of the time at which each pair first meets, 0 to 1.");
}

void bind_static_pairs(py::module_& module) {
  module.def("crossing", &crossing, py::arg("first"), py::arg("second") = py::none(), py::kw_only(),
             py::arg("threads") = 1, R"(crossing(first, second=None, *, threads=1)
--

Pairs of triangles with a common point. Exact; touching counts.

Parameters
----------
first, second : Surface
    Without a second surface, the first with itself; triangles that share a node are not paired.
threads : int
    The result does not depend on it.

Returns
-------
(k, 2) ndarray of int
    Triangles of the first and the second surface.
)");
  module.def("proximity", &proximity, py::arg("first"), py::arg("second") = py::none(),
             py::kw_only(), py::arg("distance"), py::arg("slack") = 0.0, py::arg("facing") = true,
             py::arg("threads") = 1,
             R"(proximity(first, second=None, *, distance, slack=0.0, facing=True, threads=1)
--

All local minima of the distance between two surfaces, or of a surface from itself, up to a distance.

Parameters
----------
first, second : Surface
    Without a second surface, the first with itself; features that share a node are not paired.
distance : float
    Largest distance of a pair (m), >= 0.
slack : float
    Sine of the angle by which a neighbour of the nearest point may be closer: 0, only local minima;
    1, every vertex over a face or an edge and all crossing edges.
facing : bool
    Only points that see each other from outside, by the normals of their features.
threads : int
    The result does not depend on it.

Returns
-------
ProximityPairs
)");
  module.def("penetration", &penetration, py::arg("first"), py::arg("second"), py::kw_only(),
             py::arg("threads") = 1, R"(penetration(first, second, *, threads=1)
--

Vertices of one surface inside another one, with their depths. Inside and outside are exact.

Parameters
----------
first : Surface
second : Surface
    Closed.
threads : int
    The result does not depend on it.

Returns
-------
InsideVertices

Raises
------
Error
    surface-not-closed.
)");
  module.def("overlap", &overlap, py::arg("first"), py::arg("second"), py::kw_only(),
             py::arg("threads") = 1, R"(overlap(first, second, *, threads=1)
--

Volume of the intersection of two closed surfaces, and its derivative with respect to all nodes.

Parameters
----------
first, second : Surface
threads : int
    The result does not depend on it.

Returns
-------
Overlap

Raises
------
Error
    surface-not-closed.
)");
}

}  // namespace

void bind_collision_pairs(py::module_& module) {
  bind_results(module);
  bind_static_pairs(module);
  module.def("impacts", &impacts, py::arg("first"), py::arg("second") = py::none(), py::kw_only(),
             py::arg("separation") = 0.0, py::arg("threads") = 1,
             R"(impacts(first, second=None, *, separation=0.0, threads=1)
--

Vertices and faces, and pairs of edges, that meet during a motion. None is missed in spite of rounding: if there
are none and the surfaces do not cross at the start, they never do.

Parameters
----------
first, second : Surface
    From swept(); other surfaces are at rest. Without a second surface, the first with itself; features
    that share a node are not paired.
separation : float
    Distance that counts as a meeting (m), >= 0.
threads : int
    The result does not depend on it.

Returns
-------
SurfaceImpacts
)");
}

}  // namespace sinew::python
