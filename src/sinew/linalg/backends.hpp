/// @file
/// Functions that make the plans for analyse(), one per backend.
#pragma once

#include <memory>

#include "sinew/linalg/factorisation.hpp"

namespace sinew::linalg {

using PlanPointer = std::shared_ptr<const FactorisationPlan>;

/// Sinew's own bordered supernodal factorisation L S L^T of 3x3 blocks.
PlanPointer make_block_plan(const BlockPattern& pattern, const BorderPattern& border,
                            const FactorisationSettings& settings);

}  // namespace sinew::linalg
