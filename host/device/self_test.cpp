// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/self_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>

#include "base/check.h"
#include "base/log.h"
#include "device/cache.h"
#include "device/detail/layout.h"

namespace caplet {

namespace {

constexpr std::size_t local_size = 8;

/// Collects failures, at most one for each kind of check so that a broken device gives a readable
/// message.
class Failures {
 public:
  void add(const std::string& check, const std::string& detail) {
    if (std::find(checks_.begin(), checks_.end(), check) != checks_.end()) return;
    checks_.push_back(check);
    lines_.push_back(check + ": " + detail);
  }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> checks_, lines_;
};

bool may_be_flushed(float x) { return std::fpclassify(x) == FP_SUBNORMAL; }

/// Returns |seen - exact| in units of the last place of the exact result (its binary32 neighbour's
/// distance).
double error_in_ulp(float seen, double exact) {
  const double ulp = std::ldexp(1.0, std::max(std::ilogb(exact), -126) - 23);
  return std::abs(static_cast<double>(seen) - exact) / ulp;
}

/// Returns pairs of ordinary numbers over many scales, then every pair of the special ones.
std::vector<float> float_pairs() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float specials[] = {0.0f,     -0.0f,       1.0f,
                                -1.5f,    infinity,    -infinity,
                                FLT_MAX,  FLT_MIN,     std::numeric_limits<float>::quiet_NaN(),
                                -3.25e7f, 1.0f / 3.0f, 1.17549435e-30f};
  std::vector<float> pairs;
  std::mt19937 random(1);
  const auto draw = [&] {
    const auto mantissa = static_cast<float>(random() >> 8) / 16777216.0f + 1.0f;
    const int exponent = static_cast<int>(random() % 60u) - 30;
    return std::ldexp(random() % 2u ? mantissa : -mantissa, exponent);
  };
  for (int i = 0; i < 400; ++i) {
    pairs.push_back(draw());
    pairs.push_back(draw());
  }
  for (const float a : specials)
    for (const float b : specials) pairs.insert(pairs.end(), {a, b});
  return pairs;
}

/// Checks one result against the correctly rounded `expected`; NaN matches any NaN;
/// `any_zero_sign`: a zero may have either sign, as that of fmin(+0, -0) has.
void check_value(Failures& failures, const std::string& what, float a, float b, float seen,
                 float expected, bool any_zero_sign = false) {
  const bool same = std::isnan(expected) ? std::isnan(seen)
                    : any_zero_sign
                        ? seen == expected
                        : std::bit_cast<cl_uint>(seen) == std::bit_cast<cl_uint>(expected);
  if (!same)
    failures.add(
        what, fmt::format("with a = {}, b = {} the device gives {}, not {}", a, b, seen, expected));
}

/// Does the same as check_value, but finite results may be off by `bound` ulp of `exact`.
void check_rounded(Failures& failures, const std::string& what, float a, float b, float seen,
                   double exact, double bound) {
  const auto rounded = static_cast<float>(exact);
  if (may_be_flushed(rounded)) return;
  if (!std::isfinite(rounded) || exact == 0)
    return check_value(failures, what, a, b, seen, rounded, exact == 0);
  // Beyond the largest number, results within the bound of it may also have become infinite.
  if (std::isinf(seen) && std::abs(exact) > FLT_MAX * (1 - 4e-7)) return;
  if (!(error_in_ulp(seen, exact) <= bound))
    failures.add(what, fmt::format("with a = {}, b = {} the device gives {}, not {} within {} ulp",
                                   a, b, seen, exact, bound));
}

void check_arithmetic(const Device& device, const Program& program, Failures& failures) {
  const std::vector<float> pairs = float_pairs();
  const std::size_t count = pairs.size() / 2;
  const Buffer<float> in(device, std::span<const float>(pairs));
  Buffer<float> out(device, 12 * count);
  cl::Kernel kernel = program.kernel("arithmetic");
  set_arguments(device, kernel, in, out, narrow<cl_uint>(count));
  launch(device, kernel, count, local_size);
  const std::vector<float> seen = out.read();
  for (std::size_t i = 0; i < count; ++i) {
    const float a = pairs[2 * i], b = pairs[2 * i + 1];
    const float* row = &seen[12 * i];
    const auto exact = [&](const char* what, float value, float expected) {
      if (!may_be_flushed(expected)) check_value(failures, what, a, b, value, expected);
    };
    exact("a + b", row[0], a + b);
    exact("a - b", row[1], a - b);
    exact("a * b", row[2], a * b);
    check_rounded(failures, "a / b", a, b, row[3], static_cast<double>(a) / b, 2.5);
    check_rounded(failures, "sqrt(a)", a, b, row[4], std::sqrt(static_cast<double>(a)), 3.0);
    // libclc computes -0 for fma(-0, 0, +0); kernels do not use the sign of a zero from fma.
    if (const float sum = std::fma(a, b, -a); !may_be_flushed(sum))
      check_value(failures, "fma(a, b, -a)", a, b, row[5], sum, true);
    check_value(failures, "fmin(a, b)", a, b, row[6], std::fmin(a, b), true);
    check_value(failures, "fmax(a, b)", a, b, row[7], std::fmax(a, b), true);
    exact("floor(a)", row[8], std::floor(a));
    exact("fabs(a)", row[9], std::fabs(a));
    exact("copysign(a, b)", row[10], std::isnan(b) ? row[10] : std::copysign(a, b));
    exact("as_float(as_uint(a) ^ sign)", row[11], -a);
  }
}

void check_comparisons(const Device& device, const Program& program, Failures& failures) {
  const std::vector<float> pairs = float_pairs();
  const std::size_t count = pairs.size() / 2;
  const Buffer<float> in(device, std::span<const float>(pairs));
  Buffer<cl_uint> out(device, count);
  cl::Kernel kernel = program.kernel("comparisons");
  set_arguments(device, kernel, in, out, narrow<cl_uint>(count));
  launch(device, kernel, count, local_size);
  const std::vector<cl_uint> seen = out.read();
  for (std::size_t i = 0; i < count; ++i) {
    const float a = pairs[2 * i], b = pairs[2 * i + 1];
    const bool sign = std::isnan(a) ? (seen[i] >> 8 & 1u) != 0 : std::signbit(a);
    const bool answers[] = {a < b,         a <= b,        a == b, a != b, a >= b, !(a > b),
                            std::isnan(a), std::isinf(a), sign,   a < b,  true,   std::isnan(a)};
    constexpr const char* names[] = {"a < b",
                                     "a <= b",
                                     "a == b",
                                     "a != b",
                                     "a >= b",
                                     "!(a > b)",
                                     "isnan(a)",
                                     "isinf(a)",
                                     "signbit(a)",
                                     "float8 <",
                                     "float8 < of numbers",
                                     "any(isnan(float8))"};
    for (std::size_t bit = 0; bit < std::size(answers); ++bit)
      if ((seen[i] >> bit & 1u) != (answers[bit] ? 1u : 0u))
        failures.add(names[bit],
                     fmt::format("with a = {}, b = {} the device says {}", a, b, !answers[bit]));
  }
}

void check_integers(const Device& device, const Program& program, Failures& failures) {
  std::vector<cl_uint> pairs = {0,           0, 1,           31, 0x80000000u, 31,
                                0xffffffffu, 1, 0x7fffffffu, 4,  0x80000001u, 8};
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) pairs.push_back(static_cast<cl_uint>(random()));
  const std::size_t count = pairs.size() / 2;
  const Buffer<cl_uint> in(device, std::span<const cl_uint>(pairs));
  Buffer<cl_uint> out(device, 8 * count);
  cl::Kernel kernel = program.kernel("integers");
  set_arguments(device, kernel, in, out, narrow<cl_uint>(count));
  launch(device, kernel, count, local_size);
  const std::vector<cl_uint> seen = out.read();
  for (std::size_t i = 0; i < count; ++i) {
    const cl_uint a = pairs[2 * i], b = pairs[2 * i + 1];
    const cl_uint expected[] = {static_cast<cl_uint>(std::countl_zero(a)),
                                static_cast<cl_uint>(std::popcount(a)),
                                a << (b & 31u),
                                a >> (b & 31u),
                                static_cast<cl_uint>(static_cast<cl_int>(a) >> (b & 31u)),
                                static_cast<cl_uint>(std::uint64_t{a} * b >> 32),
                                std::rotl(a, static_cast<int>(b & 31u)),
                                a * b};
    constexpr const char* names[] = {"clz(a)",       "popcount(a)",      "a << b",
                                     "a >> b",       "(int)a >> b",      "mul_hi(a, b)",
                                     "rotate(a, b)", "a * b of integers"};
    for (std::size_t j = 0; j < 8; ++j)
      if (seen[8 * i + j] != expected[j])
        failures.add(names[j],
                     fmt::format("with a = {:#x}, b = {:#x} the device gives {:#x}, not {:#x}", a,
                                 b, seen[8 * i + j], expected[j]));
  }
}

void check_lanes(const Device& device, const Program& program, Failures& failures) {
  constexpr std::size_t count = 37;
  std::vector<float> in(8 * count + 8), expected(8 * count + 2, -1.0f);
  for (std::size_t i = 0; i < in.size(); ++i)
    in[i] = static_cast<float>(i) * (i % 3 == 0 ? -1.0f : 1.0f);
  for (std::size_t i = 0; i < 8 * count; ++i)
    expected[i + 1] = in[i + 1] < 0 ? in[i + 3] : in[i + 1];
  const Buffer<float> from(device, std::span<const float>(in));
  Buffer<float> to(device, expected.size());
  to.write(std::vector<float>(expected.size(), -1.0f));
  cl::Kernel kernel = program.kernel("lanes");
  set_arguments(device, kernel, from, to, narrow<cl_uint>(count));
  launch(device, kernel, count, local_size);
  const std::vector<float> seen = to.read();
  const auto [at, wanted] = std::mismatch(seen.begin(), seen.end(), expected.begin());
  if (at != seen.end())
    failures.add("vload8, select, vstore8",
                 fmt::format("float {} is {}, not {}", at - seen.begin(), *at, *wanted));
}

void check_groups(const Device& device, const Program& program, Failures& failures) {
  constexpr std::size_t count = 512;
  Buffer<cl_uint> totals(device, 4), tickets(device, count), ids(device, 4 * count);
  totals.write(std::vector<cl_uint>(4, 0));
  cl::Kernel kernel = program.kernel("groups");
  set_arguments(device, kernel, totals, tickets, ids);
  launch(device, kernel, count, local_size);
  const std::vector<cl_uint> sums = totals.read();
  const std::vector<cl_uint> expected = {count, count * (count - 1) / 2, count - 1, 0xffffffffu};
  constexpr const char* names[] = {"atomic_inc", "atomic_add", "atomic_max", "atomic_or"};
  for (std::size_t i = 0; i < 4; ++i)
    if (sums[i] != expected[i])
      failures.add(names[i], fmt::format("gives {}, not {}", sums[i], expected[i]));
  std::vector<cl_uint> order = tickets.read();
  std::sort(order.begin(), order.end());
  std::vector<cl_uint> all(count);
  std::iota(all.begin(), all.end(), 0u);
  if (order != all) failures.add("atomic_inc", "gave a value twice");
  const std::vector<cl_uint> seen = ids.read();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t wanted[] = {local_size, i % local_size, i / local_size, count};
    if (!std::equal(wanted, wanted + 4, seen.begin() + static_cast<std::ptrdiff_t>(4 * i)))
      failures.add("work-group ids", fmt::format("of work-item {} are wrong", i));
  }
}

/// $CAPLET_SELF_TEST is "0" for never, "1" for always, else the test runs when it has not passed
/// before.
enum class When { never, unless_passed, always };

When when_to_test() {
  const char* value = std::getenv("CAPLET_SELF_TEST");
  if (!value) return When::unless_passed;
  if (std::strcmp(value, "0") == 0) return When::never;
  return std::strcmp(value, "1") == 0 ? When::always : When::unless_passed;
}

std::string trial_key(const Device& device, const std::vector<std::string>& texts) {
  const DeviceInfo& info = device.info();
  std::string key = "self test";
  for (const std::string& part : {info.name, info.driver, info.version, info.platform})
    key += '\0' + part;
  for (const std::string& text : texts) key += '\0' + text;
  return key;
}

}  // namespace

std::vector<std::string> self_test_failures(const Device& device, const std::string& source) {
  const Program program = Program::from_source(device, "self_test", source, "");
  Failures failures;
  check_arithmetic(device, program, failures);
  check_comparisons(device, program, failures);
  check_integers(device, program, failures);
  check_lanes(device, program, failures);
  check_groups(device, program, failures);
  return failures.take();
}

bool self_test_is_due(const Device& device, const std::vector<std::string>& texts) {
  const When when = when_to_test();
  return when == When::always ||
         (when == When::unless_passed && !cache_load(trial_key(device, texts), "passed"));
}

void remember_self_test(const Device& device, const std::vector<std::string>& texts) {
  cache_store(trial_key(device, texts), "passed", {});
}

void refuse_device(const Device& device, const std::vector<std::string>& failures) {
  const DeviceInfo& info = device.info();
  std::string message = fmt::format(
      "device '{}' (driver {}) computes wrongly, so that pictures would be wrong:", info.name,
      info.driver);
  for (const std::string& failure : failures) message += "\n  " + failure;
  throw WrongDevice(message + "\nCAPLET_SELF_TEST=0 leaves this test out");
}

void self_test(const Device& device) {
  const std::string source = kernel_source("probe/self_test.cl");
  const std::vector<std::string> texts{source, kernel_source("probe/layout.cl")};
  if (!self_test_is_due(device, texts)) return;
  log::info("testing {} once", device.info().name);
  std::vector<std::string> failures = self_test_failures(device, source);
  for (const std::string& mismatch : compare_layout(device)) failures.push_back(mismatch);
  if (!failures.empty()) refuse_device(device, failures);
  remember_self_test(device, texts);
}

}  // namespace caplet
