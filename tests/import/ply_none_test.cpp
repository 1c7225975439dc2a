// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A build without assimp says so.
#include <gtest/gtest.h>

#include "import/detail/ply.h"
#include "import_text.h"

namespace caplet::test {
namespace {

TEST(Ply, IsRefusedByName) {
  const std::string triangle =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(complaint_of([&] { parse_ply("m.ply", triangle); }),
            "m.ply: this build cannot read PLY meshes (CAPLET_WITH_PLY is off)");
}

}  // namespace
}  // namespace caplet::test
