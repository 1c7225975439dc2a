// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/denoise.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/own_file.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

constexpr const char* file_name = "libOpenImageDenoise.so.2";
constexpr const char* remedy =
    "`pip install pyoidn` or the system's package brings it; CAPLET_OIDN names its file elsewhere";

/// The functions of Open Image Denoise 2 that are used (its oidn.h).
struct Library {
  using Device = struct OpaqueDevice*;
  using Filter = struct OpaqueFilter*;
  Device (*new_device)(int type);
  void (*set_device_bool)(Device, const char* name, bool value);
  int (*get_device_int)(Device, const char* name);
  void (*commit_device)(Device);
  int (*get_device_error)(Device, const char** message);
  void (*release_device)(Device);
  Filter (*new_filter)(Device, const char* type);
  void (*set_image)(Filter, const char* name, void* pixels, int format, std::size_t width,
                    std::size_t height, std::size_t offset, std::size_t pixel_bytes,
                    std::size_t row_bytes);
  void (*set_filter_bool)(Filter, const char* name, bool value);
  void (*set_filter_int)(Filter, const char* name, int value);
  void (*set_monitor)(Filter, bool (*)(void* user, double share), void* user);
  void (*commit_filter)(Filter);
  void (*execute_filter)(Filter);
  void (*release_filter)(Filter);
};

constexpr int device_cpu = 1;     // OIDN_DEVICE_TYPE_CPU: pixels lie in the host's memory
constexpr int format_float3 = 3;  // OIDN_FORMAT_FLOAT3
constexpr int quality_balanced = 5, quality_high = 6;  // OIDN_QUALITY_BALANCED, OIDN_QUALITY_HIGH

/// Returns where the library may be: a file, or a name for the loader.
std::vector<fs::path> candidates() {
  if (const char* named = std::getenv("CAPLET_OIDN"); named && *named) return {named};
  const fs::path of_pyoidn = fs::path("pyoidn") / "oidn" / "lib" / file_name;
  std::vector<fs::path> out{file_name};
  // The Python package that this code is in, or that of the environment in use.
  fs::path folder = own_file().parent_path();
  for (int level = 0; level < 4 && folder.has_relative_path();
       ++level, folder = folder.parent_path())
    out.push_back(folder / of_pyoidn);
  std::vector<fs::path> roots{"/usr/local/lib", "/usr/lib"};
  if (const char* environment = std::getenv("VIRTUAL_ENV"))
    roots.insert(roots.begin(), fs::path(environment) / "lib");
  if (const char* home = std::getenv("HOME")) roots.push_back(fs::path(home) / ".local" / "lib");
  std::error_code error;
  for (const fs::path& root : roots)
    for (const fs::directory_entry& entry : fs::directory_iterator(root, error))
      if (entry.path().filename().string().starts_with("python3"))
        for (const char* packages : {"site-packages", "dist-packages"})
          out.push_back(entry.path() / packages / of_pyoidn);
  return out;
}

Library library_of(void* handle) {
  Library out{};
  const auto find = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(::dlsym(handle, name));
    if (!function)
      throw RunError(fmt::format("Open Image Denoise has no {}: version 2 is needed", name));
  };
  find(out.new_device, "oidnNewDevice");
  find(out.set_device_bool, "oidnSetDeviceBool");
  find(out.get_device_int, "oidnGetDeviceInt");
  find(out.commit_device, "oidnCommitDevice");
  find(out.get_device_error, "oidnGetDeviceError");
  find(out.release_device, "oidnReleaseDevice");
  find(out.new_filter, "oidnNewFilter");
  find(out.set_image, "oidnSetSharedFilterImage");
  find(out.set_filter_bool, "oidnSetFilterBool");
  find(out.set_filter_int, "oidnSetFilterInt");
  find(out.set_monitor, "oidnSetFilterProgressMonitorFunction");
  find(out.commit_filter, "oidnCommitFilter");
  find(out.execute_filter, "oidnExecuteFilter");
  find(out.release_filter, "oidnReleaseFilter");
  return out;
}

/// Returns the library, loaded at the first call that succeeds. Throws RunError.
const Library& library() {
  static std::mutex mutex;
  static std::map<std::string, Library> loaded;  // by CAPLET_OIDN
  const std::lock_guard lock(mutex);
  const char* const named = std::getenv("CAPLET_OIDN");
  const std::string key = named ? named : "";
  if (const auto found = loaded.find(key); found != loaded.end()) return found->second;
  std::string why;
  for (const fs::path& path : candidates()) {
    if (void* const handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
      return loaded.emplace(key, library_of(handle)).first->second;
    const std::string error = ::dlerror();
    if (why.empty() || error.find("No such file") == std::string::npos) why = error;
  }
  throw RunError(fmt::format("Open Image Denoise cannot be loaded ({}); {}", why, remedy));
}

using RgbPixels = std::vector<std::array<float, 3>>;

/// A device, and what is done with it.
class Denoiser {
 public:
  explicit Denoiser(const std::function<bool()>& goes_on = {})
      : goes_on_(goes_on), oidn_(library()), device_(oidn_.new_device(device_cpu)) {
    if (!device_) check();
    oidn_.set_device_bool(device_, "setAffinity", false);  // its threads are not the only ones
    oidn_.commit_device(device_);
    check();
  }
  ~Denoiser() {
    if (device_) oidn_.release_device(device_);
  }
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  std::string version() const {
    return fmt::format("{}.{}.{}", oidn_.get_device_int(device_, "versionMajor"),
                       oidn_.get_device_int(device_, "versionMinor"),
                       oidn_.get_device_int(device_, "versionPatch"));
  }

  struct Input {
    const char* name;
    RgbPixels* pixels;
  };
  /// Runs the filter of ray-traced pictures. Its output replaces the first input. Returns false if
  /// it was ended.
  bool run(const std::vector<Input>& inputs, int quality, bool is_hdr, bool has_clean_guides,
           std::size_t width, std::size_t height) const {
    const std::unique_ptr<OpaqueFilter, void (*)(Library::Filter)> filter(
        oidn_.new_filter(device_, "RT"), oidn_.release_filter);
    check();
    RgbPixels output(width * height);
    const auto set = [&](const char* name, RgbPixels& pixels) {
      oidn_.set_image(filter.get(), name, pixels.data(), format_float3, width, height, 0, 0, 0);
    };
    for (const Input& input : inputs) set(input.name, *input.pixels);
    set("output", output);
    oidn_.set_filter_int(filter.get(), "quality", quality);
    oidn_.set_filter_bool(filter.get(), "hdr", is_hdr);
    oidn_.set_filter_bool(filter.get(), "cleanAux", has_clean_guides);
    Monitor monitor{goes_on_};
    if (goes_on_) oidn_.set_monitor(filter.get(), &Monitor::ask, &monitor);
    oidn_.commit_filter(filter.get());
    oidn_.execute_filter(filter.get());
    check(monitor.is_ended);
    if (monitor.is_ended) return false;
    *inputs.front().pixels = std::move(output);
    return true;
  }

 private:
  struct Monitor {
    const std::function<bool()>& goes_on;
    bool is_ended = false;

    static bool ask(void* user, double /*share*/) {
      auto& of = *static_cast<Monitor*>(user);
      of.is_ended = of.is_ended || !of.goes_on();
      return !of.is_ended;
    }
  };

  /// Throws the device's error, unless it is that the filter was ended.
  void check(bool is_ended = false) const {
    const char* message = nullptr;
    if (oidn_.get_device_error(device_, &message) != 0 && !is_ended)
      throw RunError(fmt::format("Open Image Denoise: {}", message ? message : "an unknown error"));
  }

  const std::function<bool()> goes_on_;
  const Library& oidn_;
  Library::Device device_;
};

using Names = std::array<const char*, 3>;
constexpr Names color = {"R", "G", "B"}, albedo = {"albedo.R", "albedo.G", "albedo.B"},
                normal = {"N.X", "N.Y", "N.Z"}, noisy = {"noisy.R", "noisy.G", "noisy.B"};

/// Returns three channels as one; nothing where one is missing.
RgbPixels gathered(const LayeredImage& image, const Names& names) {
  RgbPixels out;
  for (const std::size_t c : {0U, 1U, 2U}) {
    const Channel* channel = image.find(names[c]);
    if (!channel) return {};
    out.resize(channel->floats.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i][c] = channel->floats[i];
  }
  return out;
}

}  // namespace

void check_denoiser(const std::string& flag) {
  try {
    library();
  } catch (const RunError& error) {
    throw RunError(fmt::format("{}: {}", flag, error.what()));
  }
}

bool has_denoiser() {
  try {
    library();
    return true;
  } catch (const RunError&) {
    return false;
  }
}

std::string denoiser_name() { return "Open Image Denoise " + Denoiser().version(); }

bool denoise(LayeredImage& image, DenoiseQuality quality, const std::function<bool()>& goes_on) {
  const auto width = static_cast<std::size_t>(image.data_width),
             height = static_cast<std::size_t>(image.data_height);
  RgbPixels picture = gathered(image, color), albedos = gathered(image, albedo),
            normals = gathered(image, normal);
  const Denoiser denoiser(goes_on);
  std::vector<Denoiser::Input> inputs{{"color", &picture}};
  const bool is_guided = !albedos.empty() && !normals.empty();
  if (is_guided) {
    // A better filter for the guides takes twice the time for the same FLIP (decision 36).
    if (!denoiser.run({{"albedo", &albedos}}, quality_balanced, false, false, width, height) ||
        !denoiser.run({{"normal", &normals}}, quality_balanced, false, false, width, height))
      return false;
    inputs.push_back({"albedo", &albedos});
    inputs.push_back({"normal", &normals});
  }
  const int of_picture = quality == DenoiseQuality::full ? quality_high : quality_balanced;
  if (!denoiser.run(inputs, of_picture, true, is_guided, width, height)) return false;
  std::vector<Channel> before;
  for (const std::size_t c : {0U, 1U, 2U})
    for (Channel& channel : image.channels)
      if (channel.name == color[c]) {
        before.push_back({noisy[c], std::move(channel.floats), {}});
        channel.floats.resize(picture.size());
        for (std::size_t i = 0; i < picture.size(); ++i) channel.floats[i] = picture[i][c];
      }
  image.channels.insert(image.channels.end(), std::make_move_iterator(before.begin()),
                        std::make_move_iterator(before.end()));
  return true;
}

}  // namespace caplet
