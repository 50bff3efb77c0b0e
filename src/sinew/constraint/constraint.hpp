/// @file
/// Constraints couple sites of one or several bodies by rows of H. The effort lambda (N, Pa) and
/// the motion delta (m, m^3) of a row are conjugate: lambda . ddelta is work done on the bodies.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/core/part_visitor.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::constraint {

class Configuration;

/// A constraint: a set of rows of H. Immutable once declared; the numbers of a simulation are in
/// its RowValues.
class Constraint {
 public:
  virtual ~Constraint() = default;

  /// Appends the rows of this constraint, and the pairs of points that its geometric stiffness
  /// couples, to those of the world, and remembers where they start. Called once, when the model is
  /// built.
  virtual void declare(mechanics::RowPattern& rows,
                       std::vector<mechanics::StiffnessPair>& stiffness_pairs) = 0;
  /// Writes delta of its rows for the current configuration, and the directions that depend on the
  /// configuration: all but the frames of a contact, which are set by its step (see Contact).
  virtual void linearise(const Configuration& configuration,
                         mechanics::RowValues& values) const = 0;
  /// Writes its geometric stiffness for the current configuration: the Hessians of its declared
  /// pairs.
  /// @param configuration of all bodies. @param effort (rows,) N or Pa, of all rows of the world.
  /// @param stiffness_pairs its own pairs, from first_stiffness_pair() on.
  virtual void geometric_stiffness(const Configuration& configuration,
                                   std::span<const double> effort,
                                   std::span<mechanics::StiffnessPair> stiffness_pairs) const;

  /// Whether its geometric stiffness is positive semidefinite at these efforts, as that of a taut
  /// cable is. The argument has the efforts of all rows of the world, (rows,) N or Pa.
  virtual bool stiffens(std::span<const double>) const { return false; }

  /// Visits what its rows depend on, apart from the points that they touch.
  virtual void describe(PartVisitor& visitor) const = 0;

  const std::string& name() const { return name_; }
  int first_row() const { return first_row_; }
  int row_count() const { return row_count_; }
  int first_stiffness_pair() const { return first_stiffness_pair_; }
  int stiffness_pair_count() const { return stiffness_pair_count_; }

 protected:
  explicit Constraint(std::string name) : name_(std::move(name)) {}

  int first_row_ = -1;
  int row_count_ = 0;
  int first_stiffness_pair_ = -1;
  int stiffness_pair_count_ = 0;

 private:
  std::string name_;
};

}  // namespace sinew::constraint
