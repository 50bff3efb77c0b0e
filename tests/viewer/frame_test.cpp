#include "viewer/frame.hpp"

#include <cstring>

#include <gtest/gtest.h>

namespace sinew::viewer {
namespace {

template <typename T>
T number(const std::vector<std::byte>& bytes, std::size_t at) {
  T value{};
  EXPECT_LE(at + sizeof value, bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST(Frame, SurfaceStandsAsDocumented) {
  DisplaySurface surface;
  surface.rest = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  surface.triangles = {2, 1, 0};
  surface.nodes = {4, 8, 6};
  surface.elements = {-1};
  const auto bytes = encode_surface(surface, 5, 7);
  ASSERT_EQ(bytes.size(), 24U + 36U + 12U + 12U + 4U);
  EXPECT_EQ(std::memcmp(bytes.data(), "SNW1", 4), 0);
  EXPECT_EQ(number<std::uint16_t>(bytes, 4), 1);
  EXPECT_EQ(number<std::uint16_t>(bytes, 6), 7);
  EXPECT_EQ(number<std::uint32_t>(bytes, 8), 5U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 12), 3U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 16), 1U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 20), 0U);
  EXPECT_EQ(number<float>(bytes, 24 + 4 * 8), 9.0F);
  EXPECT_EQ(number<std::uint32_t>(bytes, 60), 2U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 76), 8U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 84), 0xffffffffU);
}

TEST(Frame, InteriorStandsAsDocumented) {
  DisplaySurface surface;
  surface.inside.nodes = {5, 7};
  surface.inside.hexahedra.resize(1);
  surface.inside.tetrahedra = {0, 1, 2, 3, 4, 5, 6, 7};
  surface.inside.elements = {3, 9};
  const auto bytes = encode_interior(surface, 1, 2);
  ASSERT_EQ(bytes.size(), 24U + 12U + 32U + 8U);
  EXPECT_EQ(number<std::uint16_t>(bytes, 4), 3);
  EXPECT_EQ(number<std::uint32_t>(bytes, 8), 1U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 12), 3U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 16), 2U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 28), 7U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 32), 0xffffffffU) << "the middle of a hexahedron";
  EXPECT_EQ(number<std::uint32_t>(bytes, 64), 7U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 72), 9U);
}

Frame sample() {
  Frame frame;
  frame.step = 0x100000002ULL;
  frame.time = 1.5;
  frame.hash = 0xfedcba9876543210ULL;
  frame.signals = {0.25, -3.0};
  frame.bodies = {{{1, 2, 3}, {{}, {42}}, {4, 5, 6, 7, 8, 9}, {{}, {43, 44}}}};
  frame.cables = {1, 1, 1, 2, 2, 2};
  frame.effectors = {7, 8, 9};
  frame.targets = {4, 5, 6};
  frame.probes = {3, 2, 1};
  frame.contacts = {{}, {0, 0, 1, 0, 0, 0, 1, 1, 2, 3, 4, 5, 6, 2}};
  frame.joints = {1, 2, 3, 4, 5, 6, 0, 0, 1, 0, 0, 0};
  frame.picks = {{.at = {0, PickKind::node, 5}, .positions = {1, 2, 3}, .rest = {4, 5, 6}},
                 {.at = {0, PickKind::element, 5},
                  .material = 2,
                  .volume = 0.5F,
                  .positions = {1, 2, 3, 4, 5, 6},
                  .rest = {6, 5, 4, 3, 2, 1},
                  .fields = {2.0F, 3.0F}}};
  return frame;
}

/// Kind, index and size of each section, and the offset of its content.
struct Part {
  int kind, index;
  std::size_t at, bytes;
};
std::vector<Part> parts(const std::vector<std::byte>& bytes, std::size_t signals) {
  std::vector<Part> result;
  for (std::size_t at = 40 + 8 * signals; at < bytes.size();) {
    const Part part{number<std::uint16_t>(bytes, at), number<std::uint16_t>(bytes, at + 2), at + 8,
                    number<std::uint32_t>(bytes, at + 4)};
    result.push_back(part);
    at = part.at + part.bytes;
  }
  return result;
}

TEST(Frame, StandsAsDocumented) {
  std::vector<std::byte> bytes;
  encode_frame(sample(), {.generation = 3, .sequence = 9, .shape = true, .field = 1}, bytes);
  EXPECT_EQ(number<std::uint16_t>(bytes, 4), 2);
  EXPECT_EQ(number<std::uint16_t>(bytes, 6), 3);
  EXPECT_EQ(number<std::uint32_t>(bytes, 8), 9U);
  EXPECT_EQ(number<std::uint32_t>(bytes, 12), 2U);
  EXPECT_EQ(number<std::uint64_t>(bytes, 16), 0x100000002ULL);
  EXPECT_EQ(number<double>(bytes, 24), 1.5);
  EXPECT_EQ(number<std::uint64_t>(bytes, 32), 0xfedcba9876543210ULL);
  EXPECT_EQ(number<double>(bytes, 48), -3.0);
  const auto list = parts(bytes, 2);
  ASSERT_EQ(list.size(), 9U);
  EXPECT_EQ(list[0].kind, 1);
  EXPECT_EQ(number<float>(bytes, list[0].at + 8), 3.0F);
  EXPECT_EQ(list[1].kind, 2);
  EXPECT_EQ(number<std::uint32_t>(bytes, list[1].at), 1U);
  EXPECT_EQ(number<float>(bytes, list[1].at + 4), 42.0F);
  EXPECT_EQ(list[2].kind, 3);
  EXPECT_EQ(list[2].bytes, 24U);
  EXPECT_EQ(list[3].kind, 4);
  EXPECT_EQ(list[4].kind, 7);
  EXPECT_EQ(number<float>(bytes, list[4].at), 3.0F);
  EXPECT_EQ(list[5].kind, 8);
  EXPECT_EQ(list[5].bytes, 0U);
  EXPECT_EQ(list[6].kind, 8);
  EXPECT_EQ(list[6].index, 1);
  ASSERT_EQ(list[6].bytes, 4U * 14U);
  EXPECT_EQ(number<float>(bytes, list[6].at + 4 * 13), 2.0F);
  EXPECT_EQ(list[7].kind, 9);
  ASSERT_EQ(list[7].bytes, 4U * 12U);
  EXPECT_EQ(number<float>(bytes, list[7].at + 4 * 8), 1.0F);
  EXPECT_EQ(list[8].kind, 5);
}

TEST(Frame, LeavesOutWhatHasNotChanged) {
  std::vector<std::byte> bytes;
  Frame frame = sample();
  frame.pull = PullFrame{{1, 2, 3}, {4, 5, 6}, 0.5};
  encode_frame(frame, {.generation = 3, .sequence = 9, .shape = false, .field = 0}, bytes);
  const auto list = parts(bytes, 2);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].kind, 5);
  EXPECT_EQ(list[1].kind, 6);
  EXPECT_EQ(number<float>(bytes, list[1].at + 24), 0.5F);
}

TEST(Frame, HasTheElementAndTheTimelineThatWereAskedFor) {
  std::vector<std::byte> bytes;
  Frame frame = sample();
  frame.timeline = TimelineFrame{2, 40, 7, 0.5, 4.25};
  encode_frame(frame, {.shape = false, .pick = Picked{0, PickKind::element, 5}}, bytes);
  auto list = parts(bytes, 2);
  ASSERT_EQ(list.size(), 3U);
  const auto at = list[1].at;
  EXPECT_EQ(list[1].kind, 10);
  ASSERT_EQ(list[1].bytes, 4U * (5 + 1 + 12 + 2));
  EXPECT_EQ(number<std::uint32_t>(bytes, at), 0U);
  EXPECT_EQ(number<std::uint32_t>(bytes, at + 4), 1U) << "an element";
  EXPECT_EQ(number<std::uint32_t>(bytes, at + 8), 5U);
  EXPECT_EQ(number<std::uint32_t>(bytes, at + 12), 2U);
  EXPECT_EQ(number<std::uint32_t>(bytes, at + 16), 2U) << "nodes";
  EXPECT_EQ(number<float>(bytes, at + 20), 0.5F);
  EXPECT_EQ(number<float>(bytes, at + 24 + 4 * 5), 6.0F);
  EXPECT_EQ(number<float>(bytes, at + 24 + 4 * 6), 6.0F);
  EXPECT_EQ(number<float>(bytes, at + 24 + 4 * 13), 3.0F);
  EXPECT_EQ(list[2].kind, 11);
  ASSERT_EQ(list[2].bytes, 20U);
  EXPECT_EQ(number<std::uint32_t>(bytes, list[2].at + 4), 40U);
  EXPECT_EQ(number<std::uint32_t>(bytes, list[2].at + 8), 7U);
  EXPECT_EQ(number<float>(bytes, list[2].at + 16), 4.25F);
  encode_frame(frame, {.shape = false, .pick = Picked{1, PickKind::node, 5}}, bytes);
  list = parts(bytes, 2);
  ASSERT_EQ(list.size(), 2U) << "a node that no frame has";
  EXPECT_EQ(list[1].kind, 11);
}

TEST(Frame, HasWhatIsInsideForThoseWhoWantIt) {
  std::vector<std::byte> bytes;
  encode_frame(sample(), {.shape = true, .field = 1, .inside = true}, bytes);
  auto list = parts(bytes, 2);
  ASSERT_GT(list.size(), 4U);
  EXPECT_EQ(list[2].kind, 12);
  ASSERT_EQ(list[2].bytes, 24U);
  EXPECT_EQ(number<float>(bytes, list[2].at + 20), 9.0F);
  EXPECT_EQ(list[3].kind, 13);
  ASSERT_EQ(list[3].bytes, 12U);
  EXPECT_EQ(number<std::uint32_t>(bytes, list[3].at), 1U);
  EXPECT_EQ(number<float>(bytes, list[3].at + 8), 44.0F);
  encode_frame(sample(), {.shape = false, .field = 1, .inside = true}, bytes);
  list = parts(bytes, 2);
  EXPECT_EQ(list[1].kind, 13) << "where nothing has moved";
}

}  // namespace
}  // namespace sinew::viewer
