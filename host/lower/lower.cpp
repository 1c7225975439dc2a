// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/lower.h"

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "lower/camera.h"
#include "lower/detail/filter.h"
#include "lower/detail/lowering.h"

namespace caplet {

namespace {

class MaterialLowering {
 public:
  explicit MaterialLowering(SpectrumTable& spectra) : spectra_(spectra) {}

  MaterialRecord operator()(const DiffuseMaterial& material) const {
    MaterialRecord record{};
    record.kind = material_diffuse;
    record.reflectance = spectra_.add_reflectance(material.reflectance);
    return record;
  }
  MaterialRecord operator()(const ConductorMaterial& material) const {
    MaterialRecord record = rough(material_conductor, material.alpha_u, material.alpha_v);
    record.eta = spectra_.add_unbounded(material.reflectance ? ConstantSpectrum{1} : material.eta);
    record.k = material.reflectance ? spectra_.add_extinction(*material.reflectance) : spectra_.add_unbounded(material.k);
    return record;
  }
  MaterialRecord operator()(const DielectricMaterial& material) const {
    MaterialRecord record = rough(material_dielectric, material.alpha_u, material.alpha_v);
    record.eta = spectra_.add_unbounded(material.eta);
    if (!is_constant(material.eta)) record.flags |= CAPLET_MATERIAL_DISPERSIVE;
    return record;
  }

 private:
  static MaterialRecord rough(int kind, double alpha_u, double alpha_v) {
    MaterialRecord record{};
    record.kind = static_cast<uint>(kind);
    record.alpha_u = static_cast<float>(alpha_u);
    record.alpha_v = static_cast<float>(alpha_v);
    return record;
  }
  SpectrumTable& spectra_;
};

}  // namespace

MaterialRecord lower_material(const Material& material, SpectrumTable& spectra) {
  return std::visit(MaterialLowering(spectra), material.model);
}

Lowering::Lowering(const Scene& scene) : spectra(flat, scene.film.space) {
  const auto start = std::chrono::steady_clock::now();
  for (const Material& material : scene.materials) flat.materials.push_back(lower_material(material, spectra));
  geometry = lower_geometry(scene, spectra, flat);
  lower_lights(scene, geometry.emitters, spectra, environment, flat);
  flat.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

FlatScene lower(const Scene& scene) { return std::move(Lowering(scene).flat); }

FlatView lower_view(const Scene& scene) {
  FlatView out;
  lower_camera(scene, out);
  lower_filter(scene.filter, out);
  out.view.seed = scene.sampler.seed;
  out.view.max_depth = narrow<uint>(scene.integrator.max_depth);
  std::ranges::transform(rgb_from_xyz(scene.film.space), out.view.rgb_from_xyz, [](double v) { return static_cast<float>(v); });
  return out;
}

}  // namespace caplet
