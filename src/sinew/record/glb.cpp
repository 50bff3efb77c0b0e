#include "sinew/record/glb.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/build_info.hpp"
#include "sinew/core/error.hpp"

namespace sinew::record {

namespace {

using Json = nlohmann::json;
using Floats = std::vector<float>;

// Constants of the specification.
constexpr int kFloat = 5126, kUnsigned = 5125;
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;
constexpr int kLineStrip = 3, kTriangles = 4;
constexpr std::uint32_t kMagic = 0x46546c67, kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

/// Unit normals of vertices (3 v,), from the sum of the area vectors of adjacent triangles.
Floats normals_of(const Floats& positions, const std::vector<std::uint32_t>& triangles) {
  Floats normals(positions.size(), 0.0F);
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    std::array<const float*, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = positions.data() + std::size_t{3} * triangles[t + k];
    }
    std::array<float, 3> u{}, v{};
    for (std::size_t c = 0; c < 3; ++c) {
      u[c] = corner[1][c] - corner[0][c];
      v[c] = corner[2][c] - corner[0][c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      for (std::size_t k = 0; k < 3; ++k) {
        normals[std::size_t{3} * triangles[t + k] + c] += u[a] * v[b] - u[b] * v[a];
      }
    }
  }
  for (std::size_t i = 0; i + 2 < normals.size(); i += 3) {
    const float length = std::hypot(normals[i], normals[i + 1], normals[i + 2]);
    if (length > 0.0F) {
      for (std::size_t c = 0; c < 3; ++c) normals[i + c] /= length;
    } else {
      normals[i + 2] = 1.0F;  // every normal has length one
    }
  }
  return normals;
}

Floats difference(const Floats& a, const Floats& b) {
  Floats result(a.size());
  std::ranges::transform(a, b, result.begin(), std::minus<>{});
  return result;
}

/// Builds the JSON and binary chunks together.
class Builder {
 public:
  explicit Builder(const Motion& motion) : motion_(motion) {
    const std::size_t frames = motion.times.size();
    if (frames == 0) {
      throw Error(ErrorKind::empty_list, {.item = "motion"}, "there are no frames to write",
                  "record at least one step");
    }
    json_["asset"] = {{"version", "2.0"}, {"generator", fmt::format("sinew {}", version())}};
    json_["scene"] = 0;
    // -90 degrees about x: z up becomes y up.
    const double half = std::sqrt(0.5);
    json_["nodes"] = {{{"name", motion.name}, {"rotation", {-half, 0.0, 0.0, half}}}};
    json_["scenes"] = {{{"name", motion.name}, {"nodes", {0}}}};
    if (frames > 1) add_clock();
  }

  void add(const MovingSurface& surface) {
    check(surface.name, surface.frames);
    if (surface.triangles.empty()) return;
    const Floats normals = normals_of(surface.frames.front(), surface.triangles);
    Json primitive = {
        {"mode", kTriangles},
        {"attributes", {{"POSITION", positions(surface.frames.front())}}},
        {"indices", add_view(std::as_bytes(std::span(surface.triangles)), kElementBuffer,
                             surface.triangles.size(), "SCALAR", kUnsigned)}};
    primitive["attributes"]["NORMAL"] = vectors(normals);
    Json targets = Json::array();
    for (std::size_t k = 1; k < surface.frames.size(); ++k) {
      const Floats& frame = surface.frames[k];
      targets.push_back(
          {{"POSITION", positions(difference(frame, surface.frames.front()))},
           {"NORMAL", vectors(difference(normals_of(frame, surface.triangles), normals))}});
    }
    finish(surface.name, std::move(primitive), std::move(targets), surface.colour, 0.65);
  }

  void add(const MovingLine& line) {
    check(line.name, line.frames);
    if (line.frames.front().size() < 6) return;
    Json primitive = {{"mode", kLineStrip},
                      {"attributes", {{"POSITION", positions(line.frames.front())}}}};
    Json targets = Json::array();
    for (std::size_t k = 1; k < line.frames.size(); ++k) {
      targets.push_back({{"POSITION", positions(difference(line.frames[k], line.frames.front()))}});
    }
    finish(line.name, std::move(primitive), std::move(targets), line.colour, 1.0);
  }

  std::string file() {
    json_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t bytes = 12 + 8 + text.size() + 8 + binary_.size();
    if (bytes > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorKind::size_limit, {.item = "motion"},
                  fmt::format("{} bytes are more than a GLB file can hold", bytes),
                  "record fewer frames");
    }
    std::string result;
    result.reserve(bytes);
    const auto put = [&result](std::size_t number) {
      const auto word = static_cast<std::uint32_t>(number);
      for (unsigned k = 0; k < 32; k += 8) result += static_cast<char>((word >> k) & 0xffU);
    };
    put(kMagic);
    put(kVersion);
    put(bytes);
    put(text.size());
    put(kJsonChunk);
    result += text;
    put(binary_.size());
    put(kBinaryChunk);
    result += binary_;
    return result;
  }

 private:
  void check(const std::string& name, const std::vector<Floats>& frames) const {
    const bool equal = std::ranges::all_of(frames, [&](const Floats& frame) {
      return frame.size() == frames.front().size() && frame.size() % 3 == 0;
    });
    if (frames.size() == motion_.times.size() && equal) return;
    throw Error(ErrorKind::wrong_length, {.item = name},
                fmt::format("{} frames do not go with {} times, or differ in length", frames.size(),
                            motion_.times.size()),
                "give as many positions in each frame, and one frame for each time");
  }

  // Adds times, and the weights shared by all bodies: row k is 1 at target k - 1.
  void add_clock() {
    const std::size_t frames = motion_.times.size();
    clock_ = floats(motion_.times, 1, "SCALAR", 0, true);
    Floats weights(frames * (frames - 1), 0.0F);
    for (std::size_t k = 1; k < frames; ++k) weights[k * (frames - 1) + k - 1] = 1.0F;
    weights_ = floats(weights, 1, "SCALAR", 0, false);
    json_["animations"] = {
        {{"name", "motion"},
         {"samplers", {{{"input", clock_}, {"output", weights_}, {"interpolation", "LINEAR"}}}},
         {"channels", Json::array()}}};
  }

  int add_view(std::span<const std::byte> bytes, int target, std::size_t count, const char* type,
               int component) {
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    binary_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto index = static_cast<int>(json_["bufferViews"].size());
    json_["bufferViews"].push_back(std::move(view));
    const auto accessor = static_cast<int>(json_["accessors"].size());
    json_["accessors"].push_back(
        {{"bufferView", index}, {"componentType", component}, {"count", count}, {"type", type}});
    return accessor;
  }

  int floats(const Floats& values, std::size_t width, const char* type, int target, bool bounds) {
    const int accessor =
        add_view(std::as_bytes(std::span(values)), target, values.size() / width, type, kFloat);
    if (!bounds) return accessor;
    Json low = Json::array(), high = Json::array();
    for (std::size_t c = 0; c < width; ++c) {
      float least = values[c], most = values[c];
      for (std::size_t i = c; i < values.size(); i += width) {
        least = std::min(least, values[i]);
        most = std::max(most, values[i]);
      }
      low.push_back(least);
      high.push_back(most);
    }
    json_["accessors"].back()["min"] = std::move(low);
    json_["accessors"].back()["max"] = std::move(high);
    return accessor;
  }

  int positions(const Floats& values) { return floats(values, 3, "VEC3", kArrayBuffer, true); }
  int vectors(const Floats& values) { return floats(values, 3, "VEC3", kArrayBuffer, false); }

  void finish(const std::string& name, Json primitive, Json targets,
              const std::array<float, 3>& colour, double roughness) {
    primitive["material"] = json_["materials"].size();
    json_["materials"].push_back({{"name", name},
                                  {"doubleSided", true},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0}},
                                    {"metallicFactor", 0.0},
                                    {"roughnessFactor", roughness}}}});
    const std::size_t count = targets.size();
    if (count > 0) primitive["targets"] = std::move(targets);
    Json mesh = {{"name", name}, {"primitives", {std::move(primitive)}}};
    if (count > 0) mesh["weights"] = Floats(count, 0.0F);
    const std::size_t node = json_["nodes"].size();
    json_["nodes"].push_back({{"name", name}, {"mesh", json_["meshes"].size()}});
    json_["nodes"][0]["children"].push_back(node);
    json_["meshes"].push_back(std::move(mesh));
    if (count > 0) {
      json_["animations"][0]["channels"].push_back(
          {{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}});
    }
  }

  const Motion& motion_;
  Json json_;
  std::string binary_;
  int clock_ = 0, weights_ = 0;
};

}  // namespace

std::string write_glb(const Motion& motion) {
  Builder builder(motion);
  for (const MovingSurface& surface : motion.surfaces) builder.add(surface);
  for (const MovingLine& line : motion.lines) builder.add(line);
  return builder.file();
}

}  // namespace sinew::record
