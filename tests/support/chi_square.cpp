// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "support/chi_square.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace caplet::test {

double gamma_q(double a, double x) {
  if (!(x > 0)) return 1;
  const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  if (x < a + 1) {
    // The power series of the lower function (DLMF 8.11.4).
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * epsilon; ++n) sum += term *= x / n;
    return std::clamp(1 - factor * sum, 0.0, 1.0);
  }
  // The continued fraction of the upper function (DLMF 8.9.2, contracted), by Lentz's method.
  constexpr double tiny = std::numeric_limits<double>::min() / epsilon;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, fraction = d;
  for (int n = 1; n < 100000; ++n) {
    const double numerator = n * (a - n);
    b += 2;
    d = numerator * d + b;
    c = b + numerator / c;
    if (std::abs(d) < tiny) d = tiny;
    if (std::abs(c) < tiny) c = tiny;
    d = 1 / d;
    fraction *= c * d;
    if (std::abs(c * d - 1) < epsilon) break;
  }
  return std::clamp(factor * fraction, 0.0, 1.0);
}

ChiSquareResult chi_square(std::span<const double> observed, std::span<const double> expected) {
  if (observed.size() != expected.size())
    throw std::invalid_argument("chi_square: as many expectations as observations are needed");
  for (const double value : expected)
    if (!(value >= 0) || std::isinf(value))
      throw std::invalid_argument("chi_square: expectations must be finite and not negative");
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [expected](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });

  struct Pool {
    double observed = 0, expected = 0;
  };
  constexpr double least = 5;
  std::vector<Pool> pools;
  Pool pool;
  for (const std::size_t cell : order) {
    pool.observed += observed[cell];
    pool.expected += expected[cell];
    if (pool.expected < least) continue;
    pools.push_back(pool);
    pool = Pool();
  }
  if (!pools.empty()) {
    pools.back().observed += pool.observed;
    pools.back().expected += pool.expected;
  } else if (pool.observed > 0 && pool.expected == 0) {
    return {std::numeric_limits<double>::infinity(), 0, 0};
  }

  ChiSquareResult result;
  for (const Pool& p : pools)
    result.statistic += (p.observed - p.expected) * (p.observed - p.expected) / p.expected;
  result.degrees_of_freedom = std::max(0, static_cast<int>(pools.size()) - 1);
  if (result.degrees_of_freedom > 0)
    result.p_value = gamma_q(0.5 * result.degrees_of_freedom, 0.5 * result.statistic);
  return result;
}

double sidak(double significance, int tests) {
  return -std::expm1(std::log1p(-significance) / tests);
}

}  // namespace caplet::test
