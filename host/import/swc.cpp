// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples are parsed and linked first. Then somata become spheres or chains, and every other sample
// a segment to its parent.
#include "import/detail/swc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/importers.h"
#include "import/detail/swc_color.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

constexpr std::size_t kColumns = 7;
constexpr std::array<const char*, kColumns> kColumnNames = {"id", "type",   "x",     "y",
                                                            "z",  "radius", "parent"};
/// A radius of 0 means "not measured" or "tapers off". It is replaced by this part of the file's
/// median positive radius.
constexpr float kMissingRadiusPart = 0.25F;

struct Token {
  std::string_view text;
  int column = 0;  // bytes, from 1
};

/// Splits a line before any comment at blanks, into at most one part more than there are columns.
std::size_t split(std::string_view line, std::array<Token, kColumns + 1>& tokens) {
  std::size_t count = 0, i = 0;
  while (count < tokens.size()) {
    while (i < line.size() && is_blank(line[i])) ++i;
    if (i >= line.size() || line[i] == '#') break;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i]) && line[i] != '#') ++i;
    tokens[count++] = {line.substr(begin, i - begin), static_cast<int>(begin) + 1};
  }
  return count;
}

/// Parses an integer, also with a decimal point or an exponent, as programs without integers write
/// it ("12.0", "1.2e1").
template <class Integer>
bool parse_integer(std::string_view token, Integer& value) {
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc() && stop == end) return true;
  double decimal = 0;
  const auto [decimal_stop, decimal_error] = std::from_chars(token.data(), end, decimal);
  constexpr double most = std::is_same_v<Integer, std::int32_t>
                              ? 2147483647.0
                              : 9007199254740992.0;  // 2^53: all smaller integers are exact
  if (decimal_error != std::errc() || decimal_stop != end || !(std::abs(decimal) <= most) ||
      decimal != std::floor(decimal))
    return false;
  value = static_cast<Integer>(decimal);
  return true;
}

class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  std::vector<SwcSample> parse(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    for (int line = 1; !text.empty(); ++line) parse_line(take_line(text), line);
    if (extra_columns_ > 0)
      diagnostics_.warning({name_, first_extra_, 0},
                           fmt::format("columns after the seventh are ignored ({} lines have some)",
                                       extra_columns_));
    if (samples_.empty() && !diagnostics_.has_errors())
      diagnostics_.error({name_, 0, 0}, "holds no samples");
    link();
    diagnostics_.finish();
    find_cycles();
    diagnostics_.finish();
    return std::move(samples_);
  }

 private:
  void parse_line(std::string_view line, int number) {
    std::array<Token, kColumns + 1> tokens;
    const std::size_t count = split(line, tokens);
    if (count == 0) return;
    if (count < kColumns) {
      diagnostics_.error(
          {name_, number,
           tokens[count - 1].column + static_cast<int>(tokens[count - 1].text.size())},
          fmt::format("{} columns where 7 are needed (id type x y z radius parent): {} is missing",
                      count, kColumnNames[count]));
      return;
    }
    if (count > kColumns && extra_columns_++ == 0) first_extra_ = number;
    SwcSample sample;
    sample.line = number;
    bool good = true;
    const auto refuse = [&](std::size_t column, const std::string& message) {
      diagnostics_.error({name_, number, tokens[column].column},
                         fmt::format("{}: {}", kColumnNames[column], message));
      good = false;
    };
    const auto integer = [&](std::size_t column, auto& value) {
      if (!parse_integer(tokens[column].text, value))
        refuse(column, fmt::format("{} is not a whole number", quoted(tokens[column].text)));
    };
    const auto number_at = [&](std::size_t column, float& value) {
      const NumberError error = parse_float(tokens[column].text, value);
      if (error != NumberError::none) refuse(column, describe(error, tokens[column].text));
    };
    integer(0, sample.id);
    integer(1, sample.type);
    for (int axis = 0; axis < 3; ++axis)
      number_at(2 + static_cast<std::size_t>(axis), sample.position[axis]);
    number_at(5, sample.radius);
    integer(6, sample.parent_id);
    if (!good) return;
    if (sample.id < 0) refuse(0, fmt::format("{} is negative", sample.id));
    if (sample.type < 0) refuse(1, fmt::format("{} is negative", sample.type));
    if (sample.radius < 0) refuse(5, fmt::format("{} is negative", sample.radius));
    if (sample.parent_id < -1)
      refuse(6, fmt::format("{} is neither an id nor -1 (a root)", sample.parent_id));
    if (sample.parent_id == sample.id)
      refuse(6, fmt::format("sample {} is its own parent", sample.id));
    if (!good) return;
    samples_.push_back(sample);
    in_file_.prove();
  }

  /// Sets `parent`. Reports repeated ids and missing parents (the latter only if no line was
  /// refused, since that line may be the parent).
  void link() {
    std::vector<std::uint32_t> by_id(samples_.size());
    std::iota(by_id.begin(), by_id.end(), 0U);
    const auto id_of = [this](std::uint32_t i) { return samples_[i].id; };
    if (!std::ranges::is_sorted(by_id, {}, id_of)) std::ranges::stable_sort(by_id, {}, id_of);
    for (std::size_t i = 1; i < by_id.size(); ++i) {
      const SwcSample &first = samples_[by_id[i - 1]], &second = samples_[by_id[i]];
      if (first.id == second.id)
        diagnostics_.error({name_, second.line, 0},
                           fmt::format("id {} is already that of line {}", second.id, first.line));
    }
    if (diagnostics_.has_errors()) return;
    const std::int64_t first_id = samples_.empty() ? 0 : id_of(by_id.front());
    for (SwcSample& sample : samples_) {
      if (sample.parent_id < 0) continue;
      // If ids have no gaps, they give the index directly.
      const auto guess = static_cast<std::uint64_t>(sample.parent_id - first_id);
      if (sample.parent_id >= first_id && guess < by_id.size() &&
          id_of(by_id[guess]) == sample.parent_id) {
        sample.parent = static_cast<std::int32_t>(by_id[guess]);
        continue;
      }
      const auto found = std::ranges::lower_bound(by_id, sample.parent_id, {}, id_of);
      if (found == by_id.end() || id_of(*found) != sample.parent_id)
        diagnostics_.error({name_, sample.line, 0},
                           fmt::format("parent {} is no sample of this file", sample.parent_id));
      else
        sample.parent = static_cast<std::int32_t>(*found);
    }
  }

  void find_cycles() {
    constexpr std::uint32_t kUnseen = 0;
    std::vector<std::uint32_t> walk_of(samples_.size(), kUnseen);
    for (std::uint32_t start = 0; start < samples_.size(); ++start) {
      const std::uint32_t walk = start + 1;
      auto i = static_cast<std::int32_t>(start);
      while (i >= 0 && walk_of[static_cast<std::size_t>(i)] == kUnseen) {
        walk_of[static_cast<std::size_t>(i)] = walk;
        i = samples_[static_cast<std::size_t>(i)].parent;
      }
      if (i >= 0 && walk_of[static_cast<std::size_t>(i)] == walk) {
        const SwcSample& sample = samples_[static_cast<std::size_t>(i)];
        diagnostics_.error({name_, sample.line, 0},
                           fmt::format("sample {} is its own ancestor", sample.id));
      }
    }
  }

  const std::string& name_;
  Diagnostics diagnostics_;
  std::vector<SwcSample> samples_;
  std::size_t extra_columns_ = 0;
  int first_extra_ = 0;
  Unproven in_file_;
};

/// Gives a radius to samples without one, and warns.
void fill_missing_radii(std::vector<SwcSample>& samples, const std::string& name) {
  std::vector<float> known;
  const SwcSample* first = nullptr;
  for (const SwcSample& sample : samples) {
    if (sample.radius > 0)
      known.push_back(sample.radius);
    else if (!first)
      first = &sample;
  }
  if (!first) return;
  float filled = 0;
  if (!known.empty()) {
    const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
    std::ranges::nth_element(known, middle);
    filled = kMissingRadiusPart * *middle;
  } else {
    glm::vec3 low(samples[0].position), high(low);
    for (const SwcSample& sample : samples) {
      low = glm::min(low, sample.position);
      high = glm::max(high, sample.position);
    }
    constexpr double kThin = 1.0 / 512;
    const double extent = glm::length(glm::dvec3(high) - glm::dvec3(low));
    filled = extent > 0 ? static_cast<float>(kThin * extent) : 1.0F;
  }
  // A radius that rounds to 0 would be missing again.
  filled = std::max(filled, std::numeric_limits<float>::min());
  std::size_t missing = 0;
  for (SwcSample& sample : samples)
    if (!(sample.radius > 0)) {
      sample.radius = filled;
      ++missing;
    }
  Diagnostics().warning({name, first->line, 0},
                        fmt::format("{} of {} samples have radius 0; they get {:.4g}", missing,
                                    samples.size(), filled));
}

constexpr int kFork = 5, kEnd = 6;
bool is_mark(int type) { return type == kFork || type == kEnd; }

/// Types 5 and 6 mark fork and end points and say nothing of the neurite. They are replaced by the
/// type of the branch: that of the nearest ancestor that has one; at the soma or a root, that of
/// the first descendant (in file order) that has one; otherwise 0.
void resolve_marks(std::vector<SwcSample>& samples) {
  const auto parent_of = [&](std::size_t i) { return samples[i].parent; };
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  std::vector<std::size_t> path;
  // The walk goes down from ancestors and visits each sample once: those of a branch without a type
  // stay marked in `open`.
  std::vector<bool> open(samples.size(), false);
  const auto from_ancestors = [&] {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      path.clear();
      auto k = static_cast<std::int32_t>(i);
      while (k >= 0 && is_mark(samples[at(k)].type) && !open[at(k)]) {
        path.push_back(at(k));
        k = parent_of(at(k));
      }
      const int type = k >= 0 ? samples[at(k)].type : kSoma;
      for (const std::size_t one : path)
        if (type == kSoma || is_mark(type))
          open[one] = true;
        else
          samples[one].type = type;
    }
  };
  from_ancestors();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const int type = samples[i].type;
    if (type == kSoma || is_mark(type)) continue;
    for (std::int32_t k = parent_of(i); k >= 0 && is_mark(samples[at(k)].type);
         k = parent_of(at(k)))
      samples[at(k)].type = type;
  }
  open.assign(samples.size(), false);
  from_ancestors();
  for (SwcSample& sample : samples)
    if (is_mark(sample.type)) sample.type = 0;
}

/// How a sample is drawn.
struct Role {
  bool segment = false;  // to its parent
  bool sphere = false;   // a soma that is one sphere, or a sample that would otherwise be invisible
};

/// Recognises NeuroMorpho.Org's soma of three points: two children of the first, at plus and minus
/// one radius along y. Its files round to two decimals, so each of the numbers compared is off by
/// up to 0.005: 0.01 for a difference of two.
bool is_three_point_soma(const SwcSample& centre, const SwcSample& a, const SwcSample& b) {
  const float tolerance = std::max(1e-3F * centre.radius, std::min(0.011F, 0.1F * centre.radius));
  const auto near = [tolerance](float x, float y) { return std::abs(x - y) <= tolerance; };
  const glm::vec3 da = a.position - centre.position, db = b.position - centre.position;
  const bool same_radius = near(a.radius, centre.radius) && near(b.radius, centre.radius);
  const bool on_axis = near(da.x, 0) && near(da.z, 0) && near(db.x, 0) && near(db.z, 0);
  return same_radius && on_axis && near(std::abs(da.y), centre.radius) && near(da.y, -db.y);
}

std::vector<Role> roles_of(const std::vector<SwcSample>& samples) {
  const std::size_t count = samples.size();
  struct SomaLinks {
    std::uint32_t children = 0;
    std::array<std::uint32_t, 2> first{};
    bool grandchildren = false;
  };
  std::map<std::uint32_t, SomaLinks> somata;  // by sample, for the few samples of type soma
  std::vector<bool> has_children(count, false);
  const auto is_soma = [&](std::int32_t i) {
    return i >= 0 && samples[static_cast<std::size_t>(i)].type == kSoma;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int32_t parent = samples[i].parent;
    if (parent >= 0) has_children[static_cast<std::size_t>(parent)] = true;
    if (!is_soma(static_cast<std::int32_t>(i))) continue;
    somata.try_emplace(i);
    if (!is_soma(parent)) continue;
    SomaLinks& links = somata[static_cast<std::uint32_t>(parent)];
    if (links.children < 2) links.first[links.children] = i;
    ++links.children;
    const std::int32_t grandparent = samples[static_cast<std::size_t>(parent)].parent;
    if (is_soma(grandparent)) somata[static_cast<std::uint32_t>(grandparent)].grandchildren = true;
  }

  std::vector<Role> roles(count);
  for (std::size_t i = 0; i < count; ++i)
    roles[i] = {samples[i].parent >= 0, samples[i].parent < 0 && !has_children[i]};
  for (const auto& [i, links] : somata) {
    if (is_soma(samples[i].parent)) continue;
    if (links.children == 0) {
      roles[i].sphere = true;
    } else if (links.children == 2 && !links.grandchildren &&
               is_three_point_soma(samples[i], samples[links.first[0]], samples[links.first[1]])) {
      roles[i].sphere = true;
      roles[links.first[0]].segment = roles[links.first[1]].segment = false;
    }
  }
  return roles;
}

/// Returns u at the parent and at the sample of each segment: from 0 to 1 by length along each
/// branch. A branch continues while exactly one segment follows, and ends at a soma.
std::vector<glm::vec2> along_branches(const std::vector<SwcSample>& samples,
                                      const std::vector<Role>& roles) {
  constexpr std::int32_t none = -1, several = -2;
  const auto parent_of = [&](std::size_t i) { return static_cast<std::size_t>(samples[i].parent); };
  std::vector<std::int32_t> next(samples.size(), none);  // the only segment that starts at a sample
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!roles[i].segment) continue;
    std::int32_t& of_parent = next[parent_of(i)];
    of_parent = of_parent == none ? static_cast<std::int32_t>(i) : several;
  }
  const auto goes_on = [&](std::size_t i) {  // whether the branch continues past the sample
    return next[i] >= 0 &&
           (samples[i].type == kSoma) == (samples[static_cast<std::size_t>(next[i])].type == kSoma);
  };
  std::vector<glm::vec2> out(samples.size());
  std::vector<std::size_t> branch;
  std::vector<double> ends;
  for (std::size_t first = 0; first < samples.size(); ++first) {
    if (!roles[first].segment) continue;
    const std::size_t before = parent_of(first);
    if (roles[before].segment && goes_on(before)) continue;
    branch.clear();
    ends.clear();
    double length = 0;
    for (std::size_t i = first;; i = static_cast<std::size_t>(next[i])) {
      length +=
          glm::length(glm::dvec3(samples[i].position) - glm::dvec3(samples[parent_of(i)].position));
      branch.push_back(i);
      ends.push_back(length);
      if (!goes_on(i)) break;
    }
    float u = 0;
    for (std::size_t k = 0; k < branch.size(); ++k) {
      const double share = length > 0
                               ? ends[k] / length
                               : static_cast<double>(k + 1) / static_cast<double>(branch.size());
      out[branch[k]] = {u, static_cast<float>(share)};
      u = out[branch[k]].y;
    }
  }
  return out;
}

/// Returns the unit direction from the soma (without one, the first sample) to the middle of the
/// apical dendrites, whose segments count by their lengths; none where there is none.
std::optional<glm::dvec3> apical_direction(const std::vector<SwcSample>& samples) {
  glm::dvec3 soma(0), middle(0);
  double somata = 0, length = 0;
  for (const SwcSample& sample : samples) {
    if (sample.type == kSoma) {
      soma += glm::dvec3(sample.position);
      somata += 1;
    }
    if (sample.type != kApical || sample.parent < 0) continue;
    const glm::dvec3 end(sample.position),
        begin(samples[static_cast<std::size_t>(sample.parent)].position);
    middle += 0.5 * glm::distance(begin, end) * (begin + end);
    length += glm::distance(begin, end);
  }
  if (!(length > 0)) return std::nullopt;
  const glm::dvec3 way =
      middle / length - (somata > 0 ? soma / somata : glm::dvec3(samples.front().position));
  if (!(glm::length(way) > 0)) return std::nullopt;
  return glm::normalize(way);
}

}  // namespace

std::vector<SwcSample> parse_swc(std::string_view text, const std::string& name) {
  return Parser(name).parse(text);
}

Scene import_swc(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  Scene scene;
  scene.source = path.string();
  std::vector<SwcSample> samples = parse_swc(TextFile(path).text(), scene.source);
  fill_missing_radii(samples, scene.source);
  resolve_marks(samples);
  const std::vector<Role> roles = roles_of(samples);

  SwcColors colors(scene, samples, path, options);
  CapsulesShape segments;
  const auto count = static_cast<std::size_t>(std::ranges::count(roles, true, &Role::segment));
  for (std::vector<glm::vec3>* points : {&segments.p0, &segments.p1}) points->reserve(count);
  for (std::vector<float>* radii : {&segments.radius0, &segments.radius1}) radii->reserve(count);
  const std::vector<glm::vec2> u = along_branches(samples, roles);
  segments.u.reserve(count);
  segments.materials.reserve(count);
  bool tapered = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SwcSample& sample = samples[i];
    if (roles[i].sphere) {
      Shape sphere;
      sphere.geometry = SphereShape{sample.radius};
      sphere.world_from_object = glm::translate(glm::dmat4(1), glm::dvec3(sample.position));
      sphere.material = colors.of(sample);
      sphere.name = fmt::format("sample {}", sample.id);
      sphere.where = {scene.source, sample.line, 0};
      scene.shapes.push_back(std::move(sphere));
    }
    if (!roles[i].segment) continue;
    // A neurite does not widen towards its soma: the segment between them has the neurite's radius
    // and material.
    const SwcSample& parent = samples[static_cast<std::size_t>(sample.parent)];
    const bool from_soma = parent.type == kSoma && sample.type != kSoma,
               to_soma = parent.type != kSoma && sample.type == kSoma;
    segments.p0.push_back(parent.position);
    segments.p1.push_back(sample.position);
    segments.radius0.push_back(from_soma ? sample.radius : parent.radius);
    segments.radius1.push_back(to_soma ? parent.radius : sample.radius);
    segments.materials.push_back(colors.of(to_soma ? parent : sample));
    segments.u.push_back(u[i]);
    tapered |= segments.radius0.back() != segments.radius1.back();
  }
  if (!tapered) segments.radius1 = {};
  if (!segments.p0.empty()) {
    Shape shape;
    shape.geometry = std::move(segments);
    shape.name = path.stem().string();
    shape.where = {scene.source, 1, 0};
    scene.shapes.push_back(std::move(shape));
  }
  scene.legend = colors.legend();
  scene.has_no_up = true;
  if (options.text("up") == "apical") {
    scene.framing.up = apical_direction(samples);
    if (!scene.framing.up)
      throw InputError(
          {"--up"}, scene.source + " has no apical dendrite (samples of type 4) beside its soma");
  }
  scene.unit = "\u00b5m";
  return scene;
}

}  // namespace caplet
