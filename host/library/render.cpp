// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/render.h"

#include "library/detail/inside.h"

namespace caplet::v0 {

Film render(const Scene& scene, const Device& device, const RenderOptions& options) {
  const int samples = scene.samples_per_pixel();
  Session session = Inside::session(scene, std::span(&device, 1), static_cast<std::uint32_t>(samples));
  session.render(samples, options);
  return session.film();
}

}  // namespace caplet::v0
