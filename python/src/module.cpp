/// @file
/// The extension module sinew._core, which the package in python/sinew uses.
#include <string>

#include "sinew/core/build_info.hpp"

#include "bindings.hpp"
#include "errors.hpp"

PYBIND11_MODULE(_core, module) {
  namespace python = sinew::python;
  // Signatures come from the first line of the docstrings, in Python syntax.
  pybind11::options options;
  options.disable_function_signatures();

  module.doc() = "The compiled part of sinew; import sinew instead.";
  module.attr("__version__") = std::string(sinew::version());
  module.attr("compiler") = std::string(sinew::compiler());
  module.attr("instruction_set") = std::string(sinew::instruction_set());
  python::register_errors();
  python::bind_signals(module);
  python::bind_targets(module);
  python::bind_reports(module);
  python::bind_linear_model(module);
  python::bind_parameters(module);
  python::bind_mesh(module);
  python::bind_actuator(module);
  python::bind_effector(module);
  python::bind_load(module);
  python::bind_mass(module);
  python::bind_probe(module);
  python::bind_sensor(module);
  python::bind_estimator(module);
  python::bind_state(module);
  python::bind_contact(module);
  python::bind_joint(module);
  python::bind_body(module);
  python::bind_response(module);
  python::bind_simulation(module);
  python::bind_batch(module);
  python::bind_controller(module);
  python::bind_high_rate(module);
  python::bind_view(module);
  python::bind_material(module);
  python::bind_pcc(module);
  python::bind_bending(module);
  python::bind_bending_fit(module);
  python::bind_drive(module);
  python::bind_qp(module);
  python::bind_quadratic(module);
  python::bind_quantity(module);
  python::bind_collision(module);
#ifdef SINEW_HAS_PLAN
  python::bind_plan(module);
  python::bind_plan_reach(module);
  python::bind_brace(module);
  python::bind_plan_drive(module);
#endif
#ifdef SINEW_HAS_IDENTIFY
  python::bind_identify(module);
  python::bind_identify_arm(module);
  python::bind_identify_material(module);
#endif
}
