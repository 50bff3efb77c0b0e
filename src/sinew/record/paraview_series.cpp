#include "sinew/record/paraview_series.hpp"

#include <string>
#include <system_error>
#include <vector>

#include "sinew/fem/element_fields.hpp"
#include "sinew/fem/element_states.hpp"
#include "sinew/fem/has_material.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/world/world.hpp"

namespace sinew::record {

namespace {

namespace fs = std::filesystem;

std::vector<double> column(const std::vector<double>& rows, std::size_t k, std::size_t width) {
  std::vector<double> result;
  result.reserve(rows.size() / width);
  for (std::size_t i = k; i < rows.size(); i += width) result.push_back(rows[i]);
  return result;
}

std::vector<double> rows_of(const std::vector<Matrix3>& tensors) {
  std::vector<double> result;
  result.reserve(9 * tensors.size());
  for (const Matrix3& m : tensors) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) result.push_back(m(r, c));
    }
  }
  return result;
}

}  // namespace

void remove_series(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".pvd" && entry.path().stem().string().starts_with("run")) {
      stale.push_back(entry.path());
    }
  }
  for (const fs::path& list : stale) {
    const std::string stem = list.stem().string();
    std::vector<fs::path> steps;
    for (const auto& entry : fs::directory_iterator(folder / stem, ignored)) {
      if (entry.path().filename().string().starts_with(stem + "_") &&
          entry.path().extension() == ".vtu") {
        steps.push_back(entry.path());
      }
    }
    for (const fs::path& step : steps) fs::remove(step, ignored);
    fs::remove(folder / stem, ignored);  // only when nothing else is in it
    fs::remove(list, ignored);
  }
}

ParaviewSeries::ParaviewSeries(const fs::path& folder, const sim::Simulation& simulation)
    : simulation_(simulation) {
  const auto bodies = simulation.model().bodies();
  int index = -1;
  for (const auto& body : bodies) {
    ++index;
    if (!body.has_mesh()) continue;
    bodies_.push_back(index);
    means_.push_back(fem::nodal_mean(body));
    lists_.emplace_back(folder / (bodies.size() == 1 ? "run.pvd" : "run_" + body.name() + ".pvd"));
  }
}

void ParaviewSeries::move_to(const fs::path& folder) {
  for (mesh::PvdWriter& list : lists_) list.move_to(folder);
}

void ParaviewSeries::write() {
  for (std::size_t b = 0; b < lists_.size(); ++b) {
    const mechanics::Body& body = simulation_.body(bodies_[b]);
    const mesh::Mesh& mesh = body.model().mesh();
    mesh::VtuFields fields;
    fields.positions = &body.positions();
    fields.compressed = false;
    // Points are already deformed. With a displacement field, a warp would move them twice.
    fields.points.push_back(
        {"rest_position", 3, {mesh.nodes.data(), mesh.nodes.data() + mesh.nodes.size()}});
    const Points& speed = body.velocities();
    fields.points.push_back({"velocity", 3, {speed.data(), speed.data() + speed.size()}});
    if (means_[b]) add_fields(static_cast<int>(b), fields);
    lists_[b].write(simulation_.time(), mesh, fields);
  }
}

// Adds fields of finite elements: stress, strain and reactions.
void ParaviewSeries::add_fields(int index, mesh::VtuFields& fields) {
  const int number = bodies_[static_cast<std::size_t>(index)];
  const auto& body = *mechanics::as<const fem::HasMaterial>(simulation_.body(number));
  const fem::NodalMean& mean = *means_[static_cast<std::size_t>(index)];
  const fem::ElementStates states = fem::element_states(body);
  fields.cells.push_back({"deformation_gradient", 9, rows_of(states.deformation)});
  fields.cells.push_back({"cauchy_stress", 9, rows_of(states.cauchy)});
  const auto infos = fem::element_fields();
  const std::vector<double> values = fem::all_element_fields(body);
  const std::vector<double> at_nodes = mean(values, infos.size());
  for (std::size_t k = 0; k < infos.size(); ++k) {
    fields.points.push_back({infos[k].name, 1, column(at_nodes, k, infos.size())});
    if (infos[k].field == fem::ElementField::von_mises_stress) {
      fields.cells.push_back({infos[k].name, 1, column(values, k, infos.size())});
    }
  }
  const Points held =
      fem::reactions(body, states, simulation_.efforts(), simulation_.world().rows(),
                     simulation_.model().rows(), number);
  fields.points.push_back({"reaction", 3, {held.data(), held.data() + held.size()}});
  if (!simulation_.model().contacts().empty()) add_contact_force(body, fields);
}

void ParaviewSeries::add_contact_force(const fem::HasMaterial& body, mesh::VtuFields& fields) {
  Points forces = Points::Zero(body.positions().rows(), 3);
  body.add_row_forces(sim::split_efforts(simulation_).contact, forces);
  fields.points.push_back({"contact_force", 3, {forces.data(), forces.data() + forces.size()}});
}

}  // namespace sinew::record
