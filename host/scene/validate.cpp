// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the model may not hold.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scene/scene.h"

namespace caplet {

namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

template <class Vector>
bool finite(const Vector& v) {
  for (glm::length_t i = 0; i < v.length(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

class Validator {
 public:
  Validator(const Scene& scene, Diagnostics& diagnostics) : scene_(scene), diagnostics_(diagnostics) {}

  void run() {
    const SourceLocation file{scene_.source};
    for (const Material& material : scene_.materials)
      std::visit([&](const auto& m) { check(m, material.where); }, material.model);
    for (const Shape& one : scene_.shapes) shape(one);
    for (const Object& object : scene_.objects)
      for (const Shape& one : object.shapes) shape(one);
    for (const Instance& instance : scene_.instances) {
      if (instance.object >= scene_.objects.size()) error(instance.where, "an instance of an object that does not exist");
      transform(instance.world_from_object, instance.where);
    }
    for (const Light& one : scene_.lights) light(one);
    camera(file);
    film(file);
    if (!diagnostics_.has_errors() && scene_.shapes.empty() && scene_.instances.empty())
      error(file, "the scene is empty: it has no shapes");
  }

 private:
  void error(const SourceLocation& where, const std::string& message) { diagnostics_.error(where, message); }

  void transform(const glm::dmat4& m, const SourceLocation& where) {
    for (int i = 0; i < 4; ++i)
      if (!finite(m[i])) return error(where, "the transform is not finite");
    const glm::dmat3 a(m);
    // As a share of the box that the columns could span at most; below 1e-12 an inverse keeps no more than four digits.
    const double product = glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]);
    if (!(std::abs(glm::determinant(a)) > 1e-12 * product) || !std::isfinite(product))
      error(where, "the transform is singular (it flattens the shape)");
  }

  void spectrum(const Spectrum& s, const SourceLocation& where, const char* what) {
    bool good = true;
    if (const auto* constant = std::get_if<ConstantSpectrum>(&s)) good = std::isfinite(constant->value) && constant->value >= 0;
    if (const auto* rgb = std::get_if<RgbSpectrum>(&s))
      good = finite(rgb->rgb) && rgb->rgb.x >= 0 && rgb->rgb.y >= 0 && rgb->rgb.z >= 0;
    if (const auto* black = std::get_if<BlackbodySpectrum>(&s)) good = std::isfinite(black->kelvin) && black->kelvin > 0;
    if (const auto* sampled = std::get_if<SampledSpectrum>(&s)) {
      good = !sampled->values.empty() && sampled->values.size() == sampled->wavelengths.size();
      for (std::size_t i = 0; good && i < sampled->values.size(); ++i)
        good = std::isfinite(sampled->values[i]) && sampled->values[i] >= 0 && std::isfinite(sampled->wavelengths[i]) &&
               (i == 0 || sampled->wavelengths[i] > sampled->wavelengths[i - 1]);
    }
    if (!good) error(where, std::string(what) + " is not a spectrum of finite values from 0 up");
  }

  void roughness(double u, double v, const SourceLocation& where) {
    if (!(u >= 0 && v >= 0 && std::isfinite(u) && std::isfinite(v))) error(where, "the roughness must be finite and from 0 up");
  }
  void check(const DiffuseMaterial& m, const SourceLocation& where) { spectrum(m.reflectance, where, "the reflectance"); }
  void check(const ConductorMaterial& m, const SourceLocation& where) {
    spectrum(m.eta, where, "eta");
    spectrum(m.k, where, "k");
    roughness(m.alpha_u, m.alpha_v, where);
  }
  void check(const DielectricMaterial& m, const SourceLocation& where) {
    spectrum(m.eta, where, "eta");
    roughness(m.alpha_u, m.alpha_v, where);
  }

  void check(const SphereShape& sphere, const SourceLocation& where) { positive(sphere.radius, where, "the sphere's radius"); }
  void check(const DiskShape& disk, const SourceLocation& where) {
    positive(disk.radius, where, "the disk's radius");
    if (!std::isfinite(disk.height)) error(where, "the disk's height is not finite");
  }
  void check(const CapsulesShape& capsules, const SourceLocation& where) {
    const std::size_t count = capsules.p0.size();
    if (capsules.p1.size() != count || capsules.radius0.size() != count ||
        (!capsules.radius1.empty() && capsules.radius1.size() != count) ||
        (!capsules.materials.empty() && capsules.materials.size() != count))
      return error(where, "the capsules' lists differ in length");
    for (std::size_t i = 0; i < count; ++i) {
      const float r0 = capsules.radius0[i], r1 = capsules.radius1.empty() ? r0 : capsules.radius1[i];
      if (!finite(capsules.p0[i]) || !finite(capsules.p1[i]) || !std::isfinite(r0) || !std::isfinite(r1))
        return error(where, "capsule " + std::to_string(i) + " is not finite");
      if (r0 < 0 || r1 < 0) return error(where, "capsule " + std::to_string(i) + " has a negative radius");
      if (!capsules.materials.empty() && capsules.materials[i] >= scene_.materials.size())
        return error(where, "capsule " + std::to_string(i) + " has a material that does not exist");
    }
  }
  void check(const TriangleMeshShape& mesh, const SourceLocation& where) {
    const std::size_t count = mesh.positions.size();
    if ((!mesh.normals.empty() && mesh.normals.size() != count) || (!mesh.uvs.empty() && mesh.uvs.size() != count))
      return error(where, "the mesh has another number of normals or uvs than of vertices");
    for (std::size_t i = 0; i < count; ++i)
      if (!finite(mesh.positions[i]) || (!mesh.normals.empty() && !finite(mesh.normals[i])) ||
          (!mesh.uvs.empty() && !finite(mesh.uvs[i])))
        return error(where, "vertex " + std::to_string(i) + " of the mesh is not finite");
    for (const auto& triangle : mesh.triangles)
      for (std::uint32_t vertex : triangle)
        if (vertex >= count)
          return error(
              where, "the mesh has the vertex index " + std::to_string(vertex) + ", but " + std::to_string(count) + " vertices");
  }
  void positive(double value, const SourceLocation& where, const char* what) {
    if (!(value > 0 && std::isfinite(value))) error(where, std::string(what) + " must be positive and finite");
  }

  void shape(const Shape& s) {
    transform(s.world_from_object, s.where);
    std::visit([&](const auto& geometry) { check(geometry, s.where); }, s.geometry);
    if (s.material >= scene_.materials.size()) error(s.where, "the shape has a material that does not exist");
    if (!s.emission) return;
    spectrum(s.emission->radiance, s.where, "the emission");
    if (!(s.emission->scale >= 0 && std::isfinite(s.emission->scale))) error(s.where, "the emission's scale must be from 0 up");
  }

  void light(const Light& l) {
    if (!(l.scale >= 0 && std::isfinite(l.scale))) error(l.where, "the light's scale must be finite and from 0 up");
    if (const auto* point = std::get_if<PointLight>(&l.model)) {
      spectrum(point->intensity, l.where, "the intensity");
      if (!finite(point->position)) error(l.where, "the light's position is not finite");
    } else if (const auto* spot = std::get_if<SpotLight>(&l.model)) {
      spectrum(spot->intensity, l.where, "the intensity");
      if (!finite(spot->position) || !finite(spot->direction)) error(l.where, "the light's position or direction is not finite");
    } else if (const auto* distant = std::get_if<DistantLight>(&l.model)) {
      spectrum(distant->irradiance, l.where, "L");
      if (!finite(distant->direction)) error(l.where, "the light's direction is not finite");
    } else {
      infinite(std::get<InfiniteLight>(l.model), l.where);
    }
  }

  void infinite(const InfiniteLight& l, const SourceLocation& where) {
    spectrum(l.radiance, where, "L");
    if (!l.image) return;
    if (l.image->width <= 0 || l.image->height <= 0 ||
        l.image->rgb.size() != 3 * static_cast<std::size_t>(l.image->width) * static_cast<std::size_t>(l.image->height))
      return error(where, "the light's image has the wrong size");
    for (float value : l.image->rgb)
      if (!std::isfinite(value)) return error(where, "the light's image has pixels that are not finite");
  }

  void camera(const SourceLocation& file) {
    const Camera& c = scene_.camera;
    transform(c.world_from_camera, file);
    if (!(c.fov > 0 && c.fov < 3.14159265358979)) error(file, "the camera's field of view must be above 0 and below 180 degrees");
    if (!(c.lens_radius >= 0 && std::isfinite(c.lens_radius))) error(file, "the camera's lens radius must be from 0 up");
    if (!(c.focal_distance > 0 && std::isfinite(c.focal_distance))) error(file, "the camera's focal distance must be positive");
  }

  void film(const SourceLocation& file) {
    const FilmSettings& f = scene_.film;
    if (f.width <= 0 || f.height <= 0)
      error(file, "the image size must be positive");
    else if (std::int64_t{f.width} * f.height > most_pixels)
      error(file,
            "the image of " + std::to_string(f.width) + " x " + std::to_string(f.height) + " pixels is larger than 2^28 pixels");
    if (scene_.sampler.samples_per_pixel <= 0) error(file, "the samples per pixel must be positive");
    if (scene_.integrator.max_depth < 0) error(file, "the depth must not be negative");
    if (!(scene_.filter.radius_x > 0 && scene_.filter.radius_y > 0)) error(file, "the pixel filter's radius must be positive");
  }

  const Scene& scene_;
  Diagnostics& diagnostics_;
};

}  // namespace

void validate(const Scene& scene, Diagnostics& diagnostics) { Validator(scene, diagnostics).run(); }

}  // namespace caplet
