/// @file
/// Motion of surfaces and lines as binary glTF 2.0, for Blender, PowerPoint, web pages.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace sinew::record {

/// Triangles whose vertices move.
struct MovingSurface {
  std::string name;
  std::vector<std::uint32_t> triangles;    ///< (3 t,) vertices, outward by the right-hand rule
  std::vector<std::vector<float>> frames;  ///< (frames, 3 v) m, one for each of Motion::times
  std::array<float, 3> colour{0.70F, 0.36F, 0.13F};  ///< linear red, green, blue, 0 .. 1
};

/// A polyline whose points move, such as a cable.
struct MovingLine {
  std::string name;
  std::vector<std::vector<float>> frames;  ///< (frames, 3 p) m
  std::array<float, 3> colour{0.0F, 0.17F, 0.45F};
};

struct Motion {
  std::string name;
  std::vector<float> times;  ///< (frames,) s, increasing
  std::vector<MovingSurface> surfaces;
  std::vector<MovingLine> lines;
};

/// One GLB file: the first frame is the shape, every further one a morph target whose weight is 1
/// at its time and falls linearly to 0 at its neighbours', so that positions in between are linear
/// in time (Khronos, glTF 2.0 specification, sections 3.7.2.2 and 3.11). Normals move along. glTF's
/// y points up: a root node turns our z to it.
///
/// @param motion with at least one frame; bodies without triangles and lines of fewer than two
///   points are left out.
/// Throws Error: empty-list (no frames), wrong-length (a frame of another length),
/// size-limit (4 GiB).
std::string write_glb(const Motion& motion);

}  // namespace sinew::record
