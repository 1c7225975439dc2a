// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Output files: written beside their target and renamed into place, so that a killed run never leaves a broken file; streamed
// into what is no regular file. Nothing that a run reads or writes elsewhere is written over.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace caplet {

/// Makes `target` hold what `write` writes to the path it is called with, which is a regular file to be opened for writing.
/// Symbolic links are followed, also to a file that is not there yet.
/// - A new or a regular file: a file beside it is renamed over it. A new file's mode is by the umask; an old one's mode stays,
/// and
///   its owner where that is allowed. When `write` throws, the target is as before. Where a rename is refused (a mount point),
///   the contents are copied into the target. A process that is killed meanwhile leaves that file, `.STEM.PID.N.partEXT`: the
///   next one that writes to the same name removes it, as nobody holds its lock.
/// - A fifo, a character device or one of this process's standard streams: a temporary file is copied into it.
/// Throws RunError when that fails, and for a target that is a folder, a block device, a socket or a noted input (NotedInputs).
void write_atomically(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write);

/// The same for contents that are in memory.
void write_bytes(const std::filesystem::path& target, std::string_view bytes);

/// Removes the files that write_atomically is writing in this process, for ends that run no destructors. Safe in handlers of
/// signals.
void remove_temporary_files() noexcept;

/// Throws InputError naming `flag` when write_atomically could not write there (missing folder, no permission, a folder, a block
/// device, a loop of links, a name too long).
void check_writable(const std::filesystem::path& target, const std::string& flag);

/// Whether something that is no regular file stands there, such as a device, or one of this process's standard streams: its name
/// then says nothing of a format.
bool is_stream(const std::filesystem::path& target);

/// While one lives, files that are read are noted, and write_atomically and Outputs refuse to replace them: a command of the
/// program has one. Where there is none, as in the library, a file may be read, changed and written over.
class NotedInputs {
 public:
  NotedInputs();
  ~NotedInputs();
  NotedInputs(const NotedInputs&) = delete;
  NotedInputs& operator=(const NotedInputs&) = delete;
};

/// To be called for each file that is read. A file that does not exist is ignored.
void note_input(const std::filesystem::path& path);
/// A file that has been read may be replaced from now on.
void forget_input(const std::filesystem::path& path);
/// The names of the files that are noted, sorted.
std::vector<std::string> noted_inputs();

/// The outputs of a run, by option. No two may be the same file, whatever their names and links, nor one that is read.
class Outputs {
 public:
  /// Throws InputError naming `flag` when check_writable does, and when `target` is an earlier output.
  void add(const std::string& flag, const std::filesystem::path& target);
  /// Throws InputError naming the output that is among the files noted as input.
  void check_inputs() const;

 private:
  struct Output {
    std::string flag;
    std::filesystem::path target;
  };
  std::vector<Output> outputs_;
};

}  // namespace caplet
