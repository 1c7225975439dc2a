// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pearson's chi-square test of counts against expectations.
#pragma once

#include <span>

namespace caplet::test {

struct ChiSquareResult {
  double statistic = 0;
  int degrees_of_freedom = 0;
  double p_value = 1;  // chance of a statistic at least as large when the expectations hold
};

/// Cells with an expectation below 5 are pooled, in order of expectation, until a pool reaches 5
/// (Cochran's rule); what is left over joins the last pool. One degree of freedom is taken by the
/// total, so both sides should sum up to the same number of samples, those that fell nowhere
/// included as a cell. A single pool leaves nothing to test: no degrees of freedom, and p is 1.
/// Observations in cells whose expectation is zero count in their pool; where all expectations are
/// zero, p is 0. Throws std::invalid_argument for different lengths and for expectations that are
/// negative or not finite.
ChiSquareResult chi_square(std::span<const double> observed, std::span<const double> expected);

/// Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0: to about 1e-14.
double gamma_q(double a, double x);

/// The significance of each of `tests` independent tests that keeps the chance of any false alarm
/// at `significance` (Sidak 1967).
double sidak(double significance, int tests);

}  // namespace caplet::test
