// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Build tool: embed_files OUTPUT FUNCTION ROOT FILE... writes a C++ function that returns a table
// of the files' texts by their paths from ROOT (embedded_file.h).
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

namespace {

/// Returns `line` as a C++ string literal. Bytes outside printable ASCII become three-digit octal
/// escapes.
std::string literal(const std::string& line) {
  std::string out = "\"";
  for (const char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\' || c == '?') {
      out += '\\';
      out += c;
    } else if (byte >= 32 && byte < 127) {
      out += c;
    } else {
      char escape[5];
      std::snprintf(escape, sizeof escape, "\\%03o", static_cast<unsigned>(byte));
      out += escape;
    }
  }
  return out + "\"";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: embed_files OUTPUT FUNCTION ROOT FILE...\n";
    return 2;
  }
  const std::filesystem::path root = argv[3];
  std::ofstream out(argv[1]);
  out << "#include <span>\n#include \"base/embedded_file.h\"\nnamespace caplet {\nstd::span<const "
         "EmbeddedFile> "
      << argv[2]
      << "();\nnamespace {\nusing namespace std::string_view_literals;\n"
         "constexpr EmbeddedFile files[] = {\n";
  for (int i = 4; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    if (!in) {
      std::cerr << argv[i] << ": cannot be read\n";
      return 1;
    }
    out << "{" << literal(std::filesystem::path(argv[i]).lexically_relative(root).generic_string())
        << "sv,\n\"\"";
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
      out << literal(text.substr(begin, end - begin)) << "\n";
      begin = end;
    }
    out << "\"\"sv},\n";
  }
  out << "};\n}\nstd::span<const EmbeddedFile> " << argv[2] << "() { return files; }\n}\n";
  out.close();
  if (out) return 0;
  std::cerr << argv[1] << ": cannot be written\n";
  return 1;
}
