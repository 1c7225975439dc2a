// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/fingerprint.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "base/content_hash.h"

namespace caplet {

namespace {

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
    std::vector<std::string> hashes(pieces_.size());
    tbb::parallel_for(std::size_t{0}, pieces_.size(),
                      [&](std::size_t i) { hashes[i] = content_hash(pieces_[i]); });
    std::string all;
    for (const std::string& hash : hashes) all += hash;
    return content_hash(all);
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
