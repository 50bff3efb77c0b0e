/// @file
/// Place of results that programs keep from run to run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace sinew {

/// The user's folder of results that can be computed again: $XDG_CACHE_HOME/sinew or
/// $HOME/.cache/sinew (XDG Base Directory Specification 0.8); empty if neither variable is set.
/// It may be deleted at any time.
std::filesystem::path cache_folder();

/// The text that was kept under a name; none if there is none or it cannot be read.
/// @param name path below cache_folder(), made of the content that the result depends on.
std::optional<std::string> recall_result(const std::string& name);

/// Keeps a text for recall_result(), as far as possible: a cache that cannot be written is no
/// error.
/// @param name,text as for recall_result().
void keep_result(const std::string& name, std::string_view text);

}  // namespace sinew
