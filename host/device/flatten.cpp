// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/detail/flatten.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace caplet {

namespace {

constexpr std::size_t max_depth = 32;

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

struct Directive {
  std::string_view name;  // empty: an ordinary line
  std::string_view rest;
};

Directive directive_of(std::string_view line) {
  line = trimmed(line);
  if (line.empty() || line[0] != '#') return {};
  line = trimmed(line.substr(1));
  std::size_t end = 0;
  while (end < line.size() && line[end] >= 'a' && line[end] <= 'z') ++end;
  return {line.substr(0, end), trimmed(line.substr(end))};
}

/// Follows the conditionals of one file as far as __cplusplus is concerned.
class HostText {
 public:
  void see(const Directive& directive) {
    const bool about_host = directive.rest.substr(0, directive.rest.find_first_of(" \t/")) == "__cplusplus";
    if (directive.name == "ifdef")
      stack_.push_back({about_host, about_host});
    else if (directive.name == "ifndef")
      stack_.push_back({about_host, false});
    else if (directive.name == "if")
      stack_.push_back({false, false});
    else if (directive.name == "else" && !stack_.empty() && stack_.back().about_host)
      stack_.back().host = !stack_.back().host;
    else if (directive.name == "endif" && !stack_.empty())
      stack_.pop_back();
  }
  /// Whether the current line is for C++ alone.
  bool active() const {
    return std::any_of(stack_.begin(), stack_.end(), [](const Level& level) { return level.host; });
  }

 private:
  struct Level {
    bool about_host, host;
  };
  std::vector<Level> stack_;
};

class Flattener {
 public:
  explicit Flattener(const FileReader& read) : read_(read) {}

  void add(std::string_view text, const std::string& label) {
    mark(1, label);
    HostText host_text;
    int line_number = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_number;
      const Directive directive = directive_of(line);
      host_text.see(directive);
      const bool quoted = directive.name == "include" && !directive.rest.starts_with('<');
      if (!quoted) {
        out_.append(line);
        out_ += '\n';
      } else if (host_text.active()) {
        out_ += '\n';
      } else {
        include(directive.rest, label, line_number);
        mark(line_number + 1, label);
      }
    }
  }

  std::string take() { return std::move(out_); }

 private:
  void mark(int line, const std::string& label) { out_ += fmt::format("#line {} \"{}\"\n", line, label); }

  void include(std::string_view operand, const std::string& label, int line) {
    const std::size_t close = operand.find('"', 1);
    if (!operand.starts_with('"') || close == std::string_view::npos)
      throw std::logic_error(fmt::format("{}:{}: malformed #include {}", label, line, operand));
    const std::string path(operand.substr(1, close - 1));
    if (std::count(open_.begin(), open_.end(), path) > 0 || open_.size() >= max_depth) {
      std::string chain;
      for (const std::string& name : open_) chain += name + " -> ";
      throw std::logic_error(fmt::format("{}:{}: #include goes round in a circle: {}{}", label, line, chain, path));
    }
    const std::optional<std::string> text = read_(path);
    if (!text) throw std::logic_error(fmt::format("{}:{}: there is no kernel file '{}'", label, line, path));
    open_.push_back(path);
    add(*text, "kernels/" + path);
    open_.pop_back();
  }

  const FileReader& read_;
  std::string out_;
  std::vector<std::string> open_;
};

}  // namespace

std::string flatten(const std::string& text, const std::string& label, const FileReader& read) {
  Flattener flattener(read);
  flattener.add(text, label);
  return flattener.take();
}

}  // namespace caplet
