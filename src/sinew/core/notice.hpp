/// @file
/// Something that a user should know, and that stops nothing: what a warning says. Wrong input is
/// an Error, never a notice.
#pragma once

#include <string>
#include <string_view>

#include "sinew/core/error.hpp"

namespace sinew {

/// What a notice is about. The kebab-case name (notice_kind_name()) is part of the interface.
enum class NoticeKind {
  locking_element,  ///< the elements make the body much stiffer than its material
  bare_points,      ///< a cable pulls at single points, which dent the material
  unused_element,   ///< a file holds what this version does not do
  coarse_contact,   ///< a round surface is smaller than the faces between the nodes that touch it
  other_tangent,    ///< the tangent that the scene asks for is none of its materials
};

/// Who has to see it.
enum class NoticeLevel {
  remark,  ///< it follows from what the scene says in so many words: `info` and the view show it
  /// It follows from a default, or the scene does not get what it asks for: `run`, `bench` and
  /// Python's load() print it, too.
  warning,
};

/// The kind as it is printed: "locking-element".
std::string_view notice_kind_name(NoticeKind kind);
/// "remark", "warning".
std::string_view notice_level_name(NoticeLevel level);

/// See the file.
struct Notice {
  NoticeLevel level = NoticeLevel::warning;
  NoticeKind kind = NoticeKind::locking_element;
  Location place;
  std::string message;  ///< names the offending value
  std::string remedy;   ///< what to write or do instead

  /// "PLACE: MESSAGE; REMEDY [kind]", as Error::what().
  std::string text() const;
};

}  // namespace sinew
