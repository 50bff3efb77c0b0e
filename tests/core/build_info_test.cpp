#include "sinew/core/build_info.hpp"

#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(BuildInfo, VersionIsTheOneOfTheBuildFile) {
  std::ifstream file(SINEW_SOURCE_DIR "/CMakeLists.txt");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string wanted = "project(sinew VERSION " + std::string(version()) + " ";
  EXPECT_NE(text.find(wanted), std::string::npos) << version();
}

TEST(BuildInfo, NamesWhatTheTestItselfWasCompiledWith) {
#ifdef __AVX512F__
  EXPECT_EQ(instruction_set(), "AVX-512");
#elif defined(__AVX2__)
  EXPECT_EQ(instruction_set(), "AVX2");
#elif defined(__SSE4_2__) && !defined(__AVX__)
  EXPECT_EQ(instruction_set(), "SSE4.2");
#endif
  EXPECT_NE(compiler().find_first_of("0123456789"), std::string_view::npos) << compiler();
  EXPECT_FALSE(processor().empty());
}

}  // namespace
}  // namespace sinew
