// Motion as binary glTF: parses the written file. The tests of the page check such files with the
// validator of Khronos.
#include "sinew/record/glb.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"

namespace sinew::record {
namespace {

using Json = nlohmann::json;

struct Parts {
  Json json;
  std::string binary;
};

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

Parts take_apart(const std::string& file) {
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word(file, 4), 2U);
  EXPECT_EQ(word(file, 8), file.size());
  const std::size_t length = word(file, 12);
  EXPECT_EQ(length % 4, 0U);
  const std::size_t binary = 20 + length;
  EXPECT_EQ(word(file, binary) + binary + 8, file.size());
  return {Json::parse(file.substr(20, length)), file.substr(binary + 8)};
}

std::vector<float> floats(const Parts& parts, const Json& accessor_number) {
  const Json& accessor = parts.json["accessors"][accessor_number.get<std::size_t>()];
  const Json& view = parts.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  std::vector<float> values(view["byteLength"].get<std::size_t>() / sizeof(float));
  std::memcpy(values.data(), parts.binary.data() + view["byteOffset"].get<std::size_t>(),
              values.size() * sizeof(float));
  return values;
}

Motion falling_triangle() {
  Motion motion;
  motion.name = "test";
  motion.times = {0.0F, 0.5F, 2.0F};
  motion.surfaces.push_back({"sheet",
                             {0, 1, 2},
                             {{0, 0, 1, 1, 0, 1, 0, 1, 1},
                              {0, 0, 0.5F, 1, 0, 0.5F, 0, 1, 0.5F},
                              {0, 0, 0, 0, 1, 0, -1, 0, 0}}});
  motion.lines.push_back({"wire", {{0, 0, 0, 1, 1, 1}, {0, 0, 0, 2, 2, 2}, {0, 0, 0, 3, 3, 3}}});
  return motion;
}

TEST(WriteGlb, FramesAreMorphTargetsOfTheFirst) {
  const Motion motion = falling_triangle();
  const Parts parts = take_apart(write_glb(motion));
  ASSERT_EQ(parts.json["meshes"].size(), 2U);
  const Json& sheet = parts.json["meshes"][0]["primitives"][0];
  EXPECT_EQ(floats(parts, sheet["attributes"]["POSITION"]), motion.surfaces[0].frames[0]);
  ASSERT_EQ(sheet["targets"].size(), 2U);
  const auto base = motion.surfaces[0].frames[0];
  for (std::size_t k = 0; k < 2; ++k) {
    const auto moved = floats(parts, sheet["targets"][k]["POSITION"]);
    for (std::size_t i = 0; i < base.size(); ++i) {
      EXPECT_EQ(base[i] + moved[i], motion.surfaces[0].frames[k + 1][i]);
    }
  }
  // The triangle has rotated by a quarter turn about z, so its normal is still z.
  const auto normals = floats(parts, sheet["attributes"]["NORMAL"]);
  EXPECT_EQ(normals, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  for (const float change : floats(parts, sheet["targets"][1]["NORMAL"])) EXPECT_EQ(change, 0.0F);
  EXPECT_EQ(parts.json["meshes"][1]["primitives"][0]["mode"], 3) << "a line strip";
}

TEST(WriteGlb, OneTargetAtATimeInTheAnimation) {
  const Motion motion = falling_triangle();
  const Parts parts = take_apart(write_glb(motion));
  const Json& sampler = parts.json["animations"][0]["samplers"][0];
  EXPECT_EQ(floats(parts, sampler["input"]), motion.times);
  EXPECT_EQ(floats(parts, sampler["output"]), (std::vector<float>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(sampler["interpolation"], "LINEAR");
  EXPECT_EQ(parts.json["animations"][0]["channels"].size(), 2U);
}

TEST(WriteGlb, OurZPointsUp) {
  const Parts parts = take_apart(write_glb(falling_triangle()));
  const Json& root = parts.json["nodes"][parts.json["scenes"][0]["nodes"][0].get<std::size_t>()];
  const auto q = root["rotation"].get<std::array<double, 4>>();  // x, y, z, w
  // The third column of the quaternion's rotation, which is the image of z.
  EXPECT_NEAR(2 * (q[0] * q[2] + q[1] * q[3]), 0.0, 1e-12);
  EXPECT_NEAR(2 * (q[1] * q[2] - q[0] * q[3]), 1.0, 1e-12);
  EXPECT_NEAR(1 - 2 * (q[0] * q[0] + q[1] * q[1]), 0.0, 1e-12);
}

TEST(WriteGlb, ASingleFrameStandsStill) {
  Motion motion = falling_triangle();
  motion.times.resize(1);
  motion.surfaces[0].frames.resize(1);
  motion.lines[0].frames.resize(1);
  const Parts parts = take_apart(write_glb(motion));
  EXPECT_FALSE(parts.json.contains("animations"));
  EXPECT_FALSE(parts.json["meshes"][0]["primitives"][0].contains("targets"));
}

TEST(WriteGlb, RefusesFramesThatDoNotFit) {
  Motion empty;
  EXPECT_THROW(write_glb(empty), Error);
  Motion uneven = falling_triangle();
  uneven.surfaces[0].frames[1].resize(6);
  EXPECT_THROW(write_glb(uneven), Error);
  Motion missing = falling_triangle();
  missing.lines[0].frames.pop_back();
  EXPECT_THROW(write_glb(missing), Error);
}

}  // namespace
}  // namespace sinew::record
