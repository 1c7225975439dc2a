// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "program.h"

#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "support/data.h"
#include "support/device_choice.h"

namespace caplet::test {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

namespace {

std::vector<std::string> on_test_device(std::vector<std::string> arguments,
                                        const std::map<std::string, std::string>& environment) {
  const std::string device = test_device_choice();
  const auto says = [&](const char* word) {
    return std::ranges::find(arguments, word) != arguments.end();
  };
  const bool own_drivers = environment.contains("POCL_DEVICES") ||
                           environment.contains("OCL_ICD_VENDORS") ||
                           environment.contains("OPENCL_VENDOR_PATH");
  if (device.empty() || arguments.empty() || own_drivers || says("--device") ||
      says("--all-devices"))
    return arguments;
  for (const char* command : {"render", "pick", "verify"})
    if (arguments[0] == command) {
      arguments.insert(arguments.begin() + 1, {"--device", device});
      break;
    }
  return arguments;
}

[[noreturn]] void become_program(const std::vector<std::string>& arguments, const fs::path& folder,
                                 const std::map<std::string, std::string>& environment) {
  if (::chdir(folder.c_str()) != 0) ::_exit(126);
  // Kernels that no other test finds are those of the scene alone, which are quicker to build.
  if (environment.contains("POCL_CACHE_DIR") || environment.contains("POCL_DEVICES"))
    ::setenv("CAPLET_ROWS", "scene", 1);
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  const char* other = std::getenv("CAPLET_TEST_PROGRAM");  // a mutant's
  std::vector<std::string> owned{other ? other : CAPLET_PROGRAM};
  const std::vector<std::string> given = on_test_device(arguments, environment);
  owned.insert(owned.end(), given.begin(), given.end());
  std::vector<char*> argv;
  for (std::string& argument : owned) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

void redirect(const fs::path& path, int descriptor) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ::dup2(file, descriptor) < 0) ::_exit(126);
  ::close(file);
}

void set_exit(Result& result, int status) {
  if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
}

Clock::time_point deadline_in(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

Running::Running(const std::vector<std::string>& arguments, const fs::path& folder,
                 const std::map<std::string, std::string>& environment,
                 const std::function<void()>& in_child, Stderr stderr_is)
    : streams_(temporary_folder()) {
  int its_end = -1;
  winsize size{30, 100, 0, 0};
  if (stderr_is == Stderr::terminal &&
      ::openpty(&terminal_, &its_end, nullptr, nullptr, &size) != 0)
    throw std::runtime_error("openpty failed");
  process_ = ::fork();
  if (process_ < 0) throw std::runtime_error("fork failed");
  if (process_ > 0) {
    if (its_end >= 0) ::close(its_end);
    if (terminal_ >= 0) reader_ = std::thread([this] { read_terminal(); });
    return;
  }
  redirect(streams_ / "out", STDOUT_FILENO);
  if (its_end < 0) {
    redirect(streams_ / "err", STDERR_FILENO);
  } else {
    if (::dup2(its_end, STDERR_FILENO) < 0) ::_exit(126);
    ::close(its_end);
    ::close(terminal_);
    ::setenv("TERM", "xterm", 1);
  }
  // What this process may have been told to ignore.
  for (const int number : {SIGHUP, SIGINT, SIGTERM, SIGPIPE}) ::signal(number, SIG_DFL);
  if (in_child) in_child();
  become_program(arguments, folder, environment);
}

Running::~Running() {
  if (!ended()) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, &status_, 0);
  }
  if (reader_.joinable()) reader_.join();
  if (terminal_ >= 0) ::close(terminal_);
}

/// Writes what comes into the file that stderr would be, until the program has ended.
void Running::read_terminal() {
  std::ofstream to(streams_ / "err", std::ios::binary);
  char buffer[4096];
  for (ssize_t count; (count = ::read(terminal_, buffer, sizeof buffer)) > 0;)
    to.write(buffer, count).flush();
}

bool Running::ended() {
  if (!ended_) ended_ = ::waitpid(process_, &status_, WNOHANG) == process_;
  return ended_;
}

void Running::send(int signal) const { ::kill(process_, signal); }

bool Running::wait_for_stderr(const std::string& text, double seconds) {
  const auto deadline = deadline_in(seconds);
  for (;;) {
    const bool over = ended() || Clock::now() > deadline;
    if (read_file(streams_ / "err").find(text) != std::string::npos) return true;
    if (over) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

Result Running::wait(double seconds) {
  const auto deadline = deadline_in(seconds);
  while (!ended()) {
    if (Clock::now() > deadline) ::kill(process_, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (reader_.joinable()) reader_.join();
  Result result;
  set_exit(result, status_);
  result.out = read_file(streams_ / "out");
  result.err = read_file(streams_ / "err");
  return result;
}

Result run_program(const std::vector<std::string>& arguments, const fs::path& folder,
                   const std::map<std::string, std::string>& environment,
                   const std::function<void()>& in_child) {
  return Running(arguments, folder, environment, in_child).wait();
}

Result run_on_terminal(const std::vector<std::string>& arguments, const fs::path& folder) {
  int terminal = -1;
  winsize size{};
  size.ws_col = 100;
  size.ws_row = 30;
  const pid_t process = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (process < 0) throw std::runtime_error("forkpty failed");
  if (process == 0) become_program(arguments, folder, {{"TERM", "xterm"}});
  Result result;
  char buffer[4096];
  for (ssize_t count; (count = ::read(terminal, buffer, sizeof buffer)) > 0;)
    result.err.append(buffer, static_cast<std::size_t>(count));
  int status = 0;
  ::waitpid(process, &status, 0);
  ::close(terminal);
  set_exit(result, status);
  return result;
}

fs::path folder_with_scene(const std::string& text) {
  const fs::path folder = temporary_folder();
  write_file(folder / "scene.pbrt", text);
  return folder;
}

Result render(const fs::path& folder, std::vector<std::string> arguments,
              const std::function<void()>& in_child) {
  arguments.insert(arguments.begin(), {"render", "scene.pbrt", "-q"});
  return run_program(arguments, folder, {}, in_child);
}

fs::path changed_kernels(const char* file, const std::string& from, const std::string& to) {
  const fs::path folder = temporary_folder();
  fs::copy(source_folder() / "kernels", folder, fs::copy_options::recursive);
  std::string text = read_file(folder / file);
  const std::size_t at = text.find(from);
  if (at == std::string::npos)
    throw std::logic_error(std::string(file) + " does not hold: " + from);
  write_file(folder / file, text.replace(at, from.size(), to));
  return folder;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder))
    out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return out;
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace caplet::test
