// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "apart.h"

#include <caplet/device.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#ifdef __has_feature
#if __has_feature(thread_sanitizer)
#include <tbb/global_control.h>
#define CAPLET_WITHOUT_WORKERS tbb::global_control(tbb::global_control::max_allowed_parallelism, 1)
#endif
#endif

#include "support/device_choice.h"
#include "support/test_scale.h"

namespace caplet::test {

std::string end_of(pid_t child, double seconds) {
  const auto late = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(child, &status, WNOHANG)) == 0 &&
         std::chrono::steady_clock::now() < late)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  if (ended == 0) {
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    return "hangs";
  }
  if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status));
  return WEXITSTATUS(status) == 0 ? ""
                                  : "ended with exit code " + std::to_string(WEXITSTATUS(status));
}

std::string apart(const std::function<void()>& work, double seconds) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) return "no pipe";
  std::fflush(nullptr);  // or the child writes it as well
  const pid_t child = ::fork();
  if (child == 0) {
    try {
#ifdef CAPLET_WITHOUT_WORKERS
      const auto alone =
          CAPLET_WITHOUT_WORKERS;  // how TBB's threads wait for each other TSan does not see
#endif
      work();
    } catch (const std::exception& error) {
      const std::string text = error.what();
      ::_exit(::write(ends[1], text.data(), text.size()) < 0 ? 3 : 2);
    }
    ::_exit(0);
  }
  const std::string end = end_of(child, seconds);
  std::array<char, 4096> text{};
  const ssize_t count = ::read(ends[0], text.data(), text.size());
  for (const int descriptor : ends) ::close(descriptor);
  return count > 0 ? std::string(text.data(), static_cast<std::size_t>(count)) : end;
}

int times() { return 5 * test_scale(); }

void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

Device device() { return choose_device(test_device_choice()); }

Scene small_scene() {
  using Point = std::array<double, 3>;
  Scene scene;
  scene.add_shape("sphere", {{"radius", 1.0}}, {.name = "ball"});
  scene.add_shape("box", {{"p0", Point{-3, -1, -1}}, {"p1", Point{-1.5, 1, 1}}}, {.name = "box"});
  CapsuleArrays capsules;
  capsules.p0 = {{2, -1, 0}, {3, -1, 0}};
  capsules.p1 = {{2, 1, 0}, {3, 1, 0}};
  capsules.radius0 = {0.4f, 0.3f};
  scene.add_capsules(capsules, {.name = "capsules"});
  scene.set_size(24, 16);
  scene.set_samples_per_pixel(2);
  scene.present();
  return scene;
}

bool equal(const Film& a, const Film& b) {
  if (a.channels() != b.channels()) return false;
  for (const std::string& channel : a.channels()) {
    const bool is_id = channel.ends_with("id");
    if (is_id ? a.ids(channel) != b.ids(channel) : false) return false;
    if (is_id) continue;
    const std::vector<float> one = a.values(channel), other = b.values(channel);
    for (std::size_t i = 0; i < one.size(); ++i)
      if (std::bit_cast<std::uint32_t>(one[i]) != std::bit_cast<std::uint32_t>(other[i]))
        return false;
  }
  return true;
}

}  // namespace caplet::test
