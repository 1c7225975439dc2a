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

/// A statement that cannot be read further; the parser reports it and goes on at the next directive.
struct SyntaxError {
  SourceLocation where;
  std::string message;
  std::string kind = {};  // as for Diagnostics::error
};

struct Token {
  enum class Kind { word, string, open, close, end };
  Kind kind = Kind::end;
  std::string_view text;  // a string's without its quotes, escapes resolved; lives as long as the lexer
  int line = 0, column = 0;
};

/// Splits text into words, "strings" and brackets; `#` starts a comment. Columns count bytes from 1.
class Lexer {
 public:
  /// `behind`: what follows where this text ends, that of the file which includes it; null: nothing.
  Lexer(std::string file, std::string text, Lexer* behind = nullptr);
  Lexer(const Lexer&) = delete;
  Lexer& operator=(const Lexer&) = delete;

  /// The next token, left in place. Throws SyntaxError for an unterminated string or an unknown escape.
  const Token& peek();
  Token next();
  /// Appends the plain numbers (`whole`: of 32 bits) that stand next, up to the first token that is none: the quick way through
  /// long lists. Blanks and line ends are between them, no comments.
  void take_numbers(std::vector<double>& numbers, bool whole);
  SourceLocation place(const Token& token) const { return {file_, token.line, token.column}; }
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

/// "token" for messages, shortened, with control characters replaced.
std::string in_quotes(std::string_view text);

/// The number a word states; throws SyntaxError when it is none or not finite.
double parse_number(const Token& token, const Lexer& lexer);
/// The 32-bit integer a word states; throws SyntaxError otherwise.
int parse_integer(const Token& token, const Lexer& lexer);

}  // namespace caplet::pbrt
