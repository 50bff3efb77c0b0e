#include "sinew/core/notice.hpp"

#include <array>

#include <fmt/format.h>

namespace sinew {

std::string_view notice_kind_name(NoticeKind kind) {
  constexpr std::array<std::string_view, 12> kNames = {
      "locking-element", "bare-points",  "unused-element",  "coarse-contact",
      "other-tangent",   "loose-part",   "suspicious-unit", "slack-cable",
      "bowstring",       "unstable-law", "strain-range",    "renamed-word"};
  return kNames.at(static_cast<std::size_t>(kind));
}

std::string_view notice_level_name(NoticeLevel level) {
  return level == NoticeLevel::remark ? "remark" : "warning";
}

std::string Notice::text() const {
  std::string result = place.text();
  if (!result.empty()) result += ": ";
  result += message;
  if (!remedy.empty()) result += "; " + remedy;
  return result + fmt::format(" [{}]", notice_kind_name(kind));
}

}  // namespace sinew
