// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/stages.h"

#include <chrono>
#include <map>
#include <span>

#include "base/check.h"

namespace caplet {

namespace {

// One work-item at a time suits PoCL's tracing (docs/performance.md); GPUs need whole wavefronts.
constexpr std::size_t cpu_local_size = 64;
constexpr std::size_t gpu_local_size = 64;

std::size_t state_count(const std::string& name, const WavefrontSize& size) {
  static const std::map<std::string, std::size_t> per_path = {
#define PATH_STATE(name, type, count) {#name, count},
#include "shared/path_state.def"
#undef PATH_STATE
  };
  if (const auto found = per_path.find(name); found != per_path.end()) return found->second * size.paths;
  if (name == "sort_bins") return size.sort_bins;
  if (name == "counters") return 16;
  if (name == "film") return size.pixels;
  return size.paths;  // queues and their keys
}

/// Argument numbers of all stages.
enum : cl_uint {
#define BUFFER(name, type, access) buffer_##name,
#include "shared/buffers.def"
#undef BUFFER
  buffer_count
};

const std::vector<std::string>& stage_names() {
  static const std::vector<std::string> names = {
#define STAGE(name) #name,
#include "shared/stages.def"
#undef STAGE
  };
  return names;
}

template <class T>
std::span<const T> contents(const std::vector<T>& values) {
  return values;
}
template <class T>
std::span<const T> contents(const T& value) {
  return {&value, 1};
}

}  // namespace

Stages::Stages(const Device& device, const FlatScene& scene, const WavefrontSize& size, const std::string& options, bool cpu)
    : device_(device), local_size_(cpu ? cpu_local_size : gpu_local_size) {
  // IN buffers are the scene's, STATE buffers are sized by the wavefront.
#define IN(name, type) name##_ = Buffer<type>(device, std::span<const type>(contents(scene.name)));
#define STATE(name, type) name##_ = Buffer<type>(device, state_count(#name, size));
#define BUFFER(name, type, access) access(name, type)
#include "shared/buffers.def"
#undef BUFFER
#undef STATE
#undef IN
  const std::vector<FilmRecord> empty(size.pixels, FilmRecord{});
  film_.write(empty);

  for (const std::string& name : stage_names()) {
    programs_.emplace_back(device, name, options);
    programs_.back().prepare(name, local_size_of(name), name == "sort_prefix" ? 1 : size.paths);
    compile_seconds_ += programs_.back().build_seconds();
    by_stage_.emplace_back(name, programs_.back().build_seconds());
    cl::Kernel kernel = programs_.back().kernel(name);
    cl_uint index = 0;
#define BUFFER(name, type, access) kernel.setArg(index++, name##_.handle());
#include "shared/buffers.def"
#undef BUFFER
    CHECK_EQ_(index, static_cast<cl_uint>(buffer_count));
    kernels_.push_back(kernel);
  }
  seconds_.resize(kernels_.size());
}

std::size_t Stages::local_size_of(const std::string& stage) const { return stage == "sort_prefix" ? 1 : local_size_; }

std::vector<std::pair<std::string, double>> Stages::seconds_by_stage() const {
  std::vector<std::pair<std::string, double>> out;
  for (std::size_t i = 0; i < seconds_.size(); ++i) out.emplace_back(stage_names()[i], seconds_[i]);
  return out;
}

void Stages::swap_queues() {
  swapped_ = !swapped_;
  for (cl::Kernel& kernel : kernels_) {
    kernel.setArg(buffer_queue, (swapped_ ? queue_next_ : queue_).handle());
    kernel.setArg(buffer_queue_next, (swapped_ ? queue_ : queue_next_).handle());
  }
}

void Stages::set_params(const ParamsRecord& params) { params_.write(std::span<const ParamsRecord>(&params, 1)); }

void Stages::run(Stage stage, std::size_t count) {
  if (count == 0) return;
  const auto index = static_cast<std::size_t>(stage);
  cl::Kernel& kernel = kernels_[index];
  kernel.setArg(buffer_count, narrow<cl_uint>(count));
  const auto start = std::chrono::steady_clock::now();
  launch(device_, kernel, count, local_size_of(stage_names()[index]));
  if (!timed_) return;
  device_.finish();
  seconds_[index] += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Stages::set_counters(const std::array<uint, 4>& values) { counters_.RawBuffer::write(values.data(), 0, sizeof values); }

std::array<uint, 4> Stages::counters() const {
  std::array<uint, 4> values{};
  counters_.RawBuffer::read(values.data(), 0, sizeof values);
  return values;
}

void Stages::clear_sort_bins(std::size_t bins) {
  device_.queue().enqueueFillBuffer(sort_bins_.handle(), cl_uint{0}, 0, bins * sizeof(uint));
}

std::vector<FilmRecord> Stages::read_film() const { return film_.Buffer<FilmRecord>::read(); }

}  // namespace caplet
