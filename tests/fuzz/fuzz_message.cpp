// For any message from a browser the parser returns or throws an Error; see CMakeLists.txt.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "sinew/core/error.hpp"

#include "viewer/message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    static_cast<void>(sinew::viewer::parse_message({reinterpret_cast<const char*>(data), size}));
  } catch (const sinew::Error&) {
    // Expected for an invalid message.
  }
  return 0;
}
