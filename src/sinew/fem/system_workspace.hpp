/// @file
/// What a body keeps of one of its model's two systems.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

/// Assembly, border and factorisation of one FemSystem, as the parts of a body share them.
struct SystemWorkspace {
  /// @param system_in,pool must outlive this.
  SystemWorkspace(const FemSystem& system_in, ThreadPool& pool)
      : system(system_in),
        factorisation(system.plan->create(pool)),
        assembly(system.elements, pool),
        border(3 * static_cast<std::size_t>(system.border.entries()), 0.0) {}

  std::size_t bytes() const {
    return assembly.bytes() + factorisation->bytes() +
           sizeof(double) * (border.size() + damping_stiffness.size());
  }

  const FemSystem& system;
  std::unique_ptr<linalg::Factorisation> factorisation;
  Assembly assembly;
  std::vector<double> border;
  std::vector<double> damping_stiffness;  ///< K of rates of strain (Tangent::rates)
  bool damped = false;
  /// What the elements' forces and matrix in `assembly` are of, at the body's present positions:
  /// the next linearisation there takes them as they are. None once the body moved or something
  /// was added to the matrix.
  std::optional<AssemblyWeights> present;
  bool iterating = false;  ///< further linearisations follow where the body moves to
};

}  // namespace sinew::fem
