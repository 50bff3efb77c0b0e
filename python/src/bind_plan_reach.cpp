// Static reach of constant-curvature arms: sampling, nearest equilibrium, out-of-reach proofs.
#include <string>

#include "sinew/plan/reach.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"
#include "plan_limits.hpp"

namespace sinew::python {

void bind_plan_reach(py::module_& module) {
  module.def(
      "plan_sample_reach",
      [](const PccArm& arm, const py::object& torque_limits, int samples, std::uint64_t seed,
         const py::object& angle_limits) {
        const plan::ArmLimits limits = to_limits(*arm.arm, torque_limits, angle_limits);
        const plan::ReachMap map = plan::sample_reach(arm.arm, limits, samples, seed);
        py::dict result;
        result["tip"] = copy(map.tip);
        result["theta"] = copy(map.position);
        result["torque"] = copy(map.torque);
        return result;
      },
      py::arg("arm"), py::arg("torque_limits"), py::arg("samples") = 1000, py::arg("seed") = 1,
      py::kw_only(), py::arg("angle_limits") = py::none(),
      R"(plan_sample_reach(arm, torque_limits, samples=1000, seed=1, *, angle_limits=None)
--

Samples the static workspace of the tip: stable equilibria under random torques within the limits.

Parameters
----------
arm : sinew.pcc.Arm
torque_limits : (inputs,) or (2, inputs) N m
samples : int
    Number of torques, each with two starts.
seed : int
angle_limits : (coordinates,) or (2, coordinates) rad, optional

Returns
-------
dict
    "tip" (found, 3) m, "theta" (found, coordinates) rad, "torque" (found, inputs) N m.)");
  module.def(
      "plan_nearest_reach",
      [](const PccArm& arm, const py::object& torque_limits, const py::object& goal, int starts,
         std::uint64_t seed, const py::object& angle_limits) {
        const plan::ArmLimits limits = to_limits(*arm.arm, torque_limits, angle_limits);
        const auto best = plan::nearest_reach(
            arm.arm, limits, to_vector3(goal, "nearest_reach(goal)", "m"), starts, seed);
        py::dict result;
        result["found"] = best.found;
        result["stable"] = best.stable;
        result["distance"] = best.distance;
        result["tip"] = copy(best.tip);
        result["theta"] = copy(best.position);
        result["torque"] = copy(best.torque);
        result["solved"] = best.solved;
        return result;
      },
      py::arg("arm"), py::arg("torque_limits"), py::arg("goal"), py::arg("starts") = 20,
      py::arg("seed") = 1, py::kw_only(), py::arg("angle_limits") = py::none(),
      R"(plan_nearest_reach(arm, torque_limits, goal, starts=20, seed=1, *, angle_limits=None)
--

The equilibrium, stable or not, whose tip is nearest to a goal (3,) m: the best of many starts.

Returns
-------
dict
    "found", "stable", "distance" m, "tip" (3,) m, "theta", "torque", and "solved", the number of
    starts that led to an equilibrium.)");
  module.def(
      "plan_prove_out_of_reach",
      [](const PccArm& arm, const py::object& torque_limits, const py::object& goal,
         double tolerance, double angle, long max_boxes, const py::object& angle_limits) {
        const plan::ArmLimits limits = to_limits(*arm.arm, torque_limits, angle_limits);
        const Vector3 at = to_vector3(goal, "prove_out_of_reach(goal)", "m");
        const auto proof =
            plan::prove_out_of_reach(arm.arm, limits, at, {tolerance, angle, max_boxes});
        py::dict result;
        result["verdict"] = std::string(plan::verdict_name(proof.verdict));
        result["boxes"] = proof.boxes;
        result["smallest"] = proof.smallest;
        result["theta"] = copy(proof.position);
        return result;
      },
      py::arg("arm"), py::arg("torque_limits"), py::arg("goal"), py::kw_only(),
      py::arg("tolerance") = 0.02, py::arg("angle") = plan::ReachProofSettings{}.angle,
      py::arg("max_boxes") = plan::ReachProofSettings{}.max_boxes,
      py::arg("angle_limits") = py::none(),
      R"(plan_prove_out_of_reach(arm, torque_limits, goal, *, tolerance=0.02, angle=3.141592653589793, max_boxes=5000000, angle_limits=None)
--

Proves by branch and bound over the angles whether any equilibrium, stable or not, has its tip within
`tolerance` (m, along each axis) of a goal (3,) m.

Parameters
----------
arm : sinew.pcc.Arm
    With planar segments.
torque_limits : (inputs,) or (2, inputs) N m
goal : (3,) m
tolerance : float
angle : float
    Largest bend of a segment in both directions, rad, if `angle_limits` are not given.
max_boxes : int
angle_limits : (coordinates,) or (2, coordinates) rad, optional

Returns
-------
dict
    "verdict" ('out-of-reach', 'reachable' or 'undecided'), "boxes" examined, "smallest" half-width
    needed in rad, "theta" of an equilibrium found there.)");
}

}  // namespace sinew::python
