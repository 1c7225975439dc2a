// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The public classes from several threads, which begin at the same time.
#include <caplet/pick.h>
#include <caplet/render.h>
#include <caplet/session.h>
#include <caplet/verify.h>
#include <unistd.h>

#include <atomic>
#include <barrier>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "apart.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;

/// Calls all of them at the same time; throws what the first of them threw.
void together(const std::vector<std::function<void()>>& works) {
  std::barrier start(static_cast<std::ptrdiff_t>(works.size()));
  std::vector<std::exception_ptr> failures(works.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < works.size(); ++i)
    threads.emplace_back([&, i] {
      start.arrive_and_wait();
      try {
        works[i]();
      } catch (...) {
        failures[i] = std::current_exception();
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

TEST(Threads, FindDevicesAtTheSameTime) {
  for (int i = 0; i < times(); ++i)
    ASSERT_EQ(apart([] {
                std::vector<std::size_t> found(4);
                std::vector<std::function<void()>> works;
                for (std::size_t& count : found)
                  works.emplace_back([&count] { count = devices().size(); });
                together(works);
                for (const std::size_t count : found)
                  require(count > 0 && count == found[0], "a thread found no device");
              }),
              "");
}

void render_for_the_first_time() {
  const Scene scene = small_scene();
  std::vector<std::optional<Film>> films(3);
  std::vector<std::function<void()>> works;
  for (std::optional<Film>& film : films)
    works.emplace_back([&] { film = render(scene, device()); });
  together(works);
  for (const auto& film : films)
    require(equal(*film, *films[0]), "threads render different pictures");
}

TEST(Threads, UseOpenClForTheFirstTime) {
  for (int i = 0; i < times(); ++i) ASSERT_EQ(apart(render_for_the_first_time), "");
}

TEST(Threads, CompileTheSameKernelsAtTheSameTime) {
  const fs::path folder =
      fs::temp_directory_path() / ("caplet-threads-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const auto work = [&folder] {
    for (const char* name : {"POCL_CACHE_DIR", "CAPLET_CACHE"}) ::setenv(name, folder.c_str(), 1);
    ::setenv("CAPLET_ROWS", "scene", 1);  // nothing else finds these kernels: few are enough
    render_for_the_first_time();
  };
  EXPECT_EQ(apart(work, 500), "");
  fs::remove_all(folder);
}

TEST(Threads, ShareADeviceAndAScene) {
  for (int i = 0; i < times(); ++i)
    ASSERT_EQ(apart([] {
                Scene scene = small_scene();
                const Device on = device();
                std::optional<Film> one, other;
                std::size_t hits = 0;
                const Scene copy = scene;
                together({[&] { one = render(copy, on); }, [&] { other = render(Scene(copy), on); },
                          [&] {
                            Picker picker(copy, on);
                            for (int x = 0; x < 24; ++x) hits += picker.pixel(x, 8) ? 1 : 0;
                          },
                          [&] {
                            for (int k = 0; k < 100; ++k)
                              scene.set_seed(static_cast<std::uint32_t>(k));
                          }});
                const Film alone = render(copy, device());
                require(equal(*one, alone) && equal(*other, alone),
                        "a picture differs from that of one thread");
                require(hits > 4, "no hits");
                require(verify(scene, std::vector{on}, {1000, 0, {}}).agrees(), "verify disagrees");
              }),
              "");
}

TEST(Threads, CancelASessionAndReadItsFilms) {
  for (int i = 0; i < times(); ++i)
    ASSERT_EQ(apart([] {
                Session session(small_scene(), device());
                session.render(1);
                std::atomic<bool> is_begun = false;
                int done = 0;
                together({[&] {
                            done = session.render(
                                1 << 24, {{}, [&](const RenderProgress&) { is_begun = true; }});
                          },
                          [&] {
                            while (!is_begun) std::this_thread::yield();
                            session.cancel();
                          }});
                require(done > 0 && done < 1 << 24, "it was not cancelled");
                const Film film = session.film();
                std::vector<float> reds[2];
                together({[&] { reds[0] = Film(film).values("R"); },
                          [&] { reds[1] = Film(film).values("R"); }});
                require(!reds[0].empty() && reds[0] == reds[1], "a film differs between threads");
              }),
              "");
}

}  // namespace
}  // namespace caplet::test
