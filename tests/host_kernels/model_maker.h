// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes of any shapes, materials and lights from a source of numbers: tame ones for a test, any at
// all for a fuzzer.
#pragma once

#include <cstdint>
#include <memory>

#include "scene/scene.h"

namespace caplet::test {

class NumberSource {
 public:
  virtual ~NumberSource() = default;
  virtual unsigned below(unsigned n) = 0;  // n > 0
  virtual double coordinate() = 0;
  virtual double length() = 0;    // meant to be positive
  virtual double fraction() = 0;  // meant to be from 0 to 1
};

/// What it makes need not pass validate(), but where the source is tame it mostly does.
class ModelMaker {
 public:
  explicit ModelMaker(NumberSource& numbers) : numbers_(numbers) {}

  /// Kinds of geometry: CapsulesShape counts twice, as capsules and tapered ones.
  static constexpr unsigned kinds = 13;
  static constexpr unsigned csg_kind = kinds - 1;
  /// In place of a kind: any but csg; any.
  static constexpr unsigned simple_kinds = kinds, any_kind = kinds + 1;
  static const char* kind_name(unsigned kind);

  /// `count` shapes of one kind or any, some of them in an object with instances; materials;
  /// lights.
  Scene scene(unsigned kind, unsigned count);
  Shape shape(unsigned kind);
  Material material();
  Light light();

 private:
  decltype(Shape::geometry) geometry(unsigned kind);
  template <class Mesh, std::size_t corners>
  void mesh(Mesh& out, std::vector<std::array<std::uint32_t, corners>>& faces);
  CsgShape csg(int depth);
  PolyhedronShape polyhedron();
  glm::dmat4 transform();
  Spectrum spectrum(double greatest);
  glm::dvec3 point();
  glm::vec3 small_point() { return glm::vec3(point()); }
  Cap cap() { return static_cast<Cap>(numbers_.below(3)); }
  NumberSource& numbers_;
  unsigned materials_ = 1;
};

}  // namespace caplet::test
