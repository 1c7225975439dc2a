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
  return {.name = name,
          .kind = material_hair,
          .eta = 1.55f,
          .k = absorption,
          .alpha_u = beta_m,
          .alpha_v = beta_n,
          .hair_tilt = tilt};
}

/// The published formulas (Chiang et al. 2016; d'Eon et al. 2011) in double, in their own terms:
/// the fibre along x, inclinations theta from its normal plane, azimuths phi in it from y to z. The
/// local frame has the fibre along y and the normal along z.
double hair(const BsdfParameters& bsdf, const Direction& o, const Direction& i) {
  const double wo[3] = {double{o[1]}, -double{o[0]}, double{o[2]}},
               wi[3] = {double{i[1]}, -double{i[0]}, double{i[2]}};
  const double theta_o = std::asin(wo[0]), theta_i = std::asin(wi[0]);
  const double phi = std::atan2(wi[2], wi[1]) - std::atan2(wo[2], wo[1]);
  const double gamma_o = std::atan2(wo[2], wo[1]) - pi / 2;  // from the normal to wo
  const double eta = double{bsdf.eta}, m = double{bsdf.alpha_u}, n = double{bsdf.alpha_v};
  const double index = std::sqrt(eta * eta - std::pow(std::sin(theta_o), 2)) / std::cos(theta_o);
  const double gamma_t = std::asin(std::sin(gamma_o) / index),
               theta_t = std::asin(std::sin(theta_o) / eta);
  const double through = std::exp(-double{bsdf.k} * 2 * std::cos(gamma_t) / std::cos(theta_t));
  const double f = fresnel(std::cos(theta_o) * std::cos(gamma_o), eta);
  const double share[4] = {f, (1 - f) * (1 - f) * through,
                           (1 - f) * (1 - f) * through * through * f,
                           (1 - f) * (1 - f) * std::pow(through, 3) * f * f / (1 - through * f)};
  const double v = std::pow(0.726 * m + 0.812 * m * m + 3.7 * std::pow(m, 20), 2),
               variances[4] = {v, v / 4, 4 * v, 4 * v};
  const double width = std::sqrt(pi / 8) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22));
  const double tilts[4] = {2.0, -1.0, -4.0, 0.0};
  double sum = 0;
  for (int p = 0; p < 4; ++p) {
    const double variance = variances[p], tilted = theta_o - tilts[p] * double{bsdf.hair_tilt};
    const double a = std::cos(theta_i) * std::abs(std::cos(tilted)) / variance,
                 b = std::sin(theta_i) * std::sin(tilted) / variance;
    const double along =
        std::exp(-b) * std::cyl_bessel_i(0.0, a) / (2 * variance * std::sinh(1 / variance));
    double around = 1 / (2 * pi);
    if (p < 3) {
      const double x = std::remainder(phi - (2 * p * gamma_t - 2 * gamma_o + p * pi), 2 * pi),
                   e = std::exp(-std::abs(x) / width);
      const auto below = [&](double y) { return 1 / (1 + std::exp(-y / width)); };
      around = e / (width * (1 + e) * (1 + e)) / (below(pi) - below(-pi));
    }
    sum += share[p] * along * around;
  }
  return sum;
}

/// Values of Mitsuba 3.9.1's hair plugin, variant scalar_rgb, index 1.55; its fibre lies along y as
/// well. tilt: degrees.
struct MitsubaHair {
  float beta_m, beta_n, sigma_a;
  double tilt;
  Direction wo, wi;
  double value;
};
// clang-format off
const MitsubaHair mitsuba_hair[] = {
    {0.25f, 0.40f, 0.60f, 2.0, {0.734647751f, -0.645540714f, 0.208734021f}, {0.395349145f, 0.887510419f, 0.236694515f}, 0.0152555},
    {0.25f, 0.40f, 0.60f, 2.0, {0.788188457f, -0.238044381f, 0.567533076f}, {-0.702770233f, -0.265908152f, 0.659853697f}, 0.00822592},
    {0.25f, 0.40f, 0.60f, 2.0, {0.0218374413f, 0.909326553f, 0.41550976f}, {0.125873476f, -0.821071029f, -0.556774914f}, 0.236233},
    {0.25f, 0.40f, 0.60f, 2.0, {0.180375084f, 0.868054271f, 0.462543577f}, {-0.288371235f, -0.324314922f, 0.900922775f}, 0.00836302},
    {0.30f, 0.30f, 0.00f, 2.0, {0.695371747f, 0.673365355f, 0.251072228f}, {0.114440277f, -0.987464845f, -0.108704068f}, 0.00971446},
    {0.30f, 0.30f, 0.00f, 2.0, {0.568658471f, 0.167173445f, 0.805407107f}, {-0.252851635f, -0.761847794f, 0.596367359f}, 0.00342589},
    {0.30f, 0.30f, 0.00f, 2.0, {0.00973129366f, 0.400804222f, 0.916112065f}, {0.642537892f, -0.552008212f, -0.531443298f}, 0.00871012},
    {0.30f, 0.30f, 0.00f, 2.0, {-0.903218389f, 0.283650011f, 0.322085738f}, {-0.812225342f, 0.168200612f, 0.558568299f}, 0.0273154},
    {0.60f, 0.70f, 0.20f, 0.0, {0.456886947f, -0.680756927f, 0.572559416f}, {-0.402217686f, -0.868155062f, 0.290736496f}, 0.00482543},
    {0.60f, 0.70f, 0.20f, 0.0, {0.840529144f, 0.477459997f, 0.256013036f}, {0.829043627f, -0.539436936f, -0.147290468f}, 0.0739896},
    {0.60f, 0.70f, 0.20f, 0.0, {-0.770779669f, -0.479407281f, 0.419603825f}, {0.836337447f, -0.0126527296f, 0.548069f}, 0.0422551},
    {0.60f, 0.70f, 0.20f, 0.0, {0.317385584f, -0.478613466f, 0.818654716f}, {-0.474014312f, -0.452175498f, -0.755544662f}, 0.0120318},
    {0.20f, 0.30f, 0.10f, 5.0, {0.294704407f, -0.211382002f, 0.93191576f}, {-0.707484305f, 0.270659208f, 0.65284723f}, 0.00925055},
    {0.20f, 0.30f, 0.10f, 5.0, {0.468677223f, -0.177277535f, 0.865398347f}, {0.172399387f, 0.14625524f, -0.974108756f}, 1.60985},
    {0.20f, 0.30f, 0.10f, 5.0, {0.554771304f, -0.817966461f, 0.152182817f}, {-0.636547744f, 0.508461058f, -0.579891622f}, 0.00649983},
    {0.20f, 0.30f, 0.10f, 5.0, {-0.794625103f, -0.57083869f, 0.206674114f}, {-0.720901072f, 0.64800179f, 0.245754495f}, 0.0707577},
};
// clang-format on

}  // namespace

BsdfTrial hair_trial() {
  BsdfTrial trial;
  trial.reciprocal = false;  // the offset across the fibre is that of wo
  const BsdfParameters white = fibre("hair white", 0.3f, 0.3f, 0, 0.035f),
                       brown = fibre("hair brown", 0.25f, 0.4f, 0.6f, 0.035f),
                       fuzzy = fibre("hair fuzzy", 0.7f, 0.8f, 0.1f, -0.1f);
  for (const BsdfParameters& one : {white, brown, fuzzy})
    trial.cases.push_back({one, {0.1, 0.7, 1.3, pi - 0.7}});
  BsdfParameters wider = brown;
  wider.alpha_v = 0.45f;
  trial.unlike = {{brown, wider}, {brown, white}};
  // Above the surface, below it, beside and along the fibre. A density of exp(a - b - 1 / v) loses
  // 2e-7 / v.
  for (const BsdfParameters& one : {white, brown, fuzzy})
    for (const auto& [o, around_o] :
         {std::pair(0.2, 0.4), std::pair(0.9, 2.0), std::pair(1.3, 5.0)})
      for (const auto& [i, around_i] :
           {std::pair(0.5, 3.3), std::pair(1.2, 0.9), std::pair(2.2, 4.5), std::pair(2.9, 1.0)}) {
        const Direction wo = direction(o, around_o), wi = direction(i, around_i);
        trial.values.push_back(
            {one, wo, wi, hair(one, wo, wi), one.k == 0 ? hair(one, wo, wi) : -1, 2e-4});
      }
  // Its Bessel function is of ten terms: up to half a percent.
  for (const MitsubaHair& row : mitsuba_hair) {
    const BsdfParameters bsdf = fibre("hair of Mitsuba", row.beta_m, row.beta_n, row.sigma_a,
                                      static_cast<float>(row.tilt * pi / 180));
    trial.values.push_back({bsdf, row.wo, row.wi, row.value, -1, 6e-3});
  }
  trial.model.model = HairMaterial{};
  trial.most = [](const BsdfParameters&, bool) { return 1.0; };
  trial.steps = [](const BsdfParameters&, double) { return 10; };
  return trial;
}

}  // namespace caplet::test
