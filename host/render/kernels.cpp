// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <string_view>

#include "base/check.h"
#include "base/clock.h"
#include "base/error.h"
#include "device/cl_error.h"
#include "lower/all_rows.h"
#include "render/detail/array_parts.h"
#include "render/detail/known_rays.h"
#include "render/detail/launch_policy.h"
#include "shared/shapes.h"

namespace caplet {

namespace {

enum class Launch { items, shares, one, one_on_cpus };

struct StageRow {
  const char* name;
  Launch launch;
  bool (*is_used)(const StageNeeds& s);
  const char* groups;
};

constexpr StageRow stage_rows[] = {
#define STAGE(name, launch, is_used, groups) \
  {#name, Launch::launch, []([[maybe_unused]] const StageNeeds& s) { return is_used; }, #groups},
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
};

const StageRow& row_of(Stage stage) { return stage_rows[static_cast<std::size_t>(stage)]; }

/// Sets the buffers of a stage's groups and returns the number of the argument after them.
cl_uint set_buffers(Stage stage, const Bindings& bindings, bool has_parts, cl::Kernel& kernel) {
  cl_uint index = 0;
#define GROUP_BEGIN(Type, group)                \
  {                                             \
    CHECK_EQ_(bindings.group != nullptr, true); \
    const Type##Buffers& buffers = *bindings.group;
#define BUFFER(name, type, access) kernel.setArg(index++, buffers.name.handle());
#undef PARTS
#define PARTS(name, type)                               \
  for (const Buffer<type>& part : buffers.name##_parts) \
    if (has_parts) kernel.setArg(index++, part.handle());
#define GROUP_END(Type) }
  switch (stage) {
#define STAGE(name, launch, is_used, groups) \
  case Stage::name: {                        \
    groups                                   \
  } break;
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
    case Stage::count:
      break;
  }
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
#undef PARTS
#define PARTS(name, type)
  return index;
}

}  // namespace

std::vector<Stage> render_stages(const StageNeeds& needs) {
  std::vector<Stage> out;
  for (std::size_t i = 0; i < std::size(stage_rows); ++i)
    if (stage_rows[i].is_used(needs)) out.push_back(static_cast<Stage>(i));
  return out;
}

Stage first_needed(std::initializer_list<Stage> stages, const StageNeeds& needs) {
  const auto* const found =
      std::ranges::find_if(stages, [&](Stage stage) { return row_of(stage).is_used(needs); });
  CHECK_EQ_(found != stages.end(), true);
  return *found;
}

std::size_t buffer_count(Stage stage) {
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) +1
#define GROUP_END(Type)
  constexpr std::size_t counts[] = {
#define STAGE(name, launch, is_used, groups) 0 groups,
#include "shared/queries.def"
#include "shared/stages.def"
#undef STAGE
  };
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
  return counts[static_cast<std::size_t>(stage)];
}

bool is_counted(Stage stage) {
  return std::string_view(row_of(stage).groups).find("GROUP_COUNTERS") != std::string_view::npos;
}

std::string stage_source(Stage stage, const RowMasks& rows) {
  return flatten_kernels(
      fmt::format("#define STAGE_NAME {0}\n{2}#define STAGE_GROUPS {1}\n#include "
                  "\"stages/arguments.cl\"\n#include "
                  "\"stages/{0}.cl\"\n#include \"stages/kernel.cl\"\n",
                  row_of(stage).name, row_of(stage).groups,
                  is_counted(stage) ? "#define STAGE_IS_COUNTED\n" : ""),
      rows);
}

std::string options_of(std::string_view source, std::string_view options) {
  const auto is_of_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const auto names = [&](std::string_view macro) {
    for (std::size_t at = source.find(macro); at != std::string_view::npos;
         at = source.find(macro, at + 1)) {
      const std::size_t end = at + macro.size();
      if ((at == 0 || !is_of_name(source[at - 1])) &&
          (end == source.size() || !is_of_name(source[end])))
        return true;
    }
    return false;
  };
  std::string out;
  while (!options.empty()) {
    const std::size_t end = std::min(options.find(' '), options.size());
    const std::string_view option = options.substr(0, end);
    options.remove_prefix(std::min(end + 1, options.size()));
    if (option.empty()) continue;
    if (option.starts_with("-D") && !names(option.substr(2, option.find('=') - 2))) continue;
    out += fmt::format("{}{}", out.empty() ? "" : " ", option);
  }
  return out;
}

StageOptions stage_options(const FlatScene& scene, const Device& device) {
  return stage_options(scene, device,
                       part_distance(most_buffer_bytes(device), scene.arrays(), device.encoding()));
}

StageOptions stage_options(const FlatScene& scene, const Device& device,
                           std::size_t part_distance) {
  const bool all = for_all_rows();
  StageOptions out{
      fmt::format("-DCAPLET_REAL_WIDTH={} -DCAPLET_LEAF_KIND_BITS={}{}{}{}{}{}{}",
                  device.encoding() == Encoding::wide ? 8 : 1, scene.leaf_kind_bits,
                  !scene.light_nodes.empty() ? " -DCAPLET_LIGHT_TREE" : "",
                  scene.sky_is_unseen ? " -DCAPLET_UNSEEN_SKY" : "",
                  scene.moves() ? " -DCAPLET_MOTION" : "",
                  scene.has_chains || all ? " -DCAPLET_CHAINS" : "",
                  scene.multiscatters() || all ? " -DCAPLET_MULTISCATTER" : "",
                  part_distance > 0 ? fmt::format(" -DCAPLET_PART={}UL", part_distance) : ""),
      {{"shapes", shapes_on_trial(scene.shapes)},
       {"materials", scene.material_kinds()},
       {"textures", scene.texture_kinds()},
       {"lights", scene.light_kinds()},
       {"media", scene.medium_kinds()},
       {"samplers", 0},  // DeviceScene::prepare_for
       {"cameras", 0}},
      false,
      part_distance};
  if (all)
    for (auto& [list, rows] : out.rows) rows = ~std::uint64_t{0};
  // Programs without times have no shapes that move.
  if (!scene.moves()) out.rows.at("shapes") &= ~shapes_with(trait_moves);
  return out;
}

StageOptions StageOptions::together_with(const StageOptions& others) const {
  StageOptions out = others;
  out.clip |= clip;
  if (compiler == others.compiler)
    for (auto& [list, rows_of_list] : out.rows) {
      const auto here = rows.find(list);
      rows_of_list |= here != rows.end() ? here->second : ~std::uint64_t{0};
    }
  return out;
}

Kernels::Kernels(const Device& device, StageOptions options)
    : device_(device),
      options_(std::move(options)),
      local_size_(launch_policy_of(device).local_size) {}

bool Kernels::takes_shares(Stage stage) const {
  return row_of(stage).launch == Launch::shares && device_.encoding() == Encoding::wide;
}

CompileJob Kernels::job_of(Stage stage) const {
  const std::string source = stage_source(stage, options_.rows);
  const std::string options = options_.compiler + (options_.clip ? " -DCAPLET_CLIP" : "");
  const Launch launch = row_of(stage).launch;
  const bool is_one =
      launch == Launch::one || (launch == Launch::one_on_cpus && device_.profile() == Profile::cpu);
  return {row_of(stage).name, source, options_of(source, options),
          is_one || takes_shares(stage) ? 1 : local_size_};
}

std::vector<CompileJob> Kernels::jobs(std::span<const Stage> stages) const {
  std::vector<CompileJob> out;
  for (const Stage stage : stages) out.push_back(job_of(stage));
  return out;
}

void Kernels::compile(std::span<const Stage> stages) {
  std::vector<Stage> missing;
  for (const Stage stage : stages)
    if (!compiled_[static_cast<std::size_t>(stage)]) missing.push_back(stage);
  const auto start = Clock::now();
  const std::vector<CompileJob> all = jobs(missing);
  const std::map<std::string, double> ahead = compile_ahead(device_, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    CompiledKernel compiled = caplet::compile(device_, all[i]);
    const auto before = ahead.find(all[i].kernel);
    compile_seconds_by_stage_.emplace_back(
        all[i].kernel, before != ahead.end() ? before->second : compiled.program.build_seconds());
    compiled_[static_cast<std::size_t>(missing[i])] = Compiled{std::move(compiled)};
  }
  compile_seconds_ += seconds_since(start);
}

void Kernels::run(Stage stage, const Bindings& bindings, std::size_t count, std::size_t first,
                  cl_uint counter) {
  if (count == 0) return;
  auto& compiled = compiled_[static_cast<std::size_t>(stage)];
  CHECK_EQ_(compiled.has_value(), true);
  CHECK_EQ_(counter == CAPLET_NONE || is_counted(stage), true);
  const std::size_t end = first + count;
  cl_uint index = 0;
  const auto set_arguments = [&](const auto& set) {
    cl_call(fmt::format("arguments of kernel '{}'", row_of(stage).name), device_.info().name, set);
  };
  const auto set_end = [&](std::size_t of_chunk) {
    compiled->kernel.setArg(index, narrow<cl_uint>(of_chunk));
  };
  set_arguments([&] {
    index = set_buffers(stage, bindings, options_.part_distance > 0, compiled->kernel);
    set_end(end);
    compiled->kernel.setArg(index + 1, counter);
  });
  const auto start = std::chrono::steady_clock::now();
  if (takes_shares(stage)) {
    launch_shares(device_, compiled->kernel, count);
  } else {
    const std::size_t most = chunk_ > 0 ? chunk_ : count;
    for (; first < end; first += most) {
      const std::size_t chunk_end = std::min(first + most, end);
      set_arguments([&] { set_end(chunk_end); });
      launch_items(device_, compiled->kernel, chunk_end - first, compiled->local_size, first);
    }
  }
  if (!timed_) return;
  device_.finish();
  compiled->seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::pair<std::string, double>> Kernels::seconds_by_stage() const {
  std::vector<std::pair<std::string, double>> out;
  for (std::size_t i = 0; i < compiled_.size(); ++i)
    if (compiled_[i]) out.emplace_back(stage_rows[i].name, compiled_[i]->seconds);
  return out;
}

}  // namespace caplet
