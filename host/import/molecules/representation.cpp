// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/representation.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/text_file.h"
#include "present/picture_options.h"

namespace caplet {

namespace {

// These are in the order of MoleculeStyle and MoleculeColor.
constexpr std::initializer_list<const char*> style_names = {
    "ball-and-stick", "spheres", "sticks", "trace", "cartoon", "surface", "accessible"};
constexpr std::initializer_list<const char*> color_names = {"element", "chain",     "residue",
                                                            "bfactor", "secondary", "charge"};

MoleculeColor usual_color(MoleculeStyle style) {
  switch (style) {
    case MoleculeStyle::trace:
    case MoleculeStyle::cartoon:
    case MoleculeStyle::surface:
    case MoleculeStyle::accessible:
      return MoleculeColor::chain;
    default:
      return MoleculeColor::element;
  }
}

/// Water has a radius of 1.4 angstroms.
float asked_probe(const ImportOptions& options) {
  const std::optional<std::string> text = options.text("probe");
  if (!text) return 1.4F;
  double radius = 0;
  if (!parse_number(*text, radius) || !(radius >= 0.01 && radius <= 1000))
    throw InputError({"--probe"},
                     caplet::quoted(*text) + " is no radius from 0.01 to 1000 angstroms");
  return static_cast<float>(radius);
}

/// What --color says of a molecule.
struct AskedColor {
  MoleculeColor by;
  std::string from;  // for MoleculeColor::distance
};

std::optional<AskedColor> asked_color(const ImportOptions& options) {
  const std::optional<std::string> text = options.text("color");
  if (!text) return std::nullopt;
  const std::string_view distance = "distance from ";
  if (text->starts_with(distance)) {
    const std::string from(trimmed(std::string_view(*text).substr(distance.size())));
    if (!from.empty()) return AskedColor{MoleculeColor::distance, from};
  }
  if (text->starts_with("distance"))
    throw InputError({"--color"}, "'distance from' and a selection of atoms are needed");
  const auto* const found = std::ranges::find(color_names, *text);
  if (found == color_names.end()) {
    std::vector<std::string> known(color_names.begin(), color_names.end());
    known.emplace_back("distance from ATOMS");
    throw InputError({"--color"}, none_of(*text, known));
  }
  return AskedColor{static_cast<MoleculeColor>(found - color_names.begin()), ""};
}

void set_color(Representation& out, const std::optional<AskedColor>& asked) {
  out.by = asked ? asked->by : usual_color(out.style);
  if (asked) out.from = asked->from;
}

/// Reads one representation of --show.
class RepresentationText {
 public:
  explicit RepresentationText(std::string_view text) : text_(text) {}

  Representation read(const std::optional<AskedColor>& color) {
    const std::size_t colon = text_.rfind(':');
    if (colon == text_.npos) fail("':' and a style are missing after the selection");
    Representation out;
    out.selection = trimmed(text_.substr(0, colon));
    words_ = words_of(text_.substr(colon + 1));
    out.style = static_cast<MoleculeStyle>(named(style_names, "a style"));
    set_color(out, color);
    while (at_ < words_.size()) {
      if (words_[at_] == "by") {
        ++at_;
        read_color(out);
      } else if (words_[at_] == "opacity") {
        ++at_;
        out.opacity = opacity();
      } else {
        fail(fmt::format("{} is neither 'by' nor 'opacity'", caplet::quoted(words_[at_])));
      }
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({"--show"}, fmt::format("{}: {}", caplet::quoted(text_), message));
  }

  std::size_t named(std::initializer_list<const char*> names, const char* what) {
    if (at_ == words_.size()) fail(fmt::format("{} is missing", what));
    const std::string word(words_[at_]);
    const auto* const found = std::ranges::find_if(names, [&](const char* n) { return word == n; });
    if (found == names.end())
      fail(fmt::format("{} is not {}; the nearest is '{}'", caplet::quoted(word), what,
                       nearest_name(word, {names.begin(), names.end()})));
    ++at_;
    return static_cast<std::size_t>(found - names.begin());
  }

  void read_color(Representation& out) {
    if (at_ < words_.size() && words_[at_].starts_with('#')) {
      const std::optional<glm::dvec3> color = hex_color(words_[at_]);
      if (!color) fail(caplet::quoted(words_[at_]) + " is no color (#RRGGBB)");
      out.by = MoleculeColor::fixed;
      out.color = *color;
      ++at_;
    } else if (at_ < words_.size() && words_[at_] == "distance") {
      ++at_;
      if (at_ == words_.size() || words_[at_++] != "from") fail("'from' is missing after distance");
      out.by = MoleculeColor::distance;
      for (; at_ < words_.size() && words_[at_] != "opacity"; ++at_)
        out.from += (out.from.empty() ? "" : " ") + std::string(words_[at_]);
      if (out.from.empty()) fail("atoms are missing after 'distance from'");
    } else {
      out.by = static_cast<MoleculeColor>(named(color_names, "what a color tells"));
    }
  }

  double opacity() {
    if (at_ == words_.size()) fail("the opacity is missing");
    const std::string_view word = words_[at_++];
    double out = 0;
    if (!parse_number(word, out) || !(out >= 0 && out <= 1))
      fail(caplet::quoted(word) + " is no opacity from 0 to 1");
    return out;
  }

  std::string_view text_;
  std::vector<std::string_view> words_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<Representation> asked_representations(const ImportOptions& options,
                                                  MoleculeStyle automatic) {
  const std::optional<std::string> show = options.text("show");
  if (show && options.text("style"))
    throw InputError({"--style"}, "--show states the style of each representation");
  const std::optional<AskedColor> color = asked_color(options);
  const float probe = asked_probe(options);
  std::vector<Representation> out;
  if (!show) {
    Representation all;
    all.probe = probe;
    all.style = static_cast<MoleculeStyle>(
        options.choice("style", style_names, static_cast<std::size_t>(automatic)));
    set_color(all, color);
    all.option = "--style";
    return {all};
  }
  for (std::string_view rest = *show; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of(";\n"), rest.size());
    const std::string_view one = trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (one.empty()) continue;
    out.push_back(RepresentationText(one).read(color));
    out.back().probe = probe;
  }
  if (out.empty()) throw InputError({"--show"}, "has no representation");
  return out;
}

}  // namespace caplet
