// The pages written from the grammar: equal to what is in docs/, and true.
#include "sinew/scene/reference.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
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

TEST(Reference, PageInDocsIsUpToDate) { expect_written(kDocs / "scene.md", reference_page()); }

TEST(Reference, SchemaInDocsIsUpToDate) {
  expect_written(kDocs / "scene.schema.json", json_schema());
}

TEST(Reference, EveryLinkHasItsHeading) {
  const std::string page = reference_page();
  std::set<std::string> headings;
  for (std::size_t at = page.find("\n## "); at != std::string::npos;
       at = page.find("\n## ", at + 1)) {
    std::string anchor;
    for (const char c : page.substr(at + 4, page.find('\n', at + 4) - at - 4)) {
      if (c == ' ') anchor += '-';
      if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') {
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      }
    }
    EXPECT_TRUE(headings.insert(anchor).second) << "twice: " << anchor;
  }
  EXPECT_GT(headings.size(), 25u);
  int links = 0;
  for (std::size_t at = page.find("](#"); at != std::string::npos; at = page.find("](#", at + 1)) {
    const std::string anchor = page.substr(at + 3, page.find(')', at) - at - 3);
    EXPECT_TRUE(headings.contains(anchor)) << anchor;
    ++links;
  }
  EXPECT_GT(links, 25);
}

// The schema against an independent implementation of JSON Schema.
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
