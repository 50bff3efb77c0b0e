/// @file
/// Writes moving surfaces and lines as binary glTF 2.0, for Blender, PowerPoint and web pages.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sinew::record {

/// A triangle mesh with moving vertices.
struct MovingSurface {
  std::string name;
  std::vector<std::uint32_t> triangles;    ///< (3 t,) vertices, counter-clockwise seen from outside
  std::vector<std::vector<float>> frames;  ///< (frames, 3 v) m, at Motion::times
  std::array<float, 3> colour{0.70F, 0.36F, 0.13F};  ///< linear red, green, blue, 0 .. 1
};

/// A polyline with moving points, such as a cable.
struct MovingLine {
  std::string name;
  std::vector<std::vector<float>> frames;  ///< (frames, 3 p) m
  std::array<float, 3> colour{0.0F, 0.17F, 0.45F};
};

/// An animation of surfaces and lines.
struct Motion {
  std::string name;
  std::vector<float> times;  ///< (frames,) s, increasing
  std::vector<MovingSurface> surfaces;
  std::vector<MovingLine> lines;
};

/// Writes a motion as the content of a GLB file. The first frame is the base mesh, and each further
/// frame is a morph target. Its weight is 1 at its own time and falls linearly to 0 at the times of
/// its neighbours, so positions are interpolated linearly in time (Khronos, glTF 2.0 specification,
/// sections 3.7.2.2 and 3.11). Normals are morphed likewise. A root node rotates z, which points up
/// in Sinew, to glTF's y.
///
/// Throws Error: empty-list (no frames), wrong-length (a frame of another length),
/// size-limit (4 GiB).
/// @param motion with at least one frame; surfaces without triangles and lines of fewer than two
/// points are omitted.
std::string write_glb(const Motion& motion);

}  // namespace sinew::record
