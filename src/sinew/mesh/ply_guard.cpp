#include "sinew/mesh/ply_guard.hpp"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/whole.hpp"
#include "sinew/mesh/byte_reader.hpp"

namespace sinew::mesh {

namespace {

enum class Encoding { text, little, big };

struct Property {
  std::string name;
  ScalarType type = ScalarType::float32;
  std::optional<ScalarType> count_type;  // of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

ScalarType scalar_type(ByteReader& in) {
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"char", ScalarType::int8},      {"int8", ScalarType::int8},
      {"uchar", ScalarType::uint8},    {"uint8", ScalarType::uint8},
      {"short", ScalarType::int16},    {"int16", ScalarType::int16},
      {"ushort", ScalarType::uint16},  {"uint16", ScalarType::uint16},
      {"int", ScalarType::int32},      {"int32", ScalarType::int32},
      {"uint", ScalarType::uint32},    {"uint32", ScalarType::uint32},
      {"float", ScalarType::float32},  {"float32", ScalarType::float32},
      {"double", ScalarType::float64}, {"float64", ScalarType::float64},
  };
  const std::string_view word = in.word("a number type");
  for (const auto& [name, type] : kNames) {
    if (name == word) return type;
  }
  in.fail(ErrorKind::malformed_file, fmt::format("`{}` is not a number type", word.substr(0, 40)));
}

Encoding read_encoding(ByteReader& in) {
  const std::string_view word = in.word("the encoding");
  if (word == "ascii") return Encoding::text;
  if (word == "binary_little_endian") return Encoding::little;
  if (word == "binary_big_endian") return Encoding::big;
  in.fail(ErrorKind::malformed_file, fmt::format("unknown encoding `{}`", word.substr(0, 40)));
}

class PlyWalker {
 public:
  PlyWalker(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  void walk() {
    header();
    for (const Element& element : elements_) body(element);
  }

 private:
  void header() {
    if (in_.word("`ply`") != "ply") {
      in_.fail(ErrorKind::malformed_file, "a PLY file starts with the word `ply`");
    }
    bool have_format = false;
    for (;;) {
      const std::string_view keyword = in_.word("a line of the header");
      if (keyword == "end_header") break;
      if (keyword == "format") {
        encoding_ = read_encoding(in_);
        have_format = true;
      } else if (keyword == "element") {
        element();
      } else if (keyword == "property") {
        property();
      } else if (keyword != "comment" && keyword != "obj_info") {
        in_.fail(ErrorKind::malformed_file,
                 fmt::format("unknown header line `{}`", keyword.substr(0, 40)));
      }
      in_.line();
    }
    in_.line();
    if (!have_format) in_.fail(ErrorKind::malformed_file, "the header has no format");
    check_vertices();
    if (encoding_ != Encoding::text) in_.mark_binary();
  }

  void check_vertices() {
    int axes = 0;
    for (const Element& element : elements_) {
      if (element.name != "vertex") continue;
      for (const Property& p : element.properties) {
        axes += !p.count_type && (p.name == "x" || p.name == "y" || p.name == "z") ? 1 : 0;
      }
      vertices_ = element.count;
    }
    if (axes != 3) in_.fail(ErrorKind::malformed_file, "vertices need the properties x, y and z");
  }

  void element() {
    const std::string name(in_.word("the name of an element"));
    const std::int64_t count = in_.integer("a count");
    // Each item takes at least one of the following bytes.
    elements_.push_back({name, in_.checked_count(count, 1, name), {}});
  }

  void property() {
    if (elements_.empty()) {
      in_.fail(ErrorKind::malformed_file, "a property stands before the first element");
    }
    Property property;
    if (in_.peek_word() == "list") {
      in_.word("list");
      property.count_type = scalar_type(in_);
    }
    property.type = scalar_type(in_);
    property.name = in_.word("the name of a property");
    elements_.back().properties.push_back(property);
  }

  void body(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (!property.count_type) {
          number(property.type);
        } else {
          list(element, i, property);
        }
      }
    }
  }

  void list(const Element& element, std::size_t i, const Property& property) {
    const double given = number(*property.count_type);
    const std::size_t least = encoding_ == Encoding::text ? 1 : bytes_of(property.type);
    const std::size_t count =
        in_.checked_count(given >= 0 ? whole<std::int64_t>(given) : -1, least, "entries");
    const bool corners = element.name == "face" && property.name.starts_with("vertex_ind");
    for (std::size_t k = 0; k < count; ++k) {
      const double value = number(property.type);
      if (!corners || (value >= 0 && value < static_cast<double>(vertices_))) continue;
      in_.fail(ErrorKind::index_out_of_range,
               fmt::format("face {} uses vertex {}, but there are {}", i, value, vertices_));
    }
  }

  double number(ScalarType type) {
    if (encoding_ == Encoding::text) return in_.number("a number");
    const ByteOrder order = encoding_ == Encoding::big ? ByteOrder::big : ByteOrder::little;
    return decode_doubles(in_.block(bytes_of(type), "values"), type, order)[0];
  }

  ByteReader in_;
  Encoding encoding_ = Encoding::text;
  std::vector<Element> elements_;
  std::size_t vertices_ = 0;
};

}  // namespace

void require_whole_ply(std::string_view bytes, const std::string& name) {
  PlyWalker(bytes, name).walk();
}

}  // namespace sinew::mesh
