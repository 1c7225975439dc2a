// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <span>

#include "base/check.h"
#include "lower/all_rows.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/interval_trees.h"
#include "lower/detail/shapes.h"
#include "lower/detail/textures.h"
#include "lower/geometry_pages.h"
#include "scene/matte_names.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;
using glm::dvec3;

std::vector<std::array<std::uint32_t, 3>>& faces_of(TriangleMeshShape& mesh) {
  return mesh.triangles;
}
std::vector<std::array<std::uint32_t, 4>>& faces_of(BilinearMeshShape& mesh) {
  return mesh.patches;
}

/// Reserves room for `count` more; at least doubles what it allocates, so that many small additions
/// move each element a bounded number of times.
template <class T>
void reserve_more(std::vector<T>& values, std::size_t count) {
  if (values.capacity() - values.size() < count)
    values.reserve(std::max(values.size() + count, 2 * values.capacity()));
}

/// Returns the same mesh, with each corner of each face a vertex of its own, and with the uvs of a
/// mesh without any. A face that is turned over keeps them.
template <class Mesh>
Mesh with_uvs(Mesh mesh) {
  Mesh out;
  const std::size_t count = vertex_count(mesh);
  for (std::size_t key = 0; key < mesh.positions.size() / count; ++key)
    for (const auto& face : faces_of(mesh))
      for (const std::uint32_t vertex : face) {
        out.positions.push_back(mesh.positions[key * count + vertex]);
        out.normals.push_back(mesh.normals[key * count + vertex]);
      }
  for (auto& face : faces_of(mesh)) {
    // The uvs are (0 0) (1 0) (1 1), or (0 0) (1 0) (0 1) (1 1).
    for (std::size_t k = 0; k < face.size(); ++k) {
      face[k] = narrow<std::uint32_t>(out.uvs.size());
      out.uvs.emplace_back(k % 2 == 1 || k + 1 == face.size(), k >= 2);
    }
  }
  faces_of(out) = std::move(faces_of(mesh));
  if constexpr (requires { out.times; }) out.times = std::move(mesh.times);
  return out;
}

/// A mirroring transform turns normals that follow the winding, but not those of disks and solids.
bool turns_normals(const Shape& shape, const Matrix& m) {
  const bool wound = std::holds_alternative<TriangleMeshShape>(shape.geometry) ||
                     std::holds_alternative<BilinearMeshShape>(shape.geometry);
  return shape.reverse_orientation != (wound && glm::determinant(glm::dmat3(m)) < 0);
}

/// Returns InstanceRecord.flags that hide the unseen sides of a one-sided shape. Open shapes are
/// seen from where their normal points.
uint unseen_sides(const Shape& shape, const Matrix& m) {
  if (!shape.one_sided) return 0;
  return !is_closed(shape) && turns_normals(shape, m) ? CAPLET_INSTANCE_NO_ENTERING
                                                      : CAPLET_INSTANCE_NO_LEAVING;
}

class GeometryLowering {
 public:
  GeometryLowering(const Scene& scene, const ImageNumbers& images, SpectrumTable& spectra,
                   const Linking& linking, FlatScene& out)
      : scene_(scene), images_(images), spectra_(spectra), linking_(linking), out_(out) {
    std::size_t capsules = 0;
    const auto add = [&](const Shape& shape) {
      if (const auto* own = std::get_if<CapsulesShape>(&shape.geometry)) capsules += count_of(*own);
    };
    for (const Shape& shape : scene_.shapes) add(shape);
    for (const Object& object : scene_.objects)
      for (const Shape& shape : object.shapes) add(shape);
    links_ = capsules >= linking_.least_capsules;
  }

  LoweredGeometry run() {
    check_counts();
    LoweredGeometry lowered;
    placed_ = &lowered.placed;
    lowered.world = lower_shapes(scene_.shapes, 0, nullptr);
    const auto object_number = narrow<std::uint32_t>(scene_.shapes.size());
    for (const Object& object : scene_.objects)
      lowered.objects.push_back(lower_shapes(object.shapes, object_number, &object));

    find_shapes(lowered);
    out_.primitive_geometry = geometry_pages(geometry_of_);
    geometry_of_ = {};
    std::deque<Subtree>& world = lowered.world.subtrees;
    Subtree& top = world[0];
    for (std::size_t i = 1; i < world.size(); ++i) {
      encode(world[i]);
      place(world[i], world[i].placed, nullptr, CAPLET_NONE, top, lowered.placed);
    }
    for (LoweredShapes& object : lowered.objects)
      for (Subtree& subtree : object.subtrees)
        if (subtree.size() > 0) encode(subtree);
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      for (const Subtree& subtree : lowered.objects[instance.object].subtrees)
        if (subtree.size() > 0)
          place(subtree, instance.world_from_object * subtree.placed, &instance,
                narrow<std::uint32_t>(i), top, lowered.placed);
    }
    encode(top);
    // World-space emitters come first: their light_offset is absolute.
    add_emitters(top, CAPLET_NONE, Matrix(1), nullptr, lowered.emitters);
    for (const PlacedSubtree& placed : lowered.placed) {
      if (placed.subtree->emitter_count == 0) continue;
      out_.instances[placed.instance].light_base = narrow<uint>(lowered.emitters.size());
      add_emitters(*placed.subtree, placed.instance, placed.world_from_subtree,
                   placed.motion ? &*placed.motion : nullptr, lowered.emitters);
    }
    out_.world.root = top.tree.root;
    out_.world.intervals = top.tree.intervals;
    out_.world.roots = top.tree.roots_begin;
    set_world_bounds(top.tree, out_.world);
    out_.primitive_count = 0;
    for (const auto& [kind, count] : count_primitives(scene_)) out_.primitive_count += count;
    out_.bvh_depth = std::max(out_.bvh_depth, top.tree.depth);
    out_.bvh_sah = top.tree.sah;
    return lowered;
  }

  /// `object_name`: GeometryRecord.object_name.
  void lower_shape(const Shape& shape, const Matrix& m, std::uint32_t object, uint object_name,
                   Subtree& subtree) {
    const std::size_t first = subtree.primitives.size();
    const auto primitive_begin = narrow<uint>(geometry_of_.size());
    GeometryRecord record{};
    record.material = shape.material;
    record.object = object;
    record.object_name = object_name;
    record.asset_name = asset_name(shape);
    record.primitive_begin = primitive_begin;
    record.surface_begin = add_surfaces(shape);
    record.light_offset = CAPLET_NONE;
    record.alpha = alpha_of(shape);
    record.normal_begin = record.uv_begin = CAPLET_NONE;
    record.uv_space = append_uv_space(shape.geometry, m, out_.leaves);
    if (shape.emission) {
      record.light_offset = narrow<uint>(subtree.emitter_count);
      if (shape.emission->two_sided) record.flags |= CAPLET_GEOMETRY_EMIT_BOTH_SIDES;
    }
    if (turns_normals(shape, m)) record.flags |= CAPLET_GEOMETRY_FLIP_NORMAL;
    if (!is_watertight(shape)) record.flags |= CAPLET_GEOMETRY_OPEN;
    reversed_ = shape.reverse_orientation;
    may_link_ = links_ && !shape.emission && (!linking_.allows || linking_.allows(shape));
    may_be_loose_ = !shape.emission && !linking_.keeps_primitives;
    std::visit([&](const auto& geometry) { append(geometry, m, record, subtree); }, shape.geometry);
    const std::size_t count = subtree.primitives.size() - first;
    if (shape.emission && count > 0) {
      subtree.emissive.push_back({first, count, &shape, subtree.emitter_count});
      subtree.emitter_count += count;
    }
    subtree.shapes.push_back(&shape);
  }

 private:
  /// Checks counts before memory is taken: only capsules and meshes can have too many primitives.
  void check_counts() const {
    std::array<std::uint64_t, shape_count> counts{};
    const auto add = [&](const Shape& shape) {
      if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
        counts[shape_sphere] += count_of(*capsules);
      if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
        counts[shape_triangle] += mesh->triangles.size();
      if (const auto* mesh = std::get_if<BilinearMeshShape>(&shape.geometry))
        counts[shape_bilinear] += mesh->patches.size();
      if (const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry))
        counts[shape_molecular_patch] += count_of(*molecule);
    };
    for (const Shape& shape : scene_.shapes) add(shape);
    for (const Object& object : scene_.objects)
      for (const Shape& shape : object.shapes) add(shape);
    check_tree_limits(least_rows(counts), 0, leaf_kind_bits(0));
  }

  /// Sets FlatScene::shapes, has_chains and has_moving_operands: every kind that is to be encoded,
  /// and those within csg shapes.
  void find_shapes(const LoweredGeometry& lowered) {
    out_.shapes = 0;
    out_.has_moving_operands = false;
    out_.has_chains = std::ranges::any_of(out_.geometries, [](const GeometryRecord& one) {
      return (one.flags & CAPLET_GEOMETRY_CHAIN) != 0;
    });
    const auto add = [&](const LoweredShapes& shapes) {
      for (const Subtree& subtree : shapes.subtrees) {
        if (subtree.linked.size() > 0) out_.shapes |= shape_bit(shape_linked_capsule);
        for (std::uint32_t kind = 0; kind < shape_count; ++kind)
          if (subtree.loose.counts()[kind] > 0) out_.shapes |= shape_bit(kind);
        for (const FlatPrimitive& p : subtree.primitives) {
          out_.shapes |= shape_bit(p.shape);
          if (p.shape != shape_csg) continue;
          out_.shapes |= csg_operand_shapes(p, out_.leaves);
          out_.has_chains = out_.has_chains || csg_has_chain(p, out_.leaves);
          out_.has_moving_operands = out_.has_moving_operands || csg_moves(p, out_.leaves);
        }
      }
    };
    add(lowered.world);
    for (const LoweredShapes& object : lowered.objects) add(object);
    if (lowered.world.subtrees.size() > 1 || !scene_.instances.empty())
      out_.shapes |= shape_bit(shape_instance);
    // Kernels have at least one kind.
    if (out_.shapes == 0) out_.shapes = shape_bit(shape_sphere);
    kind_bits_ = out_.leaf_kind_bits =
        leaf_kind_bits(for_all_rows() ? shape_bit(shape_count - 1) : out_.shapes);
  }

  Lengths lengths() const {
    return {out_.geometries.size(),   geometry_of_.size(),      out_.surface_materials.size(),
            out_.mesh_indices.size(), out_.mesh_normals.size(), out_.mesh_uvs.size(),
            out_.leaves.size()};
  }

  /// `object`: what the shapes belong to; none: the world.
  LoweredShapes lower_shapes(const std::vector<Shape>& shapes, std::uint32_t object_begin,
                             const Object* object) {
    LoweredShapes lowered;
    const uint object_name =
        object ? matte_hash(
                     matte_name(*object, static_cast<std::size_t>(object - scene_.objects.data())))
               : 0;
    lowered.subtrees.emplace_back();
    lowered.extents.resize(shapes.size());
    std::map<std::pair<std::array<double, 16>, uint>, Subtree*> by_space;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Shape& shape = shapes[i];
      if (const auto* csg = std::get_if<CsgShape>(&shape.geometry);
          csg && is_empty(*csg, shape.world_from_object))
        continue;
      Subtree* subtree = &lowered.subtrees[0];
      const SubtreeKey own = subtree_key(shape, shape.world_from_object);
      if (!own.is_common()) {
        std::array<double, 16> key;
        for (int k = 0; k < 16; ++k) key[static_cast<std::size_t>(k)] = own.placed[k / 4][k % 4];
        const auto [found, fresh] = by_space.emplace(std::pair(key, own.flags), nullptr);
        if (fresh) {
          found->second = &lowered.subtrees.emplace_back();
          found->second->placed = own.placed;
          found->second->flags = own.flags;
        }
        subtree = found->second;
      }
      ShapeExtent& extent = lowered.extents[i];
      extent.subtree = subtree;
      extent.first = subtree->primitives.size();
      extent.begin = lengths();
      const std::size_t linked = subtree->linked.size();
      lower_shape(shape, own.baked, object_begin + narrow<std::uint32_t>(i),
                  object ? object_name : matte_hash(matte_name(shape, i)), *subtree);
      extent.end = lengths();
      extent.has_linked = subtree->linked.size() > linked;
    }
    return lowered;
  }

  uint asset_name(const Shape& shape) {
    if (shape.where.file != asset_.file || asset_.hash == 0)
      asset_ = {shape.where.file, matte_hash(matte_asset(shape))};
    return asset_.hash;
  }

  /// Returns the first step of a shape's alpha; shapes with the same one share it.
  uint alpha_of(const Shape& shape) {
    if (!shape.alpha) return CAPLET_NONE;
    const auto* number = std::get_if<ConstantSpectrum>(&shape.alpha->value);
    const auto [found, fresh] = alphas_.try_emplace(
        {shape.alpha->texture.value_or(CAPLET_NONE), number ? number->value : 0}, 0);
    if (fresh) found->second = lower_alpha(scene_, *shape.alpha, images_, spectra_, out_);
    return found->second;
  }

  /// Adds rows of surface_materials where a shape's surfaces differ; returns CAPLET_NONE where they
  /// do not.
  uint add_surfaces(const Shape& shape) {
    std::vector<uint> rows = surface_materials(shape);
    if (shape.emission && !shape.emission->surfaces.empty())
      for (std::size_t i = 0; i < rows.size(); ++i)
        if (std::ranges::find(shape.emission->surfaces, i) == shape.emission->surfaces.end())
          rows[i] |= CAPLET_SURFACE_DARK;
    if (std::ranges::all_of(rows, [&](uint row) { return row == shape.material; }))
      return CAPLET_NONE;
    const auto begin = narrow<uint>(out_.surface_materials.size());
    out_.surface_materials.insert(out_.surface_materials.end(), rows.begin(), rows.end());
    return begin;
  }

  static std::vector<uint> surface_materials(const Shape& shape) {
    if (!shape.materials.empty()) return shape.materials;
    if (const auto* csg = std::get_if<CsgShape>(&shape.geometry)) {
      std::vector<uint> rows;
      for (const auto& operand : csg->operands) {
        const std::vector<uint> more = surface_materials(*operand);
        rows.insert(rows.end(), more.begin(), more.end());
      }
      return rows;
    }
    return std::vector<uint>(surface_count(shape), shape.material);
  }

  uint add_geometry(GeometryRecord record, int shape) {
    record.shape = static_cast<uint>(shape);
    out_.geometries.push_back(record);
    return narrow<uint>(out_.geometries.size() - 1);
  }

  FlatPrimitive& add_primitive(Subtree& subtree, int shape, uint geometry) {
    FlatPrimitive& p = subtree.primitives.emplace_back();
    p = FlatPrimitive{
        static_cast<std::uint32_t>(shape), narrow<std::uint32_t>(geometry_of_.size()), {}};
    geometry_of_.push_back(geometry);
    return p;
  }

  /// Appends shapes of one primitive.
  template <class Geometry>
  void append(const Geometry& geometry, const Matrix& m, const GeometryRecord& record,
              Subtree& subtree) {
    append_one(flat_primitive(geometry, m, out_.leaves), record, subtree);
  }

  void append(const CsgShape& csg, const Matrix& m, const GeometryRecord& record,
              Subtree& subtree) {
    append_one(flat_csg(csg, m, scene_.view.film, out_.leaves), record, subtree);
  }

  void append_one(const FlatPrimitive& flat, const GeometryRecord& record, Subtree& subtree) {
    FlatPrimitive& p = add_primitive(subtree, static_cast<int>(flat.shape),
                                     add_geometry(record, static_cast<int>(flat.shape)));
    std::copy(std::begin(flat.data), std::end(flat.data), std::begin(p.data));
  }

  void append(const CapsulesShape& capsules, const Matrix& m, const GeometryRecord& record,
              Subtree& subtree) {
    GeometryRecord of_all = record;
    if (!capsules.u.empty()) of_all.flags |= CAPLET_GEOMETRY_CHAIN;
    std::optional<CapsuleMotion> motion;
    std::optional<MovingCapsules> moving;
    if (!capsules.times.empty()) {
      const FilmSettings& film = scene_.view.film;
      moving.emplace(motion.emplace(capsules, film.shutter_open, film.open_time()), out_.leaves);
    }
    const PlacedCapsules placed(capsules, m, similarity_scale(m));
    const std::vector<CapsuleRow> rows =
        may_link_ && !moving ? rows_of(placed, linking_.least_run) : std::vector<CapsuleRow>();
    std::size_t linked = 0;
    for (const CapsuleRow& row : rows) linked += row.count;
    // Linked ones have their u in their leaf blocks.
    if (!capsules.u.empty() && linked < count_of(capsules)) {
      of_all.uv_begin = narrow<uint>(out_.mesh_uvs.size());
      reserve_more(out_.mesh_uvs, 2 * capsules.u.size());
      for (const glm::vec2& u : capsules.u) out_.mesh_uvs.insert(out_.mesh_uvs.end(), {u.x, u.y});
    }
    std::array<std::vector<uint>, shape_count> own_geometries;  // by kind and material
    const auto add_id = [&](std::size_t i, std::uint32_t kind) {
      const uint material = capsules.materials.empty() ? record.material : capsules.materials[i];
      std::vector<uint>& by_material = own_geometries[kind];
      if (by_material.size() <= material) by_material.resize(material + 1, CAPLET_NONE);
      if (by_material[material] == CAPLET_NONE) {
        GeometryRecord own = of_all;
        own.material = material;
        by_material[material] = add_geometry(own, static_cast<int>(kind));
      }
      geometry_of_.push_back(by_material[material]);
    };
    reserve_more(geometry_of_, count_of(capsules));
    if (linked == 0 && !moving && may_be_loose_) {
      const auto id = narrow<std::uint32_t>(geometry_of_.size());
      std::array<std::uint64_t, shape_count> counts{};
      for (std::size_t i = 0; i < placed.size(); ++i) {
        const std::uint32_t kind = placed[i].shape;
        add_id(i, kind);
        ++counts[kind];
      }
      return subtree.loose.add(placed, id, counts);
    }
    reserve_more(subtree.primitives, count_of(capsules) - linked);
    LinkedCapsules& links = subtree.linked.of(placed);
    if (linked > 0) links.begin(placed, narrow<std::uint32_t>(geometry_of_.size()));
    auto row = rows.begin();
    for (std::size_t i = 0; i < count_of(capsules);) {
      if (row != rows.end() && row->first == i) {
        links.add_row(*row);
        for (; i < row->first + row->count; ++i) add_id(i, shape_linked_capsule);
        ++row;
        continue;
      }
      FlatPrimitive p = moving ? moving->primitive(i) : placed[i];
      p.id = narrow<std::uint32_t>(geometry_of_.size());
      subtree.primitives.push_back(p);
      add_id(i++, p.shape);
    }
  }

  void append(const MolecularSurfaceShape& molecule, const Matrix& m, const GeometryRecord& record,
              Subtree& subtree) {
    const std::vector<FlatPrimitive> patches = flat_patches(molecule, m, out_.leaves);
    std::map<uint, uint> own_geometries;  // by material
    reserve_more(subtree.primitives, patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const uint material = molecule.materials.empty()
                                ? record.material
                                : molecule.materials[ball_of_patch(molecule, i)];
      const auto [found, fresh] = own_geometries.try_emplace(material, 0);
      if (fresh) {
        GeometryRecord own = record;
        own.material = material;
        found->second = add_geometry(own, shape_molecular_patch);
      }
      FlatPrimitive& p = add_primitive(subtree, shape_molecular_patch, found->second);
      std::copy(std::begin(patches[i].data), std::end(patches[i].data), std::begin(p.data));
    }
  }

  void add_vertex_data(const std::vector<glm::vec3>& normals, const std::vector<glm::vec2>& uvs,
                       const Matrix& m, GeometryRecord& record) {
    if (!normals.empty()) {
      record.flags |= CAPLET_GEOMETRY_NORMALS;
      record.normal_begin = narrow<uint>(out_.mesh_normals.size());
      const glm::dmat3 normal_matrix = glm::transpose(glm::inverse(glm::dmat3(m)));
      for (const glm::vec3& n : normals) {
        const dvec3 turned = normal_matrix * dvec3(n);
        const double length = glm::length(turned);
        for (int k = 0; k < 3; ++k)
          out_.mesh_normals.push_back(length > 0 ? static_cast<float>(turned[k] / length) : 0.f);
      }
    }
    if (!uvs.empty()) {
      record.uv_begin = narrow<uint>(out_.mesh_uvs.size());
      for (const glm::vec2& uv : uvs) out_.mesh_uvs.insert(out_.mesh_uvs.end(), {uv.x, uv.y});
    }
  }

  /// Removes what add_vertex_data has just added.
  void drop_vertex_data(GeometryRecord& record) {
    if (record.normal_begin != CAPLET_NONE) out_.mesh_normals.resize(record.normal_begin);
    if (record.uv_begin != CAPLET_NONE) out_.mesh_uvs.resize(record.uv_begin);
    record.normal_begin = record.uv_begin = CAPLET_NONE;
    record.flags &= ~CAPLET_GEOMETRY_NORMALS;
  }

  void append_moving(const TriangleMeshShape& mesh, const Matrix& m, GeometryRecord record,
                     Subtree& subtree) {
    const FilmSettings& film = scene_.view.film;
    const MeshMotion motion(mesh, film.shutter_open, film.open_time());
    if (motion.rests()) return append(motion.at(0), m, record, subtree);
    const MeshMotion::Key& start = motion.keys()[0];
    const auto at_start = [&](std::uint32_t vertex) { return dvec3(start.positions[vertex]); };
    const bool flipped = (record.flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0;
    const auto turned = [&](const std::array<std::uint32_t, 3>& triangle) {
      const dvec3 a = at_start(triangle[0]);
      dvec3 sum(0);
      if (start.normals.empty()) return false;
      for (const std::uint32_t vertex : triangle) sum += dvec3(start.normals[vertex]);
      return is_against(sum, glm::cross(at_start(triangle[1]) - a, at_start(triangle[2]) - a),
                        flipped);
    };
    if (mesh.uvs.empty() && std::ranges::any_of(mesh.triangles, turned))
      return append_moving(with_uvs(mesh), m, record, subtree);
    record.index_begin = narrow<uint>(out_.mesh_indices.size());
    add_vertex_data({}, mesh.uvs, m, record);
    if (!start.normals.empty()) record.flags |= CAPLET_GEOMETRY_NORMALS;
    const uint geometry = add_geometry(record, shape_moving_triangle);
    MovingTriangles moving(motion, out_.leaves);
    reserve_more(subtree.primitives, mesh.triangles.size());
    for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
      if (turned(triangle)) std::swap(triangle[1], triangle[2]);
      out_.mesh_indices.insert(out_.mesh_indices.end(), triangle.begin(), triangle.end());
      const FlatPrimitive flat = moving.primitive(triangle);
      FlatPrimitive& p = add_primitive(subtree, shape_moving_triangle, geometry);
      std::copy(std::begin(flat.data), std::end(flat.data), std::begin(p.data));
    }
  }

  void append(const TriangleMeshShape& mesh, const Matrix& m, GeometryRecord record,
              Subtree& subtree) {
    if (!mesh.times.empty()) return append_moving(mesh, m, record, subtree);
    record.index_begin = narrow<uint>(out_.mesh_indices.size());
    add_vertex_data(mesh.normals, mesh.uvs, m, record);
    std::vector<glm::vec3> moved;
    moved.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) moved.emplace_back(apply_point(m, dvec3(p)));
    const bool flipped = (record.flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0;
    const auto turned = [&](const std::array<std::uint32_t, 3>& triangle) {
      const dvec3 a(moved[triangle[0]]), b(moved[triangle[1]]), c(moved[triangle[2]]);
      return against_normals(record, glm::cross(b - a, c - a), triangle, flipped);
    };
    if (mesh.uvs.empty() && std::ranges::any_of(mesh.triangles, turned)) {
      drop_vertex_data(record);
      return append(with_uvs(mesh), m, record, subtree);
    }
    const uint geometry = add_geometry(record, shape_triangle);
    reserve_more(subtree.primitives, mesh.triangles.size());
    for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
      if (turned(triangle)) std::swap(triangle[1], triangle[2]);
      FlatPrimitive& p = add_primitive(subtree, shape_triangle, geometry);
      for (std::size_t k = 0; k < 3; ++k) {
        out_.mesh_indices.push_back(triangle[k]);
        put(p, triangle_at_v0 + static_cast<int>(3 * k), dvec3(moved[triangle[k]]));
      }
    }
  }

  /// By pbrt's rule a mesh with normals has its outside where they point, whatever the winding.
  /// `normal`: by winding; `sum`: of the normals at the corners.
  bool is_against(const dvec3& sum, const dvec3& normal, bool flipped) const {
    const double side = glm::dot(normal, sum) * (reversed_ ? -1 : 1);
    return (flipped ? -side : side) < 0;
  }
  bool against_normals(const GeometryRecord& record, const dvec3& normal,
                       std::span<const std::uint32_t> corners, bool flipped) const {
    if (record.normal_begin == CAPLET_NONE) return false;
    dvec3 sum(0);
    for (const std::uint32_t v : corners)
      for (int k = 0; k < 3; ++k)
        sum[k] += out_.mesh_normals[record.normal_begin + 3 * v + static_cast<std::uint32_t>(k)];
    return is_against(sum, normal, flipped);
  }

  void append(const BilinearMeshShape& mesh, const Matrix& m, GeometryRecord record,
              Subtree& subtree) {
    record.index_begin = narrow<uint>(out_.mesh_indices.size());
    add_vertex_data(mesh.normals, mesh.uvs, m, record);
    const bool flipped = (record.flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0;
    const auto corner = [&](const std::array<std::uint32_t, 4>& patch, std::size_t k) {
      return apply_point(m, dvec3(mesh.positions[patch[k]]));
    };
    const auto turned = [&](const std::array<std::uint32_t, 4>& patch) {
      return against_normals(
          record,
          glm::cross(corner(patch, 3) - corner(patch, 0), corner(patch, 2) - corner(patch, 1)),
          patch, flipped);
    };
    if (mesh.uvs.empty() && std::ranges::any_of(mesh.patches, turned)) {
      drop_vertex_data(record);
      return append(with_uvs(mesh), m, record, subtree);
    }
    const uint geometry = add_geometry(record, shape_bilinear);
    for (std::array<std::uint32_t, 4> patch : mesh.patches) {
      if (turned(patch)) std::swap(patch[1], patch[2]);
      FlatPrimitive& p = add_primitive(subtree, shape_bilinear, geometry);
      for (std::size_t k = 0; k < 4; ++k) {
        out_.mesh_indices.push_back(patch[k]);
        put(p, bilinear_at_p00 + static_cast<int>(3 * k), corner(patch, k));
      }
    }
  }

  const PlacedSubtree& placed(const FlatPrimitive& instance) const {
    return (*placed_)[instance.id];
  }

  /// Returns whether a primitive moves. Operands of csg shapes may, within the whole's box.
  bool moves(const FlatPrimitive& p) const {
    if (p.shape != shape_instance) return shape_has(p.shape, trait_moves);
    return placed(p).motion.has_value() || placed(p).subtree->tree.intervals > 1;
  }

  /// Sets the kept box of one that does (MovingBoxes).
  void set_box(FlatPrimitive& p, float begin, float end) const {
    if (p.shape == shape_moving_capsule) {
      set_moving_capsule_box(p, out_.leaves, begin, end);
    } else if (p.shape == shape_moving_triangle) {
      set_moving_triangle_box(p, out_.leaves, begin, end);
    } else {
      const PlacedSubtree& of = placed(p);
      set_instance_box(*of.subtree, of.world_from_subtree, of.motion ? &*of.motion : nullptr, p,
                       begin, end);
    }
  }

  void encode(Subtree& subtree) {
    const bool release = linking_.release && !out_.has_media();
    const MovingBoxes boxes{
        [&](const FlatPrimitive& p) { return moves(p); },
        [&](FlatPrimitive& p, float begin, float end) { set_box(p, begin, end); }};
    subtree.tree = encode_trees({subtree.primitives, subtree.loose, subtree.linked}, boxes, release,
                                out_.nodes, out_.leaves, kind_bits_);
    out_.bvh_nodes += subtree.tree.nodes;
    out_.bvh_depth = std::max(out_.bvh_depth, subtree.tree.depth);
  }

  /// `of`: the instance of the scene; null: a subtree of the world.
  void place(const Subtree& subtree, Matrix world_from_subtree, const Instance* of,
             std::uint32_t scene_instance, Subtree& top, std::vector<PlacedSubtree>& placed) {
    const auto index = narrow<uint>(out_.instances.size());
    const auto shapes = narrow<std::uint32_t>(scene_.shapes.size());
    std::optional<MotionPath> motion;
    if (of && !of->motion.empty()) {
      const FilmSettings& film = scene_.view.film;
      world_from_subtree =
          AnimatedTransform(of->motion, of->pivot).at(film.shutter_open) * subtree.placed;
      motion = MotionPath::of(of->motion, film, of->pivot, subtree.placed, of->where);
    }
    InstanceRecord record =
        instance_record(subtree, world_from_subtree,
                        scene_instance == CAPLET_NONE ? CAPLET_NONE : shapes + scene_instance);
    if (motion) {
      record.motion_segments = motion->segments();
      record.motion_begin = narrow<uint>(out_.leaves.size());
      motion->append(true, out_.leaves);
      while (out_.leaves.size() % 8 != 0) out_.leaves.push_back(0);
    }
    out_.instances.push_back(record);
    FlatPrimitive& p = top.primitives.emplace_back();
    p = FlatPrimitive{shape_instance, index, {}};
    set_instance_box(subtree, world_from_subtree, motion ? &*motion : nullptr, p);
    placed.push_back({&subtree, index, world_from_subtree, scene_instance,
                      top.primitives.size() - 1, std::move(motion)});
  }

  void add_emitters(const Subtree& subtree, uint instance, const Matrix& world_from_subtree,
                    const MotionPath* motion, std::vector<Emitter>& emitters) {
    for (const Subtree::Emissive& emissive : subtree.emissive) {
      emitters.resize(emitters.size() + emissive.count);
      set_emitters(subtree, emissive, instance, world_from_subtree, motion, group_++, spectra_,
                   out_, &emitters[emitters.size() - emissive.count]);
    }
  }

  const Scene& scene_;
  const ImageNumbers& images_;
  SpectrumTable& spectra_;
  const Linking linking_;
  FlatScene& out_;
  std::vector<std::uint32_t> geometry_of_;  // by primitive id
  bool links_ = false;                      // the scene has linked capsules
  bool may_link_ = false;                   // the shape being appended may
  bool may_be_loose_ = false;               // it needs no primitives
  std::map<std::pair<std::uint32_t, double>, uint> alphas_;
  struct {
    std::string file;
    uint hash = 0;
  } asset_;                // of the shape before
  bool reversed_ = false;  // of the shape being appended
  std::uint32_t group_ = 0;
  int kind_bits_ = 0;                                   // of leaf references
  const std::vector<PlacedSubtree>* placed_ = nullptr;  // by instance, as far as there are
};

}  // namespace

SubtreeKey subtree_key(const Shape& shape, const Matrix& m) {
  // There is one subtree for what is baked into the shapes' common space, then one for each
  // transform that cannot be baked.
  const bool stays =
      !std::visit([&](const auto& geometry) { return bakes_under(geometry, m); }, shape.geometry);
  const Matrix baked = stays ? Matrix(1) : m;
  return {stays ? m : Matrix(1), unseen_sides(shape, baked), baked};
}

LoweredGeometry lower_geometry(const Scene& scene, const ImageNumbers& images,
                               SpectrumTable& spectra, const Linking& linking, FlatScene& out) {
  return GeometryLowering(scene, images, spectra, linking, out).run();
}

Subtree lower_shape_alone(const Scene& scene, const Shape& shape, const Matrix& baked,
                          std::uint32_t object, const ImageNumbers& images, SpectrumTable& spectra,
                          FlatScene& out) {
  Subtree subtree;
  GeometryLowering(scene, images, spectra, Linking::none(), out)
      .lower_shape(shape, baked, object, 0, subtree);
  return subtree;
}

}  // namespace caplet
