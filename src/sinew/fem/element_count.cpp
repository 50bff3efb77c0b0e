#include "sinew/fem/element_count.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/fem/solid_elements.hpp"

namespace sinew::fem {

namespace {

int count_in_patches(const FemModel& model) {
  std::ptrdiff_t count = 0;
  for (const SolidGroup& group : model.solids()) {
    if (group.patches.empty()) continue;
    count += std::ranges::count_if(group.element, [](std::int32_t e) { return e >= 0; });
  }
  return static_cast<int>(count);
}

}  // namespace

std::vector<ElementCount> count_elements(const FemModel& model) {
  const mesh::Mesh& mesh = model.mesh();
  const auto tetrahedra = static_cast<int>(mesh.tetrahedra.size());
  const int patches = count_in_patches(model);
  std::vector<ElementCount> result = {
      {mesh.quadratic.empty() ? "tet4" : "tet10", tetrahedra - patches},
      {"tet4-patch", patches},
      {"hex8", static_cast<int>(mesh.hexahedra.size())}};
  std::erase_if(result, [](const ElementCount& kind) { return kind.count == 0; });
  return result;
}

std::string describe_elements(const FemModel& model) {
  std::vector<std::string> parts;
  for (const auto& [element, count] : count_elements(model)) {
    parts.push_back(fmt::format("{} {}", count, element));
  }
  return fmt::format("{} elements", fmt::join(parts, " and "));
}

}  // namespace sinew::fem
