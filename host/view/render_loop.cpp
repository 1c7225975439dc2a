// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/render_loop.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"

namespace caplet::view {

namespace {

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
    if (tools_.films.has_more() && tools_.clients.is_seen()) step();
  } catch (const Superseded&) {
    tools_.films.drop();
  } catch (const InputError& error) {  // the scene cannot have such a view
    tools_.server.send_to_all(error_text(error.what()));
  }
}

void RenderLoop::begin(const ShowView& look) {
  tools_.films.begin(look);
  if (tools_.films.eyes() == 1) tools_.clients.show_one_eye();
}

void RenderLoop::step() {
  tools_.films.step([this](bool is_coarse) {
    answer_all();
    // A coarse picture is always shown, because nothing else appears while the camera moves.
    if (!is_coarse && tools_.clients.is_superseded()) throw Superseded();
  });
  auto picture = std::make_shared<const Picture>(tools_.films.picture());
  const auto eye = static_cast<std::size_t>(picture->eye);
  tools_.clients.show(eye, std::move(picture));
  tools_.server.picture_changed();
  if (tools_.films.is_full()) tools_.keeping.pause();
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
