// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/write.h"

#include "export/export.h"
#include "film/image.h"
#include "library/detail/inside.h"

namespace caplet::v0 {

void write_scene(const Scene& scene, const std::filesystem::path& file) {
  const FileImageWriter images;
  caplet::write_scene(*Inside::model(scene), file, {}, &images);
}

}  // namespace caplet::v0
