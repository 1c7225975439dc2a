// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The probe's kernels and their host side.
#include "probe.h"
#include "floats.h"

#include <bit>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <stdexcept>

#include "faced.h"
#include "lower/geometry_pages.h"
#include "lower/packed_nodes.h"
#include "shared/kinds.h"
#include "support/scene_buffers.h"

namespace caplet::test {

namespace {

const char* const kernel_text = R"(
#include "trace/list.cl"
#include "shapes/surface.cl"

typedef struct {
  float p[3], error, ng[3], u, ns[3], v, dpdu[3], pad2, dpdv[3], pad3;
  uint geometry, primitive, surface, light, leaving, any, pad0, pad1;
} SurfaceOut;

__attribute__((vec_type_hint(float8))) __kernel void probe_trace(__global const float* nodes, __global const float* leaves, __global const InstanceRecord* instances,
                          __global const GeometryRecord* geometries, __global const uint* primitive_geometry,
                          __global const uint* mesh_indices, __global const float* mesh_uvs, __global const uint* roots,
                          __global const RayRecord* rays, __global HitRecord* hits, __global SurfaceOut* surfaces, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const Tree tree = {0, nodes, leaves, instances};
  const Surfaces scene = {geometries, primitive_geometry, 0, mesh_indices, mesh_uvs, mesh_uvs};
  const RayRecord ray = rays[i];
  const HitRecord hit = trace_ray(&tree, roots[i], ray, 0.0f);
  hits[i] = hit;
  surfaces[i].any = trace_ray(&tree, roots[i], ray, INFINITY).slot != CAPLET_NONE;
  if (hit.slot == CAPLET_NONE) return;
  const Surface s = surface_at(&tree, &scene, &ray, &hit);
  vstore3(s.p, 0, surfaces[i].p);
  vstore3(s.ng, 0, surfaces[i].ng);
  vstore3(s.ns, 0, surfaces[i].ns);
  vstore3(s.dpdu, 0, surfaces[i].dpdu);
  vstore3(s.dpdv, 0, surfaces[i].dpdv);
  surfaces[i].error = s.error;
  surfaces[i].u = s.uv.x;
  surfaces[i].v = s.uv.y;
  surfaces[i].geometry = s.geometry;
  surfaces[i].primitive = s.primitive;
  surfaces[i].surface = s.surface;
  surfaces[i].light = s.light;
  surfaces[i].leaving = (uint)s.leaving;
}

__attribute__((vec_type_hint(float8))) __kernel void probe_list(__global const float* nodes, __global const float* leaves, __global const InstanceRecord* instances,
                         __global const uint* roots, __global const RayRecord* rays, __global HitRecord* hits, __global int* any,
                         __global uint* counts, __global HitRecord* sorted, uint capacity, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const Tree tree = {0, nodes, leaves, instances};
  const RayRecord ray = rays[i];
  hits[i] = trace_ray(&tree, roots[i], ray, 0.0f);
  any[i] = trace_ray(&tree, roots[i], ray, INFINITY).slot != CAPLET_NONE;
  counts[i] = trace_list(&tree, roots[i], ray, capacity, sorted + (size_t)i * capacity);
}

__attribute__((vec_type_hint(float8))) __kernel void probe_leave(__global const float* nodes, __global const float* leaves, __global const InstanceRecord* instances,
                          __global const uint* roots, __global const SurfaceOut* surfaces, __global const float* directions,
                          __global float* origins, __global HitRecord* hits, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const float3 d = vload3(i, directions);
  const float3 o = offset_origin(vload3(0, surfaces[i].p), vload3(0, surfaces[i].ng), surfaces[i].error, d);
  vstore3(o, i, origins);
  RayRecord ray;
  ray.ox = o.x;
  ray.oy = o.y;
  ray.oz = o.z;
  ray.t_min = 0.0f;
  ray.dx = d.x;
  ray.dy = d.y;
  ray.dz = d.z;
  ray.t_max = INFINITY;
  const Tree tree = {0, nodes, leaves, instances};
  hits[i] = trace_ray(&tree, roots[i], ray, 0.0f);
}
)";

constexpr std::size_t local_size = 16;

std::vector<PlacedPrimitive> unplaced(const std::vector<FlatPrimitive>& primitives) {
  std::vector<PlacedPrimitive> out;
  for (const FlatPrimitive& p : primitives) out.push_back({p, false, {}, {}});
  return out;
}

// Made once: PoCL takes a second.
const Program& program_of(const Device& device, int width) {
  static std::map<std::pair<cl_context, int>, Program> programs;
  auto found = programs.find({device.context()(), width});
  if (found == programs.end()) {
    const std::string options = "-DCAPLET_REAL_WIDTH=" + std::to_string(width);
    const std::string source = flatten_kernels(kernel_text);
    found = programs
                .emplace(std::pair{device.context()(), width},
                         Program::from_source(device, "shape probe", source, options))
                .first;
  }
  return found->second;
}

FlatPrimitive make(int shape, std::initializer_list<float> values) {
  FlatPrimitive p{static_cast<std::uint32_t>(shape), 0, {}};
  std::copy(values.begin(), values.end(), p.data);
  return p;
}

// The patch of these floats (shapes.def).
reference::MolecularPatch patch_of(const FlatPrimitive& p, const std::vector<float>& leaves) {
  const float* data = &leaves.at(molecular_patch_begin(p.data));
  reference::MolecularPatch out;
  out.center = point(data);
  out.minor = double(data[3]);
  out.ball_center = point(p.data);
  out.ball_radius = double(p.data[3]);
  if (const auto count = std::bit_cast<std::uint32_t>(data[4]); count != CAPLET_NONE) {
    out.of_probe = data[5] != 0;
    for (std::uint32_t i = 0; i < count; ++i)
      out.planes.push_back({point(data + 8 + 4 * i), double(data[8 + 4 * i + 3])});
    return out;
  }
  out.major = double(data[5]);
  out.axis = glm::normalize(point(data + 8));
  out.phi_max = double(data[11]);
  out.start = point(data + 12);
  out.start = glm::normalize(out.start - glm::dot(out.start, out.axis) * out.axis);
  out.theta_min = double(std::min(data[20], data[21]));
  out.theta_max = double(std::max(data[20], data[21]));
  return out;
}

}  // namespace

reference::Primitive reference_of(const FlatPrimitive& p, const std::vector<float>& leaves) {
  const float* d = p.data;
  const auto end = [](float radius, float cap) {
    return reference::Frustum::End{radius, cap == CAPLET_CAP_ROUND, cap == CAPLET_CAP_OPEN};
  };
  switch (p.shape) {
    case shape_sphere:
      return reference::Sphere{point(d), d[3]};
    case shape_capsule:
      return reference::Capsule{point(d), point(d + 3), d[6], d[6]};
    case shape_tapered_capsule:
      return reference::Capsule{point(d), point(d + 3), d[6], d[7]};
    case shape_triangle:
      return reference::Triangle{point(d), point(d + 3), point(d + 6)};
    case shape_disk:
      return reference::Disk{point(d), point(d + 3), d[6]};
    case shape_cylinder:
      return reference::make_frustum(point(d), point(d + 3), end(d[6], d[7]), end(d[6], d[8]));
    case shape_cone:
      return reference::make_frustum(point(d), point(d + 3), end(d[6], d[8]), end(d[7], d[9]));
    case shape_polyhedron: {
      const std::size_t begin = std::bit_cast<std::uint32_t>(d[0]),
                        count = std::bit_cast<std::uint32_t>(leaves.at(begin + 3));
      std::vector<glm::dvec3> normals;
      std::vector<double> offsets;
      for (std::size_t i = 0; i < count; ++i) {
        normals.push_back(point(&leaves.at(begin + 8 + 4 * i)));
        offsets.push_back(leaves.at(begin + 8 + 4 * i + 3));
      }
      return reference::make_polyhedron(point(&leaves.at(begin)), normals, offsets);
    }
    case shape_partial_sphere:
      return reference::PartialSphere{d[0], d[1], d[2], d[3]};
    case shape_open_cylinder:
      return reference::OpenCylinder{d[0], d[1], d[2], d[3]};
    case shape_partial_disk:
      return reference::PartialDisk{d[0], d[1], d[2], d[3]};
    case shape_bilinear:
      return reference::Bilinear{point(d), point(d + 3), point(d + 6), point(d + 9)};
    case shape_molecular_patch:
      return patch_of(p, leaves);
    default: {
      reference::Primitive out;
      if (!for_faced(p.shape,
                     [&]<class Type>(std::type_identity<Type>) { out = faced_reference<Type>(d); }))
        throw std::logic_error("no reference of this shape from its data");
      return out;
    }
  }
}

int length_count(const FlatPrimitive& p) {
  switch (p.shape) {
    case shape_sphere:
    case shape_molecular_patch:  // and what lies in `leaves`
      return 4;
    case shape_capsule:
    case shape_cylinder:
    case shape_disk:  // and a normal in the middle
      return 7;
    case shape_tapered_capsule:
    case shape_cone:
      return 8;
    case shape_triangle:
      return 9;
    case shape_partial_sphere:
    case shape_open_cylinder:
    case shape_partial_disk:
      return 3;
    case shape_bilinear:
      return 12;
    case shape_polyhedron:
    case shape_csg:
      return 0;
    default: {
      int out = 0;
      if (!for_faced(p.shape,
                     [&]<class Type>(std::type_identity<Type>) { out = count_fields<Type>().all; }))
        throw std::logic_error("no count of lengths for this shape");
      return out;
    }
  }
}

int coordinate_count(const FlatPrimitive& p) {
  switch (p.shape) {
    case shape_sphere:
    case shape_disk:
      return 3;
    case shape_triangle:
      return 9;
    case shape_bilinear:
      return 12;
    case shape_capsule:
    case shape_tapered_capsule:
    case shape_cylinder:
    case shape_cone:
      return 6;
    case shape_polyhedron:
    case shape_partial_sphere:
    case shape_open_cylinder:
    case shape_partial_disk:
    case shape_csg:
    case shape_molecular_patch:
      return 0;
    default: {
      int out = 0;
      if (!for_faced(p.shape, [&]<class Type>(std::type_identity<Type>) {
            out = count_fields<Type>().coordinates;
          }))
        throw std::logic_error("no count of coordinates for this shape");
      return out;
    }
  }
}

FlatPrimitive make_sphere(std::array<float, 3> c, float r) {
  return make(shape_sphere, {c[0], c[1], c[2], r});
}
FlatPrimitive make_capsule(std::array<float, 3> p0, std::array<float, 3> p1, float r) {
  return make(shape_capsule, {p0[0], p0[1], p0[2], p1[0], p1[1], p1[2], r});
}
FlatPrimitive make_tapered(std::array<float, 3> p0, std::array<float, 3> p1, float r0, float r1) {
  return make(shape_tapered_capsule, {p0[0], p0[1], p0[2], p1[0], p1[1], p1[2], r0, r1});
}
FlatPrimitive make_triangle(std::array<float, 3> v0, std::array<float, 3> v1,
                            std::array<float, 3> v2) {
  return make(shape_triangle, {v0[0], v0[1], v0[2], v1[0], v1[1], v1[2], v2[0], v2[1], v2[2]});
}
FlatPrimitive make_disk(std::array<float, 3> c, std::array<float, 3> n, float r) {
  return make(shape_disk, {c[0], c[1], c[2], n[0], n[1], n[2], r});
}

FlatPrimitive make_cylinder(std::array<float, 3> p0, std::array<float, 3> p1, float r, float cap0,
                            float cap1) {
  return make(shape_cylinder, {p0[0], p0[1], p0[2], p1[0], p1[1], p1[2], r, cap0, cap1});
}
FlatPrimitive make_cone(std::array<float, 3> p0, std::array<float, 3> p1, float r0, float r1,
                        float cap0, float cap1) {
  return make(shape_cone, {p0[0], p0[1], p0[2], p1[0], p1[1], p1[2], r0, r1, cap0, cap1});
}
FlatPrimitive make_box(std::array<float, 3> min, std::array<float, 3> max) {
  return make(shape_box, {min[0], min[1], min[2], max[0], max[1], max[2]});
}
FlatPrimitive make_partial_sphere(float r, float z_min, float z_max, float phi_max) {
  return make(shape_partial_sphere, {r, z_min, z_max, phi_max});
}
FlatPrimitive make_open_cylinder(float r, float z_min, float z_max, float phi_max) {
  return make(shape_open_cylinder, {r, z_min, z_max, phi_max});
}
FlatPrimitive make_partial_disk(float height, float r, float inner, float phi_max) {
  return make(shape_partial_disk, {height, r, inner, phi_max});
}
FlatPrimitive make_bilinear(std::array<float, 3> p00, std::array<float, 3> p10,
                            std::array<float, 3> p01, std::array<float, 3> p11) {
  return make(shape_bilinear, {p00[0], p00[1], p00[2], p10[0], p10[1], p10[2], p01[0], p01[1],
                               p01[2], p11[0], p11[1], p11[2]});
}

Probe::Probe(const Device& device, int width, const std::vector<FlatPrimitive>& primitives,
             const std::vector<float>& leaves)
    : Probe(device, width, unplaced(primitives), leaves) {}

Probe::Probe(const Device& device, int width, const std::vector<PlacedPrimitive>& primitives,
             const std::vector<float>& leaves)
    : device_(device), width_(width), leaves_(leaves) {
  const Program& program = program_of(device, width);
  trace_ = program.kernel("probe_trace");
  leave_ = program.kernel("probe_leave");
  list_ = program.kernel("probe_list");
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const PlacedPrimitive& placed = primitives[i];
    FlatPrimitive p = placed.primitive;
    p.id = i;
    GeometryRecord geometry{};
    geometry.shape = p.shape;
    geometry.primitive_begin = i;
    geometry.light_offset = placed.placed ? 3 : i % 2 == 0 ? CAPLET_NONE : i;
    geometry.index_begin = 4 * i;
    geometry.normal_begin = geometry.uv_begin = geometry.surface_begin = geometry.uv_space =
        CAPLET_NONE;
    geometries_.push_back(geometry);
    primitive_geometry_.push_back(i);
    for (std::uint32_t k = 0; k < 4; ++k) mesh_indices_.push_back(4 * i + k);
    trees_.push_back(encode_tree(std::span(&p, 1), nodes_, leaves_));
    if (placed.placed) {
      InstanceRecord instance{};
      std::copy(placed.object_from_world.begin(), placed.object_from_world.end(),
                instance.object_from_world);
      std::copy(placed.world_from_object.begin(), placed.world_from_object.end(),
                instance.world_from_object);
      instance.root = trees_.back().root;
      instance.light_base = i % 2 == 0 ? CAPLET_NONE : 100 + i;
      instances_.push_back(instance);
      // A box that holds everything: what is tested is the primitive.
      constexpr float far = 1e30f;
      const FlatPrimitive top{shape_instance,
                              static_cast<std::uint32_t>(instances_.size() - 1),
                              {-far, -far, -far, far, far, far}};
      trees_.back() = encode_tree(std::span(&top, 1), nodes_, leaves_);
    }
    roots_.push_back(trees_.back().root);
  }
}

std::vector<Probed> Probe::trace(const std::vector<std::uint32_t>& which,
                                 const std::vector<RayRecord>& rays) const {
  std::vector<std::uint32_t> roots;
  for (const std::uint32_t i : which) roots.push_back(roots_[i]);
  std::vector<GeometryRecord> geometries = geometries_;
  for (GeometryRecord& geometry : geometries) geometry.flags = flags;
  if (!mesh_uvs.empty())
    for (GeometryRecord& geometry : geometries) geometry.uv_begin = 0;
  const auto nodes = upload(device_, width_ == 1 ? packed_nodes(nodes_) : nodes_),
             leaves = upload(device_, leaves_), uvs = upload(device_, mesh_uvs);
  const auto instances = upload(device_, instances_);
  const auto geometry_buffer = upload(device_, geometries);
  const auto primitive_geometry = upload(device_, geometry_pages(primitive_geometry_)),
             indices = upload(device_, mesh_indices_), root_buffer = upload(device_, roots);
  const auto ray_buffer = upload(device_, rays);
  const Buffer<HitRecord> hits(device_, rays.size());
  const Buffer<SurfaceOut> surfaces(device_, rays.size());
  cl::Kernel kernel = trace_;
  set_arguments(device_, kernel, nodes, leaves, instances, geometry_buffer, primitive_geometry,
                indices, uvs, root_buffer, ray_buffer, hits, surfaces,
                static_cast<cl_uint>(rays.size()));
  launch(device_, kernel, rays.size(), local_size);
  const std::vector<HitRecord> hit_records = hits.read();
  const std::vector<SurfaceOut> surface_records = surfaces.read();
  std::vector<Probed> out;
  for (std::size_t i = 0; i < rays.size(); ++i)
    out.push_back({hit_records[i], surface_records[i], surface_records[i].any != 0});
  return out;
}

std::vector<Listed> Probe::list(const std::vector<std::uint32_t>& which,
                                const std::vector<RayRecord>& rays, std::uint32_t capacity) const {
  std::vector<std::uint32_t> roots;
  for (const std::uint32_t i : which) roots.push_back(roots_[i]);
  const auto nodes = upload(device_, width_ == 1 ? packed_nodes(nodes_) : nodes_),
             leaves = upload(device_, leaves_);
  const auto instances = upload(device_, instances_);
  const auto root_buffer = upload(device_, roots);
  const auto ray_buffer = upload(device_, rays);
  const Buffer<HitRecord> hits(device_, rays.size()), sorted(device_, rays.size() * capacity);
  const Buffer<int> any(device_, rays.size());
  const Buffer<std::uint32_t> counts(device_, rays.size());
  cl::Kernel kernel = list_;
  set_arguments(device_, kernel, nodes, leaves, instances, root_buffer, ray_buffer, hits, any,
                counts, sorted, static_cast<cl_uint>(capacity), static_cast<cl_uint>(rays.size()));
  launch(device_, kernel, rays.size(), local_size);
  const std::vector<HitRecord> nearest = hits.read(), all = sorted.read();
  const std::vector<int> any_values = any.read();
  const std::vector<std::uint32_t> count_values = counts.read();
  std::vector<Listed> out(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * capacity);
    out[i] = {nearest[i],
              any_values[i] != 0,
              count_values[i],
              {first, first + std::min(count_values[i], capacity)}};
  }
  return out;
}

std::vector<Left> Probe::leave(const std::vector<std::uint32_t>& which,
                               const std::vector<Probed>& from,
                               const std::vector<std::array<float, 3>>& directions) const {
  std::vector<std::uint32_t> roots;
  for (const std::uint32_t i : which) roots.push_back(roots_[i]);
  std::vector<SurfaceOut> surfaces;
  for (const Probed& probed : from) surfaces.push_back(probed.surface);
  std::vector<float> flat;
  for (const auto& d : directions) flat.insert(flat.end(), d.begin(), d.end());
  const auto nodes = upload(device_, width_ == 1 ? packed_nodes(nodes_) : nodes_),
             leaves = upload(device_, leaves_), direction_buffer = upload(device_, flat);
  const auto instances = upload(device_, instances_);
  const auto root_buffer = upload(device_, roots);
  const auto surface_buffer = upload(device_, surfaces);
  const Buffer<float> origins(device_, 3 * from.size());
  const Buffer<HitRecord> hits(device_, from.size());
  cl::Kernel kernel = leave_;
  set_arguments(device_, kernel, nodes, leaves, instances, root_buffer, surface_buffer,
                direction_buffer, origins, hits, static_cast<cl_uint>(from.size()));
  launch(device_, kernel, from.size(), local_size);
  const std::vector<float> origin_values = origins.read();
  const std::vector<HitRecord> hit_records = hits.read();
  std::vector<Left> out;
  for (std::size_t i = 0; i < from.size(); ++i)
    out.push_back({{origin_values[3 * i], origin_values[3 * i + 1], origin_values[3 * i + 2]},
                   hit_records[i]});
  return out;
}

reference::Ray reference_ray(const RayRecord& r) {
  return {{r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, r.t_min, r.t_max};
}

}  // namespace caplet::test
