/// @file
/// Identifies the two-state system of a drive cylinder from records of its command and volume.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sinew/identify/drive_record.hpp"
#include "sinew/identify/parameter_fit.hpp"
#include "sinew/pcc/drive_cylinder.hpp"

namespace sinew::identify {

/// Options of fit_cylinder().
struct CylinderFitSettings {
  int block_rows = 10;       ///< of the subspace method; more than the two states
  bool feedthrough = false;  ///< fit D; else it is zero
  ParameterFitSettings search;
};

/// Prediction of one record.
struct CylinderTrial {
  std::string name;
  VectorX predicted;  ///< (samples,)
  Eigen::Vector2d start = Eigen::Vector2d::Zero();
  double nrmse = 0.0;  ///< |y - y_predicted| / |y - mean y|
};

/// A fitted cylinder.
struct CylinderFit {
  pcc::DriveCylinder start;     ///< of the subspace method
  pcc::DriveCylinder cylinder;  ///< refined; in observer form A = [-a1 1; -a2 0], C = [1 0]
  ParameterFit fit;             ///< "a1", "a2", "b1", "b2" (and "d"), then each record's start
  std::vector<CylinderTrial> trials;
};

/// Identifies a cylinder in two stages. The initial guess is a subspace estimate, past-output MOESP
/// (Verhaegen & Dewilde, Int. J. Control 56, 1992; Van Overschee & De Moor, Subspace Identification
/// for Linear Systems, 1996, ch. 4), with the block Hankel matrices of all records side by side; B,
/// D and the starts follow by linear least squares. The refinement minimises the output error sum
/// (y - y_predicted)^2 over the coefficients of
///   y_k + a1 y_{k-1} + a2 y_{k-2} = d u_k + b1' u_{k-1} + b2' u_{k-2}
/// with exact derivatives (Ljung, System Identification, 1999, ch. 4 and 10).
/// @param records of one sample time. @param settings options.
/// Throws Error: empty-list, wrong-length, not-finite, too-few-points (records too short for the
/// order of the model), out-of-range (block rows, sample times, an input that does not excite), and
/// what fit_parameters() throws.
CylinderFit fit_cylinder(std::span<const DriveRecord> records,
                         const CylinderFitSettings& settings = {});

/// Evaluates a cylinder on records to which it was not fitted. The start is fitted to the first
/// `block` samples.
/// @param cylinder fitted. @param records for validation. @param block number of samples.
std::vector<CylinderTrial> validate_cylinder(const pcc::DriveCylinder& cylinder,
                                             std::span<const DriveRecord> records, int block = 20);

}  // namespace sinew::identify
