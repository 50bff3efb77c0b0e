/// @file
/// Cost of W for contact points on a face of a block, for docs/performance.md ("The cost of W"):
/// floating-point operations, counted from the elimination tree, and processor times of one thread.
///     compliance_cost [CELLS_ALONG_THE_FACE CELLS_ACROSS_IT]
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/elimination.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/linalg/index.hpp"
#include "sinew/linalg/scratch.hpp"

#include "mesh_matrices.hpp"

namespace {

using namespace sinew;
using namespace sinew::linalg;
using linalg::testing::BlockSystem;
using linalg::testing::TetrahedralMesh;

constexpr double kBillion = 1e9;
constexpr int kRounds = 5;

// A block of tetrahedra; the contact points are the nodes of its lowest face, which come first.
TetrahedralMesh block(int along, int across) {
  return linalg::testing::cell_mesh(along, along, across,
                                    [](const Vector3& p) { return Vector3(0.005 * p); });
}

// Pattern of the nodes from `first` on and the elements that join them.
BlockPattern pattern_of(const TetrahedralMesh& mesh, int first) {
  std::vector<std::int32_t> starts{0}, members;
  for (const auto& tet : mesh.tets) {
    for (const int node : tet) {
      if (node >= first) members.push_back(node - first);
    }
    starts.push_back(static_cast<std::int32_t>(members.size()));
  }
  return BlockPattern::from_cliques(static_cast<int>(mesh.nodes.size()) - first, starts, members);
}

Elimination eliminate(const NodeGraph& graph, const std::vector<std::int32_t>& order) {
  return {graph, order, std::vector<std::vector<std::int32_t>>(at(graph.nodes()))};
}

// Entries of L below the diagonal in column 0, 1 or 2 of a node with this number of nodes below it.
double below(double nodes, int column) { return 3.0 * nodes + 2.0 - column; }

// A column of L with m entries below the diagonal takes m divisions and the lower triangle of an
// outer product.
double factor_operations(const Elimination& tree) {
  double sum = 0.0;
  for (const auto& rows : tree.rows) {
    for (int c = 0; c < 3; ++c) {
      const double m = below(static_cast<double>(rows.size()), c);
      sum += m + m * (m + 1.0);
    }
  }
  return sum;
}

struct RowOperations {
  double substitution = 0.0, product = 0.0;
};

// Operations of L Y = H^T for the three rows of each of the first `points` nodes, which visit the
// columns from their node to the root, and of the lower triangle of Y^T Y.
RowOperations row_operations(const Elimination& tree, int points) {
  std::vector<double> passing(tree.order.size(), 0.0);  // points at the node or under it
  for (std::size_t k = 0; k < tree.order.size(); ++k) {
    passing[k] += tree.order[k] < points ? 1.0 : 0.0;
    if (tree.parent[k] >= 0) passing[at(tree.parent[k])] += passing[k];
  }
  RowOperations result;
  for (std::size_t k = 0; k < tree.order.size(); ++k) {
    const double rows = 3.0 * passing[k];
    for (int c = 0; c < 3; ++c) {
      const double m = below(static_cast<double>(tree.rows[k].size()), c);
      result.substitution += rows * (1.0 + 2.0 * m);
      result.product += rows * (rows + 1.0);
    }
  }
  return result;
}

// Elimination order: a fill-reducing order of the other nodes, then the points.
std::vector<std::int32_t> points_last(const TetrahedralMesh& mesh, int points, Ordering ordering) {
  std::vector<std::int32_t> order =
      fill_reducing_order(NodeGraph(pattern_of(mesh, points)), ordering);
  for (auto& node : order) node += points;
  for (int k = 0; k < points; ++k) order.push_back(k);
  return order;
}

void count(const TetrahedralMesh& mesh, int points) {
  const NodeGraph graph(pattern_of(mesh, 0));
  const Elimination free = eliminate(graph, fill_reducing_order(graph, Ordering::metis));
  const RowOperations rows = row_operations(free, points);
  const double unknowns = 3.0 * points;
  const auto line = [](const char* what, double operations) {
    std::printf("| %s | %.2g |\n", what, operations / kBillion);
  };
  std::printf("| %zu nodes, %d points | operations, billions |\n|---|---|\n", mesh.nodes.size(),
              points);
  line("factorisation, nested dissection", factor_operations(free));
  line("W: substitution of its rows", rows.substitution);
  line("W: product of the substituted rows", rows.product);
  for (const auto& [ordering, what] :
       {std::pair(Ordering::metis, "factorisation, points last, nested dissection of the rest"),
        std::pair(Ordering::amd, "factorisation, points last, minimum degree of the rest")}) {
    line(what, factor_operations(eliminate(graph, points_last(mesh, points, ordering))));
  }
  line("inverse of the Schur complement, which is W", 2.0 / 3.0 * unknowns * unknowns * unknowns);
}

// Shortest processor time of kRounds runs, s.
template <class Work>
double least_time(Work&& work) {
  double least = kInfinity;
  for (int k = 0; k < kRounds; ++k) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

// Speed of the kernel of products, on which all of this is based: rows x depth times depth x
// columns, with `leading` numbers from column to column.
void rate_product(int rows, int depth, int columns, int leading) {
  AlignedNumbers a, b, c;
  const std::size_t most = at(leading) * at(std::max(depth, columns)) + kOverrun;
  for (AlignedNumbers* numbers : {&a, &b, &c}) {
    grow(*numbers, most);
    std::fill_n(numbers->data(), most, 1.0);
  }
  const int times = static_cast<int>(kBillion / (2.0 * rows * depth * columns)) + 1;
  const double seconds = least_time([&] {
    for (int k = 0; k < times; ++k) {
      multiply({a.data(), leading, b.data(), leading, depth, columns}, 0, rows, c.data(), leading,
               Store::subtract);
    }
  });
  std::printf("| product of %d x %d and %d x %d, columns %d apart | %.0f GFlop/s |\n", rows, depth,
              depth, columns, leading, 2.0 * rows * depth * columns * times / seconds / kBillion);
}

// Factorises the block and computes W. The three rows of a point are the coordinates of its node.
void time_block(const TetrahedralMesh& mesh, int points) {
  BlockSystem system = linalg::testing::elastic_system(mesh, 0, 0);
  for (int j = 0; j < system.pattern.nodes; ++j) system.add(j, j, Matrix3::Identity());  // mass
  BorderPattern rows;
  std::vector<double> values;
  for (int k = 0; k < 3 * points; ++k) {
    rows.node.push_back(k / 3);
    rows.row_start.push_back(k + 1);
    for (int c = 0; c < 3; ++c) values.push_back(c == k % 3 ? 1.0 : 0.0);
  }
  ThreadPool pool(1);
  const auto plan = analyse(system.pattern, system.border, {.ordering = Ordering::metis});
  const auto factorisation = plan->create(pool);
  const double factor =
      least_time([&] { factorisation->factorise(system.matrix, system.rows, system.right); });
  const double compliance = least_time([&] { factorisation->condense_transient(rows, values); });
  std::printf("| factorisation of the block | %.3g ms |\n| W of %d rows | %.3g ms |\n",
              1e3 * factor, 3 * points, 1e3 * compliance);
}

}  // namespace

int main(int arguments, char** argument) {
  const int along = arguments > 2 ? std::atoi(argument[1]) : 21;
  const int across = arguments > 2 ? std::atoi(argument[2]) : 11;
  const TetrahedralMesh mesh = block(along, across);
  const int points = (along + 1) * (along + 1);
  count(mesh, points);
  std::printf("\n| one thread | |\n|---|---|\n");
  rate_product(1452, 135, 141, 1464);
  rate_product(96, 96, 96, 104);
  time_block(mesh, points);
  return 0;
}
