// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// NanoVDB files, written here by their layout.
#include "import/detail/nanovdb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "import_text.h"

namespace caplet::test {
namespace {

using testing::HasSubstr;

/// Bytes with numbers at given places.
struct Memory {
  std::vector<char> bytes;
  template <class T>
  void put(std::size_t at, T value) {
    if (bytes.size() < at + sizeof value) bytes.resize(at + sizeof value);
    std::memcpy(&bytes[at], &value, sizeof value);
  }
};

constexpr std::uint64_t magic = 0x304244566f6e614e;
constexpr std::size_t root = 736, upper = root + 64 + 32, lower = upper + 8256 + 262144,
                      leaf = lower + 1088 + 32768, end = leaf + 2144;

/// A grid of voxels of 0.5, moved by (10, 0, 0): a leaf at (-8, 0, 8) with values 1000 x + 100 y +
/// z, and a constant tile of 8^3 at (0, 0, 8).
Memory grid() {
  Memory m;
  m.put<std::uint64_t>(0, magic);
  m.put<std::uint32_t>(16, 32u << 21);
  m.put<std::uint64_t>(32, end);
  m.put<std::uint32_t>(636, 1);
  const std::size_t map = 296;
  for (int k = 0; k < 3; ++k) m.put<double>(map + 88 + 32 * static_cast<std::size_t>(k), 0.5);
  m.put<double>(map + 88 + 144, 10);
  const double box[] = {6, 0, 4, 14, 4, 8};
  for (std::size_t k = 0; k < 6; ++k) m.put<double>(map + 264 + 8 * k, box[k]);
  m.put<std::uint64_t>(672 + 24, root - 672);
  m.put<std::uint32_t>(root + 24, 1);
  // The root has a tile of x = -8, whose 4096s are -1, and none of x = 0: the tile of that has
  // nodes of its own.
  const auto key = [](std::int32_t x) {
    return (std::uint64_t{static_cast<std::uint32_t>(x) >> 12} << 42);
  };
  m.put<std::uint64_t>(root + 64, key(-8));
  m.put<std::int64_t>(root + 72, upper - root);
  // x = -8 is the last of 32 in x, the last of 16, the last of 16.
  const auto child = [&](std::size_t node, std::size_t masks, std::size_t index, std::size_t table,
                         std::int64_t offset) {
    m.put<std::uint8_t>(node + 32 + masks + index / 8,
                        static_cast<std::uint8_t>(1u << (index % 8)));
    m.put<std::int64_t>(node + table + 8 * index, offset);
  };
  child(upper, 4096, 31 << 10, 8256, lower - upper);
  child(lower, 512, (15 << 8) + 1, 1088, leaf - lower);
  // A constant tile beside it, at y = 8.
  const std::size_t tile = (15 << 8) + (1 << 4) + 1;
  m.put<std::uint8_t>(lower + 32 + tile / 8, static_cast<std::uint8_t>(1u << (tile % 8)));
  m.put<float>(lower + 1088 + 8 * tile, 7);
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z)
        m.put<float>(leaf + 96 + 4 * static_cast<std::size_t>((x << 6) + (y << 3) + z),
                     static_cast<float>(1000 * x + 100 * y + z));
  m.bytes.resize(end);
  return m;
}

std::string file_of(const std::string& name, const Memory& of, bool zipped,
                    const std::string& grid_name = "density", std::uint32_t version = 32) {
  Memory out;
  std::vector<char> body = of.bytes;
  if (zipped) {
    uLongf length = compressBound(of.bytes.size());
    std::vector<char> packed(length);
    compress(reinterpret_cast<Bytef*>(packed.data()), &length,
             reinterpret_cast<const Bytef*>(of.bytes.data()), of.bytes.size());
    packed.resize(length);
    Memory sized;
    sized.put<std::uint64_t>(0, length);
    sized.bytes.insert(sized.bytes.end(), packed.begin(), packed.end());
    body = sized.bytes;
  }
  out.put<std::uint64_t>(0, magic);
  out.put<std::uint32_t>(8, version << 21);
  out.put<std::uint16_t>(12, 1);
  out.put<std::uint16_t>(14, zipped ? 1 : 0);
  out.put<std::uint64_t>(16, of.bytes.size());
  out.put<std::uint64_t>(24, body.size());
  out.put<std::uint32_t>(16 + 136, static_cast<std::uint32_t>(grid_name.size() + 1));
  out.bytes.resize(16 + 176);
  out.bytes.insert(out.bytes.end(), grid_name.begin(), grid_name.end());
  out.bytes.push_back(0);
  out.bytes.insert(out.bytes.end(), body.begin(), body.end());
  const std::string path = (test::temporary_folder() / name).string();
  std::ofstream(path, std::ios::binary)
      .write(out.bytes.data(), static_cast<std::streamsize>(out.bytes.size()));
  return path;
}

TEST(Nanovdb, GridsAreRead) {
  for (const bool zipped : {false, true}) {
    const SparseGridPointer read =
        read_nanovdb(file_of("sound.nvdb", grid(), zipped), "density", {});
    ASSERT_TRUE(read);
    ASSERT_EQ(read->bricks.size(), 2u);
    EXPECT_EQ(read->bricks[0], (std::array<std::int32_t, 3>{-1, 0, 1}));
    EXPECT_EQ(read->bricks[1], (std::array<std::int32_t, 3>{-1, 1, 1}));
    EXPECT_EQ(read->values[(3 * 8 + 2) * 8 + 5], 5203);  // z 3, y 2, x 5
    EXPECT_EQ(read->values[512 + 77], 7);
    EXPECT_EQ(read->medium_from_voxels * glm::dvec4(2, 4, 6, 1), glm::dvec4(11, 2, 3, 1));
    EXPECT_EQ(read->box.min, glm::dvec3(6, 0, 4));
    EXPECT_EQ(read->box.max, glm::dvec3(14, 4, 8));
  }
  EXPECT_FALSE(read_nanovdb(file_of("sound.nvdb", grid(), false), "temperature", {}));
}

TEST(Nanovdb, WhatIsBrokenIsSaid) {
  const auto said = [](const std::string& file) {
    return complaint_of([&] { read_nanovdb(file, "density", {}); });
  };
  EXPECT_THAT(said("none.nvdb"), HasSubstr("cannot be read"));
  Memory no_magic = grid();
  no_magic.put<std::uint64_t>(0, 5);
  EXPECT_THAT(said(file_of("a.nvdb", no_magic, false)), HasSubstr("is no NanoVDB grid"));
  Memory negative = grid();
  negative.put<float>(leaf + 96, -1);
  EXPECT_THAT(said(file_of("b.nvdb", negative, false)), HasSubstr("negative"));
  const auto changed = [](std::size_t at, std::uint32_t value) {
    Memory out = grid();
    out.put<std::uint32_t>(at, value);
    return file_of("c.nvdb", out, true);
  };
  EXPECT_THAT(
      said(changed(636, 4)),
      HasSubstr("has a grid of 32-bit integers: 32-bit floats and quantised ones are read"));
  EXPECT_THAT(said(changed(636, 999)), HasSubstr("has a grid of an unknown type"));
  EXPECT_THAT(said(changed(632, 1)),
              HasSubstr("has a level set (distances from a surface) where densities are wanted"));
  EXPECT_THAT(said(changed(root + 28, 0x3f800000)), HasSubstr("background is not 0"));
  Memory tile = grid();
  tile.put<std::int64_t>(root + 72, 0);
  EXPECT_EQ(said(file_of("c.nvdb", tile, false)), "");  // it is 0, and nothing is there
  tile.put<float>(root + 64 + 20, 0.5f);
  EXPECT_THAT(said(file_of("c.nvdb", tile, false)),
              HasSubstr("has a constant tile of 4096^3 voxels"));
  for (const float bad : {-1.0f, std::numeric_limits<float>::infinity()}) {
    Memory dark = grid();
    dark.put<float>(upper + 8256, bad);  // a constant tile of the upper node
    EXPECT_THAT(said(file_of("c.nvdb", dark, false)),
                HasSubstr("has values that are negative or not finite"));
  }
  const std::string other = file_of("c.nvdb", grid(), false);
  std::fstream(other, std::ios::in | std::ios::out | std::ios::binary).put('M');
  EXPECT_THAT(said(other), HasSubstr("is no NanoVDB file"));
  for (const std::uint32_t version : {31u, 33u})
    EXPECT_THAT(said(file_of("c.nvdb", grid(), false, "density", version)),
                HasSubstr("is of NanoVDB version " + std::to_string(version)));
  const std::string blosc = file_of("c.nvdb", grid(), true);
  std::fstream(blosc, std::ios::in | std::ios::out | std::ios::binary).seekp(14).put(2);
  EXPECT_THAT(said(blosc), HasSubstr("BLOSC"));
  const std::string broken = file_of("c.nvdb", grid(), true);
  std::fstream(broken, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(16 + 176 + 8 + 8 + 40)
      .put(77);
  EXPECT_THAT(said(broken), HasSubstr("compression is broken"));
  Memory twice = grid();
  for (std::size_t i = 1024; i < 4096; ++i) {
    twice.put<std::uint8_t>(lower + 32 + 512 + i / 8, 0xff);
    twice.put<std::int64_t>(lower + 1088 + 8 * i, leaf - lower);
  }
  EXPECT_THAT(said(file_of("c.nvdb", twice, false)), HasSubstr("has nodes that are used twice"));
  // Shorter by anything, or with an offset to anywhere, it says so and does not read on.
  for (const std::size_t length : {std::size_t{100}, std::size_t{700}, root + 70, upper + 100,
                                   lower + 5, leaf + 50, end - 1}) {
    Memory cut = grid();
    cut.bytes.resize(length);
    EXPECT_THAT(said(file_of("d.nvdb", cut, false)), HasSubstr("ends in the middle of a grid"))
        << length;
  }
  for (const std::int64_t offset :
       {std::int64_t{-1} << 60, std::int64_t{1} << 62, std::int64_t{-100000000}}) {
    Memory astray = grid();
    astray.put<std::int64_t>(root + 72, offset);
    EXPECT_THAT(said(file_of("e.nvdb", astray, false)), HasSubstr("ends in the middle of a grid"));
  }
}

// The memory of grids alone, one after the other.
TEST(Nanovdb, RawGridsAreRead) {
  Memory first = grid(), second = grid();
  for (Memory* one : {&first, &second}) one->put<std::uint64_t>(0, 0x314244566f6e614e);
  std::memcpy(&first.bytes[40], "temperature", 11);
  std::memcpy(&second.bytes[40], "density", 7);
  second.put<float>(leaf + 96, 3);
  const std::string path = (test::temporary_folder() / "raw.nvdb").string();
  const auto write = [&](std::size_t less) {
    std::ofstream out(path, std::ios::binary);
    out.write(first.bytes.data(), static_cast<std::streamsize>(first.bytes.size()));
    out.write(second.bytes.data(), static_cast<std::streamsize>(second.bytes.size() - less));
  };
  write(0);
  EXPECT_EQ(read_nanovdb(path, "density", {})->values[0], 3);
  EXPECT_EQ(read_nanovdb(path, "temperature", {})->values[0], 0);
  EXPECT_FALSE(read_nanovdb(path, "flames", {}));
  write(1);
  EXPECT_THAT(complaint_of([&] { read_nanovdb(path, "density", {}); }),
              HasSubstr("ends in the middle of a grid"));
}

// Codes times a step and the least value; those of few bits from the low ones of a byte up.
TEST(Nanovdb, QuantisedGridsAreRead) {
  for (const std::uint32_t type : {13u, 14u, 15u, 16u, 17u, 18u}) {
    const unsigned bits = type < 16 ? 4u << (type - 13) : type == 16 ? 1 : type == 17 ? 2 : 16;
    Memory m = grid();
    m.put<std::uint32_t>(636, std::min(type, 16u));
    const std::array<std::uint8_t, 3> flags{0, 1, 4};
    if (type >= 16)
      m.put<std::uint8_t>(leaf + 15, static_cast<std::uint8_t>(flags[type - 16] << 5));
    m.put<float>(leaf + 80, 0.25f);
    m.put<float>(leaf + 84, 0.5f);
    std::fill(m.bytes.begin() + static_cast<std::ptrdiff_t>(leaf + 96), m.bytes.end(), '\0');
    const auto code = [&](unsigned i) { return (i * 2654435761u >> 7) & ((1u << bits) - 1); };
    for (unsigned i = 0; i < 512; ++i)
      for (unsigned b = 0; b < bits; ++b)
        if ((code(i) >> b & 1) != 0)
          m.bytes[leaf + 96 + (i * bits + b) / 8] = static_cast<char>(
              m.bytes[leaf + 96 + (i * bits + b) / 8] | 1 << ((i * bits + b) % 8));
    m.bytes.resize(leaf + 96 + 64 * bits);
    const SparseGridPointer read = read_nanovdb(file_of("quantised.nvdb", m, true), "density", {});
    for (unsigned x = 0; x < 8; ++x)
      for (unsigned y = 0; y < 8; ++y)
        for (unsigned z = 0; z < 8; ++z)
          ASSERT_EQ(read->values[(z * 8 + y) * 8 + x],
                    0.25f + 0.5f * static_cast<float>(code(x * 64 + y * 8 + z)))
              << type;
  }
}

// A file by another program (fog.txt): 20 x 17 x 10 voxels of 1/8 from (-1, 0.5, 2) on.
TEST(Nanovdb, AFileByAnotherWriter) {
  const std::string file = std::string(CAPLET_IMPORT_TESTS) + "/fog.nvdb";
  const SparseGridPointer read = read_nanovdb(file, "density", {});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->box.min, glm::dvec3(-1, 0.5, 2));
  EXPECT_EQ(read->medium_from_voxels * glm::dvec4(4, 8, 16, 1), glm::dvec4(-0.5, 1.5, 4, 1));
  int inside = 0;
  for (std::size_t i = 0; i < read->bricks.size(); ++i)
    for (int k = 0; k < 512; ++k) {
      const int x = 8 * read->bricks[i][0] + k % 8, y = 8 * read->bricks[i][1] + k / 8 % 8,
                z = 8 * read->bricks[i][2] + k / 64;
      const bool in = x >= 0 && y >= 0 && z >= 0 && x < 20 && y < 17 && z < 10;
      const double round = 1 - ((x - 9.5) * (x - 9.5) / 100 + (y - 8.0) * (y - 8.0) / 70 +
                                (z - 4.5) * (z - 4.5) / 25);
      const double expected =
          in ? std::max(0.0, round) * (1 + 0.25 * std::sin(x + 2 * y + 3 * z)) : 0;
      ASSERT_NEAR(read->values[512 * i + static_cast<std::size_t>(k)], expected, 1e-6)
          << x << " " << y << " " << z;
      inside += in;
    }
  EXPECT_EQ(inside, 20 * 17 * 10);
}

TEST(Nanovdb, IsAMediumOfAScene) {
  const std::string file = file_of("medium.nvdb", grid(), true);
  const Scene scene = world_of(
      "Translate 1 2 3 MakeNamedMedium \"v\" \"string type\" \"nanovdb\" \"string filename\" \"" +
      file +
      "\" \"float LeScale\" 3 \"float temperaturecutoff\" 5\nMediumInterface \"v\" \"\" Shape "
      "\"sphere\"");
  const auto& medium = std::get<NanovdbMedium>(scene.media.at(0).model);
  EXPECT_EQ(medium.radiance_scale, 3);
  EXPECT_EQ(medium.temperature_offset, 5);
  EXPECT_EQ(medium.world_from_medium[3], glm::dvec4(1, 2, 3, 1));
  EXPECT_FALSE(medium.temperature);
  EXPECT_THAT(complaints("WorldBegin\nMakeNamedMedium \"v\" \"string type\" \"nanovdb\" \"string "
                         "filename\" \"x.nvdb\"\nShape \"sphere\"")
                  .at(0),
              HasSubstr("scene.pbrt:2:45: x.nvdb: cannot be read"));
}

}  // namespace
}  // namespace caplet::test
