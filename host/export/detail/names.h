// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the parts of a scene are called in a file: their own names where they have some that no other part of the kind has.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace caplet::pbrt_text {

class NameList {
 public:
  /// `wanted`, or where that is empty or taken a name after `kind` that is free.
  std::string take(const std::string& wanted, const std::string& kind) {
    if (!wanted.empty() && taken_.insert(wanted).second) return wanted;
    for (;; ++next_)
      if (std::string name = (wanted.empty() ? kind : wanted) + " " + std::to_string(next_); taken_.insert(name).second)
        return name;
  }
  void free(const std::string& name) { taken_.erase(name); }

 private:
  std::set<std::string> taken_;
  std::size_t next_ = 1;
};

/// By index in the scene.
struct Names {
  std::vector<std::string> textures, materials, media, objects;
};

}  // namespace caplet::pbrt_text
