#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const model::ContactModel& model(const Contact& self) {
  return self.session->model().contacts()[static_cast<std::size_t>(self.index)];
}

// Only those that were found: the others have no place.
std::vector<contact::ContactPoint> points(const Contact& self) {
  const Session::Use use(*self.session);
  auto all = self.session->simulation().contacts().points(self.index);
  std::erase_if(all, [](const contact::ContactPoint& point) { return !point.is_measured(); });
  return all;
}

contact::ContactResultant sum(const Contact& self) {
  const Session::Use use(*self.session);
  return self.session->simulation().contacts().sum(self.index);
}

contact::ContactResultant resultant(const Contact& self) {
  const Session::Use use(*self.session);
  return self.session->simulation().contacts().resultant(self.index);
}

/// An array (n, 3) with one vector of every point.
Array vectors(const Contact& self, Vector3 contact::ContactPoint::*member) {
  const auto all = points(self);
  Points result(static_cast<Eigen::Index>(all.size()), 3);
  for (std::size_t k = 0; k < all.size(); ++k) {
    result.row(static_cast<Eigen::Index>(k)) = (all[k].*member).transpose();
  }
  return reading(result);
}

/// An array (n,) with one number of every point.
Array numbers(const Contact& self, double contact::ContactPoint::*member) {
  const auto all = points(self);
  VectorX result(static_cast<Eigen::Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    result[static_cast<Eigen::Index>(k)] = all[k].*member;
  }
  return reading(result);
}

py::list states(const Contact& self) {
  py::list result;
  for (const contact::ContactPoint& point : points(self)) {
    result.append(qp::contact_state_name(point.state));
  }
  return result;
}

/// The surface of the world, in the words of scenes; None between bodies.
py::object surface(const Contact& self) {
  const constraint::Contact& contact = self.session->model().contact(self.index);
  if (contact.other_body() >= 0) return py::none();
  const collision::Shape& shape = dynamic_cast<const constraint::ShapeContact&>(contact).surface();
  py::dict described, result;
  if (const auto* plane = std::get_if<constraint::Plane>(&shape)) {
    described["point"] = reading(plane->point);
    described["normal"] = reading(plane->normal);
    result["plane"] = described;
  } else if (const auto* sphere = std::get_if<constraint::Sphere>(&shape)) {
    described["centre"] = reading(sphere->centre);
    described["radius"] = sphere->radius;
    result["sphere"] = described;
  } else {
    const auto& capsule = std::get<constraint::Capsule>(shape);
    Points ends(2, 3);
    ends << capsule.from.transpose(), capsule.to.transpose();
    described["ends"] = reading(ends);
    described["radius"] = capsule.radius;
    result["capsule"] = described;
  }
  return result;
}

void bind_sums(py::class_<Contact>& type) {
  type.def_property_readonly(
          "force", [](const Contact& self) { return reading(sum(self).force); },
          "(3,) ndarray: force on the body in the last step, summed over all points (N).")
      .def_property_readonly(
          "normal_force", [](const Contact& self) { return sum(self).normal_force; },
          "float: sum of the points' normal forces (N), >= 0.")
      .def_property_readonly(
          "friction_force", [](const Contact& self) { return sum(self).friction_force; },
          "float: sum of the magnitudes of the points' friction forces (N).")
      .def_property_readonly(
          "gap", [](const Contact& self) { return resultant(self).smallest_gap; },
          "float: smallest gap (m), negative inside the surface. NaN between surfaces of meshes "
          "that are farther apart than the distance of the search: see `gap_above`.")
      .def_property_readonly(
          "gap_above", [](const Contact& self) { return resultant(self).gap_above; },
          "float: where `gap` is NaN, the searched distance (m): the gap is larger. Else NaN.");
}

void bind_points(py::class_<Contact>& type) {
  type.def_property_readonly(
          "positions",
          [](const Contact& self) { return vectors(self, &contact::ContactPoint::position); },
          "(n, 3) ndarray: present positions of the points that may touch (m). Where points are "
          "searched for in every step, those that the last one found; none before the first step.")
      .def_property_readonly(
          "gaps", [](const Contact& self) { return numbers(self, &contact::ContactPoint::gap); },
          "(n,) ndarray: distance of each of these points from the surface (m), negative inside.")
      .def_property_readonly(
          "normals",
          [](const Contact& self) { return vectors(self, &contact::ContactPoint::normal); },
          "(n, 3) ndarray: outward normals of the surface in the last step.")
      .def_property_readonly(
          "normal_forces",
          [](const Contact& self) { return numbers(self, &contact::ContactPoint::normal_force); },
          "(n,) ndarray: force on the body along the normal (N), >= 0.")
      .def_property_readonly(
          "friction_forces",
          [](const Contact& self) { return vectors(self, &contact::ContactPoint::friction_force); },
          "(n, 3) ndarray: force on the body along the surface (N).")
      .def_property_readonly("states", &states,
                             "list of str: 'open', 'stick' or 'slip' (friction at its limit) of "
                             "each of these points.");
}

}  // namespace

void bind_contact(py::module_& module) {
  py::class_<Contact> type(module, "Contact",
                           "Points of a body that may touch a surface. From Simulation.contact() "
                           "or Simulation.contacts.");
  type.def_property_readonly(
          "name", [](const Contact& self) { return model(self).name; }, "str: name in the scene.")
      .def_property_readonly(
          "bodies",
          [](const Contact& self) {
            return contact::touching_bodies(self.session->model(), self.index);
          },
          "list of str: the body on which `force` acts, and the body that it touches; a surface of "
          "the world has no name.")
      .def_property_readonly(
          "surface", &surface,
          "dict or None: the surface of the world that the body touches, where it is in the scene: "
          "{'plane': {'point': (3,), 'normal': (3,)}}, {'sphere': {'centre': (3,), 'radius': "
          "float}} "
          "or {'capsule': {'ends': (2, 3), 'radius': float}} (m). None if the contact is between "
          "bodies.")
      .def_property_readonly(
          "friction",
          [](const Contact& self) {
            return self.session->model().contact(self.index).friction().sticking;
          },
          "float: Coulomb's coefficient of static friction.")
      .def_property_readonly(
          "kinetic_friction",
          [](const Contact& self) {
            return self.session->model().contact(self.index).friction().sliding;
          },
          "float: Coulomb's coefficient of sliding points, by default the same.");
  bind_sums(type);
  bind_points(type);
  type.def("__repr__", [](const Contact& self) {
    return fmt::format("<sinew.Contact '{}', {} points>", model(self).name,
                       self.session->model().contact(self.index).size());
  });
}

}  // namespace sinew::python
