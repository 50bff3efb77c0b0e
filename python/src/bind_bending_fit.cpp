// Calibration of bending actuators. python/sinew/bending_fit.py wraps its records and results.
#include <memory>

#include <fmt/format.h>

#include "arrays.hpp"
#include "bending.hpp"
#include "bindings.hpp"
#include "errors.hpp"

#ifdef SINEW_HAS_IDENTIFY
#include "sinew/identify/bending_fit.hpp"
#endif

namespace sinew::python {

namespace {

#ifdef SINEW_HAS_IDENTIFY

using identify::PlanePoints;
using identify::TipErrors;
using identify::TipRecord;

PlanePoints to_plane(const py::handle& value, const char* place) {
  const Array array = to_array(value, place, "(n, 2) m");
  if (array.ndim() != 2 || array.shape(1) != 2) {
    throw Error(ErrorKind::wrong_shape, {.item = place}, "the points are not in two columns",
                "give an array of shape (n, 2): x and height in m");
  }
  return Eigen::Map<const PlanePoints>(array.data(), array.shape(0), 2);
}

Array from_plane(const PlanePoints& points) {
  return Array({points.rows(), Eigen::Index{2}}, points.data());
}

py::dict errors_of(const TipErrors& errors) {
  py::dict result;
  result["mean"] = errors.mean;
  result["largest"] = errors.largest;
  result["mean_of_length"] = errors.mean_of_length;
  result["largest_of_length"] = errors.largest_of_length;
  result["mean_absolute"] = Array(2, errors.mean_absolute.data());
  result["root_mean_square"] = Array(2, errors.root_mean_square.data());
  return result;
}

py::tuple read_record(const std::filesystem::path& path) {
  const TipRecord record = identify::read_tip_record(path);
  const auto column = [](const std::vector<double>& v) {
    return Array(static_cast<py::ssize_t>(v.size()), v.data());
  };
  const py::object pressure =
      record.pressure.empty() ? py::object(py::none()) : py::object(column(record.pressure));
  return py::make_tuple(column(record.time), from_plane(record.tip), pressure, record.name);
}

py::dict errors_between(const py::object& found, const py::object& measured, double length) {
  return errors_of(identify::tip_errors(to_plane(found, "tip_errors(found)"),
                                        to_plane(measured, "tip_errors(measured)"), length));
}

TipRecord to_record(const py::handle& given) {
  TipRecord record;
  record.name = py::str(given.attr("name"));
  record.time = to_list(given.attr("time"), record.name + ".time", "s");
  record.tip = to_plane(given.attr("tip"), "tip");
  const py::object pressure = given.attr("pressure");
  if (!pressure.is_none()) record.pressure = to_list(pressure, record.name + ".pressure", "Pa");
  return record;
}

py::dict fit(const std::shared_ptr<pcc::BendingActuator>& actuator, const py::list& given,
             int degree, const std::string& kind, std::pair<double, double> bounds, bool damping,
             double highest_damping, double longest_step, const std::string& integrator,
             double spectral_radius) {
  std::vector<TipRecord> records;
  for (const py::handle& record : given) records.push_back(to_record(record));
  const identify::BendingFitSettings settings{
      .degree = degree,
      .kind = pcc::to_modulus_kind(kind),
      .lowest = bounds.first,
      .highest = bounds.second,
      .damping = damping,
      .highest_damping = highest_damping,
      .longest_step = longest_step,
      .motion = to_motion_settings(integrator, spectral_radius)};
  identify::BendingFit found;
  {
    const py::gil_scoped_release release;
    found = identify::fit_bending(actuator->parameters(), records, settings);
  }
  py::list tips, errors;
  for (const PlanePoints& tip : found.tips) tips.append(from_plane(tip));
  for (const TipErrors& error : found.errors) errors.append(errors_of(error));
  py::dict result;
  result["actuator"] = std::make_shared<pcc::BendingActuator>(found.parameters);
  result["tips"] = tips;
  result["errors"] = errors;
  result["cost"] = found.cost;
  result["converged"] = found.converged;
  result["at_bound"] = found.at_bound;
  return result;
}

#else

[[noreturn]] py::object missing(const py::args&, const py::kwargs&) {
  throw Error(ErrorKind::tool_missing, {.item = "sinew.pcc"},
              "this package was built without fitting",
              "build it with SINEW_IDENTIFY=ON; Ceres is needed for that");
}

constexpr auto read_record = &missing, errors_between = &missing, fit = &missing;

#endif

}  // namespace

void bind_bending_fit(py::module_& module) {
  module.def("_read_tip_record", read_record);
  module.def("_tip_errors", errors_between);
  module.def("_fit_modulus", fit);
}

}  // namespace sinew::python
