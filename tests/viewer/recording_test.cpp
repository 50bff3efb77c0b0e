// Recordings of the page: numbers of every step, positions at intervals, and bounded memory.
#include "viewer/recording.hpp"

#include <gtest/gtest.h>

#include "sinew/core/csv.hpp"

#include "viewer/limits.hpp"

namespace sinew::viewer {
namespace {

Description triangle_and_wire(std::size_t signals) {
  Description shown;
  DisplaySurface surface;
  surface.body = "sheet";
  surface.rest = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  surface.triangles = {0, 1, 2};
  shown.surfaces = {surface};
  shown.cables = {{"wire", 2}};
  shown.effectors = {"tip"};
  for (std::size_t k = 0; k < signals; ++k)
    shown.signals.push_back({"s" + std::to_string(k), "", "N", ""});
  return shown;
}

Frame frame_at(std::uint64_t step, double time_step, std::size_t signals) {
  Frame frame;
  frame.step = step;
  frame.time = static_cast<double>(step) * time_step;
  frame.signals.assign(signals, static_cast<double>(step));
  const auto height = static_cast<float>(frame.time);
  frame.bodies.resize(1);
  frame.bodies[0].positions = {0, 0, height, 1, 0, height, 0, 1, height};
  frame.cables = {0, 0, 0, 0, 0, height};
  frame.targets = {1, 2, 3};
  return frame;
}

TEST(Recording, KeepsEveryStepsNumbers) {
  const Description shown = triangle_and_wire(2);
  Recording recording(shown, "test");
  for (std::uint64_t k = 5; k <= 25; ++k) {
    Frame frame = frame_at(k, 0.01, 2);
    if (k == 20) frame.pull = PullFrame{Vector3::Zero(), Vector3::Zero(), 1.5};
    EXPECT_TRUE(recording.add(frame));
  }
  EXPECT_EQ(recording.rows(), 21U);
  EXPECT_DOUBLE_EQ(recording.seconds(), 0.2);
  const Table table = parse_csv(recording.csv(), "run.csv");
  EXPECT_EQ(table.names,
            (std::vector<std::string>{"time [s]", "step", "s0 [N]", "s1 [N]", "tip.target_x [m]",
                                      "tip.target_y [m]", "tip.target_z [m]", "hand.force [N]"}));
  ASSERT_EQ(table.values.rows(), 21);
  EXPECT_EQ(table.values(0, 1), 5.0);
  EXPECT_EQ(table.values(20, 2), 25.0);
  EXPECT_EQ(table.values(3, 5), 2.0);
  EXPECT_EQ(table.values(15, 7), 1.5);
  EXPECT_EQ(table.values(16, 7), 0.0);
}

TEST(Recording, AMotionOfAnyLengthHasBoundedFrames) {
  const Description shown = triangle_and_wire(0);
  Recording recording(shown, "test");
  for (std::uint64_t k = 0; k < 50000; ++k) ASSERT_TRUE(recording.add(frame_at(k, 0.01, 0)));
  EXPECT_EQ(recording.rows(), 50000U);
  const std::string glb = recording.glb();
  // At most 600 frames of three vertices and two points, and 600^2 weights.
  EXPECT_LT(glb.size(), 2'500'000U);
  EXPECT_NE(glb.find("\"wire\""), std::string::npos);
}

TEST(Recording, EndsWhenItsMemoryIsFull) {
  constexpr std::size_t kSignals = 20000;
  const Description shown = triangle_and_wire(kSignals);
  Recording recording(shown, "test");
  const Frame frame = frame_at(0, 0.01, kSignals);
  std::size_t rows = 0;
  while (recording.add(frame) && rows < 10000) ++rows;
  EXPECT_TRUE(recording.full());
  EXPECT_EQ(recording.rows(), rows);
  EXPECT_LE(recording.bytes(), limits::kRecordedRows + record::kMotionBytes);
  EXPECT_GT(recording.bytes(), limits::kRecordedRows * 9 / 10);
  EXPECT_FALSE(recording.add(frame));
}

}  // namespace
}  // namespace sinew::viewer
