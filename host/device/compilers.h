// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Kernels are compiled in several processes at a time. Threads would not do: drivers hold a lock
// while they compile (PoCL 3.1: two threads take as long as one).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/device.h"

namespace caplet {

/// CompileJob is a kernel to compile for launches in groups of `local_size` at most. Its program is
/// `source` compiled with `options`, both as Program::from_source takes them.
struct CompileJob {
  std::string kernel, source, options;
  std::size_t local_size = 1;
};

struct CompiledKernel {
  Program program;
  cl::Kernel kernel;
  std::size_t local_size = 1;  // the job's, or less where the kernel allows no more
};

/// Compiles a job in this process, or loads it from a cache. Throws RunError.
CompiledKernel compile(const Device& device, const CompileJob& job);

/// Names the program whose command `compile` calls compile_jobs_of(0): the program itself names its
/// own file. Without a name, as in libraries, kernels are compiled in one process.
void set_compiler_program(const std::filesystem::path& program);

/// Returns how many processes, with this one, may compile at a time: the environment variable
/// CAPLET_COMPILERS, 1 to 64, else the machine's processors, at most 8; 1 without a compiler
/// program. Throws InputError for another text of the variable.
std::size_t compiler_count();

/// Compilers is a list of jobs that processes share, of which this is one.
class Compilers {
 public:
  /// Starts at most `processes` processes; fewer, or none, where the system refuses them.
  Compilers(const Device& device, std::span<const CompileJob> jobs, std::size_t processes);
  /// Ends the processes.
  ~Compilers();
  Compilers(const Compilers&) = delete;
  Compilers& operator=(const Compilers&) = delete;

  std::size_t process_count() const { return children_.size(); }
  /// Returns the first job that no process has taken, which this process is to compile; nothing
  /// when all are taken.
  std::optional<std::size_t> take();
  /// Waits until the processes have compiled what they took. Throws RunError when interrupted.
  void wait();
  /// Returns the seconds that another process took for a job; nothing if none has compiled it. A
  /// process that fails or crashes leaves its job to this one, which then reports the error.
  std::optional<double> seconds(std::size_t job) const;

 private:
  class List;
  void end();
  int file_ = -1;
  std::size_t bytes_ = 0;
  void* shared_ = nullptr;
  std::vector<pid_t> children_;
};

/// Takes jobs of the list that a Compilers of another process shares by this open file, and
/// compiles them, until none is left. Ends with that process. Throws InputError if the file holds
/// no such list, and RunError when a job fails.
void compile_jobs_of(int file);

}  // namespace caplet
