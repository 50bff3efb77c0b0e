#include "sinew/fem/mass.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/solid_elements.hpp"
#include "sinew/mesh/hexahedron.hpp"
#include "sinew/mesh/quadratic.hpp"

namespace sinew::fem {

namespace {

void check_masses(const FemModelSettings& settings) {
  for (const MaterialRegion& region : settings.regions) {
    if (std::isfinite(region.density) && region.density >= 0.0) continue;
    throw Error(ErrorKind::out_of_range, {.file = {}, .item = "density"},
                fmt::format("the density is {} kg/m^3", region.density),
                "give a finite value of at least 0, for instance 1070 kg/m^3");
  }
  const double total = settings.total_mass.value_or(1.0);
  if (!(std::isfinite(total) && total > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.file = {}, .item = "mass"},
                fmt::format("the total mass is {} kg", total),
                "give a finite value above 0, for instance 42 g");
  }
}

/// Integral of N_a N_b over an element, divided by its volume.
class ElementMass {
 public:
  explicit ElementMass(std::size_t nodes) : nodes_(nodes), shares_(nodes * nodes, 0.0) {}
  double& at(std::size_t a, std::size_t b) { return shares_[a * nodes_ + b]; }
  double of(std::size_t a, std::size_t b) const { return shares_[a * nodes_ + b]; }
  double row_sum(std::size_t a) const {
    // Exactly a quarter for tetrahedra.
    if (nodes_ == 4) return 0.25;
    double sum = 0.0;
    for (std::size_t b = 0; b < nodes_; ++b) sum += of(a, b);
    return sum;
  }
  /// Lumped masses, positive: the row sum, or for quadratic elements the scaled diagonal.
  double lump(std::size_t a) const {
    if (nodes_ != 10) return row_sum(a);
    double trace = 0.0;
    for (std::size_t b = 0; b < nodes_; ++b) trace += of(b, b);
    return of(a, a) / trace;
  }

 private:
  std::size_t nodes_;
  std::vector<double> shares_;
};

/// 1/20 (1 + delta_ab) for tetrahedra; Gauss's rule for hexahedra, exact for parallelepipeds.
ElementMass element_mass(const mesh::Mesh& mesh, const ElementList& list, int element) {
  const auto nodes = list.nodes(element);
  ElementMass result(nodes.size());
  if (nodes.size() == 4) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) result.at(a, b) = a == b ? 0.1 : 0.05;
    }
    return result;
  }
  if (nodes.size() == 10) {
    const auto& products = mesh::quadratic_products();
    for (std::size_t a = 0; a < 10; ++a) {
      for (std::size_t b = 0; b < 10; ++b) {
        result.at(a, b) = products(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
      }
    }
    return result;
  }
  Eigen::Matrix<double, 8, 3> x;
  for (int a = 0; a < 8; ++a) x.row(a) = mesh.nodes.row(nodes[static_cast<std::size_t>(a)]);
  double volume = 0.0;
  for (const Vector3& point : mesh::hexahedron_points()) {
    const double weight = (x.transpose() * mesh::hexahedron_gradients(point)).determinant();
    const auto shapes = mesh::hexahedron_shapes(point);
    volume += weight;
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) result.at(a, b) += weight * shapes[a] * shapes[b];
    }
  }
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 0; b < 8; ++b) result.at(a, b) /= volume;
  }
  return result;
}

}  // namespace

std::vector<double> element_masses(const FemModelSettings& settings,
                                   std::span<const std::int32_t> region_of,
                                   std::span<const double> volumes) {
  check_masses(settings);
  std::vector<double> masses(volumes.begin(), volumes.end());
  const bool any_density = std::ranges::any_of(
      settings.regions, [](const MaterialRegion& region) { return region.density > 0.0; });
  if (any_density || !settings.total_mass) {
    for (std::size_t t = 0; t < masses.size(); ++t) {
      masses[t] *= settings.regions[static_cast<std::size_t>(region_of[t])].density;
    }
  }
  if (settings.total_mass) {
    const double sum = std::accumulate(masses.begin(), masses.end(), 0.0);
    for (double& mass : masses) mass *= *settings.total_mass / sum;
  }
  return masses;
}

namespace {

template <typename Share>
VectorX spread(const mesh::Mesh& mesh, const FemModelSettings& settings,
               std::span<const double> masses, Share share) {
  VectorX result = VectorX::Zero(mesh.node_count());
  const ElementList list(mesh);
  for (int e = 0; e < list.count(); ++e) {
    const auto nodes = list.nodes(e);
    const ElementMass shares = element_mass(mesh, list, e);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      if (settings.equal_nodal_masses) {
        result[nodes[a]] = 1.0;
      } else {
        result[nodes[a]] += masses[static_cast<std::size_t>(e)] * share(shares, a);
      }
    }
  }
  if (settings.equal_nodal_masses) result *= *settings.total_mass / result.sum();
  return result;
}

}  // namespace

VectorX lumped_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                      std::span<const double> masses) {
  if (settings.equal_nodal_masses && !settings.total_mass) {
    throw Error(ErrorKind::conflicting_keys, {.file = {}, .item = "mass"},
                "masses are to be spread evenly over nodes, but there is no total mass",
                "give the total mass");
  }
  if (settings.equal_nodal_masses && settings.mass == MassMatrix::consistent) {
    throw Error(ErrorKind::conflicting_keys, {.file = {}, .item = "mass"},
                "masses spread evenly over nodes have no consistent matrix",
                "choose the lumped mass matrix");
  }
  return spread(mesh, settings, masses,
                [](const ElementMass& shares, std::size_t a) { return shares.lump(a); });
}

VectorX load_masses(const mesh::Mesh& mesh, const FemModelSettings& settings,
                    std::span<const double> masses) {
  return spread(mesh, settings, masses,
                [](const ElementMass& shares, std::size_t a) { return shares.row_sum(a); });
}

std::vector<double> consistent_mass_blocks(const mesh::Mesh& mesh,
                                           std::span<const NodeId> free_index,
                                           const linalg::BlockPattern& pattern,
                                           std::span<const double> masses) {
  std::vector<double> result(static_cast<std::size_t>(pattern.blocks()), 0.0);
  const ElementList list(mesh);
  for (int e = 0; e < list.count(); ++e) {
    const auto nodes = list.nodes(e);
    if (masses[static_cast<std::size_t>(e)] == 0.0) continue;  // not sampled
    const ElementMass shares = element_mass(mesh, list, e);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const NodeId i = free_index[static_cast<std::size_t>(nodes[a])];
      for (std::size_t b = 0; b < nodes.size(); ++b) {
        const NodeId j = free_index[static_cast<std::size_t>(nodes[b])];
        if (j < 0 || i < j) continue;
        result[static_cast<std::size_t>(pattern.find(i, j))] +=
            masses[static_cast<std::size_t>(e)] * shares.of(a, b);
      }
    }
  }
  return result;
}

std::vector<double> diagonal_mass_blocks(const linalg::BlockPattern& pattern,
                                         std::span<const double> diagonal) {
  std::vector<double> result(static_cast<std::size_t>(pattern.blocks()), 0.0);
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    result[static_cast<std::size_t>(pattern.column_start[i])] = diagonal[i];
  }
  return result;
}

void add_point_mass(const PointMass& point, std::span<const NodeId> free_index,
                    const linalg::BlockPattern& pattern, std::vector<double>& blocks) {
  for (std::size_t a = 0; a < point.nodes.size(); ++a) {
    const NodeId i = free_index[static_cast<std::size_t>(point.nodes[a])];
    for (std::size_t b = 0; b < point.nodes.size(); ++b) {
      const NodeId j = free_index[static_cast<std::size_t>(point.nodes[b])];
      if (j < 0 || i < j) continue;
      const int block = pattern.find(i, j);
      if (block < 0) {
        throw Error(ErrorKind::bad_argument, {.file = {}, .item = "point mass"},
                    fmt::format("nodes {} and {} are not two nodes of one element", point.nodes[a],
                                point.nodes[b]),
                    "give the nodes and weights of a point in one element");
      }
      blocks[static_cast<std::size_t>(block)] += point.mass * point.weights[a] * point.weights[b];
    }
  }
}

std::vector<SupportMass> support_masses(const mesh::Mesh& mesh, std::span<const NodeId> free_index,
                                        std::span<const double> masses, const VectorX& lumped,
                                        const std::vector<PointMass>& points) {
  std::map<std::pair<NodeId, NodeId>, double> entries;  // by support, then node
  const auto is_fixed = [&](NodeId node) { return free_index[static_cast<std::size_t>(node)] < 0; };
  if (masses.empty()) {
    for (NodeId node = 0; node < static_cast<NodeId>(lumped.size()); ++node) {
      if (is_fixed(node) && lumped[node] != 0.0) entries[{node, node}] = lumped[node];
    }
  } else {
    const ElementList list(mesh);
    for (int e = 0; e < list.count(); ++e) {
      const auto nodes = list.nodes(e);
      const bool sampled = masses[static_cast<std::size_t>(e)] != 0.0;
      if (!sampled || std::ranges::none_of(nodes, is_fixed)) continue;
      const ElementMass shares = element_mass(mesh, list, e);
      for (std::size_t b = 0; b < nodes.size(); ++b) {
        if (!is_fixed(nodes[b])) continue;
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          entries[{nodes[b], nodes[a]}] += masses[static_cast<std::size_t>(e)] * shares.of(a, b);
        }
      }
    }
  }
  for (const PointMass& point : points) {
    for (std::size_t b = 0; b < point.nodes.size(); ++b) {
      if (!is_fixed(point.nodes[b])) continue;
      for (std::size_t a = 0; a < point.nodes.size(); ++a) {
        entries[{point.nodes[b], point.nodes[a]}] +=
            point.mass * point.weights[a] * point.weights[b];
      }
    }
  }
  std::vector<SupportMass> result;
  result.reserve(entries.size());
  for (const auto& [pair, mass] : entries) result.push_back({pair.second, pair.first, mass});
  return result;
}

}  // namespace sinew::fem
