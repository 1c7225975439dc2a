// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/commands.h"

namespace caplet::cli {

namespace {

bool is_plain(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%") ==
             std::string::npos;
}

std::string quoted(const std::string& text) {
  if (is_plain(text)) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string Invocation::command_line() const {
  std::string out;
  for (const std::string& argument : arguments) out += (out.empty() ? "" : " ") + quoted(argument);
  return out;
}

}  // namespace caplet::cli
