// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Records which elements of which buffers of a FlatScene differ from what a device was sent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "shared/groups.h"

namespace caplet {

/// ChangedRange is elements [begin, end).
struct ChangedRange {
  std::size_t begin = 0, end = 0;
};

/// ChangedRanges holds the changes of one buffer.
class ChangedRanges {
 public:
  void add(std::size_t begin, std::size_t count) {
    if (count > 0) ranges_.push_back({begin, begin + count});
  }
  bool empty() const { return ranges_.empty(); }
  /// Returns the ranges in order and apart; those with at most `gap` elements between them are one.
  std::vector<ChangedRange> joined(std::size_t gap) const {
    std::vector<ChangedRange> sorted = ranges_, out;
    std::ranges::sort(sorted, {}, &ChangedRange::begin);
    for (const ChangedRange& range : sorted) {
      if (!out.empty() && range.begin <= out.back().end + gap)
        out.back().end = std::max(out.back().end, range.end);
      else
        out.push_back(range);
    }
    return out;
  }

 private:
  std::vector<ChangedRange> ranges_;
};

#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) ChangedRanges name;

/// SceneChanges holds changes by the names of the groups' buffers.
struct SceneChanges {
  SCENE_GROUPS
  bool all = false;  // everything, of another length perhaps

#undef BUFFER
#define BUFFER(name, type, access) &&name.empty()
  bool empty() const { return !all SCENE_GROUPS; }
};

#undef GROUP_BEGIN
#undef GROUP_END
#undef BUFFER

}  // namespace caplet
