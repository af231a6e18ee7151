// Points, vectors and boxes, as distinct types: a point minus a point is a vector, and so on.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace motes {

template <class T, class Tag>
struct Tuple3 {
  T x{}, y{}, z{};

  constexpr Tuple3() = default;
  constexpr Tuple3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  /// Converts between precisions and, explicitly, between points, vectors and normals.
  template <class U, class OtherTag>
  explicit constexpr Tuple3(const Tuple3<U, OtherTag>& o)
      : x(static_cast<T>(o.x)), y(static_cast<T>(o.y)), z(static_cast<T>(o.z)) {}

  constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr bool operator==(const Tuple3&) const = default;
};

struct PointTag {};
struct VectorTag {};
struct NormalTag {};

template <class T>
using Point3 = Tuple3<T, PointTag>;
template <class T>
using Vector3 = Tuple3<T, VectorTag>;
template <class T>
using Normal3 = Tuple3<T, NormalTag>;
using Point3f = Point3<float>;
using Point3d = Point3<double>;
using Vector3f = Vector3<float>;
using Vector3d = Vector3<double>;
using Normal3f = Normal3<float>;

template <class T>
constexpr Vector3<T> operator-(const Point3<T>& a, const Point3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Point3<T> operator+(const Point3<T>& p, const Vector3<T>& v) {
  return {p.x + v.x, p.y + v.y, p.z + v.z};
}
template <class T>
constexpr Point3<T> operator-(const Point3<T>& p, const Vector3<T>& v) {
  return {p.x - v.x, p.y - v.y, p.z - v.z};
}
template <class T>
constexpr Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vector3<T> operator-(const Vector3<T>& v) {
  return {-v.x, -v.y, -v.z};
}
template <class T>
constexpr Vector3<T> operator*(T s, const Vector3<T>& v) {
  return {s * v.x, s * v.y, s * v.z};
}
template <class T>
constexpr Vector3<T> operator*(const Vector3<T>& v, T s) {
  return s * v;
}
template <class T>
constexpr Vector3<T> operator/(const Vector3<T>& v, T s) {
  return {v.x / s, v.y / s, v.z / s};
}
template <class T>
constexpr T dot(const Vector3<T>& a, const Vector3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(const Vector3<T>& v) {
  return std::hypot(v.x, v.y, v.z);
}
/// Precondition: v is not zero.
template <class T>
Vector3<T> normalize(const Vector3<T>& v) {
  return v / length(v);
}

/// Axis-aligned box, faces included; empty (min > max) until something is added.
template <class T>
struct Bounds3 {
  Point3<T> min{std::numeric_limits<T>::max(), std::numeric_limits<T>::max(),
                std::numeric_limits<T>::max()};
  Point3<T> max{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::lowest(),
                std::numeric_limits<T>::lowest()};

  constexpr bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  constexpr Vector3<T> diagonal() const { return max - min; }
  constexpr Point3<T> center() const { return min + T(0.5) * diagonal(); }

  constexpr void add(const Point3<T>& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  constexpr void add(const Bounds3& b) {
    min = {std::min(min.x, b.min.x), std::min(min.y, b.min.y), std::min(min.z, b.min.z)};
    max = {std::max(max.x, b.max.x), std::max(max.y, b.max.y), std::max(max.z, b.max.z)};
  }
  /// The box grown by `distance` on every side.
  constexpr Bounds3 extended(T distance) const {
    Bounds3 b = *this;
    const Vector3<T> d{distance, distance, distance};
    b.min = min - d;
    b.max = max + d;
    return b;
  }
  constexpr bool contains(const Point3<T>& p) const {
    return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z &&
           p.z <= max.z;
  }
  constexpr bool operator==(const Bounds3&) const = default;
};
using Bounds3f = Bounds3<float>;
using Bounds3d = Bounds3<double>;

}  // namespace motes
