// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Crossings of many rays as a table: .csv or .npy (docs/pick.md).
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::cli {

struct PickRow {
  std::uint64_t ray = 0;  // its number in the list, from 0
  PickRecord pick;
};

class PickTable {
 public:
  virtual ~PickTable() = default;
  virtual void append(std::span<const PickRow> rows) = 0;
  /// Completes the file.
  virtual void finish() = 0;
};

/// Throws InputError naming `flag` unless the extension is .csv or .npy.
void check_table_format(const std::filesystem::path& path, const std::string& flag);

/// Creates the file, by its extension. Throws RunError, as the table's members do, when it cannot be written.
std::unique_ptr<PickTable> create_pick_table(const std::filesystem::path& path, const Scene& scene);

}  // namespace caplet::cli
