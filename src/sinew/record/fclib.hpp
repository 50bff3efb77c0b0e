/// @file
/// Reads and writes contact problems in the format of the FCLIB collection, which other solvers
/// use.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"

namespace sinew::record {

/// A contact problem u = W r + q with Signorini's and Coulomb's laws at n contacts, see
/// qp::solve_cones(). W, q and r may refer to velocities and impulses or to any other consistent
/// units.
struct FclibProblem {
  Eigen::SparseMatrix<double> w;  ///< (3n, 3n), for each contact the normal, then two tangents
  VectorX q;                      ///< (3n,)
  std::vector<double> friction;   ///< (n,)
  VectorX r;                      ///< (3n,) a solution; empty if there is none
  std::string title, description;
};

/// Reads an FCLIB file. The layout is that of Acary, Bremond, Koziara & Perignon, "FCLIB: a
/// collection of discrete 3D frictional contact problems", INRIA RT-0444, 2014, in HDF5:
///   /fclib_local/spacedim, /fclib_local/W/{nzmax, m, n, nz, p, i, x},
///   /fclib_local/vectors/{q, mu}, /fclib_local/info/{title, description}, /solution/{u, r},
/// with W by columns (nz = -1), by rows (nz = -2) or as nz triplets of row p, column i and value x.
/// Throws Error: file-not-found, unknown-format, malformed-file; not-in-this-version for
/// two-dimensional problems, problems with joint equations (V, R) and global problems.
/// @param path of the file.
FclibProblem read_fclib(const std::filesystem::path& path);

/// Writes an FCLIB file, with W by columns. Throws Error: wrong-shape, file-unwritable,
/// recording-failed. @param path of the file, which is replaced. @param problem to be written.
void write_fclib(const std::filesystem::path& path, const FclibProblem& problem);

}  // namespace sinew::record
