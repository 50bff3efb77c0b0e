/// @file
/// Writers of VTU files and PVD series, for ParaView and for meshes.
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

/// Content of a VTU file in addition to the mesh.
struct VtuFields {
  std::vector<VtuField> points;  ///< one row per node
  std::vector<VtuField> cells;  ///< one row per tetrahedron, then per hexahedron; NaN for triangles
  const Points* positions = nullptr;  ///< (n, 3) m, replace the nodes of the mesh
  bool sets = true;                   ///< named sets as 8-bit masks, which read_mesh() reads back
  bool triangles = true;              ///< surface triangles of the mesh as cells
  /// True: arrays compressed with zlib, fields in double precision. False: raw arrays, fields in
  /// single precision, which is several times as fast and hardly larger, since such numbers do not
  /// compress.
  bool compressed = true;
};

/// Writes a VTU file with tetrahedra, hexahedra and triangles, in this order, in m, as appended raw
/// data. The file is written atomically. Throws Error(file-unwritable), and Error(wrong-length) if
/// a field does not fit the mesh.
/// @param path the file.
/// @param mesh to write.
/// @param fields values at nodes and elements.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh, const VtuFields& fields = {});

/// Returns the bytes that write_vtu() writes. Throws Error(wrong-length).
/// @param mesh to write.
/// @param fields values at nodes and elements.
std::string format_vtu(const Mesh& mesh, const VtuFields& fields = {});

/// Writes a time series for ParaView: NAME.pvd lists NAME/NAME_000000.vtu and so on. The list is a
/// complete file after every step, so that an interrupted run can be read up to its last step.
class PvdWriter {
 public:
  /// Starts the series with an empty list. Throws Error(file-unwritable).
  /// @param path of the .pvd file; its folder is created.
  explicit PvdWriter(std::filesystem::path path);

  /// Writes one step and adds it to the list. Throws like write_vtu(), and Error(not-finite).
  /// @param time s.
  /// @param mesh to write.
  /// @param fields values at nodes and elements.
  void write(double time, const Mesh& mesh, const VtuFields& fields = {});

  /// Number of steps written.
  int count() const { return count_; }

  /// Moves the list and its steps to another folder, where they replace files of the same names.
  /// Throws what throw_unwritable() throws.
  /// @param folder on the same disk.
  void move_to(const std::filesystem::path& folder);

 private:
  std::filesystem::path step_of(int number) const;  // relative to the folder of the list

  std::filesystem::path path_;
  long tail_ = 0;  // position of the closing tags
  int count_ = 0;
};

}  // namespace sinew::mesh
