#include "sinew/mesh/gmsh.hpp"

#include <memory>

#include <fmt/format.h>

#include "sinew/mesh/gmsh_input.hpp"

namespace sinew::mesh {

namespace {

struct Header {
  std::string version;
  std::unique_ptr<GmshSections> sections;
};

/// `version file-type data-size`, and for binary files the integer 1 to tell the byte order.
Header read_header(GmshInput& in) {
  ByteReader& reader = in.reader();
  const std::string version(reader.word("the version").substr(0, 8));
  const std::int64_t binary = reader.integer("the file type, 0 or 1");
  const std::int64_t data_size = reader.integer("the data size");
  Header header{.version = version, .sections = nullptr};
  if (version == "4.1") {
    header.sections = std::make_unique<GmshSections4>();
  } else if (version == "2" || version.starts_with("2.")) {
    header.sections = std::make_unique<GmshSections2>();
  } else {
    reader.fail(ErrorKind::unsupported_version,
                fmt::format("Gmsh's format {} is not read", version),
                "save as version 4.1 or 2.2 (gmsh FILE -save -format msh41)");
  }
  if (data_size != 8) {
    reader.fail(ErrorKind::unsupported_version,
                fmt::format("numbers of {} bytes are not read, only of 8", data_size));
  }
  reader.line();
  if (binary == 0) return header;
  const std::string_view one = reader.block(4, "the byte order mark");
  const bool little = decode_integers(one, ScalarType::int32, ByteOrder::little)[0] == 1;
  const bool big = decode_integers(one, ScalarType::int32, ByteOrder::big)[0] == 1;
  if (!little && !big) {
    reader.fail(ErrorKind::malformed_file, "the byte order mark is not 1 in either order");
  }
  in.set_binary(little ? ByteOrder::little : ByteOrder::big);
  return header;
}

/// `dimension tag "name"`, text in both encodings.
void read_names(GmshInput& in) {
  ByteReader& reader = in.reader();
  const std::size_t count =
      reader.checked_count(reader.integer("the number of groups"), 6, "physical groups");
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t dimension = reader.integer("a dimension");
    const std::int64_t tag = reader.integer("a group");
    const std::string_view rest = reader.line();
    const std::size_t open = rest.find('"');
    const std::size_t close = rest.rfind('"');
    if (open == std::string_view::npos || close <= open) {
      reader.fail(ErrorKind::malformed_file,
                  fmt::format("the name of physical group {} is not in quotes", tag));
    }
    in.name_group({dimension, tag}, std::string(rest.substr(open + 1, close - open - 1)));
  }
}

void expect_end(GmshInput& in, const std::string& section) {
  const std::string end = "$End" + section.substr(1);
  const std::string_view word = in.reader().word(end);
  if (word != end) {
    in.reader().fail(ErrorKind::malformed_file,
                     fmt::format("expected {} after the section's last entry", end),
                     "the number of entries at its start may be wrong");
  }
}

void skip_section(GmshInput& in, const std::string& section) {
  if (section.empty() || section.front() != '$') {
    in.reader().fail(ErrorKind::malformed_file, "expected the start of a section, `$...`");
  }
  if (!in.reader().skip_past("$End" + section.substr(1))) {
    in.reader().fail(ErrorKind::truncated_file,
                     fmt::format("section {} has no end", section.substr(0, 40)),
                     "write the file again; it was probably cut short");
  }
}

RawMesh read(GmshInput& in) {
  Header header;
  bool have_elements = false;
  while (!in.reader().at_end()) {
    const std::string section(in.reader().word("a section"));
    if (section == "$MeshFormat") {
      header = read_header(in);
      expect_end(in, section);
    } else if (section == "$PhysicalNames") {
      read_names(in);
      expect_end(in, section);
    } else if (header.sections && header.sections->read(section, in)) {
      expect_end(in, section);
      have_elements = have_elements || section == "$Elements";
    } else {
      skip_section(in, section);
    }
  }
  if (!have_elements) {
    in.reader().fail(ErrorKind::truncated_file, "the file has no $Elements",
                     "write the file again; it was probably cut short");
  }
  RawMesh raw = in.take();
  raw.format = fmt::format("Gmsh {}, {}", header.version, in.binary() ? "binary" : "ascii");
  return raw;
}

}  // namespace

Mesh read_gmsh(std::string_view bytes, const std::string& name) {
  GmshInput in(bytes, name);
  return assemble(read(in));
}

}  // namespace sinew::mesh
