// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/media/subsurface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace caplet {

namespace {

double fresnel(double cosine, double eta) {
  const double sine2 = (1 - cosine * cosine) / (eta * eta);
  if (sine2 >= 1) return 1;
  const double beyond = std::sqrt(1 - sine2);
  const double parallel = (eta * cosine - beyond) / (eta * cosine + beyond),
               across = (cosine - eta * beyond) / (cosine + eta * beyond);
  return 0.5 * (parallel * parallel + across * across);
}

constexpr double pi = std::numbers::pi;

/// A quadrature: points and weights.
struct Nodes {
  std::vector<double> at, weight;

  /// Adds n Gauss-Legendre points over an interval.
  void add(double low, double high, int n) {
    for (int i = 0; i < n; ++i) {
      double x = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1;
      for (int round = 0; round < 8; ++round) {
        double p = 1, before = 0;
        for (int k = 0; k < n; ++k)
          before = std::exchange(p, ((2 * k + 1) * x * p - k * before) / (k + 1));
        slope = n * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      at.push_back(low + (high - low) * 0.5 * (1 + x));
      weight.push_back((high - low) / ((1 - x * x) * slope * slope));
    }
  }
};

/// A half-space that scatters isotropically, behind a smooth boundary of relative index eta.
class HalfOfSpace {
 public:
  explicit HalfOfSpace(double eta) {
    // Light from within is totally reflected below the critical cosine.
    const double critical = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
    if (critical > 0) mu_.add(0, critical, 20);
    mu_.add(critical, 1, 24);
    for (const double mu : mu_.at) mirrored_.push_back(fresnel(mu, 1 / eta));
    theta_.add(0, 1, 64);
  }

  /// Returns the part of diffuse light, once inside, that leaves again. `albedo`: of single
  /// scattering, from 0 to 1.
  double reflectance(double albedo) const {
    const std::size_t n = mu_.at.size();
    const std::vector<double> h = chandrasekhar(albedo);
    // Upward radiance u at the boundary: u = K (j + f u). K is the reflection of a half-space
    // without a boundary, albedo H H' / (2 (mu + mu')) mu'; j is the light that enters, and f the
    // internal reflection of the boundary.
    std::vector<double> table(n * (n + 1));
    const auto at = [&](std::size_t row, std::size_t column) -> double& {
      return table[row * (n + 1) + column];
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) {
        const double reflected =
            albedo * h[i] * h[k] / (2 * (mu_.at[i] + mu_.at[k])) * mu_.at[k] * mu_.weight[k];
        at(i, k) = (i == k ? 1 : 0) - reflected * mirrored_[k];
        at(i, n) += reflected * (1 - mirrored_[k]);
      }
    // The system is solved without pivoting: columns of K f add up to less than 1, so the diagonal
    // is large enough.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t r = i + 1; r < n; ++r) {
        const double times = at(r, i) / at(i, i);
        for (std::size_t k = i; k <= n; ++k) at(r, k) -= times * at(i, k);
      }
    double out = 0, in = 0;
    for (std::size_t i = n; i-- > 0;) {
      double u = at(i, n);
      for (std::size_t k = i + 1; k < n; ++k) u -= at(i, k) * at(k, n);
      at(i, n) = u / at(i, i);
      out += mu_.at[i] * mu_.weight[i] * (1 - mirrored_[i]) * at(i, n);
      in += mu_.at[i] * mu_.weight[i] * (1 - mirrored_[i]);
    }
    return out / in;
  }

 private:
  /// Chandrasekhar's H of isotropic scattering: log H(mu) = -mu / pi times the integral of log(1 -
  /// albedo t cot t) / (cos^2 t + mu^2 sin^2 t) for t from 0 to pi / 2 (Radiative Transfer, 1950).
  std::vector<double> chandrasekhar(double albedo) const {
    std::vector<double> log_h(mu_.at.size());
    for (std::size_t j = 0; j < theta_.at.size(); ++j) {
      // Points are dense near 0, where the logarithm is unbounded at albedo 1, and near pi / 2,
      // where a small mu makes a peak.
      const double s = theta_.at[j], t = pi / 2 * s * s * (3 - 2 * s), dt = pi * 3 * s * (1 - s);
      const double cosine = std::cos(t), sine = std::sin(t),
                   lost = std::log(std::max(1 - albedo * t * cosine / sine, 1e-30));
      for (std::size_t i = 0; i < log_h.size(); ++i) {
        const double mu = mu_.at[i];
        log_h[i] -=
            mu / pi * lost / (cosine * cosine + mu * mu * sine * sine) * theta_.weight[j] * dt;
      }
    }
    for (double& one : log_h) one = std::exp(one);
    return log_h;
  }

  Nodes mu_, theta_;
  std::vector<double> mirrored_;
};

}  // namespace

double albedo_within(double reflectance, double eta, double g) {
  const double wanted = std::clamp(reflectance, 0.0, 1.0);
  if (wanted == 0 || wanted == 1) return wanted;
  const HalfOfSpace half(eta);
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (half.reflectance(middle) < wanted ? low : high) = middle;
  }
  // Similarity keeps absorption and reduced scattering.
  const double even = 0.5 * (low + high);
  return even / (1 - g + even * g);
}

}  // namespace caplet
