// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures without noise for the page.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "film/image.h"
#include "scene/backdrop.h"
#include "view/picture.h"

namespace caplet::view {

/// NoisyImage is a developed picture with albedo and normals, before a backdrop is put under it.
struct NoisyImage {
  LayeredImage image;
  std::optional<Backdrop> backdrop;
  std::uint32_t samples = 0;
  std::size_t eye = 0;
};

/// Denoising removes noise from one picture at a time, on a thread of its own, and remembers the
/// last one of each eye. The renderer's thread calls the public functions.
class Denoising {
 public:
  /// `is_done` is called on the other thread after each picture.
  explicit Denoising(std::function<void()> is_done);
  /// Abandons the picture in progress.
  ~Denoising();
  Denoising(const Denoising&) = delete;
  Denoising& operator=(const Denoising&) = delete;

  bool is_on() const { return is_on_; }
  /// Turned off, it forgets all pictures.
  void turn(bool on);
  /// Forgets the pictures, which are of another view from now on.
  void forget();
  bool is_idle() const;
  void begin(NoisyImage image);
  /// Returns whether a picture has been finished since the last call. Throws RunError of the
  /// denoiser, after which it is off.
  bool has_new();
  /// Returns how many samples the last picture of an eye was made of; 0: there is none.
  std::uint32_t samples(std::size_t eye) const { return last_.at(eye).samples; }
  /// Puts the last picture of its eye in the place of a picture's colours, if there is one.
  void improve(Picture& picture) const;

 private:
  struct Cleaned {
    std::uint32_t samples = 0;
    std::vector<std::uint16_t> color;
  };

  void run();

  const std::function<void()> is_done_;
  bool is_on_ = true;
  std::array<Cleaned, 2> last_;

  mutable std::mutex mutex_;  // guards everything below
  std::condition_variable called_;
  std::uint64_t number_ = 0;  // of the picture that is wanted
  std::optional<NoisyImage> next_;
  std::optional<Cleaned> done_;
  std::size_t done_eye_ = 0;
  std::string error_;
  bool is_busy_ = false, is_ended_ = false;
  std::thread thread_;
};

}  // namespace caplet::view
