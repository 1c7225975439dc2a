// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Legacy VTK: every kind of attribute and every type of number of the format, wanted or passed
// over.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "import/detail/fibres.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using testing::ElementsAre;

std::string head(const std::string& kind) {
  return "# vtk DataFile Version 5.1\nlines\n" + kind + "\nDATASET POLYDATA\n";
}
const std::string metadata =
    "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1 \n\n";
// VTK's writer puts what it knows of an array behind it, that of the points too.
const std::string geometry =
    "POINTS 2 float\n0 0 0 1 0 0\n" + metadata +
    "LINES 2 2\nOFFSETS vtktypeint64\n0 2\nCONNECTIVITY vtktypeint64\n0 1\n";

std::vector<float> values(const std::string& bytes, const std::string& wanted,
                          bool of_points = true) {
  FibreScalars out;
  out.wanted = wanted;
  read_vtk(bytes, "a.vtk", &out);
  EXPECT_EQ(out.name, wanted);
  EXPECT_EQ(out.of_points, of_points) << wanted;
  return out.values;
}

// VTK's File Formats, "Dataset Attribute Format": all sections, each with numbers of its own.
TEST(VtkAttributes, OfAllKinds) {
  const std::string text = head("ASCII") + geometry + "CELL_DATA 1\n" + metadata +
                           "SCALARS load int\nLOOKUP_TABLE default\n7\nPOINT_DATA 2\n" + metadata +
                           "SCALARS one float\nLOOKUP_TABLE mine\n1 2\n" + metadata +
                           "LOOKUP_TABLE mine 2\n0 0 0 1  1 1 1 1\n" +
                           "SCALARS two double 2\nLOOKUP_TABLE default\n3 4 5 6\nCOLOR_SCALARS "
                           "paint 3\n0 .5 1 1 .5 0\nVECTORS way float\n1 2 3 4 5 "
                           "6\n" +
                           metadata +
                           "NORMALS up float\n0 0 1 0 1 0\nTEXTURE_COORDINATES uv 2 float\n.1 .2 "
                           ".3 .4\nTENSORS pull float\n1 2 3 4 5 6 7 8 9\n" +
                           "1 2 3 4 5 6 7 8 9\nTENSORS6 push float\n1 2 3 4 5 6\n1 2 3 4 5 "
                           "6\nGLOBAL_IDS id vtkIdType\n0 1\nFIELD more 3\n" +
                           "a%20b 1 2 float\n8 +9\n" + metadata +
                           "c 3 2 unsigned_char\n1 2 3 4 5 6\nlast 1 2 short\n-1 -2\n" + metadata;
  EXPECT_THAT(values(text, "load", false), ElementsAre(7));
  EXPECT_THAT(values(text, "one"), ElementsAre(1, 2));
  EXPECT_THAT(values(text, "two[0]"), ElementsAre(3, 5));
  EXPECT_THAT(values(text, "two[1]"), ElementsAre(4, 6));
  EXPECT_THAT(values(text, "way[2]"), ElementsAre(3, 6));
  EXPECT_THAT(values(text, "up[1]"), ElementsAre(0, 1));
  EXPECT_THAT(values(text, "a b"), ElementsAre(8, 9));
  EXPECT_THAT(values(text, "c[1]"), ElementsAre(2, 5));
  EXPECT_THAT(values(text, "last"), ElementsAre(-1, -2));
}

/// The bytes of numbers, the most significant first.
template <class T>
std::string big(std::initializer_list<T> numbers) {
  std::string out;
  for (const T number : numbers) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &number, sizeof(T));
    if (std::endian::native == std::endian::little) std::reverse(bytes, bytes + sizeof(T));
    out.append(bytes, sizeof(T));
  }
  return out;
}

TEST(VtkAttributes, OfAllTypesInBinary) {
  const std::string points = head("BINARY") + "POINTS 2 float\n" + big<float>({0, 0, 0, 1, 0, 0}) +
                             "\nLINES 2 2\nOFFSETS vtktypeint64\n" + big<std::int64_t>({0, 2}) +
                             "\nCONNECTIVITY vtktypeint64\n" + big<std::int64_t>({0, 1}) +
                             "\nPOINT_DATA 2\n";
  const std::pair<const char*, std::string> types[] = {
      {"float", big<float>({1.5F, -2})},
      {"double", big<double>({1.5, -2})},
      {"char", big<std::int8_t>({3, -2})},
      {"signed_char", big<std::int8_t>({3, -2})},
      {"unsigned_char", big<std::uint8_t>({3, 254})},
      {"short", big<std::int16_t>({300, -2})},
      {"unsigned_short", big<std::uint16_t>({300, 65534})},
      {"int", big<std::int32_t>({70000, -2})},
      {"unsigned_int", big<std::uint32_t>({70000, 4294967294U})},
      {"vtkIdType", big<std::int32_t>({70000, -2})},
      {"long", big<std::int64_t>({70000, -2})},
      {"unsigned_long", big<std::uint64_t>({70000, 1ULL << 40})},
      {"vtktypeint64", big<std::int64_t>({70000, -2})},
      {"vtktypeuint64", big<std::uint64_t>({70000, 1ULL << 40})}};
  const float first[] = {1.5F,  1.5F,  3,     3,     3,     300,   300,
                         70000, 70000, 70000, 70000, 70000, 70000, 70000};
  const float second[] = {-2,
                          -2,
                          -2,
                          -2,
                          254,
                          -2,
                          65534,
                          -2,
                          4294967294.0F,
                          -2,
                          -2,
                          1099511627776.0F,
                          -2,
                          1099511627776.0F};
  std::string all = points;
  for (const auto& [type, bytes] : types)
    all +=
        std::string("SCALARS s_") + type + " " + type + "\nLOOKUP_TABLE default\n" + bytes + "\n";
  for (std::size_t i = 0; i < std::size(types); ++i)
    EXPECT_THAT(values(all, std::string("s_") + types[i].first), ElementsAre(first[i], second[i]))
        << types[i].first;
  // Bits of all components, packed from the highest of a byte; what follows begins at the next
  // byte.
  const std::string bits = points + "SCALARS flags bit 5\nLOOKUP_TABLE default\n" + "\x4a\x40" +
                           "\nSCALARS after float\nLOOKUP_TABLE default\n" + big<float>({5, 6}) +
                           "\n";
  EXPECT_THAT(values(bits, "flags[1]"), ElementsAre(1, 1));  // 01001 01001
  EXPECT_THAT(values(bits, "flags[3]"), ElementsAre(0, 0));
  EXPECT_THAT(values(bits, "flags[4]"), ElementsAre(1, 1));
  EXPECT_THAT(values(bits, "after"), ElementsAre(5, 6));
}

}  // namespace
}  // namespace caplet
