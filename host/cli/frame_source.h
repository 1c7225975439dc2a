// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where the frames of a sequence come from.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cli/frames.h"
#include "cli/render_flags.h"
#include "present/pose_animation.h"
#include "scene/pose.h"

namespace caplet::cli {

/// The source of frames: a turntable camera, numbered files, the models of one file, poses, or a
/// scene that moves.
struct FrameSource {
  enum class Kind { turntable, files, models, poses, play } kind = Kind::turntable;
  FrameRange range;
  std::uint32_t pose_count = 0;
  bool has_times = false;  // whether frames have times: of --play, and of poses with times
  double begin = 0;        // seconds, of the first frame
  std::vector<ScenePose> poses = {};  // by frame, from 1, or the keys
  std::optional<PoseAnimation> animation = {};
  /// Returns whether all frames are of one scene.
  bool has_one_scene() const { return kind != Kind::files && kind != Kind::models; }
  /// Returns when a frame begins, of a source that has times.
  double seconds_of(std::uint32_t frame, double frames_a_second) const {
    return begin + (frame - 1) / frames_a_second;
  }
};

/// Returns the source that the options name, without its poses. Throws InputError.
FrameSource source_of(const RenderFlags& options);

/// Reads the scene of a frame.
Scene scene_of_frame(const RenderFlags& options, const FrameSource& source, std::uint32_t frame);

/// Reads the poses of a source that has some. Throws InputError, also for a scene of --play that
/// does not move, and RunError where the file has changed since source_of().
void read_poses_of(const RenderFlags& options, const Scene& scene, FrameSource& source);

/// Returns what a frame of poses changes of the scene, whose film is `film`.
std::vector<SceneEdit> edits_of_frame(const RenderFlags& options, const FrameSource& source,
                                      std::uint32_t frame, const FilmSettings& film);

/// Returns the scene as a frame of a source with times shows it. `scene` moves.
Scene played(const RenderFlags& options, const FrameSource& source, std::uint32_t frame,
             Scene scene);

}  // namespace caplet::cli
