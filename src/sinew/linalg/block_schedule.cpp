#include "sinew/linalg/block_schedule.hpp"

namespace sinew::linalg {

void BlockSchedule::factorise(BlockNumeric& numeric, const BlockInput& input, ThreadPool&) {
  const BlockSymbolic& s = numeric.symbolic();
  BlockNumeric::Scratch& scratch = numeric.scratch(0);
  for (int g = 0; g + 1 < static_cast<int>(s.group_start.size()); ++g) {
    for (int p = s.group_start[g]; p < s.group_start[g + 1]; ++p) {
      const Panel& panel = s.panels[p];
      numeric.assemble(p, input);
      numeric.update(p, 0, panel.height, scratch);
      numeric.factorise(p, scratch);
      if (panel.split) numeric.solve_rows(p, panel.below, panel.height, scratch);
    }
    numeric.update_border(g, scratch);
  }
  numeric.finish_border();
}

}  // namespace sinew::linalg
