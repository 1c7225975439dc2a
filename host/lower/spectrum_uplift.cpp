// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/spectrum_uplift.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "lower/color.h"
#include "lower/detail/spectrum_color.h"

namespace caplet {

namespace {

/// Wavelengths are mapped to t in [-1, 1] while solving, where the powers of t are well scaled.
constexpr double middle = 595, half_width = 235;

/// Response is the linear RGB response to a reflectance at nodes t under the illuminant, so that
/// rgb = sum response * reflectance.
struct Response {
  std::vector<double> t;
  std::vector<glm::dvec3> weight;
};

/// Makes nodes every `step` nm (a divisor of 470); the 1 nm responses are distributed linearly
/// between them. The weights sum up to (1, 1, 1).
Response make_response(ColorSpace space, int step) {
  const auto& observer = normalized_observer();
  const SpectrumSamples& light = illuminant(space);
  const std::array<double, 9> m = rgb_from_xyz(space);
  Response out;
  const int last = CAPLET_LAMBDA_COUNT - 1;
  for (int i = 0; i <= last; i += step)
    out.t.push_back((double{CAPLET_LAMBDA_MIN} + i - middle) / half_width);
  out.weight.assign(out.t.size(), glm::dvec3(0));
  glm::dvec3 total(0);
  for (int i = 0; i <= last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double end = i == 0 || i == last ? 0.5 : 1;
    glm::dvec3 rgb(0);
    for (std::size_t c = 0; c < 3; ++c)
      for (int row = 0; row < 3; ++row)
        rgb[row] += m[3 * static_cast<std::size_t>(row) + c] * observer[c][at] * light[at] * end;
    total += rgb;
    const auto node = static_cast<std::size_t>(i / step);
    const double f = static_cast<double>(i % step) / step;
    if (f == 0) {
      out.weight[node] += rgb;
    } else if (node == 0 || node + 2 >= out.t.size()) {
      out.weight[node] += (1 - f) * rgb;
      out.weight[node + 1] += f * rgb;
    } else {
      out.weight[node - 1] += -f * (f - 1) * (f - 2) / 6 * rgb;
      out.weight[node] += (f + 1) * (f - 1) * (f - 2) / 2 * rgb;
      out.weight[node + 1] += -(f + 1) * f * (f - 2) / 2 * rgb;
      out.weight[node + 2] += (f + 1) * f * (f - 1) / 6 * rgb;
    }
  }
  for (glm::dvec3& weight : out.weight) weight /= total;
  return out;
}

const Response& response(ColorSpace space, bool fine) {
  static std::array<std::array<Response, 2>, 4> all;
  static std::array<std::array<std::once_flag, 2>, 4> once;
  const auto s = static_cast<std::size_t>(space);
  const std::size_t f = fine ? 1 : 0;
  std::call_once(once[s][f], [&] { all[s][f] = make_response(space, fine ? 1 : 5); });
  return all[s][f];
}

/// Returns the colour of the sigmoid of c (powers 2, 1, 0 of t) and its derivatives, in columns.
glm::dvec3 color(const Response& response, const glm::dvec3& c, glm::dmat3* jacobian) {
  glm::dvec3 rgb(0);
  if (jacobian) *jacobian = glm::dmat3(0);
  for (std::size_t i = 0; i < response.t.size(); ++i) {
    const double t = response.t[i], x = (c[0] * t + c[1]) * t + c[2];
    const double inverse = 1 / std::sqrt(1 + x * x);
    rgb += response.weight[i] * (0.5 + 0.5 * x * inverse);
    if (!jacobian) continue;
    const glm::dvec3 slope = response.weight[i] * (0.5 * inverse * inverse * inverse);
    (*jacobian)[0] += slope * (t * t);
    (*jacobian)[1] += slope * t;
    (*jacobian)[2] += slope;
  }
  return rgb;
}

double sqr(double x) { return x * x; }

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Makes Gauss-Newton steps, damped (Levenberg-Marquardt) where they do not help. Returns the
/// residual.
double solve(const Response& response, const glm::dvec3& target, double tolerance, int iterations,
             glm::dvec3& c) {
  // Beyond this, |x| > 500 nearly everywhere and the spectrum is a box to 1e-6: nothing is gained,
  // and floats lose digits.
  constexpr double limit = 2000;
  double damping = 1e-6;
  glm::dmat3 jacobian;
  glm::dvec3 residual = color(response, c, &jacobian) - target;
  for (int i = 0; i < iterations && largest(residual) > tolerance; ++i) {
    const glm::dmat3 transposed = glm::transpose(jacobian);
    glm::dmat3 normal = transposed * jacobian;
    for (int k = 0; k < 3; ++k) normal[k][k] += damping * normal[k][k] + 1e-16;
    const glm::dvec3 next =
        glm::clamp(c - glm::inverse(normal) * (transposed * residual), -limit, limit);
    glm::dmat3 next_jacobian;
    const glm::dvec3 next_residual = color(response, next, &next_jacobian) - target;
    if (glm::dot(next_residual, next_residual) < glm::dot(residual, residual)) {
      c = next;
      residual = next_residual;
      jacobian = next_jacobian;
      damping = std::max(damping * 0.1, 1e-12);
    } else {
      damping = std::max(damping * 10, 1e-9);
      if (damping > 1e12) break;
    }
  }
  return largest(residual);
}

/// Returns the sigmoid's coefficient c of a constant spectrum of this value.
glm::dvec3 constant(double value) {
  const double v = std::clamp(value, 1e-6, 1 - 1e-6);
  return {0, 0, (v - 0.5) / std::sqrt(v * (1 - v))};
}

/// Converts powers of t to powers of the wavelength in nm.
std::array<double, 3> in_nanometres(const glm::dvec3& c) {
  const double a = 1 / half_width, b = -middle / half_width;
  return {c[0] * a * a, 2 * c[0] * a * b + c[1] * a, c[0] * b * b + c[1] * b + c[2]};
}

/// ChromaticityTable holds solutions for colours with maximum 1/2, over which channel is the
/// largest and the two others in units of it (rows: second).
class ChromaticityTable {
 public:
  explicit ChromaticityTable(ColorSpace space) : cells_(3 * size * size) {
    const Response& coarse = response(space, false);
    tbb::parallel_for(std::size_t{0}, 3 * size, [&](std::size_t row) {
      // Colours are solved from grey outwards: each solution starts the next.
      glm::dvec3 c(0);
      for (std::size_t step = size; step-- > 0;) {
        glm::dvec3 target;
        const std::size_t top = row / size;
        target[static_cast<int>(top)] = 0.5;
        target[static_cast<int>((top + 1) % 3)] = 0.5 * ratio_at(step);
        target[static_cast<int>((top + 2) % 3)] = 0.5 * ratio_at(row % size);
        if (step + 1 == size) {
          for (int part = 1; part <= 8; ++part)
            solve(coarse, glm::mix(glm::dvec3(0.5), target, part / 8.0), 1e-6, 20, c);
        } else {
          solve(coarse, target, 1e-6, 20, c);
        }
        cells_[row * size + step] = c;
      }
    });
  }

  std::array<double, 3> at(std::size_t top, double second, double third) const {
    const double x = place(second), y = place(third);
    const auto column = std::min(static_cast<std::size_t>(x), size - 2),
               row = std::min(static_cast<std::size_t>(y), size - 2);
    const double u = x - static_cast<double>(column), v = y - static_cast<double>(row);
    const glm::dvec3* cell = &cells_[(top * size + row) * size + column];
    return in_nanometres(
        glm::mix(glm::mix(cell[0], cell[1], u), glm::mix(cell[size], cell[size + 1], u), v));
  }

 private:
  static constexpr std::size_t size = 96;
  /// Coefficients grow fast towards saturated colours, so the nodes lie closer there.
  static double ratio_at(std::size_t node) {
    const double s = static_cast<double>(node) / (size - 1);
    return s * s;
  }
  static double place(double ratio) { return std::sqrt(std::clamp(ratio, 0.0, 1.0)) * (size - 1); }

  std::vector<glm::dvec3> cells_;
};

std::vector<float> make_sigmoid_table(ColorSpace space) {
  constexpr std::size_t values = CAPLET_UPLIFT_VALUES, ratios = CAPLET_UPLIFT_RATIOS;
  // Below this value coefficients go as one over its root to 4 digits, but the solver's precision
  // falls.
  constexpr double darkest = 2e-3;
  const Response& coarse = response(space, false);
  std::vector<float> table(CAPLET_UPLIFT_FLOATS);
  const auto ratio_at = [](std::size_t node) {
    return sqr(static_cast<double>(node) / (ratios - 1));
  };
  tbb::parallel_for(std::size_t{0}, 3 * values * ratios, [&](std::size_t row) {
    const std::size_t top = row / ratios / values, third = row % ratios;
    const double value =
        std::max(darkest, 1 - sqr(1 - static_cast<double>(row / ratios % values) / (values - 1)));
    const auto color_at = [&](double second) {
      glm::dvec3 target;
      target[static_cast<int>(top)] = value;
      target[static_cast<int>((top + 1) % 3)] = value * second;
      target[static_cast<int>((top + 2) % 3)] = value * ratio_at(third);
      return target;
    };
    // Colours are solved from grey outwards: each solution starts the next.
    glm::dvec3 c = constant(value);
    for (int part = 1; part < 8; ++part)
      solve(coarse, glm::mix(glm::dvec3(value), color_at(1), part / 8.0), 1e-5 * value, 20, c);
    for (std::size_t step = ratios; step-- > 0;) {
      solve(coarse, color_at(ratio_at(step)), 1e-5 * value, 20, c);
      const std::array<double, 3> found = in_nanometres(c);
      for (std::size_t k = 0; k < 3; ++k)
        table[3 * (row * ratios + step) + k] = static_cast<float>(found[k] * std::sqrt(value));
    }
  });
  return table;
}

const ChromaticityTable& chromaticity_table(ColorSpace space) {
  static std::array<std::unique_ptr<const ChromaticityTable>, 4> tables;
  static std::array<std::once_flag, 4> once;
  const auto s = static_cast<std::size_t>(space);
  // The table is made in isolation: meanwhile the thread must not take up another task, which may
  // wait for the table.
  std::call_once(once[s], [&] {
    tbb::this_task_arena::isolate(
        [&] { tables[s] = std::make_unique<const ChromaticityTable>(space); });
  });
  return *tables[s];
}

}  // namespace

const std::vector<float>& sigmoid_table(ColorSpace space) {
  static std::array<std::vector<float>, 4> tables;
  static std::array<std::once_flag, 4> once;
  const auto s = static_cast<std::size_t>(space);
  // This is isolated for the same reason as chromaticity_table.
  std::call_once(once[s], [&] {
    tbb::this_task_arena::isolate([&] { tables[s] = make_sigmoid_table(space); });
  });
  return tables[s];
}

SigmoidFit fit_sigmoid(const glm::dvec3& rgb, ColorSpace space) {
  const glm::dvec3 target = glm::clamp(rgb, 0.0, 1.0);
  const double low = std::min({target.x, target.y, target.z}),
               high = std::max({target.x, target.y, target.z});
  glm::dvec3 c = constant((target.x + target.y + target.z) / 3);
  SigmoidFit fit;
  if (low == high) {
    fit.coefficients = in_nanometres(c);
    fit.residual = largest(sigmoid_rgb(fit.coefficients, space) - target);
    return fit;
  }
  constexpr double tolerance = 1e-7;
  const Response& fine = response(space, true);
  fit.residual = solve(fine, target, tolerance, 40, c);
  if (fit.residual > tolerance) {
    // The solver steps from grey to the colour, each step starting from the last one's solution.
    glm::dvec3 stepped = constant((low + high) / 2);
    double residual = 1;
    for (int step = 1; step <= 16; ++step)
      residual = solve(fine, glm::mix(glm::dvec3((low + high) / 2), target, step / 16.0), tolerance,
                       step == 16 ? 200 : 20, stepped);
    if (residual < fit.residual) {
      fit.residual = residual;
      c = stepped;
    }
  }
  fit.coefficients = in_nanometres(c);
  return fit;
}

glm::dvec3 sigmoid_rgb(const std::array<double, 3>& coefficients, ColorSpace space) {
  const Response& fine = response(space, true);
  glm::dvec3 rgb(0);
  for (std::size_t i = 0; i < fine.t.size(); ++i)
    rgb += fine.weight[i] * sigmoid_value(coefficients, middle + half_width * fine.t[i]);
  return rgb;
}

std::array<float, 4> environment_texel(const glm::dvec3& rgb, ColorSpace space) {
  const glm::dvec3 color = glm::max(rgb, 0.0);
  const std::size_t top =
      color.x >= color.y ? (color.x >= color.z ? 0 : 2) : (color.y >= color.z ? 1 : 2);
  const double maximum = color[static_cast<int>(top)];
  if (!(maximum > 0)) return {0, 0, 0, 0};
  const std::array<double, 3> c =
      chromaticity_table(space).at(top, color[static_cast<int>((top + 1) % 3)] / maximum,
                                   color[static_cast<int>((top + 2) % 3)] / maximum);
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]),
          static_cast<float>(2 * maximum)};
}

}  // namespace caplet
