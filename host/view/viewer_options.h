// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstddef>

#include "view/redraw.h"
#include "view/server.h"

namespace caplet::view {

struct ViewerOptions {
  ServerOptions server;
  SceneFiles files;        // that the scene was read from
  bool read_only = false;  // refuse changes
  bool denoises = false;   // pages may have pictures without noise; the denoiser is there
  int samples = 0;         // per pixel of a finished picture; 0: the scene's own
  double noise = 0;  // of a finished picture (film/noise.h), which may have fewer samples; 0: none
  double coarse_seconds = 0.03;                    // approximate time of a view's first picture
  double step_seconds = 0.5;                       // approximate time between two pictures
  std::size_t batch_paths = std::size_t{1} << 15;  // queries are answered between batches
};

}  // namespace caplet::view
