// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/error.h"

#include <algorithm>

#include "base/log.h"

namespace caplet {

namespace {

std::string join_lines(const std::vector<std::string>& lines) {
  std::string out;
  for (const std::string& line : lines) out += (out.empty() ? "" : "\n") + line;
  return out;
}

std::string placed(const SourceLocation& where, const std::string& message) {
  const std::string place = where.to_string();
  return place.empty() ? message : place + ": " + message;
}

}  // namespace

std::string SourceLocation::to_string() const {
  std::string out = file;
  if (line > 0) out += ":" + std::to_string(line);
  if (line > 0 && column > 0) out += ":" + std::to_string(column);
  return out;
}

InputError::InputError(const std::string& message)
    : std::runtime_error(message), messages_{message} {}
InputError::InputError(const SourceLocation& where, const std::string& message)
    : InputError(placed(where, message)) {}
InputError::InputError(std::vector<std::string> messages)
    : std::runtime_error(join_lines(messages)), messages_(std::move(messages)) {}

void Diagnostics::error(const SourceLocation& where, const std::string& message,
                        const std::string& kind) {
  const auto same = [&](const Line& line) { return !kind.empty() && line.kind == kind; };
  if (const auto found = std::find_if(lines_.begin(), lines_.end(), same); found != lines_.end())
    ++found->others;
  else if (lines_.size() < limit_)
    lines_.push_back({placed(where, message), kind});
  else
    ++beyond_;
  if (++count_ < most_errors) return;
  stopped_ = true;
  finish();
}

void Diagnostics::add_more(std::size_t count) {
  beyond_ += count;
  count_ += count;
}

void Diagnostics::warning(const SourceLocation& where, const std::string& message) {
  log::warn("{}", placed(where, message));
}

void Diagnostics::finish() const {
  if (count_ == 0) return;
  std::vector<std::string> messages;
  for (const Line& line : lines_)
    messages.push_back(
        line.text +
        (line.others > 0 ? " (and " + std::to_string(line.others) + " more of this kind)" : ""));
  if (beyond_ > 0)
    messages.push_back("and " + std::to_string(beyond_) +
                       (beyond_ == 1 ? " more error" : " more errors"));
  if (stopped_) messages.push_back("too much is wrong here: reading stopped");
  throw InputError(messages);
}

namespace detail {
void check_failed(const char* expression, const std::string& a, const std::string& b,
                  const char* file, int line) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) +
                         ": check failed: " + expression + " with " + a + " and " + b);
}
}  // namespace detail

}  // namespace caplet
