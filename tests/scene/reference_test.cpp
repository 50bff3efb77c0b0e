// The pages generated from the grammar equal those in docs/ and are correct.
#include "sinew/scene/reference.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sinew/scene/grammar.hpp"
#include "sinew/scene/scene.hpp"

#include "scene_fixture.hpp"

namespace sinew::scene {
namespace {

const std::filesystem::path kDocs = std::filesystem::path(SINEW_SOURCE_DIR) / "docs";

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void expect_written(const std::filesystem::path& path, const std::string& text) {
  if (std::getenv("SINEW_WRITE_REFERENCE") != nullptr) {
    std::ofstream(path, std::ios::binary) << text;
  }
  EXPECT_TRUE(content(path) == text)
      << path << " is out of date; write it with SINEW_WRITE_REFERENCE=1 "
      << "test_scene";
}

TEST(Reference, PagesInDocsAreUpToDate) {
  for (const ReferencePage& page : reference_pages()) expect_written(kDocs / page.path, page.text);
}

TEST(Reference, SchemaInDocsIsUpToDate) {
  expect_written(kDocs / "scene.schema.json", json_schema());
}

// The anchors of a page's headings on GitHub.
std::set<std::string> anchors(const std::string& page) {
  std::set<std::string> found;
  for (std::size_t at = page.find("\n## "); at != std::string::npos;
       at = page.find("\n## ", at + 1)) {
    std::string anchor;
    for (const char c : page.substr(at + 4, page.find('\n', at + 4) - at - 4)) {
      if (c == ' ') anchor += '-';
      if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') {
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      }
    }
    EXPECT_TRUE(found.insert(anchor).second) << "twice: " << anchor;
  }
  return found;
}

TEST(Reference, EveryLinkHasItsHeading) {
  std::map<std::string, std::set<std::string>> headings;
  std::size_t tables = 0;
  for (const ReferencePage& page : reference_pages()) {
    headings[page.path] = anchors(page.text);
    tables += headings[page.path].size();
  }
  EXPECT_GT(headings.size(), 8u);
  EXPECT_GT(tables, 25u);
  int links = 0;
  for (const ReferencePage& page : reference_pages()) {
    for (std::size_t at = page.text.find("]("); at != std::string::npos;
         at = page.text.find("](", at + 1)) {
      const std::string target = page.text.substr(at + 2, page.text.find(')', at) - at - 2);
      const std::size_t hash = target.find('#');
      if (hash == std::string::npos) continue;
      const std::filesystem::path folder = std::filesystem::path(page.path).parent_path();
      const std::string path =
          hash == 0 ? page.path
                    : (folder / target.substr(0, hash)).lexically_normal().generic_string();
      EXPECT_TRUE(headings[path].contains(target.substr(hash + 1))) << page.path << ": " << target;
      ++links;
    }
  }
  EXPECT_GT(links, 100);
}

// Tables that differ only in unit, and keys of many tables, are described once.
TEST(Reference, SharedTypesAreDescribedOnce) {
  std::string all;
  for (const ReferencePage& page : reference_pages()) all += page.text;
  for (const char* line :
       {"\n## signal\n", "\n## ramp\n", "\n## sine\n", "\n## keys of all sensors\n",
        "\n| `dropout` |", "\n| `softening` |", "\n- `outside: nearest`"}) {
    const std::size_t first = all.find(line);
    EXPECT_NE(first, std::string::npos) << line;
    EXPECT_EQ(all.find(line, first + 1), std::string::npos) << line;
  }
  EXPECT_EQ(all.find("signal in"), std::string::npos);
}

// Checks the schema with an independent implementation of JSON Schema.
TEST(Reference, SchemaAcceptsAndRejectsAsTheParserDoes) {
  if (std::system("/usr/bin/python3 -c 'import jsonschema, yaml' 2>/dev/null") != 0) {
    GTEST_SKIP() << "python3-jsonschema and python3-yaml are not installed";
  }
  const std::string command = std::string("/usr/bin/python3 '") + SINEW_SOURCE_DIR +
                              "/tests/scene/check_schema.py' '" +
                              (kDocs / "scene.schema.json").string() + "'";
  const SceneFolder folder;
  folder.write("example.yaml", kExample);
  EXPECT_EQ(std::system((command + " '" + (folder.path() / "example.yaml").string() + "'").c_str()),
            0);
}

}  // namespace
}  // namespace sinew::scene
