/// @file
/// Spatial vectors and rotations for any number type. They are plain structs, so that number types
/// with derivatives cause no overhead.
#pragma once

#include <array>
#include <cstddef>

#include "sinew/core/types.hpp"

namespace sinew::pcc {

template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  Vec3() = default;
  Vec3(const T& x_, const T& y_, const T& z_) : x(x_), y(y_), z(z_) {}
  explicit Vec3(const Vector3& v) : x(v.x()), y(v.y()), z(v.z()) {}

  Vec3& operator+=(const Vec3& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  friend Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  template <typename S>
  friend Vec3 operator*(const S& s, const Vec3& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

template <typename T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Vector3 plain(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

/// A rotation matrix, stored as its columns.
template <typename T>
struct Rotation {
  Vec3<T> x, y, z;

  Vec3<T> operator*(const Vec3<T>& v) const { return v.x * x + v.y * y + v.z * z; }
  Rotation operator*(const Rotation& b) const { return {*this * b.x, *this * b.y, *this * b.z}; }
};

inline Matrix3 plain(const Rotation<double>& r) {
  Matrix3 result;
  result << plain(r.x), plain(r.y), plain(r.z);
  return result;
}

}  // namespace sinew::pcc
