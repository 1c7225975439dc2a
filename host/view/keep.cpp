// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/keep.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/log.h"
#include "base/utf8.h"
#include "device/cache.h"
#include "export/export.h"
#include "view/server.h"

namespace caplet::view {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr int format = 1;
constexpr std::size_t most_old = 1000;

fs::path in_cache(const std::string& key, const char* ending) {
  const fs::path folder = cache_folder();
  return folder.empty() ? folder : folder / fmt::format("view-{}.{}", content_hash(key), ending);
}

std::optional<Json> object_of(const std::string& line) {
  Json out = Json::parse(line, nullptr, false);
  return out.is_object() ? std::optional(std::move(out)) : std::nullopt;
}

constexpr std::string_view of_bytes =
    "bytes:";  // marks encoded bytes: absolute paths begin with a slash

/// Returns a path for JSON. One that is not UTF-8 is encoded as a character per byte behind
/// `of_bytes`, and can be read back.
std::string json_of_path(const std::string& path) {
  if (valid_utf8(path) == path) return path;
  std::string out(of_bytes);
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) out += static_cast<char>(0xc0 | byte >> 6);
    out += static_cast<char>(byte < 0x80 ? byte : 0x80 | (byte & 0x3f));
  }
  return out;
}

std::string path_of_json(const std::string& text) {
  if (!text.starts_with(of_bytes)) return text;
  std::string out;
  for (std::size_t i = of_bytes.size(); i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool is_pair = byte >= 0x80 && i + 1 < text.size();
    out += is_pair ? static_cast<char>(byte << 6 | (static_cast<unsigned char>(text[++i]) & 0x3f))
                   : text[i];
  }
  return out;
}

bool is_saved_mark(const Json& line) { return line.value("type", "") == "saved"; }

template <class T>
std::shared_future<T> ready(T value) {
  std::promise<T> out;
  out.set_value(std::move(value));
  return out.get_future().share();
}

bool is_written_by_caplet(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string begin(written_first_line.size(), '\0');
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return in && begin == written_first_line;
}

}  // namespace

Keeper::Keeper(const fs::path& scene, const ReadAs& read_as)
    : scene_(fs::absolute(scene).lexically_normal()) {
  for (const auto& [name, value] : read_as)
    read_as_.emplace(name, valid_utf8(value));  // as the journal returns it
  const std::string known_as = fs::weakly_canonical(scene_).string();
  const fs::path folder = scene_.parent_path(), name = scene_.filename();
  copy_ = folder / fmt::format(".{}.unsaved.pbrt", name.stem().string());
  journal_ = folder / fmt::format(".{}.unsaved", name.string());
  elsewhere_ = in_cache("unsaved " + known_as, "unsaved");
  default_name_ = name.extension() == ".pbrt" ? name.string() : name.stem().string() + ".pbrt";
  if (fs::path(default_name_).stem().extension() == ".pbrt")
    default_name_ =
        fs::path(default_name_).stem().string();  // removes the first ending of .pbrt.gz

  lock_file_ = in_cache("lock " + known_as, "lock");
  if (!lock_file_.empty()) {
    std::error_code ignored;
    fs::create_directories(lock_file_.parent_path(), ignored);
    lock_ = ::open(lock_file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      scene_hash_ = ready(std::string());
      base_hash_ = scene_hash_;
      is_second_ = true;
      fail("another session shows this scene, and keeps its own");
      return;
    }
  }
  // Hashing a large file takes a while, and the hash is needed only when there is something to
  // keep.
  scene_hash_ = std::async(std::launch::deferred, [content = content_of(scene_)] {
                  return hash_of(content);
                }).share();
  base_hash_ = scene_hash_;
  for (const fs::path& place : {journal_, elsewhere_})
    if (!place.empty()) find_left(place);
  std::error_code ignored;
  if (!base_is_copy_)
    fs::remove(copy_, ignored);  // a copy left by a session that had saved everything
}

Keeper::~Keeper() {
  file_.close();
  if (lock_ < 0) return;
  if (!is_second_) ::unlink(lock_file_.c_str());
  ::close(lock_);
}

void Keeper::find_left(const fs::path& journal) try {
  std::error_code error;
  for (std::size_t i = 1; i < most_old; ++i) {
    Old old{fs::path(fmt::format("{}-{}", journal.string(), i)), {}};
    if (!fs::exists(old.file, error)) break;
    old.lines = Journal::read(old.file);
    if (!old.lines.empty()) old_.push_back(std::move(old));
  }
  if (!fs::exists(journal, error)) return;
  std::vector<std::string> lines = Journal::read(journal);
  const std::optional<Json> head = lines.empty() ? std::nullopt : object_of(lines.front());
  if (lines.size() < 2 || !head || head->value("caplet", 0) != format) {
    fs::remove(journal, error);
    return;
  }
  lines.erase(lines.begin());
  // The hash of the scene's file, unless another program has written it.
  std::string wanted = head->value("content", "");
  std::size_t saved = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (const std::optional<Json> line = object_of(lines[i]); line && is_saved_mark(*line)) {
      saved = i + 1;
      wanted = line->value("content", wanted);
    }
  if (saved == lines.size()) {
    fs::remove(journal, error);
    return;
  }
  const bool begins_in_copy = head->value("copy", false);
  bool fits =
      lines_.empty() && head->value("read_as", ReadAs{}) == read_as_ && scene_hash_.get() == wanted;
  if (begins_in_copy) fits = fits && file_hash(copy_) == head->value("content", "");
  Others others;
  const Json named = head->value("others", Json::object());
  for (const auto& [name, hash] : named.items()) {
    others.emplace_back(path_of_json(name), hash.get<std::string>());
    fits = fits && file_hash(others.back().first) == others.back().second;
  }
  if (!fits) {
    lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(saved));
    // These lines are put aside without the content that they began with.
    Journal aside;
    if (aside.begin(journal, lines)) put_aside(journal);
    return;
  }
  lines_ = std::move(lines);
  base_is_copy_ = begins_in_copy;
  if (begins_in_copy) base_hash_ = ready(head->value("content", ""));
  if (journal != journal_) std::swap(journal_, elsewhere_);
} catch (const Json::exception& error) {  // intact lines that Caplet has not written
  log::warn("{}: {}", journal.string(), error.what());
}

void Keeper::put_aside(const fs::path& journal) {
  std::error_code error;
  fs::path place;
  for (std::size_t i = 1; i < most_old; ++i) {
    place = fmt::format("{}-{}", journal.string(), i);
    if (!fs::exists(place, error)) break;
  }
  fs::rename(journal, place, error);
  if (!error) old_.push_back({place, Journal::read(place)});
}

void Keeper::forget_old() {
  std::error_code ignored;
  fs::remove(old_.back().file, ignored);
  old_.pop_back();
}

void Keeper::has_read(const std::vector<std::string>& files) {
  if (is_second_) return;
  std::vector<Content> contents;
  std::error_code error;
  for (const std::string& file : files)
    if (!fs::equivalent(file, base(), error))
      contents.push_back(content_of(fs::absolute(file).lexically_normal()));
  others_ = std::async(std::launch::deferred, [contents = std::move(contents)] {
              Others out;
              for (const Content& content : contents)
                out.emplace_back(content.path, hash_of(content));
              return out;
            }).share();
}

Keeper::Content Keeper::content_of(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {file.string()};
  return {file.string(), status.st_size,
          std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec};
}

std::string Keeper::hash_of(const Content& content) {
  const Content now = content_of(content.path);
  return now.bytes == content.bytes && now.written == content.written ? file_hash(content.path)
                                                                      : "unknown";
}

void Keeper::look_at_contents() {
  if (looking_.valid()) return;
  looking_ = std::async(std::launch::async, [scene = scene_hash_, others = others_] {
    scene.wait();
    if (others.valid()) others.wait();
  });
}

void Keeper::has_made(std::size_t count) {
  if (count >= lines_.size()) return;
  const std::vector<std::string> rest(lines_.begin() + static_cast<std::ptrdiff_t>(count),
                                      lines_.end());
  lines_.resize(count);
  Journal aside;
  if (aside.begin(journal_, rest)) put_aside(journal_);
  if (!lines_.empty()) write_journal();
}

std::string Keeper::head() const {
  Json others = Json::object();
  if (others_.valid())
    for (const auto& [name, hash] : others_.get()) others[json_of_path(name)] = hash;
  Json head{{"caplet", format},
            {"content", base_hash_.get()},
            {"copy", base_is_copy_},
            {"others", others}};
  if (!read_as_.empty()) head["read_as"] = read_as_;
  return json_dump(head);
}

void Keeper::fail(const std::string& why) {
  failure_ = why;
  log::warn("changes of {} are not kept: {}", scene_.string(), why);
}

void Keeper::write_journal() {
  std::vector<std::string> all{head()};
  all.insert(all.end(), lines_.begin(), lines_.end());
  if (file_.begin(journal_, all)) return;
  const std::string why = std::strerror(errno);
  if (!elsewhere_.empty()) {
    std::error_code ignored;
    fs::create_directories(elsewhere_.parent_path(), ignored);
    std::swap(journal_, elsewhere_);
    if (file_.begin(journal_, all)) return;
  }
  fail(fmt::format("{}: {}", journal_.string(), why));
}

void Keeper::keep(const std::string& line) {
  lines_.push_back(line);
  if (!failure_.empty()) return;
  if (!file_.is_open()) return write_journal();
  if (!file_.append(line)) fail(fmt::format("{}: {}", journal_.string(), std::strerror(errno)));
}

fs::path Keeper::target(const std::optional<std::string>& name) const {
  // The page has the name as UTF-8.
  std::string out = name && *name != valid_utf8(default_name_) ? *name : default_name_;
  const auto refuse = [&](const char* why) {
    throw InputError(SourceLocation{"name"}, fmt::format("'{}' {}", out, why));
  };
  if (out.empty()) refuse("is no name");
  if (std::ranges::any_of(out,
                          [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }))
    refuse("holds a control character");
  if (out.find('/') != std::string::npos || out.find('\\') != std::string::npos ||
      out.front() == '.')
    refuse("is not a plain name: scenes are saved beside the scene's file");
  if (!out.ends_with(".pbrt")) out += ".pbrt";
  fs::path path = scene_.parent_path() / out;
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (path != scene_ && fs::exists(status) && !fs::is_regular_file(status))
    refuse("is there, and is no regular file");
  return path;
}

std::string Keeper::lost_with(const fs::path& target) const {
  std::error_code error;
  if (!fs::exists(target, error)) return {};
  const std::string name = target.filename().string();
  if (const auto ours = written_.find(target); ours != written_.end())
    return file_hash(target) == ours->second
               ? std::string()
               : fmt::format("{} has been changed since it was saved here", name);
  if (target != scene_) return fmt::format("{} is there already", name);
  if (file_hash(target) != scene_hash_.get())
    return fmt::format("{} has been changed since it was read", name);
  if (!is_written_by_caplet(target))
    return fmt::format("comments and includes of {} will not be kept", name);
  return {};
}

void Keeper::save(const Scene& scene, const fs::path& target, const std::string& mark,
                  const std::function<bool()>& cancelled) {
  const bool own = target == scene_, copies = own && !base_is_copy_ && !is_second_;
  std::error_code error;
  if (copies) {
    // This computes the hash that lines begin with. A hard link to the same file costs nothing.
    (void)base_hash_.get();
    fs::remove(copy_, error);
    const fs::path file = fs::canonical(scene_, error);
    fs::create_hard_link(file, copy_, error);
    if (error) fs::copy_file(file, copy_, fs::copy_options::overwrite_existing, error);
    if (error)
      throw RunError(fmt::format("{}: cannot be written: {}", copy_.string(), error.message()));
  }
  try {
    const FileImageWriter images;
    write_scene(scene, target, cancelled, &images);
  } catch (...) {
    if (copies) fs::remove(copy_, error);
    throw;
  }
  base_is_copy_ = base_is_copy_ || copies;
  const std::string hash = file_hash(target);
  written_[target] = hash;
  default_name_ = target.filename().string();
  Json line = Json::parse(mark);
  line["type"] = "saved";
  if (own) {
    line["content"] = hash;
    scene_hash_ = ready(hash);
  }
  lines_.push_back(json_dump(line));
  rest();
}

void Keeper::rest() {
  file_.close();
  std::error_code ignored;
  if (!is_second_) fs::remove(journal_, ignored);
}

void Keeper::end(bool has_unsaved) {
  if (has_unsaved || is_second_) return file_.close();
  rest();
  std::error_code ignored;
  if (base_is_copy_) fs::remove(copy_, ignored);
}

std::string kept_token(const std::string& host, std::uint16_t port, const fs::path& scene) {
  constexpr std::size_t length = 32;
  const fs::path file = in_cache(
      fmt::format("token {} {} {}", host, port, fs::weakly_canonical(scene).string()), "token");
  if (file.empty()) return random_token();
  struct stat status {};
  if (::lstat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
      status.st_uid == ::geteuid() && (status.st_mode & 077) == 0) {
    std::ifstream in(file);
    std::string token;
    if (std::getline(in, token) && token.size() == length &&
        token.find_first_not_of("0123456789abcdef") == std::string::npos)
      return token;
  }
  std::string token = random_token();
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  fs::remove(file, ignored);
  const int out = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (out < 0) return token;
  const std::string text = token + "\n";
  if (::write(out, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    fs::remove(file, ignored);
  ::close(out);
  return token;
}

}  // namespace caplet::view
