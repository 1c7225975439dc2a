// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `principled` beside the materials that it is mixed of, and what a white one gives back.
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>

#include "mitsuba_principled.h"

namespace caplet::test {
namespace {

double albedo_of(const BsdfParameters& bsdf, double theta, int steps = 40) {
  const std::vector<float> integrals =
      bsdf_on_device().integrate(bsdf, direction(theta, 0.4), 16, 32, steps);
  return std::accumulate(integrals.begin() + 16 * 32, integrals.end(), 0.0);
}

// Metal of reflectance 1 is a conductor that reflects all but 4e-4 (k 1e4); clear glass is a
// dielectric. The half vector is found anew by both: 2e-7 / alpha.
TEST(Principled, MetalAndGlassAreConductorAndDielectric) {
  for (const float roughness : {0.3f, 0.7f}) {
    BsdfParameters metal = principled("metal", 1, roughness),
                   glass = principled("glass", 1, roughness);
    metal.principled_metallic = glass.principled_transmission = 1;
    BsdfParameters conductor{.name = "conductor", .kind = material_conductor},
        dielectric{.name = "dielectric", .kind = material_dielectric};
    conductor.eta = 0;
    conductor.k = 1e4f;
    for (BsdfParameters* other : {&conductor, &dielectric})
      other->alpha_u = other->alpha_v = metal.alpha_u;
    std::vector<Direction> wo, wi;
    for (const double o : {0.2, 1.0, 1.4, 2.0, 2.9})
      for (const double i : {0.1, 0.9, 1.3, 2.2, 3.0}) {
        wo.push_back(direction(o, 0.3));
        wi.push_back(direction(i, 3.0));
      }
    const auto metals = bsdf_on_device().evaluate(metal, wo, wi),
               conductors = bsdf_on_device().evaluate(conductor, wo, wi);
    const auto glasses = bsdf_on_device().evaluate(glass, wo, wi),
               dielectrics = bsdf_on_device().evaluate(dielectric, wo, wi);
    for (std::size_t i = 0; i < wo.size(); ++i) {
      EXPECT_NEAR(metals[i].value, conductors[i].value, 1e-3f * conductors[i].value) << i;
      EXPECT_NEAR(glasses[i].value, dielectrics[i].value, 1e-4f * dielectrics[i].value) << i;
    }
  }
}

// Where there is room for it, the diffuse lobe is Burley's (2012, 5.3) to the last digit, beside an
// interface that reflects nothing; what that lobe reflects in all was integrated apart, in double.
TEST(Principled, TheDiffuseLobeIsBurleys) {
  for (const float roughness : {0.2f, 0.9f})
    for (const double theta : {0.1, 0.9, 1.4}) {
      BsdfParameters diffuse = principled("diffuse", 0.5f, roughness);
      diffuse.eta = 1.001f;  // the least
      double expected = 0;
      const double mu = std::cos(theta), r = double{roughness};
      const auto schlick = [](double c) { return std::pow(1 - c, 5); };
      for (int i = 0; i < 400; ++i)
        for (int j = 0; j < 200; ++j) {
          const double c = (i + 0.5) / 400, phi = (j + 0.5) / 200 * std::numbers::pi;
          const double half =
              std::sqrt((1 + mu * c + std::sin(theta) * std::sqrt(1 - c * c) * std::cos(phi)) / 2);
          const double fd90 = 0.5 + 2 * half * half * r;
          // (1 + (FD90 - 1) fo) (1 + (FD90 - 1) fi), as Burley has it
          expected +=
              c * (1 + (fd90 - 1) * schlick(mu)) * (1 + (fd90 - 1) * schlick(c)) / (400 * 200) * 2;
        }
      EXPECT_NEAR(albedo_of(diffuse, theta), 0.5 * expected, 2e-3) << roughness << ' ' << theta;
    }
}

// What a white base gives back, by numerical integration of the model apart, in double: it is held
// to the room beside the interface, and a coat of roughness 0.2 takes what it reflects. Light is
// lost where the room is less than what one direction alone would leave, and by masking.
TEST(Principled, AWhiteOneLosesNoMoreThanIsStated) {
  struct White {
    float roughness, coat;
    double theta, albedo;
  };
  for (const White& row : std::initializer_list<White>{{0.3f, 0, 0.1, 0.9610},
                                                       {0.3f, 0, 1.2, 0.9779},
                                                       {0.3f, 0, 1.4, 0.9252},
                                                       {0.8f, 0, 0.1, 0.9368},
                                                       {0.8f, 0, 0.7, 0.9379},
                                                       {0.8f, 0, 1.4, 0.8844},
                                                       {0.8f, 1, 0.1, 0.8953},
                                                       {0.8f, 1, 1.2, 0.9062},
                                                       {0.5f, 1, 0.7, 0.9232}}) {
    BsdfParameters white = principled("white", 1, row.roughness);
    white.principled_coat = row.coat;
    white.coat_alpha_u = 0.04f;
    EXPECT_NEAR(albedo_of(white, row.theta, 60), row.albedo, 4e-3)
        << row.roughness << ' ' << row.coat << ' ' << row.theta;
  }
}

}  // namespace
}  // namespace caplet::test
