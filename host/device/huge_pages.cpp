// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/detail/huge_pages.h"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace caplet {

#if defined(__linux__) && defined(MADV_HUGEPAGE)

namespace {

constexpr std::size_t page = std::size_t{2} << 20;
constexpr std::size_t pays_from = page;

/// Pages are whole pages from the system; the addresses around them that are not used are returned.
struct Pages {
  void* begin = MAP_FAILED;
  std::size_t size = 0;

  explicit Pages(std::size_t bytes) : size((bytes + page - 1) / page * page) {
    void* const all = mmap(nullptr, size + page, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (all == MAP_FAILED) return;
    char* const first = static_cast<char*>(all);
    const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(all) % page) % page;
    if (before > 0) munmap(first, before);
    munmap(first + before + size, page - before);
    begin = first + before;
    madvise(begin, size, MADV_HUGEPAGE);
  }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  ~Pages() {
    if (begin != MAP_FAILED) munmap(begin, size);
  }
};

bool are_wanted() {
  const char* const variable = std::getenv("CAPLET_HUGE_PAGES");
  return variable == nullptr || std::string_view(variable) != "0";
}

void CL_CALLBACK give_back(cl_mem, void* pages) { delete static_cast<Pages*>(pages); }

}  // namespace

cl::Buffer on_huge_pages(const Device& device, bool read_only, std::size_t size) {
  if (size < pays_from || !device.is_cpu() || !are_wanted()) return {};
  auto pages = std::make_unique<Pages>(size);
  if (pages->begin == MAP_FAILED) return {};
  cl::Buffer buffer(device.context(),
                    (read_only ? CL_MEM_READ_ONLY : CL_MEM_READ_WRITE) | CL_MEM_USE_HOST_PTR, size,
                    pages->begin);
  buffer.setDestructorCallback(give_back, pages.get());
  (void)pages.release();
  return buffer;
}

#else

cl::Buffer on_huge_pages(const Device&, bool, std::size_t) { return {}; }

#endif

}  // namespace caplet
