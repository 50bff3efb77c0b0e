#include "sinew/mesh/vtk_legacy.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/mesh/byte_reader.hpp"
#include "sinew/mesh/raw_mesh.hpp"
#include "sinew/mesh/vtk_legacy_values.hpp"

namespace sinew::mesh {

namespace {

/// Undoes the percent-encoding of array names ("my%20set").
std::string decoded_name(std::string_view text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto is_hex = [&](std::size_t k) {
      return k < text.size() && std::isxdigit(static_cast<unsigned char>(text[k])) != 0;
    };
    if (text[i] == '%' && is_hex(i + 1) && is_hex(i + 2)) {
      name += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      name += text[i];
    }
  }
  return name;
}

class LegacyReader : private LegacyValues {
 public:
  LegacyReader(std::string_view bytes, const std::string& name) : LegacyValues(bytes, name) {
    raw_.name = name;
  }

  RawMesh read() {
    header();
    while (!in_.at_end()) section();
    if (!have_points_) in_.fail(ErrorKind::malformed_file, "the file has no POINTS section");
    if (!have_cells_ || !have_types_) {
      in_.fail(ErrorKind::truncated_file,
               fmt::format("the file has no {} section", have_cells_ ? "CELL_TYPES" : "CELLS"),
               "write the file again; it was probably cut short");
    }
    return std::move(raw_);
  }

 private:
  void header() {
    constexpr std::string_view kMagic = "# vtk DataFile Version ";
    const std::string_view first = in_.line();
    if (first.substr(0, kMagic.size()) != kMagic) {
      in_.fail(ErrorKind::unknown_format,
               "the file does not start with `# vtk DataFile Version`, as VTK legacy files do");
    }
    const std::string version(first.substr(kMagic.size(), 8));
    if (version.empty() || version.front() < '1' || version.front() > '5') {
      in_.fail(ErrorKind::unsupported_version,
               fmt::format("VTK legacy version `{}` is not known", version),
               "write the file as version 2.0 to 5.1");
    }
    in_.line();  // the title may be any text
    const std::string encoding = lower_case(in_.word("the encoding, ASCII or BINARY"));
    if (encoding != "ascii" && encoding != "binary") {
      in_.fail(ErrorKind::malformed_file,
               fmt::format("the third line must be ASCII or BINARY, got `{}`", encoding));
    }
    if (encoding == "binary") set_binary();
    raw_.format = fmt::format("VTK legacy {}, {}", version.substr(0, 3), encoding);
  }

  void section() {
    const std::string keyword = lower_case(in_.word("a section"));
    if (keyword == "dataset") {
      dataset();
    } else if (keyword == "points") {
      points();
    } else if (keyword == "cells") {
      cells();
    } else if (keyword == "cell_types") {
      const std::size_t count = line_count("cell types", 1);
      raw_.types = integers(count, ScalarType::int32, "cell types");
      have_types_ = true;
    } else if (keyword == "point_data" || keyword == "cell_data") {
      fields_ = keyword == "point_data" ? &raw_.point_fields : &raw_.cell_fields;
      tuples_ = line_count("values", 0);
    } else if (keyword == "field") {
      field_section();
    } else if (keyword == "metadata") {
      metadata();
    } else if (fields_ != nullptr) {
      attribute(keyword);
    } else {
      in_.fail(ErrorKind::malformed_file,
               fmt::format("unknown section `{}`", keyword.substr(0, 40)));
    }
  }

  void dataset() {
    const std::string kind = lower_case(in_.word("the kind of dataset"));
    if (kind == "unstructured_grid") return;
    in_.fail(ErrorKind::unknown_format,
             fmt::format("DATASET {} holds no volume mesh", kind.substr(0, 40)),
             "save the mesh as UNSTRUCTURED_GRID");
  }

  void points() {
    const std::int64_t given = in_.integer("the number of points");
    const ScalarType type = scalar("the type of the points");
    end_of_header();
    const std::size_t count = in_.checked_count(given, 3 * item_size(type), "points");
    raw_.coordinates = doubles(3 * count, type, "points");
    have_points_ = true;
  }

  void cells() {
    have_cells_ = true;
    const std::int64_t first = in_.integer("the number of cells");
    const std::int64_t second = in_.integer("the size of the cells");
    end_of_header();
    if (in_.peek_word() == "OFFSETS") {
      cells_with_offsets(first, second);
    } else {
      cells_with_counts(first, second);
    }
  }

  /// Version 5.1: `first` offsets, then `second` point numbers.
  void cells_with_offsets(std::int64_t first, std::int64_t second) {
    in_.word("OFFSETS");
    const ScalarType offset_type = scalar("the type of the offsets");
    end_of_header();
    raw_.offsets = integers(in_.checked_count(first, item_size(offset_type), "offsets"),
                            offset_type, "offsets");
    if (raw_.offsets.empty()) raw_.offsets.push_back(0);
    if (in_.word("CONNECTIVITY") != "CONNECTIVITY") {
      in_.fail(ErrorKind::malformed_file, "expected CONNECTIVITY after the OFFSETS");
    }
    const ScalarType type = scalar("the type of the connectivity");
    end_of_header();
    raw_.connectivity = integers(in_.checked_count(second, item_size(type), "point numbers"), type,
                                 "point numbers");
  }

  /// Earlier versions: `second` integers; each cell is its number of points, then the points.
  void cells_with_counts(std::int64_t first, std::int64_t second) {
    const std::size_t size =
        in_.checked_count(second, item_size(ScalarType::int32), "cell entries");
    const std::size_t count = in_.checked_count(first, 1, "cells");
    const std::vector<std::int64_t> table = integers(size, ScalarType::int32, "cells");
    raw_.offsets.assign(1, 0);
    raw_.connectivity.clear();
    std::size_t at = 0;
    for (std::size_t c = 0; c < count; ++c) {
      const std::int64_t points = at < size ? table[at] : -1;
      if (points < 0 || std::cmp_greater(points, size - at - 1)) {
        in_.fail(
            ErrorKind::malformed_file,
            fmt::format("cell {} does not fit into the {} entries that CELLS announces", c, size));
      }
      const auto begin = table.begin() + static_cast<std::ptrdiff_t>(at) + 1;
      raw_.connectivity.insert(raw_.connectivity.end(), begin, begin + points);
      raw_.offsets.push_back(static_cast<std::int64_t>(raw_.connectivity.size()));
      at += static_cast<std::size_t>(points) + 1;
    }
    if (at != size) {
      in_.fail(ErrorKind::malformed_file,
               fmt::format("CELLS announces {} entries, its {} cells have {}", size, count, at));
    }
  }

  /// `FIELD name arrays`, then each `name components tuples type` with its values.
  void field_section() {
    in_.word("the name of the field");
    const std::size_t arrays = in_.checked_count(in_.integer("the number of arrays"), 4, "arrays");
    end_of_header();
    for (std::size_t k = 0; k < arrays; ++k) {
      if (in_.peek_word() == "METADATA") {
        in_.word("METADATA");
        metadata();
      }
      const std::string name = decoded_name(in_.word("the name of an array"));
      const std::int64_t components = in_.integer("the number of components");
      const std::int64_t tuples = in_.integer("the number of tuples");
      const std::string_view type = in_.word("the type of an array");
      end_of_header();
      array(name, components, tuples, type);
    }
  }

  void attribute(const std::string& keyword) {
    if (keyword == "lookup_table") return lookup_table();
    const std::string name = decoded_name(in_.word("the name of an attribute"));
    const auto tuples = static_cast<std::int64_t>(tuples_);
    if (keyword == "scalars") {
      scalars(name);
    } else if (keyword == "color_scalars") {
      const std::int64_t components = in_.integer("the number of components");
      end_of_header();
      array({}, components, tuples, binary_ ? "unsigned_char" : "float");
    } else if (keyword == "texture_coordinates") {
      const std::int64_t components = in_.integer("the number of components");
      const std::string_view type = in_.word("the type");
      end_of_header();
      array({}, components, tuples, type);
    } else {
      const std::int64_t components = attribute_components(keyword);
      const std::string_view type = in_.word("the type");
      end_of_header();
      array(components == 1 ? name : std::string(), components, tuples, type);
    }
  }

  std::int64_t attribute_components(const std::string& keyword) const {
    if (keyword == "vectors" || keyword == "normals") return 3;
    if (keyword == "tensors") return 9;
    if (keyword == "tensors6") return 6;
    if (keyword == "global_ids" || keyword == "pedigree_ids") return 1;
    in_.fail(ErrorKind::malformed_file,
             fmt::format("unknown section or attribute `{}`", keyword.substr(0, 40)));
  }

  /// `SCALARS name type [components]`, perhaps `LOOKUP_TABLE name`, then the values.
  void scalars(const std::string& name) {
    const std::string_view type = in_.word("the type of the scalars");
    std::int64_t components = 1;
    ByteReader rest(in_.line(), in_.name());
    if (!rest.peek_word().empty()) components = rest.integer("the number of components");
    if (lower_case(in_.peek_word()) == "lookup_table") {
      in_.word("LOOKUP_TABLE");
      in_.word("the name of the lookup table");
      end_of_header();
    }
    array(name, components, static_cast<std::int64_t>(tuples_), type);
  }

  void lookup_table() {
    in_.word("the name of the table");
    const std::int64_t size = in_.integer("the size of the table");
    end_of_header();
    array({}, 4, size, binary_ ? "unsigned_char" : "float");
  }

  /// Skips lines up to an empty one.
  void metadata() {
    in_.line();
    while (in_.remaining() > 0 && !in_.line().empty()) {
    }
  }

  /// Reads an array, and keeps it as integer field if it has integers, a name and one component.
  void array(const std::string& name, std::int64_t components, std::int64_t tuples,
             std::string_view type_name) {
    const std::optional<ScalarType> type = legacy_scalar_type(type_name);
    if (!type && lower_case(type_name) == "string" && !binary_)
      return skip_strings(components, tuples);
    if (!type) {
      in_.fail(ErrorKind::malformed_file,
               fmt::format("array `{}` has the unknown type `{}`", name, type_name.substr(0, 40)));
    }
    const std::size_t width = in_.checked_count(components, 0, "components");
    // A bit takes an eighth of a byte; the exact size is checked when the block is read.
    const std::size_t each = *type == ScalarType::bit && binary_ ? 0 : item_size(*type);
    if (width != 0 && each * width / width != each) {
      in_.fail(ErrorKind::size_limit, fmt::format("array `{}` is too large", name));
    }
    const std::size_t count = in_.checked_count(tuples, each * width, "tuples");
    const bool kept = fields_ != nullptr && !name.empty() && width == 1 && is_integer(*type);
    if (!kept) {
      skip(count * width, *type);
      return;
    }
    const bool mask = bytes_of(*type) == 1;
    fields_->push_back({name, mask, integers(count, *type, "values")});
  }

  /// Reads the count at the end of the line of a keyword.
  std::size_t line_count(std::string_view what, std::size_t bytes_each) {
    const std::int64_t given = in_.integer("a count");
    end_of_header();
    return in_.checked_count(given, bytes_each * item_size(ScalarType::int32), what);
  }

  RawMesh raw_;
  std::vector<IntegerField>* fields_ = nullptr;
  std::size_t tuples_ = 0;
  bool have_points_ = false;
  bool have_cells_ = false;
  bool have_types_ = false;
};

}  // namespace

Mesh read_vtk_legacy(std::string_view bytes, const std::string& name) {
  return assemble(LegacyReader(bytes, name).read());
}

}  // namespace sinew::mesh
