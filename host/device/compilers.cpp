// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/compilers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <functional>
#include <new>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "base/check.h"
#include "base/environment.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/threads.h"
#include "device/bundled.h"
#include "device/cache.h"
#include "device/detail/programs.h"

extern char** environ;

namespace caplet {

namespace fs = std::filesystem;

namespace {

constexpr const char* variable = "CAPLET_COMPILERS";
constexpr std::size_t most_by_default = 8, most_by_variable = 64;
constexpr std::uint64_t process_bytes = std::uint64_t{512} << 20;  // PoCL 3.1 takes half of it
constexpr char list_magic[16] = "caplet compile1";

fs::path& compiler_program() {
  static fs::path program;
  return program;
}

/// Text is a text of the shared file.
struct Text {
  std::uint64_t begin = 0, size = 0;
};

/// The shared file holds a Header, its Rows, and the texts.
struct Header {
  char magic[16] = {};
  std::int64_t parent = 0;  // process id
  std::int64_t device = 0;  // DeviceInfo::index
  Text device_name;
  std::uint64_t count = 0;
  std::atomic<std::uint64_t> taken = 0;
};

struct Row {
  Text kernel, source, options;
  std::uint64_t local_size = 1;
  std::atomic<double> seconds = -1;  // negative until the job is done
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free &&
                  std::atomic<double>::is_always_lock_free,
              "processes share them");

Row* rows_of(void* shared) {
  return std::launder(reinterpret_cast<Row*>(static_cast<char*>(shared) + sizeof(Header)));
}
Header* header_of(void* shared) { return std::launder(static_cast<Header*>(shared)); }

std::optional<std::size_t> take_from(void* shared) {
  const std::uint64_t job = header_of(shared)->taken.fetch_add(1);
  if (job >= header_of(shared)->count) return std::nullopt;
  return job;
}

constexpr const char* marks = "compiled";  // the extension of the marks' files

/// Returns the key of the file that says that PoCL's cache has the job.
std::string mark_of(const Device& device, const CompileJob& job) {
  const DeviceInfo& info = device.info();
  return fmt::format("compiled {:?} {:?} {:?} {:?} {:?} {:x} {}", info.name, info.driver,
                     info.version, used_cache_folder(info.bundled).string(), job.options,
                     std::hash<std::string>()(job.source), job.local_size);
}

}  // namespace

bool is_cached(const Device& device, const CompileJob& job) {
  std::error_code error;
  if (!device.is_pocl())
    return fs::is_regular_file(
        cache_file(cache_key(device.info(), job.options, job.source), "program"), error);
  return fs::is_directory(used_cache_folder(device.info().bundled), error) &&
         fs::is_regular_file(cache_file(mark_of(device, job), marks), error);
}

CompiledKernel compile(const Device& device, const CompileJob& job) {
  Program program = Program::from_source(device, job.kernel, job.source, job.options);
  cl::Kernel kernel = program.kernel(job.kernel);
  const std::size_t local = local_size_for(device, kernel, job.local_size);
  program.prepare(job.kernel, local);
  if (device.is_pocl() && !is_cached(device, job)) cache_store(mark_of(device, job), marks, {});
  return {std::move(program), std::move(kernel), local};
}

namespace {

std::size_t default_count() {
  std::size_t out = std::clamp<std::size_t>(usable_threads(), 1, most_by_default);
  if (const auto free = free_memory()) out = std::min<std::size_t>(out, 1 + *free / process_bytes);
  return out;
}

}  // namespace

void set_compiler_program(const fs::path& program) { compiler_program() = program; }

std::size_t compiler_count() {
  const std::string text = environment_variable(variable);
  std::size_t count = default_count();
  if (!text.empty()) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, count);
    if (error != std::errc() || rest != end || count < 1 || count > most_by_variable)
      throw InputError(
          SourceLocation{variable},
          fmt::format("'{}' is not a number of processes, 1 to {}", text, most_by_variable));
  }
  return compiler_program().empty() ? 1 : count;
}

Compilers::Compilers(const Device& device, std::vector<CompileJob> jobs, std::size_t processes)
    : device_(device), jobs_(std::move(jobs)) {
  std::ranges::stable_sort(jobs_, std::greater(),
                           [](const CompileJob& job) { return job.source.size(); });
  if (share()) start(std::min(processes, jobs_.size()));
}

bool Compilers::share() {
  const std::string& name = device_.info().name;
  const std::size_t texts = sizeof(Header) + jobs_.size() * sizeof(Row);
  bytes_ = texts + name.size();
  for (const CompileJob& job : jobs_)
    bytes_ += job.kernel.size() + job.source.size() + job.options.size();
  file_ = ::memfd_create("caplet-compile", MFD_CLOEXEC);
  if (file_ < 0 || ::ftruncate(file_, narrow<off_t>(bytes_)) != 0) return false;
  void* const shared = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (shared == MAP_FAILED) return false;
  shared_ = shared;

  std::size_t at = texts;
  const auto put = [&](const std::string& text) {
    std::memcpy(static_cast<char*>(shared_) + at, text.data(), text.size());
    at += text.size();
    return Text{at - text.size(), text.size()};
  };
  auto* const header = new (shared_) Header;
  std::memcpy(header->magic, list_magic, sizeof list_magic);
  header->parent = ::getpid();
  header->device = device_.info().index;
  header->device_name = put(name);
  header->count = jobs_.size();
  for (std::size_t i = 0; i < jobs_.size(); ++i) {
    auto* const row = new (static_cast<char*>(shared_) + sizeof(Header) + i * sizeof(Row)) Row;
    row->kernel = put(jobs_[i].kernel);
    row->source = put(jobs_[i].source);
    row->options = put(jobs_[i].options);
    row->local_size = jobs_[i].local_size;
  }
  return true;
}

void Compilers::start(std::size_t processes) {
  const std::string program = compiler_program().string();
  std::string name = "caplet", command = "compile";
  char* arguments[] = {name.data(), command.data(), nullptr};
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, file_, STDIN_FILENO);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&streams, stream, "/dev/null", O_WRONLY, 0);
  while (children_.size() < processes) {
    pid_t child = 0;
    if (::posix_spawn(&child, program.c_str(), &streams, nullptr, arguments, environ) != 0) break;
    children_.push_back(child);
  }
  posix_spawn_file_actions_destroy(&streams);
}

Compilers::~Compilers() {
  for (const pid_t child : children_) {
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
  }
  if (shared_) ::munmap(shared_, bytes_);
  if (file_ >= 0) ::close(file_);
}

void Compilers::finish() {
  if (!shared_) return;
  std::size_t done_here = 0;
  for (; const auto job = take_from(shared_); ++done_here) {
    if (interrupt_requested()) throw RunError("interrupted");
    seconds_[jobs_[*job].kernel] = compile(device_, jobs_[*job]).program.build_seconds();
  }
  wait(done_here);
  for (std::size_t i = 0; i < jobs_.size(); ++i)
    if (const double seconds = rows_of(shared_)[i].seconds; seconds >= 0)
      seconds_[jobs_[i].kernel] = seconds;
}

/// Waits until the processes have compiled all but what was `done_here`, or have ended.
void Compilers::wait(std::size_t done_here) {
  constexpr std::chrono::milliseconds a_while(5);
  const std::span<const Row> rows(rows_of(shared_), jobs_.size());
  while (std::cmp_less(std::ranges::count_if(rows, [](const Row& row) { return row.seconds >= 0; }),
                       rows.size() - done_here)) {
    std::erase_if(children_, [](pid_t child) { return ::waitpid(child, nullptr, WNOHANG) != 0; });
    if (interrupt_requested()) throw RunError("interrupted");
    if (children_.empty()) return;
    std::this_thread::sleep_for(a_while);
  }
}

std::map<std::string, double> compile_ahead(const Device& device, std::vector<CompileJob> jobs) {
  const std::size_t processes = compiler_count();
  if (processes == 1) return {};
  std::erase_if(jobs, [&](const CompileJob& job) { return is_cached(device, job); });
  if (jobs.size() < 2) return {};
  const std::size_t count = jobs.size();
  Compilers compilers(device, std::move(jobs), std::min(processes, count) - 1);
  log::info("compiling {} kernels in {} processes", count, compilers.process_count() + 1);
  compilers.finish();
  return compilers.seconds();
}

void compile_jobs_of(int file) {
  const InputError no_list("the file is no list of jobs of another process of Caplet");
  struct stat about {};
  if (::fstat(file, &about) != 0 || !S_ISREG(about.st_mode) ||
      about.st_size < narrow<off_t>(sizeof(Header)))
    throw no_list;
  const auto bytes = static_cast<std::size_t>(about.st_size);
  void* const shared = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (shared == MAP_FAILED) throw no_list;
  const Header& header = *header_of(shared);
  const std::uint64_t count = header.count;
  if (std::memcmp(header.magic, list_magic, sizeof list_magic) != 0 ||
      count > (bytes - sizeof(Header)) / sizeof(Row))
    throw no_list;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{};  // for drivers that crash
  ::setrlimit(RLIMIT_CORE, &no_core);
  if (::getppid() != header.parent) return;  // that process ended before prctl
  const auto text_of = [&](Text text) {
    if (text.begin > bytes || text.size > bytes - text.begin) throw no_list;
    return std::string(static_cast<const char*>(shared) + text.begin, text.size);
  };
  const Device device = Device::choose(std::to_string(header.device));
  if (device.info().name != text_of(header.device_name))
    throw RunError("the device is not that of the other process");
  while (const auto taken = take_from(shared)) {
    Row& row = rows_of(shared)[*taken];
    const CompileJob job{text_of(row.kernel), text_of(row.source), text_of(row.options),
                         row.local_size};
    row.seconds = compile(device, job).program.build_seconds();
  }
}

}  // namespace caplet
