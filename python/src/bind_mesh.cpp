#include <array>

#include <fmt/format.h>

#include "sinew/core/quantity.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/refine.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/write_mesh.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using mesh::Mesh;
using Shared = std::shared_ptr<Mesh>;

template <std::size_t Size>
py::array elements(const Shared& self, const std::vector<std::array<NodeId, Size>>& list) {
  return view<NodeId>(list.empty() ? nullptr : list.front().data(),
                      static_cast<py::ssize_t>(list.size()), static_cast<py::ssize_t>(Size),
                      py::cast(self));
}

Shared share(Mesh mesh) { return std::make_shared<Mesh>(std::move(mesh)); }

Shared read(const std::string& path, const py::object& unit, bool several) {
  mesh::ReadOptions options;
  options.allow_several_components = several;
  options.unit_given = !unit.is_none();
  if (py::isinstance<py::str>(unit)) {
    options.unit = parse_unit(unit.cast<std::string>(), dimension::kLength, {.item = "read(unit)"});
  } else if (options.unit_given) {
    options.unit = to_number(unit, "read(unit)", "m");
  }
  if (!(options.unit > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "read(unit)"},
                fmt::format("the unit is {:g} m", options.unit), "give 'mm', or 0.001");
  }
  const py::gil_scoped_release release;
  return share(mesh::read_mesh(path, options));
}

std::array<int, 3> to_cells(const py::handle& value) {
  const Array cells = to_array(value, "block(cells)", "(3,)");
  if (cells.ndim() != 1 || cells.size() != 3) {
    throw Error(ErrorKind::wrong_shape, {.item = "block(cells)"}, "it does not have three entries",
                "give three whole numbers, as (10, 2, 2)");
  }
  std::array<int, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double count = cells.at(static_cast<py::ssize_t>(i));
    if (count != std::floor(count) || count < 1.0 || count > 1e6) {
      throw Error(ErrorKind::out_of_range, {.item = "block(cells)"},
                  fmt::format("{:g} is not a number of cells", count), "give whole numbers from 1");
    }
    counts[i] = whole<int>(count);
  }
  return counts;
}

void bind_type(py::module_& module) {
  py::class_<Mesh, Shared>(module, "Mesh", "A volume mesh; lengths in m. Immutable.")
      .def_readonly("name", &Mesh::name, "str: the file or function that the mesh comes from.")
      .def_property_readonly(
          "nodes",
          [](const Shared& self) {
            return view(self->nodes.data(), self->nodes.rows(), 3, py::cast(self));
          },
          "(n, 3) ndarray: m, in the file's order. Read-only.")
      .def_property_readonly(
          "tetrahedra", [](const Shared& self) { return elements(self, self->tetrahedra); },
          "(m, 4) ndarray of int32: positively oriented. Read-only.")
      .def_property_readonly(
          "hexahedra", [](const Shared& self) { return elements(self, self->hexahedra); },
          "(m, 8) ndarray of int32: in VTK's order. Read-only.")
      .def_property_readonly(
          "triangles", [](const Shared& self) { return elements(self, self->triangles); },
          "(m, 3) ndarray of int32: surface triangles in the file. Read-only.")
      .def_readonly("node_sets", &Mesh::node_sets, "dict: named sets of nodes.")
      .def_property_readonly(
          "volume", [](const Mesh& self) { return mesh::volume(self); }, "float: m^3.")
      .def(
          "describe", [](const Mesh& self) { return mesh::format_report(mesh::describe(self)); },
          R"(describe($self)
--

Counts, size, volume, quality and sets as text.

Returns
-------
str
)")
      .def(
          "write",
          [](const Mesh& self, const std::filesystem::path& path) { mesh::write_mesh(path, self); },
          py::arg("path"),
          R"(write($self, path)
--

Writes the mesh in the format of the file extension, lengths in m.

Parameters
----------
path : path-like
    .vtu (VTK XML, compressed) or .vtk (VTK legacy, binary), both with the named sets; .stl: only the
    outer surface, as triangles.

Raises
------
Error
    unknown-format for other extensions, file-unwritable.
)")
      .def(
          "refined",
          [](const Mesh& self) {
            const py::gil_scoped_release release;
            return share(mesh::refine(self));
          },
          R"(refined($self)
--

Mesh in which every tetrahedron is split into eight. Nodes keep their numbers; the mid-edge nodes follow.

Returns
-------
Mesh
    With the same sets.

Raises
------
Error
    unsupported-element for hexahedra.
)")
      .def("__repr__", [](const Mesh& self) {
        return fmt::format("<sinew.mesh.Mesh '{}', {} nodes, {} elements>", self.name,
                           self.nodes.rows(), self.tetrahedra.size() + self.hexahedra.size());
      });
}

void bind_round_shapes(py::module_& module) {
  module.def(
      "mesh_cylinder",
      [](double radius, double height, int rings, int layers) {
        return share(mesh::cylinder({radius, height, rings, layers}));
      },
      py::kw_only(), py::arg("radius") = 0.01, py::arg("height") = 0.1, py::arg("rings") = 2,
      py::arg("layers") = 10,
      "mesh_cylinder(*, radius=0.01, height=0.1, rings=2, layers=10)\n--\n\n"
      "See sinew.mesh.cylinder().");
  module.def(
      "mesh_cone",
      [](double bottom_radius, double top_radius, double height, int rings, int layers) {
        return share(mesh::cone({bottom_radius, top_radius, height, rings, layers}));
      },
      py::kw_only(), py::arg("bottom_radius") = 0.02, py::arg("top_radius") = 0.01,
      py::arg("height") = 0.1, py::arg("rings") = 2, py::arg("layers") = 10,
      "mesh_cone(*, bottom_radius=0.02, top_radius=0.01, height=0.1, rings=2, layers=10)\n--\n\n"
      "See sinew.mesh.cone().");
  module.def(
      "mesh_hollow_cylinder",
      [](double inner_radius, double outer_radius, double height, int through, int around,
         int layers) {
        return share(
            mesh::hollow_cylinder({inner_radius, outer_radius, height, through, around, layers}));
      },
      py::kw_only(), py::arg("inner_radius") = 0.008, py::arg("outer_radius") = 0.012,
      py::arg("height") = 0.05, py::arg("through") = 2, py::arg("around") = 24,
      py::arg("layers") = 12,
      "mesh_hollow_cylinder(*, inner_radius=0.008, outer_radius=0.012, height=0.05, through=2, "
      "around=24, layers=12)\n--\n\nSee sinew.mesh.hollow_cylinder().");
}

void bind_balls(py::module_& module) {
  module.def(
      "mesh_sphere",
      [](double radius, int rings) {
        return share(mesh::sphere({radius, rings}));
      },
      py::kw_only(), py::arg("radius") = 0.015, py::arg("rings") = 3,
      "mesh_sphere(*, radius=0.015, rings=3)\n--\n\nSee sinew.mesh.sphere().");
  module.def(
      "mesh_capsule",
      [](double radius, double length, int rings, int layers) {
        return share(mesh::capsule({radius, length, rings, layers}));
      },
      py::kw_only(), py::arg("radius") = 0.01, py::arg("length") = 0.04, py::arg("rings") = 2,
      py::arg("layers") = 4,
      "mesh_capsule(*, radius=0.01, length=0.04, rings=2, layers=4)\n--\n\n"
      "See sinew.mesh.capsule().");
}

void bind_robots(py::module_& module) {
  module.def(
      "mesh_chambered_cylinder",
      [](double radius, double height, double chamber_radius, double chamber_offset,
         double chamber_bottom, double chamber_top, int core, int through, int layers) {
        return share(
            mesh::chambered_cylinder({radius, height, chamber_radius, chamber_offset,
                                      chamber_bottom, chamber_top, core, through, layers}));
      },
      py::kw_only(), py::arg("radius") = 0.0125, py::arg("height") = 0.065,
      py::arg("chamber_radius") = 0.0037, py::arg("chamber_offset") = 0.0073,
      py::arg("chamber_bottom") = 0.0, py::arg("chamber_top") = 0.06, py::arg("core") = 3,
      py::arg("through") = 4, py::arg("layers") = 26,
      "mesh_chambered_cylinder(*, radius=0.0125, height=0.065, chamber_radius=0.0037, "
      "chamber_offset=0.0073, chamber_bottom=0.0, chamber_top=0.06, core=3, through=4, "
      "layers=26)\n--\n\nSee sinew.mesh.chambered_cylinder().");
  module.def(
      "mesh_ribbed_finger",
      [](const py::object& size, double spine, double gap, int ribs, int rib_cells, int gap_cells,
         int width_cells, int spine_cells, int rib_rise_cells) {
        return share(
            mesh::ribbed_finger({to_vector3(size, "ribbed_finger(size)", "m"), spine, gap, ribs,
                                 rib_cells, gap_cells, width_cells, spine_cells, rib_rise_cells}));
      },
      py::arg("size"), py::kw_only(), py::arg("spine") = 0.006, py::arg("gap") = 0.005,
      py::arg("ribs") = 7, py::arg("rib_cells") = 2, py::arg("gap_cells") = 1,
      py::arg("width_cells") = 3, py::arg("spine_cells") = 1, py::arg("rib_rise_cells") = 2,
      "mesh_ribbed_finger(size, *, spine=0.006, gap=0.005, ribs=7, rib_cells=2, gap_cells=1, "
      "width_cells=3, spine_cells=1, rib_rise_cells=2)\n--\n\nSee sinew.mesh.ribbed_finger().");
}

void bind_other_shapes(py::module_& module) {
  module.def(
      "mesh_block",
      [](const py::object& size, const py::object& cells, const py::object& corner) {
        return share(mesh::block({to_vector3(corner, "block(corner)", "m"),
                                  to_vector3(size, "block(size)", "m"), to_cells(cells)}));
      },
      py::arg("size"), py::arg("cells"), py::arg("corner"),
      "mesh_block(size, cells, corner)\n--\n\nSee sinew.mesh.block().");
  module.def(
      "mesh_trunk",
      [](double height, double bottom_radius, double top_radius, double groove_depth, int bellows,
         int layers_per_bellow, int rings) {
        return share(mesh::trunk(
            {height, bottom_radius, top_radius, groove_depth, bellows, layers_per_bellow, rings}));
      },
      py::kw_only(), py::arg("height") = 0.195, py::arg("bottom_radius") = 0.020,
      py::arg("top_radius") = 0.0085, py::arg("groove_depth") = 0.25, py::arg("bellows") = 9,
      py::arg("layers_per_bellow") = 4, py::arg("rings") = 2,
      "mesh_trunk(*, height=0.195, bottom_radius=0.02, top_radius=0.0085, groove_depth=0.25, "
      "bellows=9, layers_per_bellow=4, rings=2)\n--\n\nSee sinew.mesh.trunk().");
}

}  // namespace

void bind_mesh(py::module_& module) {
  bind_type(module);
  bind_round_shapes(module);
  bind_balls(module);
  bind_robots(module);
  bind_other_shapes(module);
  module.def("read_mesh", &read, py::arg("path"), py::arg("unit"), py::arg("several_components"),
             "read_mesh(path, unit, several_components)\n--\n\nSee sinew.mesh.read().");
}

}  // namespace sinew::python
