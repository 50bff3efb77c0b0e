/// @file
/// What this library is and how it was compiled, for `--version`, records and benchmark reports.
#pragma once

#include <string>
#include <string_view>

namespace sinew {

/// "0.1.0", as in CMakeLists.txt.
std::string_view version();

/// The compiler and its version: "GCC 12.2.0".
std::string_view compiler();

/// The widest vector instructions that the compiler was allowed to use: "AVX-512", "AVX2", "AVX",
/// "SSE4.2", "SSE2" or "other".
std::string_view instruction_set();

/// The processor's name as the system gives it, or "unknown processor".
std::string processor();

}  // namespace sinew
