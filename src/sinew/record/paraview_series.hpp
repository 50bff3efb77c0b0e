/// @file
/// Writes the bodies of a run as a series for ParaView.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "sinew/fem/element_fields.hpp"
#include "sinew/mesh/write.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::fem {
class HasMaterial;
}  // namespace sinew::fem

namespace sinew::record {

/// Removes the series of an older run from a folder, which would be mistaken for that of a new one.
/// Other files in its folders stay.
void remove_series(const std::filesystem::path& folder);

/// Writes run.pvd, or run_BODY.pvd for each of several bodies.
class ParaviewSeries {
 public:
  /// Starts the lists. Throws what PvdWriter throws.
  /// @param folder of the lists. @param simulation must outlive this.
  ParaviewSeries(const std::filesystem::path& folder, const sim::Simulation& simulation);
  /// Writes the current state. Throws what PvdWriter::write() throws.
  void write();
  /// As PvdWriter::move_to().
  void move_to(const std::filesystem::path& folder);

 private:
  void add_fields(int index, mesh::VtuFields& fields);
  void add_contact_force(const fem::HasMaterial& body, mesh::VtuFields& fields);

  const sim::Simulation& simulation_;
  std::vector<int> bodies_;  // those with a mesh
  std::vector<mesh::PvdWriter> lists_;
  std::vector<std::unique_ptr<fem::NodalMean>> means_;  // of each, for its fields; none of an arm
};

}  // namespace sinew::record
