/// @file
/// In statics something has to hold every body: fixed nodes of its own, or welds to bodies that
/// are held.
#pragma once

#include <vector>

#include "sinew/core/error.hpp"

namespace sinew::sim {

struct ModelData;

/// Which bodies of a model under construction are held by themselves.
class BodyHolding {
 public:
  /// The next body. @param held by itself. @param place where it is written.
  void add(bool held, const Place& place);

  /// Anchors the bodies that welds alone hold. Throws Error(nothing-fixed) in statics for one that
  /// nothing holds.
  void hold(ModelData& data) const;

 private:
  std::vector<char> held_;     // (bodies,)
  std::vector<Place> places_;  // (bodies,)
};

}  // namespace sinew::sim
