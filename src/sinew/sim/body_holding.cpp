#include "sinew/sim/body_holding.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "sinew/constraint/tie.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/anchors.hpp"
#include "sinew/sim/model_data.hpp"

namespace sinew::sim {

namespace {

// Singular values below this, of the largest, belong to rigid motions that welds leave free.
constexpr double kFree = 1e-6;

// Bodies that welds connect have one number.
std::vector<int> groups_of(const ModelData& data) {
  std::vector<int> group(data.bodies.size());
  std::iota(group.begin(), group.end(), 0);
  for (const WeldModel& weld : data.welds) {
    const int from = group[static_cast<std::size_t>(weld.second)];
    const int to = group[static_cast<std::size_t>(weld.first)];
    std::ranges::replace(group, from, to);
  }
  return group;
}

// Whether welds hold every rigid motion of loose bodies: the columns of d(delta)/d(shift, turn) are
// independent. @param bodies one group. @param held (all bodies,).
bool welds_hold(const ModelData& data, const std::vector<int>& bodies,
                const std::vector<char>& held) {
  std::vector<int> column(held.size(), -1);
  int columns = 0;
  for (const int body : bodies) {
    if (held[static_cast<std::size_t>(body)] != 0) continue;
    column[static_cast<std::size_t>(body)] = columns;
    columns += 6;
  }
  if (columns == 0) return true;
  MatrixX normal = MatrixX::Zero(columns, columns);
  for (const WeldModel& weld : data.welds) {
    const auto& tie = dynamic_cast<const constraint::Tie&>(data.constraint(weld.constraint));
    for (const constraint::Tie::Pair& pair : tie.pairs()) {
      MatrixX rows = MatrixX::Zero(3, columns);
      const auto add = [&](const mechanics::MaterialPoint& point, double sign) {
        const auto body = static_cast<std::size_t>(point.body);
        if (column[body] < 0) return;
        const Vector3 at = data.bodies[body]->rest_position(point.point) / data.size;
        for (int axis = 0; axis < 3; ++axis) {
          rows(axis, column[body] + axis) = sign;
          rows.col(column[body] + 3 + axis) = sign * Vector3(Vector3::Unit(axis).cross(at));
        }
      };
      add(pair.first, -1.0);
      add(pair.second, 1.0);
      normal.noalias() += rows.transpose() * rows;
    }
  }
  const VectorX values = linalg::symmetric_eigenvalues(normal);
  return values[0] > kFree * kFree * values[columns - 1];
}

[[noreturn]] void throw_loose(Place place, const std::string& name, bool welded) {
  if (place.item.empty()) place.item = "body '" + name + "'";
  throw Error(ErrorKind::nothing_fixed, place,
              welded ? "its welds leave it free to move, so it has no static equilibrium"
                     : "nothing holds this body, so it has no static equilibrium",
              welded
                  ? "fix a region of one of the welded bodies, weld three points that are not on "
                    "one line, or choose a dynamic integrator"
                  : "fix a region of it, weld it to a body that is held, or choose a dynamic "
                    "integrator");
}

}  // namespace

void BodyHolding::add(bool held, const Place& place) {
  held_.push_back(held ? 1 : 0);
  places_.push_back(place);
}

void BodyHolding::hold(ModelData& data) const {
  const std::vector<int> group = groups_of(data);
  for (std::size_t b = 0; b < held_.size(); ++b) {
    if (held_[b] != 0) continue;
    std::vector<int> connected;
    for (std::size_t other = 0; other < group.size(); ++other) {
      if (group[other] == group[b]) connected.push_back(static_cast<int>(other));
    }
    if (welds_hold(data, connected, held_)) {
      add_anchors(data, static_cast<int>(b));
    } else if (!data.step.dynamic()) {
      throw_loose(places_[b], data.bodies[b]->name(), connected.size() > 1);
    }
  }
}

}  // namespace sinew::sim
