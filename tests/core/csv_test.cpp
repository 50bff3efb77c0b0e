#include "sinew/core/csv.hpp"

#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace sinew {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) /
         ("sinew_csv_" + std::to_string(getpid()) + "_" + name);
}

MatrixX two_by_three() { return (MatrixX(2, 3) << 1, 2, 3, 4, 5, 6.5).finished(); }

class SameTable : public ::testing::TestWithParam<const char*> {};

TEST_P(SameTable, InEverySpelling) {
  EXPECT_EQ(parse_csv(GetParam(), "table.csv").values, two_by_three()) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Spellings, SameTable,
                         ::testing::Values("1,2,3\n4,5,6.5\n", "1,2,3\n4,5,6.5",
                                           "1,2,3\r\n4,5,6.5\r\n", "1;2;3\n4;5;6.5",
                                           "1 2 3\n4 5 6.5", "  1\t2   3  \n4 5 6.5",
                                           "\xEF\xBB\xBF"
                                           "1,2,3\n4,5,6.5",
                                           "x,y,z\n1,2,3\n4,5,6.5", "x y z\n1 2 3\n4 5 6.5",
                                           "\"x [mm]\", \"y, y\",z\n1,2,3\n4,5,6.5",
                                           "# note\n\n1,2,3 # first\n4,5,6.5\n#",
                                           "+1, 2 ,3e0\n4,0.5e1,65e-1", "1,2,3\r4,5,6.5\r"));

TEST(Csv, KeepsNamesAndLines) {
  const Table table = parse_csv("# t in s\ntime, \"tip, x\"\n0,1\n\n1,2\n", "table.csv");
  EXPECT_THAT(table.names, ElementsAre("time", "tip, x"));
  EXPECT_THAT(table.lines, ElementsAre(3, 5));
  EXPECT_EQ(table.column("tip, x"), 1);
  try {
    table.column("tim");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::wrong_columns);
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'time'?"));
  }
  EXPECT_THROW(parse_csv("1,2", "table.csv").column("time"), Error);
}

struct BadTable {
  std::string text;
  ErrorKind kind;
  const char* place;
  int columns = 0;
};

class BadTables : public ::testing::TestWithParam<BadTable> {};

TEST_P(BadTables, AreRefusedWithTheirPlace) {
  try {
    parse_csv(GetParam().text, "table.csv", {.columns = GetParam().columns});
    FAIL() << "accepted: " << GetParam().text;
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(GetParam().kind)) << error.what();
    EXPECT_EQ(error.place().text(), GetParam().place) << error.what();
    EXPECT_FALSE(error.remedy().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadTables,
    ::testing::Values(BadTable{"", ErrorKind::malformed_table, "table.csv"},
                      BadTable{"\n\n# nothing\n", ErrorKind::malformed_table, "table.csv"},
                      BadTable{"x,y\n", ErrorKind::malformed_table, "table.csv"},
                      BadTable{"1,2\n3,four\n", ErrorKind::malformed_table, "table.csv:2:3"},
                      BadTable{"1,two\n", ErrorKind::malformed_table, "table.csv:1:3"},
                      BadTable{"x,y\nz,w\n1,2\n", ErrorKind::malformed_table, "table.csv:2:1"},
                      BadTable{"1,,3\n", ErrorKind::malformed_table, "table.csv:1:3"},
                      BadTable{"1,2,\n", ErrorKind::malformed_table, "table.csv:1:5"},
                      BadTable{"1;2,5\n", ErrorKind::malformed_table, "table.csv:1:3"},
                      BadTable{"1,0x10\n", ErrorKind::malformed_table, "table.csv:1:3"},
                      BadTable{"1,1e5x\n", ErrorKind::malformed_table, "table.csv:1:3"},
                      BadTable{"1,+-2\n", ErrorKind::malformed_table, "table.csv:1:3"},
                      BadTable{"1,2\n3\n", ErrorKind::wrong_columns, "table.csv:2:1"},
                      BadTable{"1,2\n3,4,5\n", ErrorKind::wrong_columns, "table.csv:2:5"},
                      BadTable{"x,y,z\n1,2\n", ErrorKind::wrong_columns, "table.csv:2:3"},
                      BadTable{"1,2\n", ErrorKind::wrong_columns, "table.csv:1:3", 3},
                      BadTable{"x,y\n1,2\n", ErrorKind::wrong_columns, "table.csv:1:3", 3},
                      BadTable{"1,nan\n", ErrorKind::not_finite, "table.csv:1:3"},
                      BadTable{"1,-inf\n", ErrorKind::not_finite, "table.csv:1:3"},
                      BadTable{"1,1e999\n", ErrorKind::not_finite, "table.csv:1:3"},
                      BadTable{"\xEF\xBB\xBF"
                               "1,b\n",
                               ErrorKind::malformed_table, "table.csv:1:6"},
                      BadTable{"\xFF\xFE"
                               "1",
                               ErrorKind::bad_encoding, "table.csv"},
                      BadTable{std::string("1,2\n\0,4\n", 8), ErrorKind::bad_encoding, "table.csv"},
                      BadTable{"\"1,2\n3,4\n", ErrorKind::malformed_table, "table.csv:1:1"}));

TEST(Csv, AcceptsNonFiniteNumbersOnRequest) {
  const Table table = parse_csv("nan,inf\n1,2\n", "table.csv", {.allow_non_finite = true});
  EXPECT_TRUE(std::isnan(table.values(0, 0)));
  EXPECT_TRUE(std::isinf(table.values(0, 1)));
}

TEST(Csv, RefusesFilesThatAreMissingOrTooLarge) {
  const auto kind_of = [](const std::filesystem::path& path, CsvSettings settings = {}) {
    try {
      read_csv(path, settings);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of(scratch("none.csv")), ErrorKind::file_not_found);
  EXPECT_EQ(kind_of(::testing::TempDir()), ErrorKind::file_unreadable);
  std::ofstream(scratch("large.csv")) << "1,2,3\n";
  EXPECT_EQ(kind_of(scratch("large.csv"), {.max_bytes = 5}), ErrorKind::size_limit);
  EXPECT_EQ(read_csv(scratch("large.csv")).values.cols(), 3);
}

TEST(Csv, NeverCrashesOnMutations) {
  const std::string good = "# a\n\"x\",y;z\n1,2\n3,4e5\r\n-5,.6\n";
  std::uint64_t state = 7;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = good;
    for (int change = 0; change < 3; ++change) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      text[(state >> 33) % text.size()] = "0,;\"#\n\r \tex-+.\xEF"[(state >> 20) % 15];
    }
    try {
      const Table table = parse_csv(text, "table.csv");
      ASSERT_GT(table.values.size(), 0);
      ASSERT_TRUE(table.values.allFinite());
      ASSERT_EQ(static_cast<Eigen::Index>(table.lines.size()), table.values.rows());
    } catch (const Error& error) {
      ASSERT_FALSE(error.remedy().empty());
    }
  }
}

TEST(CsvWriter, WritesRowsThatReadBackBitForBit) {
  const std::vector<std::string> names = {"time", "tip, x", "effort"};
  const auto path = scratch("written.csv");
  CsvWriter writer(path, names);
  writer.write_row(std::vector{0.1, -1.0 / 3.0, 1e-310});
  EXPECT_EQ(read_csv(path).values.rows(), 1);  // the writer is still open
  writer.write_row(std::vector{0.2, 5e300, -0.0});
  const Table table = read_csv(path);
  EXPECT_EQ(table.names, names);
  EXPECT_EQ(table.values, (MatrixX(2, 3) << 0.1, -1.0 / 3.0, 1e-310, 0.2, 5e300, -0.0).finished());
  writer.write_row(std::vector{kNan, 0.0, 0.0});
  EXPECT_EQ(read_csv(path, {.allow_non_finite = true}).values.rows(), 3);
}

TEST(CsvWriter, RefusesWhatItCannotWrite) {
  const std::vector<std::string> names = {"a", "b"};
  const auto kind_of = [](auto&& call) {
    try {
      call();
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of([&] { CsvWriter(scratch("no/such/folder.csv"), names); }),
            ErrorKind::file_unwritable);
  CsvWriter writer(scratch("short.csv"), names);
  EXPECT_EQ(kind_of([&] { writer.write_row(std::vector{1.0}); }), ErrorKind::wrong_columns);
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_EQ(kind_of([&] { CsvWriter("/dev/full", names); }), ErrorKind::recording_failed);
  }
}

}  // namespace
}  // namespace sinew
