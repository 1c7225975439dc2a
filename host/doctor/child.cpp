// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "doctor/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "base/clock.h"
#include "base/error.h"

namespace caplet::doctor {

namespace {

constexpr int exit_threw = 100;

struct Pipe {
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
      throw RunError(fmt::format("no pipe: {}", std::strerror(errno)));
  }
  ~Pipe() {
    close_read();
    close_write();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_read() { close_end(ends[0]); }
  void close_write() { close_end(ends[1]); }
  static void close_end(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
  /// Reads the available data; returns false at the end.
  bool take(std::string& to) const {
    std::array<char, 4096> buffer{};
    const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
    if (count > 0) to.append(buffer.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
  }
  std::array<int, 2> ends{-1, -1};
};

void write_all(int to, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t count = ::write(to, text.data() + at, text.size() - at);
    if (count <= 0) ::_exit(exit_threw);
    at += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void be_child(const std::function<std::string()>& work, pid_t parent,
                           const Pipe& answer, const Pipe& noise) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(exit_threw);  // the parent ended before prctl
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(noise.ends[1], STDOUT_FILENO);
  ::dup2(noise.ends[1], STDERR_FILENO);
  try {
    write_all(answer.ends[1], work());
  } catch (const std::exception& error) {
    write_all(answer.ends[1], error.what());
    ::_exit(exit_threw);
  }
  ::_exit(0);  // skips destructors, because a driver's may crash
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \r\n");
  if (end == std::string::npos) return {};
  const std::size_t begin = text.rfind('\n', end);
  return text.substr(begin == std::string::npos ? 0 : begin + 1,
                     end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

}  // namespace

ChildEnd in_child(const std::function<std::string()>& work, double seconds,
                  const std::function<bool()>& stop) {
  Pipe answer, noise;
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw RunError(fmt::format("no child process: {}", std::strerror(errno)));
  if (child == 0) be_child(work, parent, answer, noise);
  ::setpgid(child, child);  // here too, because the kill below may come before the child's own call
  answer.close_write();
  noise.close_write();
  for (const Pipe* pipe : {&answer, &noise}) ::fcntl(pipe->ends[0], F_SETFL, O_NONBLOCK);

  ChildEnd out;
  std::string printed;
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(seconds));
  int status = 0;
  bool late = false, stopped = false;
  constexpr int milliseconds = 20;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    stopped = stop && stop();
    if (stopped || Clock::now() > deadline) {
      late = !stopped;
      ::kill(-child, SIGKILL);
      ::waitpid(child, &status, 0);
      break;
    }
    std::array<pollfd, 2> waiting{pollfd{answer.ends[0], POLLIN, 0},
                                  pollfd{noise.ends[0], POLLIN, 0}};
    ::poll(waiting.data(), waiting.size(), milliseconds);
    if (waiting[0].revents & POLLIN) answer.take(out.answer);
    if (waiting[1].revents & POLLIN) noise.take(printed);
    // If a driver closed its end of the pipe, poll would return at once.
    if (((waiting[0].revents | waiting[1].revents) & POLLIN) == 0 &&
        (waiting[0].revents | waiting[1].revents) != 0)
      ::poll(nullptr, 0, milliseconds);
  }
  ::kill(-child, SIGKILL);  // and every process that it started
  for (std::size_t before = 0; answer.take(out.answer) && out.answer.size() != before;)
    before = out.answer.size();
  for (std::size_t before = 0; noise.take(printed) && printed.size() != before;)
    before = printed.size();
  out.said = last_line(printed);
  if (WIFEXITED(status)) out.exit_code = WEXITSTATUS(status);
  if (stopped)
    out.how = "was stopped";
  else if (late)
    out.how = fmt::format("gave no answer in {:g} s", seconds);
  else if (WIFSIGNALED(status))
    out.how =
        fmt::format("ended with signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  else if (WEXITSTATUS(status) == exit_threw)
    out.how = out.answer.empty() ? "failed" : out.answer;
  else if (WEXITSTATUS(status) != 0)
    out.how = fmt::format("ended with exit code {}", WEXITSTATUS(status));
  out.finished = out.how.empty();
  return out;
}

}  // namespace caplet::doctor
