/// @file
/// All of Sinew's public interface in one include.
#pragma once

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/fem/element_fields.hpp"
#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/inverse/target.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/mesh/write_mesh.hpp"
#include "sinew/pcc/bending_motion.hpp"
#include "sinew/qp/quadratic_program.hpp"
#include "sinew/sim/model_builder.hpp"
#include "sinew/sim/simulation.hpp"
