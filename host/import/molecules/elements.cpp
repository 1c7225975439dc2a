// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <array>
#include <cctype>
#include <gemmi/elem.hpp>

#include "import/detail/molecule.h"
#include "import/detail/text_file.h"
#include "scene/texture_image.h"

namespace caplet {

namespace {

/// Colours from hydrogen to meitnerium, sRGB: jmol.sourceforge.net/jscolors.
constexpr std::array<std::uint32_t, 110> jmol_colors = {
    0xff1493, 0xffffff, 0xd9ffff, 0xcc80ff, 0xc2ff00, 0xffb5b5, 0x909090, 0x3050f8, 0xff0d0d,
    0x90e050, 0xb3e3f5, 0xab5cf2, 0x8aff00, 0xbfa6a6, 0xf0c8a0, 0xff8000, 0xffff30, 0x1ff01f,
    0x80d1e3, 0x8f40d4, 0x3dff00, 0xe6e6e6, 0xbfc2c7, 0xa6a6ab, 0x8a99c7, 0x9c7ac7, 0xe06633,
    0xf090a0, 0x50d050, 0xc88033, 0x7d80b0, 0xc28f8f, 0x668f8f, 0xbd80e3, 0xffa100, 0xa62929,
    0x5cb8d1, 0x702eb0, 0x00ff00, 0x94ffff, 0x94e0e0, 0x73c2c9, 0x54b5b5, 0x3b9e9e, 0x248f8f,
    0x0a7d8c, 0x006985, 0xc0c0c0, 0xffd98f, 0xa67573, 0x668080, 0x9e63b5, 0xd47a00, 0x940094,
    0x429eb0, 0x57178f, 0x00c900, 0x70d4ff, 0xffffc7, 0xd9ffc7, 0xc7ffc7, 0xa3ffc7, 0x8fffc7,
    0x61ffc7, 0x45ffc7, 0x30ffc7, 0x1fffc7, 0x00ff9c, 0x00e675, 0x00d452, 0x00bf38, 0x00ab24,
    0x4dc2ff, 0x4da6ff, 0x2194d6, 0x267dab, 0x266696, 0x175487, 0xd0d0e0, 0xffd123, 0xb8b8d0,
    0xa6544d, 0x575961, 0x9e4fb5, 0xab5c00, 0x754f45, 0x428296, 0x420066, 0x007d00, 0x70abfa,
    0x00baff, 0x00a1ff, 0x008fff, 0x0080ff, 0x006bff, 0x545cf2, 0x785ce3, 0x8a4fe3, 0xa136d4,
    0xb31fd4, 0xb31fba, 0xb30da6, 0xbd0d87, 0xc70066, 0xcc0059, 0xd1004f, 0xd90045, 0xe00038,
    0xe6002e, 0xeb0026};

/// gemmi lists deuterium as a separate element, after all others.
constexpr int most_elements = 118;
gemmi::El el_of(std::uint8_t element) { return static_cast<gemmi::El>(element); }

}  // namespace

std::uint8_t element_of(std::string_view symbol) {
  int number = 0;
  if (parse_number(symbol, number))
    return number > 0 && number <= most_elements ? static_cast<std::uint8_t>(number)
                                                 : std::uint8_t{0};
  std::size_t letters = 0;
  while (letters < symbol.size() && std::isalpha(static_cast<unsigned char>(symbol[letters])))
    ++letters;
  for (const std::size_t length : {std::min<std::size_t>(letters, 2), std::size_t{1}}) {
    if (length == 0 || length > letters) continue;
    const gemmi::El el = gemmi::find_element(std::string(symbol.substr(0, length)).c_str());
    if (el == gemmi::El::D) return 1;
    if (el != gemmi::El::X && static_cast<int>(el) <= most_elements)
      return static_cast<std::uint8_t>(el);
  }
  return 0;
}

float covalent_radius(std::uint8_t element) {
  constexpr float carbon = 0.76F;  // sp3; gemmi has the value of sp2, 0.73
  return element == 6 ? carbon : gemmi::covalent_radius(el_of(element));
}
float van_der_waals_radius(std::uint8_t element) { return gemmi::vdw_radius(el_of(element)); }
float ball_radius_of(const Atom& atom) {
  return atom.radius >= 0 ? atom.radius : van_der_waals_radius(atom.element);
}
const char* element_name(std::uint8_t element) {
  return element == 0 ? "unknown" : gemmi::element_name(el_of(element));
}

glm::dvec3 element_color(std::uint8_t element) {
  const std::uint32_t rgb =
      jmol_colors[element < jmol_colors.size() ? element : jmol_colors.size() - 1];
  const auto linear = [](std::uint32_t byte) { return decoded_value({}, byte / 255.0); };
  return {linear(rgb >> 16), linear(rgb >> 8 & 255U), linear(rgb & 255U)};
}

}  // namespace caplet
