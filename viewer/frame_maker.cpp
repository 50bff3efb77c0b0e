#include "frame_maker.hpp"

#include <limits>
#include <map>
#include <span>
#include <string_view>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"

#include "fields.hpp"
#include "joint_marks.hpp"

namespace sinew::viewer {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

FrameMaker::FrameMaker(const sim::Simulation& simulation, sim::Observables& observables,
                       const Description& description)
    : simulation_(simulation), observables_(observables), description_(description) {
  for (const auto& body : simulation.model().bodies()) means_.push_back(fem::nodal_mean(body));
  find_contacts();
}

// Finds the observables of contacts, which are in the order of contacts, each starting with its
// pose. There may be thousands, so a search by name would be too slow.
void FrameMaker::find_contacts() {
  static const std::map<std::string_view, std::size_t ContactPlaces::*> members = {
      {"pose", &ContactPlaces::pose},
      {"position", &ContactPlaces::position},
      {"normal", &ContactPlaces::normal},
      {"normal_force", &ContactPlaces::normal_force},
      {"friction_force", &ContactPlaces::friction_force},
      {"state", &ContactPlaces::state}};
  for (std::size_t k = 0; k < observables_.list().size(); ++k) {
    const run::Observable& one = observables_.list()[k];
    if (one.kind != run::ObservableKind::contact_point) continue;
    if (one.quantity == "pose") contacts_.emplace_back();
    const auto found = members.find(one.quantity);
    if (found != members.end()) contacts_.back().*(found->second) = k;
  }
}

void FrameMaker::fill_signals(Frame& frame) {
  frame.signals.reserve(description_.signals.size());
  for (std::size_t k = 0; k < observables_.list().size(); ++k) {
    if (!is_signal(observables_.list()[k])) continue;
    const std::span<const double> numbers = observables_.read(k);
    frame.signals.insert(frame.signals.end(), numbers.begin(), numbers.end());
  }
}

void FrameMaker::fill_body(std::size_t index, const FrameWishes& wishes, BodyFrame& frame) {
  const mechanics::Body& body = simulation_.body(static_cast<int>(index));
  const DisplaySurface& surface = description_.surfaces[index];
  const auto put_position = [](const auto& position, std::vector<float>& list) {
    for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(position[c]));
  };
  frame.positions.reserve(3 * surface.nodes.size());
  for (const NodeId node : surface.nodes) put_position(body.positions().row(node), frame.positions);
  if (wishes.inside) {
    for (const NodeId node : surface.inside.nodes) {
      put_position(body.positions().row(node), frame.inner_positions);
    }
    for (const mesh::Hexahedron& nodes : surface.inside.hexahedra) {
      Vector3 sum = Vector3::Zero();
      for (const NodeId node : nodes) sum += body.positions().row(node).transpose();
      put_position(Vector3(sum / static_cast<double>(nodes.size())), frame.inner_positions);
    }
  }
  frame.fields.resize(wishes.fields.size());
  frame.inner_fields.resize(wishes.fields.size());
  for (std::size_t f = 0; f < wishes.fields.size(); ++f) {
    if (!wishes.fields[f]) continue;
    const std::vector<double> nodal =
        list_fields()[f].values(body, simulation_, means_[index].get());
    const auto at = [&nodal](NodeId node) { return nodal[static_cast<std::size_t>(node)]; };
    const auto put = [](std::vector<float>& list, double value) {
      list.push_back(static_cast<float>(value));
    };
    for (const NodeId node : surface.nodes) put(frame.fields[f], at(node));
    if (!wishes.inside) continue;
    for (const NodeId node : surface.inside.nodes) put(frame.inner_fields[f], at(node));
    for (const mesh::Hexahedron& nodes : surface.inside.hexahedra) {
      double sum = 0.0;
      for (const NodeId node : nodes) sum += at(node);
      put(frame.inner_fields[f], sum / static_cast<double>(nodes.size()));
    }
  }
}

void FrameMaker::fill_points(Frame& frame) {
  const model::Model& model = simulation_.model();
  const auto put = [](std::vector<float>& list, const Vector3& point) {
    for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(point[c]));
  };
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const constraint::Cable* cable = model.cable(static_cast<int>(i));
    if (cable == nullptr) continue;
    const Points points = cable->points(simulation_.configuration());
    for (Eigen::Index k = 0; k < points.rows(); ++k) put(frame.cables, points.row(k).transpose());
  }
  const auto put_marks = [&](const constraint::Probe& probe) {
    const Points marks = probe.marks(simulation_.configuration());
    for (Eigen::Index k = 0; k < marks.rows(); ++k) put(frame.probes, marks.row(k).transpose());
  };
  for (const auto& probe : model.probes()) put_marks(probe);
  for (const sense::SensorModel& sensor : sense::sensors_of(model)) {
    if (const constraint::Probe* probe = sensor.source->probe()) put_marks(*probe);
  }
  // Rotations are not points.
  const auto put_numbers = [&](std::vector<float>& list, std::size_t observable) {
    const int effector = model.effector_index(observables_.list()[observable].owner);
    const bool point = model.effector(effector).kind() == constraint::EffectorKind::point;
    const std::span<const double> numbers = observables_.read(observable);
    put(list, point ? Vector3(numbers[0], numbers[1], numbers[2]) : Vector3::Constant(kNone));
  };
  for (std::size_t k = 0; k < observables_.list().size(); ++k) {
    const run::Observable& one = observables_.list()[k];
    if (one.kind == run::ObservableKind::effector) put_numbers(frame.effectors, k);
    const bool target = one.kind == run::ObservableKind::controller && one.quantity == "target";
    if (target) put_numbers(frame.targets, k);
  }
}

void FrameMaker::fill_contacts(Frame& frame) {
  for (const ContactPlaces& places : contacts_) {
    std::vector<float>& values = frame.contacts.emplace_back();
    const auto put = [&](const auto& numbers) {
      for (Eigen::Index k = 0; k < numbers.size(); ++k) {
        values.push_back(static_cast<float>(numbers[k]));
      }
    };
    using Pose = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
    const Eigen::Map<const Pose> pose(observables_.read(places.pose).data());
    put(pose.col(3));
    put(Eigen::Quaterniond(Matrix3(pose.leftCols<3>())).coeffs());  // x, y, z, w
    const auto position = observables_.read(places.position),
               normal = observables_.read(places.normal),
               normal_force = observables_.read(places.normal_force),
               friction_force = observables_.read(places.friction_force),
               state = observables_.read(places.state);
    values.reserve(7 * (1 + state.size()));
    for (std::size_t k = 0; k < state.size(); ++k) {
      using Vector = Eigen::Map<const Vector3>;
      const Vector across(&normal[3 * k]);
      // A point that was not found has no place. Older recordings have an arbitrary one, and zero
      // for its normal.
      const bool found = across.squaredNorm() > 0.0;
      put(found ? Vector3(Vector(&position[3 * k])) : Vector3(Vector3::Constant(kNone)));
      put(found ? Vector3(normal_force[k] * across + Vector(&friction_force[3 * k]))
                : Vector3(Vector3::Zero()));
      values.push_back(static_cast<float>(state[k]));
    }
  }
}

std::shared_ptr<Frame> FrameMaker::make(const FrameWishes& wishes) {
  observables_.refresh();
  auto frame = std::make_shared<Frame>();
  frame->step = static_cast<std::uint64_t>(simulation_.steps());
  frame->time = simulation_.time();
  frame->hash = simulation_.state().hash();
  frame->inside = wishes.inside;
  fill_signals(*frame);
  frame->bodies.resize(description_.surfaces.size());
  for (std::size_t b = 0; b < frame->bodies.size(); ++b) fill_body(b, wishes, frame->bodies[b]);
  fill_points(*frame);
  fill_contacts(*frame);
  frame->joints = joint_marks(simulation_);
  for (const Picked& at : wishes.picks) {
    const DisplaySurface& surface = description_.surfaces[static_cast<std::size_t>(at.body)];
    frame->picks.push_back(values_of(simulation_, at, surface.materials));
  }
  return frame;
}

}  // namespace sinew::viewer
