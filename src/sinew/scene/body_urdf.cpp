// Bodies of type urdf: robots in URDF files, which expand_urdf() replaces by their bodies and
// joints.
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/grammar_forms.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> urdf_table() {
  return make_table(
      {.name = "body: type urdf",
       .description =
           "The links and joints of a robot in a URDF file. They become rigid bodies ROBOT.LINK "
           "and joints ROBOT.JOINT, which other parts of the scene can refer to.",
       .keys = {{.name = "file",
                 .forms = {file()},
                 .example = "arm.urdf",
                 .description = "Path of the URDF file, relative to the scene file.",
                 .required = true},
                {.name = "packages",
                 .forms = {names(file())},
                 .example = "{arm_description: ../arm_description}",
                 .default_text = "{}",
                 .description = "Folders of the packages that package:// paths of the file name."},
                {.name = "pose",
                 .forms = {table(pose_table())},
                 .example = "{position: 0 0 100 mm, rotation: {axis: z, angle: 90 deg}}",
                 .default_text = "{}",
                 .description = "Position and rotation of the root link at the start."},
                {.name = "fixed",
                 .forms = {boolean()},
                 .example = "false",
                 .default_text = "true",
                 .description = "Whether the root link is fixed in the world."},
                {.name = "angles",
                 .forms = {names(quantity(angle()))},
                 .example = "{elbow: -90 deg}",
                 .default_text = "{}",
                 .description =
                     "Angles of revolute and continuous joints at the start, by their names in the "
                     "file; 0 by default. The joint's `angle` is measured from there."},
                {.name = "displacements",
                 .forms = {names(quantity(length()))},
                 .example = "{finger: 10 mm}",
                 .default_text = "{}",
                 .description = "Displacements of prismatic joints at the start, by their names in "
                                "the file; 0 by default."},
                {.name = "density",
                 .forms = {quantity(density(), positive())},
                 .example = "1200 kg/m^3",
                 .description = "Density of the collision geometry of moving links without "
                                "`<inertial>`. Default: such links are an error."}}});
}

}  // namespace
}  // namespace forms

namespace {

std::map<std::string, std::filesystem::path> read_packages(const Fields& fields,
                                                           const ReadContext& context) {
  std::map<std::string, std::filesystem::path> packages;
  const Node* map = fields.find("packages");
  if (map == nullptr) return packages;
  for (const Node::Entry& entry : map->entries()) {
    const std::filesystem::path folder = context.base_dir / read_text(entry.value);
    std::error_code status;
    if (context.files == Files::check && !std::filesystem::is_directory(folder, status)) {
      throw Error(ErrorKind::file_not_found, entry.value.place(),
                  fmt::format("there is no folder {}", show(read_text(entry.value))),
                  "give the package's folder, relative to the scene's");
    }
    packages[entry.key] = folder;
  }
  return packages;
}

void read_starts(const Fields& fields, const char* key, bool turns, UrdfDescription& robot) {
  const Node* map = fields.find(key);
  if (map == nullptr) return;
  const Form& form = form_of(fields.table(), key, Shape::names).items.front();
  for (const Node::Entry& entry : map->entries()) {
    robot.starts.push_back(
        {entry.key, entry.key_place, read_numbers(entry.value, form).front(), turns});
  }
}

UrdfDescription read_urdf(const Fields& fields, const ReadContext& context) {
  UrdfDescription robot;
  robot.file = context.path(fields, "file");
  robot.file_place = fields.place("file");
  robot.packages = read_packages(fields, context);
  const Fields pose = fields.below("pose");
  pose.read("position", robot.position);
  robot.rotation = read_rotation(pose);
  fields.read("fixed", robot.fixed);
  if (double value = 0.0; fields.read("density", value)) robot.density = value;
  read_starts(fields, "angles", true, robot);
  read_starts(fields, "displacements", false, robot);
  return robot;
}

}  // namespace

const BodyKind& urdf_kind() {
  static const BodyKind kind{
      .word = "urdf",
      .description = "A robot in a URDF file.",
      .noun = "a robot of several bodies",
      .table = forms::urdf_table,
      .read = [](const Fields& fields, const ReadContext& context, BodyDescription& body) {
        body.own = read_urdf(fields, context);
      }};
  return kind;
}

}  // namespace sinew::scene
