// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// "multiscatter": what one scattering at rough facets loses is given back (Kulla and Conty 2017).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "trials.h"

namespace caplet::test::multiscatter_test {
namespace {

BsdfParameters metal(float alpha_u, float alpha_v, float eta = 0, float k = 1e4f) {
  BsdfParameters out{
      .name = "metal", .kind = material_conductor, .flags = CAPLET_MATERIAL_MULTISCATTER};
  out.eta = eta;
  out.k = k;
  out.alpha_u = alpha_u;
  out.alpha_v = alpha_v;
  return out;
}

BsdfParameters glass(float alpha, float eta) {
  BsdfParameters out{
      .name = "glass", .kind = material_dielectric, .flags = CAPLET_MATERIAL_MULTISCATTER};
  out.eta = eta;
  out.alpha_u = out.alpha_v = alpha;
  return out;
}

/// Energy that is reflected and that goes through, of light from theta, phi; the squared index of
/// radiance is taken out.
std::pair<double, double> energy(const BsdfParameters& bsdf, double theta, double phi = 0.4) {
  constexpr int rows = 16, columns = 32;
  const std::vector<float> integrals =
      bsdf_on_device().integrate(bsdf, direction(theta, phi), rows, columns, 24);
  const auto values = integrals.begin() + rows * columns, middle = values + rows * columns / 2;
  const double above = std::accumulate(values, middle, 0.0),
               below = std::accumulate(middle, integrals.end(), 0.0);
  const bool inside = theta > std::numbers::pi / 2;
  const double squared = bsdf.kind == material_dielectric ? double{bsdf.eta} * double{bsdf.eta} : 1;
  return inside ? std::pair(below, above / squared) : std::pair(above, below * squared);
}

// A metal that reflects all but 4e-4 at each scattering gives back all, at any roughness from 0.1
// to 1. (One scattering gives back 0.97 down to 0.31 of it.) Without the parameter nothing is
// added.
TEST(Multiscatter, AWhiteMetalReflectsAll) {
  for (const float alpha : {0.1f, 0.15f, 0.2f, 0.3f, 0.45f, 0.6f, 0.8f, 0.93f, 1.0f})
    for (const double theta : {0.1, 0.5, 0.9, 1.2, 1.4, 1.5, std::numbers::pi - 0.9}) {
      const auto [reflected, through] = energy(metal(alpha, alpha), theta);
      const bool inside = theta > std::numbers::pi / 2;
      EXPECT_NEAR(reflected, 1, 0.01) << alpha << ' ' << theta << inside;
      EXPECT_EQ(through, 0);
    }
  BsdfParameters off = metal(1, 1);
  off.flags = 0;
  EXPECT_NEAR(energy(off, 0.1).first, 0.3087, 2e-3);  // tools/energy_tables.py
}

// Two roughnesses along u and v have the losses of their mean: less is lost, but not all is given
// back.
TEST(Multiscatter, OfUnequalRoughnessesGivesBackMost) {
  for (const auto& [u, v] :
       {std::pair(0.3f, 0.5f), std::pair(0.2f, 0.1f), std::pair(0.1f, 0.4f), std::pair(0.2f, 0.8f)})
    for (const double theta : {0.1, 0.9, 1.35})
      for (const double phi : {0.0, 0.8, 1.57}) {
        BsdfParameters off = metal(u, v);
        off.flags = 0;
        const double on = energy(metal(u, v), theta, phi).first,
                     without = energy(off, theta, phi).first;
        EXPECT_LT(on, 1.04) << u << ' ' << v << ' ' << theta << ' ' << phi;
        EXPECT_GT(on, 1 - 0.5 * (1 - without)) << u << ' ' << v << ' ' << theta << ' ' << phi;
      }
}

// Metals that absorb: of all orders by walks on the same facets (tests/bsdf/facet_walks.py). The
// mean reflectance of each order stands for that of its own directions, which is right to 0.02.
TEST(Multiscatter, MetalsAbsorbAtEachScattering) {
  struct Walk {
    float eta, k, alpha;
    double cosine, reflected;
  };
  for (const Walk& walk : {Walk{0.2f, 3.9f, 0.3f, 0.2, 0.9387},
                           {0.2f, 3.9f, 0.3f, 0.9, 0.9434},
                           {0.2f, 3.9f, 0.6f, 0.5, 0.9268},
                           {0.2f, 3.9f, 1.0f, 0.2, 0.9272},
                           {0.2f, 3.9f, 1.0f, 0.9, 0.8921},
                           {1.5f, 1.2f, 0.3f, 0.5, 0.2365},
                           {1.5f, 1.2f, 0.6f, 0.9, 0.1578},
                           {1.5f, 1.2f, 1.0f, 0.2, 0.1865},
                           {1.5f, 1.2f, 1.0f, 0.9, 0.1017}})
    EXPECT_NEAR(
        energy(metal(walk.alpha, walk.alpha, walk.eta, walk.k), std::acos(walk.cosine)).first,
        walk.reflected, 0.02)
        << walk.eta << ' ' << walk.alpha << ' ' << walk.cosine;
}

// What is reflected and what goes through are all, from outside and from inside. (One scattering
// keeps 0.99 down to 0.42.)
TEST(Multiscatter, GlassTakesNothing) {
  for (const float eta : {1.33f, 1.5f, 2.0f})
    for (const float alpha : {0.15f, 0.3f, 0.6f, 1.0f})
      for (const double theta : {0.2, 0.9, 1.35, std::numbers::pi - 0.3, std::numbers::pi - 0.8,
                                 std::numbers::pi - 1.3}) {
        const auto [reflected, through] = energy(glass(alpha, eta), theta);
        EXPECT_NEAR(reflected + through, 1, 0.012) << eta << ' ' << alpha << ' ' << theta;
      }
}

/// Fresnel's reflectance of unpolarised light, in double.
double reflectance(double cosine, double eta) {
  const double sine = std::sqrt(1 - cosine * cosine) / eta;
  if (sine >= 1) return 1;
  const double beyond = std::sqrt(1 - sine * sine);
  const double s = (cosine - eta * beyond) / (cosine + eta * beyond),
               p = (eta * cosine - beyond) / (eta * cosine + beyond);
  return 0.5 * (s * s + p * p);
}

// What one scattering loses goes on in the parts of which a flat interface lets light from
// everywhere through: the mean transmittance, by quadrature of Fresnel's formulas, which the lobe
// has by a fit that is right to 0.004. From the side that loses more of such light the part is
// smaller by the ratio of both losses.
TEST(Multiscatter, OfGlassSendsOnWhatAFlatInterfaceDoes) {
  const auto middles = [](const auto& value) {  // over the hemisphere, by the cosine
    constexpr int count = 16;
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += value(std::sqrt((i + 0.5) / count)) / count;
    return sum;
  };
  for (const auto& [eta, alpha] : {std::pair(1.5f, 1.0f), std::pair(2.2f, 0.5f)}) {
    BsdfParameters off = glass(alpha, eta);
    off.flags = 0;
    const auto lost = [&](double theta) {
      const auto [reflected, through] = energy(off, theta);
      return 1 - reflected - through;
    };
    const double outside = middles([&](double cosine) { return lost(std::acos(cosine)); });
    const double inside =
        middles([&](double cosine) { return lost(std::numbers::pi - std::acos(cosine)); });
    for (const double theta : {0.5, 1.2, std::numbers::pi - 0.5, std::numbers::pi - 1.2}) {
      const bool is_inside = theta > std::numbers::pi / 2;
      const double relative = is_inside ? 1 / double{eta} : double{eta};
      double transmittance = 0;
      for (int i = 0; i < 10000; ++i)
        transmittance += (1 - reflectance(std::sqrt((i + 0.5) / 10000), relative)) / 10000;
      const double part =
          transmittance * std::min(outside, inside) / (is_inside ? inside : outside);
      EXPECT_NEAR(energy(glass(alpha, eta), theta).second,
                  energy(off, theta).second + part * lost(theta), 0.008)
          << eta << ' ' << alpha << ' ' << theta;
    }
  }
}

}  // namespace
}  // namespace caplet::test::multiscatter_test
