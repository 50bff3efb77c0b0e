/// @file
/// Features of scenes, and how each can be present: read off the scene grammar, so that a word
/// that joins the grammar joins the combinations that are tested.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::combine {

/// Something that a scene can have, and its levels: the ways it can have it, or "none".
struct Feature {
  std::string name;
  std::vector<std::string> levels;
};

/// All features. Built at the first call.
const std::vector<Feature>& features();

/// (features,) A level of each feature.
using Selection = std::vector<int>;

/// The level that a selection has of a feature. Throws std::logic_error for an unknown feature.
const std::string& level(const Selection& selection, std::string_view feature);

/// Selections in which every pair of levels of two features that this version takes together occurs
/// together at least once: most
/// defects of combinations need two features (Kuhn, Wallace & Gallo, IEEE Trans. Software Eng.
/// 30(6), 2004). Greedy, as AETG (Cohen, Dalal, Fredman & Patton, IEEE Trans. Software Eng. 23(7),
/// 1997); the same selections in every run.
std::vector<Selection> pairwise_cover();

/// Whether this version refuses a selection for a pair of its levels.
bool is_refused(const Selection& selection);

/// Levels drawn at random, each feature absent in about half of all.
Selection random_selection(std::uint64_t seed);

}  // namespace sinew::combine
