// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <complex>
#include <numbers>

#include "coats.h"
#include "trials.h"

namespace caplet::test {

namespace {

double metal_reflectance(double cos_i, std::complex<double> index) {
  const std::complex<double> sin2 = 1 - cos_i * cos_i, cos_t = std::sqrt(1.0 - sin2 / (index * index));
  return 0.5 * (std::norm((cos_i - index * cos_t) / (cos_i + index * cos_t)) +
                std::norm((index * cos_i - cos_t) / (index * cos_i + cos_t)));
}

/// GGX of equal roughnesses with height-correlated masking (Heitz 2014): f |cos wi|.
double microfacets(const Direction& wo, const Direction& wi, double alpha, std::complex<double> index) {
  double m[3], length = 0, cos_m = 0;
  for (std::size_t c = 0; c < 3; ++c) length += std::pow(m[c] = double{wo[c]} + double{wi[c]}, 2);
  for (std::size_t c = 0; c < 3; ++c) cos_m += (m[c] /= std::sqrt(length)) * double{wo[c]};
  const double a2 = alpha * alpha, d = a2 / (std::numbers::pi * std::pow(m[2] * m[2] * (a2 - 1) + 1, 2));
  const auto lambda = [&](const Direction& w) {
    const double z2 = double{w[2]} * double{w[2]};
    return 0.5 * (std::sqrt(1 + a2 * (1 - z2) / z2) - 1);
  };
  return metal_reflectance(cos_m, index) * d / (1 + lambda(wo) + lambda(wi)) / (4 * double{wo[2]});
}

}  // namespace

BsdfTrial coatedconductor_trial() {
  BsdfTrial trial;
  trial.estimates = true;
  const auto metal = [](const char* name, float coat_alpha, float alpha_u, float alpha_v) {
    BsdfParameters out = coat(name, material_coatedconductor, coat_alpha);
    out.eta = 0.2f;
    out.k = 3.9f;
    out.alpha_u = alpha_u;
    out.alpha_v = alpha_v;
    return out;
  };
  const std::vector<double> thetas = {0.1, 0.9, 1.3, std::numbers::pi - 0.7};
  BsdfParameters under_haze = metal("coatedconductor under haze", 0.2f, 0, 0);
  under_haze.thickness = 0.5f;
  under_haze.albedo = 0.8f;
  for (const BsdfParameters& one :
       {metal("coatedconductor clear", 0, 0.3f, 0.3f), metal("coatedconductor rough", 0.2f, 0.2f, 0.4f),
        metal("coatedconductor mirror", 0.2f, 0, 0), under_haze})
    trial.cases.push_back({one, thetas});
  // No interface: the metal alone.
  for (const float alpha : {0.2f, 0.5f}) {
    BsdfParameters bare = metal("coatedconductor bare", 0, alpha, alpha);
    bare.coat_eta = 1;
    bare.thickness = 1e-30f;
    for (const auto& [o, i] : {std::pair(0.2, 0.5), std::pair(1.1, 0.8), std::pair(0.6, 1.4)}) {
      const Direction wo = direction(o, 0.3), wi = direction(i, 2.6);
      trial.values.push_back({bare, wo, wi, microfacets(wo, wi, double{alpha}, {0.2, 3.9}), 0, 1e-4});
    }
  }
  CoatedConductorMaterial model;
  model.eta = ConstantSpectrum{0.2};
  model.k = ConstantSpectrum{3.9};
  trial.model.model = model;
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double cos_theta) { return std::abs(cos_theta) < 0.3 ? 40 : 20; };
  return trial;
}

}  // namespace caplet::test
