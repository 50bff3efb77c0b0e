#include "sinew/core/process.hpp"

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew {
namespace {

TEST(Process, ReportsCodeOutputAndMissingPrograms) {
  const ProcessResult result = run_program({"/bin/sh", "-c", "echo out; echo err >&2; exit 3"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.output, "out\nerr\n");
  try {
    run_program({"no-such-program-of-ours"});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::tool_missing) << error.what();
  }
  EXPECT_FALSE(program_exists("no-such-program-of-ours"));
  EXPECT_TRUE(program_exists("sh"));
  EXPECT_EQ(last_lines("a\nb\nc\n\n", 2), "b\nc");
  EXPECT_EQ(last_lines("a", 5), "a");
  EXPECT_EQ(last_lines("\n", 5), "");
}

}  // namespace
}  // namespace sinew
