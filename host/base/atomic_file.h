// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Output files are written beside their target and renamed into place, so that a killed run never
// leaves a broken file; other targets than regular files are streams. A run's inputs and other
// outputs are never overwritten.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// Calls `write` with the path of a regular file to be opened for writing, and makes its content
/// that of `target`. Symbolic links are followed, even if their target does not exist yet.
/// - A new or a regular file: a file beside it is renamed over it. A new file's mode is by the
/// umask; an old one keeps its
///   mode, and
///   its owner where that is allowed. When `write` throws, the target is as before. Where a rename
///   is refused (a mount point), the contents are copied into the target. A process that is killed
///   meanwhile leaves that file, `.STEM.PID.N.partEXT`: the next one that writes to the same name
///   removes it, as nobody holds its lock.
/// - A fifo, a character device or one of this process's standard streams: a temporary file is
/// copied into it. Throws RunError when that fails, and for a target that is a folder, a block
/// device, a socket or a noted input (NotedInputs).
void write_atomically(const std::filesystem::path& target,
                      const std::function<void(const std::filesystem::path&)>& write);

/// Does the same for contents in memory.
void write_bytes(const std::filesystem::path& target, std::string_view bytes);

/// Removes the files that write_atomically is writing in this process, for exits that run no
/// destructors. It is safe in signal handlers.
void remove_temporary_files() noexcept;

/// Throws InputError that names `flag` when write_atomically could not write there (missing folder,
/// no permission, a folder, a block device, a loop of links, a name too long).
void check_writable(const std::filesystem::path& target, const std::string& flag);

/// Returns whether the path is a device or another non-regular file, or one of this process's
/// standard streams: its name then does not determine a format.
bool is_stream(const std::filesystem::path& target);

/// While an instance exists, files that are read are noted, and write_atomically and Outputs refuse
/// to replace them. Each command of the program has one. Without one, as in the library, a file may
/// be read, changed and overwritten.
class NotedInputs {
 public:
  NotedInputs();
  ~NotedInputs();
  NotedInputs(const NotedInputs&) = delete;
  NotedInputs& operator=(const NotedInputs&) = delete;
};

/// Must be called for each file that is read. A file that does not exist is ignored.
void note_input(const std::filesystem::path& path);
/// Allows replacing a file that has been read.
void forget_input(const std::filesystem::path& path);
/// Returns the names of the noted files, sorted.
std::vector<std::string> noted_inputs();

/// The outputs of a run, by option. They must differ from each other and from all inputs, whatever
/// their names and links.
class Outputs {
 public:
  /// Throws InputError that names `flag` when check_writable does, and when `target` is an earlier
  /// output.
  void add(const std::string& flag, const std::filesystem::path& target);
  /// Throws InputError that names an output which is also a noted input.
  void check_inputs() const;

 private:
  struct Output {
    std::string flag;
    std::filesystem::path target;
  };
  std::vector<Output> outputs_;
};

}  // namespace caplet
