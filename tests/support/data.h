// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where tests find input. The shared data folder lies beside the checkout (or where CAPLET_DATA
// says).
#pragma once

#include <filesystem>
#include <string>

namespace caplet::test {

/// The folder of shared data (".../shared/data"); empty when there is none.
std::filesystem::path data_folder();
/// The repository's root, or the folder that CAPLET_SOURCE names.
std::filesystem::path source_folder();
/// True where a run without the shared data is a failure (CAPLET_REQUIRE_DATA).
bool data_required();
/// A fresh folder that is removed at the end of the process.
std::filesystem::path temporary_folder();

}  // namespace caplet::test

/// Skips the test, with the reason printed, when the shared data folder is not there; fails it
/// where data_required.
#define CAPLET_NEEDS_DATA()                                                                 \
  do {                                                                                      \
    if (::caplet::test::data_folder().empty()) {                                            \
      if (::caplet::test::data_required())                                                  \
        FAIL() << "needs the shared data folder (beside the checkout, or CAPLET_DATA)";     \
      GTEST_SKIP() << "needs the shared data folder (beside the checkout, or CAPLET_DATA)"; \
    }                                                                                       \
  } while (false)
