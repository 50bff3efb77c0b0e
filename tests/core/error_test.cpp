#include "sinew/core/error.hpp"

#include <cctype>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(ErrorKind, NamesAreUniqueKebabCase) {
  std::set<std::string_view> seen;
  for (int i = 0; i < error_kind_count(); ++i) {
    const std::string_view name = error_kind_name(static_cast<ErrorKind>(i));
    EXPECT_TRUE(seen.insert(name).second) << name;
    for (const char c : name) EXPECT_TRUE(std::islower(static_cast<unsigned char>(c)) || c == '-');
  }
}

TEST(ErrorKind, NamesStandBesideTheirKinds) {
  EXPECT_EQ(error_kind_name(ErrorKind::file_not_found), "file-not-found");
  EXPECT_EQ(error_kind_name(ErrorKind::wrong_dimension), "wrong-dimension");
  EXPECT_EQ(error_kind_name(ErrorKind::point_outside_mesh), "point-outside-mesh");
  EXPECT_EQ(error_kind_name(ErrorKind::malformed_table), "malformed-table");
  EXPECT_EQ(error_kind_name(ErrorKind::diverged), "diverged");
  EXPECT_EQ(error_kind_name(ErrorKind::wrong_shape), "wrong-shape");
  EXPECT_EQ(error_kind_name(ErrorKind::internal), "internal");
}

TEST(Location, LeavesOutWhatIsUnknown) {
  EXPECT_EQ(Location{}.text(), "");
  EXPECT_EQ((Location{.file = "a.yaml"}).text(), "a.yaml");
  EXPECT_EQ((Location{.file = "a.yaml", .line = 3}).text(), "a.yaml:3");
  EXPECT_EQ((Location{.file = "a.yaml", .line = 3, .column = 5, .item = "mass"}).text(),
            "a.yaml:3:5: mass");
  EXPECT_EQ((Location{.item = "mass"}).text(), "mass");
}

TEST(Error, SaysPlaceMessageRemedyAndKind) {
  const Error error(ErrorKind::unknown_key, {.file = "a.yaml", .line = 2, .column = 1},
                    "there is no key 'mas'", "did you mean 'mass'?");
  EXPECT_STREQ(error.what(),
               "a.yaml:2:1: there is no key 'mas'; did you mean 'mass'? [unknown-key]");
  EXPECT_STREQ(Error(ErrorKind::internal, {}, "broken").what(), "broken [internal]");
}

TEST(Error, TakesOnTheOuterPlaceWhereItsOwnIsUnknown) {
  const Error inner(ErrorKind::not_a_number, {.item = "mass"}, "'x' is not a number");
  const Error outer = inner.at({.file = "a.yaml", .line = 4, .column = 2, .item = "bodies"});
  EXPECT_EQ(outer.place().text(), "a.yaml:4:2: mass");
  EXPECT_EQ(outer.kind(), ErrorKind::not_a_number);
  const Error known(ErrorKind::not_a_number, {.file = "b.csv", .line = 1}, "m");
  EXPECT_EQ(known.at({.file = "a.yaml", .line = 4}).place().text(), "b.csv:1");
}

TEST(Error, TellsFailedRunsFromWrongInput) {
  EXPECT_TRUE(Error(ErrorKind::diverged, {}, "m").is_run_failure());
  EXPECT_TRUE(Error(ErrorKind::recording_failed, {}, "m").is_run_failure());
  EXPECT_FALSE(Error(ErrorKind::unknown_unit, {}, "m").is_run_failure());
}

TEST(EditDistance, CountsSlips) {
  EXPECT_EQ(edit_distance("mass", "mass"), 0);
  EXPECT_EQ(edit_distance("Mass", "mASS"), 0);
  EXPECT_EQ(edit_distance("mas", "mass"), 1);
  EXPECT_EQ(edit_distance("msas", "mass"), 1);
  EXPECT_EQ(edit_distance("moss", "mass"), 1);
  EXPECT_EQ(edit_distance("", "mass"), 4);
  EXPECT_EQ(edit_distance("mass", ""), 4);
}

TEST(NearestWord, FindsLikelySlipsOnly) {
  const std::vector<std::string> words = {"young_modulus", "poisson_ratio", "mass"};
  EXPECT_EQ(nearest_word("young_modulsu", words), "young_modulus");
  EXPECT_EQ(nearest_word("mas", words), "mass");
  EXPECT_EQ(nearest_word("temperature", words), "");
  EXPECT_EQ(nearest_word("x", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace sinew
