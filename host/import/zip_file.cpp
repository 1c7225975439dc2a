// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/zip_file.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "base/reading.h"
#include "base/spelling.h"
#include "import/detail/gzip_file.h"

namespace caplet {

namespace {

constexpr std::int64_t kMostFiles = 100'000;
constexpr std::size_t kPiece = std::size_t{1} << 20;

zip_t* archive(const std::shared_ptr<void>& file) { return static_cast<zip_t*>(file.get()); }

}  // namespace

ZipFile::ZipFile(const std::filesystem::path& path) : path_(path) {
  begin_reading(path);
  int code = 0;
  if (zip_t* opened = zip_open(path.c_str(), ZIP_RDONLY, &code))
    file_ =
        std::shared_ptr<void>(opened, [](void* file) { zip_discard(static_cast<zip_t*>(file)); });
  if (!file_) fail("is no zip archive, or is cut off or broken");
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  left_ = most_unpacked(error ? 0 : size);
  const std::int64_t count = zip_get_num_entries(archive(file_), 0);
  if (count > kMostFiles) fail(fmt::format("the archive has more than {} files", kMostFiles));
  for (std::int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive(file_), static_cast<zip_uint64_t>(i), 0);
    if (name == nullptr) fail("the archive's list of files is broken");
    names_.emplace_back(name);
  }
}

void ZipFile::fail(const std::string& message) const {
  throw InputError({path_.string(), 0, 0}, message);
}

std::optional<std::string> ZipFile::find(std::string_view name) const {
  const std::string wanted = lower_case(std::string(name));
  const auto found = std::ranges::find_if(
      names_, [&](const std::string& other) { return lower_case(other) == wanted; });
  return found == names_.end() ? std::nullopt : std::optional(*found);
}

std::string ZipFile::read(const std::string& name) {
  const auto broken = [&](const char* what) { fail(name + ": " + what); };
  const auto index = static_cast<zip_uint64_t>(std::ranges::find(names_, name) - names_.begin());
  zip_stat_t info{};
  constexpr zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_ENCRYPTION_METHOD;
  if (zip_stat_index(archive(file_), index, 0, &info) != 0 || (info.valid & needed) != needed)
    broken("cannot be found in the archive");
  if (info.encryption_method != ZIP_EM_NONE) broken("is encrypted");
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> entry(
      zip_fopen_index(archive(file_), index, 0), &zip_fclose);
  if (!entry) broken("is broken, or packed in another way than deflate");
  std::string out;
  const auto too_much = [&] {
    fail(
        fmt::format("{}: the archive unpacks to more than {} bytes, which no archive of its size "
                    "does that was not made to",
                    name, left_ + out.size()));
  };
  if (info.size > left_) too_much();
  for (;;) {
    const std::size_t before = out.size();
    // One byte more than the stated size is read, so that a longer file is noticed.
    const std::uintmax_t rest = info.size > before ? info.size - before : 0;
    const std::size_t piece = std::min({std::uintmax_t{kPiece}, left_ + 1, rest + 1});
    out.resize(before + piece);
    const std::int64_t got = zip_fread(entry.get(), out.data() + before, piece);
    out.resize(before + static_cast<std::size_t>(std::max<std::int64_t>(got, 0)));
    // zip compares checksums at the end of the file.
    if (got < 0)
      broken(zip_error_code_zip(zip_file_get_error(entry.get())) == ZIP_ER_CRC
                 ? "is broken (its checksum is another)"
                 : "is broken");
    if (static_cast<std::uintmax_t>(got) > left_) too_much();
    left_ -= static_cast<std::uintmax_t>(got);
    if (got == 0) break;
  }
  if (out.size() != info.size) broken("is cut off");
  return out;
}

}  // namespace caplet
