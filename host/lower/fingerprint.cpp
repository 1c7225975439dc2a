// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/fingerprint.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/content_hash.h"

namespace caplet {

namespace {

__extension__ typedef unsigned __int128 Wide;

using Hash = std::array<std::uint64_t, 2>;

/// Returns a hash of bytes: FNV-1a of 128 bits (base/content_hash.h) that takes eight bytes at a
/// time, for it reads gigabytes. Each step can be undone, so that no change of one word is lost.
Hash hash_of_words(std::string_view bytes) {
  Wide hash = bytes.size();
  const Wide prime = (static_cast<Wide>(1) << 88) | 0x13bu;
  for (std::size_t begin = 0; begin < bytes.size(); begin += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + begin, std::min(sizeof(word), bytes.size() - begin));
    hash = (hash ^ word) * prime;
  }
  return {static_cast<std::uint64_t>(hash), static_cast<std::uint64_t>(hash >> 64)};
}

constexpr std::size_t piece_bytes = std::size_t{1} << 20;

template <class T>
std::string_view view_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}
template <class T>
std::string_view view_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}
template <class T>
std::string_view view_of(const T& record) {
  return {reinterpret_cast<const char*>(&record), sizeof(record)};
}

/// Hashes buffers in pieces, several at a time.
class HashedPieces {
 public:
  /// An empty buffer is a piece as well, so that the same bytes in another buffer have another
  /// hash.
  void add(std::string_view bytes, std::vector<Hash>& out) {
    out.resize(std::max<std::size_t>(1, (bytes.size() + piece_bytes - 1) / piece_bytes));
    for (std::size_t i = 0; i < out.size(); ++i)
      pieces_.emplace_back(bytes.substr(i * piece_bytes, piece_bytes), &out[i]);
  }
  void hash() const {
    tbb::parallel_for(std::size_t{0}, pieces_.size(),
                      [&](std::size_t i) { *pieces_[i].second = hash_of_words(pieces_[i].first); });
  }

 private:
  std::vector<std::pair<std::string_view, Hash*>> pieces_;
};

/// Returns the hash of the hashes of pieces.
std::string hash_of(const std::vector<Hash>& pieces) { return content_hash(view_of(pieces)); }

}  // namespace

#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)

void SceneFingerprint::note(const SceneChanges& changes) {
#define BUFFER(name, type, access) \
  if (changes.all || !changes.name.empty()) buffers_.name = {};
  SCENE_GROUPS
#undef BUFFER
}

std::string SceneFingerprint::of(const FlatScene& scene) {
  HashedPieces unknown;
  const auto find = [&](std::string_view bytes, Buffer& buffer) {
    if (!buffer.pieces.empty() && buffer.bytes == bytes.size()) return;
    buffer.bytes = bytes.size();
    unknown.add(bytes, buffer.pieces);
  };
  const SceneArrays arrays = scene.arrays();
#define BUFFER(name, type, access) find(view_of(arrays.name), buffers_.name);
  SCENE_GROUPS
#undef BUFFER
  unknown.hash();
  std::vector<Hash> all;
#define BUFFER(name, type, access) \
  all.insert(all.end(), buffers_.name.pieces.begin(), buffers_.name.pieces.end());
  SCENE_GROUPS
#undef BUFFER
  // The kernels are built by these (stage_options).
  const auto add = [&](const auto& value) { all.push_back(hash_of_words(view_of(value))); };
  add(scene.shapes);
  add(scene.leaf_kind_bits);
  add(scene.sky_is_unseen);
  add(scene.has_chains);
  add(scene.has_moving_operands);
  return hash_of(all);
}

std::string fingerprint(const FlatScene& scene) { return SceneFingerprint().of(scene); }

std::string fingerprint(const FlatView& view) {
  std::vector<Hash> all;
  const auto add = [&](std::string_view bytes) {
    std::vector<Hash> pieces;
    HashedPieces of_it;
    of_it.add(bytes, pieces);
    of_it.hash();
    all.insert(all.end(), pieces.begin(), pieces.end());
  };
#define BUFFER(name, type, access) add(view_of(view.name));
  VIEW_GROUPS
#undef BUFFER
  return hash_of(all);
}

#undef GROUP_BEGIN
#undef GROUP_END

}  // namespace caplet
