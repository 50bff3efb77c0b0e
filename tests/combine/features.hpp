/// @file
/// Features of scenes and their levels, derived from the scene grammar: a new word of the grammar
/// joins the tested combinations automatically.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::combine {

/// A feature of a scene with its levels, that is its variants or "none".
struct Feature {
  std::string name;
  std::vector<std::string> levels;
};

/// All features; built at the first call.
const std::vector<Feature>& features();

/// (features,) index of the chosen level of each feature.
using Selection = std::vector<int>;

/// The chosen level of a feature. Throws std::logic_error for an unknown feature.
const std::string& level(const Selection& selection, std::string_view feature);

/// Selections that cover every compatible pair of levels of two features at least once: most
/// combination defects involve two features (Kuhn, Wallace & Gallo, IEEE Trans. Software Eng.
/// 30(6), 2004). Greedy, as AETG (Cohen, Dalal, Fredman & Patton, IEEE Trans. Software Eng. 23(7),
/// 1997); the same selections in every run.
std::vector<Selection> pairwise_cover();

/// Whether this version rejects a selection because of a pair of its levels.
bool is_refused(const Selection& selection);

/// Random levels; each feature is absent in about half of the selections.
Selection random_selection(std::uint64_t seed);

}  // namespace sinew::combine
