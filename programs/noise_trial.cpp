// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Measures how true the stated noise is: renders scenes with many seeds, evenly and to targets of
// noise, and compares what the films state with how their pixels differ from seed to seed. Prints a
// line of JSON for each scene and way of sampling.
//
//   ways        "even" has the same number of samples in all pixels; a number is a target of noise
//   held        share of the values (pixel, channel) within 1.96 stated deviations of the mean of
//               all other seeds, whose own error widens the interval
//   stated      mean stated variance over mean true variance
//   typical     that of the median pixel
//   noise       true noise of one picture, as render.h defines it, and what the renders stated
//   samples     of a pixel, in the mean
//   apart       difference between the mean of all pictures and that of the even way, in standard
//               errors
#include <caplet/import.h>
#include <caplet/session.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace {

constexpr std::array<const char*, 3> colors{"R", "G", "B"};
constexpr std::array<double, 3> luminance{0.2126, 0.7152, 0.0722};  // of BT.709
constexpr int reach = 3;                                            // of the 7 x 7 around a pixel
constexpr double floor_share = 0.25;  // of the picture's mean luminance

/// A scene in one way of sampling.
struct Way {
  std::optional<double> target = {};
  std::vector<std::vector<float>> values = {},
                                  variances = {};  // by seed: all pixels of R, then G, then B
  std::vector<double> stated_noise = {}, seconds = {}, samples = {};
  std::vector<double> seen = {};  // seeds that saw something in the pixel, or in one of the 7 x 7
};

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

void render_once(Way& way, caplet::Session& session, int samples, int most) {
  const auto begin = std::chrono::steady_clock::now();
  if (way.target)
    way.stated_noise.push_back(
        session.render_to({.noise = *way.target, .least_samples = 16, .most_samples = most}));
  else
    session.render(samples);
  way.seconds.push_back(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  const caplet::Film film = session.film();
  std::vector<float> values, variances;
  for (const char* color : colors) {
    const std::vector<float> value = film.values(color),
                             variance = film.values(std::string("variance.") + color);
    values.insert(values.end(), value.begin(), value.end());
    variances.insert(variances.end(), variance.begin(), variance.end());
  }
  const std::vector<float> alpha = film.values("A");
  way.seen.resize(alpha.size());
  for (std::size_t i = 0; i < alpha.size(); ++i)
    if (alpha[i] > 0 || variances[alpha.size() + i] > 0) ++way.seen[i];  // variance.G
  const std::vector<std::string> channels = film.channels();
  double mean_samples = film.samples_per_pixel();
  if (std::ranges::find(channels, "samples") != channels.end()) {
    mean_samples = 0;
    const std::vector<std::uint32_t> counts = film.ids("samples");
    for (const std::uint32_t count : counts) mean_samples += count;
    mean_samples /= static_cast<double>(counts.size());
  }
  way.samples.push_back(mean_samples);
  way.values.push_back(std::move(values));
  way.variances.push_back(std::move(variances));
}

/// The mean picture, and the true variance of one.
struct Truth {
  std::vector<double> mean, variance;
};

Truth truth_of(const std::vector<std::vector<float>>& values) {
  Truth out{std::vector<double>(values[0].size()), std::vector<double>(values[0].size())};
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values[0].size(); ++i) {
    double sum = 0, squares = 0;
    for (const auto& picture : values) sum += static_cast<double>(picture[i]);
    for (const auto& picture : values)
      squares += std::pow(static_cast<double>(picture[i]) - sum / n, 2);
    out.mean[i] = sum / n;
    out.variance[i] = squares / (n - 1);
  }
  return out;
}

std::vector<float> luminances(const std::vector<float>& values) {
  const std::size_t pixels = values.size() / 3;
  std::vector<float> out(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out[i] += static_cast<float>(luminance[c]) * values[c * pixels + i];
  return out;
}

/// The noise of one picture, by the variance of its luminance from seed to seed. `seen`: how often
/// each pixel counts, as those of a picture count that show something.
double true_noise(const Truth& of, const std::vector<double>& seen, int width) {
  const int height = static_cast<int>(of.mean.size()) / width;
  double all = 0, count = 0, sum = 0;
  for (std::size_t i = 0; i < of.mean.size(); ++i) {
    all += of.mean[i];
    count += seen[i];
  }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::size_t>(y * width + x);
      double around = 0, pixels = 0;
      for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u) {
          around += of.mean[static_cast<std::size_t>(v * width + u)];
          pixels += seen[static_cast<std::size_t>(v * width + u)];
        }
      const double scale = around / pixels + floor_share * all / count;
      if (pixels > 0 && scale > 0) sum += of.variance[at] / (scale * scale);
    }
  return std::sqrt(sum / count);
}

/// The mean of a picture's luminance over all seeds, and its standard error.
std::array<double, 2> picture_mean(const std::vector<std::vector<float>>& pictures) {
  std::vector<double> means;
  for (const auto& picture : pictures) {
    double sum = 0;
    for (const float value : picture) sum += static_cast<double>(value);
    means.push_back(sum / static_cast<double>(picture.size()));
  }
  const double mean = mean_of(means);
  double squares = 0;
  for (const double value : means) squares += (value - mean) * (value - mean);
  const auto n = static_cast<double>(means.size());
  return {mean, std::sqrt(squares / (n - 1) / n)};
}

struct Found {
  double held = 0, stated = 0, typical = 0, noise = 0;
  std::array<double, 2> mean{};
};

/// The median, over the pixels that vary, of stated over true variance, both summed over channels.
double median_ratio(const std::vector<double>& stated, const std::vector<double>& is) {
  std::vector<double> ratios;
  const std::size_t pixels = is.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double sum = is[i] + is[pixels + i] + is[2 * pixels + i];
    if (sum > 0) ratios.push_back((stated[i] + stated[pixels + i] + stated[2 * pixels + i]) / sum);
  }
  if (ratios.empty()) return 0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::ranges::nth_element(ratios, middle);
  return *middle;
}

Found found_of(const Way& way, int width) {
  Found out;
  const Truth truth = truth_of(way.values);
  const auto seeds = static_cast<double>(way.values.size());
  std::vector<double> stated_of(truth.mean.size());
  double held = 0, values = 0, true_sum = 0, stated_sum = 0;
  for (std::size_t seed = 0; seed < way.values.size(); ++seed)
    for (std::size_t i = 0; i < truth.mean.size(); ++i) {
      if (!(truth.variance[i] > 0)) continue;
      const auto value = static_cast<double>(way.values[seed][i]),
                 stated = static_cast<double>(way.variances[seed][i]);
      const double others = (truth.mean[i] * seeds - value) / (seeds - 1);
      held +=
          std::abs(value - others) <= 1.96 * std::sqrt(stated + truth.variance[i] / (seeds - 1));
      ++values;
      true_sum += truth.variance[i];
      stated_sum += stated;
      stated_of[i] += stated / seeds;
    }
  out.held = held / values;
  out.stated = stated_sum / true_sum;
  out.typical = median_ratio(stated_of, truth.variance);
  std::vector<std::vector<float>> pictures;
  for (const auto& picture : way.values) pictures.push_back(luminances(picture));
  std::vector<double> seen = way.seen;
  for (double& pixel : seen) pixel /= seeds;
  out.noise = true_noise(truth_of(pictures), seen, width);
  out.mean = picture_mean(pictures);
  return out;
}

struct Options {
  std::vector<std::string> scenes;
  int seeds = 200, width = 96, height = 54, samples = 64, most = 16384;
  std::vector<double> targets{0.05};
  double minutes = 60;
  std::string device;
};

void try_scene(const std::string& file, const Options& options, const caplet::Device& device) {
  const auto begin = std::chrono::steady_clock::now();
  const auto is_late = [&] {
    return std::chrono::steady_clock::now() - begin >
           std::chrono::duration<double>(60 * options.minutes);
  };
  caplet::Scene scene = caplet::import_scene(file);
  scene.set_size(options.width, options.height);
  // A render to a noise needs points that are even at any number of samples.
  scene.set_option(caplet::Statement::sampler, "sobol", {});
  scene.set_samples_per_pixel(options.samples);
  std::vector<Way> ways(1);
  for (const double target : options.targets) ways.push_back({.target = target});
  caplet::Session session(scene, device);
  int seeds = 0;
  for (; seeds < options.seeds && !is_late(); ++seeds)
    for (Way& way : ways) {
      scene.set_seed(static_cast<std::uint32_t>(seeds + 1));
      session.update(scene);
      session.begin_at(0);
      render_once(way, session, options.samples, options.most);
    }
  if (seeds < 2) throw std::runtime_error(file + ": no time for two seeds");
  const Found even = found_of(ways[0], options.width);
  for (const Way& way : ways) {
    const Found found = found_of(way, options.width);
    const double apart =
        way.target ? (found.mean[0] - even.mean[0]) / std::hypot(found.mean[1], even.mean[1]) : 0;
    fmt::print(
        "{{\"scene\":\"{}\",\"way\":\"{}\",\"seeds\":{},\"held\":{:.4f},\"stated\":{:.3f},"
        "\"typical\":{:.3f},"
        "\"noise\":{:.5f},\"stated_noise\":{:.5f},\"samples\":{:.1f},\"seconds\":{:.4f},"
        "\"apart\":{:.2f}}}\n",
        std::filesystem::path(file).filename().string(),
        way.target ? fmt::format("{}", *way.target) : "even", seeds, found.held, found.stated,
        found.typical, found.noise, mean_of(way.stated_noise), mean_of(way.samples),
        mean_of(way.seconds), apart);
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  CLI::App app{"Measures how true the stated noise is"};
  app.add_option("scenes", options.scenes, "scene files")->required();
  app.add_option("--seeds", options.seeds)->check(CLI::Range(2, 100000));
  app.add_option("--width", options.width)->check(CLI::Range(8, 4096));
  app.add_option("--height", options.height)->check(CLI::Range(8, 4096));
  app.add_option("--samples", options.samples, "of the even way")->check(CLI::Range(2, 1 << 20));
  app.add_option("--most", options.most, "samples of a pixel")->check(CLI::Range(16, 1 << 20));
  app.add_option("--noise", options.targets, "targets")->expected(0, 8);
  app.add_option("--minutes", options.minutes, "of a scene: seeds beyond it are left out");
  app.add_option("--device", options.device);
  CLI11_PARSE(app, argc, argv);
  const caplet::Device device = caplet::choose_device(options.device);
  for (const std::string& scene : options.scenes) try_scene(scene, options, device);
} catch (const std::exception& error) {
  fmt::print(stderr, "caplet_noise_trial: {}\n", error.what());
  return 1;
}
