/// @file
/// Words of other programs and of the field for what scenes call otherwise.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sinew::scene {

/// The word of `known` that means what `word` means elsewhere: 'cable' for "tendon", 'tet10' for
/// "C3D10"; empty if there is none. Capitals, '-', '_' and blanks do not count.
/// @param word as written. @param known the keys or words that are allowed there.
std::string word_for(std::string_view word, const std::vector<std::string>& known);

}  // namespace sinew::scene
