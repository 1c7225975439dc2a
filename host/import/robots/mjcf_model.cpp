// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// MJCF files with their includes, sections, default classes and assets.
#include <fmt/format.h>

#include <algorithm>

#include "base/reading.h"
#include "import/detail/mjcf.h"
#include "import/detail/text_file.h"

namespace caplet::mjcf {

namespace {

/// Sections of a model that do not affect the picture.
constexpr std::string_view kPhysics =
    " option size statistic custom extension contact equality actuator sensor deformable "
    "lengthrange ";
constexpr std::string_view kSections = " compiler default asset worldbody visual tendon keyframe ";

bool is_among(std::string_view name, std::string_view words) {
  return words.find(' ' + std::string(name) + ' ') != std::string_view::npos;
}

struct Words {
  const char* element;
  std::string_view attributes;  // separated by blanks
};
constexpr Words kAttributes[] = {
    {"compiler",
     " alignfree angle assetdir autolimits balanceinertia boundinertia boundmass conflict "
     "convexhull coordinate discardvisual "
     "exactmeshinertia eulerseq fitaabb "
     "fusestatic inertiafromgeom inertiagrouprange meshdir passthrough savecanonical savecompiled "
     "saveinertial settotalmass "
     "strippath texturedir usethread "},
    {"geom",
     " adhesion axisangle castshadow class conaffinity condim contype density euler fitscale "
     "fluidcoef fluidshape friction "
     "fromto gap group hfield margin "
     "mass material mesh name pos priority quat rgba shellinertia size solimp solmix solref "
     "surfacevel type user xyaxes zaxis "},
    {"body",
     " axisangle childclass euler fuse gravcomp mocap name pos quat simple sleep user xyaxes "
     "zaxis "},
    {"frame", " axisangle childclass euler name pos quat xyaxes zaxis "},
    {"replicate", " childclass count euler offset prefix sep "},
    {"attach", " body frame model prefix "},
    {"camera",
     " axisangle class euler focal focalpixel fovy ipd mode name orthographic output pos principal "
     "principalpixel projection "
     "quat resolution sensorsize "
     "target user xyaxes zaxis "},
    {"light",
     " active ambient attenuation bulbradius castshadow class cutoff diffuse dir directional "
     "exponent intensity mode name pos "
     "range softness specular "
     "target texture type "},
    {"mesh",
     " builtin class content_type face file inertia material maxhullvert name normal params refpos "
     "refquat scale smoothnormal "
     "texcoord vertex octree_maxdepth "},
    {"hfield", " content_type elevation file name ncol nrow size "},
    {"texture",
     " builtin class colorspace content_type embed file fileback filedown filefront fileleft "
     "fileright fileup gridlayout "
     "gridsize height hflip mark markrgb "
     "name nchannel random rgb1 rgb2 type vflip width "},
    {"material",
     " class emission metallic name reflectance rgba roughness shininess specular texrepeat "
     "texture texuniform "},
};

/// Returns one name for all spellings of a path; the path itself if it has no canonical form, such
/// as a pipe.
std::string known_as(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path out = std::filesystem::weakly_canonical(path, error);
  return (error ? path : out).string();
}

}  // namespace

void check_attributes(const Model& model, pugi::xml_node node) {
  const auto* known =
      std::ranges::find(kAttributes, std::string_view(node.name()), &Words::element);
  if (known == std::end(kAttributes)) return;
  for (const pugi::xml_attribute attribute : node.attributes())
    if (!is_among(attribute.name(), known->attributes))
      model.fail(node, fmt::format("<{}> has no attribute {}", node.name(),
                                   quoted(std::string_view(attribute.name()))));
}

Model::Model(const std::filesystem::path& path, const SourceLocation& named_at,
             std::set<std::string> above)
    : folder_(path.parent_path()), above_(std::move(above)) {
  const std::string here = known_as(path);
  if (!above_.insert(here).second)
    throw InputError(named_at, "the model '" + path.string() + "' is attached to itself");
  if (above_.size() > 20)
    throw InputError(named_at, "models are attached to models more than 20 deep");
  auto file = std::make_unique<XmlFile>(path, named_at);
  root_ = file->root();
  files_.emplace(root_.root().internal_object(), std::move(file));
  seen_.insert(here);
  if (std::string_view(root_.name()) != "mujoco") fail(root_, "the root element is not <mujoco>");
  name_ = root_.attribute("model").value();
  classes_["main"];
  std::vector<pugi::xml_node> defaults, assets;
  compiler_.meshes = compiler_.textures = folder_;
  each(root_, [&](pugi::xml_node section) {
    const std::string_view name = section.name();
    if (!is_among(name, kSections) && !is_among(name, kPhysics))
      fail(section, "<mujoco> has no section " + quoted(name));
    if (name == "compiler") read_compiler(section);
    if (name == "default") defaults.push_back(section);
    if (name == "asset") assets.push_back(section);
  });
  for (const pugi::xml_node section : defaults) read_defaults(section, nullptr, 0);
  for (const pugi::xml_node section : assets) read_assets(section);
}

SourceLocation Model::place(pugi::xml_node node) const {
  const auto file = files_.find(node.root().internal_object());
  return file == files_.end() ? SourceLocation{} : file->second->place(node);
}

void Model::fail(pugi::xml_node node, const std::string& message) const {
  throw InputError(place(node), message);
}

std::vector<pugi::xml_node> Model::sections(std::string_view name) const {
  std::vector<pugi::xml_node> out;
  each(root_, [&](pugi::xml_node section) {
    if (section.name() == name) out.push_back(section);
  });
  return out;
}

pugi::xml_node Model::included(pugi::xml_node node) const {
  const auto known = includes_.find(node.internal_object());
  if (known != includes_.end()) return known->second;
  const std::string name = node.attribute("file").value();
  if (name.empty()) fail(node, "<include> without a file");
  std::filesystem::path path = folder_ / name;
  if (!is_there(path, place(node))) {
    const std::filesystem::path beside =
        std::filesystem::path(place(node).file).parent_path() / name;
    if (is_there(beside, place(node))) path = beside;
  }
  if (!seen_.insert(known_as(path)).second)
    fail(node, "the file '" + path.string() + "' is included already");
  if (seen_.size() > most_nested) fail(node, "too many files are included");
  auto file = std::make_unique<XmlFile>(path, place(node));
  const pugi::xml_node root = file->root();
  files_.emplace(root.root().internal_object(), std::move(file));
  includes_.emplace(node.internal_object(), root);
  return root;
}

void Model::read_compiler(pugi::xml_node node) {
  check_attributes(*this, node);
  const Element element(*this, node, "compiler", nullptr);
  if (element.has("angle"))
    compiler_.degrees = element.choice("angle", {"radian", "degree"}, 1) == 1;
  if (element.text("coordinate", "local") != "local")
    fail(node, "coordinate: only 'local' is read, as MuJoCo has it");
  if (element.has("strippath")) compiler_.strips_paths = element.yes("strippath", false);
  if (element.has("fitaabb")) compiler_.fits_extents = element.yes("fitaabb", false);
  if (element.has("eulerseq")) {
    compiler_.euler = element.text("eulerseq");
    if (compiler_.euler.size() != 3 ||
        compiler_.euler.find_first_not_of("xyzXYZ") != std::string::npos)
      fail(node, "eulerseq: " + quoted(std::string_view(compiler_.euler)) +
                     " is not three of x, y, z, X, Y, Z");
  }
  if (element.has("assetdir"))
    compiler_.meshes = compiler_.textures = folder_ / element.text("assetdir");
  if (element.has("meshdir")) compiler_.meshes = folder_ / element.text("meshdir");
  if (element.has("texturedir")) compiler_.textures = folder_ / element.text("texturedir");
}

void Model::read_defaults(pugi::xml_node node, const Class* parent, int depth) {
  if (depth > most_nested) fail(node, "default classes are nested too deep");
  const std::string name = node.attribute("class").value();
  Class* to = nullptr;
  if (!parent) {
    to = &classes_["main"];
    if (!name.empty() && name != "main")
      fail(node, "the outermost default class is 'main', not " + quoted(std::string_view(name)));
  } else {
    if (name.empty()) fail(node, "a default class without a name");
    const auto [entry, fresh] = classes_.try_emplace(name);
    if (!fresh)
      fail(node, "the default class " + quoted(std::string_view(name)) + " was there before");
    to = &entry->second;
    to->parent = parent;
  }
  each(node, [&](pugi::xml_node child) {
    if (std::string_view(child.name()) == "default") return;
    check_attributes(*this, child);
    to->elements.push_back(child);
  });
  each(node, [&](pugi::xml_node child) {
    if (std::string_view(child.name()) == "default") read_defaults(child, to, depth + 1);
  });
}

const Class* Model::class_of(pugi::xml_node node, const char* attribute,
                             const Class* otherwise) const {
  const pugi::xml_attribute name = node.attribute(attribute);
  if (!name) return otherwise;
  const auto found = classes_.find(name.value());
  if (found == classes_.end())
    fail(node, "there is no default class " + quoted(std::string_view(name.value())));
  return &found->second;
}

void Model::read_assets(pugi::xml_node node) {
  each(node, [&](pugi::xml_node asset) {
    const std::string kind = asset.name();
    if (!is_among(kind, " mesh hfield texture material model skin "))
      fail(asset, "<asset> has no " + quoted(std::string_view(kind)));
    check_attributes(*this, asset);
    std::string name = asset.attribute("name").value();
    if (name.empty()) name = std::filesystem::path(asset.attribute("file").value()).stem().string();
    if (kind == "model" && !asset.attribute("name")) {
      // The name is the one in the model's own root.
      const std::filesystem::path path = folder_ / asset.attribute("file").value();
      auto model = std::make_unique<Model>(path, place(asset), above_);
      name = model->name();
      models_.emplace(name, std::move(model));
    }
    if (kind == "texture" && std::string_view(asset.attribute("type").value()) == "skybox" &&
        name.empty())
      name = " sky" + std::to_string(assets_[kind].size());
    if (!assets_[kind].emplace(name, asset).second && !name.empty())
      fail(asset, fmt::format("a {} of the name {} was there before", kind,
                              quoted(std::string_view(name))));
  });
}

const std::map<std::string, pugi::xml_node>& Model::assets(const char* kind) const {
  static const std::map<std::string, pugi::xml_node> none;
  const auto found = assets_.find(kind);
  return found == assets_.end() ? none : found->second;
}

Element Model::asset(const char* kind, const std::string& name, const SourceLocation& user) const {
  const auto& all = assets(kind);
  const auto found = all.find(name);
  if (found == all.end())
    throw InputError(user, fmt::format("there is no {} {}", kind, quoted(std::string_view(name))));
  return element(found->second, kind, root_class());
}

const Model& Model::attached(const std::string& name, const SourceLocation& user) const {
  const auto known = models_.find(name);
  if (known != models_.end()) return *known->second;
  const Element of = asset("model", name, user);
  auto model = std::make_unique<Model>(folder_ / of.text("file"), of.where(), above_);
  return *models_.emplace(name, std::move(model)).first->second;
}

std::filesystem::path Model::file(const Element& of, const std::string& name,
                                  const std::filesystem::path& folder) const {
  const std::filesystem::path path =
      compiler_.strips_paths ? std::filesystem::path(name).filename() : std::filesystem::path(name);
  if (name.empty()) of.fail("a file is needed");
  return path.is_absolute() ? path : folder / path;
}

}  // namespace caplet::mjcf
