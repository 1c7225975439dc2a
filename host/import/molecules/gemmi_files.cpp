// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads PDB and mmCIF with gemmi.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <gemmi/chemcomp_xyz.hpp>
#include <gemmi/cif.hpp>
#include <gemmi/mmcif.hpp>
#include <gemmi/mmread.hpp>
#include <gemmi/pdb.hpp>
#include <gemmi/resinfo.hpp>
#include <gemmi/select.hpp>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/gemmi_structure.h"
#include "import/detail/molecule.h"
#include "import/detail/secondary.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

bool begins_with(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

/// gemmi reports lines as "PATH:LINE:COLUMN(BYTE): ..." or "Problem in line LINE: ...".
[[noreturn]] void refuse(const std::string& path, std::string message) {
  SourceLocation where{path, 0, 0};
  const auto number = [&message](std::size_t& at) {
    int value = 0;
    const auto [end, error] =
        std::from_chars(message.data() + at, message.data() + message.size(), value);
    at = static_cast<std::size_t>(end - message.data());
    return error == std::errc() ? value : 0;
  };
  const std::string problem = "Problem in line ";
  std::size_t at = 0;
  if (begins_with(message, path + ":")) {
    at = path.size() + 1;
    where.line = number(at);
    if (at < message.size() && message[at] == ':') where.column = number(++at);
    at = message.find(": ", at);
    if (at != std::string::npos) message.erase(0, at + 2);
  } else if (begins_with(message, problem)) {
    at = problem.size();
    where.line = number(at);
    message.erase(0, std::min(message.size(), at + 2));
  }
  // Further lines of the message quote the file.
  message = message.substr(0, message.find('\n'));
  if (!message.empty() && message.back() == ':') message.pop_back();  // it is C++17 here
  throw InputError(where, message);
}

ResidueKind residue_kind(const std::string& name) {
  const gemmi::ResidueInfo info = gemmi::find_tabulated_residue(name);
  if (info.is_water()) return ResidueKind::water;
  if (info.is_amino_acid()) return ResidueKind::amino_acid;
  return info.is_nucleic_acid() ? ResidueKind::nucleotide : ResidueKind::other;
}

/// Returns whether a residue has the backbone of an amino acid and is bound to a neighbour by it,
/// as modified residues are that gemmi does not list. Peptide bonds are 1.33 angstroms long, and
/// mkdssp takes up to 2.5 for one.
bool is_in_peptide(const std::vector<gemmi::Residue>& residues, std::size_t at) {
  const auto atom = [&](std::size_t of, const char* name) {
    return of < residues.size() ? residues[of].find_atom(name, '*') : nullptr;
  };
  const auto are_bound = [](const gemmi::Atom* c, const gemmi::Atom* n) {
    return c && n && c->pos.dist(n->pos) <= 2.5;
  };
  const gemmi::Atom *n = atom(at, "N"), *c = atom(at, "C");
  return n && c && atom(at, "CA") &&
         ((at > 0 && are_bound(atom(at - 1, "C"), n)) || are_bound(c, atom(at + 1, "N")));
}

/// Returns the alternative place of a residue's atoms that is kept: '*' all of them, '\0' only
/// atoms without one.
char kept_altloc(const gemmi::Residue& residue, const std::string& asked) {
  if (asked == "all") return '*';
  if (asked != "first") return asked[0];
  for (const gemmi::Atom& atom : residue.atoms)
    if (atom.altloc != '\0') return atom.altloc;
  return '\0';
}

std::string address_key(const std::string& chain, const std::string& residue,
                        const std::string& atom) {
  return chain + '\n' + residue + '\n' + atom;
}

class Builder {
 public:
  Builder(gemmi::Structure& structure, const std::string& path, const ImportOptions& options,
          std::vector<SecondaryRange> secondary)
      : structure_(structure), path_(path), options_(options), secondary_(std::move(secondary)) {}

  Molecule build() {
    gemmi::Model& model = chosen_model();
    if (const std::optional<std::string> select = options_.text("select"))
      keep_selected(model, *select);
    const std::string altloc = options_.text("altloc").value_or("first");
    if (altloc != "first" && altloc != "all" && altloc.size() != 1)
      throw InputError({"--altloc"}, "'" + altloc + "' is neither first nor all nor one letter");
    const bool hydrogens = options_.yes("hydrogens", true), water = options_.yes("water", true);
    for (const gemmi::Chain& chain : model.chains) add_chain(chain, altloc, hydrogens, water);
    if (out_.atoms.empty()) throw InputError({path_, 0, 0}, "holds no atoms that are asked for");
    state_secondary(out_, numbers_, codes_, secondary_);
    add_connections();
    add_assemblies();
    out_.name = structure_.name;
    out_.frames = static_cast<std::uint32_t>(structure_.models.size());
    return std::move(out_);
  }

 private:
  gemmi::Model& chosen_model() {
    if (structure_.models.empty()) throw InputError({path_, 0, 0}, "holds no atoms");
    const std::uint32_t number = options_.number("model", 1);
    if (number > structure_.models.size())
      throw InputError({"--model"},
                       fmt::format("{}: the file has {} models", number, structure_.models.size()));
    return structure_.models[number - 1];
  }

  static void keep_selected(gemmi::Model& model, const std::string& text) {
    try {
      const gemmi::Selection selection(text);
      selection.remove_not_selected(model);
    } catch (const std::exception& error) {
      throw InputError({"--select"}, "'" + text + "': " + error.what());
    }
  }

  std::uint32_t chain_index(const std::string& name) {
    const auto [entry, fresh] =
        chains_.try_emplace(name, static_cast<std::uint32_t>(out_.chains.size()));
    if (fresh) out_.chains.push_back(name);
    return entry->second;
  }

  void add_chain(const gemmi::Chain& chain, const std::string& altloc, bool hydrogens, bool water) {
    for (std::size_t i = 0; i < chain.residues.size(); ++i) {
      const gemmi::Residue& source = chain.residues[i];
      Residue residue;
      residue.kind = residue_kind(source.name);
      if (residue.kind == ResidueKind::other && is_in_peptide(chain.residues, i))
        residue.kind = ResidueKind::amino_acid;
      if (residue.kind == ResidueKind::water && !water) continue;
      residue.name = source.name;
      residue.number = source.seqid.str();
      residue.part = source.subchain;
      residue.first_atom = static_cast<std::uint32_t>(out_.atoms.size());
      const char kept = kept_altloc(source, altloc);
      for (const gemmi::Atom& atom : source.atoms) {
        if (atom.altloc != '\0' && kept != '*' && atom.altloc != kept) continue;
        if (atom.is_hydrogen() && !hydrogens) continue;
        add_atom(atom, chain, source, residue);
      }
      residue.atom_count = static_cast<std::uint32_t>(out_.atoms.size()) - residue.first_atom;
      if (residue.atom_count == 0) continue;
      residue.chain = chain_index(chain.name);
      out_.residues.push_back(std::move(residue));
      numbers_.push_back(*source.seqid.num);
      codes_.push_back(source.seqid.icode);
    }
  }

  void add_atom(const gemmi::Atom& atom, const gemmi::Chain& chain, const gemmi::Residue& source,
                Residue& residue) {
    Atom one;
    one.position = {static_cast<float>(atom.pos.x), static_cast<float>(atom.pos.y),
                    static_cast<float>(atom.pos.z)};
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(one.position[axis]) <= largest_number))
        throw InputError({path_, 0, 0},
                         fmt::format("atom {} ({} of {} {}) has no finite place", atom.serial,
                                     atom.name, source.name, source.seqid.str()));
    one.b_factor = std::abs(atom.b_iso) <= largest_number ? atom.b_iso : 0;
    one.residue = static_cast<std::uint32_t>(out_.residues.size());
    one.serial = atom.serial;
    one.altloc = atom.altloc;
    one.charge = atom.charge;
    one.element = element_of(atom.element.name());
    if (one.element == 0) one.element = element_of(atom.name);
    const auto index = static_cast<std::uint32_t>(out_.atoms.size());
    const char* trace = residue.kind == ResidueKind::amino_acid ? "CA" : "P";
    if (residue.trace_atom < 0 &&
        (residue.kind == ResidueKind::amino_acid || residue.kind == ResidueKind::nucleotide) &&
        atom.name == trace)
      residue.trace_atom = static_cast<std::int32_t>(index);
    if (!structure_.connections.empty())
      by_address_.try_emplace(address_key(chain.name, source.seqid.str() + source.name, atom.name),
                              index);
    out_.has_b_factors |= one.b_factor != 0;
    out_.has_charges |= one.charge != 0;
    out_.atoms.push_back(one);
    out_.atom_names.push_back(atom.name);
  }

  void add_connections() {
    const auto index_of = [this](const gemmi::AtomAddress& a) -> std::int64_t {
      const auto found = by_address_.find(
          address_key(a.chain_name, a.res_id.seqid.str() + a.res_id.name, a.atom_name));
      return found == by_address_.end() ? -1 : static_cast<std::int64_t>(found->second);
    };
    for (const gemmi::Connection& connection : structure_.connections) {
      if (connection.type == gemmi::Connection::Hydrog || connection.asu == gemmi::Asu::Different)
        continue;
      const std::int64_t a = index_of(connection.partner1), b = index_of(connection.partner2);
      if (a >= 0 && b >= 0 && a != b)
        out_.bonds.emplace_back(static_cast<std::uint32_t>(std::min(a, b)),
                                static_cast<std::uint32_t>(std::max(a, b)));
    }
  }

  void add_assemblies() {
    for (const gemmi::Assembly& assembly : structure_.assemblies) {
      std::vector<AssemblyPart>& parts = out_.assemblies[assembly.name];
      for (const gemmi::Assembly::Gen& gen : assembly.generators) {
        AssemblyPart part{gen.chains, gen.subchains, {}};
        for (const gemmi::Assembly::Operator& op : gen.operators) {
          glm::dmat4 m(1);
          for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
              m[column][row] = op.transform.mat[row][column];
            m[3][row] = op.transform.vec.at(row);
          }
          part.operators.push_back(m);
        }
        parts.push_back(std::move(part));
      }
    }
  }

  gemmi::Structure& structure_;
  const std::string& path_;
  const ImportOptions& options_;
  std::vector<SecondaryRange> secondary_;
  std::vector<std::int32_t> numbers_;  // of residues, and their insertion codes
  std::string codes_;
  Molecule out_;
  std::unordered_map<std::string, std::uint32_t> chains_, by_address_;
};

template <class Work>
auto read_by_gemmi(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    refuse(path, error.what());
  }
}

/// Reads CONECT: columns 7-11 hold an atom, then up to four others follow in five columns each.
void add_conect(std::string_view text, Molecule& out) {
  std::unordered_map<std::int32_t, std::uint32_t> by_serial;
  const auto serial_at = [](std::string_view line, std::size_t column) {
    std::int32_t value = 0;
    if (line.size() <= column) return value;
    std::string_view field = line.substr(column, 5);
    while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
    std::from_chars(field.data(), field.data() + field.size(), value);
    return value;
  };
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (!begins_with(line, "CONECT")) continue;
    if (by_serial.empty())
      for (std::uint32_t i = 0; i < out.atoms.size(); ++i)
        by_serial.try_emplace(out.atoms[i].serial, i);
    const auto from = by_serial.find(serial_at(line, 6));
    if (from == by_serial.end()) continue;
    for (const std::size_t column : {11U, 16U, 21U, 26U}) {
      const auto to = by_serial.find(serial_at(line, column));
      if (to != by_serial.end() && to->second != from->second)
        out.bonds.emplace_back(std::min(from->second, to->second),
                               std::max(from->second, to->second));
    }
  }
}

/// Splits REMARK 350 by words: beyond 999 copies its columns shift, and gemmi 0.5 misreads them.
std::map<std::string, std::vector<AssemblyPart>> assemblies_of_remarks(std::string_view text,
                                                                       const std::string& path) {
  std::map<std::string, std::vector<AssemblyPart>> out;
  std::vector<AssemblyPart>* parts = nullptr;
  bool listing = false;
  glm::dmat4 m(1);
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    if (begins_with(line, "ATOM")) break;
    const std::string_view remark = "REMARK 350";
    if (!begins_with(line, remark)) continue;
    line.remove_prefix(remark.size());
    const std::vector<std::string> words = gemmi::split_str_multi(std::string(line), " ,\t");
    const auto chains_from = [&](std::size_t first) {
      for (std::size_t i = first; i < words.size(); ++i) parts->back().chains.push_back(words[i]);
    };
    if (words.size() >= 2 && words[0] == "BIOMOLECULE:") {
      parts = &out[words[1]];
      listing = false;
    } else if (parts && words.size() > 5 && words[0] == "APPLY" && words[4] == "CHAINS:") {
      parts->emplace_back();
      chains_from(5);
      listing = true;
    } else if (listing && words.size() > 2 && words[0] == "AND" && words[1] == "CHAINS:") {
      chains_from(2);
    } else if (listing && words.size() == 6 && words[0].size() == 6 &&
               begins_with(words[0], "BIOMT")) {
      const int row = words[0][5] - '1';
      if (row < 0 || row > 2) continue;
      for (int column = 0; column < 4; ++column) {
        const std::string& word = words[static_cast<std::size_t>(column) + 2];
        double value = 0;
        if (!parse_number(std::string_view(word), value) || !std::isfinite(value))
          throw InputError({path, number, 0},
                           caplet::quoted(word) + " is no number of an operator");
        m[column][row] = value;
      }
      if (row == 2) parts->back().operators.push_back(m);
    }
  }
  return out;
}

/// gemmi 0.5 reads the distance of SSBOND and LINK, columns 74 to 78, beyond the end of a line that
/// ends within it. Such lines are padded with blanks to column 80.
std::string with_whole_distances(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    out += line;
    const std::string record = lower_case(std::string(line.substr(0, 4)));
    if (line.size() > 72 && line.size() < 80 && (record == "ssbo" || record == "link"))
      out.append(80 - line.size(), ' ');
    out += '\n';
  }
  return out;
}

gemmi::cif::Document document_of(std::string_view text, const std::string& path) {
  return gemmi::cif::read_memory(text.data(), text.size(), path.c_str());
}

/// gemmi 0.5 converts a component's charge to a byte without a check, even a missing one.
void mend_charges(gemmi::cif::Block& block) {
  for (auto row : block.find("_chem_comp_atom.", {"charge"}))
    if (!(std::abs(gemmi::cif::as_number(row[0])) <= 100)) row[0] = "0";
}

/// gemmi 0.5 reads no atoms without certain columns of _atom_site that other programs omit (PyMOL
/// auth_seq_id). They are copied from an equivalent column, or filled with "unknown".
void add_columns(gemmi::cif::Block& block) {
  const std::string category = "_atom_site.";
  gemmi::cif::Loop* loop = block.find_loop(category + "Cartn_x").get_loop();
  if (!loop) return;
  struct Column {
    const char *name, *other, *value;
  };
  static constexpr Column needed[] = {{"id", "", "?"},
                                      {"type_symbol", "", "?"},
                                      {"label_alt_id", "", "."},
                                      {"label_asym_id", "auth_asym_id", "A"},
                                      {"occupancy", "", "1"},
                                      {"B_iso_or_equiv", "", "0"},
                                      {"auth_seq_id", "label_seq_id", "?"}};
  std::vector<std::pair<int, std::string>>
      added;  // the column that is copied, or the value of all rows
  const std::size_t width = loop->width();
  for (const Column& column : needed) {
    if (loop->has_tag(category + column.name)) continue;
    added.emplace_back(*column.other ? loop->find_tag(category + column.other) : -1, column.value);
    loop->tags.push_back(category + column.name);
  }
  if (added.empty()) return;
  std::vector<std::string> values;
  values.reserve(loop->values.size() / width * loop->tags.size());
  for (std::size_t row = 0; row + width <= loop->values.size(); row += width) {
    for (std::size_t i = 0; i < width; ++i) values.push_back(std::move(loop->values[row + i]));
    const std::size_t begin = values.size() - width;
    for (const auto& [from, value] : added)
      values.push_back(from < 0 ? value
                                : std::string(values[begin + static_cast<std::size_t>(from)]));
  }
  loop->values = std::move(values);
}

void add_component_bonds(const gemmi::cif::Block& block, ComponentBonds& out) {
  // gemmi 0.5 offers no const access to tables.
  auto& table_of =
      const_cast<gemmi::cif::Block&>(block);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  for (const auto row : table_of.find("_chem_comp_bond.", {"comp_id", "atom_id_1", "atom_id_2"}))
    out[row.str(0)].emplace_back(row.str(1), row.str(2));
}

SecondaryRange range_of(Secondary kind, const gemmi::AtomAddress& start,
                        const gemmi::AtomAddress& end) {
  return {kind,
          start.chain_name,
          {*start.res_id.seqid.num, *end.res_id.seqid.num},
          {start.res_id.seqid.icode, end.res_id.seqid.icode}};
}

/// Returns the ranges of HELIX, without helices of polyproline, and of SHEET.
std::vector<SecondaryRange> secondary_records(const gemmi::Structure& structure) {
  std::vector<SecondaryRange> out;
  for (const gemmi::Helix& helix : structure.helices)
    if (helix.pdb_helix_class != gemmi::Helix::HelixPolyProlineNone)
      out.push_back(range_of(Secondary::helix, helix.start, helix.end));
  for (const gemmi::Sheet& sheet : structure.sheets)
    for (const gemmi::Sheet::Strand& strand : sheet.strands)
      out.push_back(range_of(Secondary::strand, strand.start, strand.end));
  return out;
}

/// Returns the ranges of _struct_conf, which may hold strands too (STRN), and of
/// _struct_sheet_range. gemmi's list of helices has those of polyproline (HELX_LH_PP_P) without
/// their type.
std::vector<SecondaryRange> secondary_categories(gemmi::cif::Block& block) {
  std::vector<SecondaryRange> out;
  const auto add = [&](const char* category, const char* type) {
    for (auto row :
         block.find(category, {"beg_auth_asym_id", "beg_auth_seq_id", "end_auth_seq_id",
                               "?pdbx_beg_PDB_ins_code", "?pdbx_end_PDB_ins_code", type})) {
      SecondaryRange range;
      range.kind = Secondary::strand;
      if (row.has(5) && *type == 'c') {
        const std::string kind = row.str(5);
        if (begins_with(kind, "HELX_LH_PP")) continue;
        if (begins_with(kind, "HELX"))
          range.kind = Secondary::helix;
        else if (!begins_with(kind, "STRN"))
          continue;
      }
      range.chain = row.str(0);
      bool is_number = true;
      for (std::size_t end = 0; end < 2; ++end) {
        is_number &= parse_number(std::string_view(row.str(1 + static_cast<int>(end))),
                                  range.number.at(end));
        const std::string code = row.has(3 + end) ? row.str(3 + static_cast<int>(end)) : "";
        if (!code.empty()) range.code.at(end) = code[0];
      }
      if (is_number) out.push_back(range);
    }
  };
  add("_struct_conf.", "conf_type_id");
  add("_struct_sheet_range.", "sheet_id");
  return out;
}

}  // namespace

Molecule molecule_of(gemmi::Structure& structure, const std::string& path,
                     const ImportOptions& options, std::vector<SecondaryRange> secondary) {
  return Builder(structure, path, options, std::move(secondary)).build();
}

Molecule read_pdb(std::string_view text, const std::string& path, const ImportOptions& options) {
  return read_by_gemmi(path, [&] {
    const std::string whole = with_whole_distances(text);
    gemmi::Structure structure = gemmi::read_pdb_from_memory(whole.data(), whole.size(), path);
    Molecule out = molecule_of(structure, path, options, secondary_records(structure));
    add_conect(text, out);
    out.assemblies = assemblies_of_remarks(text, path);
    return out;
  });
}

Molecule read_mmcif(std::string_view text, const std::string& path, const ImportOptions& options) {
  return read_by_gemmi(path, [&] {
    gemmi::cif::Document document = document_of(text, path);
    if (std::optional<Molecule> crystal = read_crystal(document, path, options))
      return std::move(*crystal);
    for (gemmi::cif::Block& block : document.blocks) {
      mend_charges(block);
      add_columns(block);
    }
    ComponentBonds components;
    for (const gemmi::cif::Block& block : document.blocks) add_component_bonds(block, components);
    std::vector<SecondaryRange> secondary;
    for (gemmi::cif::Block& block : document.blocks)
      for (SecondaryRange& range : secondary_categories(block))
        secondary.push_back(std::move(range));
    gemmi::Structure structure = gemmi::make_structure_from_doc(
        std::move(document), true);  // const& before gemmi 0.6, then &&
    Molecule out = molecule_of(structure, path, options, std::move(secondary));
    out.components = std::move(components);
    return out;
  });
}

ComponentBonds component_bonds_of(std::string_view text, const std::string& path) {
  return read_by_gemmi(path, [&] {
    const gemmi::cif::Document document = document_of(text, path);
    ComponentBonds out;
    for (const gemmi::cif::Block& block : document.blocks) add_component_bonds(block, out);
    return out;
  });
}

}  // namespace caplet
