#include "sinew/world/connected_bodies.hpp"

#include <cstddef>

#include "sinew/mechanics/step_system.hpp"
#include "sinew/model/model.hpp"

namespace sinew::world {

void mark_connected_bodies(const model::Model& model,
                           std::span<mechanics::StepSystem* const> systems,
                           std::span<const double> effort, std::span<char> marks) {
  const mechanics::RowPattern& rows = model.rows();
  const auto body = [&](std::size_t entry) {
    return static_cast<std::size_t>(rows.site[entry].body);
  };
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t row = 0; row < effort.size(); ++row) {
      if (effort[row] == 0.0) continue;
      const auto first = static_cast<std::size_t>(rows.row_start[row]);
      const auto end = static_cast<std::size_t>(rows.row_start[row + 1]);
      bool reached = false;
      for (std::size_t e = first; e < end; ++e) {
        reached = reached || (marks[body(e)] != 0 && systems[body(e)]->size() > 0);
      }
      if (!reached) continue;
      for (std::size_t e = first; e < end; ++e) {
        grows = grows || marks[body(e)] == 0;
        marks[body(e)] = 1;
      }
    }
  }
}

}  // namespace sinew::world
