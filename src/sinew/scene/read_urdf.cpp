// Reads bodies of type urdf.
#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/scene/readers.hpp"

namespace sinew::scene {

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

}  // namespace

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

}  // namespace sinew::scene
