/// @file
/// Points at which two facets touch.
#pragma once

#include "sinew/collision/facet.hpp"
#include "sinew/collision/touching_candidates.hpp"

namespace sinew::collision {

/// Two facets that face each other along a normal.
class FacetPair {
 public:
  /// All arguments must outlive this object. @param first,second of the two shapes; flat ones must
  /// not be seen edge-on.
  /// @param normal (3,) unit length, from the second towards the first.
  /// @param candidates the list to which clip_both() adds.
  FacetPair(const Facet& first, const Facet& second, const Vector3& normal,
            TouchingCandidates& candidates)
      : first_(first), second_(second), normal_(normal), candidates_(candidates) {}

  /// Adds the corners of the overlap of both facets. For two lines there are none. For a rim, these
  /// are its crossings with the border of the other facet, four points between them, and the lowest
  /// point.
  void clip_both();

 private:
  void add(const Vector3& point, int own_part, const Facet& other, int other_part, bool is_first);
  void add_if_over(const Vector3& point, int own_part, const Facet& other, bool is_first);
  void clip_border(const Facet& own, const Facet& other, bool is_first);
  void rim_points(const Facet& disc, const Facet& other, bool is_first);
  void rim_crossings(const Facet& disc, const Facet& other, bool is_first);
  Vector3 across_rim(const Facet& disc, const Facet& other) const;

  const Facet& first_;
  const Facet& second_;
  const Vector3& normal_;
  TouchingCandidates& candidates_;
};

}  // namespace sinew::collision
