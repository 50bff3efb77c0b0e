/// @file
/// One include for robots that are built and simulated in C++: meshes, materials, bodies,
/// actuators, contacts, the simulation and its inverse controller.
///
/// Not included, because they pull in files, formats or optional dependencies:
/// scene files (sinew/scene/build.hpp), records of runs (sinew/record/run_recorder.hpp), both in
/// the target sinew::sinew; identification (sinew/identify/..., target sinew::identify) and
/// planning (sinew/plan/..., target sinew::plan).
#pragma once

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/inverse/controller_observables.hpp"
#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/inverse/target.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/mesh/write_mesh.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/bending_motion.hpp"
#include "sinew/qp/quadratic_program.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/cable_settings.hpp"
#include "sinew/sim/chamber_settings.hpp"
#include "sinew/sim/contact_settings.hpp"
#include "sinew/sim/contact_state.hpp"
#include "sinew/sim/effector_settings.hpp"
#include "sinew/sim/force_settings.hpp"
#include "sinew/sim/inputs.hpp"
#include "sinew/sim/joint_settings.hpp"
#include "sinew/sim/linearisation.hpp"
#include "sinew/sim/load_settings.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/model_builder.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/probe_settings.hpp"
#include "sinew/sim/signal.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/spring_line_settings.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/state_io.hpp"
#include "sinew/sim/torque_settings.hpp"
