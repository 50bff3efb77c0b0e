#include "sinew/fem/fem_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/element_batches.hpp"
#include "sinew/fem/gather_lists.hpp"
#include "sinew/fem/mass.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/fem/spatial_order.hpp"

namespace sinew::fem {

double stiffest_modulus(const FemModelSettings& settings) {
  double modulus = 0.0;
  for (const MaterialRegion& region : settings.regions) {
    modulus = std::max(modulus, region.young_modulus());
  }
  return modulus;
}

void check_mesh(const mesh::Mesh& mesh) {
  const Location place{.file = mesh.name, .item = {}};
  const ElementList list(mesh);
  if (list.count() == 0) {
    throw Error(ErrorKind::no_volume_elements, place, "the mesh has no tetrahedra or hexahedra",
                "mesh the volume, not only its surface");
  }
  for (Eigen::Index node = 0; node < mesh.nodes.rows(); ++node) {
    if (mesh.nodes.row(node).allFinite()) continue;
    throw Error(ErrorKind::non_finite_node, place,
                fmt::format("node {} is at ({}, {}, {})", node, mesh.nodes(node, 0),
                            mesh.nodes(node, 1), mesh.nodes(node, 2)),
                "give finite positions");
  }
  for (int e = 0; e < list.count(); ++e) {
    for (const NodeId node : list.nodes(e)) {
      if (node >= 0 && node < mesh.node_count()) continue;
      throw Error(ErrorKind::index_out_of_range, place,
                  fmt::format("{} names node {} of {}", list.name(e), node, mesh.node_count()),
                  "nodes count from 0");
    }
  }
}

namespace {

constexpr double kPseudoDensity = 1e3;  // kg/m^3

void check_region(const MaterialRegion& region) {
  if (region.patches && (!region.hyperelastic || region.hyperelastic->saint_venant_shear != 0.0)) {
    throw Error(ErrorKind::unsupported_element, {.item = "material"},
                "patches of tetrahedra need a law whose volumetric part stands apart",
                "give them a hyperelastic material other than saint-venant-kirchhoff");
  }
  if (region.hyperelastic) {
    region.hyperelastic->validate("material");
  } else {
    region.constants.validate("material");
  }
}

/// Region of each element.
std::vector<std::int32_t> assign_regions(const mesh::Mesh& mesh,
                                         const std::vector<MaterialRegion>& regions) {
  const auto fail = [&](ErrorKind kind, const std::string& message, const std::string& remedy) {
    throw Error(kind, {.file = mesh.name, .item = "material"}, message, remedy);
  };
  if (regions.empty()) fail(ErrorKind::empty_list, "there is no material", "give one");
  const ElementList list(mesh);
  const auto count = static_cast<NodeId>(list.count());
  std::vector<std::int32_t> result(static_cast<std::size_t>(count), -1);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    check_region(regions[r]);
    std::vector<NodeId> all(regions[r].elements.empty() ? result.size() : 0);
    std::iota(all.begin(), all.end(), 0);
    for (const NodeId e : regions[r].elements.empty() ? all : regions[r].elements) {
      if (e < 0 || e >= count) {
        fail(ErrorKind::index_out_of_range,
             fmt::format("region {} names element {} of {}", r, e, count), "count from 0");
      }
      std::int32_t& region = result[static_cast<std::size_t>(e)];
      if (region >= 0) {
        fail(ErrorKind::conflicting_keys,
             fmt::format("{} is in regions {} and {}", list.name(e), region, r),
             "let regions not overlap");
      }
      if (!list.is_linear_tetrahedron(e) && !regions[r].hyperelastic) {
        fail(ErrorKind::unsupported_element,
             fmt::format("{} has a linear or corotational material", list.name(e)),
             "give hexahedra and quadratic tetrahedra a hyperelastic one, for instance "
             "neo-hookean");
      }
      region = static_cast<std::int32_t>(r);
    }
  }
  const auto none = std::ranges::find(result, -1);
  if (none != result.end()) {
    fail(ErrorKind::empty_region,
         fmt::format("{} has no material", list.name(static_cast<int>(none - result.begin()))),
         "let the regions cover every element");
  }
  return result;
}

void check_node(NodeId node, const mesh::Mesh& mesh, const char* what) {
  if (node >= 0 && node < mesh.node_count()) return;
  throw Error(ErrorKind::index_out_of_range, {.file = mesh.name, .item = what},
              fmt::format("node {} of {}", node, mesh.node_count()), "nodes count from 0");
}

void check_sample(const mesh::Mesh& mesh, const FemModelSettings& settings) {
  const ElementSample& sample = *settings.sample;
  const Location place{.file = mesh.name, .item = "sample"};
  if (sample.elements.empty()) {
    throw Error(ErrorKind::empty_list, place, "no element is sampled", "give at least one");
  }
  if (sample.weights.size() != sample.elements.size()) {
    throw Error(
        ErrorKind::wrong_length, place,
        fmt::format("{} weights for {} elements", sample.weights.size(), sample.elements.size()),
        "give one weight for each element");
  }
  if (!settings.point_masses.empty() || settings.total_mass || settings.equal_nodal_masses) {
    throw Error(ErrorKind::conflicting_keys, place,
                "masses of points and of the whole body cannot be sampled",
                "give densities, and add point masses where the sample is used");
  }
}

/// (elements,) how often each element counts: 1, or its weight in the sample, or 0.
std::vector<double> element_weights(const mesh::Mesh& mesh, const FemModelSettings& settings) {
  const auto count = static_cast<std::size_t>(ElementList(mesh).count());
  if (!settings.sample) return std::vector<double>(count, 1.0);
  check_sample(mesh, settings);
  const ElementSample& sample = *settings.sample;
  const auto fail = [&](ErrorKind kind, const std::string& message, const char* remedy) {
    throw Error(kind, {.file = mesh.name, .item = "sample"}, message, remedy);
  };
  std::vector<double> weights(count, 0.0);
  for (std::size_t k = 0; k < sample.elements.size(); ++k) {
    const NodeId e = sample.elements[k];
    if (e < 0 || static_cast<std::size_t>(e) >= count) {
      fail(ErrorKind::index_out_of_range, fmt::format("element {} of {}", e, count),
           "count from 0");
    }
    const double weight = sample.weights[k];
    if (!(weight > 0.0) || !std::isfinite(weight)) {
      fail(ErrorKind::out_of_range, fmt::format("the weight of element {} is {:g}", e, weight),
           "give a positive one, or leave the element out");
    }
    double& own = weights[static_cast<std::size_t>(e)];
    if (own != 0.0) {
      fail(ErrorKind::conflicting_keys, fmt::format("element {} is sampled twice", e),
           "name it once");
    }
    own = weight;
  }
  return weights;
}

template <typename Visit>
void each_membrane_face(const FemModelSettings& settings, Visit visit) {
  for (const MembraneLayer& layer : settings.membranes) {
    for (const mesh::Face& face : layer.faces) {
      std::vector<NodeId> nodes(face.nodes().begin(), face.nodes().end());
      if (face.is_quadratic()) nodes.insert(nodes.end(), face.middle.begin(), face.middle.end());
      visit(nodes);
    }
  }
}

/// Mesh node -> free number, or -1 where fixed or unused. @param weights (elements,).
std::vector<NodeId> number_free_nodes(const mesh::Mesh& mesh, const FemModelSettings& settings,
                                      std::span<const double> weights) {
  std::vector<NodeId> result(static_cast<std::size_t>(mesh.node_count()), -1);
  const auto use = [&](const auto& nodes) {
    for (const NodeId node : nodes) result[static_cast<std::size_t>(node)] = 0;
  };
  const ElementList list(mesh);
  for (int e = 0; e < list.count(); ++e) {
    if (weights[static_cast<std::size_t>(e)] != 0.0) use(list.nodes(e));
  }
  if (settings.sample) {
    each_membrane_face(settings, [&](const std::vector<NodeId>& nodes) {
      for (const NodeId node : nodes) check_node(node, mesh, "membranes");
      use(nodes);
    });
  }
  for (const NodeId node : settings.fixed_nodes) {
    check_node(node, mesh, "fixed");
    result[static_cast<std::size_t>(node)] = -1;
  }
  NodeId next = 0;
  for (NodeId& number : result) {
    if (number == 0) number = next++;
  }
  if (next == 0) {
    throw Error(ErrorKind::everything_fixed, {.item = "fixed"},
                fmt::format("all {} nodes are fixed", mesh.node_count()),
                "fix a smaller region, and check its unit");
  }
  return result;
}

linalg::BlockPattern make_pattern(const mesh::Mesh& mesh, const FemModelSettings& settings,
                                  std::span<const double> weights,
                                  std::span<const NodeId> free_index, int free_count,
                                  std::span<const SolidGroup> solids) {
  std::vector<std::int32_t> starts{0}, members;
  const auto add = [&](const auto& clique) {
    for (const NodeId node : clique) {
      check_node(node, mesh, "couplings");
      const NodeId free = free_index[static_cast<std::size_t>(node)];
      if (free >= 0) members.push_back(free);
    }
    starts.push_back(static_cast<std::int32_t>(members.size()));
  };
  const ElementList list(mesh);
  for (int e = 0; e < list.count(); ++e) {
    if (weights[static_cast<std::size_t>(e)] != 0.0) add(list.nodes(e));
  }
  if (settings.sample) each_membrane_face(settings, add);
  for (const SolidGroup& group : solids) {
    const ElementPatches& patches = group.patches;
    for (std::size_t p = 0; p < patches.volume.size(); ++p) {
      const auto first = static_cast<std::size_t>(patches.first_row[p]);
      add(std::span(patches.row_node)
              .subspan(first, static_cast<std::size_t>(patches.first_row[p + 1]) - first));
    }
  }
  for (const std::vector<NodeId>& coupling : settings.couplings) add(coupling);
  return linalg::BlockPattern::from_cliques(free_count, starts, members);
}

/// (elements,) m^3, times their weights.
std::vector<double> element_volumes(const mesh::Mesh& mesh, const ElementBatches& elements,
                                    std::span<const SolidGroup> solids) {
  std::vector<double> result(static_cast<std::size_t>(ElementList(mesh).count()));
  for (std::size_t slot = 0; slot < elements.tetrahedron.size(); ++slot) {
    if (elements.tetrahedron[slot] < 0) continue;
    result[static_cast<std::size_t>(elements.tetrahedron[slot])] =
        elements.constants[slot / material::kLanes].volume.value[slot % material::kLanes];
  }
  for (const SolidGroup& group : solids) {
    for (std::size_t slot = 0; slot < group.element.size(); ++slot) {
      if (group.element[slot] < 0) continue;
      double& volume = result[static_cast<std::size_t>(group.element[slot])];
      for (int q = 0; q < group.points; ++q) volume += group.weight(slot, q);
    }
  }
  return result;
}

}  // namespace

FemModel::FemModel(std::shared_ptr<const mesh::Mesh> mesh, const FemModelSettings& settings)
    : mesh_(std::move(mesh)) {
  check_mesh(*mesh_);
  const std::vector<std::int32_t> region_of = assign_regions(*mesh_, settings.regions);
  const std::vector<double> weights = element_weights(*mesh_, settings);
  free_index_ = number_free_nodes(*mesh_, settings, weights);
  for (NodeId node = 0; node < mesh_->node_count(); ++node) {
    if (free_index_[static_cast<std::size_t>(node)] >= 0) free_nodes_.push_back(node);
  }
  const std::vector<std::int32_t> rank = spatial_ranks(mesh_->nodes);
  elements_ = std::make_unique<const ElementBatches>(
      make_element_batches(*mesh_, settings.regions, region_of, weights, rank));
  solids_ = make_solid_groups(*mesh_, settings.regions, region_of, weights, rank, *elements_);
  pattern_ = make_pattern(*mesh_, settings, weights, free_index_, free_count(), solids_);
  list_held(settings.held_axes);
  gather_ = std::make_unique<const GatherLists>(
      make_gather_lists(*elements_, solids_, settings.regions, free_index_, rank, pattern_));
  membranes_ = Membranes(*mesh_, settings.membranes, free_index_, pattern_);

  const std::vector<double> volumes = element_volumes(*mesh_, *elements_, solids_);
  volume_ = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  make_masses(settings, element_masses(settings, region_of, volumes));
  if (total_mass_ == 0.0) make_pseudo_masses(settings, volumes);
}

FemModel::~FemModel() = default;

void FemModel::make_masses(const FemModelSettings& settings, std::span<const double> masses) {
  lumped_mass_ = lumped_masses(*mesh_, settings, masses);
  load_mass_ = mesh_->quadratic.empty() ? lumped_mass_ : load_masses(*mesh_, settings, masses);
  total_mass_ = lumped_mass_.sum();
  const bool consistent = settings.mass == MassMatrix::consistent;
  if (consistent) {
    mass_blocks_ = consistent_mass_blocks(*mesh_, free_index_, pattern_, masses);
  } else {
    free_mass_.reserve(free_nodes_.size());
    for (const NodeId node : free_nodes_) free_mass_.push_back(lumped_mass_[node]);
  }
  support_mass_ =
      support_masses(*mesh_, free_index_, consistent ? masses : std::span<const double>{},
                     lumped_mass_, settings.point_masses);
  if (settings.point_masses.empty()) return;
  if (!consistent) {
    mass_blocks_ = diagonal_mass_blocks(pattern_, free_mass_);
    free_mass_.clear();
  }
  for (const PointMass& point : settings.point_masses) {
    for (const NodeId node : point.nodes) check_node(node, *mesh_, "point mass");
    add_point_mass(point, free_index_, pattern_, mass_blocks_);
    for (std::size_t k = 0; k < point.nodes.size(); ++k) {
      load_mass_[point.nodes[k]] += point.mass * point.weights[k];
    }
  }
}

void FemModel::make_pseudo_masses(const FemModelSettings& settings,
                                  std::span<const double> volumes) {
  if (!settings.point_masses.empty()) return;
  std::vector<double> masses(volumes.begin(), volumes.end());
  for (double& mass : masses) mass *= kPseudoDensity;
  if (has_mass_blocks()) {
    mass_blocks_ = consistent_mass_blocks(*mesh_, free_index_, pattern_, masses);
    return;
  }
  const VectorX lumped = lumped_masses(*mesh_, settings, masses);
  for (std::size_t k = 0; k < free_nodes_.size(); ++k) free_mass_[k] = lumped[free_nodes_[k]];
}

void FemModel::list_held(const std::vector<HeldAxis>& axes) {
  std::vector<std::array<bool, 3>> holds(free_nodes_.size(), {false, false, false});
  for (const HeldAxis& held : axes) {
    check_node(held.node, *mesh_, "held axis");
    if (held.axis < 0 || held.axis > 2) {
      throw Error(ErrorKind::index_out_of_range, {.file = mesh_->name, .item = "held axis"},
                  fmt::format("axis {} of node {}", held.axis, held.node), "axes are 0, 1 and 2");
    }
    const NodeId free = free_index_[static_cast<std::size_t>(held.node)];
    if (free >= 0)
      holds[static_cast<std::size_t>(free)][static_cast<std::size_t>(held.axis)] = true;
  }
  for (std::size_t i = 0; i < holds.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (holds[i][c]) held_.push_back(static_cast<std::int32_t>(3 * i + c));
    }
  }
  if (held_.empty()) return;
  for (std::size_t j = 0; j < holds.size(); ++j) {
    for (std::int32_t b = pattern_.column_start[j]; b < pattern_.column_start[j + 1]; ++b) {
      const auto i = static_cast<std::size_t>(pattern_.row[static_cast<std::size_t>(b)]);
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t r = 0; r < 3; ++r) {
          if (!holds[i][r] && !holds[j][c]) continue;
          const auto at = static_cast<std::int64_t>(
              linalg::kBlockStride * static_cast<std::size_t>(b) + 4 * c + r);
          (i == j && r == c ? held_diagonals_ : held_entries_).push_back(at);
        }
      }
    }
  }
}

bool FemModel::has_memory() const {
  return std::ranges::any_of(solids_, [](const SolidGroup& g) { return g.law.has_memory(); });
}

std::span<const SolidGroup> FemModel::solids() const { return solids_; }

void FemModel::apply_mass(std::span<const double> x, std::span<double> y) const {
  using Rows = Eigen::Map<Points>;
  using ConstRows = Eigen::Map<const Points>;
  const ConstRows in(x.data(), free_count(), 3);
  Rows out(y.data(), free_count(), 3);
  if (!has_mass_blocks()) {
    for (Eigen::Index i = 0; i < free_count(); ++i) {
      out.row(i) = free_mass_[static_cast<std::size_t>(i)] * in.row(i);
    }
    return;
  }
  out.setZero();
  for (Eigen::Index j = 0; j < free_count(); ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (auto b = static_cast<std::size_t>(pattern_.column_start[column]);
         b < static_cast<std::size_t>(pattern_.column_start[column + 1]); ++b) {
      const Eigen::Index i = pattern_.row[b];
      out.row(i) += mass_blocks_[b] * in.row(j);
      if (i != j) out.row(j) += mass_blocks_[b] * in.row(i);
    }
  }
}

}  // namespace sinew::fem
