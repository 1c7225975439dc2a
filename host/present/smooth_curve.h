// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Smooth curves through points that have times.
#pragma once

#include <cstddef>
#include <vector>

namespace caplet {

/// A curve of cubic Bézier pieces, one between two keys. Its velocity at a key is that of the
/// parabola through the key and its neighbours, so a line of keys at an even speed is kept; it is 0
/// at a key that equals one of them, so that a key given twice is a rest. On the sphere the
/// straight lines of de Casteljau's construction are arcs of great circles (Shoemake 1985,
/// "Animating rotation with quaternion curves").
class SmoothCurve {
 public:
  enum class Space { line, sphere };
  using Point = std::vector<double>;

  explicit SmoothCurve(Space space) : space_(space) {}

  /// Adds a key after all others. Points have one size; on the sphere they are unit vectors, and
  /// none is opposite to the one before.
  void add(double time, Point point);
  /// Returns the point at `time`; before the first key and after the last, that key's. There must
  /// be a key.
  Point at(double time) const;

 private:
  struct Key {
    double time;
    Point point;
  };

  Point towards(const Point& from, const Point& to) const;
  Point moved(const Point& from, const Point& by, double factor) const;
  Point between(const Point& a, const Point& b, double u) const;
  Point velocity(std::size_t key) const;

  Space space_;
  std::vector<Key> keys_;
};

}  // namespace caplet
