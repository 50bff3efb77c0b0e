/// @file
/// The makers of plans behind `analyse`, one a backend.
#pragma once

#include <memory>

#include "sinew/linalg/factorisation.hpp"

namespace sinew::linalg {

using PlanPointer = std::shared_ptr<const FactorisationPlan>;

/// Our bordered supernodal factorisation L S L^T of 3x3 blocks.
PlanPointer make_block_plan(const BlockPattern& pattern, const BorderPattern& border,
                            const FactorisationSettings& settings);

/// Eigen's SimplicialLDLT, as a reference; unlike ours, its solves allocate.
PlanPointer make_eigen_ldlt_plan(const BlockPattern& pattern, const BorderPattern& border,
                                 const FactorisationSettings& settings);

/// Eigen's SimplicialLLT, as a reference; reports indefinite matrices as singular.
PlanPointer make_eigen_llt_plan(const BlockPattern& pattern, const BorderPattern& border,
                                const FactorisationSettings& settings);

}  // namespace sinew::linalg
