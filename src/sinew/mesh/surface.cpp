#include "sinew/mesh/surface.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <assimp/BaseImporter.h>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/mesh/check.hpp"
#include "sinew/mesh/duplicates.hpp"
#include "sinew/mesh/ply_guard.hpp"

namespace sinew::mesh {

namespace {

constexpr std::size_t kReasonShown = 100;  // assimp quotes whole files
constexpr std::array kExtensions = {"stl", "obj", "ply"};

/// Removes all importers except those for the formats above; the others are not tested.
void keep_named_importers(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    const std::string extensions = description != nullptr ? description->mFileExtensions : "";
    const bool named = std::any_of(kExtensions.begin(), kExtensions.end(),
                                   [&](const char* wanted) { return extensions == wanted; });
    if (named) continue;
    const std::unique_ptr<Assimp::BaseImporter> removed(importer.GetImporter(i));
    importer.UnregisterLoader(removed.get());
  }
}

/// Splits a polygon into a fan from the first corner from which all triangles have the same
/// orientation.
void add_polygon(const std::vector<NodeId>& corners, const std::vector<double>& coordinates,
                 Surface& surface) {
  const std::size_t n = corners.size();
  const auto position = [&](NodeId node) {
    return Vector3(Eigen::Map<const Vector3>(&coordinates[3 * static_cast<std::size_t>(node)]));
  };
  for (std::size_t start = 0; start < n; ++start) {
    std::vector<Triangle> fan;
    Vector3 area = Vector3::Zero();
    std::vector<Vector3> normals;
    for (std::size_t k = 1; k + 1 < n; ++k) {
      fan.push_back({corners[start], corners[(start + k) % n], corners[(start + k + 1) % n]});
      const Vector3 origin = position(fan.back()[0]);
      normals.push_back((position(fan.back()[1]) - origin).cross(position(fan.back()[2]) - origin));
      area += normals.back();
    }
    const bool alike = std::all_of(normals.begin(), normals.end(), [&](const Vector3& normal) {
      return !(normal.dot(area) < 0.0);
    });
    if (!alike) continue;
    surface.triangles.insert(surface.triangles.end(), fan.begin(), fan.end());
    return;
  }
  throw Error(ErrorKind::unsupported_element, {.file = surface.name},
              fmt::format("a polygon of {} corners cannot be cut into a fan of triangles", n),
              "export the surface as triangles");
}

/// Collects all triangles, with the vertices of the file.
Surface collect(const aiScene& scene, const std::string& name) {
  std::vector<double> coordinates;
  Surface surface{.name = name, .nodes = {}, .triangles = {}};
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    const auto first = static_cast<NodeId>(coordinates.size() / 3);
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D& x = part.mVertices[v];
      coordinates.insert(coordinates.end(), {double(x.x), double(x.y), double(x.z)});
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) continue;  // points and lines, which are no surface
      std::vector<NodeId> corners;
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        corners.push_back(first + static_cast<NodeId>(face.mIndices[k]));
      }
      add_polygon(corners, coordinates, surface);
    }
  }
  surface.nodes = Eigen::Map<const Points>(coordinates.data(),
                                           static_cast<Eigen::Index>(coordinates.size() / 3), 3);
  return surface;
}

/// Requires the end of a text file: one truncated at the end of a triangle would look like a
/// smaller surface.
void require_whole_stl(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, sizeof(count));
  const bool binary = bytes.size() >= kHeader && bytes.size() == kHeader + kTriangle * count;
  if (binary || !bytes.starts_with("solid")) return;
  if (bytes.find("endsolid") != std::string_view::npos) return;
  throw Error(ErrorKind::truncated_file, {.file = name}, "the text ends without `endsolid`",
              "write the file again; it was probably cut short");
}

void require_finite(const Surface& surface) {
  for (NodeId node = 0; node < static_cast<NodeId>(surface.nodes.rows()); ++node) {
    if ((surface.nodes.row(node).array().abs() <= kFarthestNode).all()) continue;
    throw Error(ErrorKind::non_finite_node, {.file = surface.name},
                fmt::format("vertex {} is not finite, or beyond {:g}", node, kFarthestNode),
                "write the file again");
  }
}

/// Merges coincident vertices, and removes triangles that are then flat and unused vertices.
Surface welded(const Surface& raw, double tolerance) {
  const std::vector<NodeId> lowest = weld_map(raw.nodes, {}, tolerance);
  Surface surface{.name = raw.name, .nodes = {}, .triangles = {}};
  std::vector<NodeId> number(lowest.size(), -1);
  std::vector<NodeId> kept;
  for (Triangle triangle : raw.triangles) {
    for (NodeId& node : triangle) node = lowest[static_cast<std::size_t>(node)];
    const auto [a, b, c] = triangle;
    if (a == b || b == c || c == a) continue;
    for (NodeId& node : triangle) {
      NodeId& fresh = number[static_cast<std::size_t>(node)];
      if (fresh < 0) {
        fresh = static_cast<NodeId>(kept.size());
        kept.push_back(node);
      }
      node = fresh;
    }
    surface.triangles.push_back(triangle);
  }
  surface.nodes.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    surface.nodes.row(static_cast<Eigen::Index>(i)) = raw.nodes.row(kept[i]);
  }
  return surface;
}

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

void check_size(const Surface& surface, const SurfaceOptions& options) {
  constexpr double kLargest = 10.0;
  if (options.unit_given || options.unit != 1.0) return;
  const double size =
      (surface.nodes.colwise().maxCoeff() - surface.nodes.colwise().minCoeff()).maxCoeff();
  if (size <= kLargest) return;
  throw Error(
      ErrorKind::suspicious_unit, {.file = surface.name},
      fmt::format("the surface is {:.4g} m large, since no unit is given", size),
      fmt::format("if the file is in millimetres (the surface is then {:.4g} mm large), write "
                  "`unit: mm` in a scene, --unit mm on the command line; else `unit: m`",
                  size));
}

}  // namespace

Surface parse_surface(std::string_view bytes, const std::string& extension, const std::string& name,
                      double weld_tolerance) {
  const bool known = std::any_of(kExtensions.begin(), kExtensions.end(),
                                 [&](const char* wanted) { return extension == wanted; });
  if (!known) {
    throw Error(ErrorKind::unknown_format, {.file = name},
                fmt::format("surfaces are not read from `.{}` files", extension),
                "give an STL, OBJ or PLY file");
  }
  if (extension == "ply") require_whole_ply(bytes, name);
  if (extension == "stl") require_whole_stl(bytes, name);
  Assimp::Importer importer;
  keep_named_importers(importer);
  // No post-processing: its triangulation aborts the program on some damaged files.
  const aiScene* scene =
      importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
  if (scene == nullptr) {
    throw Error(ErrorKind::malformed_file, {.file = name},
                fmt::format("the surface cannot be read: {}",
                            std::string_view(importer.GetErrorString()).substr(0, kReasonShown)),
                "write the file again");
  }
  const Surface raw = collect(*scene, name);
  require_finite(raw);
  Surface surface = welded(raw, weld_tolerance);
  if (surface.triangles.empty()) {
    throw Error(ErrorKind::empty_list, {.file = name}, "the file has no triangles",
                "export the surface as triangles");
  }
  return surface;
}

Surface read_surface(const std::filesystem::path& path, const SurfaceOptions& options) {
  Surface surface =
      parse_surface(read_file(path), extension_of(path), path.string(), options.weld_tolerance);
  surface.nodes *= options.unit;
  check_size(surface, options);
  return surface;
}

void require_closed(const Surface& surface) {
  // Each directed edge must occur once, and its opposite once.
  std::vector<std::pair<NodeId, NodeId>> edges;
  for (const auto& [a, b, c] : surface.triangles) {
    edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  }
  std::sort(edges.begin(), edges.end());
  int faults = 0;
  std::pair<NodeId, NodeId> first;
  for (auto edge = edges.begin(); edge != edges.end(); ++edge) {
    const bool repeated = edge != edges.begin() && *edge == *(edge - 1);
    const bool matched =
        std::binary_search(edges.begin(), edges.end(), std::pair(edge->second, edge->first));
    if (matched && !repeated) continue;
    if (faults++ == 0) first = *edge;
  }
  if (faults == 0) return;
  const Vector3 a = surface.nodes.row(first.first), b = surface.nodes.row(first.second);
  throw Error(ErrorKind::surface_not_closed, {.file = surface.name},
              fmt::format("{} edges do not have one triangle on either side, the first from "
                          "({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) m",
                          faults, a.x(), a.y(), a.z(), b.x(), b.y(), b.z()),
              "close the holes and let all triangles face outwards");
}

std::string format_stl(const Surface& surface, double scale) {
  std::string bytes(80, ' ');
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector3 xa = surface.nodes.row(a), xb = surface.nodes.row(b), xc = surface.nodes.row(c);
    const Vector3 normal = (xb - xa).cross(xc - xa).normalized();
    for (const double value : normal) append(static_cast<float>(value));
    for (const Vector3& x : {xa, xb, xc}) {
      for (const double value : x) append(static_cast<float>(scale * value));
    }
    append(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace sinew::mesh
