// For any input, the surface reader and the checks of solids return or throw an Error; see
// CMakeLists.txt. An input begins with the file type (stl, obj, ply) and a zero byte.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "sinew/core/error.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/surface.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHead = 4;
  if (size < kHead) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const sinew::mesh::Surface surface = sinew::mesh::parse_surface(
        bytes.substr(kHead), std::string(bytes.substr(0, kHead - 1)), "fuzz");
    static_cast<void>(sinew::mesh::solid_moments(surface));
    sinew::mesh::require_solid(surface);
  } catch (const sinew::Error&) {
    // Expected for invalid input.
  }
  return 0;
}
