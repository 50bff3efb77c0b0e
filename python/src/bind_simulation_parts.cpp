// Binds access to parts of a simulation by name.
#include <functional>
#include <string>
#include <string_view>

#include "sinew/constraint/probe.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sense/sensor_set.hpp"

#include "simulation_type.hpp"

namespace sinew::python {

namespace {

// The part with a name.
template <class One, class Index>
auto named(Index index) {
  return [index](const std::shared_ptr<Session>& self, const std::string& name) {
    return One{{self, std::invoke(index, self->model(), name)}};
  };
}

// All parts of a kind by name, in the order of the model.
template <class One, class List>
auto all(List list) {
  return [list](const std::shared_ptr<Session>& self) {
    py::dict result;
    int index = 0;
    for (const auto& part : std::invoke(list, self->model())) {
      One one{{self, index++}};
      if constexpr (requires { part.name(); }) {
        result[part.name().c_str()] = std::move(one);
      } else {
        result[part.name.c_str()] = std::move(one);
      }
    }
    return result;
  };
}

void bind_devices(SimulationType& type) {
  type.def("actuator", named<Actuator>(&model::Model::actuator_index), py::arg("name"),
           R"(actuator($self, name)
--

An actuator by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("effector", named<Effector>(&model::Model::effector_index), py::arg("name"),
           R"(effector($self, name)
--

An effector by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("probe", named<Probe>(&model::Model::probe_index), py::arg("name"),
           R"(probe($self, name)
--

A probe by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("sensor", named<Sensor>(&sense::sensor_index), py::arg("name"),
           R"(sensor($self, name)
--

A sensor by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("estimator", named<Estimator>(&estimate::estimator_index), py::arg("name"),
           R"(estimator($self, name)
--

An estimator by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("load", named<Load>(&model::Model::load_index), py::arg("name"),
           R"(load($self, name)
--

A load by its name. Raises Error (unknown-name) with a suggestion.
)");
}

void bind_bodies(SimulationType& type) {
  type.def("body", named<Body>(&model::Model::body_index), py::arg("name"),
           R"(body($self, name)
--

A body by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("mass", named<PointMass>(&model::Model::mass_index), py::arg("name"),
           R"(mass($self, name)
--

A point mass by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("contact", named<Contact>(&model::Model::contact_index), py::arg("name"),
           R"(contact($self, name)
--

A contact by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def("joint", named<Joint>(&model::Model::joint_index), py::arg("name"),
           R"(joint($self, name)
--

A joint by its name. Raises Error (unknown-name) with a suggestion.
)");
}

void bind_lists(SimulationType& type) {
  type.def_property_readonly("actuators", all<Actuator>(&model::Model::actuators),
                             "dict: all actuators by name, in the scene's order.")
      .def_property_readonly("effectors", all<Effector>(&model::Model::effectors),
                             "dict: all effectors by name, in the scene's order.")
      .def_property_readonly("probes", all<Probe>(&model::Model::probes),
                             "dict: all probes by name, in the scene's order.")
      .def_property_readonly("sensors", all<Sensor>([](const model::Model& model) {
                               return sense::sensors_of(model);
                             }),
                             "dict: all sensors by name, in the scene's order.")
      .def_property_readonly("estimators", all<Estimator>(&estimate::estimators_of),
                             "dict: all estimators by name, in the scene's order.")
      .def_property_readonly("masses", all<PointMass>(&model::Model::masses),
                             "dict: all point masses by name, body by body.")
      .def_property_readonly("contacts", all<Contact>(&model::Model::contacts),
                             "dict: all contacts by name, in the scene's order.")
      .def_property_readonly("joints", all<Joint>(&model::Model::joints),
                             "dict: all joints by name, in the scene's order.")
      .def_property_readonly("bodies", all<Body>(&model::Model::bodies),
                             "dict: all bodies by name, in the scene's order.");
}

}  // namespace

void bind_simulation_parts(SimulationType& type) {
  bind_devices(type);
  bind_bodies(type);
  bind_lists(type);
}

}  // namespace sinew::python
