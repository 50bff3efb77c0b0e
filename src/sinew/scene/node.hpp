/// @file
/// The tree from which a scene is read, whether it comes from a YAML file or a Python dict. It is
/// independent of robots. Every node keeps the location where it was written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"

namespace sinew::scene {

/// A scalar (text, number, boolean, null), a list, or a map. Entries of a map keep their order, and
/// scalars keep the spelling of their source, so that writing a tree back changes no digit.
class Node {
 public:
  enum class Kind { null, boolean, number, text, list, map };
  struct Entry;

  /// Makes a null node.
  Node();
  ~Node();
  Node(const Node&);
  Node(Node&&) noexcept;
  Node& operator=(const Node&);
  Node& operator=(Node&&) noexcept;

  static Node boolean(bool value);
  static Node number(double value);  ///< spelled with the fewest digits that read back as `value`
  static Node integer(std::int64_t value);
  static Node text(std::string value);
  static Node list();
  static Node map();
  /// An unquoted YAML scalar: "true" is a boolean, "1e-3" a number, "~" null, anything else text.
  static Node plain(std::string spelling);

  Kind kind() const { return kind_; }
  bool is_scalar() const { return kind_ != Kind::list && kind_ != Kind::map; }
  bool is_list() const { return kind_ == Kind::list; }
  bool is_map() const { return kind_ == Kind::map; }

  /// The spelling of a scalar; empty for lists and maps.
  const std::string& spelling() const { return spelling_; }
  /// The value of a number; throws Error(wrong-type) for other kinds.
  double as_number() const;
  /// The value of a boolean; throws Error(wrong-type) for other kinds.
  bool as_boolean() const;

  const std::vector<Node>& items() const { return items_; }
  std::vector<Node>& items() { return items_; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::vector<Entry>& entries() { return entries_; }
  /// The entry's value, or nullptr.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);

  /// Appends an item to a list, and returns the new item.
  Node& append(Node item);
  /// Adds an entry to a map or replaces its value in place, and returns the value.
  Node& set(std::string key, Node value);
  /// Removes an entry. Returns false if there is none.
  bool erase(std::string_view key);

  const Location& place() const { return place_; }
  void set_place(Location place) { place_ = std::move(place); }
  /// Gives this node the dotted path `path`, and all nodes below it the resulting paths
  /// ("bodies.trunk.fixed[0]"). Trees made by hand have no paths until this is called.
  void name_paths(const std::string& path = {});
  /// Names the source of the whole tree if that has no lines, such as a command-line option.
  void name_file(const std::string& file);

  /// Compares kinds, spellings, keys and order, but not locations.
  bool operator==(const Node& other) const;

 private:
  Kind kind_ = Kind::null;
  std::string spelling_;
  std::vector<Node> items_;
  std::vector<Entry> entries_;
  Location place_;
};

/// One entry of a map.
struct Node::Entry {
  std::string key;
  Location key_place;
  Node value;
};

/// "a number", "a list", ... for messages.
std::string_view node_kind_name(Node::Kind kind);

/// Bounds on the size of a YAML document, so that no file can exhaust time or memory.
struct YamlLimits {
  std::size_t bytes = 4u << 20;
  std::size_t nodes = 200'000;   ///< with aliases expanded
  std::size_t key_length = 200;  ///< bytes
  int depth = 32;
};

/// Reads one YAML document.
/// @param text UTF-8.
/// @param name the file name, for locations.
/// @param limits on the size of the document.
/// Throws Error: syntax-error, duplicate-key, bad-encoding, size-limit, each with line and column.
Node parse_yaml(std::string_view text, const std::string& name, const YamlLimits& limits = {});

/// Reads a whole file (at most limits.bytes) and parses it. Throws what parse_yaml() throws, and
/// Error(file-not-found), Error(file-unreadable).
Node read_yaml(const std::filesystem::path& path, const YamlLimits& limits = {});

/// Writes a tree as YAML: maps in block style, lists of scalars on one line. parse_yaml() of the
/// result gives an equal tree.
std::string to_yaml(const Node& tree);

}  // namespace sinew::scene
