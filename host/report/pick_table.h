// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes crossings of many rays as a table: .csv or .npy (docs/pick.md).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::report {

struct PickRow {
  std::uint64_t ray = 0;  // index in the list, from 0
  PickRecord pick;
};

class PickTable {
 public:
  virtual ~PickTable() = default;
  virtual void append(std::span<const PickRow> rows) = 0;
  /// Completes the file.
  virtual void finish() = 0;
};

enum class TableFormat { csv, npy };

/// Returns the format by the extension; CSV for a stream (is_stream) without one; no value when
/// unknown.
std::optional<TableFormat> table_format(const std::filesystem::path& path);
/// Throws InputError that names `flag` when there is no format for it.
void check_table_format(const std::filesystem::path& path, const std::string& flag);

/// Creates the file; messages call it `name`. Throws RunError, as the table's members do, when it
/// cannot be written.
std::unique_ptr<PickTable> create_pick_table(const std::filesystem::path& path, TableFormat format,
                                             const Scene& scene, const std::filesystem::path& name);

}  // namespace caplet::report
