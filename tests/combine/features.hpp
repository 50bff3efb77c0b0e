/// @file
/// Features of scenes and their levels. They are read from the scene grammar, so that a new word of
/// the grammar joins the tested combinations.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::scene {
struct KeyTable;
}

namespace sinew::combine {

/// A feature of scenes. Its levels are the forms it can take, or "none".
struct Feature {
  std::string name;
  std::vector<std::string> levels;
};

/// All features; built at the first call.
const std::vector<Feature>& features();

/// The keys of the kind with a word in a section such as "bodies". Throws std::logic_error if there
/// is none.
const scene::KeyTable& variant_table(std::string_view section, std::string_view word);

/// A level of each feature, (features,).
using Selection = std::vector<int>;

/// The level of a feature in a selection. Throws std::logic_error for an unknown feature.
const std::string& level(const Selection& selection, std::string_view feature);

/// Changes the level of a feature. Throws std::logic_error for an unknown feature or level.
void set_level(Selection& selection, std::string_view feature, std::string_view wanted);

/// Selections in which every pair of levels of two features that this version accepts together
/// occurs at least once, since most defects of combinations need only two features (Kuhn, Wallace &
/// Gallo, IEEE Trans. Software Eng. 30(6), 2004). The algorithm is greedy, like AETG (Cohen, Dalal,
/// Fredman & Patton, IEEE Trans. Software Eng. 23(7), 1997), and gives the same selections in every
/// run.
std::vector<Selection> pairwise_cover();

/// Whether this version refuses a selection because of a pair of its levels.
bool is_refused(const Selection& selection);

/// A random selection, in which each feature is absent with a probability of about one half.
Selection random_selection(std::uint64_t seed);

}  // namespace sinew::combine
