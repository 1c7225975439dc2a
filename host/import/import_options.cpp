// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/import_options.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/text_file.h"

namespace caplet {

const std::vector<ImportOptionRow>& import_option_rows() {
  using Of = ImportOptionRow::Of;
  static const std::vector<ImportOptionRow> rows = {
      {"style", "ball-and-stick|spheres|sticks|trace|cartoon|surface|accessible",
       "How molecules are drawn: ball-and-stick, spheres, sticks, trace, cartoon, surface "
       "(solvent-excluded) or accessible (to a solvent)",
       Of::format},
      {"color",
       "element|chain|residue|bfactor|charge|'distance from ATOMS'|secondary|direction|fibre|file|"
       "scalar|scalar:NAME|type|order|depth|FILE",
       "What colours tell: element, chain, residue, bfactor, charge, distance from atoms or "
       "secondary of molecules; direction, fibre, file, scalar or scalar:NAME of fibres; type, "
       "file, order, depth or a FILE of values of neurons",
       Of::format},
      {"show", "ATOMS: STYLE [by COLOR] [opacity X]",
       "Parts of a molecule, each in its own style, between semicolons or by repetition, such as "
       "'polymer: cartoon; ligand: sticks by element'; see docs/formats/molecules.md",
       Of::format, true},
      {"probe", "R", "Radius of the solvent's probe for a molecule's surfaces, in angstroms",
       Of::format},
      {"range", "LOW,HIGH", "Values at the ends of the colour map", Of::format},
      {"select", "ATOMS",
       "Part of a molecule, as gemmi and mmdb write it: //A,B/10-20/CA; see "
       "docs/formats/molecules.md",
       Of::format},
      {"model", "N", "Which model, frame or record of a file of several, from 1", Of::format},
      {"secondary", "file|dssp",
       "Helices and strands of a molecule: the file's, or by hydrogen bonds as DSSP finds them",
       Of::format},
      {"positions", "FILE.npy",
       "Places of a molecule's atoms, an array (T, N, 3): T frames, of which --model chooses one",
       Of::format},
      {"altloc", "first|all|LETTER",
       "Alternative places of atoms: first (of each residue), all, or a letter", Of::format},
      {"assembly", "cell|NAME",
       "A biological assembly of the file, by instances: its name, such as 1; cell: all of a "
       "crystal's cell",
       Of::format},
      {"hydrogens", "yes|no", "Whether hydrogen atoms are drawn", Of::format},
      {"water", "yes|no", "Whether water molecules are drawn", Of::format},
      {"components", "FILE",
       "Chemical components (mmCIF, _chem_comp_bond) whose bonds residues of their names have",
       Of::format},
      {"radius", "R", "Radius of fibres, in the file's unit", Of::format},
      {"opacity", "X", "How opaque the surfaces of fibres are, above 0 and up to 1", Of::format},
      {"share", "X", "Draws this share of a file's fibres, above 0 and up to 1", Of::format},
      {"lengths", "LOW,HIGH", "Draws fibres of these lengths, in the file's unit", Of::format},
      {"values", "LOW,HIGH", "Draws fibres whose mean value is in this range", Of::format},
      {"groups", "visual|collision|all|N,...",
       "Which geometry of a robot is drawn: seen, touched, all, or MJCF's groups of these numbers",
       Of::format},
      {"pose", "[KEYFRAME,]JOINT=VALUE,...",
       "A robot's pose: a keyframe of MJCF by its name, and values of joints in radians and metres",
       Of::format},
      {"camera", "NAME", "A camera of the file", Of::format},
      {"view", "front|back|left|right|top|bottom|iso|X,Y,Z",
       "From where an automatic camera looks: front, back, left, right, top, bottom, iso, or the "
       "direction toward the viewer; "
       "frames everything",
       Of::picture},
      {"up", "x|y|z|-x|-y|-z|apical",
       "The axis of the file that is up, or a neuron's apical dendrite", Of::picture},
      {"projection", "perspective|orthographic",
       "Of perspective and orthographic cameras; orthographic: lengths are the same at all depths",
       Of::picture},
      {"light", "studio|flat|dramatic",
       "A set-up of lights around the camera in place of the scene's lights (shapes that shine "
       "stay)",
       Of::picture},
      {"background", "transparent|white|black|grey|COLOR|FILE",
       "What stands behind everything, as bright as it is: nothing, white, black, grey, #rrggbb, "
       "r,g,b, or a picture; the lights "
       "are then not seen",
       Of::picture},
      {"least-width", "PIXELS",
       "Capsules and spheres are drawn at least so wide (0: as they are); not for pick and verify",
       Of::picture},
      {"clip", "DIRECTION[=PLACE]",
       "Cuts away what lies in this direction (x|y|z|-x|-y|-z, view: towards the camera, or X,Y,Z) "
       "behind a plane, at a coordinate or a share that is kept, such as x=1.5 or view=30%; none: "
       "not even what the file says",
       Of::picture},
      {"exposure", "STOPS|auto",
       "Previews, .png and .jpg are so much brighter; auto: as the picture needs it. The .exr and "
       "the background stay",
       Of::picture},
      {"no-outside", "yes|no",
       "Files of a scene may name others in the scene's own folder and below it alone, wherever "
       "links lead: for scenes of "
       "strangers",
       Of::reading},
  };
  return rows;
}

void ValueRange::extend(double value) {
  low = is_there ? std::min(low, value) : value;
  high = is_there ? std::max(high, value) : value;
  is_there = true;
}

std::optional<std::string> ImportOptions::text(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? std::nullopt : std::optional(found->second);
}

std::size_t ImportOptions::choice(const std::string& name,
                                  std::initializer_list<const char*> choices,
                                  std::size_t otherwise) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return otherwise;
  const auto* const found = std::ranges::find(choices, *asked);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  throw InputError({"--" + name}, none_of(*asked, {choices.begin(), choices.end()}));
}

bool ImportOptions::yes(const std::string& name, bool otherwise) const {
  return choice(name, {"no", "yes"}, otherwise ? 1 : 0) == 1;
}

std::optional<std::pair<double, double>> ImportOptions::range(const std::string& name) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return std::nullopt;
  const std::string_view whole = *asked;
  const std::size_t comma = std::min(whole.find(','), whole.size());
  std::pair<double, double> out;
  if (comma == whole.size() || !parse_number(whole.substr(0, comma), out.first) ||
      !parse_number(whole.substr(comma + 1), out.second) || !std::isfinite(out.first) ||
      !std::isfinite(out.second) || !(out.first < out.second))
    throw InputError({"--" + name},
                     "'" + *asked + "' is not LOW,HIGH: two numbers, the second above the first");
  return out;
}

std::uint32_t ImportOptions::number(const std::string& name, std::uint32_t otherwise) const {
  const std::optional<std::string> asked = text(name);
  if (!asked) return otherwise;
  std::uint32_t value = 0;
  if (!parse_number(std::string_view(*asked), value) || value == 0)
    throw InputError({"--" + name}, "'" + *asked + "' is no whole number from 1");
  return value;
}

}  // namespace caplet
