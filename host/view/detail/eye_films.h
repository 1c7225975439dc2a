// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The films of the picture that pages look at.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "lower/live_scene.h"
#include "render/session.h"
#include "view/detail/denoising.h"
#include "view/editor.h"
#include "view/messages.h"
#include "view/picture.h"
#include "view/viewer_options.h"

namespace caplet::view {

/// Renders one look, of one eye or two, coarsely at first. Both eyes share one session: the film of
/// the other eye waits here. Where the film has a least width of lines, pictures are of a copy of
/// the scene, and queries still see it as it is. Only the renderer's thread calls it.
class EyeFilms {
 public:
  /// The scene and its editor must outlive this. Sends the scene to the device. `denoises`: films
  /// have the layers that denoising needs.
  EyeFilms(LiveScene& live, const Editor& editor, const Device& device,
           const ViewerOptions& options, bool denoises);

  /// Returns the scene on the device as it is, for queries.
  DeviceScene& device_scene() const { return *session_.scene_on(0); }
  /// Returns the scene that pictures are of, which may have wider lines, for queries.
  DeviceScene& drawn_scene() const { return *drawn().scene_on(0); }
  const ShowView& look() const { return look_; }
  std::size_t eyes() const { return look_.separation > 0 ? 2 : 1; }
  /// Returns the samples per pixel of a finished picture, and of one with a noise the most.
  std::uint32_t target() const;
  /// Returns ViewerOptions.noise, or else, without a number of samples either, the scene's; 0: any.
  double noise_target() const;
  bool has_more() const {
    return scale_ != 1 || (samples_[eyes() - 1] < target() && !has_little_noise());
  }
  bool has_snapshot() const { return scale_ == 1 && samples_[0] > 0; }
  bool is_full() const { return scale_ == 1; }
  /// Returns for how long the view and the scene have been as they are.
  double seconds() const { return seconds_since(begun_); }
  /// Returns the samples of an eye's picture at full scale; 0 if it is coarse.
  std::uint32_t samples(std::size_t eye) const { return scale_ == 1 ? samples_.at(eye) : 0; }

  /// Starts the picture of another look, or of a changed scene. Throws InputError.
  void begin(const ShowView& look);
  /// Drops the picture in progress.
  void drop() { scale_ = 0; }
  /// Renders the next samples. `between_batches` may throw to end it; its argument says whether the
  /// picture is the first one of a view, which is coarse.
  void step(const std::function<void(bool is_first)>& between_batches);

  /// Returns the picture of the eye that the last step rendered, or of another one that has
  /// samples.
  Picture picture() { return picture(eye_); }
  Picture picture(std::size_t eye);
  /// Returns the same to be denoised.
  NoisyImage noisy(std::size_t eye);
  /// Returns the picture of the first eye as the bytes of an EXR file.
  std::string snapshot();
  /// Renders a figure, as figure_png does.
  std::string figure(const MakeFigure& asked, const std::function<bool(double share)>& goes_on);

 private:
  void look_with(const ShowView& look, int scale, std::size_t eye);
  void set_film(const ShowView& look, int scale);
  void change_eyes();
  std::uint32_t samples_of_step(std::size_t eye, double pixels) const;
  bool has_little_noise() const;
  Film film(std::size_t eye);
  const Session& drawn() const { return wide_ ? wide_->session : session_; }
  Session& drawn() { return wide_ ? wide_->session : session_; }
  void widen(const View& full, int scale, bool has_changed);

  /// The scene with lines of FilmSettings::least_width for one view of the full picture.
  struct Wide {
    Wide(Scene scene, const Device& device, const SessionOptions& options);
    LiveScene live;
    Session session;
    View view;
    std::vector<glm::dvec3> places;  // some centres of lines
    double seconds = 0;              // that it took to widen and send it
  };

  LiveScene& live_;
  const Editor& editor_;
  ViewerOptions options_;
  SessionOptions session_options_;
  Device device_;
  Session session_;             // of the scene as it is
  std::unique_ptr<Wide> wide_;  // where lines have a least width
  ShowView look_;
  std::uint64_t version_ = 0;
  std::uint32_t view_ = 1;
  std::array<std::uint32_t, 2> samples_{};  // for both eyes
  std::array<double, 2> noise_{};           // of their last pictures
  std::array<std::optional<Film>, 2> films_;
  std::size_t eye_ = 0;  // the eye whose film is in the session
  int scale_ = 0;        // of the film; 0: it is empty
  int first_scale_ = 1;  // of the view's first film
  double paths_a_second_;
  Clock::time_point begun_ = Clock::now();
};

}  // namespace caplet::view
