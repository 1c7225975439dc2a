// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The renderer's thread of a viewer.
#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "view/detail/clients.h"
#include "view/detail/denoising.h"
#include "view/detail/edit_desk.h"
#include "view/detail/eye_films.h"
#include "view/detail/keeping.h"
#include "view/detail/picker.h"
#include "view/server.h"

namespace caplet::view {

/// The renderer's thread works with these. They must outlive the loop. All but clients and server
/// belong to that thread.
struct RenderTools {
  Clients& clients;
  Server& server;
  EyeFilms& films;
  Picker& picker;
  EditDesk& desk;
  Keeping& keeping;
  Denoising* denoising = nullptr;  // null: pictures stay as they are
};

/// Renders and answers on its own thread until the clients' session ends. The owner's thread calls
/// the public functions.
class RenderLoop {
 public:
  explicit RenderLoop(const RenderTools& tools);
  /// Joins the thread; Clients::end() must have been called.
  ~RenderLoop();
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  /// Waits a short time, and throws the error that has ended rendering, if any.
  void wait(double seconds);

 private:
  // The renderer's thread calls these.
  void run();
  void work();
  void begin(const ShowView& look);
  void step();
  void make_figure(const Clients::AskedFigure& asked);
  void answer_all();
  void show(Picture picture);
  void denoise();

  RenderTools tools_;
  std::mutex mutex_;  // guards the failure
  std::condition_variable failed_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace caplet::view
