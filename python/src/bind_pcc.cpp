// Constant-curvature arms without a scene.
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/published.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"

namespace sinew::python {

namespace {

/// Vector (n,) from an array of that length, or from one number for all entries.
VectorX spread(const py::handle& value, const std::string& place, Eigen::Index n,
               const std::string& unit) {
  const Array array = to_array(value, place, fmt::format("({},) {}", n, unit));
  if (array.ndim() == 0) return VectorX::Constant(n, array.data()[0]);
  return to_vector(value, place, n, unit);
}

Vector3 to_gravity(const py::handle& value) {
  const Array array = to_array(value, "Arm(gravity)", "a magnitude or (3,) m/s^2");
  if (array.ndim() == 0) return {0.0, 0.0, -array.data()[0]};
  return to_vector3(value, "Arm(gravity)", "m/s^2");
}

std::unique_ptr<PccArm> make_arm(const py::object& lengths, const py::object& masses,
                                 const py::object& stiffness, const py::object& damping,
                                 const std::string& centre, const py::object& gravity,
                                 const py::object& gamma, const py::object& dead_lengths,
                                 const std::string& bending, const py::object& axial_stiffness,
                                 const py::object& axial_damping, const py::object& base,
                                 const py::object& actuation, int mass_points) {
  using pcc::Bending;
  using pcc::MassCentre;
  const std::vector<double> length = to_list(lengths, "Arm(lengths)", "m");
  const auto n = static_cast<Eigen::Index>(length.size());
  pcc::ArmSettings settings;
  settings.centre = choose<MassCentre>(centre, "Arm(centre)",
                                       {{"arc", MassCentre::arc},
                                        {"chord", MassCentre::chord},
                                        {"distributed", MassCentre::distributed}});
  settings.gravity = to_gravity(gravity);
  settings.base = to_vector3(base, "Arm(base)", "m");
  settings.mass_points = mass_points;
  const Bending kind = choose<Bending>(
      bending, "Arm(bending)", {{"planar", Bending::planar}, {"spatial", Bending::spatial}});
  const VectorX m = to_vector(masses, "Arm(masses)", n, "kg");
  const VectorX k = spread(stiffness, "Arm(stiffness)", n, "N m");
  const VectorX b = spread(damping, "Arm(damping)", n, "N m s");
  const VectorX turn = spread(gamma, "Arm(gamma)", n, "rad");
  const VectorX dead = spread(dead_lengths, "Arm(dead_lengths)", n, "m");
  const bool extensible = !axial_stiffness.is_none();
  VectorX ka, ba;
  if (extensible) {
    ka = spread(axial_stiffness, "Arm(axial_stiffness)", n, "N/m");
    ba = spread(axial_damping, "Arm(axial_damping)", n, "N s/m");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    pcc::Segment& segment = settings.segments.emplace_back();
    segment.length = length[static_cast<std::size_t>(i)];
    segment.mass = m[i];
    segment.stiffness = k[i];
    segment.damping = b[i];
    segment.gamma = turn[i];
    segment.dead_length = dead[i];
    segment.bending = kind;
    segment.extensible = extensible;
    if (extensible) {
      segment.axial_stiffness = ka[i];
      segment.axial_damping = ba[i];
    }
  }
  if (!actuation.is_none()) settings.actuation = to_matrix(actuation, "Arm(actuation)", "");
  return std::make_unique<PccArm>(std::make_shared<const pcc::Arm>(std::move(settings)));
}

std::unique_ptr<PccArm> published(const py::object& lengths, const std::string& centre) {
  using pcc::MassCentre;
  const auto where = choose<MassCentre>(centre, "published_arm(centre)",
                                        {{"arc", MassCentre::arc},
                                         {"chord", MassCentre::chord},
                                         {"distributed", MassCentre::distributed}});
  VectorX length;
  if (!lengths.is_none()) length = to_vector(lengths, "published_arm(lengths)", 4, "m");
  return std::make_unique<PccArm>(
      std::make_shared<const pcc::Arm>(pcc::published_arm(where, length)));
}

constexpr const char* kArmDoc =
    R"(Arm(lengths, masses, stiffness, damping, *, ...)

A soft arm of N segments of constant curvature, hanging along -z at rest; a positive angle bends
towards +x. Each segment has one angle as its coordinate; with ``bending="spatial"`` two (u towards x, v
towards y), with `axial_stiffness` also the extension e in m.

Parameters
----------
lengths, masses : (N,) m, kg
stiffness, damping : (N,) or float
    N m and N m s: torque ``-k theta - b theta_dot``.
centre : str
    Location of a segment's mass: "arc" (midpoint of the arc), "chord" (midpoint of the
    chord) or "distributed" (Gauss points along the arc).
gravity : float or (3,)
    m/s^2; a magnitude points along -z.
gamma : (N,) or float
    Rotation about the axis before each segment, rad.
dead_lengths : (N,) or float
    Rigid length before each bend, m.
bending : str
    "planar" or "spatial".
axial_stiffness, axial_damping : (N,) or float
    N/m and N s/m; makes spatial segments extensible.
base : (3,) m
actuation : (coordinates, inputs), optional
    B in the generalised forces B tau; the identity by default.
mass_points : int
    Gauss points per segment of distributed mass.

Raises
------
Error
    out-of-range, not-finite, wrong-shape, unknown-choice.)";

void bind_published(py::module_& module) {
  module.def("published_arm", &published, py::arg("lengths") = py::none(),
             py::arg("centre") = "arc",
             R"(published_arm(lengths=None, centre='arc')
--

The identified four-segment fluidic arm, with published masses, stiffness and damping. The lengths
(4,) m are not published; the default is 0.14 each. Returns an Arm.)");
  module.def(
      "published_torque_limits", [] { return copy(pcc::published_torque_limits()); },
      R"(published_torque_limits()
--

(4,) N m, torque limits of that arm in both directions; its first segment is not actuated.)");
}

void bind_stiffness(py::module_& module) {
  module.def(
      "channel_stiffness",
      [](double first, const py::object& lengths) {
        const std::vector<double> values = to_list(lengths, "channel_stiffness(lengths)", "m");
        return copy(pcc::channel_stiffness(
            first,
            Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()))));
      },
      py::arg("first"), py::arg("lengths"), R"(channel_stiffness(first, lengths)
--

(N,) N m: k_i = k_1 L_i / L_1, as published for fluidic segments with equal channels.)");
  module.def(
      "beam_stiffness",
      [](double bending, const py::object& lengths) {
        const std::vector<double> values = to_list(lengths, "beam_stiffness(lengths)", "m");
        return copy(pcc::beam_stiffness(
            bending,
            Eigen::Map<const VectorX>(values.data(), static_cast<Eigen::Index>(values.size()))));
      },
      py::arg("bending"), py::arg("lengths"), R"(beam_stiffness(bending, lengths)
--

(N,) N m: k_i = EI / L_i, with EI = `bending` in N m^2.)");
}

}  // namespace

void bind_pcc(py::module_& module) {
  PccArmClass arm(module, "Arm", kArmDoc);
  arm.def(py::init(&make_arm), py::arg("lengths"), py::arg("masses"), py::arg("stiffness"),
          py::arg("damping"), py::kw_only(), py::arg("centre") = "arc", py::arg("gravity") = 9.81,
          py::arg("gamma") = 0.0, py::arg("dead_lengths") = 0.0, py::arg("bending") = "planar",
          py::arg("axial_stiffness") = py::none(), py::arg("axial_damping") = 0.0,
          py::arg("base") = py::make_tuple(0.0, 0.0, 0.0), py::arg("actuation") = py::none(),
          py::arg("mass_points") = 3);
  bind_arm_equations(arm);
  bind_arm_simulation(arm);
  bind_published(module);
  bind_stiffness(module);
}

}  // namespace sinew::python
