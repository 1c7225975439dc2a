// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// NanoVDB files (Museth, "NanoVDB: A GPU-friendly and portable VDB data structure for real-time
// rendering and simulation", 2021). A segment has a header, the metadata of each grid, and the
// grids as they are in memory; from version 32.6 on a file may hold grids alone. Layouts are those
// of version 32.
#include "import/detail/nanovdb.h"

#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>

#include "base/reading.h"

namespace caplet {

namespace {

// The magic numbers are "NanoVDB0", and in newer files "NanoVDB1" for grids and "NanoVDB2" for
// files.
constexpr std::uint64_t magic = 0x304244566f6e614e, magic_grid = 0x314244566f6e614e,
                        magic_mask = 0x00ffffffffffffff;
constexpr std::size_t file_header_bytes = 16, meta_bytes = 176, grid_bytes = 672;
constexpr std::uint32_t type_float = 1, type_fp4 = 13, type_fpn = 16, class_level_set = 1;
// Names are indexed by type number; types of newer versions have none.
constexpr const char* type_names[] = {"an unknown type",
                                      "32-bit floats",
                                      "64-bit floats",
                                      "16-bit integers",
                                      "32-bit integers",
                                      "64-bit integers",
                                      "vectors of 32-bit floats",
                                      "vectors of 64-bit floats",
                                      "masks",
                                      "16-bit floats",
                                      "32-bit unsigned integers",
                                      "booleans",
                                      "colours of 8 bits",
                                      "4-bit quantised floats",
                                      "8-bit quantised floats",
                                      "16-bit quantised floats",
                                      "quantised floats of varying bits",
                                      "vectors of four 32-bit floats",
                                      "vectors of four 64-bit floats",
                                      "indices",
                                      "indices of active values",
                                      "indices with a mask",
                                      "indices of active values with a mask",
                                      "indices of points"};
constexpr std::uint16_t codec_none = 0, codec_zip = 1;
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 34;

/// Reads numbers from memory with bounds checks.
class GridBytes {
 public:
  GridBytes(const std::vector<char>& bytes, const SourceLocation& where, const std::string& file)
      : bytes_(bytes), where_(where), file_(file) {}

  template <class T>
  T at(std::uint64_t offset) const {
    need(offset, sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof(T));
    return value;
  }
  void need(std::uint64_t offset, std::uint64_t count) const {
    if (offset > bytes_.size() || count > bytes_.size() - offset)
      fail("ends in the middle of a grid");
  }
  std::uint64_t size() const { return bytes_.size(); }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(where_, file_ + ": " + what);
  }

 private:
  const std::vector<char>& bytes_;
  SourceLocation where_;
  std::string file_;
};

/// Converts a grid in memory to bricks.
class GridReader {
 public:
  GridReader(const GridBytes& bytes) : bytes_(bytes) {}

  SparseGrid read() {
    if ((bytes_.at<std::uint64_t>(0) & magic_mask) != (magic & magic_mask))
      bytes_.fail("is no NanoVDB grid");
    type_ = bytes_.at<std::uint32_t>(636);
    if (bytes_.at<std::uint32_t>(632) == class_level_set)
      bytes_.fail("has a level set (distances from a surface) where densities are wanted");
    if (type_ != type_float && !(type_ >= type_fp4 && type_ <= type_fpn))
      bytes_.fail("has a grid of " +
                  std::string(type_ < std::size(type_names) ? type_names[type_] : type_names[0]) +
                  ": 32-bit floats and quantised ones are read");
    const std::uint64_t map =
        40 + 256;  // offset after magic, checksum, version, flags, index, count, size and name
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        out_.medium_from_voxels[c][r] =
            bytes_.at<double>(map + 88 + 8 * static_cast<std::uint64_t>(3 * r + c));
      out_.medium_from_voxels[3][r] =
          bytes_.at<double>(map + 88 + 144 + 8 * static_cast<std::uint64_t>(r));
      out_.box.min[r] = bytes_.at<double>(map + 264 + 8 * static_cast<std::uint64_t>(r));
      out_.box.max[r] = bytes_.at<double>(map + 264 + 24 + 8 * static_cast<std::uint64_t>(r));
    }
    const std::uint64_t root = grid_bytes + bytes_.at<std::uint64_t>(grid_bytes + 24);
    const auto tiles = bytes_.at<std::uint32_t>(root + 24);
    if (bytes_.at<float>(root + 28) != 0) bytes_.fail("has a grid whose background is not 0");
    bytes_.need(root + root_bytes, std::uint64_t{32} * tiles);
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const std::uint64_t tile = root + root_bytes + std::uint64_t{32} * i;
      const auto key = bytes_.at<std::uint64_t>(tile);
      const auto child = bytes_.at<std::int64_t>(tile + 8);
      // The key has 21 bits each of x, y and z, divided by 4096.
      const auto part = [&](int shift) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> shift & 0x1fffff) << 12);
      };
      const Coordinates low{part(42), part(21), part(0)};
      if (child != 0)
        node<5>(at(root, child), low);
      else if (bytes_.at<float>(tile + 20) != 0)
        bytes_.fail("has a constant tile of 4096^3 voxels");
    }
    return std::move(out_);
  }

 private:
  using Coordinates = std::array<std::int32_t, 3>;
  static constexpr std::uint64_t root_bytes = 64;

  static std::uint64_t at(std::uint64_t node, std::int64_t offset) {
    return node + static_cast<std::uint64_t>(offset);
  }

  /// The tree has 32^3 nodes over 16^3 nodes over leaves of 8^3 voxels.
  template <int Log>
  void node(std::uint64_t begin, const Coordinates& low) {
    constexpr std::uint64_t children = std::uint64_t{1} << (3 * Log), mask = children / 8;
    constexpr std::uint64_t child_mask = 32 + mask, table = (32 + 2 * mask + 16 + 31) / 32 * 32;
    constexpr int side = Log == 5 ? 128 : 8;
    bytes_.need(begin, table + 8 * children);
    for (std::uint64_t i = 0; i < children; ++i) {
      const auto n = static_cast<std::int32_t>(i);
      constexpr std::int32_t most = (1 << Log) - 1;
      const Coordinates here{low[0] + side * (n >> 2 * Log), low[1] + side * (n >> Log & most),
                             low[2] + side * (n & most)};
      if ((bytes_.at<std::uint8_t>(begin + child_mask + i / 8) >> (i % 8) & 1) != 0) {
        const std::uint64_t child = at(begin, bytes_.at<std::int64_t>(begin + table + 8 * i));
        if constexpr (Log == 5)
          node<4>(child, here);
        else
          leaf(child, here);
      } else {
        constant(bytes_.at<float>(begin + table + 8 * i), here, side);
      }
    }
  }

  /// After its origin, flags and mask, a leaf has four statistics and the values; a quantised one
  /// has the minimum, the step, statistics and codes of 4, 8 or 16 bits, or of 1 to 16 bits by its
  /// flags.
  void leaf(std::uint64_t begin, const Coordinates& low) {
    constexpr std::uint64_t values = 96;
    int bits = 32;
    if (type_ == type_fpn)
      bits = 1 << (bytes_.at<std::uint8_t>(begin + 15) >> 5);
    else if (type_ != type_float)
      bits = 4 << (type_ - type_fp4);
    if (type_ == type_fpn && bits > 16) bytes_.fail("has values of more than 16 bits");
    const std::uint64_t size = values + 64 * static_cast<std::uint64_t>(bits);
    bytes_.need(begin, size);
    if (++leaves_ > bytes_.size() / size) bytes_.fail("has nodes that are used twice");
    const auto least = bytes_.at<float>(begin + 80), step = bytes_.at<float>(begin + 84);
    const auto value_of = [&](std::uint64_t i) {
      if (bits == 32) return bytes_.at<float>(begin + values + 4 * i);
      const std::uint64_t bit = i * static_cast<std::uint64_t>(bits), at = begin + values + bit / 8;
      const unsigned code = bits == 16
                                ? bytes_.at<std::uint16_t>(at)
                                : bytes_.at<std::uint8_t>(at) >> (bit % 8) & ((1u << bits) - 1);
      return static_cast<float>(code) * step + least;
    };
    std::vector<float>& to = brick(low);
    const std::size_t first = to.size() - 512;
    for (std::size_t i = 0; i < 512; ++i) {
      const float value = value_of(i);
      if (!std::isfinite(value) || value < 0)
        bytes_.fail("has values that are negative or not finite");
      // The order changes from x slowest to x fastest.
      to[first + ((i & 7) * 8 + (i >> 3 & 7)) * 8 + (i >> 6)] = value;
    }
  }

  void constant(float value, const Coordinates& low, int side) {
    if (!std::isfinite(value) || value < 0)
      bytes_.fail("has values that are negative or not finite");
    if (value == 0) return;
    for (int x = 0; x < side; x += 8)
      for (int y = 0; y < side; y += 8)
        for (int z = 0; z < side; z += 8) {
          std::vector<float>& to = brick({low[0] + x, low[1] + y, low[2] + z});
          std::fill(to.end() - 512, to.end(), value);
        }
  }

  /// Appends a brick at the end of all values.
  std::vector<float>& brick(const Coordinates& low) {
    if (out_.bricks.size() >= most_spanned_bricks / 16)
      bytes_.fail("has more than 8 million bricks of 8^3 voxels");
    out_.bricks.push_back({low[0] >> 3, low[1] >> 3, low[2] >> 3});
    out_.values.resize(out_.values.size() + 512);
    return out_.values;
  }

  const GridBytes& bytes_;
  std::uint32_t type_ = 0;
  std::uint64_t leaves_ = 0;
  SparseGrid out_;
};

std::vector<char> inflated(const std::vector<char>& from, std::uint64_t size,
                           const GridBytes& bytes) {
  std::vector<char> out(size);
  uLongf length = size;
  if (uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                 reinterpret_cast<const Bytef*>(from.data()), from.size()) != Z_OK ||
      length != size)
    bytes.fail("has a grid whose compression is broken");
  return out;
}

}  // namespace

SparseGridPointer read_nanovdb(const std::string& file, const std::string& name,
                               const SourceLocation& where) {
  begin_reading(file, where);
  std::ifstream stream;
  if (is_file(file, where))
    stream.open(file, std::ios::binary | std::ios::ate);  // opening a pipe would block
  if (!stream.is_open()) throw InputError(where, file + ": cannot be read");
  const auto total = static_cast<std::uint64_t>(stream.tellg());
  std::uint64_t at = 0;
  const std::vector<char> nothing;
  const GridBytes whole(nothing, where, file);
  const auto read = [&](std::uint64_t offset, std::uint64_t count) {
    if (offset > total || count > total - offset) whole.fail("ends in the middle of a grid");
    std::vector<char> out(count);
    stream.seekg(static_cast<std::streamoff>(offset));
    if (!stream.read(out.data(), static_cast<std::streamsize>(count))) whole.fail("cannot be read");
    return out;
  };
  const auto check_version = [&](std::uint32_t version) {
    if (version >> 21 != 32)
      whole.fail("is of NanoVDB version " + std::to_string(version >> 21) + ", not 32");
  };
  const auto grid_of = [&](const std::vector<char>& memory) {
    const GridBytes bytes(memory, where, file);
    SparseGrid grid = GridReader(bytes).read();
    grid.file = file;
    return std::make_shared<const SparseGrid>(std::move(grid));
  };
  while (at < total) {
    const std::vector<char> head = read(at, file_header_bytes);
    const GridBytes header(head, where, file);
    if (header.at<std::uint64_t>(0) == magic_grid) {
      // The segment is a single grid without file header.
      const std::vector<char> begin = read(at, grid_bytes);
      const GridBytes grid(begin, where, file);
      check_version(grid.at<std::uint32_t>(16));
      const auto size = grid.at<std::uint64_t>(32);
      if (size < grid_bytes || size > total - at) whole.fail("ends in the middle of a grid");
      if (std::string(begin.data() + 40, strnlen(begin.data() + 40, 256)) == name)
        return grid_of(read(at, size));
      at += size;
      continue;
    }
    if ((header.at<std::uint64_t>(0) & magic_mask) != (magic & magic_mask))
      whole.fail("is no NanoVDB file");
    check_version(header.at<std::uint32_t>(8));
    const auto grids = header.at<std::uint16_t>(12), codec = header.at<std::uint16_t>(14);
    at += file_header_bytes;
    struct Told {
      std::string name;
      std::uint64_t size, bytes;
    };
    std::vector<Told> all;
    for (std::uint16_t i = 0; i < grids; ++i) {
      const std::vector<char> told = read(at, meta_bytes);
      const GridBytes meta(told, where, file);
      const auto length = meta.at<std::uint32_t>(136);
      const std::vector<char> named = read(at + meta_bytes, length);
      const std::string text(named.begin(), named.end());
      all.push_back({text.c_str(), meta.at<std::uint64_t>(0), meta.at<std::uint64_t>(8)});
      at += meta_bytes + length;
    }
    for (const Told& one : all) {
      // A compressed grid is preceded by its length; writers disagree on whether the size in the
      // metadata includes that.
      const std::uint64_t prefix = codec == codec_none ? 0 : 8;
      std::uint64_t bytes = one.bytes;
      if (prefix != 0) {
        const std::vector<char> length = read(at, prefix);
        bytes = GridBytes(length, where, file).at<std::uint64_t>(0);
        at += prefix;
      }
      if (bytes > total - at) whole.fail("ends in the middle of a grid");
      if (one.name == name) {
        if (one.size > most_bytes) whole.fail("has a grid \"" + name + "\" of more than 16 GiB");
        if (codec != codec_none && codec != codec_zip)
          whole.fail(
              "is compressed by BLOSC, which is not read: convert it with ZIP or without "
              "compression");
        const std::vector<char> memory = read(at, bytes);
        return grid_of(codec == codec_zip ? inflated(memory, one.size, whole) : memory);
      }
      at += bytes;
    }
  }
  return nullptr;
}

}  // namespace caplet
