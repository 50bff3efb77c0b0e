#include "sinew/mesh/write_mesh.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/mesh/write.hpp"

namespace sinew::mesh {

namespace {

enum class Format { vtu, vtk, stl };

Format format_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".vtu") return Format::vtu;
  if (ending == ".vtk") return Format::vtk;
  if (ending == ".stl") return Format::stl;
  throw Error(ErrorKind::unknown_format, {.file = path.string(), .item = {}},
              ending.empty() ? "the file's name has no ending that says its format"
                             : fmt::format("meshes are not written as '{}'", ending),
              "end the name in .vtu or .vtk, or in .stl for the surface alone");
}

}  // namespace

void require_writable_format(const std::filesystem::path& path) { format_of(path); }

void write_mesh(const std::filesystem::path& path, const Mesh& mesh) {
  switch (format_of(path)) {
    case Format::vtu:
      return write_vtu(path, mesh);
    case Format::vtk:
      return write_file(path, format_vtk_legacy(mesh));
    case Format::stl:
      return write_file(path, format_stl(boundary_surface(mesh)));
  }
}

}  // namespace sinew::mesh
