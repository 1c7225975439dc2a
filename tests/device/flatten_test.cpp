// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The flattener on small sets of files.
#include "device/detail/flatten.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <stdexcept>

namespace caplet {
namespace {

using testing::HasSubstr;

using Files = std::map<std::string, std::string>;

std::string flattened(const std::string& text, const Files& files = {}) {
  return flatten(text, "text", [&files](const std::string& path) -> std::optional<std::string> {
    const auto at = files.find(path);
    if (at == files.end()) return std::nullopt;
    return at->second;
  });
}

std::string failure(const std::string& text, const Files& files = {}) {
  try {
    return flattened(text, files);
  } catch (const std::logic_error& error) {
    return error.what();
  }
}

TEST(Flatten, LeavesOtherLinesAlone) {
  EXPECT_EQ(flattened("int a;\n#define X 1\n#pragma OPENCL FP_CONTRACT OFF\n"),
            "#line 1 \"text\"\nint a;\n#define X 1\n#pragma OPENCL FP_CONTRACT OFF\n");
  EXPECT_EQ(flattened("// #include \"missing\"\n#include <missing>\n"),
            "#line 1 \"text\"\n// #include \"missing\"\n#include <missing>\n");
}

TEST(Flatten, MarksWhereLinesComeFrom) {
  EXPECT_EQ(flattened("one\n  # include \"a.cl\"  // why\nthree", {{"a.cl", "A"}}),
            "#line 1 \"text\"\none\n#line 1 \"kernels/a.cl\"\nA\n#line 3 \"text\"\nthree\n");
}

TEST(Flatten, TakesAListAsOftenAsItIsNamed) {
  const std::string out = flattened("#include \"l.def\"\n#include \"l.def\"\n", {{"l.def", "ROW(x)\n"}});
  EXPECT_EQ(out,
            "#line 1 \"text\"\n#line 1 \"kernels/l.def\"\nROW(x)\n#line 2 \"text\"\n#line 1 \"kernels/l.def\"\nROW(x)\n#line 3 "
            "\"text\"\n");
}

TEST(Flatten, GoesIntoIncludedFiles) {
  EXPECT_THAT(flattened("#include \"a\"", {{"a", "#include \"d/b\"\n"}, {"d/b", "deep\n"}}),
              HasSubstr("#line 1 \"kernels/a\"\n#line 1 \"kernels/d/b\"\ndeep\n#line 2 \"kernels/a\"\n#line 2 \"text\"\n"));
}

TEST(Flatten, LeavesOutWhatIsForTheHost) {
  EXPECT_EQ(
      flattened("#ifdef __cplusplus\n#include \"missing\"\n#if 1\n#include \"missing\"\n#endif\n#else\nkernel\n#endif\nend\n"),
      "#line 1 \"text\"\n#ifdef __cplusplus\n\n#if 1\n\n#endif\n#else\nkernel\n#endif\nend\n");
  EXPECT_THAT(flattened("#ifndef __cplusplus\n#include \"a\"\n#else\n#include \"missing\"\n#endif\n", {{"a", "A\n"}}),
              HasSubstr("A\n"));
  EXPECT_THAT(failure("#ifdef OTHER\n#include \"missing\"\n#endif\n"), HasSubstr("text:2: "));
  EXPECT_THAT(failure("#ifdef __cplusplus\n#endif\n#include \"missing\"\n"), HasSubstr("text:3: "));
}

TEST(Flatten, ErrorsHaveAPlace) {
  EXPECT_THAT(failure("\n#include \"a\"\n", {{"a", "x\ny\n#include \"b\"\n"}}),
              HasSubstr("kernels/a:3: there is no kernel file 'b'"));
  EXPECT_THAT(failure("#include \"a\n"), HasSubstr("text:1: malformed #include"));
  EXPECT_THAT(failure("#include NAME\n"), HasSubstr("text:1: malformed #include"));
  EXPECT_THAT(failure("#include\n"), HasSubstr("text:1: malformed #include"));
}

TEST(Flatten, CirclesAreNamed) {
  EXPECT_THAT(failure("#include \"a\"\n", {{"a", "#include \"b\"\n"}, {"b", "\n#include \"a\"\n"}}),
              HasSubstr("kernels/b:2: #include goes round in a circle: a -> b -> a"));
}

}  // namespace
}  // namespace caplet
