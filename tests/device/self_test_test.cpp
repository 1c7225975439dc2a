// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The self-test passes here, and sees each kind of wrong device (played by a changed kernel).
#include "device/self_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/data.h"
#include "support/environment.h"
#include "support/test_device.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

/// The self-test's kernels with each `from` (which must be there) replaced by `to`.
std::string changed(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = kernel_source("probe/self_test.cl");
  for (const auto& [from, to] : changes) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the self-test has no '" + from + "'");
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST(SelfTest, Passes) {
  const Device device = test::test_device(Encoding::automatic);
  EXPECT_THAT(self_test_failures(device, kernel_source("probe/self_test.cl")), IsEmpty());
}

TEST(SelfTest, SeesWrongNumbers) {
  // 1.2e-7 is one ulp of 1: a sum or product off by one ulp. 4.2e-7 is 3.5 ulp of 1, beyond both
  // bounds of division and square root for mantissas near 1.
  const std::vector<std::string> failures = self_test_failures(
      test::test_device(Encoding::automatic), changed({{"= a + b;", "= (a + b) * 1.0000001f;"},
                                                       {"= a / b;", "= a / b * 1.0000005f;"},
                                                       {"= sqrt(a);", "= sqrt(a) * 1.0000005f;"},
                                                       {"fma(a, b, -a)", "a * b - a * 1.0000001f"},
                                                       {"fmax(a, b)", "(a > b ? a : b)"},
                                                       {"isnan(a) ?", "false ?"},
                                                       {"!(a > b)", "a <= b"},
                                                       {"= clz(a)", "= clz(a | 1u)"},
                                                       {"= popcount(a)", "= popcount(a >> 1)"},
                                                       {"(uint)((int)a >>", "(uint)(a >>"},
                                                       {"vload8(i, in + 3)", "vload8(i, in + 2)"},
                                                       {"atomic_inc(totals)", "totals[0]"},
                                                       {"get_group_id(0)", "get_group_id(1)"}}));
  std::vector<std::string> checks;
  for (const std::string& failure : failures)
    checks.push_back(failure.substr(0, failure.find(':')));
  EXPECT_THAT(checks,
              testing::ElementsAre("a + b", "a / b", "sqrt(a)", "fma(a, b, -a)", "fmax(a, b)",
                                   "!(a > b)", "isnan(a)", "clz(a)", "popcount(a)", "(int)a >> b",
                                   "vload8, select, vstore8", "atomic_inc", "work-group ids"));
}

TEST(SelfTest, AllowsEitherSignOfAZeroFromFma) {
  const std::string negated = "fma(a, b, -a) == 0.0f ? -fma(a, b, -a) : fma(a, b, -a)";
  EXPECT_THAT(self_test_failures(test::test_device(Encoding::automatic),
                                 changed({{"fma(a, b, -a)", negated}})),
              IsEmpty());
}

class SelfTestMemory : public testing::Test {
 protected:
  /// A folder of kernels whose self-test fails.
  static std::string broken_kernels() {
    const fs::path kernels = test::temporary_folder();
    fs::copy(test::source_folder() / "kernels", kernels, fs::copy_options::recursive);
    std::ofstream(kernels / "probe" / "self_test.cl") << changed({{"= clz(a)", "= clz(a | 1u)"}});
    return kernels.string();
  }

  fs::path folder_ = test::temporary_folder();
  test::ScopedVariable cache_{"CAPLET_CACHE", folder_.string()};
  Device device_ = test::test_device(Encoding::automatic);
};

/// Whether self_test runs anything on a device that has not been used yet.
bool runs() {
  const Device fresh = test::test_device(Encoding::automatic);
  self_test(fresh);
  return fresh.bytes_peak() > 0;
}

TEST_F(SelfTestMemory, RemembersThatItPassed) {
  EXPECT_TRUE(runs());
  EXPECT_FALSE(runs());
  {
    const test::ScopedVariable force("CAPLET_SELF_TEST", "1");
    EXPECT_TRUE(runs());
  }
  const test::ScopedVariable other_folder("CAPLET_CACHE", test::temporary_folder().string());
  EXPECT_TRUE(runs());
}

TEST_F(SelfTestMemory, AFailureNamesDeviceAndCheckEveryTime) {
  const test::ScopedVariable kernels("CAPLET_KERNELS", broken_kernels());
  for (int time = 0; time < 2; ++time) {
    try {
      self_test(device_);
      FAIL() << "passed";
    } catch (const RunError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(HasSubstr(device_.info().name),
                                               HasSubstr("\n  clz(a): with a = 0x0")));
    }
  }
}

TEST_F(SelfTestMemory, CanBeLeftOut) {
  const test::ScopedVariable kernels("CAPLET_KERNELS", broken_kernels());
  const test::ScopedVariable leave_out("CAPLET_SELF_TEST", "0");
  EXPECT_FALSE(runs());
}

}  // namespace
}  // namespace caplet
