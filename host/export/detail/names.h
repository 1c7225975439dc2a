// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Names of a scene's parts in a file: their own names, where they are not empty and unique among
// the parts of the kind.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caplet::pbrt_text {

class NameList {
 public:
  /// Returns `wanted`; if it is empty or taken, a free name that begins with `kind`.
  std::string take(const std::string& wanted, const std::string& kind) {
    if (!wanted.empty() && taken_.insert(wanted).second) return wanted;
    const std::string& begin = wanted.empty() ? kind : wanted;
    for (std::size_t& next = next_.try_emplace(begin, 1).first->second;; ++next)
      if (std::string name = begin + " " + std::to_string(next); taken_.insert(name).second)
        return name;
  }
  void free(const std::string& name) { taken_.erase(name); }

 private:
  std::set<std::string> taken_;
  std::map<std::string, std::size_t> next_;  // by begin: the first number that may be free
};

/// Names by index in the scene.
struct Names {
  std::vector<std::string> textures, materials, media, objects;
};

}  // namespace caplet::pbrt_text
