// Binds materials without a scene: laws, and materials of the library.
#include <fmt/format.h>

#include "sinew/material/instability.hpp"
#include "sinew/material/library.hpp"
#include "sinew/scene/scene.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "tree.hpp"

namespace sinew::python {

namespace {

using material::DeformationMode;

struct Material {
  material::Hyperelastic energy;
  double density = 0.0;
};

// Reads a material with the scene reader, in a scene with one block.
Material read_material(const py::object& spec) {
  py::dict mesh, body, bodies, tree;
  mesh["shape"] = "block";
  for (const char* side : {"length", "width", "height"}) mesh[side] = 0.01;
  body["type"] = "fem";
  body["mesh"] = mesh;
  body["material"] = spec;
  bodies["body"] = body;
  tree["sinew"] = 1;
  tree["bodies"] = bodies;
  const auto scene = scene::parse_scene_tree(to_tree(tree), {});
  const scene::MaterialDescription& read = scene.bodies.front().material;
  if (!read.is_hyperelastic()) {
    throw Error(ErrorKind::wrong_type, {.item = "material(spec)"},
                "linear and corotational materials are not large-strain laws",
                "its constants are Young's modulus and Poisson's ratio");
  }
  return {read.energy, read.density};
}

DeformationMode to_mode(const std::string& mode) {
  if (mode == "uniaxial") return DeformationMode::uniaxial;
  if (mode == "equibiaxial") return DeformationMode::equibiaxial;
  if (mode == "planar") return DeformationMode::planar;
  throw Error(ErrorKind::unknown_choice, {.item = "mode"},
              fmt::format("there is no mode '{}'", mode),
              "use 'uniaxial', 'equibiaxial' or 'planar'");
}

Array nominal_stress(const Material& self, const py::object& stretch, const std::string& mode) {
  const Array stretches = to_array(stretch, "nominal_stress(stretch)", "any shape");
  const DeformationMode test = to_mode(mode);
  Array result(std::vector<py::ssize_t>(stretches.shape(), stretches.shape() + stretches.ndim()));
  for (py::ssize_t i = 0; i < stretches.size(); ++i) {
    const double l = stretches.data()[i];
    if (l <= 0.0) {
      throw Error(ErrorKind::out_of_range, {.item = "nominal_stress(stretch)"},
                  fmt::format("a stretch is {:g}", l), "stretches are above 0; 1 is at rest");
    }
    result.mutable_data()[i] = material::nominal_stress(self.energy, test, l);
  }
  return result;
}

std::pair<double, double> stable_range(const Material& self, const std::string& mode, double lowest,
                                       double highest) {
  if (!(lowest > 0.0 && lowest <= 1.0 && highest >= 1.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "stable_range()"},
                fmt::format("{:g} to {:g} does not hold 1", lowest, highest),
                "give 0 < lowest <= 1 <= highest");
  }
  return material::stable_range(self.energy, to_mode(mode), lowest, highest);
}

// None for a number that the library does not know.
py::object known(double value) {
  return value > 0.0 ? py::object(py::float_(value)) : py::object(py::none());
}

py::dict library() {
  py::dict result;
  for (const material::NamedMaterial& named : material::material_library()) {
    py::dict entry;
    entry["trade_name"] = named.trade_name;
    entry["law"] = named.law;
    entry["density"] = named.density;
    entry["stretch_range"] = named.highest > 0.0
                                 ? py::object(py::make_tuple(named.lowest, named.highest))
                                 : py::object(py::none());
    entry["error"] = known(named.error);
    entry["young_modulus"] = named.energy.young_modulus();
    entry["measured_modulus"] = known(named.measured_modulus);
    entry["measured_by"] = named.measured_by;
    entry["soft_below"] = known(named.soft_below);
    entry["better"] = named.better;
    entry["unstable"] = material::instability(named.energy);
    entry["source"] = named.source;
    entry["remark"] = named.remark;
    result[named.name.c_str()] = entry;
  }
  return result;
}

}  // namespace

void bind_material(py::module_& module) {
  py::class_<Material>(module, "Material",
                       "A hyperelastic law with its constants. From sinew.material().")
      .def_property_readonly(
          "shear_modulus", [](const Material& self) { return self.energy.shear_modulus(); },
          "float: initial, Pa.")
      .def_property_readonly(
          "bulk_modulus", [](const Material& self) { return self.energy.bulk_modulus; },
          "float: kappa, Pa.")
      .def_property_readonly(
          "young_modulus", [](const Material& self) { return self.energy.young_modulus(); },
          "float: initial shear modulus, Pa.")
      .def_property_readonly(
          "poisson_ratio", [](const Material& self) { return self.energy.poisson_ratio(); },
          "float: of small strain.")
      .def_property_readonly(
          "viscosity",
          [](const Material& self) {
            std::vector<std::pair<double, double>> series;
            for (const material::PronyTerm& term : self.energy.prony) {
              series.emplace_back(term.relative_modulus, term.relaxation_time);
            }
            return series;
          },
          "list of tuple: relative modulus and relaxation time (s) of each branch of its Prony "
          "series; moduli and stresses of this object are long-term values.")
      .def_property_readonly(
          "density",
          [](const Material& self) -> std::optional<double> {
            if (self.density > 0.0) return self.density;
            return std::nullopt;
          },
          "float or None: density of a library material, kg/m^3.")
      .def("nominal_stress", &nominal_stress, py::arg("stretch"), py::arg("mode") = "uniaxial",
           R"(nominal_stress($self, stretch, mode='uniaxial')
--

Nominal stress of the incompressible material in a test: force per undeformed area, with stress-free free faces.

Parameters
----------
stretch : float or array_like
    Length divided by length at rest, > 0.
mode : {'uniaxial', 'equibiaxial', 'planar'}

Returns
-------
ndarray
    Pa, in the shape of `stretch`.
)")
      .def("stable_range", &stable_range, py::arg("mode") = "uniaxial", py::arg("lowest") = 0.1,
           py::arg("highest") = 10.0,
           R"(stable_range($self, mode='uniaxial', lowest=0.1, highest=10.0)
--

Range of stretches around 1 in which the incompressible material is Drucker-stable.

Parameters
----------
mode : {'uniaxial', 'equibiaxial', 'planar'}
lowest, highest : float
    Range of the search.

Returns
-------
tuple of float
)")
      .def("__repr__", [](const Material& self) {
        return fmt::format("<sinew.Material, initial shear modulus {:.4g} Pa, nu_0 {:.4g}>",
                           self.energy.shear_modulus(), self.energy.poisson_ratio());
      });
  module.def("material", &read_material, py::arg("spec"),
             R"(material(spec)
--

Creates a material from a scene's `material`, to examine it before it is used.

Parameters
----------
spec : str or dict
    A name of materials(), or a hyperelastic law as in a scene: {"model": "neo-hookean",
    "shear_modulus": "20 kPa", "poisson_ratio": 0.49}.

Returns
-------
Material

Raises
------
Error
    As for a scene, and wrong-type for small-strain laws.
)");
  module.def("materials", &library,
             R"(materials()
--

The library of materials that scenes can name.

Returns
-------
dict of dict
    By name: 'trade_name'; 'law'; 'density' (kg/m^3); 'stretch_range', the stretches measured by the
    source, or None if it does not say; 'error', the largest relative deviation of the nominal stress
    from the data there (above a stretch of 1.5 for fits to tensile curves), or None; 'young_modulus'
    at small strain (Pa); 'measured_modulus' (Pa, or None) and 'measured_by', what another test found;
    'soft_below', the stretch below which the law is too soft, or None; 'better', the entry to use
    instead there, or in place of an unstable law; 'unstable', where the law is unstable between
    stretches of 0.5 and 3, empty if nowhere; 'source' and 'remark'.
)");
}

}  // namespace sinew::python
