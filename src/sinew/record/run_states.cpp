#include "sinew/record/run_states.hpp"

#include <chrono>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/core/build_info.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/pcc/arm_body.hpp"

namespace sinew::record {

namespace {

constexpr std::chrono::milliseconds kFlushInterval{500};

template <typename Array>
std::span<const double> numbers(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

}  // namespace

RunStates::RunStates(const std::filesystem::path& path, const sim::Simulation& simulation,
                     const inverse::InverseController* controller, const RecordSettings& settings)
    : simulation_(simulation), controller_(controller), file_(path) {
  describe(settings);
  time_ = declare("/time", {}, "s");
  declare_bodies(settings.states);
  declare_actuators();
  declare_effectors();
  declare_probes();
  if (settings.states) declare_contacts();
  declare_report();
}

int RunStates::declare(const std::string& path, const std::vector<std::uint64_t>& shape,
                       const char* unit) {
  const int series = file_.series(path, shape);
  file_.attribute(path, "unit", std::string_view(unit));
  return series;
}

void RunStates::describe(const RecordSettings& settings) {
  file_.attribute("/", "format", std::string_view("sinew-run"));
  file_.attribute("/", "format_version", kRunFormatVersion);
  file_.attribute("/", "sinew_version", version());
  file_.attribute("/", "scene_name", settings.scene_name);
  file_.attribute("/", "units", std::string_view("SI; every series names its own"));
  file_.attribute("/", "time_step", simulation_.model().step().time_step);
  file_.attribute("/", "record_every", static_cast<std::int64_t>(settings.every));
  file_.attribute("/", "fingerprint", fmt::format("{:016x}", simulation_.model().fingerprint()));
  file_.text("/scene", settings.scene);
}

void RunStates::declare_bodies(bool states) {
  const sim::Model& model = simulation_.model();
  const bool moving = model.step().integrator != mechanics::Integrator::quasi_static;
  for (const auto& body : model.bodies()) {
    const std::string& name = body->name();
    const mesh::Mesh& mesh = body->mesh();
    const auto nodes = static_cast<std::uint64_t>(mesh.node_count());
    const std::string folder = "/mesh/" + name;
    file_.dataset(folder + "/nodes", {nodes, 3}, numbers(mesh.nodes));
    file_.attribute(folder + "/nodes", "unit", std::string_view("m"));
    const auto elements = [&](const char* kind, const auto& list) {
      const std::size_t corners = std::tuple_size_v<std::decay_t<decltype(list[0])>>;
      const NodeId* first = list.empty() ? nullptr : list[0].data();
      file_.dataset(folder + kind, {list.size(), corners},
                    std::span<const std::int32_t>(first, corners * list.size()));
    };
    elements("/tetrahedra", mesh.tetrahedra);
    if (!mesh.quadratic.empty()) elements("/quadratic", mesh.quadratic);
    elements("/hexahedra", mesh.hexahedra);
    if (!states) continue;
    positions_.push_back(declare("/positions/" + name, {nodes, 3}, "m"));
    if (moving) velocities_.push_back(declare("/velocities/" + name, {nodes, 3}, "m/s"));
    const auto* arm = dynamic_cast<const pcc::ArmBodyModel*>(body.get());
    const auto count = static_cast<std::uint64_t>(arm == nullptr ? 0 : arm->arm().coordinates());
    coordinates_.push_back(arm == nullptr ? -1 : declare("/coordinates/" + name, {count}, "rad"));
  }
}

void RunStates::declare_actuators() {
  file_.group("/actuators");
  for (const sim::ActuatorModel& actuator : simulation_.model().actuators()) {
    const std::string folder = "/actuators/" + actuator.name;
    efforts_.push_back(declare(folder + "/effort", {}, actuator.effort_name().unit));
    motions_.push_back(declare(folder + "/motion", {}, actuator.motion_name().unit));
    file_.attribute(folder, "type", std::string_view(actuator_type_name(actuator.type)));
  }
}

void RunStates::declare_effectors() {
  const sim::Model& model = simulation_.model();
  file_.group("/effectors");
  for (std::size_t e = 0; e < model.effectors().size(); ++e) {
    effectors_.push_back(declare("/effectors/" + model.effectors()[e].name + "/position", {3},
                                 model.effector(static_cast<int>(e)).unit()));
  }
  if (controller_ == nullptr) return;
  for (const inverse::Task& task : controller_->settings().tasks) {
    const char* unit = model.effector(task.effector).unit();
    const std::string folder =
        "/controller/" + model.effectors()[static_cast<std::size_t>(task.effector)].name;
    targets_.push_back(declare(folder + "/target", {3}, unit));
    errors_.push_back(declare(folder + "/error", {}, unit));
  }
}

void RunStates::declare_probes() {
  const auto& probes = simulation_.model().probes();
  if (!probes.empty()) file_.group("/probes");
  for (const auto& probe : probes) {
    const std::string folder = "/probes/" + probe->name();
    const auto count = static_cast<std::uint64_t>(probe->components().size());
    const char* unit = probe->components().front().unit;
    const auto* line = dynamic_cast<const constraint::LineProbe*>(probe.get());
    if (line != nullptr) {
      probes_.push_back({declare(folder + "/value", {}, unit),
                         declare(folder + "/positions", {line->mark_count(), 3}, unit)});
    } else if (count == 1) {
      probes_.push_back({declare(folder + "/value", {}, unit), -1});
    } else {
      probes_.push_back({declare(folder + "/value", {count}, unit), -1});
    }
    file_.attribute(folder, "kind", std::string_view(probe->kind()));
  }
}

void RunStates::write_probe(int index) {
  const auto [value, positions] = probes_[static_cast<std::size_t>(index)];
  const std::vector<double> values = simulation_.probe_values(index);
  const std::span<const double> all(values);
  if (positions < 0) return file_.append(value, all);
  file_.append(value, all.first(1));
  file_.append(positions, all.subspan(1));
}

void RunStates::declare_contacts() {
  const sim::Model& model = simulation_.model();
  if (!model.contacts().empty()) file_.group("/contacts");
  for (std::size_t c = 0; c < model.contacts().size(); ++c) {
    const std::string folder = "/contacts/" + model.contacts()[c].name;
    const auto count =
        static_cast<std::uint64_t>(model.contact(static_cast<int>(c)).points().size());
    contacts_.push_back(
        {declare(folder + "/pose", {3, 4}, "1, m"), declare(folder + "/position", {count, 3}, "m"),
         declare(folder + "/gap", {count}, "m"), declare(folder + "/normal", {count, 3}, "1"),
         declare(folder + "/normal_force", {count}, "N"),
         declare(folder + "/friction_force", {count, 3}, "N"),
         declare(folder + "/state", {count}, "1")});
    file_.attribute(folder + "/state", "meaning", std::string_view("0 open, 1 stick, 2 slip"));
  }
}

void RunStates::write_contact(int index) {
  const ContactSeries& series = contacts_[static_cast<std::size_t>(index)];
  const sim::ContactMoment moment = simulation_.contact_moment(index);
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> pose = moment.pose.affine();
  file_.append(series.pose, numbers(pose));
  const auto count = static_cast<Eigen::Index>(moment.points.size());
  Points position(count, 3), normal(count, 3), friction(count, 3);
  VectorX gap(count), force(count), state(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const sim::ContactPoint& point = moment.points[static_cast<std::size_t>(k)];
    position.row(k) = point.position.transpose();
    normal.row(k) = point.normal.transpose();
    friction.row(k) = point.friction_force.transpose();
    gap[k] = point.gap;
    force[k] = point.normal_force;
    state[k] = static_cast<double>(point.state);
  }
  file_.append(series.position, numbers(position));
  file_.append(series.gap, numbers(gap));
  file_.append(series.normal, numbers(normal));
  file_.append(series.normal_force, numbers(force));
  file_.append(series.friction_force, numbers(friction));
  file_.append(series.state, numbers(state));
}

void RunStates::declare_report() {
  report_ = {declare("/report/residual", {}, "N"),
             declare("/report/relative_residual", {}, "1"),
             declare("/report/iterations", {}, "1"),
             declare("/report/scale", {}, "1"),
             declare("/report/smallest_volume_ratio", {}, "1"),
             declare("/report/status", {}, "1")};
}

void RunStates::write() {
  append(time_, simulation_.time());
  for (std::size_t b = 0; b < positions_.size(); ++b) {
    const mechanics::Body& body = simulation_.world().body(static_cast<int>(b));
    file_.append(positions_[b], numbers(body.positions()));
    if (!velocities_.empty()) file_.append(velocities_[b], numbers(body.velocities()));
    if (const auto* arm = dynamic_cast<const pcc::ArmBody*>(&body)) {
      const VectorX& q = arm->coordinates();
      file_.append(coordinates_[b], {q.data(), static_cast<std::size_t>(q.size())});
    }
  }
  for (std::size_t a = 0; a < efforts_.size(); ++a) {
    append(efforts_[a], simulation_.actuator(static_cast<int>(a)).effort);
    append(motions_[a], simulation_.actuator(static_cast<int>(a)).motion);
  }
  for (std::size_t e = 0; e < effectors_.size(); ++e) {
    append(effectors_[e], simulation_.effector_value(static_cast<int>(e)));
  }
  for (std::size_t p = 0; p < probes_.size(); ++p) write_probe(static_cast<int>(p));
  for (std::size_t c = 0; c < contacts_.size(); ++c) write_contact(static_cast<int>(c));
  for (std::size_t t = 0; t < targets_.size(); ++t) {
    append(targets_[t], controller_->settings().tasks[t].target.at(simulation_.time()));
    append(errors_[t], controller_->error(static_cast<int>(t)));
  }
  const sim::StepReport& report = simulation_.report();
  append(report_[0], report.residual);
  append(report_[1], report.relative_residual);
  append(report_[2], report.iterations);
  append(report_[3], report.scale);
  append(report_[4], report.smallest_volume_ratio);
  append(report_[5], static_cast<double>(report.status));
  file_.flush_after(kFlushInterval);
}

}  // namespace sinew::record
