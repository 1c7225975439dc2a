// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/detail/flatten.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>
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

/// Follows the conditionals of one file that depend on __cplusplus.
class HostText {
 public:
  void see(const Directive& directive) {
    const bool about_host =
        directive.rest.substr(0, directive.rest.find_first_of(" \t/")) == "__cplusplus";
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
  /// Returns whether the current line is for C++ alone.
  bool active() const {
    return std::any_of(stack_.begin(), stack_.end(), [](const Level& level) { return level.host; });
  }

 private:
  struct Level {
    bool about_host, host;
  };
  std::vector<Level> stack_;
};

/// Returns the macro that a line of a list calls; empty where it calls none.
std::string_view entry_of(std::string_view line) {
  std::size_t end = 0;
  while (end < line.size() && ((line[end] >= 'A' && line[end] <= 'Z') || line[end] == '_')) ++end;
  return end > 0 && end < line.size() && line[end] == '(' ? line.substr(0, end)
                                                          : std::string_view();
}

bool begins_row(std::string_view entry) {
  return !entry.empty() && entry != "FIELD" && entry != "KEPT" && !entry.ends_with("_END");
}

/// Returns the name of an include guard around the whole file; empty where there is none.
std::string_view guard_of(std::string_view text) {
  std::string_view name;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty() || line.starts_with("//")) continue;
    const Directive directive = directive_of(line);
    if (name.empty() && directive.name == "ifndef")
      name = directive.rest;
    else
      return !name.empty() && directive.name == "define" && directive.rest == name
                 ? name
                 : std::string_view();
  }
  return {};
}

class Flattener {
 public:
  Flattener(const FileReader& read, const RowMasks& rows) : read_(read), rows_(rows) {}

  void add(std::string_view text, const std::string& label) {
    mark(1, label);
    HostText host_text;
    const int depth_around = depth_;
    bool guarded = !guard_of(text).empty();
    int line_number = 0;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_number;
      const Directive directive = directive_of(line);
      host_text.see(directive);
      if (directive.name.starts_with("if") && !std::exchange(guarded, false)) ++depth_;
      if (directive.name == "endif" && depth_ > depth_around) --depth_;
      const bool quoted = directive.name == "include" && !directive.rest.starts_with('<');
      if (quoted && !host_text.active() && include(directive.rest, label, line_number)) {
        mark(line_number + 1, label);
        continue;
      }
      if (!quoted) out_.append(line);
      out_ += '\n';
    }
    depth_ = depth_around;
  }

  std::string take() {
    std::string masks;
    for (const auto& [list, mask] : rows_)
      if (out_.find(mask_name(list)) != std::string::npos)
        masks += fmt::format("#define {} 0x{:x}UL\n", mask_name(list), mask);
    return masks + out_;
  }

 private:
  void mark(int line, const std::string& label) {
    out_ += fmt::format("#line {} \"{}\"\n", line, label);
  }

  static std::string mask_name(std::string_view list) {
    std::string name = "CAPLET_";
    for (const char c : list) name += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    return name;
  }

  /// Returns whether anything was included.
  bool include(std::string_view operand, const std::string& label, int line) {
    const std::size_t close = operand.find('"', 1);
    if (!operand.starts_with('"') || close == std::string_view::npos)
      throw std::logic_error(fmt::format("{}:{}: malformed #include {}", label, line, operand));
    const std::string path(operand.substr(1, close - 1));
    constexpr std::string_view present = "rows/", list_end = ".def";
    if (path.starts_with(present) && path.ends_with(list_end)) {
      const std::string list =
          path.substr(present.size(), path.size() - present.size() - list_end.size());
      mark(1, "kernels/shared/" + list + ".def");
      out_ += present_rows(list, label, line);
      return true;
    }
    const std::size_t open_brace = path.find('{'), close_brace = path.find('}', open_brace + 1);
    if (open_brace != std::string::npos && close_brace != std::string::npos) {
      const std::string list = path.substr(open_brace + 1, close_brace - open_brace - 1);
      bool some = false;
      for (const std::string& name : names_with_files(list, label, line))
        some |= include_file(path.substr(0, open_brace) + name + path.substr(close_brace + 1),
                             label, line);
      return some;
    }
    return include_file(path, label, line);
  }

  bool include_file(const std::string& path, const std::string& label, int line) {
    if (std::count(open_.begin(), open_.end(), path) > 0 || open_.size() >= max_depth) {
      std::string chain;
      for (const std::string& name : open_) chain += name + " -> ";
      throw std::logic_error(
          fmt::format("{}:{}: #include goes round in a circle: {}{}", label, line, chain, path));
    }
    if (once_.contains(path)) return false;
    const std::string text = text_of(path, label, line);
    // A file under a condition that may be false does not count as included.
    if (depth_ == 0 && !guard_of(text).empty()) once_.insert(path);
    open_.push_back(path);
    add(text, "kernels/" + path);
    open_.pop_back();
    return true;
  }

  std::string text_of(const std::string& path, const std::string& label, int line) const {
    if (std::optional<std::string> text = read_(path)) return *std::move(text);
    throw std::logic_error(fmt::format("{}:{}: there is no kernel file '{}'", label, line, path));
  }

  /// Calls visit(line, entry, the row is present) with every line of shared/<list>.def.
  template <class Visit>
  void each_line(const std::string& list, const std::string& label, int line, Visit visit) const {
    const std::string text = text_of("shared/" + list + ".def", label, line);
    const auto named = rows_.find(list);
    const std::uint64_t mask = named == rows_.end() ? ~std::uint64_t{0} : named->second;
    int row = -1;
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string_view one = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      const std::string_view entry = entry_of(one);
      if (begins_row(entry) && ++row == 64)
        throw std::logic_error(fmt::format("shared/{}.def has more than 64 rows", list));
      visit(one, entry, row < 0 || (mask >> row & 1) != 0);
    }
  }

  std::string present_rows(const std::string& list, const std::string& label, int line) const {
    std::string out;
    each_line(list, label, line, [&](std::string_view one, std::string_view entry, bool present) {
      if ((entry.empty() && !one.starts_with("//")) || (!entry.empty() && present)) out += one;
      out += '\n';
    });
    return out;
  }

  std::vector<std::string> names_with_files(const std::string& list, const std::string& label,
                                            int line) const {
    std::vector<std::string> names;
    each_line(list, label, line, [&](std::string_view one, std::string_view entry, bool present) {
      if (!present || !begins_row(entry) || entry == "COMPOUND") return;
      one.remove_prefix(entry.size() + 1);
      names.emplace_back(trimmed(one.substr(0, one.find_first_of(",)"))));
    });
    return names;
  }

  const FileReader& read_;
  const RowMasks& rows_;
  std::string out_;
  std::vector<std::string> open_;
  std::set<std::string> once_;
  int depth_ = 0;  // of conditionals other than include guards
};

}  // namespace

std::string flatten(const std::string& text, const std::string& label, const FileReader& read,
                    const RowMasks& rows) {
  Flattener flattener(read, rows);
  flattener.add(text, label);
  return flattener.take();
}

}  // namespace caplet
