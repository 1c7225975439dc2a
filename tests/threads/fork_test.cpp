// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Processes that are forked before, after and while OpenCL is used.
#include <caplet/device.h>
#include <caplet/import.h>
#include <caplet/pick.h>
#include <caplet/render.h>
#include <caplet/session.h>
#include <caplet/verify.h>
#include <caplet/write.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apart.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;

constexpr double plenty = 60;  // seconds, of what takes none

/// Throws unless `call` throws the RunError that says what to do.
void refused(const std::string& name, const std::function<void()>& call) {
  std::string said = "nothing";
  try {
    call();
  } catch (const RunError& error) {
    said = error.what();
  }
  require(said.find("spawn") != std::string::npos, name + " in a forked process says " + said);
}

TEST(Fork, BeforeOpenClIsUsedChangesNothing) {
  for (int i = 0; i < times(); ++i)
    ASSERT_EQ(apart([] {
                const Scene scene = small_scene();
                for (const char* child : {"a child: ", "a second child: "}) {
                  const std::string end = apart([&] { render(scene, device()); }, plenty);
                  require(end.empty(), child + end);
                }
                render(scene, device());
              }),
              "");
}

/// All calls that need a device, and destructors of what has one.
void all_that_need_a_device() {
  const Scene scene = small_scene();
  std::optional<Device> on = device();
  std::optional<Session> session(std::in_place, scene, *on);
  session->render(2);
  const Film film = session->film();
  std::optional<Picker> picker(std::in_place, scene, *on);
  require(picker->pixel(12, 8).has_value(), "nothing is there");
  const std::string child = apart(
      [&] {
        const Ray ray{{0, 0, 9}, {0, 0, -1}};
        Crossing crossing;
        refused("check_process", [] { check_process(); });
        refused("devices", [] { devices(); });
        refused("choose_device", [] { choose_device(); });
        refused("choose_devices", [] { choose_devices("all"); });
        refused("render", [&] { render(scene, *on); });
        refused("Session", [&] { Session(scene, *on); });
        refused("Session::update", [&] { session->update(scene); });
        refused("Session::render", [&] { session->render(1); });
        refused("Session::film", [&] { session->film(); });
        refused("Session::resume", [&] { session->resume(film); });
        refused("Session::pixel", [&] { session->pixel(1, 1); });
        refused("Session::nearest", [&] { session->nearest(ray); });
        refused("Session::nearest of many", [&] { session->nearest({&ray, 1}, {&crossing, 1}); });
        refused("Session::all", [&] { session->all({&ray, 1}); });
        refused("Session::crossings", [&] { session->crossings({&ray, 1}); });
        refused("Picker", [&] { Picker(scene, *on); });
        refused("Picker::pixel", [&] { picker->pixel(1, 1); });
        refused("Picker::nearest", [&] { picker->nearest(ray); });
        refused("Picker::nearest of many", [&] { picker->nearest({&ray, 1}, {&crossing, 1}); });
        refused("Picker::all", [&] { picker->all({&ray, 1}); });
        refused("Picker::crossings", [&] { picker->crossings({&ray, 1}); });
        refused("verify", [&] { verify(std::vector{*on}); });
        refused("verify of a scene", [&] { verify(scene, std::vector{*on}); });
        session->cancel();
        require(film.values("R").size() == 24u * 16, "a film is not there");
        session.reset();
        picker.reset();
        on.reset();
        require(apart([] { refused("a grandchild", [] { devices(); }); }, plenty).empty(),
                "a grandchild is not refused");
      },
      plenty);
  require(child.empty(), child);
  session->render(2);
  require(session->film().samples_per_pixel() == 4, "the parent does not go on");
}

TEST(Fork, AfterOpenClWasUsedIsRefusedByAllThatNeedsADevice) {
  for (int i = 0; i < times(); ++i) ASSERT_EQ(apart(all_that_need_a_device), "");
}

TEST(Fork, LeavesScenesUsable) {
  const fs::path file =
      fs::temp_directory_path() / ("caplet-fork-" + std::to_string(::getpid()) + ".pbrt");
  EXPECT_EQ(apart([&file] {
              Scene scene = small_scene();
              render(scene, device());
              require(apart(
                          [&] {
                            scene.add_shape("sphere", {{"radius", 0.5}}, {.name = "more"});
                            scene.present();
                            write_scene(scene, file);
                            require(import_scene(file).shapes().back() == "more",
                                    "the scene is another");
                          },
                          plenty)
                          .empty(),
                      "a child cannot work with scenes");
            }),
            "");
  fs::remove(file);
}

TEST(Fork, DuringARenderOfAnotherThreadIsRefusedAndEnds) {
  EXPECT_EQ(apart(
                [] {
                  const Scene scene = small_scene();
                  const Device on = device();
                  std::optional<Session> session(std::in_place, scene, on);
                  session->render(1);
                  std::atomic<bool> is_over = false;
                  std::thread renders([&] {
                    while (!is_over) session->render(16);
                  });
                  std::string bad;
                  for (int i = 0; i < 2 * times() && bad.empty(); ++i)
                    bad = apart(
                        [&] {
                          refused("devices", [] { devices(); });
                          refused("render", [&] { render(scene, on); });
                          refused("Session::film", [&] { session->film(); });
                          session.reset();  // what the driver's threads hold is let go
                        },
                        plenty);
                  is_over = true;
                  renders.join();
                  require(bad.empty(), bad);
                  session->update(scene);
                  session->render(2);
                  require(equal(session->film(), render(scene, on)),
                          "the parent's picture is wrong");
                },
                500),
            "");
}

/// The child comes out of the progress function into its parent's call.
TEST(Fork, WithinARenderEndsItInTheChild) {
  for (int i = 0; i < times(); ++i)
    ASSERT_EQ(apart([] {
                const Scene scene = small_scene();
                const Device on = device();
                const Film alone = render(scene, on);
                pid_t child = -1;
                const auto progress = [&](const RenderProgress&) {
                  std::fflush(nullptr);
                  if (child < 0) child = ::fork();
                };
                std::string said;
                std::optional<Film> film;
                try {
                  film = render(scene, on, {{}, progress});
                } catch (const RunError& error) {
                  said = error.what();
                }
                if (child == 0) ::_exit(said.find("spawn") == std::string::npos ? 1 : 0);
                require(child > 0 && end_of(child, plenty).empty(),
                        "the child does not end with an error");
                require(film && equal(*film, alone), "the parent's picture is wrong");
              }),
              "");
}

}  // namespace
}  // namespace caplet::test
