// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/frames.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"

namespace caplet::cli {

namespace fs = std::filesystem;

namespace {

struct Container {
  const char *extension, *format;
  std::vector<const char*> codec;
};

const std::vector<Container>& containers() {
  static const std::vector<const char*> h264{
      "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf",
      "18"};
  static const std::vector<Container> rows = {
      {".mp4", "mp4", h264},
      {".mov", "mov", h264},
      {".mkv", "matroska", h264},
      {".webm", "webm", {"-c:v", "libvpx-vp9", "-pix_fmt", "yuv420p", "-crf", "24", "-b:v", "0"}},
      {".gif", "gif", {"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse"}},
  };
  return rows;
}

const Container* container_of(const fs::path& path) {
  for (const Container& one : containers())
    if (path.extension() == one.extension) return &one;
  return nullptr;
}

/// Finds the program in the folders of PATH; empty: in none.
fs::path in_path(const std::string& program) {
  const char* folders = std::getenv("PATH");
  for (std::string_view rest = folders ? folders : ""; !rest.empty();) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const fs::path file = fs::path(rest.substr(0, colon)) / program;
    if (::access(file.c_str(), X_OK) == 0) return file;
    rest.remove_prefix(std::min(rest.size(), colon + 1));
  }
  return {};
}

/// The place of the number in a file name: begin, length and digits.
struct Place {
  std::size_t begin, size;
  int digits;
};

std::optional<Place> place_of(const std::string& name) {
  if (const std::size_t last = name.find_last_of('#'); last != std::string::npos) {
    std::size_t begin = last;
    while (begin > 0 && name[begin - 1] == '#') --begin;
    return Place{begin, last - begin + 1, static_cast<int>(last - begin + 1)};
  }
  for (std::size_t at = name.rfind('%'); at != std::string::npos;
       at = at == 0 ? std::string::npos : name.rfind('%', at - 1)) {
    std::size_t end = at + 1;
    int digits = 0;
    while (end < name.size() && name[end] >= '0' && name[end] <= '9' && digits < 10)
      digits = 10 * digits + (name[end++] - '0');
    if (end < name.size() && name[end] == 'd' && digits <= 20)
      return Place{at, end + 1 - at, digits};
  }
  return std::nullopt;
}

}  // namespace

std::optional<FrameRange> parse_frames(const std::string& text) {
  if (text == "all") return std::nullopt;
  const auto refuse = [&] {
    throw InputError(SourceLocation{"--frames"},
                     fmt::format("'{}' is neither A-B, two whole numbers from 1, nor all", text));
  };
  FrameRange out;
  const auto number = [&](std::string_view part, std::uint32_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || value == 0) refuse();
  };
  const std::string_view whole = text;
  const std::size_t dash = whole.find('-');
  number(whole.substr(0, dash), out.first);
  out.last = out.first;
  if (dash != std::string_view::npos) number(whole.substr(dash + 1), out.last);
  if (out.last < out.first) refuse();
  out.count = out.last;
  return out;
}

bool is_numbered(const std::string& name) {
  return place_of(fs::path(name).filename().string()).has_value();
}

fs::path numbered(const fs::path& path, std::uint32_t number) {
  std::string name = path.filename().string();
  const std::optional<Place> place = place_of(name);
  if (!place) return path;
  name.replace(place->begin, place->size, fmt::format("{:0{}}", number, place->digits));
  return path.parent_path() / name;
}

bool is_movie(const fs::path& path) { return container_of(path) != nullptr; }

Movie::Movie(fs::path path, double frames_a_second, const std::string& flag)
    : path_(std::move(path)), frames_a_second_(frames_a_second) {
  if (in_path("ffmpeg").empty())
    throw InputError(
        SourceLocation{flag},
        fmt::format("'{}': movies are made by ffmpeg, which is not there: install the package "
                    "ffmpeg, or write numbered pictures, such as frame.####.png",
                    path_.string()));
  std::string name = (fs::temp_directory_path() / "caplet-frames-XXXXXX").string();
  if (!::mkdtemp(name.data())) throw RunError("no temporary folder can be made: " + name);
  folder_ = name;
}

Movie::~Movie() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

fs::path Movie::next() { return folder_ / fmt::format("{:06}.png", ++count_); }

void Movie::finish() {
  const Container& container = *container_of(path_);
  write_atomically(path_, [&](const fs::path& temporary) {
    const std::string said = (folder_ / "said.txt").string();
    std::vector<std::string> words{"ffmpeg",       "-nostdin",
                                   "-hide_banner", "-loglevel",
                                   "error",        "-y",
                                   "-framerate",   fmt::format("{}", frames_a_second_),
                                   "-i",           (folder_ / "%06d.png").string()};
    words.insert(words.end(), container.codec.begin(), container.codec.end());
    words.insert(words.end(), {"-f", container.format, temporary.string()});
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t streams;
    posix_spawn_file_actions_init(&streams);
    posix_spawn_file_actions_addopen(&streams, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, said.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = 0;
    const int failed =
        ::posix_spawnp(&child, "ffmpeg", &streams, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&streams);
    int status = 0;
    if (!failed)
      while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
      }
    if (!failed && WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    std::ifstream in(said);
    std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    while (!text.empty() && text.back() == '\n') text.pop_back();
    throw RunError(fmt::format("ffmpeg made no movie of {} frames{}{}", count_,
                               text.empty() ? "" : ": ", text.substr(0, 1000)));
  });
}

}  // namespace caplet::cli
