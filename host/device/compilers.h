// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Kernels are compiled in several processes at a time. Threads would not do: drivers hold a lock
// while they compile (PoCL 3.1: two threads take as long as one).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <map>
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

/// Returns whether a cache should have the job, so that to compile it takes some 10 ms.
bool is_cached(const Device& device, const CompileJob& job);

/// Names the program whose command `compile` calls compile_jobs_of(0): the program itself names its
/// own file. Without a name, as in libraries, kernels are compiled in one process.
void set_compiler_program(const std::filesystem::path& program);

/// Returns how many processes, with this one, may compile at a time: the environment variable
/// CAPLET_COMPILERS, 1 to 64, else the machine's processors, at most 8 and one more for each 512 MB
/// of free memory; 1 without a compiler program. Throws InputError for another text of the
/// variable.
std::size_t compiler_count();

/// Compilers is a list of jobs that processes share, of which this is one.
class Compilers {
 public:
  /// Starts `processes` processes, at most as many as there are jobs; fewer, or none, where the
  /// system refuses them. They begin with the jobs of the longest texts, which take longest.
  Compilers(const Device& device, std::vector<CompileJob> jobs, std::size_t processes);
  /// Ends the processes.
  ~Compilers();
  Compilers(const Compilers&) = delete;
  Compilers& operator=(const Compilers&) = delete;

  std::size_t process_count() const { return children_.size(); }
  /// Compiles jobs here that no process has taken, until none is left, and waits for the others. A
  /// process that fails or crashes leaves its job: to compile that again reports the error. Throws
  /// RunError, also when interrupted.
  void finish();
  /// Returns the seconds that a process, or this one, took for each compiled kernel.
  const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  bool share();
  void start(std::size_t processes);
  void wait(std::size_t done_here);
  Device device_;
  std::vector<CompileJob> jobs_;
  int file_ = -1;
  std::size_t bytes_ = 0;
  void* shared_ = nullptr;
  std::vector<pid_t> children_;
  std::map<std::string, double> seconds_;
};

/// Compiles those of the jobs that no cache has, in several processes if there are several. Returns
/// the seconds that each of these kernels took.
std::map<std::string, double> compile_ahead(const Device& device, std::vector<CompileJob> jobs);

/// Takes jobs of the list that a Compilers of another process shares by this open file, and
/// compiles them, until none is left. Ends with that process. Throws InputError if the file holds
/// no such list, and RunError when a job fails.
void compile_jobs_of(int file);

}  // namespace caplet
