// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/matte_options.h"

#include <CLI/CLI.hpp>

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

Layers with_mattes(Layers layers, const MatteFlags& flags) {
  return flags.cryptomatte ? Layers::of_bits(layers.bits() | Layers::mattes().bits()) : layers;
}

}  // namespace caplet::cli
