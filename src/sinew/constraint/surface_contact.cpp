#include "sinew/constraint/surface_contact.hpp"

#include <algorithm>
#include <utility>

#include "sinew/collision/principal_frame.hpp"
#include "sinew/collision/surface_topology.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/mechanics/surface_trace.hpp"

namespace sinew::constraint {

namespace {

// Maximum number of points of one contact.
constexpr std::size_t kMaxPoints = 4096;

std::size_t vertices_of(const collision::SurfaceTopology& surface) {
  std::size_t count = 0;
  for (NodeId node = 0; node < surface.node_count(); ++node) {
    count += surface.triangles_of_node(node).empty() ? 0 : 1;
  }
  return count;
}

std::size_t most_points(const SurfaceContact::Side& first, const SurfaceContact::Side& second) {
  return std::min(kMaxPoints, vertices_of(*first.surface) + vertices_of(*second.surface));
}

}  // namespace

bool SurfaceContact::Side::holds(const collision::SurfacePoint& place) const {
  return std::ranges::all_of(trace->at(place).nodes, [&](NodeId node) {
    return node < 0 || held[static_cast<std::size_t>(node)] != 0;
  });
}

SurfaceContact::SurfaceContact(std::string name, Side first, Side second, const Settings& settings)
    : Contact(std::move(name), most_points(first, second), settings.friction, 2),
      first_(std::move(first)),
      second_(std::move(second)),
      settings_(settings) {}

void SurfaceContact::declare(mechanics::RowPattern& rows, std::vector<mechanics::StiffnessPair>&) {
  first_row_ = rows.rows();
  first_entry_ = rows.entries();
  row_count_ = 3 * static_cast<int>(size());
  for (int k = 0; k < row_count_; ++k) rows.add_row({first_.site, second_.site}, true);
}

void SurfaceContact::prepare(mechanics::RowValues& values) const {
  if (values.patch.empty()) values.patch.resize(values.direction.size());
}

void SurfaceContact::put(std::size_t point, const collision::ProximityPair& pair,
                         const Points& first_nodes, const Points& second_nodes,
                         mechanics::RowValues& values) const {
  const Matrix3 frame = collision::tangent_frame(pair.normal);
  put_patches(point, pair, frame, values);
  const Vector3 start = frame.transpose() * relative(first_nodes, second_nodes, point, values);
  values.offset.segment<3>(row(point)) = Vector3(-separation(), -start[1], -start[2]);
  values.reference.segment<3>(row(point)) = Vector3(start[0] - separation(), 0.0, 0.0);
}

void SurfaceContact::put_patches(std::size_t point, const collision::ProximityPair& pair,
                                 const Matrix3& frame, mechanics::RowValues& values) const {
  const mechanics::Patch one = first_.trace->at(pair.first), other = second_.trace->at(pair.second);
  for (int j = 0; j < 3; ++j) {
    const std::size_t at = entry(point, j);
    values.direction[at] = frame.col(j);
    values.direction[at + 1] = -frame.col(j);
    values.patch[at] = one;
    values.patch[at + 1] = other;
  }
}

double SurfaceContact::gap_of(const collision::ProximityPair& pair, const Points& first_nodes,
                              const Points& second_nodes) const {
  const Vector3 between = first_.trace->at(pair.first).mean(first_nodes) -
                          second_.trace->at(pair.second).mean(second_nodes);
  return pair.normal.dot(between) - separation();
}

void SurfaceContact::clear(std::size_t point, mechanics::RowValues& values) const {
  for (int j = 0; j < 3; ++j) {
    for (const std::size_t at : {entry(point, j), entry(point, j) + 1}) {
      values.direction[at].setZero();
      values.patch[at] = {};
    }
  }
  for (VectorX* numbers : {&values.offset, &values.reference, &values.delta}) {
    numbers->segment<3>(row(point)).setZero();
  }
}

bool SurfaceContact::idle(std::size_t point, const mechanics::RowValues& values) const {
  return values.patch.empty() || values.patch[entry(point)].nodes[0] < 0;
}

Vector3 SurfaceContact::relative(const Points& first, const Points& second, std::size_t point,
                                 const mechanics::RowValues& values) const {
  const std::size_t at = entry(point);
  return values.patch[at].mean(first) - values.patch[at + 1].mean(second);
}

void SurfaceContact::linearise(const Configuration& configuration,
                               mechanics::RowValues& values) const {
  for (std::size_t k = 0; k < size(); ++k) {
    if (!idle(k, values)) measure(configuration, k, values);
  }
}

void SurfaceContact::measure(const Configuration& configuration, std::size_t point,
                             mechanics::RowValues& values) const {
  values.delta.segment<3>(row(point)) =
      values.offset.segment<3>(row(point)) +
      frame(point, values).transpose() * relative(configuration.surface_nodes(body()),
                                                  configuration.surface_nodes(other_body()), point,
                                                  values);
}

double SurfaceContact::gap_at(const Points& first, const Points& second, std::size_t point,
                              const mechanics::RowValues& values) const {
  return values.direction[entry(point)].dot(relative(first, second, point, values)) +
         values.offset[row(point)];
}

// Half-way between the surfaces. An idle point is placed on the body.
Vector3 SurfaceContact::position_now(const Configuration& configuration, std::size_t point,
                                     const mechanics::RowValues& values) const {
  if (idle(point, values)) return configuration.surface_nodes(body()).row(0).transpose();
  const std::size_t at = entry(point);
  return 0.5 * (values.patch[at].mean(configuration.surface_nodes(body())) +
                values.patch[at + 1].mean(configuration.surface_nodes(other_body())));
}

Vector3 SurfaceContact::velocity_beside(const Configuration& configuration, std::size_t point,
                                        const mechanics::RowValues& values) const {
  return relative(configuration.surface_node_velocities(body()),
                  configuration.surface_node_velocities(other_body()), point, values);
}

Vector3 SurfaceContact::centre_velocity_beside(const Configuration& configuration,
                                               std::size_t) const {
  const auto mean = [&](int body) -> Vector3 {
    return configuration.surface_node_velocities(body).colwise().mean().transpose();
  };
  return mean(body()) - mean(other_body());
}

double SurfaceContact::linear_gap(const Configuration& configuration, std::size_t point,
                                  const mechanics::RowValues& values) const {
  return gap_at(configuration.surface_nodes(body()), configuration.surface_nodes(other_body()),
                point, values);
}

double SurfaceContact::gap_now(const Configuration& configuration, const Eigen::Isometry3d&,
                               std::size_t point, const mechanics::RowValues& values) const {
  return linear_gap(configuration, point, values);
}

double SurfaceContact::distance(const Configuration& configuration, std::size_t point,
                                const mechanics::RowValues& values) const {
  return relative(configuration.surface_nodes(body()), configuration.surface_nodes(other_body()),
                  point, values)
      .norm();
}

void SurfaceContact::save(std::size_t point, const collision::ProximityPair& pair,
                          const mechanics::RowValues& values, double* to) const {
  to = std::copy_n(frame(point, values).data(), 9, to);
  for (const collision::SurfacePoint* place : {&pair.first, &pair.second}) {
    for (const NodeId node : place->nodes) *to++ = static_cast<double>(node);
    to = std::copy_n(place->weights.data(), 3, to);
  }
}

collision::ProximityPair SurfaceContact::load(std::size_t point, const double* from,
                                              mechanics::RowValues& values) const {
  const Eigen::Map<const Matrix3> frame(from);
  from += 9;
  collision::ProximityPair pair;
  for (collision::SurfacePoint* place : {&pair.first, &pair.second}) {
    for (std::size_t k = 0; k < place->nodes.size(); ++k) {
      place->nodes[k] = whole<NodeId>(*from++, k == 0 ? 0 : -1);  // a feature has at least one node
    }
    place->weights = Eigen::Map<const Vector3>(from);
    from += 3;
  }
  put_patches(point, pair, frame, values);
  values.offset.segment<3>(row(point)) = Vector3(-separation(), 0.0, 0.0);
  return pair;
}

void SurfaceContact::describe(PartVisitor& visitor) const {
  friction().describe(visitor);
  visitor.number("separation", "m", settings_.separation).add(settings_.depth);
  visitor.add(is_within());
}

}  // namespace sinew::constraint
