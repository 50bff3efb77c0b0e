#include "frame.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::viewer {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they lie in memory");

constexpr std::uint32_t kMagic = 0x31574e53;  // "SNW1"
enum class Kind : std::uint16_t { surface = 1, frame, interior };
enum class Section : std::uint16_t {
  positions = 1,
  field,
  cables,
  effectors,
  targets,
  pull,
  probes,
  contacts,
  joints,
  pick,
  timeline,
  inner_positions,
  inner_field
};

/// Appends numbers to bytes.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) { bytes_.clear(); }

  template <typename T>
  void put(T value) {
    put(std::span<const T>(&value, 1));
  }
  template <typename T>
  void put(std::span<const T> values) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size_bytes());
  }
  void header(Kind kind, std::uint16_t generation) {
    put(kMagic);
    put(static_cast<std::uint16_t>(kind));
    put(generation);
  }
  void section(Section section, std::size_t index, std::size_t bytes) {
    put(static_cast<std::uint16_t>(section));
    put(static_cast<std::uint16_t>(index));
    put(static_cast<std::uint32_t>(bytes));
  }
  void section(Section kind, std::size_t index, const std::vector<float>& values) {
    section(kind, index, values.size() * sizeof(float));
    put(std::span<const float>(values));
  }

 private:
  std::vector<std::byte>& bytes_;
};

void put_field(Section kind, std::size_t body, int field,
               const std::vector<std::vector<float>>& fields, Writer& writer) {
  if (field < 0 || static_cast<std::size_t>(field) >= fields.size()) return;
  const std::vector<float>& values = fields[static_cast<std::size_t>(field)];
  if (values.empty()) return;
  writer.section(kind, body, sizeof(std::uint32_t) + values.size() * sizeof(float));
  writer.put(static_cast<std::uint32_t>(field));
  writer.put(std::span<const float>(values));
}

void put_bodies(const Frame& frame, const FrameChoice& choice, Writer& writer) {
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    const BodyFrame& body = frame.bodies[b];
    if (choice.shape) writer.section(Section::positions, b, body.positions);
    put_field(Section::field, b, choice.field, body.fields, writer);
    if (!choice.inside) continue;
    if (choice.shape) writer.section(Section::inner_positions, b, body.inner_positions);
    put_field(Section::inner_field, b, choice.field, body.inner_fields, writer);
  }
}

void put_pick(const Frame& frame, const Picked& wanted, Writer& writer) {
  const auto pick = std::ranges::find(frame.picks, wanted, &PickFrame::at);
  if (pick == frame.picks.end()) return;
  const std::size_t floats = 1 + 2 * pick->positions.size() + pick->fields.size();
  writer.section(Section::pick, 0, 5 * sizeof(std::uint32_t) + floats * sizeof(float));
  for (const int number : {wanted.body, static_cast<int>(wanted.kind), wanted.number,
                           pick->material, static_cast<int>(pick->positions.size() / 3)}) {
    writer.put(static_cast<std::uint32_t>(number));
  }
  writer.put(pick->volume);
  for (const auto* values : {&pick->positions, &pick->rest, &pick->fields}) {
    writer.put(std::span<const float>(*values));
  }
}

void put_timeline(const TimelineFrame& timeline, Writer& writer) {
  writer.section(Section::timeline, 0, 3 * sizeof(std::uint32_t) + 2 * sizeof(float));
  for (const std::int64_t number : {timeline.oldest, timeline.latest, timeline.shown}) {
    writer.put(static_cast<std::uint32_t>(number));
  }
  writer.put(static_cast<float>(timeline.oldest_time));
  writer.put(static_cast<float>(timeline.latest_time));
}

}  // namespace

namespace {

// Starts a message about a body: its header with two counts, and reserved memory.
void begin_message(Writer& writer, Kind kind, int body, std::size_t first, std::size_t second,
                   std::uint16_t generation) {
  constexpr std::size_t kMaxCount = std::numeric_limits<std::uint32_t>::max() / 16;
  if (std::max(first, second) > kMaxCount) {
    throw Error(ErrorKind::size_limit, {.item = "surface"},
                fmt::format("the body has {} triangles or tetrahedra", second),
                "show a coarser mesh");
  }
  writer.header(kind, generation);
  writer.put(static_cast<std::uint32_t>(body));
  writer.put(static_cast<std::uint32_t>(first));
  writer.put(static_cast<std::uint32_t>(second));
  writer.put(std::uint32_t{0});
}

}  // namespace

std::vector<std::byte> encode_surface(const DisplaySurface& surface, int body,
                                      std::uint16_t generation) {
  std::vector<std::byte> bytes;
  Writer writer(bytes);
  begin_message(writer, Kind::surface, body, surface.nodes.size(), surface.elements.size(),
                generation);
  writer.put(std::span<const float>(surface.rest));
  writer.put(std::span<const std::uint32_t>(surface.triangles));
  writer.put(std::span<const NodeId>(surface.nodes));
  writer.put(std::span<const std::int32_t>(surface.elements));
  return bytes;
}

std::vector<std::byte> encode_interior(const DisplaySurface& surface, int body,
                                       std::uint16_t generation) {
  const mesh::Interior& inside = surface.inside;
  const std::size_t vertices = inside.nodes.size() + inside.hexahedra.size();
  std::vector<std::byte> bytes;
  Writer writer(bytes);
  begin_message(writer, Kind::interior, body, vertices, inside.elements.size(), generation);
  writer.put(std::span<const NodeId>(inside.nodes));
  const std::vector<NodeId> middles(inside.hexahedra.size(), -1);
  writer.put(std::span<const NodeId>(middles));
  writer.put(std::span<const std::uint32_t>(inside.tetrahedra));
  writer.put(std::span<const std::int32_t>(inside.elements));
  return bytes;
}

void encode_frame(const Frame& frame, const FrameChoice& choice, std::vector<std::byte>& bytes) {
  Writer writer(bytes);
  writer.header(Kind::frame, choice.generation);
  writer.put(choice.sequence);
  writer.put(static_cast<std::uint32_t>(frame.signals.size()));
  writer.put(frame.step);
  writer.put(frame.time);
  writer.put(frame.hash);
  writer.put(std::span<const double>(frame.signals));
  put_bodies(frame, choice, writer);
  if (choice.shape) {
    writer.section(Section::cables, 0, frame.cables);
    writer.section(Section::effectors, 0, frame.effectors);
    if (!frame.probes.empty()) writer.section(Section::probes, 0, frame.probes);
    for (std::size_t c = 0; c < frame.contacts.size(); ++c) {
      writer.section(Section::contacts, c, frame.contacts[c]);
    }
    if (!frame.joints.empty()) writer.section(Section::joints, 0, frame.joints);
  }
  writer.section(Section::targets, 0, frame.targets);
  if (frame.pull) {
    const auto single = [](double value) { return static_cast<float>(value); };
    std::vector<float> values;
    for (const Vector3& v : {frame.pull->point, frame.pull->anchor}) {
      for (int c = 0; c < 3; ++c) values.push_back(single(v[c]));
    }
    values.push_back(single(frame.pull->force));
    writer.section(Section::pull, 0, values);
  }
  if (choice.pick) put_pick(frame, *choice.pick, writer);
  if (frame.timeline) put_timeline(*frame.timeline, writer);
}

}  // namespace sinew::viewer
