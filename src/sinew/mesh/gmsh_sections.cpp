#include <cstdlib>

#include "sinew/mesh/gmsh_input.hpp"

namespace sinew::mesh {

namespace {

void nodes_2(GmshInput& in) {
  const std::size_t count = in.count(in.reader().integer("the number of nodes"), 28, 4, "nodes");
  if (in.binary()) in.reader().line();
  for (std::size_t i = 0; i < count; ++i) {
    in.add_node_tag(in.integer("a node number"));
    const double x = in.real("x"), y = in.real("y"), z = in.real("z");
    in.add_coordinates(x, y, z);
  }
}

/// Tags of an element of version 2: the first is its physical group, 0 for none.
std::vector<std::int64_t> physical_tags_2(GmshInput& in, std::size_t tags) {
  std::vector<std::int64_t> physical;
  for (std::size_t k = 0; k < tags; ++k) {
    const std::int64_t tag = in.integer("a tag");
    if (k == 0) physical.push_back(tag);
  }
  return physical;
}

std::vector<std::int64_t> node_tags_2(GmshInput& in, std::size_t count) {
  std::vector<std::int64_t> nodes(count);
  for (std::int64_t& node : nodes) node = in.integer("a node number");
  return nodes;
}

void text_elements_2(GmshInput& in, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t tag = in.integer("an element number");
    const std::int64_t type = in.integer("an element type");
    const std::size_t tags = in.count(in.integer("the number of tags"), 4, 1, "tags");
    const auto physical = physical_tags_2(in, tags);
    in.add_element(tag, type, node_tags_2(in, in.nodes_of_type(type)), physical);
  }
}

/// Blocks of elements of one type, each with the header (type, elements, tags).
void binary_elements_2(GmshInput& in, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    const std::int64_t type = in.integer("an element type");
    const std::int64_t given = in.integer("the number of elements");
    const std::size_t tags = in.count(in.integer("the number of tags"), 4, 1, "tags");
    const std::size_t nodes = in.nodes_of_type(type);
    const std::size_t elements = in.count(given, 4 * (1 + tags + nodes), 1, "elements");
    if (elements == 0 || elements > count - done) {
      in.reader().fail(ErrorKind::malformed_file, "the blocks of elements do not add up");
    }
    for (std::size_t i = 0; i < elements; ++i) {
      const std::int64_t tag = in.integer("an element number");
      const auto physical = physical_tags_2(in, tags);
      in.add_element(tag, type, node_tags_2(in, nodes), physical);
    }
    done += elements;
  }
}

void nodes_4(GmshInput& in) {
  const std::size_t blocks = in.count(in.size("the number of blocks"), 20, 4, "node blocks");
  in.count(in.size("the number of nodes"), 32, 4, "nodes");
  in.size("the least tag");
  in.size("the largest tag");
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::int64_t dimension = in.integer("a dimension");
    in.integer("an entity");
    const bool parametric = in.integer("a flag") != 0;
    const std::size_t nodes = in.count(in.size("the number of nodes"), 32, 4, "nodes");
    for (std::size_t i = 0; i < nodes; ++i) in.add_node_tag(in.size("a node number"));
    for (std::size_t i = 0; i < nodes; ++i) {
      const double x = in.real("x"), y = in.real("y"), z = in.real("z");
      in.add_coordinates(x, y, z);
      for (std::int64_t k = 0; parametric && k < dimension; ++k) in.real("a parameter");
    }
  }
}

}  // namespace

bool GmshSections2::read(std::string_view section, GmshInput& in) {
  if (section == "$Nodes") {
    nodes_2(in);
    return true;
  }
  if (section != "$Elements") return false;
  in.expect_repeated_elements();
  const std::size_t count =
      in.count(in.reader().integer("the number of elements"), 8, 4, "elements");
  if (in.binary()) {
    in.reader().line();
    binary_elements_2(in, count);
  } else {
    text_elements_2(in, count);
  }
  return true;
}

/// Entities carry the physical groups of their elements.
void GmshSections4::entities(GmshInput& in) {
  constexpr std::size_t kDimensions = 4;
  std::size_t counts[kDimensions];
  for (std::size_t& count : counts) count = in.count(in.size("a count"), 36, 5, "entities");
  for (std::size_t dimension = 0; dimension < kDimensions; ++dimension) {
    for (std::size_t i = 0; i < counts[dimension]; ++i) {
      const std::int64_t tag = in.integer("an entity");
      const int bounds = dimension == 0 ? 3 : 6;
      for (int k = 0; k < bounds; ++k) in.real("a bound");
      auto& tags = physical_tags_[{static_cast<std::int64_t>(dimension), tag}];
      tags.resize(in.count(in.size("the number of groups"), 4, 1, "groups"));
      for (std::int64_t& group : tags) group = in.integer("a group");
      if (dimension == 0) continue;
      const std::size_t boundary = in.count(in.size("the number of bounds"), 4, 1, "bounds");
      for (std::size_t k = 0; k < boundary; ++k) in.integer("a bounding entity");
    }
  }
}

void GmshSections4::elements(GmshInput& in) {
  const std::size_t blocks = in.count(in.size("the number of blocks"), 20, 4, "element blocks");
  in.count(in.size("the number of elements"), 16, 2, "elements");
  in.size("the least tag");
  in.size("the largest tag");
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::int64_t dimension = in.integer("a dimension");
    const std::int64_t entity = in.integer("an entity");
    const std::int64_t type = in.integer("an element type");
    const std::size_t nodes = in.nodes_of_type(type);
    const std::size_t count =
        in.count(in.size("the number of elements"), 8 * (1 + nodes), 1 + nodes, "elements");
    const auto& groups = physical_tags_[{dimension, entity}];
    std::vector<std::int64_t> tags(nodes);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t tag = in.size("an element number");
      for (std::int64_t& node : tags) node = in.size("a node number");
      in.add_element(tag, type, tags, groups);
    }
  }
}

bool GmshSections4::read(std::string_view section, GmshInput& in) {
  const bool known = section == "$Entities" || section == "$Nodes" || section == "$Elements";
  if (known && in.binary()) in.reader().line();
  if (section == "$Entities") entities(in);
  if (section == "$Nodes") nodes_4(in);
  if (section == "$Elements") elements(in);
  return known;
}

}  // namespace sinew::mesh
