// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the colours of a neuron tell: types, the file, branch orders, ways from the soma, or values of another file.
// Conventions: docs/formats/swc.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "import/detail/swc_sample.h"
#include "import/detail/value_colors.h"
#include "import/import_options.h"
#include "scene/scene.h"

namespace caplet {

/// How many forks lie between each sample and the soma or root: samples with two children or more that are neither soma nor root.
std::vector<double> branch_orders(const std::vector<SwcSample>& samples);

/// The way along the samples to each from its root, or from the last sample of the soma before it; in the file's unit.
std::vector<double> path_depths(const std::vector<SwcSample>& samples);

/// What a file of values says of each sample: one number a sample in their order, an id and a number a line, one number a file,
/// or a file's name without its ending and a number a line; blanks, tabs or a comma between. `#` begins a comment; the first,
/// before the first value, names the values (`name`). NaN where it says nothing of a sample. `neuron`: the file of the samples,
/// the number of which among how many files `options` says. Throws InputError.
std::vector<double> read_values(const std::filesystem::path& path, const std::vector<SwcSample>& samples,
                                const std::filesystem::path& neuron, const ImportOptions& options, std::string& name);

/// The materials of samples, made when first asked for; `types` are the samples' as drawn.
class SwcColors {
 public:
  /// Throws InputError naming --color or --range.
  SwcColors(Scene& scene, const std::vector<SwcSample>& samples, const std::filesystem::path& path, const ImportOptions& options);
  std::uint32_t of(const SwcSample& sample);

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
