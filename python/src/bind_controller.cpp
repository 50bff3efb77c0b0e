#include <limits>
#include <map>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/control/inverse_controller.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sense/sensor_set.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

using control::EffectorTask;
using control::InverseController;
using control::InverseSettings;
using control::TargetController;

// The class of `controller.targets`: a live mapping from effectors to targets.
struct Targets {
  Controller controller;
};

const TargetController& law(const Controller& self) { return *self.attached->law; }

const std::string& effector_name(const Controller& self, const EffectorTask& task) {
  return self.session->model().effectors()[static_cast<std::size_t>(task.effector)].name;
}

void require_attached(const Controller& self) {
  if (self.attached->attached) return;
  throw Error(ErrorKind::bad_argument, {.item = "InverseController"},
              "this controller is detached from its simulation",
              "make a new one: sinew.InverseController(sim, targets=...)");
}

int task_of(const Controller& self, const std::string& name) {
  std::vector<std::string> names;
  const auto& tasks = law(self).settings().tasks;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    names.push_back(effector_name(self, tasks[k]));
    if (names.back() == name) return static_cast<int>(k);
  }
  throw Error(ErrorKind::unknown_name, {.item = "targets"},
              fmt::format("this controller does not steer '{}'", name),
              fmt::format("it steers {}", fmt::join(names, ", ")));
}

std::string text_key(const py::handle& key, const char* place) {
  if (py::isinstance<py::str>(key)) return py::str(key);
  throw Error(ErrorKind::wrong_type, {.item = place},
              fmt::format("the key {} is not text", std::string(py::repr(key))),
              "name effectors by text");
}

py::dict to_dict(const py::handle& value, const char* place) {
  if (py::isinstance<py::dict>(value)) return py::reinterpret_borrow<py::dict>(value);
  throw Error(ErrorKind::wrong_type, {.item = place},
              fmt::format("{} is not a dict", std::string(py::repr(value)).substr(0, 60)),
              "give a dict such as {'tip': [0.03, 0.0, 0.18]}");
}

std::vector<EffectorTask> to_tasks(const model::Model& model, const py::handle& targets,
                                   const py::object& weights) {
  std::vector<EffectorTask> tasks;
  for (const auto& [key, value] : to_dict(targets, "InverseController(targets)")) {
    const std::string name = text_key(key, "InverseController(targets)");
    tasks.push_back(
        {model.effector_index(name), to_target(value, fmt::format("targets['{}']", name)), {1.0}});
  }
  if (weights.is_none()) return tasks;
  for (const auto& [key, value] : to_dict(weights, "InverseController(weights)")) {
    const int effector = model.effector_index(text_key(key, "InverseController(weights)"));
    const auto found = std::find_if(tasks.begin(), tasks.end(), [&](const EffectorTask& task) {
      return task.effector == effector;
    });
    if (found == tasks.end()) {
      throw Error(ErrorKind::unknown_name, {.item = "InverseController(weights)"},
                  fmt::format("'{}' has a weight but no target", std::string(py::str(key))),
                  "add it to targets");
    }
    const std::string place = fmt::format("weights['{}']", std::string(py::str(key)));
    const bool single = PyFloat_Check(value.ptr()) || PyLong_Check(value.ptr());
    found->weights = single ? std::vector<double>{to_number(value, place, "no unit")}
                            : to_list(value, place, "no unit");
  }
  return tasks;
}

control::ContactTask to_contact_task(const model::Model& model, const std::string& name,
                                     const py::handle& value) {
  control::ContactTask task;
  task.contact = model.contact_index(name);
  const std::string place = fmt::format("contacts['{}']", name);
  bool may_slip = true;
  for (const auto& [key, given] : to_dict(value, place.c_str())) {
    const std::string word = text_key(key, place.c_str());
    if (word == "normal_force" && py::isinstance<py::dict>(given)) {
      for (const auto& [end, force] : py::reinterpret_borrow<py::dict>(given)) {
        const std::string limit = text_key(end, place.c_str());
        if (limit != "min" && limit != "max") {
          throw Error(ErrorKind::unknown_key, {.item = place},
                      fmt::format("normal_force has no '{}'", limit), "give min, max or both");
        }
        (limit == "min" ? task.normal_min : task.normal_max) = to_number(force, place, "N");
      }
    } else if (word == "normal_force") {
      task.normal_min = task.normal_max = to_number(given, place, "N");
    } else if (word == "slip") {
      may_slip = py::cast<bool>(given);
      if (!may_slip && !task.reserve) task.reserve = 0.0;
    } else if (word == "reserve") {
      task.reserve = to_number(given, place, "no unit");
    } else {
      throw Error(ErrorKind::unknown_key, {.item = place}, fmt::format("there is no '{}'", word),
                  "give normal_force, slip or reserve");
    }
  }
  return task;
}

std::vector<control::ContactTask> to_contact_tasks(const model::Model& model,
                                                   const py::object& contacts) {
  std::vector<control::ContactTask> tasks;
  if (contacts.is_none()) return tasks;
  for (const auto& [key, value] : to_dict(contacts, "InverseController(contacts)")) {
    const std::string name = text_key(key, "InverseController(contacts)");
    tasks.push_back(to_contact_task(model, name, value));
  }
  return tasks;
}

void set_priorities(const model::Model& model, const py::object& priorities,
                    std::vector<EffectorTask>& tasks) {
  if (priorities.is_none()) return;
  for (const auto& [key, value] : to_dict(priorities, "InverseController(priorities)")) {
    const int effector = model.effector_index(text_key(key, "InverseController(priorities)"));
    const auto found = std::ranges::find(tasks, effector, &EffectorTask::effector);
    if (found == tasks.end()) {
      throw Error(ErrorKind::unknown_name, {.item = "InverseController(priorities)"},
                  fmt::format("'{}' has a priority but no target", std::string(py::str(key))),
                  "add it to targets");
    }
    found->priority =
        static_cast<int>(to_count(py::reinterpret_borrow<py::object>(value), "priorities"));
  }
}

std::vector<int> to_actuators(const model::Model& model, const py::object& names) {
  std::vector<int> actuators;
  if (names.is_none()) return actuators;
  if (py::isinstance<py::str>(names) || !py::isinstance<py::iterable>(names)) {
    throw Error(ErrorKind::wrong_type, {.item = "InverseController(actuators)"},
                fmt::format("{} is not a list of names", std::string(py::repr(names))),
                "give a list such as ['long_0', 'long_1']");
  }
  for (const auto& name : names) {
    actuators.push_back(model.actuator_index(text_key(name, "InverseController(actuators)")));
  }
  if (actuators.empty()) {
    throw Error(ErrorKind::no_actuators, {.item = "InverseController(actuators)"},
                "the list is empty", "leave it out to use all actuators");
  }
  return actuators;
}

control::Regularisation to_regularisation(const std::string& word) {
  if (word == "change") return control::Regularisation::change;
  if (word == "effort") return control::Regularisation::effort;
  throw Error(ErrorKind::unknown_choice, {.item = "InverseController(regularisation)"},
              fmt::format("there is no regularisation '{}'", word), "use 'change' or 'effort'");
}

Controller make(const std::shared_ptr<Session>& session, const py::object& targets,
                const py::object& actuators, const py::object& weights,
                const std::string& regularisation, const py::object& epsilon,
                const py::object& tolerance, const py::object& largest_step,
                const py::object& contacts, const py::object& priorities, bool certify) {
  control::TargetSettings settings;
  InverseSettings own;
  own.certify = certify;
  settings.tasks = to_tasks(session->model(), targets, weights);
  own.contacts = to_contact_tasks(session->model(), contacts);
  set_priorities(session->model(), priorities, settings.tasks);
  settings.actuators = to_actuators(session->model(), actuators);
  own.regularisation = to_regularisation(regularisation);
  const auto read = [](const py::object& value, const char* place, const char* unit, double& to) {
    if (!value.is_none()) to = to_number(value, place, unit);
  };
  read(epsilon, "InverseController(epsilon)", "no unit", own.epsilon);
  read(tolerance, "InverseController(tolerance)", "m", settings.tolerance);
  read(largest_step, "InverseController(largest_step)", "no unit", own.largest_step);
  return {session,
          session->attach(
              control::settings_for<InverseController>(std::move(settings), std::move(own)), {})};
}

py::object get_target(const Targets& self, const std::string& name) {
  const int task = task_of(self.controller, name);
  const auto& target = law(self.controller).settings().tasks[static_cast<std::size_t>(task)].target;
  if (target.end_time() == 0.0) return reading(target.at(0.0));
  return py::cast(target);
}

void set_target(const Targets& self, const std::string& name, const py::object& value) {
  const int task = task_of(self.controller, name);
  auto target = to_target(value, fmt::format("targets['{}']", name));
  const Session::Use use(*self.controller.session);
  self.controller.attached->law->set_target(task, std::move(target));
}

py::list target_names(const Targets& self) {
  py::list names;
  for (const EffectorTask& task : law(self.controller).settings().tasks) {
    names.append(effector_name(self.controller, task));
  }
  return names;
}

py::dict errors(const Controller& self) {
  const Session::Use use(*self.session);
  py::dict result;
  const auto& tasks = law(self).settings().tasks;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    result[effector_name(self, tasks[k]).c_str()] = law(self).error(static_cast<int>(k));
  }
  return result;
}

py::dict measured_errors(const Controller& self) {
  const Session::Use use(*self.session);
  py::dict result;
  const auto& tasks = law(self).settings().tasks;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const int task = static_cast<int>(k);
    if (law(self).sensor(task) < 0) continue;
    result[effector_name(self, tasks[k]).c_str()] = law(self).measured_error(task);
  }
  return result;
}

py::dict sensors(const Controller& self) {
  py::dict result;
  const auto& tasks = law(self).settings().tasks;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const int sensor = law(self).sensor(static_cast<int>(k));
    if (sensor < 0) continue;
    result[effector_name(self, tasks[k]).c_str()] =
        sense::sensors_of(self.session->model())[static_cast<std::size_t>(sensor)].name;
  }
  return result;
}

std::vector<std::string> actuator_names(const Controller& self) {
  std::vector<std::string> names;
  for (const int index : law(self).settings().actuators) {
    names.push_back(self.session->model().actuators()[static_cast<std::size_t>(index)].name);
  }
  return names;
}

void bind_mapping(py::module_& module) {
  py::class_<Targets>(
      module, "Targets",
      "Targets of a controller's effectors; a live mapping from names. Assign three numbers "
      "(m) or a Target at any time between steps.")
      .def("__getitem__", &get_target, py::arg("name"))
      .def("__setitem__", &set_target, py::arg("name"), py::arg("target"))
      .def("__contains__", [](const Targets& self,
                              const py::object& name) { return target_names(self).contains(name); })
      .def("__len__", [](const Targets& self) { return target_names(self).size(); })
      .def("__iter__", [](const Targets& self) { return py::iter(target_names(self)); })
      .def("keys", &target_names, "keys($self)\n--\n\nNames of the effectors, as a list.")
      .def("__repr__", [](const Targets& self) {
        std::string text;
        for (const auto& name : target_names(self)) {
          text += fmt::format("{}'{}': {}", text.empty() ? "" : ", ", std::string(py::str(name)),
                              std::string(py::repr(get_target(self, py::str(name)))));
        }
        return "{" + text + "}";
      });
}

constexpr const char* kControllerDoc =
    R"(InverseController(sim, targets={}, *, actuators=None, weights=None, regularisation='change', epsilon=None, tolerance=None, largest_step=None, contacts=None, priorities=None, certify=False)
--

Inverse controller: chooses the actuator efforts that bring effectors to their targets.

Minimises 1/2 |W_ea effort + delta_e - target|^2 + eps/2 (effort - last)^T W_aa (effort - last)
in every step, within the actuators' limits on effort, stroke and rate. The controller owns its
actuators until it is detached by detach(), by Simulation.detach() or at the end of a `with` block.
Deleting the Python object does not detach it.

Parameters
----------
sim : Simulation
targets : dict
    Targets by name of the effector: (3,) array_like (m; for an orientation effector the rotation
    vector, rad), or a Circle, Polyline or Trajectory.
actuators : list of str, optional
    Actuators to use (default: all). The others follow their commands.
weights : dict, optional
    Weight of each effector, or one weight per direction; >= 0.
regularisation : {'change', 'effort'}
    Whether to minimise the change of efforts or the efforts themselves among equally good
    solutions. 'effort' biases the effector.
epsilon : float, optional
    Weight of the regularisation relative to the objective, > 0.
tolerance : float, optional
    Distance below which an effector is on target, m (or rad).
largest_step : float, optional
    Largest motion per step towards a target, as a fraction of the robot's size.
contacts : dict, optional
    Tasks on contact forces by name of the contact, with priority over targets: `normal_force`, a
    number (N) or {'min': N, 'max': N} for the sum over the contact's points; `slip`, False keeps the
    resultant within the friction cone; `reserve`, the fraction by which the cone is reduced.
priorities : dict, optional
    Priority of each effector, from 1 (highest, the default) to 3. The error of an effector disturbs
    those of the next higher priority by about 1e-4 of itself.
certify : bool, optional
    Whether to compute a `certificate` of every solution, which takes longer than the solution.

Raises
------
Error
    actuator-owned while another controller is attached, unknown-name, no-effectors, wrong-shape,
    not-finite, out-of-range; suspicious-unit for a target more than a hundred robot sizes away.
)";

void bind_methods(py::class_<Controller>& type) {
  type.def(py::init(&make), py::arg("sim"), py::arg("targets") = py::dict(), py::kw_only(),
           py::arg("actuators") = py::none(), py::arg("weights") = py::none(),
           py::arg("regularisation") = "change", py::arg("epsilon") = py::none(),
           py::arg("tolerance") = py::none(), py::arg("largest_step") = py::none(),
           py::arg("contacts") = py::none(), py::arg("priorities") = py::none(),
           py::arg("certify") = false, "See help(sinew.InverseController).")
      .def(
          "step",
          [](const Controller& self, const py::object& n) {
            require_attached(self);
            self.session->advance(to_count(n, "step(n)"));
            return std::string(controller_status_name(law(self).status()));
          },
          py::arg("n") = 1,
          R"(step($self, n=1)
--

Solves for the efforts and advances the simulation, n times.

Returns
-------
str
    The status of the last step, see `status`.

Raises
------
RunError
    As Simulation.step().
)")
      .def(
          "detach",
          [](const Controller& self) {
            if (self.attached->attached) self.session->detach(*self.attached);
          },
          R"(detach($self)
--

Releases the actuators. Each holds its present displacement until it gets another command.
)")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](const Controller& self, const py::args&) {
        if (self.attached->attached) self.session->detach(*self.attached);
      });
}

template <typename Get>
auto guarded(Get get) {
  return [get](const Controller& self) {
    const Session::Use use(*self.session);
    return get(law(self));
  };
}

// Only an inverse controller has requirements on forces, predictions and certificates.
const InverseController* as_inverse(const TargetController& law) {
  return dynamic_cast<const InverseController*>(&law);
}

void bind_results(py::class_<Controller>& type) {
  type.def_property_readonly(
          "status", guarded([](const TargetController& law) {
            return std::string(controller_status_name(law.status()));
          }),
          "str: status of the last step: 'not-started'; 'on-target', within the "
          "tolerance and as predicted; 'moving', on the way; 'rate-limited', on "
          "the way at rate limits; 'out-of-reach', at rest as near as limits "
          "allow; 'local-optimum', at rest where no small change of efforts "
          "reduces the error, although no limit is active; 'held-back', at rest because "
          "larger steps failed; 'limits-conflict', see `conflict`. A closed loop judges "
          "'on-target' by its samples, and "
          "is 'at-limits' if limits prevent motion, 'holding' while a sensor is "
          "silent.")
      .def_property_readonly(
          "conflict", guarded([](const TargetController& law) { return law.conflict(); }),
          "str: with 'limits-conflict', which limits of which actuators contradict each other; "
          "with 'holding', which sensors are silent; else empty.")
      .def_property_readonly(
          "efforts", guarded([](const TargetController& law) { return reading(law.efforts()); }),
          "(k,) ndarray: latest efforts (N), for a closed loop the present ones, in the order of "
          "`actuators`. A copy.")
      .def_property_readonly("actuators", &actuator_names,
                             "list of str: names of the owned actuators.")
      .def_property_readonly(
          "error", guarded([](const TargetController& law) { return law.error(); }),
          "float: largest present distance of an effector from its target (m or rad), along "
          "directions with nonzero weight; also available before the first step.")
      .def_property_readonly("errors", &errors, "dict: `error` of every effector.")
      .def_property_readonly("measured_errors", &measured_errors,
                             "dict: for a closed loop, the error of every effector by the latest "
                             "sample of its sensor, NaN before the first; else empty.")
      .def_property_readonly("sensors", &sensors,
                             "dict: for a closed loop, the sensor of every effector; else empty.")
      .def_property_readonly("force_errors", guarded([](const TargetController& law) {
                               py::dict errors;
                               const InverseController* inverse = as_inverse(law);
                               if (inverse == nullptr) return errors;
                               const auto& tasks = inverse->own_settings().contacts;
                               for (std::size_t k = 0; k < tasks.size(); ++k) {
                                 const auto& model = law.simulation().model();
                                 errors[py::str(model.contact(tasks[k].contact).name())] =
                                     inverse->force_error(static_cast<int>(k));
                               }
                               return errors;
                             }),
                             "dict: violation of the force task of every contact in `contacts` "
                             "(N); NaN before the first step.")
      .def_property_readonly(
          "certificate", guarded([](const TargetController& law) -> py::object {
            const InverseController* inverse = as_inverse(law);
            if (inverse == nullptr || !inverse->certificate()) return py::none();
            const auto& found = inverse->certificate();
            py::dict all;
            all["violation"] = found->violation;
            all["stays"] = found->stays;
            all["cold"] = found->cold;
            all["between"] = found->between;
            all["pieces"] = found->pieces;
            all["stationarity"] = std::string(law::stationarity_name(found->stationarity));
            all["best_nearby"] = found->best_nearby;
            return all;
          }),
          "dict or None: with `certify`, a certificate of the last choice, for its linearisation: "
          "`violation` (m) of all laws; `stays` and `cold` (m), the largest change of a motion "
          "when the forward problem is solved again from the choice, and from zero forces; "
          "`between`, the number of contacts, cables or drives at the limit between two states; "
          "`stationarity`, 'S', 'M', 'C', 'W' or 'none', by the multipliers on these; "
          "`best_nearby`, whether no neighbouring piece is better: because of 'S', or because all "
          "`pieces` (2^between) were compared.")
      .def_property_readonly(
          "predicted_error", guarded([](const TargetController& law) {
            const InverseController* inverse = as_inverse(law);
            return inverse == nullptr ? std::numeric_limits<double>::quiet_NaN()
                                      : inverse->predicted_error();
          }),
          "float: error predicted by the last linearisation (m or rad), over all effectors; NaN "
          "before a step.")
      .def_property_readonly(
          "attached", [](const Controller& self) { return self.attached->attached; },
          "bool: whether it still owns its actuators.")
      .def_property_readonly(
          "name", [](const Controller& self) { return self.attached->name; },
          "str: name in the scene; empty for a controller made in Python.")
      .def_property(
          "targets", [](const Controller& self) { return Targets{self}; },
          [](const Controller& self, const py::object& targets) {
            for (const auto& [key, value] : to_dict(targets, "targets")) {
              set_target({self}, text_key(key, "targets"),
                         py::reinterpret_borrow<py::object>(value));
            }
          },
          "Targets of the effectors; assign `ik.targets['tip'] = [0.03, 0, 0.18]` between steps.")
      .def("__repr__", [](const Controller& self) {
        return fmt::format("<sinew.InverseController of {} actuators, {}>",
                           law(self).settings().actuators.size(),
                           self.attached->attached ? controller_status_name(law(self).status())
                                                   : std::string_view("detached"));
      });
}

}  // namespace

void bind_controller(py::module_& module) {
  bind_mapping(module);
  py::class_<Controller> type(module, "InverseController", kControllerDoc);
  bind_methods(type);
  bind_results(type);
}

}  // namespace sinew::python
