#include "sinew/material/instability.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sinew::material {

std::string instability(const Hyperelastic& law) {
  if (law.saint_venant_shear > 0.0) return "below 0.577 in uniaxial stretch";
  std::vector<std::string> modes;
  constexpr std::pair<DeformationMode, const char*> kModes[] = {
      {DeformationMode::uniaxial, "uniaxial"},
      {DeformationMode::equibiaxial, "equibiaxial"},
      {DeformationMode::planar, "planar"}};
  for (const auto& [mode, name] : kModes) {
    const auto [low, high] = stable_range(law, mode, kLeastStretch, kMostStretch);
    std::vector<std::string> ends;
    if (high < kMostStretch) ends.push_back(fmt::format("above {:.3g}", high));
    if (low > kLeastStretch) ends.push_back(fmt::format("below {:.3g}", low));
    if (ends.empty()) continue;
    modes.push_back(fmt::format("{} in {} stretch", fmt::join(ends, " and "), name));
  }
  return fmt::format("{}", fmt::join(modes, ", "));
}

}  // namespace sinew::material
