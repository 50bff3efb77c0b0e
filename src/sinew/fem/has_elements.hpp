/// @file
/// Capability of finite-element body models, in addition to mechanics::BodyModel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace sinew::fem {

class FemModel;
struct FemBodySettings;

/// A body model that consists of finite elements: mechanics::as<HasElements>(model).
class HasElements {
 public:
  virtual ~HasElements() = default;
  virtual const FemModel& elements() const = 0;
  /// The same, for an Assembly, which shares ownership.
  virtual std::shared_ptr<const FemModel> shared_elements() const = 0;
  virtual const FemBodySettings& settings() const = 0;
  /// Attached point of a point mass, by its position in the settings.
  virtual int mass_point(std::size_t mass) const = 0;
};

}  // namespace sinew::fem
