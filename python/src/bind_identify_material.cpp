#include <limits>
#include <optional>
// Identification of hyperelastic constants from material tests.
#include <filesystem>

#include <fmt/format.h>

#include "sinew/identify/material_fit.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using namespace identify;
using material::DeformationMode;

struct MaterialFit {
  FitResult fit;
  double information = 0.0;
  std::string yaml;
};

DeformationMode to_mode(const std::string& mode) {
  for (const DeformationMode known :
       {DeformationMode::uniaxial, DeformationMode::equibiaxial, DeformationMode::planar}) {
    if (mode == mode_name(known)) return known;
  }
  throw Error(ErrorKind::unknown_choice, {.item = "fit_materials(tests)"},
              fmt::format("there is no mode '{}'", mode),
              "use 'uniaxial', 'equibiaxial' or 'planar'");
}

/// Material test from a path or a tuple (mode, stretch, stress).
RubberTest to_test(const py::handle& value, std::size_t index) {
  const auto is_path = py::module_::import("os").attr("PathLike");
  if (py::isinstance<py::str>(value) || py::isinstance(value, is_path)) {
    return read_rubber_test(py::cast<std::filesystem::path>(value));
  }
  const std::string place = fmt::format("fit_materials(tests[{}])", index);
  if (!py::isinstance<py::tuple>(value) || py::len(value) != 3) {
    throw Error(ErrorKind::wrong_type, {.item = place}, "this is not a test",
                "give a path, or a tuple of mode, stretches and nominal stresses (Pa)");
  }
  const auto parts = py::cast<py::tuple>(value);
  RubberTest test{.name = fmt::format("test {}", index + 1),
                  .mode = to_mode(py::cast<std::string>(parts[0])),
                  .stretch = to_list(parts[1], place, ""),
                  .stress = to_list(parts[2], place, "Pa")};
  if (test.stretch.size() != test.stress.size()) {
    throw Error(ErrorKind::wrong_length, {.item = place},
                fmt::format("there are {} stretches and {} stresses", test.stretch.size(),
                            test.stress.size()),
                "give one stress for each stretch");
  }
  for (const double stretch : test.stretch) {
    if (stretch > 0.0) continue;
    throw Error(ErrorKind::out_of_range, {.item = place}, fmt::format("a stretch is {:g}", stretch),
                "stretches are above 0; 1 is at rest");
  }
  return test;
}

std::vector<MaterialFit> fit_materials(const py::object& tests,
                                       const std::vector<std::string>& models, double min_stretch,
                                       std::optional<double> max_stretch, int starts,
                                       std::uint64_t seed, bool mullins, double poisson_ratio) {
  std::vector<RubberTest> given;
  if (py::isinstance<py::list>(tests)) {
    for (const py::handle& test : tests) given.push_back(to_test(test, given.size()));
  } else {
    given.push_back(to_test(tests, 0));
  }
  FitSettings settings{
      .starts = starts,
      .seed = seed,
      .mullins = mullins,
      .poisson_ratio = poisson_ratio,
      .min_stretch = min_stretch,
      .max_stretch = max_stretch.value_or(std::numeric_limits<double>::infinity())};
  const py::gil_scoped_release release;
  const std::vector<FitResult> fits =
      identify::fit_materials(given, models.empty() ? fit_models() : models, settings);
  const std::vector<double> information = bayes_information(fits);
  std::vector<MaterialFit> result;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    result.push_back({fits[k], information[k], material_yaml(fits[k], given, settings)});
  }
  return result;
}

py::list coefficients(const MaterialFit& self) {
  py::list result;
  for (const Coefficient& c : self.fit.coefficients) {
    result.append(py::make_tuple(c.name, c.value));
  }
  return result;
}

template <typename Get>
auto of_tests(Get get) {
  return [get](const MaterialFit& self) {
    std::vector<double> result;
    for (const TestFit& test : self.fit.tests) result.push_back(get(test));
    return result;
  };
}

void bind_result(py::module_& module) {
  py::class_<MaterialFit>(module, "MaterialFit",
                          "A law fitted to material tests. From sinew.identify.fit_materials().")
      .def_property_readonly(
          "model", [](const MaterialFit& self) { return self.fit.model; },
          "str: requested model; 'ogden3' may have fewer terms if more do not improve the fit.")
      .def_property_readonly(
          "coefficients", &coefficients,
          "list of tuple: name and value (SI) of each constant, named as in scenes; Ogden's mu and "
          "alpha alternate, mu-over-alpha.")
      .def_property_readonly(
          "shear_modulus", [](const MaterialFit& self) { return self.fit.energy.shear_modulus(); },
          "float: initial, Pa.")
      .def_property_readonly(
          "rms", of_tests([](const TestFit& test) { return test.rms; }),
          "list of float: RMS error in each test over the rows in the range, Pa.")
      .def_property_readonly("relative_rms",
                             of_tests([](const TestFit& test) { return test.relative; }),
                             "list of float: the same divided by the test's largest stress.")
      .def_readonly(
          "information", &MaterialFit::information,
          "float: Bayesian information criterion among the models fitted together; the model with "
          "the lowest value is best supported by the tests.")
      .def_property_readonly(
          "stable_range", [](const MaterialFit& self) { return self.fit.uniaxial_range; },
          "tuple: range of uniaxial stretches in which the law is Drucker-stable.")
      .def_property_readonly(
          "converged", [](const MaterialFit& self) { return self.fit.converged; },
          "bool: whether the search converged.")
      .def_readonly("yaml", &MaterialFit::yaml,
                    "str: the material for a scene, `material: {file: rubber.yaml}`.")
      .def("__repr__", [](const MaterialFit& self) {
        return fmt::format("<MaterialFit {}, mu_0 {:.4g} kPa, RMS {:.2g} % of the largest stress>",
                           self.fit.model, 1e-3 * self.fit.energy.shear_modulus(),
                           100.0 * std::sqrt(self.fit.cost));
      });
}

}  // namespace

void bind_identify_material(py::module_& module) {
  bind_result(module);
  module.def(
      "fit_materials", &fit_materials, py::arg("tests"), py::arg("models") = py::list(),
      py::kw_only(), py::arg("min_stretch") = 0.0, py::arg("max_stretch") = py::none(),
      py::arg("starts") = 5, py::arg("seed") = 1, py::arg("mullins") = false,
      py::arg("poisson_ratio") = 0.49,
      R"(fit_materials(tests, models=[], *, min_stretch=0.0, max_stretch=None, starts=5, seed=1, mullins=False, poisson_ratio=0.49)
--

Fits hyperelastic laws to material tests by least squares, as `sinew fit` does.

Each test is weighted by its largest stress. A richer model of a family never fits worse than a simpler one.

Parameters
----------
tests : path-like, tuple, or list of them
    A table as for `sinew fit`, or (mode, stretch, stress): 'uniaxial', 'equibiaxial' or
    'planar', (n,) stretches and (n,) nominal stresses (Pa), in measured order.
models : list of str
    'neo-hookean', 'mooney-rivlin', 'yeoh1' to 'yeoh3', 'ogden1' to 'ogden6', 'arruda-boyce'; empty:
    all of them.
min_stretch, max_stretch : float
    Rows outside are ignored.
starts, seed : int
    Number and seed of random starts, in addition to those from simpler models.
mullins : bool
    Whether to fit softening on unloading, too.
poisson_ratio : float
    Poisson's ratio of the material written by `yaml`.

Returns
-------
list of MaterialFit
    In the order of `models`.

Raises
------
Error
    For invalid tables or arguments.

Examples
--------
>>> fits = identify.fit_materials("tensile.csv", max_stretch=4.0)
>>> best = min(fits, key=lambda fit: fit.information)
)");
}

}  // namespace sinew::python
