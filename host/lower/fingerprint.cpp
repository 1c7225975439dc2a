// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/fingerprint.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "base/content_hash.h"

namespace caplet {

namespace {

__extension__ typedef unsigned __int128 Wide;

/// Returns a hash of bytes: FNV-1a of 128 bits (base/content_hash.h) that takes eight bytes at a
/// time, for it reads gigabytes. Each step can be undone, so that no change of one word is lost.
Wide hash_of_words(std::string_view bytes) {
  Wide hash = bytes.size();
  const Wide prime = (static_cast<Wide>(1) << 88) | 0x13bu;
  for (std::size_t begin = 0; begin < bytes.size(); begin += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + begin, std::min(sizeof(word), bytes.size() - begin));
    hash = (hash ^ word) * prime;
  }
  return hash;
}

/// Hashes buffers in pieces, several at a time, and then the hashes of the pieces.
class Hasher {
 public:
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  template <class T>
  void add(const T& record) {
    add(&record, sizeof(record));
  }

  std::string result() const {
    std::vector<Wide> hashes(pieces_.size());
    tbb::parallel_for(std::size_t{0}, pieces_.size(),
                      [&](std::size_t i) { hashes[i] = hash_of_words(pieces_[i]); });
    return content_hash(
        {reinterpret_cast<const char*>(hashes.data()), hashes.size() * sizeof(hashes.front())});
  }

 private:
  static constexpr std::size_t piece_bytes = std::size_t{1} << 20;

  // An empty buffer is a piece as well, so that the same bytes in another buffer have another hash.
  void add(const void* data, std::size_t bytes) {
    const std::string_view all(static_cast<const char*>(data), bytes);
    std::size_t begin = 0;
    do {
      pieces_.push_back(all.substr(begin, piece_bytes));
      begin += piece_bytes;
    } while (begin < bytes);
  }

  std::vector<std::string_view> pieces_;
};

}  // namespace

#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)

std::string fingerprint(const FlatScene& scene) {
  Hasher hasher;
#define BUFFER(name, type, access) hasher.add(scene.name);
  SCENE_GROUPS
#undef BUFFER
  // The kernels are built by these (stage_options).
  hasher.add(scene.shapes);
  hasher.add(scene.leaf_kind_bits);
  hasher.add(scene.sky_is_unseen);
  hasher.add(scene.has_chains);
  hasher.add(scene.has_moving_operands);
  return hasher.result();
}

std::string fingerprint(const FlatView& view) {
  Hasher hasher;
#define BUFFER(name, type, access) hasher.add(view.name);
  VIEW_GROUPS
#undef BUFFER
  return hasher.result();
}

#undef GROUP_BEGIN
#undef GROUP_END

}  // namespace caplet
