// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "device/detail/embedded.h"
#include "device/detail/flatten.h"
#include "device/device.h"

namespace caplet {

namespace {

namespace fs = std::filesystem;

std::optional<std::string> read_embedded(const std::string& path) {
  for (const EmbeddedFile& file : embedded_kernels())
    if (file.path == path) return std::string(file.text);
  return std::nullopt;
}

/// Reads kernel files from $CAPLET_KERNELS when it is set, else from the embedded table.
FileReader kernel_reader() {
  const char* named = std::getenv("CAPLET_KERNELS");
  if (!named || !*named) return read_embedded;
  const fs::path folder = named;
  if (std::error_code ignored; !fs::is_directory(folder, ignored))
    throw RunError(fmt::format("CAPLET_KERNELS: '{}' is not a folder", folder.string()));
  return [folder](const std::string& path) -> std::optional<std::string> {
    std::ifstream in(folder / path, std::ios::binary);
    if (!in || fs::is_directory(folder / path)) return std::nullopt;
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
}

}  // namespace

std::string flatten_kernels(const std::string& text, const RowMasks& rows) {
  return flatten(text, "text", kernel_reader(), rows);
}

std::string builtin_declarations() {
  constexpr const char* path = "math/builtins.cl";
  const std::optional<std::string> text = kernel_reader()(path);
  return text ? *text : read_embedded(path).value();
}

std::string kernel_source(std::string_view name) {
  const std::string path = name.find('/') == std::string_view::npos
                               ? fmt::format("stages/{}.cl", name)
                               : std::string(name);
  const FileReader read = kernel_reader();
  const std::optional<std::string> text = read(path);
  if (!text) throw std::logic_error(fmt::format("there is no kernel file '{}'", path));
  return flatten(*text, "kernels/" + path, read);
}

}  // namespace caplet
