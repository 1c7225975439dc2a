// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/lexer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/quotes.h"

namespace caplet::pbrt {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}
bool ends_word(char c) { return is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  if (!may_quote()) return std::string("\"") + withheld + "\"";
  std::string out = "\"";
  for (char c : text.substr(0, longest))
    out += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return out + (text.size() > longest ? "...\"" : "\"");
}

double parse_number(const Token& token, const std::string& file) {
  const std::string_view text = without_plus(token.text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (token.kind != Token::Kind::word || error == std::errc::invalid_argument ||
      end != text.data() + text.size())
    throw SyntaxError{place_of(token, file), "expected a number, found " + in_quotes(token.text)};
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(text).c_str(), nullptr);
  if (!std::isfinite(value))
    throw SyntaxError{place_of(token, file),
                      "the number " + in_quotes(token.text) + " is not finite"};
  return value;
}

int parse_integer(const Token& token, const std::string& file) {
  const std::string_view text = without_plus(token.text);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (token.kind == Token::Kind::word && error == std::errc::result_out_of_range &&
      end == text.data() + text.size())
    throw SyntaxError{place_of(token, file),
                      "the integer " + in_quotes(token.text) + " is out of range (32 bits)"};
  if (token.kind != Token::Kind::word || error != std::errc() || end != text.data() + text.size())
    throw SyntaxError{place_of(token, file), "expected an integer, found " + in_quotes(token.text)};
  return value;
}

Lexer::Lexer(std::string file, std::string text, Lexer* behind)
    : file_(std::move(file)), text_(std::move(text)), behind_(behind) {
  if (text_.starts_with("\xef\xbb\xbf")) at_ = line_start_ = 3;
}

void Lexer::skip_blanks() {
  for (; at_ < text_.size(); ++at_) {
    if (text_[at_] == '#') at_ = std::min(text_.find('\n', at_), text_.size());
    if (at_ == text_.size() || !is_blank(text_[at_])) return;
    if (text_[at_] != '\n') continue;
    ++line_;
    line_start_ = at_ + 1;
  }
}

const Token& Lexer::peek() {
  if (!has_ahead_) {
    ahead_ = scan();
    has_ahead_ = true;
  }
  return ahead_;
}

Token Lexer::next() {
  peek();
  has_ahead_ = false;
  return ahead_;
}

void Lexer::take_numbers(std::vector<double>& numbers, bool whole) {
  if (has_ahead_) return;
  const char* const end = text_.data() + text_.size();
  for (;;) {
    skip_blanks();
    const char* const at = text_.data() + at_;
    double value = 0;
    int count = 0;
    const auto [behind, error] =
        whole ? std::from_chars(at, end, count) : std::from_chars(at, end, value);
    if (error != std::errc() || behind == end || !(is_blank(*behind) || *behind == ']')) return;
    if (!std::isfinite(value)) return;
    numbers.push_back(whole ? count : value);
    at_ += static_cast<std::size_t>(behind - at);
  }
}

Token Lexer::scan() {
  skip_blanks();
  Token token{Token::Kind::end, "end of file", line_, column()};
  if (at_ == text_.size()) return token;
  const char first = text_[at_];
  if (first == '"') return scan_string();
  const std::size_t start = at_;
  if (first == '[' || first == ']') {
    token.kind = first == '[' ? Token::Kind::open : Token::Kind::close;
    ++at_;
  } else {
    token.kind = Token::Kind::word;
    while (at_ < text_.size() && !ends_word(text_[at_])) ++at_;
  }
  token.text = std::string_view(text_).substr(start, at_ - start);
  return token;
}

Token Lexer::scan_string() {
  Token token{Token::Kind::string, {}, line_, column()};
  ++at_;
  const std::size_t start = at_;
  std::string* unescaped = nullptr;
  bool bad_escape = false;
  SourceLocation escape_place;
  while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') {
    if (text_[at_] != '\\') {
      if (unescaped) *unescaped += text_[at_];
      ++at_;
      continue;
    }
    if (!unescaped) unescaped = &unescaped_.emplace_back(text_.substr(start, at_ - start));
    constexpr std::string_view escapes = "nrtbf\\'\"", meanings = "\n\r\t\b\f\\'\"";
    const SourceLocation here{file_, line_, column()};
    ++at_;
    const std::size_t which =
        at_ < text_.size() ? escapes.find(text_[at_]) : std::string_view::npos;
    if (which != std::string_view::npos) {
      *unescaped += meanings[which];
      ++at_;
    } else if (!bad_escape) {
      bad_escape = true;
      escape_place = here;
    }
  }
  if (at_ == text_.size() || text_[at_] == '\n')
    throw SyntaxError{place(token), "this string is not closed on its line"};
  token.text =
      unescaped ? std::string_view(*unescaped) : std::string_view(text_).substr(start, at_ - start);
  ++at_;
  if (bad_escape) throw SyntaxError{escape_place, "unknown escape in a string"};
  return token;
}

}  // namespace caplet::pbrt
