#include "sinew/pcc/published.hpp"

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

ArmSettings published_arm(MassCentre centre, const VectorX& lengths) {
  constexpr std::array masses{0.190, 0.146, 0.090, 0.090};
  const VectorX length = lengths.size() > 0 ? lengths : VectorX::Constant(4, 0.14);
  if (length.size() != 4) {
    throw Error(ErrorKind::wrong_length, {.item = "lengths"},
                fmt::format("{} lengths are given", length.size()), "give 4 or none");
  }
  const VectorX stiffness = channel_stiffness(0.108, length);
  ArmSettings settings;
  settings.name = "fluidic arm";
  settings.centre = centre;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    Segment& segment = settings.segments.emplace_back();
    segment.length = length[static_cast<Eigen::Index>(i)];
    segment.mass = masses[i];
    segment.stiffness = stiffness[static_cast<Eigen::Index>(i)];
    segment.damping = 4.2e-3;
  }
  return settings;
}

VectorX published_torque_limits() { return VectorX{{0.0, 0.12, 0.13, 0.18}}; }

}  // namespace sinew::pcc
