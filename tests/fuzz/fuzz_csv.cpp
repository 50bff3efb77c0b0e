// For any input the reader returns or throws an Error; see CMakeLists.txt.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "sinew/core/csv.hpp"
#include "sinew/core/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    static_cast<void>(sinew::parse_csv(bytes, "fuzz"));
  } catch (const sinew::Error&) {
    // Expected for invalid input.
  }
  return 0;
}
