// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// NanoVDB files (Museth, "NanoVDB: A GPU-friendly and portable VDB data structure for real-time rendering and simulation", 2021):
// segments of a header, of what is told of each grid, and of the grids, whose memory is written as it is. Layouts are those of
// versions 32 and up.
#include "import/detail/nanovdb.h"

#include <zlib.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>

namespace caplet {

namespace {

// "NanoVDB0", and in newer files "NanoVDB1" and "NanoVDB2" (of grids and of files).
constexpr std::uint64_t magic = 0x304244566f6e614e, magic_mask = 0x00ffffffffffffff;
constexpr std::size_t file_header_bytes = 16, meta_bytes = 176, grid_bytes = 672, tree_bytes = 64;
constexpr std::uint32_t type_float = 1;
constexpr std::uint16_t codec_none = 0, codec_zip = 1;
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 34;

/// Numbers of a memory that may end anywhere.
class Bytes {
 public:
  Bytes(const std::vector<char>& bytes, const SourceLocation& where, const std::string& file)
      : bytes_(bytes), where_(where), file_(file) {}

  template <class T>
  T at(std::uint64_t offset) const {
    need(offset, sizeof(T));
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof(T));
    return value;
  }
  void need(std::uint64_t offset, std::uint64_t count) const {
    if (offset > bytes_.size() || count > bytes_.size() - offset) fail("ends in the middle of a grid");
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(where_, file_ + ": " + what); }

 private:
  const std::vector<char>& bytes_;
  SourceLocation where_;
  std::string file_;
};

/// A grid's memory -> its bricks.
class GridReader {
 public:
  GridReader(const Bytes& bytes) : bytes_(bytes) {}

  SparseGrid read() {
    if ((bytes_.at<std::uint64_t>(0) & magic_mask) != (magic & magic_mask)) bytes_.fail("is no NanoVDB grid");
    const std::uint64_t map = 24 + 8 + 256;  // after magic, checksum, version, flags, index, count, size and name
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        out_.medium_from_voxels[c][r] = bytes_.at<double>(map + 88 + 8 * static_cast<std::uint64_t>(3 * r + c));
      out_.medium_from_voxels[3][r] = bytes_.at<double>(map + 88 + 144 + 8 * static_cast<std::uint64_t>(r));
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
      // 21 bits each of x, y and z over 4096.
      const auto part = [&](int shift) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> shift & 0x1fffff) << 12);
      };
      const Coordinates low{part(42), part(21), part(0)};
      if (child != 0)
        node<5>(at(root, child), low);
      else if (bytes_.at<std::uint32_t>(tile + 16) != 0 && bytes_.at<float>(tile + 20) != 0)
        bytes_.fail("has a constant tile of 4096^3 voxels");
    }
    return std::move(out_);
  }

 private:
  using Coordinates = std::array<std::int32_t, 3>;
  static constexpr std::uint64_t root_bytes = 64;

  static std::uint64_t at(std::uint64_t node, std::int64_t offset) { return node + static_cast<std::uint64_t>(offset); }

  /// 32^3 nodes of 16^3 leaves of 8^3 voxels.
  template <int Log>
  void node(std::uint64_t begin, const Coordinates& low) {
    constexpr std::uint64_t children = std::uint64_t{1} << (3 * Log), mask = children / 8;
    constexpr std::uint64_t values = 32, child_mask = values + mask, table = (values + 2 * mask + 16 + 31) / 32 * 32;
    constexpr int side = Log == 5 ? 128 : 8;
    bytes_.need(begin, table + 8 * children);
    for (std::uint64_t i = 0; i < children; ++i) {
      const auto n = static_cast<std::int32_t>(i);
      constexpr std::int32_t most = (1 << Log) - 1;
      const Coordinates here{low[0] + side * (n >> 2 * Log), low[1] + side * (n >> Log & most), low[2] + side * (n & most)};
      const auto is_set = [&](std::uint64_t of) { return (bytes_.at<std::uint8_t>(begin + of + i / 8) >> (i % 8) & 1) != 0; };
      if (is_set(child_mask)) {
        const std::uint64_t child = at(begin, bytes_.at<std::int64_t>(begin + table + 8 * i));
        if constexpr (Log == 5)
          node<4>(child, here);
        else
          leaf(child, here);
      } else if (is_set(values)) {
        constant(bytes_.at<float>(begin + table + 8 * i), here, side);
      }
    }
  }

  void leaf(std::uint64_t begin, const Coordinates& low) {
    constexpr std::uint64_t mask = 16, values = 96;
    bytes_.need(begin, values + 2048);
    std::vector<float>& to = brick(low);
    const std::size_t first = to.size() - 512;
    for (std::size_t i = 0; i < 512; ++i) {
      (void)mask;
      const auto value = bytes_.at<float>(begin + values + 4 * i);
      if (!std::isfinite(value) || value < 0) bytes_.fail("has values that are negative or not finite");
      // From x slowest to x fastest.
      to[first + ((i & 7) * 8 + (i >> 3 & 7)) * 8 + (i >> 6)] = value;
    }
  }

  void constant(float value, const Coordinates& low, int side) {
    if (!std::isfinite(value) || value < 0) bytes_.fail("has values that are negative or not finite");
    if (value == 0) return;
    for (int x = 0; x < side; x += 8)
      for (int y = 0; y < side; y += 8)
        for (int z = 0; z < side; z += 8) {
          std::vector<float>& to = brick({low[0] + x, low[1] + y, low[2] + z});
          std::fill(to.end() - 512, to.end(), value);
        }
  }

  /// Another brick, at the end of all values.
  std::vector<float>& brick(const Coordinates& low) {
    if (out_.bricks.size() >= most_spanned_bricks / 16) bytes_.fail("has more than 8 million bricks of 8^3 voxels");
    out_.bricks.push_back({low[0] >> 3, low[1] >> 3, low[2] >> 3});
    out_.values.resize(out_.values.size() + 512);
    return out_.values;
  }

  const Bytes& bytes_;
  SparseGrid out_;
};

std::vector<char> inflated(const std::vector<char>& from, std::uint64_t size, const Bytes& bytes) {
  std::vector<char> out(size);
  uLongf length = size;
  if (uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(from.data()), from.size()) !=
          Z_OK ||
      length != size)
    bytes.fail("has a grid whose compression is broken");
  return out;
}

}  // namespace

SparseGridPointer read_nanovdb(const std::string& file, const std::string& name, const SourceLocation& where) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) throw InputError(where, file + ": cannot be read");
  const auto total = static_cast<std::uint64_t>(stream.tellg());
  std::uint64_t at = 0;
  const std::vector<char> nothing;
  const Bytes whole(nothing, where, file);
  const auto read = [&](std::uint64_t offset, std::uint64_t count) {
    if (offset > total || count > total - offset) whole.fail("ends in the middle of a grid");
    std::vector<char> out(count);
    stream.seekg(static_cast<std::streamoff>(offset));
    if (!stream.read(out.data(), static_cast<std::streamsize>(count))) whole.fail("cannot be read");
    return out;
  };
  while (at < total) {
    const std::vector<char> head = read(at, file_header_bytes);
    const Bytes header(head, where, file);
    if ((header.at<std::uint64_t>(0) & magic_mask) != (magic & magic_mask)) whole.fail("is no NanoVDB file");
    if (header.at<std::uint32_t>(8) >> 21 < 32) whole.fail("is of a NanoVDB version before 32");
    const auto grids = header.at<std::uint16_t>(12), codec = header.at<std::uint16_t>(14);
    at += file_header_bytes;
    struct Told {
      std::string name;
      std::uint64_t size, bytes;
      std::uint32_t type;
    };
    std::vector<Told> all;
    for (std::uint16_t i = 0; i < grids; ++i) {
      const std::vector<char> told = read(at, meta_bytes);
      const Bytes meta(told, where, file);
      const auto length = meta.at<std::uint32_t>(136);
      const std::vector<char> named = read(at + meta_bytes, length);
      const std::string text(named.begin(), named.end());
      all.push_back({text.c_str(), meta.at<std::uint64_t>(0), meta.at<std::uint64_t>(8), meta.at<std::uint32_t>(32)});
      at += meta_bytes + length;
    }
    for (const Told& one : all) {
      if (one.name == name) {
        if (one.type != type_float) whole.fail("has a grid \"" + name + "\" that is not of 32-bit floats");
        if (one.size > most_bytes) whole.fail("has a grid \"" + name + "\" of more than 16 GiB");
        if (codec != codec_none && codec != codec_zip)
          whole.fail("is compressed by BLOSC, which is not read: convert it with ZIP or without compression");
        std::vector<char> memory = read(at, one.bytes);
        if (codec == codec_zip) {
          if (memory.size() < 8) whole.fail("ends in the middle of a grid");
          memory.erase(memory.begin(), memory.begin() + 8);  // its length
          memory = inflated(memory, one.size, whole);
        }
        const Bytes bytes(memory, where, file);
        SparseGrid grid = GridReader(bytes).read();
        grid.file = file;
        return std::make_shared<const SparseGrid>(std::move(grid));
      }
      if (one.bytes > total - at) whole.fail("ends in the middle of a grid");
      at += one.bytes;
    }
  }
  return nullptr;
}

}  // namespace caplet
