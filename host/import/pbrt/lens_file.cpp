// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/lens_file.h"

#include <utility>

#include "base/quotes.h"
#include "import/detail/gzip_file.h"
#include "import/detail/pbrt/lexer.h"

namespace caplet::pbrt {

namespace {

constexpr std::size_t most_surfaces = 256;

}  // namespace

Lens parse_lens_text(const std::string& file, std::string text) try {
  check_text(text, file);
  Lexer lexer(file, std::move(text));
  Lens lens{file, {}};
  while (lexer.peek().kind != Token::Kind::end) {
    LensElement element;
    double* const values[] = {&element.radius, &element.thickness, &element.eta, &element.diameter};
    Token at;
    for (double* const value : values) {
      if (lexer.peek().kind == Token::Kind::end)
        throw SyntaxError{
            lexer.place(at),
            "the last surface has no four numbers: radius, thickness, index, diameter"};
      at = lexer.next();
      *value = parse_number(at, lexer.file());
    }
    if (!(element.thickness >= 0))
      throw SyntaxError{lexer.place(at), "the thickness of this surface must be from 0 up"};
    if (element.eta != 0 && !(element.eta >= 1 && element.eta <= 10))
      throw SyntaxError{lexer.place(at), "the index of this surface must be 0 or from 1 to 10"};
    if (!(element.diameter > 0))
      throw SyntaxError{lexer.place(at), "the diameter of this surface must be positive"};
    if (lens.elements.size() == most_surfaces)
      throw SyntaxError{lexer.place(at), "a lens has at most 256 surfaces"};
    lens.elements.push_back(element);
  }
  if (lens.elements.empty()) throw InputError(SourceLocation{file}, "the lens file is empty");
  return lens;
} catch (const SyntaxError& error) {
  throw InputError(error.where, error.message);
}

Lens read_lens_file(const std::filesystem::path& path, const SourceLocation& where) {
  return parse_lens_text(path.string(), read_text(path, where));
}

}  // namespace caplet::pbrt
