// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces rays with the traversal kernels, without the rest of the renderer.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "device/device.h"
#include "shared/records.h"

namespace caplet::bench {

class DeviceTracer {
 public:
  /// How rays of width 8 traverse the tree (kernels/trace/many.cl): many at once, as a renderer's
  /// rays do; as its camera rays do; or one after the other, for devices that are slow at tracing
  /// many.
  enum class Manner { pool, stream, one_by_one };

  /// `width`: CAPLET_REAL_WIDTH, 8 or 1. The kernels support the shapes of `rows`.
  DeviceTracer(const Device& device, int width, const std::string& options = "",
               const RowMasks& rows = {}, Manner manner = Manner::pool);
  void upload(std::span<const float> nodes, std::span<const float> leaves,
              std::span<const InstanceRecord> instances, uint root);
  void set_rays(std::span<const RayRecord> rays);
  /// Traces the rays that were set before, and blocks.
  void run_closest();
  void run_any();
  std::vector<HitRecord> hits() const;
  std::vector<int> any() const;

  std::vector<HitRecord> closest(std::span<const RayRecord> rays);
  std::vector<int> any(std::span<const RayRecord> rays);

 private:
  void run(cl::Kernel& kernel);

  Device device_;
  bool shares_;
  cl::Kernel closest_, any_;
  Buffer<float> nodes_, leaves_;
  Buffer<InstanceRecord> instances_;
  Buffer<RayRecord> rays_;
  Buffer<HitRecord> hits_;
  Buffer<int> anys_;
  uint root_ = 0;
};

}  // namespace caplet::bench
