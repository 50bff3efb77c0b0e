/// @file
/// Decoding of the DataArray elements of VTK XML files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include "sinew/mesh/byte_reader.hpp"

namespace sinew::mesh {

/// A parsed VTU file: its XML document and its appended data.
class VtuFile {
 public:
  /// @param bytes the whole file; the caller keeps it alive.
  /// @param name its name, for messages.
  VtuFile(std::string_view bytes, const std::string& name);

  /// The element `VTKFile`.
  pugi::xml_node root() const { return document_.child("VTKFile"); }

  /// Reads the values of a DataArray.
  /// @param array its node; its text or appended data are read.
  /// @param count required number of values.
  std::vector<double> doubles(pugi::xml_node array, std::size_t count) const;

  /// Reads an array of integers, like doubles().
  std::vector<std::int64_t> integers(pugi::xml_node array, std::size_t count) const;

  /// Reads an array of integers of unknown length.
  std::vector<std::int64_t> all_integers(pugi::xml_node array) const;

  /// The number type of an array. Throws Error(malformed-file) if it is unknown.
  ScalarType type_of(pugi::xml_node array) const;

  /// Reads a count from an attribute of an element.
  std::size_t count(pugi::xml_node node, const char* attribute) const;

  /// Throws an Error at the line of the node.
  [[noreturn]] void fail(ErrorKind kind, pugi::xml_node node, const std::string& message,
                         const std::string& remedy = {}) const;

 private:
  void parse();
  void find_appended(std::size_t tag);
  void read_attributes();
  int line_of(pugi::xml_node node) const;
  bool is_ascii(pugi::xml_node array) const;
  std::string block(pugi::xml_node array) const;
  std::string raw_bytes(pugi::xml_node array, std::size_t skip, std::size_t max_bytes) const;
  std::string plain_block(pugi::xml_node array) const;
  std::string compressed_block(pugi::xml_node array) const;
  std::size_t header_item(pugi::xml_node array, std::string_view header, std::size_t item) const;

  template <typename Value, typename Decode, typename Parse>
  std::vector<Value> values(pugi::xml_node array, const Decode& decode, const Parse& parse) const;
  void check_size(pugi::xml_node array, std::size_t have, std::size_t count) const;

  std::string_view bytes_;
  std::string name_;
  std::string_view xml_;       // before the appended data
  std::string_view appended_;  // after its leading underscore
  bool appended_is_base64_ = false;
  pugi::xml_document document_;
  ByteOrder order_ = ByteOrder::little;
  std::size_t header_bytes_ = 4;
  bool compressed_ = false;
};

}  // namespace sinew::mesh
