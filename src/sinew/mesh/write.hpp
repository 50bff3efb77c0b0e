/// @file
/// Writers for ParaView and for Sinew's own meshes: VTU files and PVD series.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Values at nodes or elements.
struct VtuField {
  std::string name;
  int components = 1;          ///< 1 scalar, 3 vector, 9 tensor
  std::vector<double> values;  ///< (count x components,) row by row
};

/// What a VTU file carries beside the mesh.
struct VtuFields {
  std::vector<VtuField> points;  ///< one row a node
  std::vector<VtuField> cells;  ///< one row a tetrahedron, then one a hexahedron; NaN for triangles
  const Points* positions = nullptr;  ///< (n, 3) m, in place of the mesh's own nodes
  bool sets = true;                   ///< named sets as 8-bit masks, which read_mesh() reads back
  bool triangles = true;              ///< the mesh's surface triangles as cells
  /// Arrays compressed with zlib, fields in double precision. Else raw arrays, fields in single
  /// precision: several times as fast, and hardly larger, since such numbers do not compress.
  bool compressed = true;
};

/// Writes tetrahedra, hexahedra and triangles, in this order, in m, as appended raw data. The file
/// appears whole or not at all. Throws Error(file-unwritable), and Error(wrong-length) when a field
/// does not fit the mesh.
/// @param path the file.
/// @param mesh to write.
/// @param fields values at nodes and elements.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh, const VtuFields& fields = {});

/// The bytes that write_vtu() writes. Throws Error(wrong-length).
/// @param mesh to write.
/// @param fields values at nodes and elements.
std::string format_vtu(const Mesh& mesh, const VtuFields& fields = {});

/// A time series for ParaView: NAME.pvd lists NAME/NAME_000000.vtu and so on. The list is a whole
/// file after every step, so that an interrupted run can be read as far as it went.
class PvdWriter {
 public:
  /// Starts the series with an empty list. Throws Error(file-unwritable).
  /// @param path of the .pvd file; its folder is made.
  explicit PvdWriter(std::filesystem::path path);

  /// Writes one step and adds it to the list. Throws as write_vtu(), or Error(not-finite).
  /// @param time s.
  /// @param mesh to write.
  /// @param fields values at nodes and elements.
  void write(double time, const Mesh& mesh, const VtuFields& fields = {});

  /// Steps written.
  int count() const { return count_; }

 private:
  std::filesystem::path path_;
  long tail_ = 0;  // where the closing tags start
  int count_ = 0;
};

}  // namespace sinew::mesh
