/// @file
/// Shared helpers of the mesh tests.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh::test {

/// Runs `action`, expects an Error of this kind, and returns its full text.
template <typename Action>
std::string error_text(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(kind)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error, expected " << error_kind_name(kind);
  return {};
}

inline std::filesystem::path data_folder() {
  return std::filesystem::path(SINEW_SOURCE_DIR) / "tests/mesh/data";
}

/// A temporary folder of one test, initially empty and removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "." + info->name();
    for (char& c : name) {
      if (c == '/') c = '_';
    }
    path_ =
        std::filesystem::temp_directory_path() / ("sinew-test-" + name + std::to_string(getpid()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// A corner tetrahedron with three perpendicular edges of 0.1 m.
inline Mesh one_tetrahedron() {
  Mesh mesh;
  mesh.name = "one";
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1;
  mesh.tetrahedra = {{0, 1, 2, 3}};
  return mesh;
}

/// Two tetrahedra on either side of the face (1, 2, 3).
inline Mesh two_tetrahedra() {
  Mesh mesh = one_tetrahedron();
  mesh.nodes.conservativeResize(5, 3);
  mesh.nodes.row(4) << 0.1, 0.1, 0.1;
  mesh.tetrahedra.push_back({1, 2, 3, 4});
  return mesh;
}

}  // namespace sinew::mesh::test
