// sinew info: describes a file of any kind.
#include <algorithm>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/chamber.hpp"
#include "sinew/constraint/contact.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/quantity.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/read.hpp"
#include "sinew/mesh/report.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/record/run_file.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sim/state_io.hpp"

#include "arguments.hpp"
#include "commands.hpp"
#include "info_body.hpp"
#include "material_text.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// The same facts for people and for programs. (The JSON type's move asserts what cannot fail.)
struct Facts {  // NOLINT(bugprone-exception-escape)
  ordered_json json;
  std::string text;
};

struct InfoOptions {
  std::string file;
  std::optional<std::string> unit;
  bool json = false;
  bool parameters = false;
};

std::string size_text(const Vector3& size) {
  return fmt::format("{} x {} x {}", mesh::format_length(size.x()), mesh::format_length(size.y()),
                     mesh::format_length(size.z()));
}

ordered_json histogram(const mesh::Histogram& histogram) {
  return {{"low", histogram.low}, {"high", histogram.high}, {"counts", histogram.counts}};
}

ordered_json mesh_json(const mesh::MeshReport& report) {
  ordered_json json = {{"kind", "mesh"},
                       {"name", report.name},
                       {"format", report.notes.format},
                       {"nodes", report.nodes},
                       {"unused_nodes", report.unused_nodes},
                       {"tetrahedra", report.tetrahedra},
                       {"hexahedra", report.hexahedra},
                       {"triangles", report.triangles},
                       {"reordered_elements", report.notes.reordered_elements},
                       {"passed_over_cells", report.notes.passed_over_cells},
                       {"low_m", triple(report.low)},
                       {"high_m", triple(report.high)},
                       {"volume_m3", report.volume},
                       {"surface_area_m2", report.surface_area},
                       {"components", report.components.element_count.size()}};
  json["loose_parts"] = ordered_json::array();
  for (std::size_t k = 0; k < report.loose.size(); ++k) {
    json["loose_parts"].push_back({{"elements", report.loose[k].elements},
                                   {"centre_m", triple(report.loose[k].centre)},
                                   {"shared_nodes", report.loose[k].shared},
                                   {"motions", report.loose[k].motions},
                                   {"text", report.loose_text[k]}});
  }
  if (report.tetrahedra > 0) {
    json["edge_m"] = {{"shortest", report.shortest_edge},
                      {"mean", report.mean_edge},
                      {"longest", report.longest_edge}};
    json["radius_ratio"] = {{"least", report.min_radius_ratio},
                            {"mean", report.mean_radius_ratio},
                            {"worst_tetrahedron", report.worst_tetrahedron},
                            {"histogram", histogram(report.radius_ratio)}};
    json["dihedral_degrees"] = {{"least", report.min_dihedral},
                                {"largest", report.max_dihedral},
                                {"histogram", histogram(report.dihedral)}};
  }
  json["sets"] = ordered_json::array();
  for (const mesh::SetSummary& set : report.sets) {
    json["sets"].push_back({{"name", set.name}, {"kind", set.kind}, {"size", set.size}});
  }
  json["defects"] = ordered_json::array();
  for (const mesh::Defect& defect : report.defects) {
    json["defects"].push_back({{"kind", error_kind_name(defect.kind)},
                               {"message", defect.message},
                               {"remedy", defect.remedy}});
  }
  return json;
}

Facts mesh_facts(const InfoOptions& options) {
  mesh::ReadOptions settings;
  if (options.unit) {
    settings.unit = length_unit("--unit", *options.unit);
    settings.unit_given = true;
  }
  mesh::Mesh mesh = mesh::read_mesh_unchecked(options.file, settings);
  const auto inside = [&](NodeId node) { return node >= 0 && node < mesh.node_count(); };
  const bool numbered =
      std::ranges::all_of(mesh.tetrahedra,
                          [&](const auto& tet) { return std::ranges::all_of(tet, inside); }) &&
      std::ranges::all_of(mesh.hexahedra,
                          [&](const auto& hex) { return std::ranges::all_of(hex, inside); });
  if (numbered) mesh::reorder_elements(mesh);  // counts itself in the notes
  const mesh::MeshReport report = mesh::describe(mesh, {.unit_given = settings.unit_given});
  return {mesh_json(report), mesh::format_report(report)};
}

Facts surface_facts(const InfoOptions& options) {
  mesh::SurfaceOptions settings;
  settings.unit_given = true;  // described, not judged
  if (options.unit) settings.unit = length_unit("--unit", *options.unit);
  const mesh::Surface surface = mesh::read_surface(options.file, settings);
  const Vector3 size =
      (surface.nodes.colwise().maxCoeff() - surface.nodes.colwise().minCoeff()).transpose();
  Facts facts;
  facts.json = {{"kind", "surface"},
                {"name", surface.name},
                {"nodes", surface.nodes.rows()},
                {"triangles", surface.triangles.size()},
                {"size_m", triple(size)}};
  facts.text = fmt::format("{}: surface\n  {} nodes, {} triangles\n  size {}\n", surface.name,
                           surface.nodes.rows(), surface.triangles.size(), size_text(size));
  add_solid(facts.json, facts.text, surface);
  return facts;
}

void add_notice(Facts& facts, const Notice& notice) {
  facts.json["notices"].push_back({{"level", notice_level_name(notice.level)},
                                   {"kind", notice_kind_name(notice.kind)},
                                   {"item", notice.place.item},
                                   {"message", notice.message},
                                   {"remedy", notice.remedy}});
  facts.text += fmt::format("  {}: {}\n", notice_level_name(notice.level), notice.text());
}

void add_joint(Facts& facts, const model::Model& model, int index) {
  const model::JointModel& joint = model.joints()[static_cast<std::size_t>(index)];
  const auto name = [&](int body) -> std::string {
    return body == model::kWorld ? "world" : model.body(body).name();
  };
  const constraint::Tie* tie = model.tie(index);
  const std::string type =
      tie != nullptr ? "weld" : constraint::joint_type_name(model.joint(index)->type());
  ordered_json json = {
      {"name", joint.name}, {"type", type}, {"bodies", {name(joint.first), name(joint.second)}}};
  if (tie != nullptr) {
    json["points"] = tie->pairs().size();
    facts.text += fmt::format("  joint {}: {} points of {} welded to {}\n", joint.name,
                              tie->pairs().size(), name(joint.first), name(joint.second));
  } else {
    facts.text += fmt::format("  joint {}: {} of {} and {}\n", joint.name, type, name(joint.first),
                              name(joint.second));
  }
  facts.json["joints"].push_back(json);
}

void add_membranes(Facts& facts, const mechanics::BodyModel& body) {
  const auto* own = mechanics::as<const fem::HasElements>(body);
  if (own == nullptr) return;
  const auto& layers = own->settings().elements.membranes;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const fem::MembraneLayer& layer = layers[k];
    const double area = own->elements().membranes().area(k);
    facts.json["membranes"].push_back({{"name", layer.name},
                                       {"body", body.name()},
                                       {"faces", layer.faces.size()},
                                       {"area_m2", area},
                                       {"thickness_m", layer.thickness}});
    facts.text +=
        fmt::format("  membrane {}: {} thick, {} in {} faces of {}\n", layer.name,
                    mesh::format_length(layer.thickness), rounded_quantity(area, dimension::kArea),
                    layer.faces.size(), body.name());
  }
}

// JSON always has them; the text, if they are asked for.
void add_parameters(Facts& facts, const model::Model& model, bool as_text) {
  const std::vector<Parameter> all = model.parameters();
  std::size_t width = 0;
  for (const Parameter& one : all) width = std::max(width, one.path.size());
  facts.json["parameters"] = ordered_json::array();
  for (const Parameter& one : all) {
    facts.json["parameters"].push_back(
        {{"path", one.path}, {"value", one.value}, {"unit", one.unit}});
    if (!as_text) continue;
    facts.text += fmt::format("  {:<{}}  {:g}{}{}\n", one.path, width, one.value,
                              one.unit.empty() ? "" : " ", one.unit);
  }
}

Facts scene_facts(const InfoOptions& options) {
  const scene::Robot robot = scene::load(options.file);
  const model::Model& model = *robot.model;
  const double duration = robot.description.run_duration();
  Facts facts;
  facts.json = {{"kind", "scene"},
                {"name", robot.description.name},
                {"time_step_s", model.step().time_step},
                {"integrator", mechanics::integrator_name(model.step().integrator)},
                {"duration_s", duration}};
  facts.text = fmt::format(
      "{}: scene, {}, {} a step, {}\n", robot.description.name,
      mechanics::integrator_name(model.step().integrator),
      format_quantity(model.step().time_step, dimension::kTime),
      duration > 0.0 ? rounded_quantity(duration, dimension::kTime) : "without a duration");
  for (const auto& body : model.bodies()) add_body(facts.json, facts.text, body);
  for (const scene::BodyDescription& body : robot.description.bodies) {
    add_laws(facts.json, facts.text, body);
  }
  for (const Notice& notice : robot.notices) add_notice(facts, notice);
  for (std::size_t a = 0; a < model.actuators().size(); ++a) {
    const model::ActuatorModel& actuator = model.actuators()[a];
    const constraint::Cable* cable = model.cable(static_cast<int>(a));
    ordered_json entry = {{"name", actuator.name}, {"type", actuator.kind->word}};
    const constraint::Chamber* chamber = model.chamber(static_cast<int>(a));
    std::string size;
    if (cable != nullptr) {
      entry["rest_length_m"] = cable->rest_length();
      size = fmt::format(", {} long", mesh::format_length(cable->rest_length()));
    }
    if (chamber != nullptr) {
      entry["rest_volume_m3"] = chamber->rest_volume();
      entry["rest_area_m2"] = chamber->rest_area();
      size = fmt::format(", {} in {} faces",
                         rounded_quantity(chamber->rest_volume(), dimension::kVolume),
                         chamber->faces().size());
    }
    facts.json["actuators"].push_back(entry);
    facts.text += fmt::format("  {} {}{}\n", actuator.kind->word, actuator.name, size);
  }
  for (const model::MassModel& mass : model.masses()) {
    const std::string& body = model.body(mass.body).name();
    facts.json["masses"].push_back({{"name", mass.name}, {"body", body}, {"mass_kg", mass.mass}});
    facts.text += fmt::format("  mass {}: {:.4g} g on {}\n", mass.name, 1e3 * mass.mass, body);
  }
  for (const auto& body : model.bodies()) add_membranes(facts, body);
  for (const auto& effector : model.effectors()) {
    facts.json["effectors"].push_back(effector.name);
    facts.text += fmt::format("  effector {}\n", effector.name);
  }
  for (const auto& probe : model.probes()) {
    facts.json["probes"].push_back(probe.name());
    facts.text += fmt::format("  probe {}: {}\n", probe.name(), probe.kind());
  }
  for (const sense::SensorModel& sensor : sense::sensors_of(model)) {
    facts.json["sensors"].push_back({{"name", sensor.name}, {"kind", sensor.kind}});
    facts.text += fmt::format("  sensor {}: {}\n", sensor.name, sensor.kind);
  }
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const std::string& name = model.contacts()[i].name;
    const constraint::Contact& contact = model.contact(static_cast<int>(i));
    const std::vector<std::string> bodies = contact::touching_bodies(model, static_cast<int>(i));
    facts.json["contacts"].push_back(
        {{"name", name}, {"bodies", bodies}, {"points", contact.size()}});
    facts.text +=
        fmt::format("  contact {}: of {}, {}{} points\n", name, fmt::join(bodies, " and "),
                    contact.is_found_anew() ? "up to " : "", contact.size());
  }
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    add_joint(facts, model, static_cast<int>(i));
  }
  for (const auto& controller : robot.controllers) {
    facts.json["controllers"].push_back(controller.name);
    facts.text += fmt::format("  controller {}\n", controller.name);
  }
  add_parameters(facts, model, options.parameters);
  return facts;
}

Facts run_facts(const std::string& file) {
  const record::RunFile run(file);
  const double first = run.times().empty() ? 0.0 : run.times().front();
  const double last = run.times().empty() ? 0.0 : run.times().back();
  Facts facts;
  facts.json = {{"kind", "run"},
                {"scene", run.scene_name()},
                {"sinew_version", run.sinew_version()},
                {"frames", run.frames()},
                {"first_time_s", first},
                {"last_time_s", last},
                {"time_step_s", run.time_step()},
                {"states", run.has_states()},
                {"bodies", run.bodies()},
                {"actuators", run.actuators()},
                {"effectors", run.effectors()},
                {"probes", run.probes()},
                {"contacts", run.contacts()},
                {"format_version", run.format_version()},
                {"lacks", run.lacks()}};
  facts.text =
      fmt::format("{}: run of {} by Sinew {}\n  {} frames from {:g} s to {:g} s, {}\n", file,
                  run.scene_name(), run.sinew_version(), run.frames(), first, last,
                  run.has_states() ? "with positions of all nodes" : "without positions of nodes");
  const auto list = [&](const char* what, const std::vector<std::string>& names) {
    if (!names.empty()) facts.text += fmt::format("  {}: {}\n", what, fmt::join(names, ", "));
  };
  list("bodies", run.bodies());
  list("actuators", run.actuators());
  list("effectors", run.effectors());
  list("probes", run.probes());
  list("contacts", run.contacts());
  if (!run.lacks().empty()) facts.text += fmt::format("  {}\n", run.lacks());
  return facts;
}

bool starts_as_state(const fs::path& path) {
  std::string start(8, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file.good() && sim::is_state(start);
}

Facts state_facts(const InfoOptions& options) {
  const sim::StateHeader state = sim::read_state_header(read_file(options.file), options.file);
  Facts facts;
  facts.json = {{"kind", "state"},
                {"format_version", state.version},
                {"model", fmt::format("{:016x}", state.fingerprint)},
                {"steps", state.steps},
                {"numbers", state.count}};
  facts.text =
      fmt::format("{}: saved state, format {}\n  model {:016x}\n  after {} steps, {} numbers\n",
                  options.file, state.version, state.fingerprint, state.steps, state.count);
  return facts;
}

Facts facts_of(const InfoOptions& options) {
  const fs::path path(options.file);
  if (fs::is_directory(path)) {
    if (fs::exists(path / "run.h5")) return run_facts((path / "run.h5").string());
    throw Error(ErrorKind::file_unreadable, {.file = options.file},
                "this folder contains no run.h5",
                "give a mesh, a surface, a scene, a saved state, or the folder of a run");
  }
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".yaml" || extension == ".yml") return scene_facts(options);
  if (extension == ".stl" || extension == ".obj" || extension == ".ply") {
    return surface_facts(options);
  }
  if (extension == ".h5" || record::RunFile::is_hdf5(path)) return run_facts(options.file);
  if (starts_as_state(path)) return state_facts(options);
  return mesh_facts(options);
}

int info(const InfoOptions& options) {
  const Facts facts = facts_of(options);
  if (options.json) {
    fmt::print("{}\n", facts.json.dump(2));
  } else {
    fmt::print("{}", facts.text);
  }
  return 0;
}

}  // namespace

void add_info(CommandLine& line) {
  Command command =
      line.add_command("info", "Describe a mesh, surface, scene, recorded run or saved state");
  const auto options = std::make_shared<InfoOptions>();
  command
      .add_option("FILE", options->file,
                  "Mesh, surface, scene, saved state, or output folder of a run")
      .required();
  command
      .add_option("--unit", options->unit,
                  "Length unit of a mesh or surface file, e.g. mm (default: m)")
      .type_name("UNIT");
  command.add_flag("--json", options->json, "Print JSON, in SI units");
  command.add_flag("--parameters", options->parameters,
                   "Also list the numbers on which the motion of a scene's robot depends, with the "
                   "paths that --set and sweeps take");
  command.footer(
      "Defects of a mesh are listed; only an unreadable file is an error.\n\n"
      "Examples:\n"
      "  sinew info finger.vtk --unit mm\n"
      "  sinew info examples/trunk/trunk.yaml --parameters\n"
      "  sinew info out/trunk --json");
  command.set_action([options] { return info(*options); });
}

}  // namespace sinew::cli
