// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <cmath>
#include <numbers>

#include "coats.h"
#include "trials.h"

namespace caplet::test {

namespace {

using std::numbers::pi;

BsdfParameters fibre(const char* name, float beta_m, float beta_n, float absorption, float tilt) {
  return {.name = name, .kind = material_hair, .eta = 1.55f, .k = absorption, .alpha_u = beta_m, .alpha_v = beta_n, .tilt = tilt};
}

/// The published formulas (Chiang et al. 2016; d'Eon et al. 2011) in double, in their own terms: the fibre along x, inclinations
/// theta from its normal plane, azimuths phi in it from y to z. The local frame has the fibre along y and the normal along z.
double hair(const BsdfParameters& bsdf, const Direction& o, const Direction& i) {
  const double wo[3] = {double{o[1]}, -double{o[0]}, double{o[2]}}, wi[3] = {double{i[1]}, -double{i[0]}, double{i[2]}};
  const double theta_o = std::asin(wo[0]), theta_i = std::asin(wi[0]);
  const double phi = std::atan2(wi[2], wi[1]) - std::atan2(wo[2], wo[1]);
  const double gamma_o = std::atan2(wo[2], wo[1]) - pi / 2;  // from the normal to wo
  const double eta = double{bsdf.eta}, m = double{bsdf.alpha_u}, n = double{bsdf.alpha_v};
  const double index = std::sqrt(eta * eta - std::pow(std::sin(theta_o), 2)) / std::cos(theta_o);
  const double gamma_t = std::asin(std::sin(gamma_o) / index), theta_t = std::asin(std::sin(theta_o) / eta);
  const double through = std::exp(-double{bsdf.k} * 2 * std::cos(gamma_t) / std::cos(theta_t));
  const double f = fresnel(std::cos(theta_o) * std::cos(gamma_o), eta);
  const double share[4] = {f, (1 - f) * (1 - f) * through, (1 - f) * (1 - f) * through * through * f,
                           (1 - f) * (1 - f) * std::pow(through, 3) * f * f / (1 - through * f)};
  const double v = std::pow(0.726 * m + 0.812 * m * m + 3.7 * std::pow(m, 20), 2), variances[4] = {v, v / 4, 4 * v, 4 * v};
  const double width = std::sqrt(pi / 8) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22));
  const double tilts[4] = {2.0, -1.0, -4.0, 0.0};
  double sum = 0;
  for (int p = 0; p < 4; ++p) {
    const double variance = variances[p], tilted = theta_o - tilts[p] * double{bsdf.tilt};
    const double a = std::cos(theta_i) * std::abs(std::cos(tilted)) / variance,
                 b = std::sin(theta_i) * std::sin(tilted) / variance;
    const double along = std::exp(-b) * std::cyl_bessel_i(0.0, a) / (2 * variance * std::sinh(1 / variance));
    double around = 1 / (2 * pi);
    if (p < 3) {
      const double x = std::remainder(phi - (2 * p * gamma_t - 2 * gamma_o + p * pi), 2 * pi), e = std::exp(-std::abs(x) / width);
      const auto below = [&](double y) { return 1 / (1 + std::exp(-y / width)); };
      around = e / (width * (1 + e) * (1 + e)) / (below(pi) - below(-pi));
    }
    sum += share[p] * along * around;
  }
  return sum;
}

}  // namespace

BsdfTrial hair_trial() {
  BsdfTrial trial;
  trial.reciprocal = false;  // the offset across the fibre is that of wo
  const BsdfParameters white = fibre("hair white", 0.3f, 0.3f, 0, 0.035f), brown = fibre("hair brown", 0.25f, 0.4f, 0.6f, 0.035f),
                       fuzzy = fibre("hair fuzzy", 0.7f, 0.8f, 0.1f, -0.1f);
  for (const BsdfParameters& one : {white, brown, fuzzy}) trial.cases.push_back({one, {0.1, 0.7, 1.3, pi - 0.7}});
  BsdfParameters wider = brown;
  wider.alpha_v = 0.45f;
  trial.unlike = {{brown, wider}, {brown, white}};
  // Above the surface, below it, beside and along the fibre. A density of exp(a - b - 1 / v) loses 2e-7 / v.
  for (const BsdfParameters& one : {white, brown, fuzzy})
    for (const auto& [o, around_o] : {std::pair(0.2, 0.4), std::pair(0.9, 2.0), std::pair(1.3, 5.0)})
      for (const auto& [i, around_i] : {std::pair(0.5, 3.3), std::pair(1.2, 0.9), std::pair(2.2, 4.5), std::pair(2.9, 1.0)}) {
        const Direction wo = direction(o, around_o), wi = direction(i, around_i);
        trial.values.push_back({one, wo, wi, hair(one, wo, wi), one.k == 0 ? hair(one, wo, wi) : -1, 2e-4});
      }
  trial.model.model = HairMaterial{};
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double) { return 10; };
  return trial;
}

}  // namespace caplet::test
