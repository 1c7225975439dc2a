// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/log.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Identifies a file by device and inode, whatever its name; one that does not exist yet by those
/// of its folder, and its name.
struct Identity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;
  bool operator==(const Identity&) const = default;
};

enum class Kind { fresh, file, stream, refused };

struct Place {
  Kind kind = Kind::refused;
  fs::path path;             // after following symbolic links
  struct stat status {};     // not set when fresh or refused
  int descriptor = -1;       // when it is a standard stream: its number
  std::string problem = {};  // why it is refused
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int operator()() const { return number_; }
  /// Returns the result of close(2), which may report the error of an earlier write.
  int close() { return number_ < 0 ? 0 : ::close(std::exchange(number_, -1)); }

 private:
  int number_;
};

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

Place refused(const fs::path& path, const std::string& problem) {
  return {Kind::refused, path, {}, -1, problem};
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

int standard_stream(const struct stat& status) {
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat stream {};
    if (::fstat(descriptor, &stream) == 0 && same_file(stream, status)) return descriptor;
  }
  return -1;
}

/// For a path without a file: returns the path itself, or the one that its symbolic links end at.
fs::path end_of_links(fs::path path) {
  std::error_code error;
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = next.is_absolute() ? next : folder_of(path) / next;
  }
  return path;
}

Place place_of_new(const fs::path& target) {
  const fs::path path = end_of_links(target);
  std::error_code error;
  if (!path.has_filename()) return refused(path, fmt::format("'{}' names no file", path.string()));
  if (!fs::is_directory(folder_of(path), error))
    return refused(path, fmt::format("folder '{}' does not exist", folder_of(path).string()));
  return {Kind::fresh, path};
}

Place place_of(const fs::path& target) {
  if (!target.has_filename())
    return refused(target, fmt::format("'{}' names no file", target.string()));
  Place out{Kind::file, target};
  if (::stat(target.c_str(), &out.status) != 0) {
    if (errno == ENOENT) return place_of_new(target);
    if (errno == ENOTDIR)
      return refused(target, fmt::format("folder '{}' does not exist", folder_of(target).string()));
    if (errno == ELOOP)
      return refused(target, fmt::format("'{}' is a loop of links", target.string()));
    return refused(
        target, fmt::format("'{}' cannot be written: {}", target.string(), std::strerror(errno)));
  }
  const mode_t mode = out.status.st_mode;
  if (S_ISDIR(mode)) return refused(target, fmt::format("'{}' is a folder", target.string()));
  out.descriptor = standard_stream(out.status);
  if (out.descriptor >= 0 || S_ISFIFO(mode) || S_ISCHR(mode)) {
    out.kind = Kind::stream;
    return out;
  }
  if (!S_ISREG(mode))
    return refused(target, fmt::format("'{}' is a {}", target.string(),
                                       S_ISBLK(mode) ? "block device" : "socket"));
  std::error_code error;
  out.path = fs::canonical(target, error);
  struct stat there {};
  if (error || ::stat(out.path.c_str(), &there) != 0 || !same_file(there, out.status))
    return refused(target, fmt::format("'{}' leads to a file that has no name", target.string()));
  return out;
}

/// Returns no value when the folder of a file that does not exist yet cannot be read.
std::optional<Identity> identity_of(const Place& place) {
  if (place.kind != Kind::fresh) return Identity{place.status.st_dev, place.status.st_ino, {}};
  struct stat folder {};
  if (::stat(folder_of(place.path).c_str(), &folder) != 0) return std::nullopt;
  return Identity{folder.st_dev, folder.st_ino, place.path.filename().string()};
}

// --- Inputs ---

struct Inputs {
  std::mutex mutex;
  int keepers = 0;
  std::map<std::pair<dev_t, ino_t>, std::string> names;
};

Inputs& inputs() {
  static Inputs all;
  return all;
}

/// Returns the name under which a regular file was read.
std::optional<std::string> input_at(const Place& place) {
  if (place.kind != Kind::file && place.kind != Kind::stream) return std::nullopt;
  const std::lock_guard lock(inputs().mutex);
  const auto found = inputs().names.find({place.status.st_dev, place.status.st_ino});
  if (found == inputs().names.end()) return std::nullopt;
  return found->second;
}

std::string input_text(const fs::path& target, const std::string& input) {
  return target == input
             ? fmt::format("'{}' is an input of this run", target.string())
             : fmt::format("'{}' is an input of this run ('{}')", target.string(), input);
}

// --- Writing ---

[[noreturn]] void fail(const fs::path& target, const char* what, int code) {
  throw RunError(fmt::format("{}: {}: {}", target.string(), what, std::strerror(code)));
}

void write_all(int to, std::string_view bytes, const fs::path& target) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) fail(target, "cannot be written", errno);
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void copy(int from, int to, const fs::path& target) {
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t count = ::read(from, buffer.data(), buffer.size());
    if (count == 0) return;
    if (count < 0 && errno != EINTR) fail(target, "cannot be written", errno);
    if (count > 0)
      write_all(to, std::string_view(buffer.data(), static_cast<std::size_t>(count)), target);
  }
}

/// Writes into a fifo, a device or a standard stream: first into an unnamed temporary file, which
/// is then copied.
void write_through(const Place& place, const fs::path& target,
                   const std::function<void(const fs::path&)>& write) {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "caplet-XXXXXX").string();
  const Descriptor temporary(::mkostemp(name.data(), O_CLOEXEC));
  if (temporary() < 0) fail(target, "no temporary file for it", errno);
  ::unlink(name.c_str());
  write(fmt::format("/proc/self/fd/{}", temporary()));
  if (::lseek(temporary(), 0, SEEK_SET) != 0) fail(target, "cannot be written", errno);
  if (place.descriptor >= 0) {
    std::fflush(place.descriptor == STDOUT_FILENO ? stdout : stderr);
    copy(temporary(), place.descriptor, target);
    return;
  }
  Descriptor to(::open(place.path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
  if (to() < 0) fail(target, "cannot be written", errno);
  copy(temporary(), to(), target);
  if (to.close() != 0) fail(target, "cannot be written", errno);
}

/// Copies the mode and, if permitted, the owner of the file that is to be replaced.
void set_owner_and_mode(int file, const Place& place) {
  if (place.kind == Kind::fresh) return;
  // Users who may not change the owner keep the file. The mode comes last, because a change of the
  // owner clears bits of it.
  if (::fchown(file, place.status.st_uid, place.status.st_gid) != 0 &&
      ::fchown(file, static_cast<uid_t>(-1), place.status.st_gid) != 0)
    errno = 0;
  ::fchmod(file, place.status.st_mode & 07777);
}

/// Copies over targets that no file can be renamed to, such as mount points.
void copy_over(const fs::path& temporary, const fs::path& target) {
  const Descriptor from(::open(temporary.c_str(), O_RDONLY | O_CLOEXEC));
  Descriptor to(::open(target.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  if (from() < 0 || to() < 0) fail(target, "cannot be replaced", errno);
  copy(from(), to(), target);
  if (to.close() != 0) fail(target, "cannot be written", errno);
}

/// A file name that a signal handler may read.
struct Slot {
  std::atomic<int> state = 0;  // 0 free, 1 being named, 2 in use
  std::array<char, PATH_MAX> name{};
};
std::array<Slot, 8> slots;
static_assert(std::atomic<int>::is_always_lock_free, "handlers of signals use it");

/// Lets remove_temporary_files remove this file during the object's lifetime, except a ninth file,
/// or one with a longer name.
class Listed {
 public:
  explicit Listed(const fs::path& path) {
    if (path.native().size() >= PATH_MAX) return;
    for (Slot& slot : slots) {
      int was = 0;
      if (!slot.state.compare_exchange_strong(was, 1)) continue;
      std::memcpy(slot.name.data(), path.c_str(), path.native().size() + 1);
      slot.state = 2;
      slot_ = &slot;
      return;
    }
  }
  ~Listed() {
    if (slot_) slot_->state = 0;
  }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;

 private:
  Slot* slot_ = nullptr;
};

// --- Temporary files, .STEM.PID.NUMBER.partEXTENSION, also those of killed processes ---

struct TemporaryName {
  explicit TemporaryName(const fs::path& path)
      : before("." + path.stem().string().substr(0, longest) + "."),
        after(".part" + path.extension().string().substr(0, longest)) {}

  std::string next() const {
    static std::atomic<int> serial = 0;
    return fmt::format("{}{}.{}{}", before, ::getpid(), serial++, after);
  }
  /// Returns whether it is a temporary name for the same target, of any process.
  bool is_one(std::string_view name) const {
    if (name.size() < before.size() + after.size() || !name.starts_with(before) ||
        !name.ends_with(after))
      return false;
    return are_numbers(name.substr(before.size(), name.size() - before.size() - after.size()));
  }
  /// Returns whether it is a temporary name for any target.
  static bool is_any(std::string_view name) {
    const std::size_t part = name.rfind(".part");
    if (!name.starts_with('.') || part == std::string_view::npos) return false;
    const std::size_t second = name.rfind('.', part - 1),
                      first = second == 0 ? second : name.rfind('.', second - 1);
    return part > 0 && second != std::string_view::npos && first != std::string_view::npos &&
           first > 0 && are_numbers(name.substr(first + 1, part - first - 1));
  }

 private:
  static constexpr std::size_t longest = 100;  // file systems have limits

  /// The text is "PID.NUMBER".
  static bool are_numbers(std::string_view text) {
    const std::size_t point = text.find('.');
    const auto is_number = [](std::string_view one) {
      return !one.empty() && std::ranges::all_of(one, [](char c) { return c >= '0' && c <= '9'; });
    };
    return point != std::string_view::npos && is_number(text.substr(0, point)) &&
           is_number(text.substr(point + 1));
  }

  std::string before, after;
};

/// Returns the temporary files in a folder when this process first writes there. Newer ones belong
/// to live processes, or to processes that died since; the next run removes those.
std::vector<std::string>& found_in(const fs::path& folder) {
  static std::map<fs::path, std::vector<std::string>> all;
  const auto [at, is_new] = all.try_emplace(folder);
  std::error_code error;
  if (is_new)
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
      if (std::string name = entry->path().filename().string(); TemporaryName::is_any(name))
        at->second.push_back(std::move(name));
  return at->second;
}

/// Removes this user's temporary file if its lock is free, which means that its process has ended.
void remove_if_left(const fs::path& file) {
  const Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  struct stat status {};
  if (descriptor() < 0 || ::fstat(descriptor(), &status) != 0) return;
  if (!S_ISREG(status.st_mode) || status.st_uid != ::geteuid()) return;
  if (::flock(descriptor(), LOCK_EX | LOCK_NB) == 0 && ::unlink(file.c_str()) == 0)
    log::info("removed {}, which a run that was killed has left", file.string());
}

void remove_left_of(const fs::path& path) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const TemporaryName name(path);
  std::error_code error;
  std::erase_if(found_in(fs::absolute(folder_of(path), error)), [&](const std::string& left) {
    if (!name.is_one(left)) return false;
    remove_if_left(folder_of(path) / left);
    return true;
  });
}

/// A temporary file beside its target, locked during the object's lifetime. The lock ends with the
/// process in any case.
class Temporary {
 public:
  Temporary(const Place& place, const fs::path& target) {
    const TemporaryName name(place.path);
    for (int tries = 0;; ++tries) {
      path_ = folder_of(place.path) / name.next();
      descriptor_.emplace(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                                 place.kind == Kind::fresh ? 0666 : 0600));
      if ((*descriptor_)() < 0 && (errno != EEXIST || tries == 100))
        fail(target, "cannot be written", errno);
      if ((*descriptor_)() >= 0 && is_ours()) break;
    }
    set_owner_and_mode((*descriptor_)(), place);
  }
  const fs::path& path() const { return path_; }

 private:
  /// Returns false if another process found the file between its creation and its lock, took it for
  /// abandoned and removed it.
  bool is_ours() const {
    if (::flock((*descriptor_)(), LOCK_EX | LOCK_NB) != 0)
      return errno != EWOULDBLOCK;  // some file systems have no locks
    struct stat status {};
    return ::fstat((*descriptor_)(), &status) != 0 || status.st_nlink > 0;
  }

  fs::path path_;
  std::optional<Descriptor> descriptor_;
};

}  // namespace

void write_atomically(const fs::path& target, const std::function<void(const fs::path&)>& write) {
  const Place place = place_of(target);
  if (place.kind == Kind::refused) throw RunError(place.problem);
  if (const auto input = input_at(place)) throw RunError(input_text(target, *input));
  if (place.kind == Kind::stream) {
    write_through(place, target, write);
    return;
  }
  remove_left_of(place.path);
  const Temporary file(place, target);
  const fs::path& temporary = file.path();
  const Listed listed(temporary);
  std::error_code error;
  try {
    write(temporary);
    fs::rename(temporary, place.path, error);
    if (error == std::errc::device_or_resource_busy && place.kind == Kind::file)
      copy_over(temporary, place.path);
    else if (error)
      throw RunError(fmt::format("{}: cannot be written: {}", target.string(), error.message()));
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  fs::remove(temporary, error);  // it exists only after copy_over
}

void remove_temporary_files() noexcept {
  for (const Slot& slot : slots)
    if (slot.state == 2) ::unlink(slot.name.data());
}

void write_bytes(const fs::path& target, std::string_view bytes) {
  write_atomically(target, [&](const fs::path& path) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
    if (file() < 0) fail(target, "cannot be written", errno);
    write_all(file(), bytes, target);
    if (file.close() != 0) fail(target, "cannot be written", errno);
  });
}

void check_writable(const fs::path& target, const std::string& flag) {
  const auto refuse = [&](const std::string& why) { throw InputError(SourceLocation{flag}, why); };
  const Place place = place_of(target);
  if (place.kind == Kind::refused) refuse(place.problem);
  if (place.kind == Kind::stream) {
    if (place.descriptor < 0 && ::access(place.path.c_str(), W_OK) != 0)
      refuse(fmt::format("'{}' cannot be written", target.string()));
    return;
  }
  if (place.kind == Kind::file && ::access(place.path.c_str(), W_OK) != 0)
    refuse(fmt::format("'{}' cannot be written", target.string()));
  const fs::path folder = folder_of(place.path);
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(fmt::format("folder '{}' cannot be written", folder.string()));
}

bool is_stream(const fs::path& target) { return place_of(target).kind == Kind::stream; }

void note_input(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !(S_ISREG(status.st_mode) || S_ISFIFO(status.st_mode)))
    return;
  const std::lock_guard lock(inputs().mutex);
  if (inputs().keepers > 0)
    inputs().names.emplace(std::pair{status.st_dev, status.st_ino}, path.string());
}

void forget_input(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return;
  const std::lock_guard lock(inputs().mutex);
  inputs().names.erase({status.st_dev, status.st_ino});
}

std::vector<std::string> noted_inputs() {
  const std::lock_guard lock(inputs().mutex);
  std::vector<std::string> out;
  for (const auto& [identity, name] : inputs().names) out.push_back(name);
  std::ranges::sort(out);
  return out;
}

NotedInputs::NotedInputs() {
  const std::lock_guard lock(inputs().mutex);
  ++inputs().keepers;
}

NotedInputs::~NotedInputs() {
  const std::lock_guard lock(inputs().mutex);
  if (--inputs().keepers == 0) inputs().names.clear();
}

void Outputs::add(const std::string& flag, const fs::path& target) {
  check_writable(target, flag);
  const Place place = place_of(target);
  const auto identity = identity_of(place);
  for (const Output& other : outputs_) {
    const Place there = place_of(other.target);
    // Several outputs may go to one device, such as /dev/null.
    if (!identity || identity != identity_of(there) ||
        (place.kind == Kind::stream && S_ISCHR(place.status.st_mode)))
      continue;
    throw InputError(SourceLocation{flag},
                     fmt::format("'{}' is the output of {} as well", target.string(), other.flag));
  }
  outputs_.push_back({flag, target});
}

void Outputs::check_inputs() const {
  for (const Output& output : outputs_)
    if (const auto input = input_at(place_of(output.target)))
      throw InputError(SourceLocation{output.flag}, input_text(output.target, *input));
}

}  // namespace caplet
