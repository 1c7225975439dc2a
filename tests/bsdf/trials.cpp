// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "trials.h"

namespace caplet::test {

const std::vector<MaterialOnTrial>& materials_on_trial() {
  static const std::vector<MaterialOnTrial> all = {
#define MATERIAL(name, ...) {material_##name, #name, name##_trial()},
#define CHOICE(name, ...)
#include "shared/materials.def"
#undef MATERIAL
  };
  return all;
}

}  // namespace caplet::test
