#include "sinew/core/part_visitor.hpp"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace sinew {
namespace {

// Numbers count in the hash as data do, whether they are listed or not: hashes in saved states do
// not depend on what is a parameter.
TEST(PartVisitor, HashesNumbersAsData) {
  std::vector<Parameter> listed;
  PartVisitor lists("bodies.finger", &listed), hashes;
  for (PartVisitor* one : {&lists, &hashes}) {
    one->add(3, true).number("mass", "kg", 0.25);
    one->below("material", [&] { one->number("young_modulus", "Pa", 1e5); });
    one->number("gravity", "m/s^2", Vector3(0.0, 1.0, -9.81));
    one->number("limit", "N", std::optional<double>()).number("other", "N", std::optional(2.0));
  }
  const ValueHash expected = ValueHash().add(3, true, 0.25, 1e5, Vector3(0.0, 1.0, -9.81),
                                             std::optional<double>(), std::optional(2.0));
  EXPECT_EQ(lists.hash(), expected.value());
  EXPECT_EQ(hashes.hash(), expected.value());
  const std::vector<Parameter> all{{"bodies.finger.mass", "kg", 0.25},
                                   {"bodies.finger.material.young_modulus", "Pa", 1e5},
                                   {"bodies.finger.gravity.x", "m/s^2", 0.0},
                                   {"bodies.finger.gravity.y", "m/s^2", 1.0},
                                   {"bodies.finger.gravity.z", "m/s^2", -9.81},
                                   {"bodies.finger.other", "N", 2.0}};
  EXPECT_EQ(listed, all);
}

TEST(PartVisitor, OptionalValuesAndListedOnes) {
  std::vector<Parameter> listed;
  PartVisitor visitor("a", &listed);
  const auto visit = [](PartVisitor& of, double value) { of.number("b", "m", value); };
  visitor.optional(std::optional(4.0), visit).optional(std::optional<double>(), visit);
  visitor.list("c", "", 5.0);
  EXPECT_EQ(visitor.hash(), ValueHash().add(std::optional(4.0), std::optional<double>()).value());
  EXPECT_EQ(listed, (std::vector<Parameter>{{"a.b", "m", 4.0}, {"a.c", "", 5.0}}));
}

TEST(PartsVisitor, NamesPartsWithinABody) {
  std::vector<Parameter> listed;
  PartsVisitor parts(&listed);
  parts.part("time step").number("time_step", "s", 0.01);
  parts.enter("body 'x': ", "bodies.x");
  PartVisitor& material = parts.part("material");
  PartVisitor& masses = parts.part("point masses", "masses");
  masses.number("tip.mass", "kg", 1.0);
  material.number("k", "N/m", 2.0);  // a part may be completed after the next has begun
  parts.enter({}, {});
  parts.part("actuator 'a'").add(1);
  const std::vector<NamedHash> hashes = parts.hashes();
  ASSERT_EQ(hashes.size(), 4U);
  EXPECT_EQ(hashes[1], (NamedHash{"body 'x': material", ValueHash().add(2.0).value()}));
  EXPECT_EQ(hashes[2].name, "body 'x': point masses");
  EXPECT_EQ(hashes[3].name, "actuator 'a'");
  EXPECT_EQ(listed, (std::vector<Parameter>{{"time_step", "s", 0.01},
                                            {"masses.tip.mass", "kg", 1.0},
                                            {"bodies.x.k", "N/m", 2.0}}));
}

}  // namespace
}  // namespace sinew
