#include "sinew/mesh/report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/whole.hpp"
#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {

namespace {

constexpr int kRatioBins = 10;
constexpr int kAngleBins = 9;

void count_value(Histogram& histogram, double value) {
  const auto bins = static_cast<double>(histogram.counts.size());
  const double place = (value - histogram.low) / (histogram.high - histogram.low) * bins;
  ++histogram.counts[whole<std::size_t>(place, 0, histogram.counts.size() - 1)];
}

void describe_edges(const Mesh& mesh, MeshReport& report) {
  std::vector<std::pair<NodeId, NodeId>> edges;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) edges.emplace_back(std::minmax(t[i], t[j]));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  if (edges.empty()) return;
  report.shortest_edge = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : edges) {
    const double length = (mesh.nodes.row(a) - mesh.nodes.row(b)).norm();
    report.shortest_edge = std::min(report.shortest_edge, length);
    report.longest_edge = std::max(report.longest_edge, length);
    report.mean_edge += length / static_cast<double>(edges.size());
  }
}

void describe_quality(const Mesh& mesh, MeshReport& report) {
  report.radius_ratio = {.low = 0.0, .high = 1.0, .counts = std::vector<int>(kRatioBins)};
  report.dihedral = {.low = 0.0, .high = 180.0, .counts = std::vector<int>(kAngleBins)};
  if (mesh.tetrahedra.empty()) return;
  report.min_radius_ratio = std::numeric_limits<double>::infinity();
  report.min_dihedral = 180.0;
  for (int e = 0; e < report.tetrahedra; ++e) {
    const Corners corners = corners_of(mesh, e);
    const double ratio = radius_ratio(corners);
    count_value(report.radius_ratio, ratio);
    report.mean_radius_ratio += ratio / report.tetrahedra;
    if (ratio < report.min_radius_ratio) {
      report.min_radius_ratio = ratio;
      report.worst_tetrahedron = e;
    }
    for (const double angle : dihedral_angles(corners)) {
      const double degrees = angle * 180.0 / std::numbers::pi;
      count_value(report.dihedral, degrees);
      report.min_dihedral = std::min(report.min_dihedral, degrees);
      report.max_dihedral = std::max(report.max_dihedral, degrees);
    }
  }
}

void describe_size(const Mesh& mesh, MeshReport& report) {
  const std::vector<char> used = used_nodes(mesh);
  Eigen::AlignedBox3d box;
  for (NodeId node = 0; node < mesh.node_count(); ++node) {
    if (used[static_cast<std::size_t>(node)] == 0) continue;
    box.extend(Vector3(mesh.nodes.row(node)));
  }
  report.unused_nodes = static_cast<int>(std::count(used.begin(), used.end(), 0));
  if (!box.isEmpty()) {
    report.low = box.min();
    report.high = box.max();
  }
  report.volume = volume(mesh);
  const Surface surface = boundary_surface(mesh);
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector3 origin = surface.nodes.row(a);
    const Vector3 first = Vector3(surface.nodes.row(b)) - origin;
    report.surface_area += 0.5 * first.cross(Vector3(surface.nodes.row(c)) - origin).norm();
  }
}

void describe_sets(const Mesh& mesh, MeshReport& report) {
  const auto add = [&](const auto& sets, const char* kind) {
    for (const auto& [name, members] : sets) {
      report.sets.push_back({.name = name, .kind = kind, .size = static_cast<int>(members.size())});
    }
  };
  add(mesh.node_sets, "nodes");
  add(mesh.triangle_sets, "triangles");
  add(mesh.tetrahedron_sets, "tetrahedra");
  add(mesh.hexahedron_sets, "hexahedra");
}

std::string bar(int count, int largest) {
  constexpr double kWidth = 40.0;
  const double length = largest > 0 ? std::ceil(kWidth * count / largest) : 0.0;
  return std::string(whole<std::size_t>(length, 0, 40), '#');
}

void print_histogram(const Histogram& histogram, std::string_view title, int decimals,
                     std::string& text) {
  const int largest = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double width =
      (histogram.high - histogram.low) / static_cast<double>(histogram.counts.size());
  text += fmt::format("{}\n", title);
  for (std::size_t k = 0; k < histogram.counts.size(); ++k) {
    const double low = histogram.low + width * static_cast<double>(k);
    const int count = histogram.counts[k];
    text += fmt::format("  {:>5.{}f} to {:<5.{}f}{:>9}  {}\n", low, decimals, low + width, decimals,
                        count, bar(count, largest));
  }
}

void print_quality(const MeshReport& report, std::string& text) {
  if (report.tetrahedra == 0 || report.radius_ratio.counts.empty()) return;
  text += fmt::format("edges        {} to {}, mean {}\n", format_length(report.shortest_edge),
                      format_length(report.longest_edge), format_length(report.mean_edge));
  text += fmt::format(
      "quality      radius ratio min {:.3f} (1 is best), mean {:.3f}; worst: tetrahedron {}\n",
      report.min_radius_ratio, report.mean_radius_ratio, report.worst_tetrahedron);
  text += fmt::format("             dihedral angles {:.1f} to {:.1f} degrees\n",
                      report.min_dihedral, report.max_dihedral);
  print_histogram(report.radius_ratio, "radius ratio (tetrahedra)", 1, text);
  print_histogram(report.dihedral, "dihedral angle in degrees (six per tetrahedron)", 0, text);
}

void print_sets(const MeshReport& report, std::string& text) {
  constexpr std::size_t kShown = 40;
  text += report.sets.empty() ? "sets         none\n" : "sets\n";
  for (std::size_t k = 0; k < std::min(kShown, report.sets.size()); ++k) {
    const SetSummary& set = report.sets[k];
    text += fmt::format("  {}: {} {}\n", set.name, set.size, set.kind);
  }
  if (report.sets.size() > kShown) {
    text += fmt::format("  and {} more\n", report.sets.size() - kShown);
  }
}

void print_loose(const MeshReport& report, std::string& text) {
  constexpr std::size_t kShown = 8;
  for (std::size_t k = 0; k < std::min(kShown, report.loose_text.size()); ++k) {
    text += fmt::format("loose        {}\n", report.loose_text[k]);
  }
  if (report.loose.size() > kShown) {
    text += fmt::format("             and {} more\n", report.loose.size() - kShown);
  }
}

void print_findings(const MeshReport& report, std::string& text) {
  const auto& parts = report.components.element_count;
  text += fmt::format("components   {}", parts.size());
  if (parts.size() > 1) {
    const auto end =
        parts.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(8, parts.size()));
    text += fmt::format(" of {}{} elements", fmt::join(parts.begin(), end, ", "),
                        parts.size() > 8 ? ", ..." : "");
  }
  text += '\n';
  print_loose(report, text);
  if (report.notes.reordered_elements > 0) {
    text += fmt::format("reordered    {} elements of the opposite node ordering are turned round\n",
                        report.notes.reordered_elements);
  }
  if (report.defects.empty()) text += "defects      none\n";
  for (const Defect& defect : report.defects) {
    text += fmt::format("defect       {} [{}]\n             remedy: {}\n", defect.message,
                        error_kind_name(defect.kind), defect.remedy);
  }
}

}  // namespace

std::string format_length(double metres) {
  const double size = std::abs(metres);
  if (size == 0.0 || size >= 1.0) return fmt::format("{:.4g} m", metres);
  if (size >= 1e-4) return fmt::format("{:.4g} mm", metres * 1e3);
  return fmt::format("{:.4g} um", metres * 1e6);
}

MeshReport describe(const Mesh& mesh, const CheckOptions& options) {
  MeshReport report;
  report.name = mesh.name;
  report.notes = mesh.notes;
  report.nodes = mesh.node_count();
  report.tetrahedra = static_cast<int>(mesh.tetrahedra.size());
  report.hexahedra = static_cast<int>(mesh.hexahedra.size());
  report.triangles = static_cast<int>(mesh.triangles.size());
  describe_sets(mesh, report);
  report.defects = find_defects(mesh, options);
  const bool measurable =
      std::none_of(report.defects.begin(), report.defects.end(), [](const Defect& defect) {
        return defect.kind == ErrorKind::index_out_of_range ||
               defect.kind == ErrorKind::non_finite_node;
      });
  if (!measurable) return report;
  report.components = components(mesh);
  report.loose = loose_joints(mesh);
  for (const LooseJoint& loose : report.loose) report.loose_text.push_back(describe(loose, mesh));
  describe_size(mesh, report);
  describe_edges(mesh, report);
  describe_quality(mesh, report);
  return report;
}

std::string format_report(const MeshReport& report) {
  const Vector3 size = report.high - report.low;
  std::string text;
  text += fmt::format("mesh         {}\n", report.name);
  if (!report.notes.format.empty()) {
    text += fmt::format("format       {}; 1 file unit = {}\n", report.notes.format,
                        format_length(report.notes.unit));
  }
  text += fmt::format("nodes        {}{}\n", report.nodes,
                      report.unused_nodes > 0
                          ? fmt::format(" ({} unused by volume elements)", report.unused_nodes)
                          : "");
  text +=
      fmt::format("elements     {} tetrahedra, {} hexahedra", report.tetrahedra, report.hexahedra);
  text += fmt::format("; {} triangles, {} other cells ignored\n", report.triangles,
                      report.notes.passed_over_cells);
  text += fmt::format("size         {} x {} x {}\n", format_length(size.x()),
                      format_length(size.y()), format_length(size.z()));
  text += fmt::format("bounds       ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) m\n",
                      report.low.x(), report.low.y(), report.low.z(), report.high.x(),
                      report.high.y(), report.high.z());
  text += fmt::format("volume       {:.6g} m^3 ({:.4g} cm^3), surface {:.4g} cm^2\n", report.volume,
                      report.volume * 1e6, report.surface_area * 1e4);
  print_findings(report, text);
  print_sets(report, text);
  print_quality(report, text);
  return text;
}

}  // namespace sinew::mesh
