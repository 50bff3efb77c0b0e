#include "sinew/mesh/vtu_array.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/mesh/codec.hpp"

namespace sinew::mesh {

namespace {

constexpr std::pair<std::string_view, ScalarType> kTypes[] = {
    {"Int8", ScalarType::int8},       {"UInt8", ScalarType::uint8},
    {"Int16", ScalarType::int16},     {"UInt16", ScalarType::uint16},
    {"Int32", ScalarType::int32},     {"UInt32", ScalarType::uint32},
    {"Int64", ScalarType::int64},     {"UInt64", ScalarType::uint64},
    {"Float32", ScalarType::float32}, {"Float64", ScalarType::float64},
};

std::string described(pugi::xml_node array) {
  const std::string name = array.attribute("Name").as_string();
  return name.empty() ? fmt::format("the array of <{}>", array.parent().name())
                      : fmt::format("array `{}`", name);
}

}  // namespace

VtuFile::VtuFile(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
  parse();
  read_attributes();
}

/// Appended data may be raw bytes, which are not valid XML, so the document is parsed without them.
void VtuFile::parse() {
  constexpr std::string_view kTag = "<AppendedData";
  const std::size_t tag = bytes_.find(kTag);
  xml_ = bytes_.substr(0, tag);
  std::string text(xml_);
  if (tag != std::string_view::npos) {
    find_appended(tag);
    text += "</VTKFile>";
  }
  const pugi::xml_parse_result result = document_.load_buffer(text.data(), text.size());
  if (!result) {
    const std::size_t at = std::min(static_cast<std::size_t>(result.offset), xml_.size());
    const auto end = xml_.begin() + static_cast<std::ptrdiff_t>(at);
    throw Error(result.status == pugi::status_end_element_mismatch && at + 1 >= xml_.size()
                    ? ErrorKind::truncated_file
                    : ErrorKind::malformed_file,
                {.file = name_, .line = 1 + static_cast<int>(std::count(xml_.begin(), end, '\n'))},
                fmt::format("the XML is broken: {}", result.description()), "write the file again");
  }
}

void VtuFile::find_appended(std::size_t tag) {
  const std::size_t end = bytes_.find('>', tag);
  const std::size_t start = bytes_.find('_', std::min(end, bytes_.size()));
  if (start == std::string_view::npos) {
    throw Error(ErrorKind::truncated_file, {.file = name_},
                "the appended data have no underscore to start with", "write the file again");
  }
  const std::string_view attributes = bytes_.substr(tag, end - tag);
  appended_is_base64_ = attributes.find("base64") != std::string_view::npos;
  appended_ = bytes_.substr(start + 1);
  if (appended_is_base64_) appended_ = appended_.substr(0, appended_.find('<'));
}

void VtuFile::read_attributes() {
  const std::string_view order = root().attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian" && order != "BigEndian") {
    fail(ErrorKind::malformed_file, root(), fmt::format("unknown byte_order `{}`", order));
  }
  order_ = order == "BigEndian" ? ByteOrder::big : ByteOrder::little;
  const std::string_view header = root().attribute("header_type").as_string("UInt32");
  if (header != "UInt32" && header != "UInt64") {
    fail(ErrorKind::malformed_file, root(), fmt::format("unknown header_type `{}`", header));
  }
  header_bytes_ = header == "UInt64" ? 8 : 4;
  const std::string_view compressor = root().attribute("compressor").as_string();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    fail(ErrorKind::unknown_format, root(),
         fmt::format("the arrays are compressed with {}, which is not read", compressor),
         "save with zlib or without compression");
  }
  compressed_ = !compressor.empty();
}

int VtuFile::line_of(pugi::xml_node node) const {
  const auto offset =
      std::clamp<std::ptrdiff_t>(node.offset_debug(), 0, static_cast<std::ptrdiff_t>(xml_.size()));
  return 1 + static_cast<int>(std::count(xml_.begin(), xml_.begin() + offset, '\n'));
}

void VtuFile::fail(ErrorKind kind, pugi::xml_node node, const std::string& message,
                   const std::string& remedy) const {
  throw Error(kind, {.file = name_, .line = line_of(node)}, message, remedy);
}

std::size_t VtuFile::count(pugi::xml_node node, const char* attribute) const {
  const std::string_view text = node.attribute(attribute).as_string();
  std::int64_t value = -1;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || value < 0) {
    fail(ErrorKind::malformed_file, node, fmt::format("{}=\"{}\" is not a count", attribute, text));
  }
  if (value > std::numeric_limits<std::int32_t>::max()) {
    fail(ErrorKind::size_limit, node, fmt::format("{}=\"{}\" is too large", attribute, text));
  }
  return static_cast<std::size_t>(value);
}

ScalarType VtuFile::type_of(pugi::xml_node array) const {
  const std::string_view wanted = array.attribute("type").as_string();
  for (const auto& [name, type] : kTypes) {
    if (name == wanted) return type;
  }
  fail(ErrorKind::malformed_file, array,
       fmt::format("{} has the unknown type `{}`", described(array), wanted));
}

bool VtuFile::is_ascii(pugi::xml_node array) const {
  const std::string_view format = array.attribute("format").as_string("ascii");
  if (format != "ascii" && format != "binary" && format != "appended") {
    fail(ErrorKind::malformed_file, array,
         fmt::format("{} has the unknown format `{}`", described(array), format));
  }
  return format == "ascii";
}

/// Up to `max_bytes` of the stored form of an array, after its first `skip` bytes.
std::string VtuFile::raw_bytes(pugi::xml_node array, std::size_t skip,
                               std::size_t max_bytes) const {
  std::string_view source = array.text().get();
  bool base64 = true;
  if (std::string_view(array.attribute("format").as_string()) == "appended") {
    const std::size_t offset = count(array, "offset");
    if (offset > appended_.size()) {
      fail(ErrorKind::truncated_file, array,
           fmt::format("{} starts at offset {} of appended data that have {} bytes",
                       described(array), offset, appended_.size()),
           "write the file again; it was probably cut short");
    }
    source = appended_.substr(offset);
    base64 = appended_is_base64_;
  }
  if (!base64) return std::string(source.substr(std::min(skip, source.size()), max_bytes));
  const auto decoded = decode_base64(
      source, max_bytes > std::string::npos - skip ? std::string::npos : skip + max_bytes);
  if (!decoded) {
    fail(ErrorKind::bad_encoding, array, fmt::format("{} is not valid base64", described(array)),
         "write the file again");
  }
  return decoded->substr(std::min(skip, decoded->size()), max_bytes);
}

std::size_t VtuFile::header_item(pugi::xml_node array, std::string_view header,
                                 std::size_t item) const {
  const std::string_view bytes =
      header.substr(std::min(item * header_bytes_, header.size()), header_bytes_);
  const ScalarType type = header_bytes_ == 8 ? ScalarType::uint64 : ScalarType::uint32;
  const auto values = decode_integers(bytes, type, order_);
  if (values.empty() || values[0] < 0) {
    fail(ErrorKind::truncated_file, array,
         fmt::format("the size header of {} is cut short or damaged", described(array)),
         "write the file again");
  }
  return static_cast<std::size_t>(values[0]);
}

std::string VtuFile::plain_block(pugi::xml_node array) const {
  const std::size_t size = header_item(array, raw_bytes(array, 0, header_bytes_), 0);
  std::string data = raw_bytes(array, header_bytes_, size);
  if (data.size() < size) {
    fail(ErrorKind::truncated_file, array,
         fmt::format("{} should have {} bytes, but the file has only {} of them", described(array),
                     size, data.size()),
         "write the file again; it was probably cut short");
  }
  return data;
}

/// Header: number of blocks, size of a block, size of the last one if it is partial (else 0),
/// compressed size of each block.
std::string VtuFile::compressed_block(pugi::xml_node array) const {
  const std::size_t blocks = header_item(array, raw_bytes(array, 0, header_bytes_), 0);
  if (blocks > bytes_.size() / header_bytes_) {
    fail(ErrorKind::truncated_file, array,
         fmt::format("{} announces {} compressed blocks, more than the file can hold",
                     described(array), blocks));
  }
  const std::size_t header_size = (3 + blocks) * header_bytes_;
  const std::string header = raw_bytes(array, 0, header_size);
  const std::size_t full = header_item(array, header, 1);
  const std::size_t partial = header_item(array, header, 2);
  const std::string stored = raw_bytes(array, header_size, std::string::npos);
  std::string data;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t packed = header_item(array, header, 3 + b);
    const std::size_t size = b + 1 == blocks && partial != 0 ? partial : full;
    const bool there = packed <= stored.size() - at;
    const auto unpacked =
        there ? inflate(std::string_view(stored).substr(at, packed), size) : std::nullopt;
    if (!unpacked) {
      fail(there ? ErrorKind::bad_encoding : ErrorKind::truncated_file, array,
           fmt::format("compressed block {} of {} is {}", b, described(array),
                       there ? "damaged" : "cut short"),
           "write the file again");
    }
    data += *unpacked;
    at += packed;
  }
  return data;
}

std::string VtuFile::block(pugi::xml_node array) const {
  return compressed_ ? compressed_block(array) : plain_block(array);
}

template <typename Value, typename Decode, typename Parse>
std::vector<Value> VtuFile::values(pugi::xml_node array, const Decode& decode,
                                   const Parse& parse) const {
  const ScalarType type = type_of(array);
  if (!is_ascii(array)) return decode(block(array), type, order_);
  const std::string_view text = array.text().get();
  ByteReader reader(text, name_, line_of(array));
  std::vector<Value> result;
  while (!reader.at_end()) result.push_back(parse(reader));
  return result;
}

void VtuFile::check_size(pugi::xml_node array, std::size_t have, std::size_t count) const {
  if (have == count) return;
  fail(have < count ? ErrorKind::truncated_file : ErrorKind::malformed_file, array,
       fmt::format("{} has {} values instead of {}", described(array), have, count),
       "write the file again");
}

std::vector<double> VtuFile::doubles(pugi::xml_node array, std::size_t count) const {
  auto result = values<double>(array, decode_doubles,
                               [](ByteReader& reader) { return reader.number("a number"); });
  check_size(array, result.size(), count);
  return result;
}

std::vector<std::int64_t> VtuFile::all_integers(pugi::xml_node array) const {
  if (!is_integer(type_of(array))) {
    fail(ErrorKind::malformed_file, array,
         fmt::format("{} must be of an integer type", described(array)));
  }
  return values<std::int64_t>(array, decode_integers,
                              [](ByteReader& reader) { return reader.integer("an integer"); });
}

std::vector<std::int64_t> VtuFile::integers(pugi::xml_node array, std::size_t count) const {
  auto result = all_integers(array);
  check_size(array, result.size(), count);
  return result;
}

}  // namespace sinew::mesh
