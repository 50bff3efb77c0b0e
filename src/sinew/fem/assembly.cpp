#include "sinew/fem/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/fem/block_gather.hpp"
#include "sinew/fem/element_history.hpp"
#include "sinew/fem/element_kernel.hpp"
#include "sinew/fem/solid_kernel.hpp"
#include "sinew/linalg/aligned_buffer.hpp"
#include "sinew/linalg/thread_scratch.hpp"
#include "sinew/mechanics/step_system.hpp"

namespace sinew::fem {

namespace {

using material::kLanes;
constexpr int kPatchGrain = 256;
constexpr int kNodeGrain = 4096;  // below this a thread's wake-up costs more than the work

/// Splits the visits to columns so that threads have equal numbers of contributions.
std::vector<int> split_columns(const FemModel& model, int threads) {
  const linalg::BlockPattern& pattern = model.pattern();
  const std::vector<std::int32_t>& start = model.gather().contribution_start;
  std::vector<int> splits(static_cast<std::size_t>(threads) + 1, pattern.nodes);
  splits[0] = 0;
  int column = 0;
  for (int thread = 1; thread < threads; ++thread) {
    const auto share = static_cast<std::int64_t>(start.back()) * thread / threads;
    const auto before = [&](int j) {
      return start[static_cast<std::size_t>(
          model.gather().block_visit[static_cast<std::size_t>(j)])];
    };
    while (column < pattern.nodes && before(column) < share) ++column;
    splits[static_cast<std::size_t>(thread)] = column;
  }
  return splits;
}

std::size_t bytes_of(const auto& vector) { return vector.capacity() * sizeof(vector[0]); }

}  // namespace

struct Assembly::Workspace {
  std::size_t force_records = 0, solid_blocks = 0;  // doubles, of the records below
  std::size_t patch_slots = 0, patches = 0, patch_rows = 0;
  linalg::AlignedBuffer points, start_points;  // (n, 4) m
  bool started = false;                        // start_points are in use
  linalg::AlignedBuffer matrix;
  std::vector<double> forces;
  std::vector<double> batch_energy;             // one per batch, those of solid groups last
  std::vector<SmallestRatio> thread_ratios;     // one per thread, for batches, then for each group
  std::vector<SmallestRatio> thread_stretches;  // one per thread, of batches in evaluate()
  std::vector<int> column_splits;
  double energy = 0.0;
  SmallestRatio smallest{1.0, 0};
};

// Records of elements and patches in one evaluate(), which gather() sums. In scratch memory.
struct Assembly::Records {
  Records(const Workspace& work, int batches, Tangent tangent)
      : element_records(record_size(tangent) * kLanes * static_cast<std::size_t>(batches)),
        scratch(work.force_records + element_records + work.solid_blocks + work.patch_slots +
                work.patches + 16 * work.patch_slots + 4 * work.patch_rows + kPadding),
        forces(scratch.take(work.force_records)),
        elements(scratch.take(element_records)),
        solids(scratch.take(work.solid_blocks)),
        slot_ratios(scratch.take(work.patch_slots)),
        patch_ratios(scratch.take(work.patches)),
        spread(scratch.take(16 * work.patch_slots)),
        rows(scratch.take(4 * work.patch_rows)) {}

  static std::size_t record_size(Tangent tangent) {
    if (tangent == Tangent::none) return 0;
    const bool corotated = tangent == Tangent::corotated || tangent == Tangent::rates;
    return static_cast<std::size_t>(corotated ? kCorotatedRecord : kExactRecord);
  }

  static constexpr std::size_t kPadding = 7 * 7;  // between the arrays, see ThreadScratch
  std::size_t element_records;
  linalg::ThreadScratch scratch;
  double* forces;
  double* elements;      // of tetrahedra
  double* solids;        // blocks of hyperelastic elements
  double* slot_ratios;   // det F of members of patches
  double* patch_ratios;  // Jm
  double* spread;        // see sum_rows()
  double* rows;
};

Assembly::Assembly(std::shared_ptr<const FemModel> model, ThreadPool& pool)
    : model_(std::move(model)), pool_(&pool), work_(std::make_unique<Workspace>()) {
  const auto batches = static_cast<std::size_t>(model_->elements().batches());
  std::size_t solid_batches = 0;
  work_->force_records = kLanes * kForceRecord * batches;
  for (const SolidGroup& group : model_->solids()) {
    const std::size_t slots = group.element.size();
    work_->force_records += 4 * static_cast<std::size_t>(group.nodes) * slots;
    work_->solid_blocks += kSolidBlock * static_cast<std::size_t>(group.pairs()) * slots;
    solid_batches += static_cast<std::size_t>(group.batches());
    if (group.patches.empty()) continue;
    work_->patch_slots += slots;
    work_->patches += group.patches.volume.size();
    work_->patch_rows += group.patches.row_node.size();
  }
  work_->points = linalg::AlignedBuffer(4 * static_cast<std::size_t>(model_->mesh().node_count()));
  work_->forces.resize(3 * static_cast<std::size_t>(model_->free_count()));
  work_->matrix = linalg::AlignedBuffer(linalg::kBlockStride *
                                        static_cast<std::size_t>(model_->pattern().blocks()));
  work_->batch_energy.resize(batches + solid_batches);
  work_->thread_ratios.resize(static_cast<std::size_t>(pool.size()) *
                              (1 + model_->solids().size()));
  work_->thread_stretches.resize(static_cast<std::size_t>(pool.size()));
  work_->column_splits = split_columns(*model_, pool.size());
}

Assembly::~Assembly() = default;
Assembly::Assembly(Assembly&&) noexcept = default;

void Assembly::evaluate(const Points& positions, const AssemblyWeights& weights) {
  if (positions.rows() != model_->mesh().node_count()) {
    throw Error(ErrorKind::wrong_shape, {.file = {}, .item = "positions"},
                fmt::format("there are {} rows for {} nodes", positions.rows(),
                            model_->mesh().node_count()),
                "give one row for every node of the mesh");
  }
  const Records records(*work_, model_->elements().batches(), weights.tangent);
  evaluate_elements(positions, weights.tangent, weights.softened, records);
  AssemblyWeights scaled = weights;
  scaled.stiffness *= weights.moduli;
  gather(scaled, records);
  if (weights.moduli != 1.0) {
    for (double& force : work_->forces) force *= weights.moduli;
    work_->energy *= weights.moduli;
  }
  work_->energy += model_->membranes().add(positions, weights.tangent, weights.stiffness,
                                           work_->forces, matrix());
}

bool Assembly::linearise_from(const Points* positions) {
  const bool before = work_->started;
  work_->started = positions != nullptr && !model_->solids().empty();
  if (!work_->started) return before;
  if (work_->start_points.size() == 0) {
    work_->start_points = linalg::AlignedBuffer(work_->points.size());
  }
  pad(*positions, work_->start_points.data());
  return before;
}

void Assembly::load_positions(const Points& positions) { pad(positions, work_->points.data()); }

void Assembly::pad(const Points& positions, double* to) {
  const int nodes = static_cast<int>(positions.rows());
  pool_->for_range(nodes, kNodeGrain, [&](int begin, int end, int) {
    for (Eigen::Index i = begin; i < end; ++i) {
      for (Eigen::Index c = 0; c < 3; ++c) {
        to[4 * i + c] = positions(i, c);
      }
    }
  });
}

void Assembly::evaluate_elements(const Points& positions, Tangent tangent, bool softened,
                                 const Records& records) {
  Workspace& work = *work_;
  load_positions(positions);
  const SmallestRatio none{std::numeric_limits<double>::infinity(), -1};
  std::ranges::fill(work.thread_ratios, none);
  std::ranges::fill(work.thread_stretches, none);
  const ElementBatches& elements = model_->elements();
  const ElementOutput output{records.forces, records.elements, work.batch_energy.data()};
  if (elements.batches() > 0) {
    pool_->for_range(elements.batches(), 1, [&](int begin, int end, int thread) {
      const auto own = static_cast<std::size_t>(thread);
      const BatchMeasures measured =
          evaluate_batches(elements, begin, end, work.points.data(), tangent, output);
      work.thread_ratios[own] = measured.volume;
      work.thread_stretches[own] = measured.stretch;
    });
  }
  SmallestRatio* ratios = work.thread_ratios.data();
  SolidOutput solids{records.forces, records.solids, work.batch_energy.data() + elements.batches(),
                     records.patch_ratios, records.spread};
  if (work.started) solids.start = work.start_points.data();
  for (std::size_t g = 0; g < model_->solids().size(); ++g) {
    const SolidGroup& group = model_->solids()[g];
    if (history_ != nullptr) solids.history = history_->of_step(g, softened);
    ratios += pool_->size();
    average_patches(group, records);
    pool_->for_range(group.batches(), 1, [&](int begin, int end, int thread) {
      ratios[thread] = evaluate_solids(group, begin, end, work.points.data(), tangent, solids);
    });
    if (tangent != Tangent::none) spread_patches(group, records);
    solids.energy += group.batches();
  }
  work.energy = 0.0;
  for (const double energy : work.batch_energy) work.energy += energy;
  find_smallest();
}

void Assembly::average_patches(const SolidGroup& group, const Records& records) {
  const ElementPatches& patches = group.patches;
  if (patches.empty()) return;
  const std::span ratios(records.slot_ratios + patches.slots_before, group.element.size());
  const std::span means(records.patch_ratios + patches.patches_before, patches.volume.size());
  pool_->for_range(group.batches(), 1, [&](int begin, int end, int) {
    volume_ratios(group, begin, end, work_->points.data(), ratios.data());
  });
  pool_->for_range(patches.count(), kPatchGrain, [&](int begin, int end, int) {
    average_ratios(group, begin, end, ratios, means);
  });
}

void Assembly::spread_patches(const SolidGroup& group, const Records& records) {
  const ElementPatches& patches = group.patches;
  if (patches.empty()) return;
  const double* spread = records.spread + 16 * patches.slots_before;
  double* rows = records.rows + 4 * patches.rows_before;
  pool_->for_range(patches.count(), kPatchGrain,
                   [&](int begin, int end, int) { sum_rows(group, begin, end, spread, rows); });
}

void Assembly::find_smallest() {
  work_->smallest = {std::numeric_limits<double>::infinity(), -1};
  for (const SmallestRatio& ratio : work_->thread_ratios) {  // ascending slots: the first wins ties
    if (ratio.value < work_->smallest.value) work_->smallest = ratio;
  }
}

void Assembly::advance(const Points& positions, ElementHistory& history) {
  load_positions(positions);
  for (std::size_t g = 0; g < model_->solids().size(); ++g) {
    pool_->for_range(model_->solids()[g].batches(), 1, [&](int begin, int end, int) {
      history.end_step(g, begin, end, work_->points.data());
    });
  }
}

VolumeMeasure Assembly::measure_volume(const Points& positions) {
  Workspace& work = *work_;
  load_positions(positions);
  std::ranges::fill(work.thread_ratios, SmallestRatio{std::numeric_limits<double>::infinity(), -1});
  const ElementBatches& elements = model_->elements();
  if (elements.batches() > 0) {
    pool_->for_range(elements.batches(), 1, [&](int begin, int end, int thread) {
      work.thread_ratios[static_cast<std::size_t>(thread)] =
          measure_batches(elements, begin, end, work.points.data());
    });
  }
  SmallestRatio* ratios = work.thread_ratios.data();
  for (const SolidGroup& group : model_->solids()) {
    ratios += pool_->size();
    pool_->for_range(group.batches(), 1, [&](int begin, int end, int thread) {
      ratios[thread] = measure_solids(group, begin, end, work.points.data());
    });
  }
  find_smallest();
  return {minimum_volume_ratio(), worst_element()};
}

std::optional<StretchMeasure> Assembly::evaluated_stretch() const {
  if (!model_->solids().empty()) return {};
  SmallestRatio found{0.0, -1};
  for (const SmallestRatio& stretch : work_->thread_stretches) {
    if (stretch.value < found.value) found = stretch;
  }
  const double bound = std::sqrt(-found.value);
  if (found.slot < 0 || !(bound <= mechanics::kSaneStretch)) return {};
  return StretchMeasure{bound, element_of(found.slot)};
}

StretchMeasure Assembly::measure_stretch(const Points& positions) {
  Workspace& work = *work_;
  load_positions(positions);
  const SmallestRatio none{std::numeric_limits<double>::infinity(), -1};
  std::ranges::fill(work.thread_ratios, none);
  const ElementBatches& elements = model_->elements();
  if (elements.batches() > 0) {
    pool_->for_range(elements.batches(), 1, [&](int begin, int end, int thread) {
      work.thread_ratios[static_cast<std::size_t>(thread)] =
          measure_batch_stretch(elements, begin, end, work.points.data());
    });
  }
  SmallestRatio* ratios = work.thread_ratios.data();
  for (const SolidGroup& group : model_->solids()) {
    ratios += pool_->size();
    pool_->for_range(group.batches(), 1, [&](int begin, int end, int thread) {
      ratios[thread] = measure_solid_stretch(group, begin, end, work.points.data());
    });
  }
  SmallestRatio found = none;
  for (const SmallestRatio& ratio : work.thread_ratios) {
    if (ratio.value < found.value) found = ratio;
  }
  if (found.slot < 0) return {};
  return {-found.value, element_of(found.slot)};
}

void Assembly::gather(const AssemblyWeights& weights, const Records& records) {
  Workspace& work = *work_;
  const FemModel& model = *model_;
  const bool blocks = model.has_mass_blocks();
  pool_->run([&](int thread) {
    const int begin = work.column_splits[static_cast<std::size_t>(thread)];
    const int end = work.column_splits[static_cast<std::size_t>(thread) + 1];
    gather_forces(model.gather(), begin, end, records.forces, work.forces.data());
    gather_blocks(model.gather(), model.pattern(), begin, end, records.elements, records.solids,
                  records.rows, weights, blocks ? nullptr : model.free_mass().data(),
                  blocks ? model.mass_blocks().data() : nullptr, work.matrix.data());
  });
}

std::span<const double> Assembly::forces() const { return work_->forces; }
std::span<const double> Assembly::matrix() const {
  return {work_->matrix.data(), work_->matrix.size()};
}
std::span<double> Assembly::matrix() { return {work_->matrix.data(), work_->matrix.size()}; }

void Assembly::add_block(int free_i, int free_j, const Matrix3& k) {
  const int block = model_->pattern().find(free_i, free_j);
  if (block < 0) {
    throw Error(ErrorKind::internal, {},
                fmt::format("block ({}, {}) is not in the pattern", free_i, free_j),
                "declare the coupling when the model is made");
  }
  double* target = work_->matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(block);
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) target[4 * c + r] += free_i >= free_j ? k(r, c) : k(c, r);
  }
}

void Assembly::hold() {
  double* matrix = work_->matrix.data();
  for (const std::int64_t entry : model_->held_entries()) matrix[entry] = 0.0;
  for (const std::int64_t entry : model_->held_diagonals()) {
    // The motion of a held coordinate is zero with any value here; one of the size of the others
    // keeps the factor well scaled.
    matrix[entry] = matrix[entry] == 0.0 ? 1.0 : std::abs(matrix[entry]);
  }
}

double Assembly::strain_energy() const { return work_->energy; }
double Assembly::minimum_volume_ratio() const { return work_->smallest.value; }

int Assembly::worst_element() const { return element_of(work_->smallest.slot); }

int Assembly::element_of(std::int32_t slot) const {
  if (slot < 0) return -1;
  const auto& tetrahedra = model_->elements().tetrahedron;
  if (static_cast<std::size_t>(slot) < tetrahedra.size()) {
    return tetrahedra[static_cast<std::size_t>(slot)];
  }
  for (const SolidGroup& group : model_->solids()) {
    const auto own = static_cast<std::size_t>(slot - group.first_slot);
    if (own < group.element.size()) return group.element[own];
  }
  return -1;
}

std::size_t Assembly::bytes() const {
  const Workspace& work = *work_;
  return sizeof(Assembly) + sizeof(Workspace) + work.points.bytes() + work.start_points.bytes() +
         bytes_of(work.forces) + work.matrix.bytes() + bytes_of(work.batch_energy) +
         bytes_of(work.thread_ratios) + bytes_of(work.column_splits);
}

}  // namespace sinew::fem
