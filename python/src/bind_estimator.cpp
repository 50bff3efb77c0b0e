#include <cmath>
#include <string>
#include <utility>

#include "sinew/estimate/estimator.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/estimate/estimators.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const estimate::EstimatorModel& model(const Estimator& self) {
  return estimate::estimators_of(self.session->model())[static_cast<std::size_t>(self.index)];
}

template <class Get>
auto of_estimator(Get get) {
  return [get](const Estimator& self) {
    const Session::Use use(*self.session);
    return get(estimate::estimator_of(self.session->simulation(), self.index));
  };
}

py::list sensor_names(const Estimator& self) {
  py::list names;
  for (const estimate::EstimatorSensor& sensor : model(self).sensors) {
    names.append(
        sense::sensors_of(self.session->model())[static_cast<std::size_t>(sensor.index)].name);
  }
  return names;
}

// The estimates of the unknowns of one kind, by name. @param get(components) converts one.
template <class Get>
py::dict unknowns(const Estimator& self, estimate::Unknown::Kind kind, Get get) {
  const Session::Use use(*self.session);
  const VectorX mean = estimate::estimator_of(self.session->simulation(), self.index).mean();
  py::dict all;
  Eigen::Index first = 0;
  for (const estimate::Unknown& unknown : model(self).unknowns) {
    const Eigen::Index own = std::exchange(first, first + unknown.size());
    if (unknown.kind == kind) all[py::str(unknown.name)] = get(mean.segment(own, unknown.size()));
  }
  return all;
}

py::dict forces(const Estimator& self) {
  return unknowns(self, estimate::Unknown::Kind::force,
                  [](const VectorX& own) { return reading(Vector3(own)); });
}

py::dict efforts(const Estimator& self) {
  return unknowns(self, estimate::Unknown::Kind::effort, [](const VectorX& own) { return own[0]; });
}

py::dict stiffness_factors(const Estimator& self) {
  return unknowns(self, estimate::Unknown::Kind::stiffness,
                  [](const VectorX& own) { return std::exp(own[0]); });
}

py::list list_of(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(text);
  return list;
}

}  // namespace

void bind_estimator(py::module_& module) {
  module.attr("silent_periods") = estimate::kSilentPeriods;
  py::class_<Estimator>(module, "Estimator",
                        "An estimator of the scene; it does not affect the robot. From "
                        "Simulation.estimator() or Simulation.estimators.")
      .def_property_readonly(
          "name", [](const Estimator& self) { return model(self).name; }, "str: as in the scene.")
      .def_property_readonly("sensors", &sensor_names, "list of str: the sensors that it uses.")
      .def_property_readonly(
          "components",
          [](const Estimator& self) { return list_of(model(self).component_names()); },
          "list of str (n,): 'hand.x', 'hand.y', 'hand.z' of an unknown force, 'leak' of an "
          "unknown pressure, tension or stiffness.")
      .def_property_readonly("forces", &forces,
                             "dict of (3,) ndarray: the estimate of each unknown force (N), in "
                             "world axes.")
      .def_property_readonly("efforts", &efforts,
                             "dict of float: the estimate of each unknown pressure (Pa) and "
                             "tension (N).")
      .def_property_readonly("stiffness", &stiffness_factors,
                             "dict of float: the estimate of each unknown stiffness, as a factor "
                             "of the body's moduli in the scene.")
      .def_property_readonly(
          "mean", of_estimator([](const estimate::Estimator& one) { return reading(one.mean()); }),
          "(n,) ndarray: the estimate of all components (N or Pa; of a stiffness, the logarithm of "
          "the factor).")
      .def_property_readonly(
          "std",
          of_estimator([](const estimate::Estimator& one) { return reading(one.deviation()); }),
          "(n,) ndarray: standard deviations of the components (N or Pa; of a stiffness, of the "
          "logarithm, about the relative standard deviation of the factor).")
      .def_property_readonly(
          "covariance",
          of_estimator([](const estimate::Estimator& one) { return reading(one.covariance()); }),
          "(n, n) ndarray: covariance of the components, in products of their units.")
      .def_property_readonly("singular_values", of_estimator([](const estimate::Estimator& one) {
                               return reading(one.observability().singular_values);
                             }),
                             "(n,) ndarray, descending: information of one sample of each sensor "
                             "along n directions, relative to the prior; for a robot with inertia, "
                             "of all samples so far. Along a direction with singular value s, the "
                             "samples reduce the standard deviation to 1/sqrt(1 + s^2) of the "
                             "prior's. Zeros before the first step.")
      .def_property_readonly("unobservable", of_estimator([](const estimate::Estimator& one) {
                               return list_of(one.unobservable());
                             }),
                             "list of str: directions with a singular value below 1, such as "
                             "'0.98 hand.z - 0.2 hand.x (singular value 0.03)'. The prior decides "
                             "the estimate there.")
      .def_property_readonly(
          "lost", of_estimator([](const estimate::Estimator& one) { return list_of(one.lost()); }),
          "list of str: sensors without a sample for five periods, or older than their timeout.")
      .def_property_readonly(
          "dropped", of_estimator([](const estimate::Estimator& one) { return one.dropped(); }),
          "int: samples that came later than the longest delay of the sensors.")
      .def_property_readonly("status", of_estimator([](const estimate::Estimator& one) {
                               return std::string(estimate::estimator_status_name(one.status()));
                             }),
                             "str: 'not-started', 'estimating', 'unobservable', 'sensors-lost' or "
                             "'no-equilibrium'.")
      .def_property_readonly(
          "message", of_estimator([](const estimate::Estimator& one) { return one.message(); }),
          "str: which sensors are silent, which directions they do not observe, or why "
          "there is no equilibrium; else empty.");
}

}  // namespace sinew::python
