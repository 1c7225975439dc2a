// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/frame_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "import/import.h"
#include "import/poses.h"
#include "present/next_frame.h"
#include "present/open_shutter.h"
#include "scene/frozen.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

constexpr double most_frames = 10'000'000;

std::vector<std::string> numbered_all(const std::vector<std::string>& scenes, std::uint32_t frame) {
  std::vector<std::string> out;
  for (const std::string& scene : scenes) out.push_back(numbered(scene, frame).string());
  return out;
}

/// Returns the number of frames from the first time to the last. A last frame that rounding puts
/// behind the last time counts.
std::uint32_t frames_between(const std::pair<double, double>& seconds, double frames_a_second,
                             const char* flag) {
  const double steps = (seconds.second - seconds.first) * frames_a_second;
  if (!(steps < most_frames))
    throw InputError(SourceLocation{flag},
                     fmt::format("there are {:.3g} frames from {:g} s to {:g} s", steps,
                                 seconds.first, seconds.second));
  return static_cast<std::uint32_t>(std::floor(steps * (1 + 1e-12))) + 1;
}

/// Parses "A:B", two times of which the second is not before the first.
std::pair<double, double> parse_seconds(const std::string& text) {
  const auto number = [&](std::string_view part) {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc() && end == part.data() + part.size() && std::isfinite(value)
               ? value
               : std::numeric_limits<double>::quiet_NaN();
  };
  const std::string_view whole = text;
  const std::size_t middle = std::min(whole.find(':'), whole.size());
  const double first = number(whole.substr(0, middle)),
               last = number(whole.substr(std::min(middle + 1, whole.size())));
  if (!(first <= last))
    throw InputError(SourceLocation{"--play"},
                     fmt::format("'{}' is not A:B, two times in seconds, A not after B", text));
  return {first, last};
}

/// Reads a frame of numbered files or of the models of one.
Scene read_frame(const RenderFlags& options, const FrameSource& source, std::uint32_t frame) {
  if (source.kind == FrameSource::Kind::files)
    return import_files(numbered_all(options.scenes, frame), options.import_options);
  ImportOptions of_frame = options.import_options;
  of_frame.set("model", std::to_string(frame));
  return import_files(options.scenes, of_frame);
}

/// Returns whether there is such a frame, whichever are asked for.
bool has_frame(const RenderFlags& options, const FrameSource& source, std::uint32_t frame) {
  if (source.kind == FrameSource::Kind::models) return frame <= source.range.count;
  return std::ranges::all_of(numbered_all(options.scenes, frame), [](const std::string& scene) {
    std::error_code ignored;
    return fs::exists(scene, ignored);
  });
}

}  // namespace

FrameSource source_of(const RenderFlags& options) {
  const auto refuse = [](const std::string& why) {
    throw InputError(SourceLocation{"--frames"}, why);
  };
  const std::optional<FrameRange> asked =
      options.frames.empty() ? std::nullopt : parse_frames(options.frames);
  FrameSource source;
  source.range = {1, options.turntable, options.turntable};
  const bool has_numbers = std::ranges::any_of(options.scenes, [](const std::string& scene) {
    std::error_code ignored;
    return is_numbered(scene) && !fs::exists(scene, ignored);
  });
  if (!options.poses.empty()) {
    if (has_numbers || options.turntable > 0 || !options.play.empty())
      throw InputError(SourceLocation{"--poses"},
                       "does not go with --turntable, --play and numbered scene files");
    source.kind = FrameSource::Kind::poses;
    const PoseCount count = count_poses(options.poses);
    const std::uint32_t frames =
        count.seconds ? frames_between(*count.seconds, options.frames_a_second, "--poses")
                      : count.poses;
    if (count.seconds) source.begin = count.seconds->first;
    source.range = {1, frames, frames};
    source.pose_count = count.poses;
    source.has_times = count.seconds.has_value();
  } else if (!options.play.empty()) {
    if (has_numbers || options.turntable > 0)
      throw InputError(SourceLocation{"--play"},
                       "does not go with --turntable and numbered scene files");
    const std::pair<double, double> seconds = parse_seconds(options.play);
    const std::uint32_t frames = frames_between(seconds, options.frames_a_second, "--play");
    source.kind = FrameSource::Kind::play;
    source.range = {1, frames, frames};
    source.begin = seconds.first;
    source.has_times = true;
  } else if (options.turntable > 0) {
    if (has_numbers) refuse("numbered scene files do not go with --turntable");
  } else if (has_numbers) {
    source.kind = FrameSource::Kind::files;
    if (!asked) refuse("'all': of numbered scene files it is to be said which, such as 1-100");
    source.range = *asked;
  } else {
    source.kind = FrameSource::Kind::models;
    if (options.import_options.text("model"))
      throw InputError(SourceLocation{"--model"}, "does not go with --frames");
    const auto moves = std::ranges::find_if(options.scenes, [](const std::string& scene) {
      return std::ranges::find(format_of(scene).options, "model") != format_of(scene).options.end();
    });
    if (moves == options.scenes.end())
      refuse(
          "the scene has one frame: several are in files of molecules, in numbered files (####), "
          "or in --turntable N, --poses and --play");
    ImportOptions of_file;
    for (const auto& [name, value] : options.import_options.values())
      if (name == "no-outside" ||
          std::ranges::find(format_of(*moves).options, name) != format_of(*moves).options.end())
        of_file.set(name, value);
    const std::uint32_t count = read_scene(*moves, FileImageReader(), of_file).frames;
    source.range = {1, count, count};
  }
  if (options.shutter > 0 && !source.has_times && source.kind == FrameSource::Kind::poses)
    throw InputError(SourceLocation{"--shutter"},
                     "goes with --turntable, --frames, --play, and --poses that have times");
  if (asked && source.kind != FrameSource::Kind::files) {
    if (asked->last > source.range.last)
      refuse(fmt::format("'{}': there are {} frames", options.frames, source.range.last));
    source.range.first = asked->first;
    source.range.last = asked->last;
  }
  return source;
}

Scene scene_of_frame(const RenderFlags& options, const FrameSource& source, std::uint32_t frame) {
  if (source.has_one_scene()) return import_files(options.scenes, options.import_options);
  Scene out = read_frame(options, source, frame);
  if (options.shutter > 0 && has_frame(options, source, frame + 1))
    move_to_next_frame(out, read_frame(options, source, frame + 1), options.shutter);
  return out;
}

void read_poses_of(const RenderFlags& options, const Scene& scene, FrameSource& source) {
  if (source.kind == FrameSource::Kind::play && !moves(scene))
    throw InputError(SourceLocation{"--play"}, "nothing in the scene moves");
  if (source.kind != FrameSource::Kind::poses) return;
  source.poses = read_poses(options.poses, scene);
  if (source.poses.size() != source.pose_count)
    throw RunError(fmt::format("'{}' has changed while it was read", options.poses));
  if (source.has_times) source.animation.emplace(scene, source.poses);
}

std::vector<SceneEdit> edits_of_frame(const RenderFlags& options, const FrameSource& source,
                                      std::uint32_t frame, const FilmSettings& film) {
  if (!source.animation) return source.poses.at(frame - 1).edits;
  return source.animation->at(source.seconds_of(frame, options.frames_a_second),
                              options.shutter / options.frames_a_second, film);
}

Scene played(const RenderFlags& options, const FrameSource& source, std::uint32_t frame,
             Scene scene) {
  Scene out = seen_from(std::move(scene), source.seconds_of(frame, options.frames_a_second),
                        options.shutter / options.frames_a_second);
  if (source.animation)
    for (const SceneEdit& edit : edits_of_frame(options, source, frame, out.view.film))
      apply_edit(out, edit);
  return out;
}

}  // namespace caplet::cli
