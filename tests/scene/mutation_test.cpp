// Damaged scenes give an Error and nothing else. SINEW_MUTATIONS sets their number.
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "sinew/scene/scene.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

const char* const kPieces[] = {"{",
                               "}",
                               "[",
                               "]",
                               ":",
                               ", ",
                               "- ",
                               "\n",
                               "  ",
                               "\t",
                               "&a ",
                               "*a",
                               "!!",
                               "#",
                               "'",
                               "\"",
                               "|\n",
                               ">\n",
                               "~",
                               "? ",
                               "<<: *a",
                               "---\n",
                               "1e999",
                               "-1",
                               "0",
                               ".nan",
                               "10 mm",
                               "1 N",
                               "x",
                               "type",
                               "file: ",
                               "set: a",
                               "ramp: ",
                               "steps: [[0, 1]]",
                               "sine: {}",
                               "orientation: [0 0 0, 1 0 0, 0 1 0]",
                               "directions: [x, y]",
                               "weight: 1 2",
                               "polyline: {}",
                               "unit: mm",
                               "mass",
                               "density: 1",
                               "\xc3",
                               "\xe2\x82\xac",
                               "%"};

std::string mutate(std::string text, std::mt19937& random) {
  const int edits = 1 + static_cast<int>(random() % 4);
  for (int i = 0; i < edits; ++i) {
    const std::size_t at = random() % (text.size() + 1);
    const std::size_t length = random() % 12;
    const std::string piece = kPieces[random() % std::size(kPieces)];
    switch (random() % 4) {
      case 0:
        text.insert(at, piece);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.replace(at, length, piece);
        break;
      default:
        text.insert(at, text.substr(random() % text.size(), random() % 40));
    }
  }
  return text;
}

TEST(Mutations, OfTheExampleAreReadOrRefused) {
  const char* wanted = std::getenv("SINEW_MUTATIONS");
  const int count = wanted != nullptr ? std::atoi(wanted) : 4000;
  std::mt19937 random(5);
  int read = 0;
  int refused = 0;
  for (int i = 0; i < count; ++i) {
    const std::string text = mutate(kExample, random);
    try {
      const SceneDescription scene = parse(text);
      ASSERT_TRUE(parse_yaml(to_yaml(scene.tree), "again.yaml") == scene.tree) << text;
      EXPECT_GE(scene.run_duration(), 0.0);
      ++read;
    } catch (const Error& error) {
      ASSERT_NE(error.kind(), ErrorKind::internal) << error.what() << "\n" << text;
      ASSERT_FALSE(error.remedy().empty()) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(read, count / 50);
  EXPECT_GT(refused, count / 4);
}

}  // namespace
}  // namespace sinew::scene
