// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One picture by a device, by each of the parts that it is divided into, and by all of them
// together: samples of all pixels a second, alternating, medians; and what the parts together reach
// of the sum of the parts, and of the whole.
//
// usage: caplet_bench_devices SCENE [SAMPLES [PARTS [DEVICE]]]
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/clock.h"
#include "film/image.h"
#include "import/import.h"
#include "lower/lower.h"
#include "render/session.h"

namespace caplet {
namespace {

constexpr int times = 5;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

double processor_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Samples of all pixels a second, and processors that were busy: once to warm up, then the session
/// goes on.
class Contender {
 public:
  Contender(const FlatScene& flat, const FlatView& view, const std::vector<Device>& devices,
            std::uint32_t samples)
      : session_(flat, view, devices, {}), samples_(samples) {
    session_.render(samples);
  }
  void go_on() {
    Stopwatch watch;
    const double before = processor_seconds();
    session_.render(samples_);
    const double seconds = watch.lap();
    speeds_.push_back(samples_ / seconds);
    busy_.push_back((processor_seconds() - before) / seconds);
  }
  double speed() const { return median(speeds_); }
  double busy() const { return median(busy_); }

 private:
  Session session_;
  std::uint32_t samples_;
  std::vector<double> speeds_, busy_;
};

void run(const std::string& path, std::uint32_t samples, std::size_t parts,
         const std::string& choice) {
  const Scene scene = import_scene(path, FileImageReader());
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  const Device whole = Device::choose(choice);
  const std::vector<Device> divided = whole.split(parts);
  std::vector<std::unique_ptr<Contender>> contenders;
  contenders.push_back(std::make_unique<Contender>(flat, view, std::vector{whole}, samples));
  contenders.push_back(std::make_unique<Contender>(flat, view, divided, samples));
  for (const Device& part : divided)
    contenders.push_back(std::make_unique<Contender>(flat, view, std::vector{part}, samples));
  for (int i = 0; i < times; ++i)
    for (const auto& contender : contenders) contender->go_on();
  double sum = 0;
  for (std::size_t i = 2; i < contenders.size(); ++i) sum += contenders[i]->speed();
  const double all = contenders[0]->speed(), together = contenders[1]->speed();
  fmt::print(
      "{}, samples of {} x {} pixels a second: the device {:.2f}, its {} parts together {:.2f}, "
      "the sum of each alone {:.2f}; "
      "together {:.3f} of the sum, {:.3f} of the device; processors busy: {:.2f} by the device, "
      "{:.2f} by the parts together\n",
      path, scene.view.film.width, scene.view.film.height, all, parts, together, sum,
      together / sum, together / all, contenders[0]->busy(), contenders[1]->busy());
}

}  // namespace
}  // namespace caplet

int main(int argc, char** argv) {
  try {
    if (argc < 2)
      throw std::runtime_error("usage: caplet_bench_devices SCENE [SAMPLES [PARTS [DEVICE]]]");
    const auto number = [&](int i, unsigned long otherwise) {
      return argc > i ? std::strtoul(argv[i], nullptr, 10) : otherwise;
    };
    caplet::run(argv[1], static_cast<std::uint32_t>(number(2, 8)), number(3, 2),
                argc > 4 ? argv[4] : "cpu");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
