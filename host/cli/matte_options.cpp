// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/matte_options.h"

#include <CLI/CLI.hpp>

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/options.h"
#include "film/slots.h"

namespace caplet::cli {

void add_matte_flags(CLI::App& command, MatteFlags& flags) {
  command.option_defaults()->group("Output");
  command.add_flag("--cryptomatte", flags.cryptomatte,
                   "Also write mattes by object, material and file: crypto_object, "
                   "crypto_material and crypto_asset");
  command
      .add_option("--matte-levels", flags.levels,
                  "How many things of a pixel a matte tells: those that cover most of it")
      ->check(CLI::Range(1, slots_of_a_pixel))
      ->type_name("N")
      ->default_str("the scene's, or 6");
  command
      .add_option("--deep", flags.deep,
                  "Also write a deep EXR: alpha and distance of all that each pixel shows")
      ->type_name("OUT.exr");
}

std::filesystem::path deep_path(const MatteFlags& flags) {
  if (flags.deep.empty()) return {};
  std::filesystem::path path = output_named(flags.deep);
  if (!is_stream(path) && path.extension() != ".exr")
    throw InputError(SourceLocation{"--deep"},
                     "'" + flags.deep + "': deep pictures are written as .exr");
  return path;
}

Layers with_mattes(Layers layers, const MatteFlags& flags) {
  return flags.cryptomatte ? Layers::of_bits(layers.bits() | Layers::mattes().bits()) : layers;
}

}  // namespace caplet::cli
