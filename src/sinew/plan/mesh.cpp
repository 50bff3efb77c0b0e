#include "sinew/plan/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sinew/core/whole.hpp"

namespace sinew::plan {

VectorX refined(const VectorX& fractions, const VectorX& defects, double left) {
  constexpr int kMaxParts = 4;
  const auto count = static_cast<double>(fractions.size());
  std::vector<int> parts;
  for (const double defect : defects) {
    const double wanted = std::ceil(std::pow(count * defect / left, 0.25));
    parts.push_back(whole<int>(wanted, 1, kMaxParts));
  }
  if (*std::max_element(parts.begin(), parts.end()) == 1) parts.assign(parts.size(), 2);
  std::vector<double> cut;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    cut.insert(cut.end(), static_cast<std::size_t>(parts[k]),
               fractions[static_cast<Eigen::Index>(k)] / parts[k]);
  }
  return VectorX::Map(cut.data(), static_cast<Eigen::Index>(cut.size()));
}

MatrixX slopes(const VectorX& times, const MatrixX& values) {
  const Eigen::Index last = times.size() - 1;
  MatrixX result(values.rows(), values.cols());
  for (Eigen::Index k = 0; k <= last; ++k) {
    const Eigen::Index from = std::max<Eigen::Index>(k - 1, 0), to = std::min(k + 1, last);
    result.row(k) = (values.row(to) - values.row(from)) / (times[to] - times[from]);
  }
  return result;
}

}  // namespace sinew::plan
