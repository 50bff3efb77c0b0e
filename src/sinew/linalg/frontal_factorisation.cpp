#include "sinew/linalg/frontal_factorisation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

/// Minimum ratio of a pivot to its column.
constexpr double kThreshold = 1e-4;
/// A pivot below it counts as zero, in a matrix scaled to entries near one.
constexpr double kVanishing = 1e-14;
constexpr int kScalings = 3;
/// An unknown with more neighbours than this, and than this multiple of the median, gets no level.
constexpr std::size_t kFull = 64, kFullOverMedian = 8;

}  // namespace

FrontalFactorisation::FrontalFactorisation(int size, std::vector<SparseEntry> entries)
    : size_(size),
      entries_(std::move(entries)),
      level_of_(at(size), -1),
      scale_(VectorX::Ones(size)),
      largest_(size),
      place_(at(size), -1),
      local_(size) {
  order();
  plan_boundaries();
  diagonal_.resize(at(size));
  beside_.resize(at(size));
}

void FrontalFactorisation::order() {
  std::vector<std::vector<int>> beside(at(size_));
  for (const SparseEntry& entry : entries_) {
    if (entry.row == entry.column) continue;
    beside[at(entry.row)].push_back(entry.column);
    beside[at(entry.column)].push_back(entry.row);
  }
  for (auto& list : beside) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  // Rows with so many entries that they would join all levels.
  std::vector<std::size_t> degrees;
  degrees.reserve(beside.size());
  for (const auto& list : beside) degrees.push_back(list.size());
  const auto middle = degrees.begin() + static_cast<std::ptrdiff_t>(degrees.size() / 2);
  std::nth_element(degrees.begin(), middle, degrees.end());
  const std::size_t full = degrees.empty() ? 0 : std::max(kFull, kFullOverMedian * *middle);
  std::vector<int> last;
  for (int i = 0; i < size_; ++i) {
    if (beside[at(i)].size() > full) last.push_back(i);
  }
  const auto is_last = [&](int i) { return beside[at(i)].size() > full; };
  std::vector<int> found, distance(at(size_), -1);
  // Breadth-first search from `start` over the unknowns without a level.
  const auto spread = [&](int start) {
    for (const int i : found) distance[at(i)] = -1;
    found = {start};
    distance[at(start)] = 0;
    for (std::size_t next = 0; next < found.size(); ++next) {
      for (const int j : beside[at(found[next])]) {
        if (distance[at(j)] >= 0 || level_of_[at(j)] >= 0 || is_last(j)) continue;
        distance[at(j)] = distance[at(found[next])] + 1;
        found.push_back(j);
      }
    }
  };
  level_begin_ = {0};
  for (int i = 0; i < size_; ++i) {
    if (level_of_[at(i)] >= 0 || is_last(i)) continue;
    // Start at an end: repeatedly the farthest unknown with the fewest neighbours (George & Liu
    // 1979).
    int start = i;
    for (int depth = -1;;) {
      spread(start);
      const int deepest = distance[at(found.back())];
      if (deepest <= depth) break;
      depth = deepest;
      start = *std::min_element(found.begin(), found.end(), [&](int a, int b) {
        return std::pair(-distance[at(a)], beside[at(a)].size()) <
               std::pair(-distance[at(b)], beside[at(b)].size());
      });
    }
    const int before = static_cast<int>(level_begin_.size()) - 1;
    for (const int j : found) {
      const int level = before + distance[at(j)];
      level_of_[at(j)] = level;
      if (at(level) + 1 == level_begin_.size()) level_begin_.push_back(level_order_.size());
      level_order_.push_back(j);
      level_begin_.back() = level_order_.size();
    }
    for (const int j : found) distance[at(j)] = -1;
    found.clear();
  }
  if (!last.empty()) {
    const int level = static_cast<int>(level_begin_.size()) - 1;
    for (const int j : last) level_of_[at(j)] = level;
    level_order_.insert(level_order_.end(), last.begin(), last.end());
    level_begin_.push_back(level_order_.size());
  }
}

void FrontalFactorisation::plan_boundaries() {
  const auto levels = static_cast<std::size_t>(this->levels());
  boundary_.resize(levels);
  const auto taker = [&](const SparseEntry& entry) {
    return at(std::min(level_of_[at(entry.row)], level_of_[at(entry.column)]));
  };
  entry_begin_.assign(levels + 1, 0);
  for (const SparseEntry& entry : entries_) ++entry_begin_[taker(entry) + 1];
  for (std::size_t l = 0; l < levels; ++l) entry_begin_[l + 1] += entry_begin_[l];
  entry_order_.resize(entries_.size());
  std::vector<std::size_t> next(entry_begin_.begin(), entry_begin_.end() - 1);
  for (std::size_t e = 0; e < entries_.size(); ++e) entry_order_[next[taker(entries_[e])]++] = e;
  for (std::size_t l = 0; l < levels; ++l) {
    std::vector<int>& boundary = boundary_[l];
    const auto later = [&](int i) { return at(level_of_[at(i)]) > l; };
    if (l > 0) {
      std::copy_if(boundary_[l - 1].begin(), boundary_[l - 1].end(), std::back_inserter(boundary),
                   later);
    }
    for (std::size_t e = entry_begin_[l]; e < entry_begin_[l + 1]; ++e) {
      const SparseEntry& entry = entries_[entry_order_[e]];
      for (const int i : {entry.row, entry.column}) {
        if (later(i)) boundary.push_back(i);
      }
    }
    std::sort(boundary.begin(), boundary.end());
    boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  }
}

void FrontalFactorisation::scale(std::span<const double> values) {
  scale_.setOnes();
  for (int k = 0; k < kScalings; ++k) {
    largest_.setZero();
    for (std::size_t e = 0; e < entries_.size(); ++e) {
      const auto [i, j] = entries_[e];
      const double size = std::abs(values[e]) * scale_[i] * scale_[j];
      largest_[i] = std::max(largest_[i], size);
      largest_[j] = std::max(largest_[j], size);
    }
    for (int i = 0; i < size_; ++i) {
      if (largest_[i] > 0.0) scale_[i] /= std::sqrt(largest_[i]);
    }
  }
}

void FrontalFactorisation::assemble(std::size_t level, std::span<const double> values) {
  // Rows: delayed pivots, the unknowns of the level, and the boundary.
  const auto waiting = std::partition_point(rest_rows_.begin(), rest_rows_.end(),
                                            [&](int i) { return at(level_of_[at(i)]) < level; });
  rows_.assign(rest_rows_.begin(), waiting);
  rows_.insert(rows_.end(), level_order_.begin() + static_cast<std::ptrdiff_t>(level_begin_[level]),
               level_order_.begin() + static_cast<std::ptrdiff_t>(level_begin_[level + 1]));
  full_ = static_cast<int>(rows_.size());
  rows_.insert(rows_.end(), boundary_[level].begin(), boundary_[level].end());
  for (std::size_t r = 0; r < rows_.size(); ++r) place_[at(rows_[r])] = static_cast<int>(r);
  front_.assign(rows_.size() * rows_.size(), 0.0);
  const std::size_t before = rest_rows_.size();
  for (std::size_t j = 0; j < before; ++j) {
    const int column = place_[at(rest_rows_[j])];
    for (std::size_t i = j; i < before; ++i) {
      entry(place_[at(rest_rows_[i])], column) += rest_[j * before + i];
    }
  }
  for (std::size_t e = entry_begin_[level]; e < entry_begin_[level + 1]; ++e) {
    const std::size_t which = entry_order_[e];
    const auto [i, j] = entries_[which];
    entry(place_[at(i)], place_[at(j)]) += values[which] * scale_[i] * scale_[j];
  }
}

void FrontalFactorisation::swap(int a, int b) {
  if (a == b) return;
  const int size = static_cast<int>(rows_.size());
  for (int j = 0; j < a; ++j) std::swap(column(j)[a], column(j)[b]);
  std::swap(column(a)[a], column(b)[b]);
  for (int i = a + 1; i < b; ++i) std::swap(column(a)[i], column(i)[b]);
  for (int i = b + 1; i < size; ++i) std::swap(column(a)[i], column(b)[i]);
  std::swap(rows_[at(a)], rows_[at(b)]);
}

FrontalFactorisation::Pivot FrontalFactorisation::find(int next) {
  const int size = static_cast<int>(rows_.size());
  // The largest entry of a column in the remaining rows, except two; and the largest in rows that
  // may be pivots.
  struct Largest {
    double all = 0.0, full = 0.0;
    int where = -1;
  };
  const auto largest = [&](int c, int without) {
    Largest result;
    for (int i = next; i < size; ++i) {
      if (i == c || i == without) continue;
      const double value = std::abs(entry(i, c));
      result.all = std::max(result.all, value);
      if (i < full_ && value > result.full) {
        result.full = value;
        result.where = i;
      }
    }
    return result;
  };
  for (int c = next; c < full_; ++c) {
    const Largest own = largest(c, c);
    const double diagonal = std::abs(entry(c, c));
    if (diagonal > kVanishing && diagonal >= kThreshold * own.all) {
      swap(next, c);
      return Pivot::single;
    }
    if (own.where < 0) continue;
    const int r = own.where;
    const double cc = entry(c, c), rr = entry(r, r), cr = entry(r, c);
    const double determinant = std::abs(cc * rr - cr * cr);
    const double beside_c = largest(c, r).all, beside_r = largest(r, c).all;
    if (determinant > kVanishing * std::abs(cr) &&
        kThreshold * (std::abs(rr) * beside_c + std::abs(cr) * beside_r) <= determinant &&
        kThreshold * (std::abs(cr) * beside_c + std::abs(cc) * beside_r) <= determinant) {
      const int low = std::min(c, r), high = std::max(c, r);
      swap(next, low);
      swap(next + 1, high);
      return Pivot::twin;
    }
  }
  return Pivot::none;
}

void FrontalFactorisation::eliminate_single(int p) {
  const auto size = static_cast<Eigen::Index>(rows_.size());
  const double pivot = column(p)[p];
  diagonal_[at(fronts_.back().first + p)] = pivot;
  beside_[at(fronts_.back().first + p)] = 0.0;
  negative_ += pivot < 0.0 ? 1 : 0;
  const Eigen::Index left = size - p - 1;
  Eigen::Map<VectorX> own(column(p) + p + 1, left);
  Eigen::Map<VectorX> weighted(weighted_.data() + at(p) * rows_.size() + p + 1, left);
  weighted = own;
  own /= pivot;
  for (int j = p + 1; j < full_; ++j) {
    const Eigen::Index from = j - p - 1;
    Eigen::Map<VectorX>(column(j) + j, size - j).noalias() -=
        weighted[from] * own.tail(left - from);
  }
}

void FrontalFactorisation::eliminate_twin(int p) {
  const auto size = static_cast<Eigen::Index>(rows_.size());
  const double a = column(p)[p], b = column(p)[p + 1], c = column(p + 1)[p + 1];
  const double determinant = a * c - b * b;
  const std::size_t first = at(fronts_.back().first + p);
  diagonal_[first] = a;
  diagonal_[first + 1] = c;
  beside_[first] = b;
  beside_[first + 1] = 0.0;
  negative_ += determinant < 0.0 ? 1 : (a < 0.0 ? 2 : 0);
  const Eigen::Index left = size - p - 2;
  Eigen::Map<VectorX> one(column(p) + p + 2, left), two(column(p + 1) + p + 2, left);
  Eigen::Map<VectorX> weighted_one(weighted_.data() + at(p) * rows_.size() + p + 2, left);
  Eigen::Map<VectorX> weighted_two(weighted_.data() + at(p + 1) * rows_.size() + p + 2, left);
  weighted_one = one;
  weighted_two = two;
  one = (c * weighted_one - b * weighted_two) / determinant;
  two = (a * weighted_two - b * weighted_one) / determinant;
  column(p)[p + 1] = 0.0;  // entry of L
  for (int j = p + 2; j < full_; ++j) {
    const Eigen::Index from = j - p - 2;
    Eigen::Map<VectorX>(column(j) + j, size - j).noalias() -=
        weighted_one[from] * one.tail(left - from) + weighted_two[from] * two.tail(left - from);
  }
}

void FrontalFactorisation::eliminate() {
  weighted_.resize(rows_.size() * rows_.size());
  done_ = 0;
  while (done_ < full_) {
    const Pivot pivot = find(done_);
    if (pivot == Pivot::none) break;
    if (pivot == Pivot::single) {
      eliminate_single(done_);
      done_ += 1;
    } else {
      eliminate_twin(done_);
      done_ += 2;
    }
  }
  // Pass on the remainder: delayed columns are up to date, those of the boundary are not.
  const std::size_t size = rows_.size(), left = size - at(done_);
  rest_.resize(left * left);
  rest_rows_.assign(rows_.begin() + done_, rows_.end());
  using Panel = Eigen::Map<const MatrixX>;
  const Panel own(front_.data(), static_cast<Eigen::Index>(size), done_);
  const Panel weighted(weighted_.data(), static_cast<Eigen::Index>(size), done_);
  for (int j = done_; j < static_cast<int>(size); ++j) {
    const auto length = static_cast<Eigen::Index>(size) - j;
    Eigen::Map<VectorX> to(rest_.data() + at(j - done_) * left + at(j - done_), length);
    to = Eigen::Map<const VectorX>(column(j) + j, length);
    if (j >= full_ && done_ > 0) {
      to.noalias() -= own.bottomRows(length) * weighted.row(j).transpose();
    }
  }
}

bool FrontalFactorisation::factor(std::span<const double> values) {
  scale(values);
  fronts_.clear();
  panels_.clear();
  front_rows_.clear();
  rest_rows_.clear();
  negative_ = 0;
  int eliminated = 0;
  for (std::size_t level = 0; level < at(levels()); ++level) {
    assemble(level, values);
    fronts_.push_back(
        {panels_.size(), front_rows_.size(), static_cast<int>(rows_.size()), 0, eliminated});
    eliminate();
    fronts_.back().pivots = done_;
    eliminated += done_;
    panels_.insert(panels_.end(), front_.begin(),
                   front_.begin() + static_cast<std::ptrdiff_t>(rows_.size() * at(done_)));
    front_rows_.insert(front_rows_.end(), rows_.begin(), rows_.end());
  }
  return eliminated == size_;
}

void FrontalFactorisation::solve(VectorX& x) {
  x.array() *= scale_.array();
  const auto gather = [&](const Front& front) {
    for (int r = 0; r < front.size; ++r) local_[r] = x[front_rows_[front.rows + at(r)]];
  };
  for (const Front& front : fronts_) {
    gather(front);
    for (int p = 0; p < front.pivots; ++p) {
      const Eigen::Index left = front.size - p - 1;
      const Eigen::Map<const VectorX> below(
          panels_.data() + front.panel + at(p) * at(front.size) + at(p) + 1, left);
      local_.segment(p + 1, left).noalias() -= local_[p] * below;
    }
    // Solve with D, and scatter the rows.
    for (int p = 0; p < front.pivots; ++p) {
      const std::size_t k = at(front.first + p);
      const double a = diagonal_[k], b = beside_[k];
      if (b == 0.0) {
        local_[p] /= a;
      } else {
        const double c = diagonal_[k + 1], determinant = a * c - b * b;
        const double one = local_[p], two = local_[p + 1];
        local_[p] = (c * one - b * two) / determinant;
        local_[p + 1] = (a * two - b * one) / determinant;
        ++p;
      }
    }
    for (int r = 0; r < front.size; ++r) x[front_rows_[front.rows + at(r)]] = local_[r];
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const Front& front = fronts_[f];
    gather(front);
    for (int p = front.pivots; p-- > 0;) {
      const Eigen::Index left = front.size - p - 1;
      const Eigen::Map<const VectorX> below(
          panels_.data() + front.panel + at(p) * at(front.size) + at(p) + 1, left);
      local_[p] -= below.dot(local_.segment(p + 1, left));
    }
    for (int p = 0; p < front.pivots; ++p) x[front_rows_[front.rows + at(p)]] = local_[p];
  }
  x.array() *= scale_.array();
}

void FrontalFactorisation::multiply(std::span<const double> values, const VectorX& x,
                                    VectorX& result) const {
  result.setZero(size_);
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const auto [i, j] = entries_[e];
    result[i] += values[e] * x[j];
    if (i != j) result[j] += values[e] * x[i];
  }
}

}  // namespace sinew::linalg
