// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colours of a neuron by type, file, branch order, path length from the soma, or values of another
// file. Conventions: docs/formats/swc.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "import/detail/swc_sample.h"
#include "import/detail/value_colors.h"
#include "import/import_options.h"
#include "scene/scene.h"

namespace caplet {

/// Counts the forks between each sample and the soma or root: samples with two or more children,
/// other than soma and root.
std::vector<double> branch_orders(const std::vector<SwcSample>& samples);

/// Returns the path length to each sample from its root, or from the last soma sample on the path;
/// in the file's unit.
std::vector<double> path_depths(const std::vector<SwcSample>& samples);

/// Reads one value per sample: a number per sample in their order, an id and a number per line, one
/// number per file, or a file's name without its ending and a number per line; separated by blanks,
/// tabs or a comma. `#` begins a comment; the first, before the first value, gives the values' name
/// (`name`). Samples without a value are NaN. `neuron` is the file of the samples; `options` gives
/// its number among the files. Throws InputError.
std::vector<double> read_values(const std::filesystem::path& path,
                                const std::vector<SwcSample>& samples,
                                const std::filesystem::path& neuron, const ImportOptions& options,
                                std::string& name);

/// Makes the materials of samples at their first use; `types` are the samples' types as drawn.
class SwcColors {
 public:
  /// Throws InputError that names --color or --range.
  SwcColors(Scene& scene, const std::vector<SwcSample>& samples, const std::filesystem::path& path,
            const ImportOptions& options);
  std::uint32_t of(const SwcSample& sample);
  /// Returns the names of types or of the file, for what was drawn; none where colours tell
  /// numbers.
  std::optional<Legend> legend() const;

 private:
  enum class By { type, file, value };
  std::uint32_t of_type(const SwcSample& sample);
  std::uint32_t add(const std::string& name, const glm::dvec3& color, int line);

  Scene& scene_;
  const std::vector<SwcSample>& samples_;
  By by_ = By::type;
  std::string what_, file_name_;
  std::size_t file_ = 0;
  std::vector<double> values_;
  ValueColors by_value_;
  std::int64_t of_file_ = -1;
  std::map<int, std::uint32_t> types_;
  int last_type_ = -1;
  std::uint32_t last_index_ = 0;
};

}  // namespace caplet
