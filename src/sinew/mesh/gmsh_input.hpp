/// @file
/// Common parts of the readers of Gmsh versions: numbers in either encoding, nodes by tag, groups.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sinew/mesh/byte_reader.hpp"
#include "sinew/mesh/raw_mesh.hpp"

namespace sinew::mesh {

/// A physical group: dimension and tag.
using PhysicalGroup = std::pair<std::int64_t, std::int64_t>;

/// A Gmsh file being read: the cursor, and the mesh so far.
class GmshInput {
 public:
  /// @param bytes the whole file; the caller keeps it alive.
  /// @param name its name, for messages.
  GmshInput(std::string_view bytes, const std::string& name);

  ByteReader& reader() { return reader_; }
  bool binary() const { return binary_; }
  /// From here on, numbers are binary in this byte order.
  void set_binary(ByteOrder order);

  /// Reads a 32-bit integer, or a word of text.
  std::int64_t integer(std::string_view what);
  /// Reads a 64-bit size, or a word of text.
  std::int64_t size(std::string_view what);
  /// Reads a double, or a word of text.
  double real(std::string_view what);

  /// Checks a count of items of at least `binary_bytes` each, or `words` words of text.
  std::size_t count(std::int64_t given, std::size_t binary_bytes, std::size_t words,
                    std::string_view what);

  /// Starts a node. Throws Error(duplicate-node) if the tag exists.
  void add_node_tag(std::int64_t tag);
  void add_coordinates(double x, double y, double z);

  /// Merges repeated elements into one cell: version 2 repeats an element for each physical group.
  void expect_repeated_elements() { elements_repeat_ = true; }

  /// Adds a cell of a Gmsh element type by its node tags, and adds it to groups (tag 0 is none).
  void add_element(std::int64_t element_tag, std::int64_t type,
                   const std::vector<std::int64_t>& node_tags,
                   const std::vector<std::int64_t>& physical_tags);

  void name_group(const PhysicalGroup& group, const std::string& name) { names_[group] = name; }

  /// Returns the complete mesh; call once.
  RawMesh take();

  /// Number of nodes of an element type. Throws Error(unsupported-element) if unknown.
  std::size_t nodes_of_type(std::int64_t type);

 private:
  ByteReader reader_;
  RawMesh raw_;
  bool binary_ = false;
  ByteOrder order_ = ByteOrder::little;
  std::unordered_map<std::int64_t, std::int64_t> node_of_tag_;
  std::map<PhysicalGroup, std::string> names_;
  std::map<PhysicalGroup, std::vector<std::size_t>> members_;
  bool elements_repeat_ = false;
  std::vector<std::int64_t> last_nodes_;  // of the previous element, and its groups
  std::vector<std::int64_t> last_groups_;
};

/// Reads the sections of one version: $Nodes and $Elements, and in version 4.1 $Entities.
class GmshSections {
 public:
  virtual ~GmshSections() = default;
  /// Reads a section, after its name. Returns false if it is not one of these.
  virtual bool read(std::string_view section, GmshInput& in) = 0;
};

/// Sections of versions 2.0 to 2.2.
class GmshSections2 : public GmshSections {
 public:
  bool read(std::string_view section, GmshInput& in) override;
};

/// Sections of version 4.1.
class GmshSections4 : public GmshSections {
 public:
  bool read(std::string_view section, GmshInput& in) override;

 private:
  void entities(GmshInput& in);
  void elements(GmshInput& in);

  /// (dimension, entity tag) -> physical tags.
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::int64_t>> physical_tags_;
};

}  // namespace sinew::mesh
