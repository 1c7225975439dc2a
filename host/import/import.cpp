// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>

#include "base/log.h"
#include "base/reading.h"
#include "base/spelling.h"
#include "import/color_map.h"
#include "import/detail/placement.h"
#include "import/picture_options.h"
#include "present/lights.h"
#include "present/present.h"
#include "scene/append.h"
#include "scene/names.h"

namespace caplet {

namespace fs = std::filesystem;

namespace {

/// Common files of these fields that no importer reads, with advice.
constexpr std::pair<const char*, const char*> not_read[] = {
    {".nml",
     "NeuroML is not read by the program; Python's caplet.from_neuroml reads it. Or write the "
     "morphology as SWC"},
    {".h5",
     "SONATA and other HDF5 files are not read by the program; Python's caplet.from_sonata reads "
     "circuits, caplet.from_morphio "
     "morphologies. Or write the morphologies as SWC (morphio's Morphology.write), one file a "
     "cell"},
    {"circuit_config.json",
     "SONATA circuits are not read by the program; Python's caplet.from_sonata reads them"},
    {".asc",
     "Neurolucida files are not read by the program; Python's caplet.from_morphio takes them as "
     "MorphIO reads them. Or write the "
     "morphology as SWC (morphio's Morphology.write)"},
    {".tree",
     "a tree of `caplet build` has no shapes: render, pick and info read it, and it alone; others "
     "need the scene that it was built of"},
};

/// Returns the name of an XML file's root element, as far as its first 64 KiB show it; else empty.
std::string root_element(const fs::path& path) {
  std::string text(1 << 16, '\0');
  std::ifstream stream;
  if (is_file(path, {})) stream.open(path, std::ios::binary);  // opening a pipe would block
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    if (text.compare(at, 4, "<!--") == 0)
      at = text.find("-->", at);
    else if (text.compare(at, 2, "<?") == 0 || text.compare(at, 2, "<!") == 0)
      at = text.find('>', at);
    else
      return text.substr(at + 1, text.find_first_of(" \t\r\n/>", at) - at - 1);
  }
  return {};
}

void check_readable(const fs::path& path) {
  check_may_read(path);
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw InputError({path.string()}, "no such file");
  if (status.type() == fs::file_type::none)
    throw InputError({path.string()}, "cannot be read (" + error.message() + ")");
  if (fs::is_directory(status)) throw InputError({path.string()}, "is a folder, not a file");
  if (!fs::is_regular_file(status)) throw InputError({path.string()}, "is no regular file");
  if (fs::file_size(path, error) == 0 && !error)
    throw InputError({path.string()}, "the file is empty");
}

bool is_of_all(const std::string& name) {
  const auto found = std::ranges::find(import_option_rows(), name, &ImportOptionRow::name);
  return found != import_option_rows().end() && found->of != ImportOptionRow::Of::format;
}

/// Restricts this thread to the file's own folder if the options ask for it.
class Fence {
 public:
  Fence(const fs::path& path, const ImportOptions& options) {
    if (options.yes("no-outside", false)) beneath_.emplace(path);
  }

 private:
  std::optional<ReadingBeneath> beneath_;
};

bool knows(const Format& format, const std::string& option) {
  return std::ranges::find(format.options, option) != format.options.end();
}

[[noreturn]] void refuse_option(const std::string& name,
                                const std::vector<const Format*>& formats_of_files) {
  std::vector<std::string> who, whose;
  for (const Format& other : formats())
    if (knows(other, name)) who.push_back(other.name);
  for (const Format* format : formats_of_files)
    if (std::ranges::find(whose, format->name) == whose.end()) whose.push_back(format->name);
  std::string message =
      fmt::format("says nothing to files of the format {}", fmt::join(whose, ", "));
  if (!who.empty()) message += fmt::format(" (it does to: {})", fmt::join(who, ", "));
  throw InputError({"--" + name}, message);
}

/// `formats_of_files`: the format of each file that is read.
void check_known(const ImportOptions& options, const std::vector<const Format*>& formats_of_files) {
  for (const auto& [name, value] : options.values())
    if (!is_of_all(name) &&
        std::ranges::none_of(formats_of_files,
                             [&name = name](const Format* format) { return knows(*format, name); }))
      refuse_option(name, formats_of_files);
}

/// Returns the options that the format knows. Only an importer can tell where an apical dendrite
/// is.
ImportOptions known_to(const Format& format, const ImportOptions& options) {
  std::map<std::string, std::string> values;
  for (const auto& [name, value] : options.values())
    if (knows(format, name) || (name == "up" && value == "apical")) values.emplace(name, value);
  ImportOptions out(std::move(values));
  out.file = options.file;
  out.files = options.files;
  out.seen = options.seen;
  out.are_of_scene = options.are_of_scene;
  return out;
}

void tell_range(const ValueRange& range, const ImportOptions& options) {
  if (!range.is_there) return;
  const auto asked = options.range("range");
  log::info(
      "colours: {} from {:.6g} to {:.6g}, dark blue to yellow (viridis){}", range.what,
      asked ? asked->first : range.low, asked ? asked->second : range.high,
      asked ? fmt::format("; the values are from {:.6g} to {:.6g}", range.low, range.high) : "");
}

/// Adds the counts of a file to those of the scene, by their names.
void add_contents(Scene& scene, const Scene& file) {
  for (const auto& [name, count] : file.contents) {
    const auto known =
        std::ranges::find(scene.contents, name, &std::pair<std::string, std::uint64_t>::first);
    if (known == scene.contents.end())
      scene.contents.emplace_back(name, count);
    else
      known->second += count;
  }
}

/// Returns the legend of a colour map; `unit` is that of lengths.
Legend legend_of(const ValueRange& range, const ImportOptions& options, const std::string& unit) {
  const auto [low, high] = options.range("range").value_or(std::pair(range.low, range.high));
  return map_legend(range.what, range.is_length ? unit : "", low, high);
}

Scene validated(Scene scene) {
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  diagnostics.finish();
  return scene;
}

// --- Several files ---

bool is_studio(const Light& light) {
  const auto* infinite = std::get_if<InfiniteLight>(&light.model);
  return infinite && infinite->image && infinite->image->preset == studio_preset;
}

/// Removes an automatic camera and the studio light, because the joined scene is framed anew.
void open_again(Imported& file) {
  if (!file.scene.automatic_camera) return;
  std::erase_if(file.scene.lights, is_studio);
  file.scene.automatic_camera = false;
  file.has_camera = false;
  file.is_lit = is_lit(file.scene);
}

/// Moves a file's shapes. It is framed and lit anew.
void place(Imported& file, const glm::dmat4& placement, const fs::path& path) {
  open_again(file);
  if (file.has_camera || !file.scene.lights.empty() || !file.scene.media.empty())
    log::warn("{}: its shapes alone are moved, not its camera, lights and media", path.string());
  place(file.scene, placement);
}

/// Returns names that tell the files apart.
std::vector<std::string> names_of(std::span<const fs::path> paths) {
  std::map<std::string, int> count;
  for (const fs::path& path : paths) ++count[path.stem().string()];
  std::vector<std::string> out;
  std::map<std::string, int> used;
  for (const fs::path& path : paths) {
    const std::string stem = path.stem().string();
    out.push_back(count[stem] == 1 ? stem : fmt::format("{} {}", stem, ++used[stem]));
  }
  return out;
}

/// Returns the unit of the files that state one; empty where they differ.
std::string common_unit(const std::vector<Imported>& files) {
  std::string out;
  for (const Imported& file : files) {
    const std::string& unit = file.scene.unit;
    if (!out.empty() && !unit.empty() && unit != out) return "";
    if (out.empty()) out = unit;
  }
  return out;
}

Scene joined(std::vector<Imported> files, std::span<const fs::path> paths) {
  std::optional<std::size_t> with_camera;
  for (std::size_t i = 0; i < files.size(); ++i) {
    open_again(files[i]);
    if (files[i].has_camera && with_camera)
      throw InputError({paths[i].string()}, "brings a camera, as " + paths[*with_camera].string() +
                                                " does: of several files one at most may");
    if (files[i].has_camera) with_camera = i;
  }
  // Without a camera, the first file that states a picture or lights gives size and samples; if
  // none does, the format that asks for most width, and a noise if one has it.
  std::optional<std::size_t> settings = with_camera;
  for (std::size_t i = 0; i < files.size() && !settings; ++i)
    if (!files[i].scene.view.film.filename.empty() || files[i].is_lit) settings = i;
  const std::size_t head = settings.value_or(0);
  Scene scene;
  {
    const Scene& from = files[head].scene;
    scene.view = from.view;
    scene.source = from.source;
    scene.has_no_up =
        std::ranges::all_of(files, [](const Imported& file) { return file.scene.has_no_up; });
    scene.world_from_file = from.world_from_file;
    scene.unit = common_unit(files);
    for (const Imported& file : files) {
      if (!scene.legend)
        scene.legend = file.scene.legend;
      else if (file.scene.legend)
        add_names(*scene.legend, *file.scene.legend);
      add_contents(scene, file.scene);
      if (settings) continue;
      scene.view.film.least_width =
          std::max(scene.view.film.least_width, file.scene.view.film.least_width);
      if (file.scene.view.sampler.noise > 0) scene.view.sampler = file.scene.view.sampler;
    }
  }
  Imported out(std::move(scene));
  out.has_camera = with_camera.has_value();
  const std::vector<std::string> names = names_of(paths);
  for (std::size_t i = 0; i < files.size(); ++i) {
    Scene& part = files[i].scene;
    out.is_lit |= files[i].is_lit;
    prefix_names(part, names[i],
                 paths[i].stem().string());  // pictures use the prefixed names of shapes
    const Appended at = append(out.scene, std::move(part));
    if (i == head && out.scene.view.camera.medium) *out.scene.view.camera.medium += at.media;
    part = {};
  }
  return presented(std::move(out));
}

}  // namespace

const Format& format_of(const fs::path& path) {
  const std::string name = lower_case(path.filename().string());
  std::string known;
  for (const Format& format : formats())
    for (const std::string& extension : format.extensions) {
      if (name.size() > extension.size() && name.ends_with(extension) &&
          (extension != ".xml" || is_its_root(format, root_element(path))))
        return format;
      if ((", " + known + ", ").find(", " + extension + ", ") == std::string::npos)
        known += (known.empty() ? "" : ", ") + extension;
    }
  for (const auto& [extension, what] : not_read)
    if (name.ends_with(extension)) throw InputError({path.string()}, what);
  throw InputError({path.string()}, "no known scene format (known: " + known + ")");
}

namespace {

/// Reads a file, with its format's defaults for what such files do not state.
Imported import_file(const Format& format, const fs::path& path, const ImageReader& images,
                     const ImportOptions& options) {
  Imported file = format.import(path, images, options);
  View& view = file.scene.view;
  if (format.least_width > 0) view.film.least_width = format.least_width;
  if (format.noise > 0) {
    view.sampler.noise = format.noise;
    view.sampler.samples_per_pixel = most_noise_samples;
  }
  return file;
}

}  // namespace

std::vector<ImportOptionRow> format_options_of(std::span<const fs::path> paths) {
  std::vector<ImportOptionRow> out;
  for (const ImportOptionRow& row : import_option_rows()) {
    const auto knows = [&](const fs::path& path) {
      const std::vector<std::string>& known = format_of(placed_file(path).path).options;
      return std::ranges::find(known, row.name) != known.end();
    };
    if (row.of == ImportOptionRow::Of::format && std::ranges::any_of(paths, knows))
      out.push_back(row);
  }
  return out;
}

Imported read_scene(const fs::path& path, const ImageReader& images, const ImportOptions& options,
                    const Format* format) {
  const Fence fence(path, options);
  check_readable(path);
  if (!format) format = &format_of(path);
  check_known(options, {format});
  return import_file(*format, path, images, options);
}

Scene presented(Imported file) {
  Scene& scene = file.scene;
  if (scene.automatic_camera || (file.has_camera && file.is_lit)) return std::move(scene);
  if (!file.has_camera && !file.is_lit && scene.shapes.empty() && scene.instances.empty())
    throw InputError(SourceLocation{scene.source},
                     "the scene is empty: it has no shapes, no light and no camera");
  if (!can_be_framed(scene)) return std::move(scene);
  if (!file.has_camera) frame_camera(scene);
  if (!file.is_lit) add_studio_light(scene);
  return std::move(scene);
}

Scene import_scene(const fs::path& path, const ImageReader& images, const ImportOptions& options) {
  return import_scenes(std::span(&path, 1), images, options);
}

Scene import_scenes(std::span<const fs::path> given, const ImageReader& images,
                    const ImportOptions& options) {
  std::vector<fs::path> paths;
  std::vector<std::optional<glm::dmat4>> placements;
  for (const fs::path& one : given) {
    const PlacedFile placed = placed_file(one);
    paths.push_back(placed.path);
    placements.push_back(placed.placement);
  }
  std::vector<const Format*> formats_of_files;
  for (const fs::path& path : paths) {
    const Fence fence(path, options);
    check_readable(path);
    formats_of_files.push_back(&format_of(path));
  }
  check_known(options, formats_of_files);
  ValueRange all;
  std::vector<Imported> files;
  std::vector<std::size_t> by_values;  // files that use a colour map
  const auto read = [&](std::size_t i, ImportOptions of_all) {
    of_all.file = i;
    of_all.files = paths.size();
    of_all.seen = std::make_shared<ValueRange>();
    const Fence fence(paths[i], options);
    Imported file =
        import_file(*formats_of_files[i], paths[i], images, known_to(*formats_of_files[i], of_all));
    if (const ValueRange& seen = *of_all.seen; seen.is_there) {
      by_values.push_back(i);
      all.what = seen.what;
      all.is_length = seen.is_length;
      all.extend(seen.low);
      all.extend(seen.high);
    }
    return file;
  };
  for (std::size_t i = 0; i < paths.size(); ++i) files.push_back(read(i, options));
  tell_range(all, options);
  if (by_values.size() > 1 && !options.text("range") && all.low < all.high) {
    // All files share one range, which is known only after they are read.
    ImportOptions of_all = options;
    of_all.set("range", fmt::format("{},{}", all.low, all.high));
    for (const std::size_t i : std::exchange(by_values, {})) files[i] = read(i, of_all);
  }
  for (std::size_t i = 0; i < paths.size(); ++i)
    if (placements[i]) place(files[i], *placements[i], paths[i]);
  Scene scene =
      files.size() == 1 ? presented(std::move(files.front())) : joined(std::move(files), paths);
  if (all.is_there && !scene.legend) scene.legend = legend_of(all, options, scene.unit);
  apply_picture_options(scene, images, options,
                        std::ranges::any_of(formats_of_files, [](const Format* format) {
                          return knows(*format, "up");
                        }));
  make_names_valid(scene);
  return validated(std::move(scene));
}

}  // namespace caplet
