// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tokens of pbrt-v4 scene text, with their places.
#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace caplet::pbrt {

/// A syntax error in a statement. The parser reports it and goes on at the next directive.
struct SyntaxError {
  SourceLocation where;
  std::string message;
  std::string kind = {};  // as in Diagnostics::error
};

struct Token {
  enum class Kind { word, string, open, close, end };
  Kind kind = Kind::end;
  std::string_view
      text;  // a string's without its quotes, escapes resolved; lives as long as the lexer
  int line = 0, column = 0;
};

inline SourceLocation place_of(const Token& token, const std::string& file) {
  return {file, token.line, token.column};
}

/// Splits text into words, "strings" and brackets. `#` starts a comment. Columns count bytes
/// from 1.
class Lexer {
 public:
  /// `behind`: the text that follows this one, that of the including file; null: nothing follows.
  Lexer(std::string file, std::string text, Lexer* behind = nullptr);
  Lexer(const Lexer&) = delete;
  Lexer& operator=(const Lexer&) = delete;

  /// Returns the next token without taking it. Throws SyntaxError for an unterminated string or an
  /// unknown escape.
  const Token& peek();
  Token next();
  /// Appends the plain numbers (`whole`: 32-bit integers) that come next, up to the first other
  /// token. This is a fast path for long lists. Only blanks and line ends may separate them, no
  /// comments.
  void take_numbers(std::vector<double>& numbers, bool whole);
  SourceLocation place(const Token& token) const { return place_of(token, file_); }
  const std::string& file() const { return file_; }
  Lexer* behind() const { return behind_; }

 private:
  Token scan();
  Token scan_string();
  void skip_blanks();
  int column() const { return static_cast<int>(at_ - line_start_) + 1; }

  std::string file_, text_;
  Lexer* behind_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  Token ahead_;
  bool has_ahead_ = false;
  std::deque<std::string> unescaped_;
};

/// Quotes a token for messages: shortened, with control characters replaced.
std::string in_quotes(std::string_view text);

/// Returns the number that a word of `file` states. Throws SyntaxError when it is not a number or
/// not finite.
double parse_number(const Token& token, const std::string& file);
/// Returns the 32-bit integer that a word of `file` states. Throws SyntaxError otherwise.
int parse_integer(const Token& token, const std::string& file);

}  // namespace caplet::pbrt
