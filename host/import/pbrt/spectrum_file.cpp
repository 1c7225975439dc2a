// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/spectrum_file.h"

#include "base/quotes.h"
#include "import/detail/gzip_file.h"
#include "import/detail/pbrt/lexer.h"

namespace caplet::pbrt {

SampledSpectrum parse_spectrum_text(const std::string& file, std::string text) try {
  check_text(text, file);
  Lexer lexer(file, std::move(text));
  SampledSpectrum spectrum;
  Unproven in_file;
  while (lexer.peek().kind != Token::Kind::end) {
    const Token wavelength = lexer.next();
    spectrum.wavelengths.push_back(parse_number(wavelength, lexer.file()));
    if (spectrum.wavelengths.back() <= 0)
      throw SyntaxError{lexer.place(wavelength), "a wavelength must be positive"};
    if (const std::size_t n = spectrum.wavelengths.size();
        n > 1 && spectrum.wavelengths[n - 1] <= spectrum.wavelengths[n - 2])
      throw SyntaxError{lexer.place(wavelength), "wavelengths must ascend"};
    if (lexer.peek().kind == Token::Kind::end)
      throw SyntaxError{lexer.place(wavelength), "this wavelength has no value"};
    spectrum.values.push_back(parse_number(lexer.next(), lexer.file()));
    in_file.prove();
  }
  if (spectrum.wavelengths.empty())
    throw InputError(SourceLocation{file}, "the spectrum file is empty");
  return spectrum;
} catch (const SyntaxError& error) {
  throw InputError(error.where, error.message);
}

SampledSpectrum read_spectrum_file(const std::filesystem::path& path, const SourceLocation& where) {
  return parse_spectrum_text(path.string(), read_text(path, where));
}

}  // namespace caplet::pbrt
