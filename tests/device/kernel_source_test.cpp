// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Kernel texts from the embedded table and from a folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>

#include "device/detail/embedded.h"
#include "device/device.h"
#include "support/data.h"
#include "support/environment.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

TEST(KernelSource, EveryKernelFileIsEmbeddedUnaltered) {
  const fs::path root = test::source_folder() / "kernels";
  std::set<std::string> on_disk;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".cl" || extension == ".h" || extension == ".def")
      on_disk.insert(fs::relative(entry.path(), root).generic_string());
  }
  std::set<std::string> embedded;
  for (const EmbeddedFile& file : embedded_kernels()) {
    embedded.insert(std::string(file.path));
    std::ifstream in(root / file.path, std::ios::binary);
    EXPECT_EQ(file.text, (std::string{std::istreambuf_iterator<char>(in), {}})) << file.path;
  }
  EXPECT_EQ(embedded, on_disk);
}

TEST(KernelSource, StagesGoByTheirNameOtherFilesByTheirPath) {
  EXPECT_THAT(kernel_source("kernel"), StartsWith("#line 1 \"kernels/stages/kernel.cl\"\n"));
  EXPECT_THAT(kernel_source("shared/records.h"),
              StartsWith("#line 1 \"kernels/shared/records.h\"\n"));
  EXPECT_THAT(kernel_source("shared/records.h"), testing::Not(HasSubstr("#include \"")));
  EXPECT_THROW(kernel_source("no_such_stage"), std::logic_error);
  EXPECT_THROW(kernel_source("shared/no_such_file.h"), std::logic_error);
}

TEST(KernelSource, TextsMayIncludeKernelFiles) {
  EXPECT_THAT(flatten_kernels("#include \"math/vector.cl\"\nlast\n"),
              HasSubstr("frame_from_normal"));
  EXPECT_THROW(flatten_kernels("#include \"no/such.cl\"\n"), std::logic_error);
}

TEST(KernelSource, AFolderTakesTheTablesPlace) {
  const fs::path folder = test::temporary_folder();
  fs::create_directories(folder / "stages");
  std::ofstream(folder / "stages" / "mine.cl") << "#include \"other.h\"\n";
  std::ofstream(folder / "other.h") << "from disk\n";
  const test::ScopedVariable kernels("CAPLET_KERNELS", folder.string());
  EXPECT_EQ(kernel_source("mine"),
            "#line 1 \"kernels/stages/mine.cl\"\n#line 1 \"kernels/other.h\"\nfrom disk\n#line 2 "
            "\"kernels/stages/mine.cl\"\n");
  EXPECT_THROW(kernel_source("kernel"), std::logic_error);
  EXPECT_THROW(kernel_source("stages/"), std::logic_error);
}

TEST(KernelSource, AMissingFolderIsAnError) {
  const test::ScopedVariable kernels("CAPLET_KERNELS", "/no/such/folder");
  EXPECT_THROW(kernel_source("kernel"), RunError);
}

}  // namespace
}  // namespace caplet
