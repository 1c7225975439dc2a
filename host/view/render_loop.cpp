// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/render_loop.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.h"
#include "base/error.h"

namespace caplet::view {

namespace {

constexpr double rest_seconds = 1;           // after which a picture is denoised
constexpr double figure_told_seconds = 0.2;  // between what a page is told of its figure

/// Thrown when a new view is requested, to abandon the picture in progress.
struct Superseded {};

}  // namespace

RenderLoop::RenderLoop(const RenderTools& tools) : tools_(tools), thread_([this] { run(); }) {}

RenderLoop::~RenderLoop() { thread_.join(); }

void RenderLoop::wait(double seconds) {
  std::unique_lock lock(mutex_);
  failed_.wait_for(lock, std::chrono::duration<double>(seconds),
                   [this] { return failure_ != nullptr; });
  if (failure_) std::rethrow_exception(failure_);
}

void RenderLoop::run() try {
  while (tools_.clients.wait_for_work(tools_.films.has_more())) work();
} catch (...) {
  const std::lock_guard lock(mutex_);
  failure_ = std::current_exception();
  failed_.notify_all();
}

void RenderLoop::work() {
  answer_all();
  try {
    const bool has_changed = tools_.desk.make_all(tools_.server);
    const std::optional<ShowView> look = tools_.clients.take_look();
    if (has_changed || look) begin(look.value_or(tools_.films.look()));
    while (const std::optional<Clients::AskedFigure> asked = tools_.clients.take_figure())
      make_figure(*asked);
    if (tools_.films.has_more() && tools_.clients.is_seen()) step();
    if (tools_.denoising) denoise();
  } catch (const Superseded&) {
    tools_.films.drop();
  } catch (const InputError& error) {  // the scene cannot have such a view
    tools_.server.send_to_all(error_text(error.what()));
  }
}

void RenderLoop::begin(const ShowView& look) {
  tools_.films.begin(look);
  if (tools_.denoising) tools_.denoising->forget();
  if (tools_.films.eyes() == 1) tools_.clients.show_one_eye();
}

void RenderLoop::step() {
  tools_.films.step([this](bool is_first) {
    answer_all();
    // The first picture is always shown, because nothing else appears while the camera moves.
    if (!is_first && tools_.clients.is_superseded()) throw Superseded();
  });
  show(tools_.films.picture());
  if (tools_.films.is_full()) tools_.keeping.pause();
}

void RenderLoop::show(Picture picture) {
  if (tools_.denoising && picture.scale == 1) tools_.denoising->improve(picture);
  const auto eye = static_cast<std::size_t>(picture.eye);
  tools_.clients.show(eye, std::make_shared<const Picture>(std::move(picture)));
  tools_.server.picture_changed();
}

/// Shows what has been denoised, and begins the next picture: after a rest each time that the
/// samples have doubled, and at the end.
void RenderLoop::denoise() {
  Denoising& denoising = *tools_.denoising;
  EyeFilms& films = tools_.films;
  const auto show_all = [&] {
    for (std::size_t eye = 0; eye < films.eyes(); ++eye)
      if (films.samples(eye) > 0) show(films.picture(eye));
  };
  if (const std::optional<bool> on = tools_.clients.take_denoise()) {
    denoising.turn(*on);
    show_all();
  }
  try {
    if (denoising.has_new()) show_all();
  } catch (const RunError& error) {
    tools_.clients.greet_with({{"denoise", false}});
    tools_.server.send_to_all(text_of({{"type", "denoise"}, {"on", false}}));
    tools_.server.send_to_all(error_text(error.what()));
    return show_all();
  }
  if (!denoising.is_on() || !denoising.is_idle()) return;
  if (films.has_more() && films.seconds() < rest_seconds) return;
  for (std::size_t eye = 0; eye < films.eyes(); ++eye) {
    const std::uint32_t before = denoising.samples(eye), now = films.samples(eye);
    if (now > before && (now >= 2 * before || !films.has_more()))
      return denoising.begin(films.noisy(eye));
  }
}

void RenderLoop::make_figure(const Clients::AskedFigure& asked) try {
  Clock::time_point told = Clock::now();
  const auto tell = [&](double share) {
    told = Clock::now();
    tools_.server.send(
        asked.from,
        text_of({{"type", "figuring"}, {"number", asked.figure.number}, {"share", share}}));
  };
  tell(0);
  std::string png = tools_.films.figure(asked.figure, [&](double share) {
    if (seconds_since(told) > figure_told_seconds) tell(share);
    return tools_.clients.wants_figure(asked.from);
  });
  if (!png.empty())
    tools_.server.send(asked.from, std::make_shared<const std::string>(std::move(png)), true);
} catch (const InputError& error) {
  tools_.server.send(asked.from, error_text(error.what(), asked.figure.number));
} catch (const RunError& error) {  // the device may have no room for a second scene
  tools_.server.send(asked.from, error_text(error.what(), asked.figure.number));
}

void RenderLoop::answer_all() {
  while (const std::optional<Clients::Asked> asked =
             tools_.clients.take_question(tools_.films.has_snapshot())) {
    if (asked->question)
      tools_.server.send(asked->from, tools_.picker.answer(*asked->question, tools_.films.look()));
    else
      tools_.server.send(asked->from, std::make_shared<const std::string>(tools_.films.snapshot()),
                         true);
  }
}

}  // namespace caplet::view
