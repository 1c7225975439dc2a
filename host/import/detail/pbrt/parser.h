// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The syntax of pbrt-v4 text: reads directives with their arguments, and hands them to a target.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

#include "base/quotes.h"
#include "import/detail/pbrt/lexer.h"
#include "import/detail/pbrt/target.h"

namespace caplet::pbrt {

/// Reads the arguments of one statement. Each method throws SyntaxError where something else comes.
class Arguments {
 public:
  Arguments(Lexer& lexer, const Statement& statement, Diagnostics& diagnostics)
      : lexer_(lexer), statement_(statement), diagnostics_(diagnostics) {}
  const Statement& statement() const { return statement_; }
  Lexer& lexer() { return lexer_; }
  bool is_string_next() { return lexer_.peek().kind == Token::Kind::string; }
  /// Reads a string; `what` names it in messages.
  Word string(const char* what);
  double number();
  glm::dvec3 vector();
  glm::dmat4 matrix();
  ParameterList parameters() { return parse_parameters(lexer_, diagnostics_); }

 private:
  Lexer& lexer_;
  const Statement& statement_;
  Diagnostics& diagnostics_;
};

/// Parses a scene and the files that it includes.
class Parser {
 public:
  Parser(const Target& target, Diagnostics& diagnostics)
      : target_(target), diagnostics_(diagnostics) {}
  /// `behind`: the text that follows, that of the including file; null: nothing follows.
  void parse(const std::string& file, std::string text, Lexer* behind = nullptr);

  const Target& target() const { return target_; }

 private:
  void parse_statement(Lexer& lexer, Unproven& in_file);
  void skip_to_directive(Lexer& lexer);

  Target target_;
  Diagnostics& diagnostics_;
  int depth_ = 0;  // files that are open
  bool in_world_ = false;
};

}  // namespace caplet::pbrt
