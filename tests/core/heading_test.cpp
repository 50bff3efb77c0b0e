#include "sinew/core/heading.hpp"

#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"

namespace sinew {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Heading, HasANameAndAUnit) {
  struct Case {
    const char* text;
    const char* name;
    std::optional<std::string> unit;
  };
  const Case cases[] = {{"x [mm]", "x", "mm"},
                        {"x[mm]", "x", "mm"},
                        {" tip.x ( N s/m ) ", "tip.x", "N s/m"},
                        {"stress (true) [MPa]", "stress (true)", "MPa"},
                        {"x [mm] filtered", "x filtered", "mm"},
                        {"x []", "x", ""},
                        {"x", "x", std::nullopt},
                        {"x_mm", "x_mm", std::nullopt},
                        {"]x[", "]x[", std::nullopt},
                        {"[s]", "", "s"}};
  for (const auto& [text, name, unit] : cases) {
    const Heading heading = parse_heading(text);
    EXPECT_EQ(heading.name, name) << text;
    EXPECT_EQ(heading.unit, unit) << text;
  }
}

std::optional<double> unit(const std::string& heading, Dimension expected) {
  return heading_unit(parse_csv("time," + heading + "\n0,1\n", "a.csv"), 1, expected);
}

TEST(HeadingUnit, IsThatInBracketsOrTheLastWord) {
  EXPECT_EQ(unit("x [mm]", dimension::kLength), 1e-3);
  EXPECT_EQ(unit("x (mm)", dimension::kLength), 1e-3);
  EXPECT_EQ(unit("x_mm", dimension::kLength), 1e-3);
  EXPECT_EQ(unit("x mm", dimension::kLength), 1e-3);
  EXPECT_EQ(unit("pressure_kPa", dimension::kPressure), 1e3);
  EXPECT_EQ(unit("p/kPa", dimension::kPressure), 1e3);
  EXPECT_EQ(unit("v_m/s", dimension::kVelocity), 1.0);
  EXPECT_EQ(unit("x [in]", dimension::kLength), 0.0254);
  EXPECT_EQ(unit("duty [%]", dimension::kNone), 0.01);
  EXPECT_EQ(unit("strain [-]", dimension::kNone), 1.0);
  for (const char* none : {"x", "mm", "tip_x", "x []", "motor_0", "pull_in", "a/b"}) {
    EXPECT_EQ(unit(none, dimension::kLength), std::nullopt) << none;
  }
  // The last word of a name is a unit only where it fits.
  EXPECT_EQ(unit("joint_N", dimension::kLength), std::nullopt);
  EXPECT_EQ(heading_unit(parse_csv("0,1\n", "a.csv"), 1, dimension::kLength), std::nullopt);
}

TEST(HeadingUnit, RefusesWhatIsNoUnitOfTheColumn) {
  const auto error = [](const char* heading, Dimension expected) {
    try {
      unit(heading, expected);
    } catch (const Error& caught) {
      EXPECT_EQ(caught.place().file, "a.csv") << heading;
      EXPECT_EQ(caught.place().line, 1) << heading;
      EXPECT_EQ(caught.place().column, 6) << heading;
      EXPECT_THAT(caught.what(), HasSubstr(heading));
      EXPECT_FALSE(caught.remedy().empty()) << heading;
      return caught.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(error("x [furlong]", dimension::kLength), ErrorKind::unknown_unit);
  EXPECT_EQ(error("p (kpa)", dimension::kPressure), ErrorKind::unknown_unit);
  EXPECT_EQ(error("x [N]", dimension::kLength), ErrorKind::wrong_dimension);
  EXPECT_EQ(error("f [Hz]", dimension::kForce), ErrorKind::wrong_dimension);
  EXPECT_EQ(error("factor [N]", dimension::kNone), ErrorKind::wrong_dimension);
  EXPECT_EQ(error("x [-]", dimension::kLength), ErrorKind::unknown_unit);
}

// numpy.savetxt() writes its header as a comment.
TEST(HeadingUnit, IsReadFromACommentAboveTheRows) {
  for (const char* text :
       {"# time [ms],x [mm]\n0,5\n", "# made today\n#time [ms],x [mm]\n0,5\n",
        "# time [ms] x [mm]\n0 5\n", "time [ms] x [mm]\n0 5\n", "# time (ms);x (mm)\n\n0;5\n"}) {
    const Table table = parse_csv(text, "a.csv");
    EXPECT_EQ(table.names.size(), 2u) << text;
    EXPECT_EQ(heading_unit(table, 0, dimension::kTime), 1e-3) << text;
    EXPECT_EQ(heading_unit(table, 1, dimension::kLength), 1e-3) << text;
  }
  for (const char* text :
       {"# x in mm\n0,5\n", "# in mm, by hand\n0,5\n", "# a [mm]\n0,5\n",
        "# it is 5\" [mm],\n0,5\n", "# by (me), today\n0,5\n", "# [mm],\n0,5\n"}) {
    EXPECT_TRUE(parse_csv(text, "a.csv").names.empty()) << text;
  }
  EXPECT_THAT(parse_csv("# a [m],b [m]\ntime [ms],x [mm]\n0,5\n", "a.csv").names,
              ElementsAre("time [ms]", "x [mm]"));
}

}  // namespace
}  // namespace sinew
