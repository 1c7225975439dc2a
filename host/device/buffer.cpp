// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>

#include "base/check.h"
#include "device/cl_error.h"
#include "device/detail/accounting.h"
#include "device/detail/huge_pages.h"
#include "device/device.h"

namespace caplet {

namespace {

constexpr std::size_t smallest_buffer = 16;

void require_memory(const DeviceInfo& info, std::uint64_t bytes, std::uint64_t alive) {
  const std::uint64_t left = info.global_bytes - std::min(info.global_bytes, alive);
  if (bytes <= info.max_allocation_bytes && bytes <= left) return;
  throw RunError(
      fmt::format("a buffer needs {} bytes, the device allows {} bytes in one buffer and {} bytes "
                  "in all, {} of them in use "
                  "(device '{}')",
                  bytes, info.max_allocation_bytes, info.global_bytes, alive, info.name));
}

void CL_CALLBACK let_go(cl_mem, void* keeper) {
  delete static_cast<std::shared_ptr<const void>*>(keeper);
}

}  // namespace

RawBuffer::RawBuffer(const Device& device, std::size_t bytes, bool read_only, const void* contents)
    : device_(device), bytes_(bytes) {
  const std::size_t size = std::max(bytes, smallest_buffer);
  require_memory(device.info(), size, device.bytes_allocated());
  cl_call(fmt::format("buffer of {} bytes", bytes), device.info().name, [&] {
    buffer_ = on_huge_pages(device, read_only, size);
    if (!buffer_())
      buffer_ =
          cl::Buffer(device.context(), read_only ? CL_MEM_READ_ONLY : CL_MEM_READ_WRITE, size);
    if (contents && bytes > 0)
      device.queue().enqueueWriteBuffer(buffer_, CL_TRUE, 0, bytes, contents);
  });
  const std::shared_ptr<Device::Accounting> accounting = device.accounting_;
  accounting->add(size);
  accounted_ =
      std::shared_ptr<void>(nullptr, [accounting, size](void*) { accounting->remove(size); });
}

RawBuffer::RawBuffer(const Device& device, std::span<const std::byte> memory,
                     std::shared_ptr<const void> keeper)
    : device_(device), bytes_(memory.size()) {
  CHECK_LE_(std::size_t{1}, memory.size());
  require_memory(device.info(), memory.size(), 0);
  auto kept = std::make_unique<std::shared_ptr<const void>>(std::move(keeper));
  cl_call(fmt::format("buffer over {} bytes", bytes_), device.info().name, [&] {
    buffer_ = cl::Buffer(device.context(), CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, memory.size(),
                         const_cast<std::byte*>(memory.data()));
    buffer_.setDestructorCallback(let_go, kept.get());
  });
  (void)kept.release();
}

void RawBuffer::read(void* to, std::size_t offset, std::size_t bytes) const {
  if (bytes == 0) return;
  CHECK_LE_(offset, bytes_);
  CHECK_LE_(bytes, bytes_ - offset);
  cl_call(fmt::format("reading {} of a buffer's {} bytes", bytes, bytes_), device_.info().name,
          [&] { device_.queue().enqueueReadBuffer(buffer_, CL_TRUE, offset, bytes, to); });
}

void RawBuffer::clear() {
  if (bytes_ == 0) return;
  cl_call(fmt::format("clearing a buffer of {} bytes", bytes_), device_.info().name,
          [&] { device_.queue().enqueueFillBuffer(buffer_, cl_uchar{0}, 0, bytes_); });
}

void RawBuffer::write(const void* from, std::size_t offset, std::size_t bytes) {
  if (bytes == 0) return;
  CHECK_LE_(offset, bytes_);
  CHECK_LE_(bytes, bytes_ - offset);
  cl_call(fmt::format("writing {} of a buffer's {} bytes", bytes, bytes_), device_.info().name,
          [&] { device_.queue().enqueueWriteBuffer(buffer_, CL_TRUE, offset, bytes, from); });
}

}  // namespace caplet
