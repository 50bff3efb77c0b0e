/// @file
/// All of Sinew's public interface in one include.
#pragma once

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/qp/quadratic_program.hpp"
