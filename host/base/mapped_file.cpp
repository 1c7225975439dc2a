// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/reading.h"

namespace caplet {

namespace {

[[noreturn]] void cannot_map(const std::filesystem::path& path, const std::string& why) {
  throw InputError({path.string()}, "cannot be read: " + why);
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  begin_reading(path);
  // O_NONBLOCK: opening a fifo must not wait for a writer; fifos are refused below.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) cannot_map(path, std::strerror(errno));
  struct stat status {};
  const bool is_known = ::fstat(file, &status) == 0;
  std::string problem = is_known ? "" : std::strerror(errno);
  if (is_known && !S_ISREG(status.st_mode))
    problem = S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file";
  if (problem.empty() && status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    // Writable, though nothing is written: drivers may ask for memory that they could write to.
    void* const all =
        ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_NORESERVE, file, 0);
    if (all == MAP_FAILED)
      problem = std::strerror(errno);
    else
      begin_ = static_cast<const char*>(all);
  }
  ::close(file);
  if (!problem.empty()) cannot_map(path, problem);
}

MappedFile::~MappedFile() {
  if (begin_) ::munmap(const_cast<char*>(begin_), size_);
}

}  // namespace caplet
