/// @file
/// Contact problems as files of the FCLIB collection, which other solvers read and write, too.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"

namespace sinew::record {

/// u = W r + q with Signorini's and Coulomb's laws at n contacts, see qp::solve_cones(). FCLIB's W,
/// q and r are those of velocities and impulses or of any other units that fit together.
struct FclibProblem {
  Eigen::SparseMatrix<double> w;  ///< (3n, 3n) of each contact the normal, then two tangents
  VectorX q;                      ///< (3n,)
  std::vector<double> friction;   ///< (n,)
  VectorX r;                      ///< (3n,) a solution; empty: the file has none
  std::string title, description;
};

/// The layout is that of Acary, Bremond, Koziara & Perignon, "FCLIB: a collection of discrete 3D
/// frictional contact problems", INRIA RT-0444, 2014, in HDF5:
///   /fclib_local/spacedim, /fclib_local/W/{nzmax, m, n, nz, p, i, x},
///   /fclib_local/vectors/{q, mu}, /fclib_local/info/{title, description}, /solution/{u, r},
/// W by columns (nz = -1), by rows (nz = -2) or as nz triplets of row p, column i and value x.
/// Throws Error: file-not-found, unknown-format, malformed-file; not-in-this-version for problems
/// in two dimensions, with equations of joints (V, R), and global ones.
/// @param path of the file.
FclibProblem read_fclib(const std::filesystem::path& path);

/// W by columns. Throws Error: wrong-shape, file-unwritable, recording-failed.
/// @param path is replaced. @param problem see there.
void write_fclib(const std::filesystem::path& path, const FclibProblem& problem);

}  // namespace sinew::record
