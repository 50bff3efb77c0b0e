// ModelBuilder: welds, and what they hold.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/constraint/coupling.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/core/error.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::sim {

namespace {

// Singular values below this, of the largest, belong to rigid motions that welds leave free.
constexpr double kFree = 1e-6;

// Three nodes as far from one another as they come: farthest from the middle, from that one, and
// from the line through both.
std::array<NodeId, 3> spread_nodes(const Points& nodes) {
  const Eigen::RowVector3d middle = nodes.colwise().mean();
  std::array<Eigen::Index, 3> found{};
  (nodes.rowwise() - middle).rowwise().squaredNorm().maxCoeff(&found[0]);
  const Eigen::RowVector3d a = nodes.row(found[0]);
  (nodes.rowwise() - a).rowwise().squaredNorm().maxCoeff(&found[1]);
  const Vector3 along = (nodes.row(found[1]) - a).normalized();
  double farthest = -1.0;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const double distance = along.cross(Vector3(nodes.row(i) - a)).norm();
    if (distance <= farthest) continue;
    farthest = distance;
    found[2] = i;
  }
  return {static_cast<NodeId>(found[0]), static_cast<NodeId>(found[1]),
          static_cast<NodeId>(found[2])};
}

// Bodies that welds connect have one number.
std::vector<int> groups_of(const Model& model) {
  std::vector<int> group(model.bodies().size());
  std::iota(group.begin(), group.end(), 0);
  for (const WeldModel& weld : model.welds()) {
    const int from = group[static_cast<std::size_t>(weld.second)];
    const int to = group[static_cast<std::size_t>(weld.first)];
    std::ranges::replace(group, from, to);
  }
  return group;
}

// Whether welds hold every rigid motion of loose bodies: the columns of d(delta)/d(shift, turn) are
// independent. @param bodies one group. @param held (all bodies,). @param size m, of the robot.
bool welds_hold(const Model& model, const std::vector<int>& bodies, const std::vector<char>& held,
                double size) {
  std::vector<int> column(held.size(), -1);
  int columns = 0;
  for (const int body : bodies) {
    if (held[static_cast<std::size_t>(body)] != 0) continue;
    column[static_cast<std::size_t>(body)] = columns;
    columns += 6;
  }
  if (columns == 0) return true;
  MatrixX normal = MatrixX::Zero(columns, columns);
  for (std::size_t w = 0; w < model.welds().size(); ++w) {
    for (const auto& pair : model.weld(static_cast<int>(w)).pairs()) {
      MatrixX rows = MatrixX::Zero(3, columns);
      const auto add = [&](const mechanics::MaterialPoint& point, double sign) {
        const auto body = static_cast<std::size_t>(point.body);
        if (column[body] < 0) return;
        const Vector3 at = model.bodies()[body]->rest_position(point.point) / size;
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

}  // namespace

int ModelBuilder::add_weld(const WeldSettings& settings) {
  check_body(settings.first, settings.place);
  check_body(settings.second, settings.place);
  for (const WeldModel& other : model_->welds_) {
    if (other.name == settings.name) {
      throw Error(ErrorKind::duplicate_key, settings.place,
                  fmt::format("two joints are called '{}'", settings.name), "rename one");
    }
  }
  if (settings.first == settings.second) {
    throw Error(ErrorKind::bad_argument, settings.place, "a body cannot be welded to itself",
                "name two bodies");
  }
  try {
    mechanics::BodyModel &first = body(settings.first), &second = body(settings.second);
    std::vector<int> points;
    if (!settings.nodes.empty()) fem_body(settings.first, settings.place, "weld of nodes");
    for (const NodeId node : settings.nodes) {
      const double whole = 1.0;
      points.push_back(first.attach_nodes({&node, 1}, {&whole, 1}));
    }
    for (Eigen::Index i = 0; i < settings.points.rows(); ++i) {
      points.push_back(first.attach(settings.points.row(i), mesh::Outside::error,
                                    fmt::format("point {} of weld '{}'", i, settings.name)));
    }
    if (points.empty()) {
      throw Error(ErrorKind::too_few_points, settings.place, "the weld has no point",
                  "name a region of the first body, or points");
    }
    std::vector<constraint::Tie::Pair> pairs;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vector3 at = first.rest_position(points[k]);
      const int on_second =
          second.attach(at, settings.outside,
                        fmt::format("point {} of weld '{}', {:.4g} {:.4g} {:.4g} m, on body '{}'",
                                    k, settings.name, at[0], at[1], at[2], second.name()));
      pairs.push_back({{settings.first, points[k]}, {settings.second, on_second}});
    }
    auto tie = std::make_unique<constraint::Tie>(settings.name, std::move(pairs));
    tie->declare(model_->rows_, model_->curvatures_);
    model_->welds_.push_back({settings.name, settings.place, settings.first, settings.second,
                              static_cast<int>(model_->constraints_.size())});
    model_->constraints_.push_back(std::move(tie));
    return static_cast<int>(model_->welds_.size()) - 1;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

void ModelBuilder::throw_loose(std::size_t index, bool welded) const {
  Place place = places_[index];
  if (place.item.empty()) place.item = "body '" + model_->bodies_[index]->name() + "'";
  throw Error(ErrorKind::nothing_fixed, place,
              welded ? "its welds leave it free to move, so it has no static equilibrium"
                     : "nothing holds this body, so it has no static equilibrium",
              welded
                  ? "fix a region of one of the welded bodies, weld three points that are not on "
                    "one line, or choose a dynamic integrator"
                  : "fix a region of it, weld it to a body that is held, or choose a dynamic "
                    "integrator");
}

// In statics something has to hold every body. What welds alone hold gets anchors.
void ModelBuilder::hold_bodies() {
  const std::vector<int> group = groups_of(*model_);
  const bool dynamic = model_->step_.integrator != mechanics::Integrator::quasi_static;
  for (std::size_t b = 0; b < held_.size(); ++b) {
    if (held_[b] != 0) continue;
    std::vector<int> connected;
    for (std::size_t other = 0; other < group.size(); ++other) {
      if (group[other] == group[b]) connected.push_back(static_cast<int>(other));
    }
    if (welds_hold(*model_, connected, held_, model_->size_)) {
      add_anchors(static_cast<int>(b));
    } else if (!dynamic) {
      throw_loose(b, connected.size() > 1);
    }
  }
}

void ModelBuilder::add_anchors(int index) {
  const fem::FemBodyModel& anchored = fem_body(index, {}, "anchor");
  double modulus = 0.0;
  for (const fem::Region& region : anchored.settings().elements.regions) {
    modulus = std::max(modulus, region.young_modulus());
  }
  const double stiffness = modulus * std::cbrt(anchored.elements().volume());
  for (const NodeId node : spread_nodes(body(index).mesh().nodes)) {
    const double whole = 1.0;
    auto point = std::make_unique<constraint::PointEffector>(
        "anchor",
        mechanics::MaterialPoint{index, body(index).attach_nodes({&node, 1}, {&whole, 1})});
    point->declare(model_->rows_, model_->curvatures_);
    model_->anchors_.push_back({index, static_cast<int>(model_->constraints_.size()), stiffness});
    model_->constraints_.push_back(std::move(point));
  }
}

// No body has room for what couples it to another.
void ModelBuilder::add_couplings() {
  for (std::size_t k = 0; k < model_->curvatures_.size(); ++k) {
    const auto& [first, second, curvature] = model_->curvatures_[k];
    if (first.body == second.body) continue;
    auto rows = std::make_unique<constraint::Coupling>(first, second);
    rows->declare(model_->rows_, model_->curvatures_);
    model_->couplings_.push_back(
        {static_cast<int>(k), static_cast<int>(model_->constraints_.size())});
    model_->constraints_.push_back(std::move(rows));
  }
}

}  // namespace sinew::sim
