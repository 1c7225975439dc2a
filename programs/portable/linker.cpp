// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `ld` of the bundled PoCL. PoCL's compiler links kernels as it links any C program: with -lm,
// -lgcc and -lc, which only machines with a C compiler have. This one hands LLVM's linker, `lld`
// beside it, everything but the libraries and their folders, and the mathematical library that this
// very program runs with, which every machine has.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// Beside this program.
std::string lld() {
  char path[PATH_MAX];
  const ssize_t length = ::readlink("/proc/self/exe", path, sizeof path);
  if (length <= 0 || length == sizeof path) return {};
  const std::string self(path, static_cast<std::size_t>(length));
  return self.substr(0, self.rfind('/') + 1) + "lld";
}

/// The file that this process has the mathematical library from; empty where that cannot be told.
std::string libm() {
  double (*volatile function)(double) = &std::sin;  // called nowhere else
  Dl_info info{};
  return ::dladdr(reinterpret_cast<void*>(function), &info) != 0 && info.dli_fname != nullptr
             ? info.dli_fname
             : "";
}

}  // namespace

int main(int count, char** arguments) {
  const std::string program = lld();
  std::string library = libm();
  std::string name = "ld.lld";  // lld is the linker that it is called as
  std::vector<char*> handed{name.data()};
  for (int i = 1; i < count; ++i) {
    const std::string_view text = arguments[i];
    if (!text.starts_with("-l") && !text.starts_with("-L")) handed.push_back(arguments[i]);
  }
  if (!library.empty()) handed.push_back(library.data());
  handed.push_back(nullptr);
  ::execv(program.c_str(), handed.data());
  std::fprintf(stderr, "ld: %s: %s\n", program.c_str(), std::strerror(errno));
  return 1;
}
