// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/cache.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <mutex>

#include "base/atomic_file.h"
#include "base/content_hash.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/log.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

// A file holds this line, the hash of key and contents, the length of the contents (both in text),
// then the contents.
constexpr std::string_view magic = "caplet cache 1\n";

std::string header(std::string_view key, const std::vector<unsigned char>& contents) {
  std::string hashed(key);
  hashed += '\0';
  hashed.append(contents.begin(), contents.end());
  return fmt::format("{}{}\n{}\n", magic, content_hash(hashed), contents.size());
}

}  // namespace

fs::path cache_folder() {
  if (fs::path named = environment_variable("CAPLET_CACHE"); !named.empty()) return named;
  if (const fs::path base = environment_variable("XDG_CACHE_HOME"); !base.empty())
    return base / "caplet";
  if (const fs::path home = environment_variable("HOME"); !home.empty())
    return home / ".cache" / "caplet";
  return {};
}

fs::path cache_file(std::string_view key, std::string_view extension) {
  const fs::path folder = cache_folder();
  return folder.empty() ? folder : folder / fmt::format("{}.{}", content_hash(key), extension);
}

std::optional<std::vector<unsigned char>> cache_load(std::string_view key,
                                                     std::string_view extension) {
  const fs::path path = cache_file(key, extension);
  if (path.empty()) return std::nullopt;
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return std::nullopt;  // a folder would be opened, and throw when it is read
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  const std::string file{std::istreambuf_iterator<char>(in), {}};
  std::size_t begin = magic.size();
  for (int line = 0; line < 2; ++line) {
    begin = file.find('\n', begin);
    if (begin == std::string::npos) return std::nullopt;
    ++begin;
  }
  const std::vector<unsigned char> contents(file.begin() + static_cast<std::ptrdiff_t>(begin),
                                            file.end());
  if (std::string_view(file).substr(0, begin) != header(key, contents)) return std::nullopt;
  return contents;
}

bool cache_store(std::string_view key, std::string_view extension,
                 const std::vector<unsigned char>& contents) {
  static std::mutex one_writer;
  const std::lock_guard lock(one_writer);
  const fs::path path = cache_file(key, extension);
  if (path.empty()) return false;
  static std::atomic<bool> is_told = false;
  const auto tell = [](const std::string& why) {
    if (!is_told.exchange(true))
      log::warn("nothing can be kept in the cache: {} (CAPLET_CACHE names another folder)", why);
    return false;
  };
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return tell(fmt::format("{}: {}", path.parent_path().string(), error.message()));
  try {
    write_atomically(path, [&](const fs::path& temporary) {
      std::ofstream out(temporary, std::ios::binary);
      out << header(key, contents);
      out.write(reinterpret_cast<const char*>(contents.data()),
                static_cast<std::streamsize>(contents.size()));
      out.close();
      if (!out) throw RunError(fmt::format("{}: cannot be written", temporary.string()));
    });
    return true;
  } catch (const std::exception& refused) {
    return tell(refused.what());
  }
}

}  // namespace caplet
