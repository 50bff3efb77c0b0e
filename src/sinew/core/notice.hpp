/// @file
/// Remarks and warnings, which do not stop a run. Wrong input is an Error, never a notice.
#pragma once

#include <string>
#include <string_view>

#include "sinew/core/error.hpp"

namespace sinew {

/// Subject of a notice. The kebab-case name (notice_kind_name()) is part of the interface.
enum class NoticeKind {
  locking_element,  ///< the elements make the body much stiffer than its material
  bare_points,      ///< a cable pulls at single points, which dents the material
  unused_element,   ///< a file contains something that this version does not use
  coarse_contact,   ///< a round surface is smaller than the faces between the nodes that touch it
  other_tangent,    ///< the materials of the scene do not have the requested tangent
  loose_part,       ///< elements of a mesh are joined to the others by a node or an edge only
  suspicious_unit,  ///< a number without a unit is far from those of robots
  slack_cable,      ///< a cable with a commanded displacement was slack in all steps of a run
  bowstring,        ///< a cable ran straight between two points of a body that bent
  unstable_law,     ///< a material loses its stability at strains of robots
  strain_range,     ///< the strains of a run are not those at which its material was tested
  renamed_word,     ///< a key of the scene has another name now
};

/// Where a notice is shown.
enum class NoticeLevel {
  remark,  ///< follows from an explicit choice of the scene; `info` and the view show it
  /// Follows from a default, or the scene does not get what it asks for; `run`, `bench` and load()
  /// in Python print it, too.
  warning,
};

/// Printed name of a kind, such as "locking-element".
std::string_view notice_kind_name(NoticeKind kind);
/// "remark", "warning".
std::string_view notice_level_name(NoticeLevel level);

/// One remark or warning.
struct Notice {
  NoticeLevel level = NoticeLevel::warning;
  NoticeKind kind = NoticeKind::locking_element;
  Location place;
  std::string message;  ///< with the offending value
  std::string remedy;   ///< what to write or do instead

  /// "PLACE: MESSAGE; REMEDY [kind]", like Error::what().
  std::string text() const;
};

}  // namespace sinew
