// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "reference/from_scene.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace caplet::reference {

namespace {

using glm::dvec3;

Spool::End end_of(double radius, Cap cap) { return {radius, cap == Cap::round, cap == Cap::open}; }

struct PrimitivesOf {
  std::vector<Primitive> operator()(const SphereShape& s) const { return {Sphere{dvec3(0), s.radius}}; }
  std::vector<Primitive> operator()(const DiskShape& d) const {
    if (d.is_whole()) return {Disk{dvec3(0, 0, d.height), dvec3(0, 0, 1), d.radius}};
    return {PartialDisk{d.height, d.radius, d.inner_radius, d.phi_max}};
  }
  std::vector<Primitive> operator()(const CapsulesShape& capsules) const {
    std::vector<Primitive> out;
    for (std::size_t i = 0; i < capsules.p0.size(); ++i) {
      const double radius0 = capsules.radius0[i];
      const double radius1 = capsules.radius1.empty() ? radius0 : static_cast<double>(capsules.radius1[i]);
      out.push_back(Capsule{dvec3(capsules.p0[i]), dvec3(capsules.p1[i]), radius0, radius1});
    }
    return out;
  }
  std::vector<Primitive> operator()(const TriangleMeshShape& mesh) const {
    std::vector<Primitive> out;
    for (const auto& t : mesh.triangles)
      out.push_back(Triangle{dvec3(mesh.positions[t[0]]), dvec3(mesh.positions[t[1]]), dvec3(mesh.positions[t[2]])});
    return out;
  }
  std::vector<Primitive> operator()(const BilinearMeshShape& mesh) const {
    std::vector<Primitive> out;
    for (const auto& p : mesh.patches)
      out.push_back(Bilinear{dvec3(mesh.positions[p[0]]), dvec3(mesh.positions[p[1]]), dvec3(mesh.positions[p[2]]),
                             dvec3(mesh.positions[p[3]])});
    return out;
  }
  std::vector<Primitive> operator()(const CylinderShape& c) const {
    return {make_spool(c.p0, c.p1, end_of(c.radius, c.caps[0]), end_of(c.radius, c.caps[1]))};
  }
  std::vector<Primitive> operator()(const ConeShape& c) const {
    return {make_spool(c.p0, c.p1, end_of(c.radius[0], c.caps[0]), end_of(c.radius[1], c.caps[1]))};
  }
  std::vector<Primitive> operator()(const BoxShape& b) const { return {Box{glm::min(b.p0, b.p1), glm::max(b.p0, b.p1)}}; }
  std::vector<Primitive> operator()(const PolyhedronShape& p) const {
    dvec3 center{0};
    for (const dvec3& point : p.points) center += point / double(p.points.size());
    std::vector<double> offsets;
    for (std::size_t i = 0; i < p.points.size(); ++i) offsets.push_back(glm::dot(p.normals[i], p.points[i] - center));
    return {make_polyhedron(center, p.normals, offsets)};
  }
  std::vector<Primitive> operator()(const PartialSphereShape& s) const {
    return {PartialSphere{s.radius, s.z_min, s.z_max, s.phi_max}};
  }
  std::vector<Primitive> operator()(const OpenCylinderShape& c) const {
    return {OpenCylinder{c.radius, c.z_min, c.z_max, c.phi_max}};
  }
  std::vector<Primitive> operator()(const CsgShape& csg) const {
    std::vector<CsgPart> parts;
    for (const auto& operand : csg.operands) parts.push_back({primitives_of(*operand).at(0), operand->world_from_object});
    const auto operation = csg.operation == CsgShape::Operation::set_union          ? Csg::Operation::set_union
                           : csg.operation == CsgShape::Operation::set_intersection ? Csg::Operation::set_intersection
                                                                                    : Csg::Operation::set_difference;
    return {make_csg(operation, parts)};
  }
};

}  // namespace

std::vector<Primitive> primitives_of(const Shape& shape) { return std::visit(PrimitivesOf{}, shape.geometry); }

}  // namespace caplet::reference
