// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/denoising.h"

#include <exception>
#include <utility>

#include "base/error.h"
#include "film/denoise.h"
#include "film/develop.h"
#include "view/detail/snapshot.h"

namespace caplet::view {

Denoising::Denoising(std::function<void()> is_done)
    : is_done_(std::move(is_done)), thread_([this] { run(); }) {}

Denoising::~Denoising() {
  {
    const std::lock_guard lock(mutex_);
    is_ended_ = true;
    ++number_;
  }
  called_.notify_all();
  thread_.join();
}

void Denoising::turn(bool on) {
  is_on_ = on;
  forget();
}

void Denoising::forget() {
  last_ = {};
  const std::lock_guard lock(mutex_);
  ++number_;
  next_.reset();
  done_.reset();
}

bool Denoising::is_idle() const {
  const std::lock_guard lock(mutex_);
  return !is_busy_ && !next_ && !done_;
}

void Denoising::begin(NoisyImage image) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(image);
  }
  called_.notify_all();
}

bool Denoising::has_new() {
  std::string error;
  {
    const std::lock_guard lock(mutex_);
    error = std::exchange(error_, {});
    if (error.empty() && done_) {
      last_.at(done_eye_) = std::move(*done_);
      done_.reset();
      return true;
    }
  }
  if (error.empty()) return false;
  turn(false);
  throw RunError(error);
}

void Denoising::improve(Picture& picture) const {
  const Cleaned& of = last_.at(static_cast<std::size_t>(picture.eye));
  if (of.samples == 0 || of.color.size() != picture.color.size()) return;
  picture.color = of.color;
  picture.is_denoised = true;
}

void Denoising::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    called_.wait(lock, [this] { return is_ended_ || next_; });
    if (is_ended_) return;
    NoisyImage image = std::move(*next_);
    next_.reset();
    is_busy_ = true;
    const std::uint64_t number = number_;
    lock.unlock();
    std::optional<Cleaned> done;
    std::string error;
    try {
      const bool is_complete = denoise(image.image, DenoiseQuality::quick, [&] {
        const std::lock_guard again(mutex_);
        return number_ == number;
      });
      if (is_complete) {
        if (!is_put_under_by_page(image.backdrop)) put_under(image.image, image.backdrop);
        done = Cleaned{image.samples, shown_of(image.image, false, false).color};
      }
    } catch (const std::exception& problem) {
      error = problem.what();
    }
    lock.lock();
    is_busy_ = false;
    if (number_ == number) {
      done_ = std::move(done);
      done_eye_ = image.eye;
      error_ = error;
    }
    lock.unlock();
    is_done_();
    lock.lock();
  }
}

}  // namespace caplet::view
