// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs the built program in a folder of its own, on the device that tests run on.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace caplet::test {

struct Result {
  int code = -1;   // exit code; -1 when a signal ended it
  int signal = 0;  // that signal
  std::string out, err;
};

/// The program at work: its streams go to files beside `folder`, so that the folder shows only what
/// the program makes. Where CAPLET_TEST_DEVICE is set, `render`, `pick` and `verify` get it as
/// their `--device`, unless the test says which device or which drivers they are to see.
class Running {
 public:
  /// On a terminal the first progress is shown at once, elsewhere after five seconds.
  enum class Stderr { file, terminal };
  /// `in_child`: called in the process before it becomes the program.
  Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
          const std::map<std::string, std::string>& environment = {},
          const std::function<void()>& in_child = {}, Stderr stderr_is = Stderr::file);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void send(int signal) const;
  /// Waits until stderr holds `text`; false when the program ended or `seconds` passed first.
  bool wait_for_stderr(const std::string& text, double seconds = 120);
  /// Waits for the end; kills the program after `seconds`.
  Result wait(double seconds = 300);

 private:
  bool ended();
  void read_terminal();
  int terminal_ = -1;
  std::thread reader_;
  pid_t process_ = -1;
  int status_ = 0;
  bool ended_ = false;
  std::filesystem::path streams_;
};

/// Runs to the end.
Result run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                   const std::map<std::string, std::string>& environment = {},
                   const std::function<void()>& in_child = {});

/// Runs with a terminal as its stderr and stdout; what it printed there.
Result run_on_terminal(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder);

/// A capsule under a white sky: 24 x 16 pixels, 2 samples.
inline constexpr const char* small_scene =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n"
    "Sampler \"independent\" \"integer pixelsamples\" 2\nWorldBegin\nLightSource \"infinite\"\n"
    "Shape \"capsule\" \"point3 p0\" [-.5 0 0] \"point3 p1\" [.5 0 0] \"float radius\" 0.6\n";

/// A fresh folder with this text as scene.pbrt.
std::filesystem::path folder_with_scene(const std::string& text = small_scene);

/// `render scene.pbrt -q` with more arguments.
Result render(const std::filesystem::path& folder, std::vector<std::string> arguments,
              const std::function<void()>& in_child = {});

/// A copy of the kernels in which `from` of one file became `to`. Throws std::logic_error where the
/// file does not hold it.
std::filesystem::path changed_kernels(const char* file, const std::string& from,
                                      const std::string& to);

/// Names in a folder, sorted.
std::vector<std::string> names_in(const std::filesystem::path& folder);

std::vector<std::string> lines_of(const std::string& text);

void write_file(const std::filesystem::path& path, const std::string& text);
std::string read_file(const std::filesystem::path& path);

}  // namespace caplet::test
