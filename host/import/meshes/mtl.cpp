// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials of Wavefront OBJ files, with the physically based parameters (Pm, Pr) that exporters
// add.
#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/reading.h"
#include "import/detail/mesh_file.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

/// Returns the file of a map: the last words, after options such as "-s 1 1 1".
std::string map_of(const LineWords& words) {
  std::size_t i = 1;
  while (i < words.count() && words.word(i).size() > 1 && words.word(i)[0] == '-' &&
         std::isalpha(static_cast<unsigned char>(words.word(i)[1]))) {
    ++i;
    float ignored = 0;
    while (i < words.count() && (parse_float(words.word(i), ignored) == NumberError::none ||
                                 words.word(i) == "on" || words.word(i) == "off"))
      ++i;
  }
  std::string name(words.rest(i));
  std::ranges::replace(name, '\\', '/');
  return name;
}

void statement(const LineWords& words, MtlValues& e) {
  const std::string_view what = words.word(0);
  const auto color = [&](glm::dvec3& out) {
    if (words.count() > 1 && (words.word(1) == "spectral" || words.word(1) == "xyz")) return;
    out.x = words.number(1);
    out.y = words.count() > 2 ? words.number(2) : out.x;
    out.z = words.count() > 3 ? words.number(3) : out.x;
    for (int k = 0; k < 3; ++k)
      if (out[k] < 0) words.fail(1, "is negative");
  };
  if (what == "Kd") color(e.kd);
  if (what == "Ks") color(e.ks);
  if (what == "Ke") color(e.ke);
  if (what == "Ns") e.ns = std::max(0.0F, words.number(1));
  if (what == "Ni") e.ni = words.number(1);
  if (what == "d" && words.word(std::min<std::size_t>(1, words.count() - 1)) != "-halo")
    e.d = words.number(1);
  if (what == "Tr") e.d = 1 - words.number(1);
  if (what == "illum")
    e.illum = static_cast<int>(std::clamp<std::int64_t>(words.whole(1), -1, 100));
  if (what == "Pm") e.metallic = std::clamp<double>(words.number(1), 0, 1);
  if (what == "Pr") e.roughness = std::clamp<double>(words.number(1), 0, 1);
  if (what == "map_Kd") e.map_kd = map_of(words);
  if (what == "map_d") e.map_d = map_of(words);
  if (what == "map_Pm") e.map_pm = map_of(words);
  if (what == "map_Pr") e.map_pr = map_of(words);
}

void begin_entry(std::vector<MtlValues>& entries, std::string name, int line) {
  MtlValues& entry = entries.emplace_back();
  entry.name = std::move(name);
  entry.line = line;
}

class Maker {
 public:
  Maker(const std::filesystem::path& folder, Scene& scene, MeshImages& images)
      : folder_(folder), scene_(scene), images_(images) {}

  MtlMaterial make(const MtlValues& e, const SourceLocation& where) {
    MtlMaterial out;
    Material material;
    material.name = e.name;
    material.where = where;
    const glm::dvec3 kd = glm::min(e.kd, glm::dvec3(1));
    const bool glass = (e.illum == 4 || e.illum == 6 || e.illum == 7 || e.illum == 9) && e.d < 1 &&
                       e.map_d.empty();
    const bool shiny = e.metallic || e.roughness || std::max({e.ks.x, e.ks.y, e.ks.z}) > 0;
    const char* color_field = "reflectance";
    if (glass) {
      DielectricMaterial model;
      model.eta = ConstantSpectrum{std::clamp(e.ni, 1.01, 4.0)};
      material.model = model;
      color_field = nullptr;
    } else if (shiny) {
      PrincipledMaterial model;
      model.base_color = RgbSpectrum{kd};
      model.metallic = e.metallic.value_or(0);
      // Converts Blinn's exponent to GGX's alpha: it is 2 / alpha^2 - 2 (Walter et al. 2007);
      // roughness is the root of alpha.
      model.roughness = e.roughness.value_or(std::sqrt(std::sqrt(2 / (e.ns + 2))));
      model.eta = std::clamp(e.ni, 1.01, 4.0);
      material.model = model;
      color_field = "base_color";
      if (is_there(e.map_pm, where))
        material.textures.push_back({"metallic", image(e.map_pm, true, where)});
      if (is_there(e.map_pr, where))
        material.textures.push_back({"roughness", image(e.map_pr, true, where)});
    } else {
      material.model = DiffuseMaterial{RgbSpectrum{kd}};
    }
    if (color_field && is_there(e.map_kd, where))
      material.textures.push_back({color_field, image(e.map_kd, false, where)});
    if (!glass && is_there(e.map_d, where)) {
      TextureOperand alpha(1);
      alpha.texture = image(e.map_d, true, where);
      out.alpha = alpha;
    } else if (!glass && e.d < 1) {
      out.alpha = TextureOperand(std::max(0.0, e.d));
    }
    if (std::max({e.ke.x, e.ke.y, e.ke.z}) > 0) {
      AreaEmission emission;
      emission.radiance = RgbSpectrum{e.ke};
      emission.two_sided = true;
      out.emission = emission;
    }
    out.material = narrow<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
    return out;
  }

 private:
  /// Models are often distributed without their images or with absolute paths. Such images are left
  /// out with a warning.
  bool is_there(const std::string& name, const SourceLocation& where) const {
    if (name.empty()) return false;
    if (caplet::is_there(folder_ / name, where)) return true;
    Diagnostics().warning(
        where, "the image '" + (folder_ / name).string() + "' is left out: there is no such file");
    return false;
  }
  std::uint32_t image(const std::string& name, bool is_float, const SourceLocation& where) {
    return images_.texture(folder_ / name, is_float, !is_float, where);
  }
  const std::filesystem::path& folder_;
  Scene& scene_;
  MeshImages& images_;
};

}  // namespace

std::map<std::string, MtlMaterial> read_mtl(const std::filesystem::path& path,
                                            const SourceLocation& named_at, Scene& scene,
                                            MeshImages& images) {
  std::optional<TextFile> file;
  try {
    file.emplace(path);
  } catch (const InputError& error) {
    throw InputError(named_at, error.what());
  }
  const std::string name = path.string();
  std::string_view text = file->text();
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<MtlValues> entries;
  for (int line = 1; !text.empty(); ++line) {
    const LineWords words(take_line(text), name, line);
    if (words.count() == 0) continue;
    if (words.word(0) == "newmtl")
      begin_entry(entries, std::string(words.rest(1)), line);
    else if (!entries.empty())
      statement(words, entries.back());
  }
  const std::filesystem::path folder = path.parent_path();
  Maker maker(folder, scene, images);
  std::map<std::string, MtlMaterial> out;
  for (const MtlValues& entry : entries)
    out.insert_or_assign(entry.name, maker.make(entry, {path.string(), entry.line, 0}));
  return out;
}

MtlMaterial make_mtl(const MtlValues& values, const SourceLocation& where,
                     const std::filesystem::path& folder, Scene& scene, MeshImages& images) {
  return Maker(folder, scene, images).make(values, where);
}

}  // namespace caplet
