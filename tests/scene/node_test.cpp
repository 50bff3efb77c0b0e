#include "sinew/scene/node.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sinew::scene {
namespace {

ErrorKind kind_of(const std::string& text, const YamlLimits& limits = {}) {
  try {
    parse_yaml(text, "t.yaml", limits);
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::internal;
}

TEST(Node, PlainScalarsMeanWhatYamlSays) {
  using Kind = Node::Kind;
  for (const char* text :
       {"1", "-1", "+3", "0.5", ".5", "1.", "1e3", "1.5E-7", ".inf", "-.inf", ".nan", "007"}) {
    EXPECT_EQ(Node::plain(text).kind(), Kind::number) << text;
  }
  for (const char* text : {"true", "False", "TRUE"}) {
    EXPECT_EQ(Node::plain(text).kind(), Kind::boolean) << text;
  }
  for (const char* text : {"", "~", "null", "NULL"}) {
    EXPECT_EQ(Node::plain(text).kind(), Kind::null) << text;
  }
  for (const char* text :
       {"yes", "10 mm", "1e", "e3", ".", "-", "+", "1.2.3", "0x10", "inf", "nan", "1_000", "--1"}) {
    EXPECT_EQ(Node::plain(text).kind(), Kind::text) << text;
  }
}

TEST(Node, NumbersHaveTheirValue) {
  EXPECT_EQ(Node::plain("-1.5e-3").as_number(), -1.5e-3);
  EXPECT_EQ(Node::plain("+.5").as_number(), 0.5);
  EXPECT_EQ(Node::plain("1.").as_number(), 1.0);
  EXPECT_EQ(Node::plain("-.inf").as_number(), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(Node::plain(".nan").as_number()));
  EXPECT_EQ(Node::integer(-12).as_number(), -12.0);
}

TEST(Node, NumbersAreSpelledSoThatTheyReadBackExactly) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const double value =
        std::ldexp(static_cast<double>(random()) / 1e19, static_cast<int>(random() % 600) - 300);
    EXPECT_EQ(Node::number(value).as_number(), value);
    EXPECT_EQ(Node::plain(Node::number(value).spelling()).as_number(), value);
  }
}

TEST(Node, QuotedScalarsAreText) {
  const Node tree = parse_yaml("a: \"1\"\nb: 'true'\nc: 1", "t.yaml");
  EXPECT_EQ(tree.find("a")->kind(), Node::Kind::text);
  EXPECT_EQ(tree.find("b")->kind(), Node::Kind::text);
  EXPECT_EQ(tree.find("c")->kind(), Node::Kind::number);
}

TEST(Node, SetAppendsOrReplacesInPlace) {
  Node map = Node::map();
  map.set("a", Node::integer(1));
  map.set("b", Node::integer(2));
  map.set("a", Node::integer(3));
  ASSERT_EQ(map.entries().size(), 2u);
  EXPECT_EQ(map.entries()[0].key, "a");
  EXPECT_EQ(map.find("a")->as_number(), 3.0);
  EXPECT_TRUE(map.erase("a"));
  EXPECT_FALSE(map.erase("a"));
  EXPECT_EQ(map.find("a"), nullptr);
}

TEST(Node, PathsAreDotted) {
  Node tree = parse_yaml("a:\n  b: [1, {c: 2}]", "t.yaml");
  EXPECT_EQ(tree.find("a")->find("b")->items()[1].find("c")->place().text(),
            "t.yaml:2:14: a.b[1].c");
}

TEST(Node, AliasesAreExpanded) {
  const Node tree = parse_yaml("a: &x {k: 1}\nb: *x\nc: [*x, *x]", "t.yaml");
  EXPECT_EQ(tree.find("b")->find("k")->as_number(), 1.0);
  EXPECT_EQ(tree.find("c")->items()[1].find("k")->place().item, "c[1].k");
}

TEST(Node, AliasesCannotExhaustMemory) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) bomb += before + (k < 9 ? ", " : " ");
    bomb += "]\n";
  }
  EXPECT_EQ(kind_of(bomb), ErrorKind::size_limit);
}

TEST(Node, AnAliasWithinItsOwnAnchorIsRefused) {
  EXPECT_EQ(kind_of("a: &x [1, *x]"), ErrorKind::syntax_error);
}

TEST(Node, LimitsHold) {
  EXPECT_EQ(kind_of(std::string(100, '[') + std::string(100, ']')), ErrorKind::size_limit);
  EXPECT_EQ(kind_of(std::string(100000, '[') + std::string(100000, ']')), ErrorKind::size_limit);
  std::string deep;
  for (int i = 0; i < 100; ++i) deep += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_EQ(kind_of(deep), ErrorKind::size_limit);
  EXPECT_EQ(kind_of("a: 1\nb: 2\nc: 3", {.bytes = 5}), ErrorKind::size_limit);
  EXPECT_EQ(kind_of("[1, 2, 3]", {.nodes = 3}), ErrorKind::size_limit);
  EXPECT_EQ(kind_of(std::string(300, 'k') + ": 1"), ErrorKind::size_limit);
  EXPECT_EQ(kind_of("a: &x [[[[1]]]]\nb: [[[*x]]]", {.depth = 6}), ErrorKind::size_limit);
}

TEST(Node, BadTextIsRefused) {
  for (const char* text : {"a: \xc3", "a: \xc0\x80", "a: \xed\xa0\x80", "a: \xf5\x80\x80\x80",
                           "\xff\xfe"
                           "a",
                           "a: \x01"}) {
    EXPECT_EQ(kind_of(text), ErrorKind::bad_encoding) << text;
  }
  EXPECT_EQ(parse_yaml("a: \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", "t").find("a")->spelling(),
            "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80");
}

TEST(Node, WritesWhatReadsBackTheSame) {
  Node tree = Node::map();
  const char* const texts[] = {"plain",
                               "10 mm",
                               "",
                               " lead",
                               "trail ",
                               "true",
                               "1",
                               "~",
                               "null",
                               "a: b",
                               "# no comment",
                               "x #y",
                               "- item",
                               "-",
                               "-1 N",
                               "[a]",
                               "{a}",
                               "quote\"s",
                               "it's",
                               "back\\slash",
                               "line\nbreak",
                               "tab\there",
                               "*alias",
                               "&anchor",
                               "!tag",
                               "%dir",
                               "@at",
                               "`tick",
                               "|",
                               ">",
                               "?",
                               ": ",
                               "a:",
                               "1 2 3",
                               "0 0 -9.81 m/s^2",
                               "---",
                               "...",
                               "--- a",
                               "\xc3\xa9t\xc3\xa9",
                               "\xef\xbb\xbf",
                               "\xc2\x85",
                               "\x01",
                               "y",
                               "=",
                               "<<",
                               "-.5 mm",
                               "- 5",
                               "a,b",
                               "long long long long long long long "
                               "long long long long long long long long long long long long long"};
  Node list = Node::list();
  int number = 0;
  for (const char* text : texts) {
    tree.set("t" + std::to_string(number++), Node::text(text));
    list.append(Node::text(text));
  }
  tree.set("list", list);
  tree.set("empty list", Node::list());
  tree.set("empty map", Node::map());
  tree.set("null", Node());
  tree.set("1.5", Node::number(-0.1));
  tree.set("b", Node::boolean(false));
  Node nested = Node::list();
  Node inner = Node::map();
  inner.set("x", list);
  inner.set("y", Node::map());
  nested.append(inner);
  nested.append(Node::list());
  Node deep = Node::list();
  deep.append(inner);
  nested.append(deep);
  tree.set("nested", nested);
  const std::string written = to_yaml(tree);
  // YAML files cannot contain control characters; everything else must be preserved.
  EXPECT_TRUE(parse_yaml(written, "t.yaml") == tree) << written;
}

TEST(Node, WritesScalarsAndEmptyTrees) {
  for (const Node& node :
       {Node(), Node::map(), Node::list(), Node::text("a: b"), Node::integer(3)}) {
    EXPECT_TRUE(parse_yaml(to_yaml(node), "t.yaml") == node) << to_yaml(node);
  }
}

TEST(Node, RandomTreesSurviveARoundTrip) {
  std::mt19937 random(11);
  const std::string alphabet = "ab1 -:#'\"\\,[]{}&*!|>%@`\n\t.~?=<\xc3\xa9";
  const auto text = [&] {
    std::string result;
    const std::size_t size = random() % 8;
    while (result.size() < size) {
      const char c = alphabet[random() % (alphabet.size() - 2)];
      result += c;
    }
    return result;
  };
  const auto make = [&](const auto& self, int depth) -> Node {
    const auto choice = random() % (depth > 0 ? 6 : 4);
    if (choice == 0) return Node::integer(static_cast<int>(random() % 100));
    if (choice == 1) return Node::boolean(random() % 2 == 0);
    if (choice < 4) return Node::text(text());
    Node node = choice == 4 ? Node::list() : Node::map();
    const std::size_t count = random() % 4;
    for (std::size_t i = 0; i < count; ++i) {
      if (choice == 4) {
        node.append(self(self, depth - 1));
      } else {
        node.set(text() + std::to_string(i), self(self, depth - 1));
      }
    }
    return node;
  };
  for (int i = 0; i < 3000; ++i) {
    const Node tree = make(make, 4);
    const std::string written = to_yaml(tree);
    ASSERT_TRUE(parse_yaml(written, "t.yaml") == tree) << written;
  }
}

}  // namespace
}  // namespace sinew::scene
