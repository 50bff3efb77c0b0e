/// @file
/// Version and build of the library, for `--version`, records and benchmark reports.
#pragma once

#include <string>
#include <string_view>

namespace sinew {

/// The version in CMakeLists.txt, such as "0.1.0".
std::string_view version();

/// The compiler and its version, such as "GCC 12.2.0".
std::string_view compiler();

/// The widest vector instructions that the compiler was allowed to use: "AVX-512", "AVX2", "AVX",
/// "SSE4.2", "SSE2" or "other".
std::string_view instruction_set();

/// The name of the processor from the operating system, or "unknown processor".
std::string processor();

}  // namespace sinew
