// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <span>

#include "base/check.h"
#include "render/known_rays.h"

namespace caplet {

namespace {

// One work-item at a time suits PoCL's tracing (docs/performance.md); GPUs need whole wavefronts.
constexpr std::size_t cpu_local_size = 64;
constexpr std::size_t gpu_local_size = 64;

std::size_t state_count(const std::string& name, const StateSize& size) {
  static const std::map<std::string, std::size_t> per_path = {
#define PATH_STATE(name, type, count) {#name, count},
#include "shared/path_state.def"
#undef PATH_STATE
  };
  if (const auto found = per_path.find(name); found != per_path.end()) return found->second * size.paths;
  if (name == "sort_bins") return size.sort_bins;
  if (name == "counters") return 16;
  if (name == "film") return size.pixels;
  if (name == "query_rays" || name == "query_counts" || name == "query_begin") return size.query_rays;
  if (name == "query_hits") return size.query_hits;
  if (name == "picks") return size.picks;
  return size.paths;  // queues and their keys
}

/// Argument numbers of all stages.
enum : cl_uint {
#define BUFFER(name, type, access) buffer_##name,
#include "shared/buffers.def"
#undef BUFFER
  buffer_count
};

constexpr const char* stage_names[] = {
#define STAGE(name) #name,
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
};

constexpr Stage stages_of_a_render[] = {
#define STAGE(name) Stage::name,
#include "shared/stages.def"
#undef STAGE
};

const char* name_of(Stage stage) { return stage_names[static_cast<std::size_t>(stage)]; }

template <class T>
std::span<const T> contents(const std::vector<T>& values) {
  return values;
}
template <class T>
std::span<const T> contents(const T& value) {
  return {&value, 1};
}

}  // namespace

std::span<const Stage> render_stages() { return stages_of_a_render; }

std::string stage_options(const FlatScene& scene, const Device& device) {
  return fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_SHAPES=0x{:x}UL -DCAPLET_LEAF_KIND_BITS={}",
                     device.encoding() == Encoding::wide ? 8 : 1, shapes_on_trial(scene.shapes), scene.leaf_kind_bits);
}

Stages::Stages(const Device& device, const FlatScene& scene, const StateSize& size, const std::string& options)
    : device_(device), options_(options), local_size_(device.is_cpu() ? cpu_local_size : gpu_local_size) {
  // IN buffers are the scene's, STATE buffers have the sizes asked for.
#define IN(name, type) name##_ = Buffer<type>(device, std::span<const type>(contents(scene.name)));
#define STATE(name, type) name##_ = Buffer<type>(device, state_count(#name, size));
#define BUFFER(name, type, access) access(name, type)
#include "shared/buffers.def"
#undef BUFFER
#undef STATE
#undef IN
  // In pieces: a film is the largest thing there is.
  const std::vector<FilmRecord> empty(std::min<std::size_t>(size.pixels, 1 << 16), FilmRecord{});
  for (std::size_t first = 0; first < size.pixels; first += empty.size())
    film_.RawBuffer::write(empty.data(), first * sizeof(FilmRecord),
                           std::min(empty.size(), size.pixels - first) * sizeof(FilmRecord));
}

void Stages::compile(std::span<const Stage> stages, std::size_t most) {
  for (const Stage stage : stages) {
    auto& compiled = compiled_[static_cast<std::size_t>(stage)];
    if (compiled) continue;
    const std::string name = name_of(stage);
    Program program(device_, name, options_);
    program.prepare(name, local_size_of(stage), stage == Stage::sort_prefix ? 1 : most);
    compile_seconds_ += program.build_seconds();
    by_stage_.emplace_back(name, program.build_seconds());
    cl::Kernel kernel = program.kernel(name);
    set_buffers(kernel);
    compiled = Compiled{std::move(program), std::move(kernel)};
  }
}

void Stages::set_buffers(cl::Kernel& kernel) const {
  cl_uint index = 0;
#define BUFFER(name, type, access) kernel.setArg(index++, name##_.handle());
#include "shared/buffers.def"
#undef BUFFER
  CHECK_EQ_(index, static_cast<cl_uint>(buffer_count));
  if (!swapped_) return;
  kernel.setArg(buffer_queue, queue_next_.handle());
  kernel.setArg(buffer_queue_next, queue_.handle());
}

void Stages::reserve_query(std::size_t rays, std::size_t hits, std::size_t picks) {
  if (rays > query_rays_.size()) {
    query_rays_ = Buffer<RayRecord>(device_, rays);
    query_counts_ = Buffer<uint>(device_, rays);
    query_begin_ = Buffer<uint>(device_, rays);
  }
  if (hits > query_hits_.size()) query_hits_ = Buffer<HitRecord>(device_, hits);
  if (picks > picks_.size()) picks_ = Buffer<PickRecord>(device_, picks);
  for (auto& compiled : compiled_)
    if (compiled) set_buffers(compiled->kernel);
}

std::size_t Stages::local_size_of(Stage stage) const { return stage == Stage::sort_prefix ? 1 : local_size_; }

std::vector<std::pair<std::string, double>> Stages::seconds_by_stage() const {
  std::vector<std::pair<std::string, double>> out;
  for (std::size_t i = 0; i < compiled_.size(); ++i)
    if (compiled_[i]) out.emplace_back(stage_names[i], compiled_[i]->seconds);
  return out;
}

void Stages::swap_queues() {
  swapped_ = !swapped_;
  for (auto& compiled : compiled_)
    if (compiled) {
      compiled->kernel.setArg(buffer_queue, (swapped_ ? queue_next_ : queue_).handle());
      compiled->kernel.setArg(buffer_queue_next, (swapped_ ? queue_ : queue_next_).handle());
    }
}

void Stages::set_params(const ParamsRecord& params) { params_.write(std::span<const ParamsRecord>(&params, 1)); }

void Stages::run(Stage stage, std::size_t count) {
  if (count == 0) return;
  Compiled& compiled = compiled_[static_cast<std::size_t>(stage)].value();
  compiled.kernel.setArg(buffer_count, narrow<cl_uint>(count));
  const auto start = std::chrono::steady_clock::now();
  launch(device_, compiled.kernel, count, local_size_of(stage));
  if (!timed_) return;
  device_.finish();
  compiled.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TracedPaths Stages::trace(std::span<const RayRecord> rays, std::span<const RayRecord> shadows) {
  std::vector<uint> all(std::max(rays.size(), shadows.size()));
  std::iota(all.begin(), all.end(), 0u);
  std::vector<float> light(4 * shadows.size(), 1.0f), seen(light.size(), 0.0f);
  path_ray_.write(rays);
  queue_.write(std::span(all).first(rays.size()));
  path_shadow_.write(shadows);
  queue_shadow_.write(std::span(all).first(shadows.size()));
  path_shadow_radiance_.write(light);
  path_radiance_.write(seen);
  run(Stage::extend, rays.size());
  run(Stage::connect, shadows.size());
  TracedPaths out;
  out.hits.resize(rays.size());
  path_hit_.RawBuffer::read(out.hits.data(), 0, std::span(out.hits).size_bytes());
  path_radiance_.RawBuffer::read(seen.data(), 0, std::span(seen).size_bytes());
  for (std::size_t i = 0; i < shadows.size(); ++i) out.free.push_back(seen[4 * i] == 1.0f);
  return out;
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

}  // namespace caplet
