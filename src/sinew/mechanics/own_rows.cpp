#include "sinew/mechanics/own_rows.hpp"

#include <algorithm>

namespace sinew::mechanics {

OwnRows::OwnRows(int body, const RowPattern& world, int surface_site) {
  for (int row = 0; row < world.rows(); ++row) {
    const auto end = world.row_start[static_cast<std::size_t>(row) + 1];
    bool mine = false;
    for (auto e = world.row_start[static_cast<std::size_t>(row)]; e < end; ++e) {
      const Site& site = world.site[static_cast<std::size_t>(e)];
      if (site.body != body) continue;
      if (site.number == surface_site) {
        surface.push_back({row, e});
        continue;
      }
      mine = true;
      entries.push_back({static_cast<int>(rows.size()), e, site.number});
    }
    if (mine) rows.push_back(row);
  }
}

RowMemory::RowMemory(const OwnRows& own)
    : effort(VectorX::Zero(static_cast<Eigen::Index>(own.rows.size()))),
      directions(own.entries.size(), Vector3::Zero()) {}

void RowMemory::restart() {
  effort.setZero();
  std::ranges::fill(directions, Vector3::Zero());
}

std::size_t RowMemory::size() const {
  return static_cast<std::size_t>(effort.size()) + 3 * directions.size();
}

double* RowMemory::save(double* to) const {
  to = std::copy_n(effort.data(), effort.size(), to);
  for (const Vector3& direction : directions) to = std::copy_n(direction.data(), 3, to);
  return to;
}

const double* RowMemory::load(const double* from) {
  std::copy_n(from, effort.size(), effort.data());
  from += effort.size();
  for (Vector3& direction : directions) {
    std::copy_n(from, 3, direction.data());
    from += 3;
  }
  return from;
}

}  // namespace sinew::mechanics
