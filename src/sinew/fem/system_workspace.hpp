/// @file
/// Working data of a body for one of the two systems of its model.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sinew/fem/assembly.hpp"
#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

/// Assembly and factorisation of one FemSystem, shared by the parts of a body.
struct SystemWorkspace {
  /// @param system_in,pool must outlive this.
  SystemWorkspace(const FemSystem& system_in, ThreadPool& pool)
      : system(system_in),
        factorisation(system.plan->create(pool)),
        assembly(system.elements, pool) {}

  std::size_t bytes() const {
    return assembly.bytes() + factorisation->bytes() + sizeof(double) * damping_stiffness.size();
  }

  const FemSystem& system;
  std::unique_ptr<linalg::Factorisation> factorisation;
  Assembly assembly;
  std::vector<double> damping_stiffness;  ///< K against strain rates (Tangent::rates)
  bool damped = false;
  /// Weights of the forces and the matrix in `assembly` if they are valid at the current positions,
  /// so that the next linearisation can reuse them. None after the body moved or something was
  /// added to the matrix.
  std::optional<AssemblyWeights> present;
  bool iterating = false;  ///< further linearisations of the same step may follow
};

}  // namespace sinew::fem
