#include <fmt/format.h>

#include "sinew/core/rotation.hpp"
#include "sinew/fem/assembly.hpp"
#include "sinew/fem/body_elements.hpp"
#include "sinew/fem/element_count.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/fem/of_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/self_touch.hpp"
#include "sinew/model/model.hpp"
#include "sinew/pcc/has_arm.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

mechanics::Body& body(const Body& self) { return self.session->simulation().body(self.index); }
const std::string& name(const Body& self) { return body(self).model().name(); }
const fem::HasElements& model(const Body& self) {
  return fem::of_elements<const fem::HasMaterial>(body(self)).material();
}
const fem::FemModel& elements(const Body& self) { return model(self).elements(); }
Points& external_forces(const Body& self) {
  return fem::of_elements<mechanics::TakesForces>(body(self)).external_forces();
}
const mechanics::HasCoordinates& arm(const Body& self) {
  const auto* found = mechanics::as<const mechanics::HasCoordinates>(body(self));
  if (found == nullptr) {
    throw Error(ErrorKind::wrong_type, {.item = fmt::format("body('{}')", name(self))},
                "this body is not a constant-curvature arm", "read its positions instead");
  }
  return *found;
}

const mechanics::HasPose& rigid(const Body& self, const char* what) {
  const auto* found = mechanics::as<const mechanics::HasPose>(body(self));
  if (found == nullptr) {
    throw Error(ErrorKind::wrong_type, {.item = fmt::format("body('{}').{}", name(self), what)},
                "this body is not rigid", "read its positions, or declare an effector on it");
  }
  return *found;
}

const mechanics::HasShape* shape(const Body& self) {
  return mechanics::as<const mechanics::HasShape>(body(self).model());
}

py::array points_view(const Body& self, const Points& points, bool writable = false) {
  // Bodies with few coordinates compute their points on demand, so there is no array for a live
  // view.
  const bool few = mechanics::as<const mechanics::HasCoordinates>(body(self)) != nullptr ||
                   mechanics::as<const mechanics::HasPose>(body(self)) != nullptr;
  if (few) return reading(points);
  return view(points.data(), points.rows(), 3, py::cast(self.session), writable);
}

void set_external_forces(const Body& self, const py::object& value) {
  const Points forces = to_points(value, fmt::format("body('{}').external_forces", name(self)), "N",
                                  external_forces(self).rows());
  const Session::Use use(*self.session);
  external_forces(self) = forces;
}

double stiffness_factor(const Body& self) {
  return fem::of_elements<const fem::HasMaterial>(body(self)).stiffness_factor();
}

void set_stiffness_factor(const Body& self, double factor) {
  const Session::Use use(*self.session);
  self.session->simulation().set_stiffness_factor(self.index, factor);
}

Points positions_from(const Body& self, const py::object& positions, const char* what) {
  const Points& now = fem::of_elements<const fem::HasMaterial>(body(self)).positions();
  if (positions.is_none()) return now;
  return to_points(positions, fmt::format("body('{}').{}(positions)", name(self), what), "m",
                   now.rows());
}

// Expands internal forces on free nodes to one row per node.
Array internal_forces(const Body& self, const py::object& positions) {
  const Session::Use use(*self.session);
  const Points at = positions_from(self, positions, "internal_forces");
  ThreadPool pool;
  fem::Assembly assembly(model(self).shared_elements(), pool);
  assembly.evaluate(at, {fem::Tangent::none, 1.0, 0.0, true, stiffness_factor(self)});
  Points forces = Points::Zero(at.rows(), 3);
  const auto nodes = elements(self).free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      forces(nodes[i], c) = assembly.forces()[3 * i + static_cast<std::size_t>(c)];
    }
  }
  return reading(forces);
}

// Converts the stored lower blocks to a full matrix in scipy's block compressed row format.
py::object stiffness(const Body& self, const py::object& positions, const std::string& tangent) {
  const fem::Tangent chosen = fem::element_tangent(to_tangent(tangent, "stiffness(tangent)"));
  const Session::Use use(*self.session);
  const Points at = positions_from(self, positions, "stiffness");
  ThreadPool pool;
  fem::Assembly assembly(model(self).shared_elements(), pool);
  assembly.evaluate(at, {chosen, 1.0, 0.0, true, stiffness_factor(self)});
  const auto& pattern = elements(self).pattern();
  const auto matrix = std::as_const(assembly).matrix();
  std::vector<double> values;
  std::vector<std::int32_t> rows, columns;
  const auto add = [&](int block, int i, int j, bool transposed) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const int at_entry = linalg::kBlockStride * block + (transposed ? 4 * r + c : 4 * c + r);
        values.push_back(matrix[static_cast<std::size_t>(at_entry)]);
        rows.push_back(3 * i + r);
        columns.push_back(3 * j + c);
      }
    }
  };
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (auto b = pattern.column_start[column]; b < pattern.column_start[column + 1]; ++b) {
      const auto i = pattern.row[static_cast<std::size_t>(b)];
      add(b, i, j, false);
      if (i != j) add(b, j, i, true);
    }
  }
  const auto size = 3 * pattern.nodes;
  const auto make = py::module_::import("scipy.sparse").attr("csr_matrix");
  const auto triples =
      py::make_tuple(py::array(py::cast(values)),
                     py::make_tuple(py::array(py::cast(rows)), py::array(py::cast(columns))));
  return make(triples, py::arg("shape") = py::make_tuple(size, size));
}

// Jacobian H: a displacement dx_i of node i moves row k by H[k, i] . dx_i.
Array jacobian(const Body& self) {
  const Session::Use use(*self.session);
  const auto& directions = self.session->simulation().world().rows().direction;
  const auto& pattern = self.session->model().rows();
  const auto nodes = elements(self).mesh().nodes.rows();
  const auto& own = *mechanics::as<const mechanics::MovesByNodes>(body(self).model());
  Array result({static_cast<Eigen::Index>(pattern.rows()), nodes, Eigen::Index{3}});
  auto h = result.mutable_unchecked<3>();
  std::fill_n(result.mutable_data(), result.size(), 0.0);
  for (int k = 0; k < pattern.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    for (auto e = pattern.row_start[row]; e < pattern.row_start[row + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      const auto& site = pattern.site[entry];
      if (site.body != self.index) continue;
      const auto& attachment = own.attachment(site.number);
      for (std::size_t a = 0; a < attachment.nodes.size(); ++a) {
        for (int c = 0; c < 3; ++c) {
          h(k, attachment.nodes[a], c) += attachment.weights[a] * directions[entry][c];
        }
      }
    }
  }
  return result;
}

py::array_t<bool> fixed(const Body& self) {
  const auto free = elements(self).free_index();
  py::array_t<bool> mask(static_cast<py::ssize_t>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i) {
    mask.mutable_at(static_cast<py::ssize_t>(i)) = free[i] < 0;
  }
  return read_only(mask);
}

void move_base(const Body& self, const py::object& translation, const py::object& rotation,
               const py::object& centre) {
  const auto read = [](const py::object& value, const char* what) -> Vector3 {
    const Array numbers = to_array(value, what, "(3,)");
    if (numbers.size() != 3) {
      throw Error(ErrorKind::wrong_shape, {.item = what},
                  fmt::format("{} numbers where three belong", numbers.size()), "give x, y and z");
    }
    return {numbers.data()[0], numbers.data()[1], numbers.data()[2]};
  };
  const Vector3 shift = read(translation, "move_base(translation)");
  const Vector3 turn = read(rotation, "move_base(rotation)");
  const Vector3 about = read(centre, "move_base(centre)");
  const Session::Use use(*self.session);
  self.session->simulation().move_base(self.index, shift, turn, about);
}

void bind_state(py::class_<Body>& type) {
  type.def(
      "move_base", &move_base, py::arg("translation") = py::make_tuple(0.0, 0.0, 0.0),
      py::arg("rotation") = py::make_tuple(0.0, 0.0, 0.0),
      py::arg("centre") = py::make_tuple(0.0, 0.0, 0.0),
      R"(move_base($self, translation=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0), centre=(0.0, 0.0, 0.0))
--

Moves the fixed nodes in the next step: a rotation about `centre`, then a translation, both relative to rest.
Like a command, it is an input: reset() moves the base back, and a saved state contains where the base was.

Parameters
----------
translation : (3,) array_like
    m.
rotation : (3,) array_like
    Rotation vector, rad.
centre : (3,) array_like
    m, at rest.

Raises
------
Error
    bad-argument if the scene moves this base by `motion`; nothing-fixed; not-finite.
)");
  type.def_property_readonly(
          "positions", [](const Body& self) { return points_view(self, body(self).positions()); },
          R"((n, 3) ndarray: present positions of all nodes, in the mesh's order (m). If a mesh of linear
tetrahedra was made quadratic, its own nodes come first and the mid-edge nodes after them.

A live, read-only view: it follows every later step, keeps the simulation alive, and must not be read
while another thread steps. Copy it to keep a moment: `body.positions.copy()`.)")
      .def_property_readonly(
          "coordinates",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(arm(self).coordinates());
          },
          "(coordinates,) ndarray: angles of a constant-curvature arm (rad; extensions m).")
      .def_property_readonly(
          "rates",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(arm(self).rates());
          },
          "(coordinates,) ndarray: rates of the coordinates (rad/s).")
      .def_property_readonly(
          "arm",
          [](const Body& self) {
            arm(self);  // throws if the body is not an arm
            const auto& own = *mechanics::as<const pcc::HasArm>(body(self).model());
            return std::make_unique<PccArm>(own.shared_arm());
          },
          "sinew.pcc.Arm: model of a constant-curvature body.")
      .def_property_readonly(
          "velocities", [](const Body& self) { return points_view(self, body(self).velocities()); },
          "(n, 3) ndarray: velocities of all nodes (m/s); zero in quasi-static runs. A live, "
          "read-only view.")
      .def_property(
          "external_forces",
          [](const Body& self) { return points_view(self, external_forces(self), true); },
          &set_external_forces,
          R"((n, 3) ndarray: dead loads on the nodes in addition to gravity (N).

A live, writable view: `body.external_forces[5] = [0, 0, -0.1]` acts from the next step on. The forces
stay until changed; reset() sets them to zero. Forces on fixed nodes have no effect.)")
      .def_property(
          "stiffness_factor", &stiffness_factor, &set_stiffness_factor,
          R"(float: factor of all moduli of the elements, above 0; 1 is the scene's material.

It multiplies the stresses at a given strain, and with them stiffness damping, of the material and of all
parts; membranes keep theirs. It acts from the next step on and stays until changed; reset() sets it to 1.
If the body is strained, its strain energy changes at once, which counts as outside work in the ledger.
Raises Error: wrong-type for a body that is not of type fem, out-of-range.)");
}

void bind_loads_of(py::class_<Body>& type) {
  type.def(
          "self_touch",
          [](const Body& self, double apart) -> py::object {
            const Session::Use use(*self.session);
            const mesh::Mesh& own = elements(self).mesh();
            const auto found = mesh::SelfTouch(own).find(body(self).positions(), apart);
            if (!found) return py::none();
            return py::make_tuple(found->node, found->element);
          },
          py::arg("apart") = 0.0, R"(self_touch($self, apart=0.0)
--

Whether the body penetrates itself: None, or (node, element) of the first surface node that
lies in an element to which it does not belong. Crossing edges are not detected; a contact
`between: [body, body]` prevents both. Parts closer than `apart` (m) at rest are not checked,
such as the dent around a point load.
)")
      .def_property_readonly(
          "load_forces",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(fem::of_elements<fem::HasMaterial>(body(self)).load_forces());
          },
          "(n, 3) ndarray: forces of the scene's loads on all nodes of a finite-element body (N) "
          "in the last step.")
      .def_property_readonly(
          "load_force",
          [](const Body& self) {
            const Session::Use use(*self.session);
            const auto* loaded = mechanics::as<mechanics::TakesLoads>(body(self));
            return reading(loaded == nullptr ? Vector3(Vector3::Zero()) : loaded->load_force());
          },
          "(3,) ndarray: sum of the forces of the scene's loads on it (N) in the last step.")
      .def_property_readonly(
          "load_moment",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(rigid(self, "load_moment").load_moment());
          },
          "(3,) ndarray: moment of the scene's loads on a rigid body about its centre of mass in "
          "the last step (N m). Raises as `position`.");
}

// Element nodes (m, k), with k nodes each.
template <std::size_t k>
auto numbers_view(const Body& self, const std::vector<std::array<NodeId, k>>& list) {
  return view<NodeId>(list.empty() ? nullptr : list.front().data(),
                      static_cast<py::ssize_t>(list.size()), static_cast<py::ssize_t>(k),
                      py::cast(self.session));
}

void bind_mesh_of(py::class_<Body>& type) {
  type.def_property_readonly(
          "rest_positions",
          [](const Body& self) { return points_view(self, body(self).model().mesh().nodes); },
          "(n, 3) ndarray: positions of all nodes at rest (m). Read-only.")
      .def_property_readonly(
          "tetrahedra",
          [](const Body& self) { return numbers_view(self, body(self).model().mesh().tetrahedra); },
          "(m, 4) ndarray of int32: the nodes of every tetrahedron, positively oriented. "
          "Read-only.")
      .def_property_readonly(
          "quadratic_tetrahedra",
          [](const Body& self) { return numbers_view(self, body(self).model().mesh().quadratic); },
          "(m, 10) ndarray of int32: corners and mid-edge nodes of quadratic tetrahedra, in VTK's "
          "order; `tetrahedra` has their corners. Read-only.")
      .def_property_readonly(
          "hexahedra",
          [](const Body& self) { return numbers_view(self, body(self).model().mesh().hexahedra); },
          "(m, 8) ndarray of int32: the nodes of every hexahedron, in VTK's order. Read-only.")
      .def_property_readonly(
          "triangles",
          [](const Body& self) { return numbers_view(self, body(self).model().mesh().triangles); },
          "(m, 3) ndarray of int32: nodes of the triangles of its mesh, if it has any: the whole "
          "surface of a rigid body from a file. Read-only.")
      .def_property_readonly(
          "elements",
          [](const Body& self) {
            py::dict result;
            for (const auto& [element, count] : fem::count_elements(elements(self))) {
              result[py::str(std::string(element))] = count;
            }
            return result;
          },
          "dict: number of elements by kind, as {'tet10': 2639}; kinds are those of scenes.")
      .def_property_readonly(
          "fixed", &fixed,
          "(n,) ndarray of bool: nodes that do not move: fixed nodes and nodes that belong to no "
          "element.")
      .def_property_readonly(
          "node_sets", [](const Body& self) { return body(self).model().mesh().node_sets; },
          "dict: named sets of nodes of the mesh.")
      .def_property_readonly(
          "mass",
          [](const Body& self) {
            return shape(self) != nullptr ? shape(self)->mass() : elements(self).total_mass();
          },
          "float: total mass (kg).")
      .def_property_readonly(
          "node_masses", [](const Body& self) { return reading(elements(self).lumped_mass()); },
          "(n,) ndarray: mass lumped at every node (kg).")
      .def_property_readonly(
          "volume", [](const Body& self) { return elements(self).volume(); },
          "float: volume at rest (m^3).");
}

auto energy(double mechanics::Energies::*part) {
  return [part](const Body& self) {
    const Session::Use use(*self.session);
    return body(self).energies().*part;
  };
}

void bind_mechanics(py::class_<Body>& type) {
  type.def_property_readonly(
          "strain_energy", energy(&mechanics::Energies::strain),
          "float: present strain energy (J), without the relaxing branches of viscoelastic "
          "materials and with the energy dissipated by softening; 0 for rigid bodies.")
      .def_property_readonly("kinetic_energy", energy(&mechanics::Energies::kinetic),
                             "float: present kinetic energy (J).")
      .def_property_readonly("gravity_energy", energy(&mechanics::Energies::gravity),
                             "float: gravity energy relative to rest (J).")
      .def("internal_forces", &internal_forces, py::arg("positions") = py::none(),
           R"(internal_forces($self, positions=None)
--

Elastic nodal forces f(q) = dU/dq; at equilibrium f = external + gravity + H^T effort.

Parameters
----------
positions : (n, 3) array_like, optional
    m; the present ones by default. The simulation is not changed.

Returns
-------
(n, 3) ndarray
    N; zero at nodes that do not move.
)")
      .def("stiffness", &stiffness, py::arg("positions") = py::none(), py::kw_only(),
           py::arg("tangent") = "exact",
           R"(stiffness($self, positions=None, *, tangent='exact')
--

Stiffness of the elements, df/dq, over free nodes, without that of the cables.

Parameters
----------
positions : (n, 3) array_like, optional
    m; the present ones by default. The simulation is not changed.
tangent : {'exact', 'projected', 'corotated'}
    The derivative of the forces; its projection that is positive semi-definite element by element; or
    R K0 R^T with the rotations held fixed.

Returns
-------
scipy.sparse.csr_matrix
    (3 f, 3 f), N/m, for the f nodes with `~body.fixed` in order.
)")
      .def("jacobian", &jacobian,
           R"(jacobian($self)
--

H at the present state: derivative of the motion of every row with respect to the nodes.

Returns
-------
(rows, n, 3) ndarray
    d(delta)/dx, dimensionless (1/m in rows of orientations); rows as `Simulation.rows`. The
    forces of the actuators on the nodes are `np.einsum('k,knc->nc', effort, H)`.
)");
}

// Binds members of rigid bodies.
void bind_pose(py::class_<Body>& type) {
  type.def_property_readonly(
          "position",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(rigid(self, "position").origin());
          },
          "(3,) ndarray: position of a rigid body's frame (m). Raises Error(wrong-type) for "
          "deformable bodies.")
      .def_property_readonly(
          "rotation",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(VectorX(unit_quaternion(rigid(self, "rotation").axes())));
          },
          "(4,) ndarray: rotation of its frame, a unit quaternion w, x, y, z with w >= 0. Raises "
          "as `position`.")
      .def_property_readonly(
          "velocity",
          [](const Body& self) {
            const Session::Use use(*self.session);
            const mechanics::HasPose& own = rigid(self, "velocity");
            VectorX both(6);
            both << own.linear_velocity(), own.angular_velocity();
            return reading(both);
          },
          "(6,) ndarray: velocity of its centre of mass (m/s), then angular velocity in world axes "
          "(rad/s). Raises as `position`.")
      .def_property_readonly(
          "centre_of_mass",
          [](const Body& self) {
            const Session::Use use(*self.session);
            return reading(rigid(self, "centre_of_mass").centre_of_mass());
          },
          "(3,) ndarray: position of its centre of mass (m). Raises as `position`.")
      .def_property_readonly(
          "inertia",
          [](const Body& self) {
            rigid(self, "inertia");
            return reading(Points(shape(self)->own_inertia()));
          },
          "(3, 3) ndarray: inertia about the centre of mass, in the axes of its frame (kg m^2). "
          "Raises as `position`.");
}

}  // namespace

void bind_body(py::module_& module) {
  py::class_<Body> type(
      module, "Body",
      "A body: finite elements, rigid, or a constant-curvature arm. From Simulation.body().");
  type.def_property_readonly(
          "name", [](const Body& self) { return name(self); }, "str: name in the scene.")
      .def("__repr__", [](const Body& self) {
        if (shape(self) != nullptr) {
          return fmt::format("<sinew.Body '{}', rigid {}>", name(self), shape(self)->shape_name());
        }
        const mesh::Mesh& mesh = body(self).model().mesh();
        return fmt::format("<sinew.Body '{}', {} nodes, {} elements>", name(self),
                           mesh.nodes.rows(), mesh.tetrahedra.size() + mesh.hexahedra.size());
      });
  bind_state(type);
  bind_pose(type);
  bind_fields(module, type);
  bind_loads_of(type);
  bind_mesh_of(type);
  bind_mechanics(type);
}

}  // namespace sinew::python
