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

std::string flattened(const std::string& text, const Files& files = {}, const RowMasks& rows = {}) {
  const FileReader read = [&files](const std::string& path) -> std::optional<std::string> {
    const auto at = files.find(path);
    if (at == files.end()) return std::nullopt;
    return at->second;
  };
  return flatten(text, "text", read, rows);
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
  const std::string out =
      flattened("#include \"l.def\"\n#include \"l.def\"\n", {{"l.def", "ROW(x)\n"}});
  EXPECT_EQ(out,
            "#line 1 \"text\"\n#line 1 \"kernels/l.def\"\nROW(x)\n#line 2 \"text\"\n#line 1 "
            "\"kernels/l.def\"\nROW(x)\n#line 3 "
            "\"text\"\n");
}

TEST(Flatten, TakesAGuardedFileOnce) {
  const Files files = {{"g.h", "// why\n#ifndef G\n#define G\n#if 1\none\n#endif\n#endif\n"},
                       {"a", "#include \"g.h\"\n"}};
  EXPECT_EQ(flattened("#include \"g.h\"\n#include \"a\"\nend\n", files),
            "#line 1 \"text\"\n#line 1 \"kernels/g.h\"\n// why\n#ifndef G\n#define G\n#if "
            "1\none\n#endif\n#endif\n#line 2 \"text\"\n"
            "#line 1 \"kernels/a\"\n\n#line 3 \"text\"\nend\n");
  // What begins otherwise is no guard.
  EXPECT_THAT(flattened("#include \"n\"\n#include \"n\"\n",
                        {{"n", "#ifndef N\nmore\n#define N\n#endif\n"}}),
              testing::ContainsRegex("more(.|\n)*more"));
}

// The preprocessor would not have seen the first of the two.
TEST(Flatten, AGuardedFileUnderAConditionDoesNotCount) {
  const Files files = {{"g.h", "#ifndef G\n#define G\nguarded\n#endif\n"},
                       {"h.h", "#ifndef H\n#define H\n#include \"g.h\"\n#endif\n"}};
  EXPECT_THAT(flattened("#if 0\n#include \"g.h\"\n#endif\n#include \"g.h\"\n", files),
              testing::ContainsRegex("guarded(.|\n)*guarded"));
  EXPECT_THAT(flattened("#ifdef X\n#include \"h.h\"\n#else\n#endif\n#include \"g.h\"\n", files),
              testing::ContainsRegex("guarded(.|\n)*guarded"));
  EXPECT_THAT(flattened("#include \"h.h\"\n#include \"g.h\"\n", files),
              testing::Not(testing::ContainsRegex("guarded(.|\n)*guarded")));
}

const Files list_of_three = {{"shared/pets.def",
                              "// PET(name)\n#ifndef FIELD\n#endif\nPET(cat, 1)\nFIELD(cat, "
                              "x)\nPET_END(cat)\nPET(dog, 2)  // barks\n"
                              "FIELD(dog, y)\nKEPT(dog, z)\nCOMPOUND(herd)\n#undef FIELD\n"},
                             {"pets/a_cat.cl", "meow\n"},
                             {"pets/a_dog.cl", "wuff\n"}};

TEST(Flatten, PutsInTheFilesOfTheRowsOfAList) {
  EXPECT_EQ(flattened("#include \"pets/a_{pets}.cl\"\nend\n", list_of_three),
            "#line 1 \"text\"\n#line 1 \"kernels/pets/a_cat.cl\"\nmeow\n#line 1 "
            "\"kernels/pets/a_dog.cl\"\nwuff\n#line 2 "
            "\"text\"\nend\n");
  EXPECT_EQ(flattened("#include \"pets/a_{pets}.cl\"\nend\n", list_of_three, {{"pets", 2}}),
            "#line 1 \"text\"\n#line 1 \"kernels/pets/a_dog.cl\"\nwuff\n#line 2 \"text\"\nend\n");
  EXPECT_EQ(flattened("#include \"pets/a_{pets}.cl\"\nend\n", list_of_three, {{"pets", 4}}),
            "#line 1 \"text\"\n\nend\n");
  EXPECT_THAT(failure("#include \"pets/a_{pets}.cl\"\n", {{"shared/pets.def", "PET(cow)\n"}}),
              HasSubstr("text:1: there is no kernel file 'pets/a_cow.cl'"));
  EXPECT_THAT(failure("#include \"pets/a_{cars}.cl\"\n"),
              HasSubstr("text:1: there is no kernel file 'shared/cars.def'"));
}

TEST(Flatten, PutsInTheRowsThatThereAre) {
  EXPECT_EQ(flattened("#include \"rows/pets.def\"\nend\n", list_of_three, {{"pets", 2}}),
            "#line 1 \"text\"\n#line 1 \"kernels/shared/pets.def\"\n\n#ifndef "
            "FIELD\n#endif\n\n\n\nPET(dog, 2)  // "
            "barks\nFIELD(dog, y)\nKEPT(dog, z)\n\n#undef "
            "FIELD\n#line 2 \"text\"\nend\n");
  const std::string all = flattened("#include \"rows/pets.def\"\n", list_of_three, {{"others", 0}});
  for (const char* row :
       {"PET(cat, 1)\nFIELD(cat, x)\nPET_END(cat)", "PET(dog, 2)", "COMPOUND(herd)"})
    EXPECT_THAT(all, HasSubstr(row));
  std::string many;
  for (int i = 0; i < 65; ++i) many += "PET(p" + std::to_string(i) + ")\n";
  EXPECT_THAT(failure("#include \"rows/pets.def\"\n", {{"shared/pets.def", many}}),
              HasSubstr("pets.def has more than 64 rows"));
}

TEST(Flatten, DefinesTheMasksOfListsThatTheTextSpeaksOf) {
  EXPECT_EQ(flattened("a CAPLET_PETS\n", {}, {{"cars", 1}, {"pets", 0x8000000000000002}}),
            "#define CAPLET_PETS 0x8000000000000002UL\n#line 1 \"text\"\na CAPLET_PETS\n");
  EXPECT_EQ(flattened("a CAPLET_PETS\n"), "#line 1 \"text\"\na CAPLET_PETS\n");
}

TEST(Flatten, GoesIntoIncludedFiles) {
  EXPECT_THAT(flattened("#include \"a\"", {{"a", "#include \"d/b\"\n"}, {"d/b", "deep\n"}}),
              HasSubstr("#line 1 \"kernels/a\"\n#line 1 \"kernels/d/b\"\ndeep\n#line 2 "
                        "\"kernels/a\"\n#line 2 \"text\"\n"));
}

TEST(Flatten, LeavesOutWhatIsForTheHost) {
  EXPECT_EQ(
      flattened("#ifdef __cplusplus\n#include \"missing\"\n#if 1\n#include "
                "\"missing\"\n#endif\n#else\nkernel\n#endif\nend\n"),
      "#line 1 \"text\"\n#ifdef __cplusplus\n\n#if 1\n\n#endif\n#else\nkernel\n#endif\nend\n");
  EXPECT_THAT(
      flattened("#ifndef __cplusplus\n#include \"a\"\n#else\n#include \"missing\"\n#endif\n",
                {{"a", "A\n"}}),
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
