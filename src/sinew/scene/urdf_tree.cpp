#include "sinew/scene/urdf_tree.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

constexpr std::size_t kMaxBytes = 16u << 20;
constexpr int kMaxDepth = 64;  // the second parser is recursive

struct DepthLimit : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node&) override { return depth() < kMaxDepth; }
};

// Finds attributes with '%', since the second parser uses invalid values as a format string.
struct FormatSearch : pugi::xml_tree_walker {
  pugi::xml_node found;

  bool for_each(pugi::xml_node& element) override {
    for (const pugi::xml_attribute& attribute : element.attributes()) {
      if (std::string_view(attribute.value()).find('%') != std::string_view::npos) found = element;
    }
    return found.empty();
  }
};

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

const char* name_of(const pugi::xml_node& element) { return element.attribute("name").value(); }

const char* end_of(const pugi::xml_node& joint, const char* end) {
  return joint.child(end).attribute("link").value();
}

// Names appear in dotted paths, in column headings and in file names.
bool is_spelled_well(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
}

std::vector<std::string> names_of(const std::vector<pugi::xml_node>& elements) {
  std::vector<std::string> names;
  names.reserve(elements.size());
  for (const pugi::xml_node& element : elements) names.emplace_back(name_of(element));
  return names;
}

}  // namespace

UrdfTree::UrdfTree(std::string_view text, std::string name)
    : name_(std::move(name)), source_(text) {
  if (source_.size() > kMaxBytes) {
    throw Error(ErrorKind::size_limit, {.file = name_},
                fmt::format("the file has {} bytes, more than {}", source_.size(), kMaxBytes),
                "describe geometry by mesh files");
  }
  const pugi::xml_parse_result result = document_.load_buffer(source_.data(), source_.size());
  if (!result) {
    const auto end =
        source_.begin() + std::clamp<std::ptrdiff_t>(result.offset, 0, std::ssize(source_));
    const int line = 1 + static_cast<int>(std::count(source_.begin(), end, '\n'));
    throw Error(ErrorKind::syntax_error, {.file = name_, .line = line},
                fmt::format("this is no XML: {}", result.description()),
                "correct the file there; xacro files are to be expanded first");
  }
  if (DepthLimit limit; !document_.traverse(limit)) {
    throw Error(ErrorKind::size_limit, {.file = name_},
                fmt::format("elements are nested more than {} deep", kMaxDepth),
                "write the file flat");
  }
  read_elements();
  for (auto* elements : {&links_, &joints_}) {
    for (pugi::xml_node& element : *elements) refuse_formats(element);
  }
  for (const pugi::xml_node& joint : joints_) check_tie(joint);
  sort_from_root();
}

Location UrdfTree::place(const pugi::xml_node& element) const {
  const auto end =
      source_.begin() + std::clamp<std::ptrdiff_t>(element.offset_debug(), 0, std::ssize(source_));
  const int line = 1 + static_cast<int>(std::count(source_.begin(), end, '\n'));
  std::string item = element.name();
  if (*name_of(element) != '\0') item += fmt::format(" '{}'", name_of(element));
  return {.file = name_, .line = line, .item = std::move(item)};
}

Location UrdfTree::place_named_in(const std::string& message) const {
  for (const auto* elements : {&joints_, &links_}) {
    for (const pugi::xml_node& element : *elements) {
      for (const char* quotes : {"[]", "''", "\"\""}) {
        const std::string quoted = fmt::format("{}{}{}", quotes[0], name_of(element), quotes[1]);
        if (message.find(quoted) != std::string::npos) return place(element);
      }
    }
  }
  return {.file = name_};
}

int UrdfTree::link_number(std::string_view link) const {
  const auto found =
      std::ranges::find_if(links_, [&](const auto& other) { return link == name_of(other); });
  return found == links_.end() ? -1 : static_cast<int>(found - links_.begin());
}

std::string UrdfTree::text() const {
  pugi::xml_document result;
  pugi::xml_node robot = result.append_child("robot");
  robot.append_attribute("name") = "robot";
  for (const auto* elements : {&links_, &joints_}) {
    for (const pugi::xml_node& element : *elements) robot.append_copy(element);
  }
  std::ostringstream text;
  result.save(text, "", pugi::format_raw);
  return text.str();
}

void UrdfTree::read_elements() {
  const pugi::xml_node robot = document_.document_element();
  if (std::string_view(robot.name()) != "robot") {
    throw Error(ErrorKind::malformed_file, {.file = name_},
                fmt::format("the file is of <{}>, not of <robot>", robot.name()),
                "give a URDF file");
  }
  for (const pugi::xml_node& element : robot.children()) {
    const std::string_view tag = element.name();
    if (tag == "link") {
      check_link(element);
    } else if (tag == "joint") {
      check_joint(element);
    } else if (element.type() == pugi::node_element && tag != "material") {
      if (tag.starts_with("xacro:")) {
        throw Error(ErrorKind::malformed_file, place(element), "this is a xacro file",
                    "expand it first: xacro robot.urdf.xacro > robot.urdf");
      }
      ignore(element, fmt::format("<{}>", tag));
    }
  }
  if (!links_.empty()) return;
  throw Error(ErrorKind::malformed_file, {.file = name_}, "the robot has no <link>",
              "give a URDF file with links and joints");
}

void UrdfTree::check_name(const pugi::xml_node& element,
                          const std::vector<pugi::xml_node>& others) const {
  const std::string_view name = name_of(element);
  if (!is_spelled_well(name)) {
    throw Error(ErrorKind::bad_argument, place(element),
                fmt::format("{} is not a name", show(name)),
                "write names with letters, digits, '_' and '-'");
  }
  const auto same = [&](const pugi::xml_node& other) { return name == name_of(other); };
  const auto found = std::ranges::find_if(others, same);
  if (found == others.end()) return;
  throw Error(ErrorKind::duplicate_key, place(element),
              fmt::format("line {} has a <{}> of this name", place(*found).line, element.name()),
              "give each a name of its own");
}

void UrdfTree::check_link(const pugi::xml_node& link) {
  check_name(link, links_);
  links_.push_back(link);
  for (const pugi::xml_node& part : link.children()) {
    if (part.type() != pugi::node_element) continue;
    const std::string_view tag = part.name();
    if (!is_one_of(tag, {"inertial", "visual", "collision"})) {
      ignore(part, fmt::format("<{}> of a link", tag));
    }
    for (const pugi::xml_node& detail : part.children()) {
      if (detail.type() != pugi::node_element ||
          is_one_of(detail.name(), {"origin", "geometry", "material", "mass", "inertia"})) {
        continue;
      }
      ignore(detail, fmt::format("<{}> of a <{}>", detail.name(), tag));
    }
  }
}

void UrdfTree::check_joint(const pugi::xml_node& joint) {
  check_name(joint, joints_);
  joints_.push_back(joint);
  const std::string_view type = joint.attribute("type").value();
  if (type == "planar") {
    throw Error(ErrorKind::not_in_this_version, place(joint), "a planar joint",
                "make it two prismatic joints and a revolute one, with light links between them");
  }
  if (!is_one_of(type, {"fixed", "revolute", "continuous", "prismatic", "floating"})) {
    throw Error(ErrorKind::unknown_choice, place(joint),
                fmt::format("there is no joint of type {}", show(type)),
                "revolute, continuous, prismatic, fixed or floating");
  }
  for (const pugi::xml_node& part : joint.children()) {
    const std::string_view tag = part.name();
    if (part.type() != pugi::node_element) continue;
    if (tag == "mimic") {
      throw Error(ErrorKind::not_in_this_version, place(joint),
                  "<mimic>, a joint that follows another one",
                  "remove it, and command both joints by motors");
    }
    if (!is_one_of(tag, {"origin", "parent", "child", "axis", "dynamics", "limit"})) {
      ignore(part, fmt::format("<{}> of a joint", tag));
    }
    if (tag == "dynamics" && part.attribute("damping").as_double() != 0.0) {
      ignore(part, "viscous damping of a joint");
    }
  }
}

void UrdfTree::refuse_formats(pugi::xml_node& element) const {
  FormatSearch search;
  element.traverse(search);
  if (search.found.empty()) return;
  throw Error(ErrorKind::bad_argument, place(search.found), "an attribute holds a '%'",
              "write it without, as a file of another name");
}

void UrdfTree::check_tie(const pugi::xml_node& joint) {
  for (const char* end : {"parent", "child"}) {
    const std::string link = end_of(joint, end);
    if (link.empty()) {
      throw Error(ErrorKind::missing_key, place(joint),
                  fmt::format("<{} link=...> is missing", end), "add it, with the name of a link");
    }
    if (link_number(link) >= 0) continue;
    const std::vector<std::string> known = names_of(links_);
    throw Error(ErrorKind::unknown_name, place(joint),
                fmt::format("its {} {} is not a link", end, show(link)),
                fmt::format("{}the links are {}", did_you_mean(link, known), join(known)));
  }
  const std::string_view child = end_of(joint, "child");
  for (const pugi::xml_node& other : joints_) {
    if (other == joint) return;
    if (child != end_of(other, "child")) continue;
    throw Error(ErrorKind::malformed_file, place(joint),
                fmt::format("link '{}' has a parent already, by the joint of line {}", child,
                            place(other).line),
                "close loops in the scene, by joints between the links that meet");
  }
}

// Sorts links after their parents, in the order of joints in the file.
void UrdfTree::sort_from_root() {
  std::vector<pugi::xml_node> links, ties;
  for (const pugi::xml_node& link : links_) {
    const auto leads_here = [&](const auto& joint) {
      return std::string_view(name_of(link)) == end_of(joint, "child");
    };
    if (std::ranges::none_of(joints_, leads_here)) links.push_back(link);
  }
  if (links.size() > 1) {
    throw Error(ErrorKind::malformed_file, place(links[1]),
                fmt::format("links '{}' and '{}' have no parent both", name_of(links[0]),
                            name_of(links[1])),
                "tie all links to one root by joints");
  }
  for (std::size_t k = 0; k < links.size(); ++k) {
    for (const pugi::xml_node& joint : joints_) {
      if (std::string_view(name_of(links[k])) != end_of(joint, "parent")) continue;
      ties.push_back(joint);
      links.push_back(links_[static_cast<std::size_t>(link_number(end_of(joint, "child")))]);
    }
  }
  if (links.size() < links_.size()) {
    const auto lost = std::ranges::find_if(
        joints_, [&](const auto& joint) { return std::ranges::find(ties, joint) == ties.end(); });
    throw Error(ErrorKind::malformed_file, place(*lost),
                fmt::format("link '{}' hangs on itself", end_of(*lost, "child")),
                "close loops in the scene, by joints between the links that meet");
  }
  links_ = std::move(links);
  joints_ = std::move(ties);
}

void UrdfTree::ignore(const pugi::xml_node& element, const std::string& what) {
  const std::string message = fmt::format("{} is not used", what);
  if (std::ranges::find(notices_, message, &Notice::message) != notices_.end()) return;
  notices_.push_back({NoticeLevel::warning, NoticeKind::unused_element, place(element), message,
                      "the robot is built without it, here and wherever else it stands"});
}

}  // namespace sinew::scene
