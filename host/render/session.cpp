// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/session.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <utility>

#include "base/check.h"
#include "base/clock.h"
#include "base/log.h"
#include "render/detail/work_queue.h"
#include "render/detail/worker_pool.h"
#include "render/renderer.h"

namespace caplet {

DeviceWork work_of(const DeviceInfo& info) {
  DeviceWork out;
  out.name = info.name;
  out.driver = info.driver;
  out.platform = info.platform;
  return out;
}

struct Session::Worker {
  Worker(const Device& on, std::shared_ptr<DeviceScene> of_scene, const FlatView& of,
         const RendererOptions& options)
      : device(on), scene(std::move(of_scene)), view(of), renderer(*scene, view, options) {}
  DeviceWork work() const {
    DeviceWork out = work_of(device.info());
    out.paths_a_second = speed.paths_a_second();
    for (const Work& work : had) out.paths += work.paths();
    return out;
  }
  Device device;
  std::shared_ptr<DeviceScene> scene;
  FlatView view;
  Renderer renderer;
  Speed speed;
  std::vector<Work>
      had;  // what is in its film; unlike the renderer's own list, never changed while it hangs
};

namespace {

std::string text_of(const std::exception_ptr& failure, double patience) {
  try {
    if (failure) std::rethrow_exception(failure);
    return fmt::format("has given no answer for {:g} s", patience);
  } catch (const std::exception& error) {
    return fmt::format("has failed ({})", error.what());
  }
}

void warn_of_lost(const Device& device, const std::exception_ptr& failure, double patience) {
  log::warn("device {} '{}' {}: the others do its work again", device.info().index,
            device.info().name, text_of(failure, patience));
}

void warn_of_not_finite(std::uint64_t samples) {
  if (samples > 0) log::warn("{} samples were not finite and count as black", samples);
}

/// Adds work that is done to the list of it; parts of windows are joined where possible.
void add_work(std::vector<Work>& had, const Work& work) {
  if (!work.samples) {
    std::vector<FilmPart> parts;
    std::erase_if(had, [&](const Work& each) {
      if (!each.samples) parts.push_back(each.part);
      return !each.samples;
    });
    add_part(parts, work.part);
    for (const FilmPart& part : parts) had.push_back({part, nullptr});
  } else {
    had.push_back(work);
  }
}

StageSeconds& add(StageSeconds& to, const StageSeconds& more) {
  for (const auto& [stage, seconds] : more) {
    const auto there = std::ranges::find(to, stage, &StageSeconds::value_type::first);
    if (there == to.end())
      to.emplace_back(stage, seconds);
    else
      there->second += seconds;
  }
  return to;
}

}  // namespace

bool any_thread_given_up() { return WorkerPool::any_given_up(); }

namespace {
/// Ends a pass after the batch under way.
struct PassGivenUp {};
}  // namespace

/// Run is one task of all workers; workers that hang keep it alive.
struct Session::Run {
  Run(Workers of, WorkQueue of_picture)
      : workers(std::move(of)), shares(std::move(of_picture)), under_way(workers.size()) {}

  void tell(std::size_t member, double paths) {
    under_way[member] = paths;
    if (!progress || fatal || asked_paths == 0) return;
    double done = shares.paths_done();
    for (const double each : under_way) done += each;
    const double samples = std::clamp(shares.paths_done(), 0.0, asked_paths) / pixels;
    try {
      progress({static_cast<std::uint32_t>(samples), asked,
                std::clamp(done / asked_paths, 0.0, 1.0),
                done / std::max(1e-9, seconds_since(start))});
    } catch (...) {
      fatal = std::current_exception();
    }
  }

  Workers workers;
  WorkQueue shares;
  std::vector<double> under_way;  // paths of finished batches of unfinished parts
  double pixels = 1;
  std::uint32_t asked = 0;
  double asked_paths = 0;
  Clock::time_point start = Clock::now();
  std::function<void(const SessionProgress&)> progress;
  std::exception_ptr fatal;  // of the caller's function
  std::exception_ptr last_failure;
  Workers gone;
};

Session::Session(const FlatScene& scene, const FlatView& view, const std::vector<Device>& devices,
                 const SessionOptions& options)
    : Session(view, devices, options,
              [&](const Device& device) { return std::make_shared<DeviceScene>(device, scene); }) {}

Session::Session(FlatScene&& scene, const FlatView& view, const std::vector<Device>& devices,
                 const SessionOptions& options)
    : Session(view, devices, options, [&](const Device& device) {
        return &device == &devices.back() ? std::make_shared<DeviceScene>(device, std::move(scene))
                                          : std::make_shared<DeviceScene>(device, scene);
      }) {}

Session::Session(const FlatView& view, const std::vector<Device>& devices,
                 const SessionOptions& options,
                 const std::function<std::shared_ptr<DeviceScene>(const Device&)>& scene_for)
    : options_(options), first_(options.sample_begin), next_(options.sample_begin) {
  CHECK_LT_(std::size_t{0}, devices.size());
  RendererOptions each;
  each.layers = options.layers;
  each.batch_paths = options.batch_paths;
  if (options.most_samples > 0)
    each.most_paths = std::size_t{view.view.crop_width} * view.view.crop_height *
                      std::size_t{options.most_samples};
  std::exception_ptr failure;
  for (const Device& device : devices) try {
      workers_.push_back(std::make_shared<Worker>(device, scene_for(device), view, each));
      workers_.back()->scene->kernels().time_stages(options.time_stages);
    } catch (const RunError&) {
      if (failure || devices.size() > 1)
        warn_of_lost(device, std::current_exception(), options.patience);
      failure = std::current_exception();
      lost_.push_back(work_of(device.info()));
      lost_.back().lost = true;
    }
  if (workers_.empty()) std::rethrow_exception(failure);
}

Session::~Session() = default;

const Device& Session::device(std::size_t number) const { return workers_[number]->device; }
std::shared_ptr<DeviceScene> Session::scene_on(std::size_t device) const {
  return workers_[device]->scene;
}
FilmLayout Session::layout() const { return workers_.front()->renderer.layout(); }

std::vector<DeviceWork> Session::work() const {
  std::vector<DeviceWork> out;
  for (const auto& worker : workers_) out.push_back(worker->work());
  out.insert(out.end(), lost_.begin(), lost_.end());
  return out;
}

RayCounts Session::rays() const {
  RayCounts out;
  for (const auto& worker : workers_) {
    const RayCounts& its = worker->renderer.rays();
    out.camera += its.camera;
    out.bounce += its.bounce;
    out.shadow += its.shadow;
    out.not_finite += its.not_finite;
  }
  return out;
}

double Session::compile_seconds() const {
  double out = 0;
  for (const auto& worker : workers_) out += worker->scene->kernels().compile_seconds();
  return out;
}

StageSeconds Session::compile_seconds_by_stage() const {
  StageSeconds out;
  for (const auto& worker : workers_) add(out, worker->scene->kernels().compile_seconds_by_stage());
  return out;
}

StageSeconds Session::seconds_by_stage() const {
  StageSeconds out;
  for (const auto& worker : workers_) add(out, worker->scene->kernels().seconds_by_stage());
  return out;
}

void Session::clear() {
  for (const auto& worker : workers_) {
    worker->had.clear();
    worker->renderer.reset(worker->view);
  }
  before_.reset();
  again_.clear();
  has_lists_ = false;
  first_ = next_ = options_.sample_begin;
}

/// Leaves these workers out, except for the last one there is: its failure is thrown, and it may be
/// used again.
void Session::part_with(const Workers& gone, const std::exception_ptr& last_failure) {
  const std::shared_ptr<Worker> last =
      gone.size() == workers_.size() && !gone.empty() ? gone.back() : nullptr;
  for (const auto& worker : gone) {
    if (worker == last) continue;
    DeviceWork work = worker->work();
    work.paths = 0;
    work.lost = true;
    lost_.push_back(std::move(work));
    std::erase(workers_, worker);
  }
  if (!last) return;
  try {
    clear();
  } catch (const RunError&) {  // the first failure is the one to tell of
  }
  std::rethrow_exception(last_failure);
}

void Session::update(const FlatScene& scene, const SceneChanges& changes, const FlatView& view) {
  Workers gone;
  std::exception_ptr failure;
  for (const auto& worker : workers_) try {
      worker->scene->update(scene, changes);
      worker->view = view;
      worker->had.clear();
      worker->renderer.reset(view);
    } catch (const RunError&) {
      failure = std::current_exception();
      gone.push_back(worker);
      if (gone.size() < workers_.size()) warn_of_lost(worker->device, failure, options_.patience);
    }
  part_with(gone, failure);
  before_.reset();
  again_.clear();
  has_lists_ = false;
  first_ = next_ = options_.sample_begin;
}

void Session::begin_at(std::uint32_t sample) {
  options_.sample_begin = sample;
  clear();
}

void Session::resume(Film film) {
  if (!(film.layout() == layout()))
    throw InputError("the film is one of another picture, other layers or another scene");
  clear();
  for (const FilmPart& part : film.parts())
    next_ = std::max(next_, part.sample_begin + part.sample_count);
  first_ = next_;
  has_lists_ = !film.is_even();
  before_ = std::move(film);
}

std::uint32_t Session::render(std::uint32_t sample_count,
                              const std::function<void(const SessionProgress&)>& progress,
                              std::optional<double> time_limit) {
  sample_count = std::min(sample_count, std::numeric_limits<std::uint32_t>::max() - next_);
  if (sample_count > 0 && !is_even()) {
    const Film now = film();
    const std::uint32_t begin =
        now.parts().empty() ? options_.sample_begin : now.parts().front().sample_begin;
    return render({next_samples(now, begin, sample_count)}, progress, time_limit) ? sample_count
                                                                                  : 0;
  }
  const std::uint64_t not_finite = rays().not_finite;
  const std::uint32_t done = run({sample_count}, progress, time_limit)->shares.samples();
  *cancelled_ = false;
  warn_of_not_finite(rays().not_finite - not_finite);
  next_ += done;
  return done;
}

bool Session::render(std::vector<PixelSamples> samples,
                     const std::function<void(const SessionProgress&)>& progress,
                     std::optional<double> time_limit) {
  const std::uint64_t not_finite = rays().not_finite;
  std::uint32_t end = next_;
  for (const PixelSamples& each : samples)
    for (const PixelRecord& pixel : each.pixels)
      end = std::max(end, pixel.sample_begin + each.count);
  const auto done = run({0, std::move(samples)}, progress, time_limit);
  *cancelled_ = false;
  warn_of_not_finite(rays().not_finite - not_finite);
  next_ = end;
  has_lists_ = true;
  return done->shares.paths_done() == done->asked_paths;
}

std::shared_ptr<Session::Run> Session::run(
    Asked asked, const std::function<void(const SessionProgress&)>& progress,
    std::optional<double> time_limit) {
  const Window window = layout().window;
  const std::size_t pixels = std::max<std::size_t>(1, window.pixels());
  std::vector<WorkQueue::Worker> members;
  for (const auto& worker : workers_) {
    const std::size_t batch = worker->renderer.batch_paths(),
                      fill = std::max<std::size_t>(1, batch / pixels);
    const std::size_t most = options_.pass_samples > 0 ? options_.pass_samples
                             : workers_.size() > 1     ? batch
                                                       : fill;
    members.push_back({worker->speed, batch, static_cast<std::uint32_t>(std::min(most, batch))});
  }
  double asked_paths = static_cast<double>(pixels) * asked.samples;
  for (const PixelSamples& each : asked.lists)
    asked_paths += static_cast<double>(each.pixels.size()) * each.count;
  std::vector<Work> again = std::exchange(again_, {});
  auto run = std::make_shared<Run>(
      workers_, asked.lists.empty()
                    ? WorkQueue(window, next_, asked.samples, std::move(again), members)
                    : WorkQueue(std::move(asked.lists), std::move(again), members));
  run->pixels = static_cast<double>(pixels);
  run->asked = asked.samples;
  run->asked_paths = asked_paths;
  run->progress = progress;
  const auto beats = [run](std::size_t i) { return run->workers[i]->renderer.beats(); };
  const auto lost = [run, patience = options_.patience](std::size_t i,
                                                        const std::exception_ptr& failure) {
    run->shares.lose(i, run->workers[i]->had);
    run->under_way[i] = 0;
    run->gone.push_back(run->workers[i]);
    run->last_failure = failure;
    if (run->shares.workers_there() > 0) warn_of_lost(run->workers[i]->device, failure, patience);
  };
  const auto pool = std::make_shared<WorkerPool>(workers_.size(), WorkerPool::Calls{beats, lost});
  const std::weak_ptr<WorkerPool> weak = pool;
  pool->run(options_.patience, [run, weak, cancelled = cancelled_, time_limit](
                                   std::size_t i, WorkerPool::Lock& lock) {
    const std::shared_ptr<WorkerPool> pool_of = weak.lock();
    Worker& worker = *run->workers[i];
    while (!pool_of->gone(i) && !run->fatal) {
      const bool late =
          time_limit && run->shares.begun() && seconds_since(run->start) >= *time_limit;
      if (*cancelled || late) run->shares.close();
      const std::optional<Work> work = run->shares.take(i);
      if (!work) {
        if (run->shares.complete() || run->shares.workers_there() == 0) break;
        pool_of->wait(lock);
        continue;
      }
      const Clock::time_point start = Clock::now();
      const bool there = pool_of->attempt(i, lock, [&] {
        const std::uint32_t samples =
            work->samples ? work->samples->count : work->part.sample_count;
        const auto batch_done = [&](std::size_t pixels_done) {
          const WorkerPool::Lock telling(pool_of->mutex());
          if (!pool_of->gone(i)) run->tell(i, static_cast<double>(pixels_done) * samples);
          if (run->fatal) throw PassGivenUp();
        };
        try {
          if (work->samples)
            worker.renderer.pass(std::span(work->samples->pixels).subspan(work->first, work->count),
                                 samples, batch_done);
          else
            worker.renderer.pass(work->part.window, work->part.sample_begin, samples, batch_done);
        } catch (const PassGivenUp&) {  // the film is cleared below
        }
      });
      if (!there || run->fatal) break;
      run->shares.done(i, seconds_since(start));
      worker.speed = run->shares.speed(i);
      add_work(worker.had, *work);
      run->tell(i, 0);
      pool_of->notify();
    }
    pool_of->notify();
  });
  const WorkerPool::Lock lock(pool->mutex());
  run->progress = {};
  if (run->fatal) {
    const std::exception_ptr fatal = run->fatal;
    std::erase_if(workers_, [&](const auto& worker) {
      return std::ranges::find(run->gone, worker) != run->gone.end();
    });
    clear();
    std::rethrow_exception(fatal);
  }
  part_with(run->gone, run->last_failure);
  return run;
}

bool Session::read_films(const std::function<void(std::size_t, const DeviceFilm&)>& read) {
  const auto run = std::make_shared<Run>(workers_, WorkQueue(layout().window, next_, 0, {}, {}));
  const auto lost = [run, patience = options_.patience](std::size_t i,
                                                        const std::exception_ptr& failure) {
    run->gone.push_back(run->workers[i]);
    run->last_failure = failure;
    if (run->gone.size() < run->workers.size())
      warn_of_lost(run->workers[i]->device, failure, patience);
  };
  const auto pool = std::make_shared<WorkerPool>(
      workers_.size(), WorkerPool::Calls{[](std::size_t) { return 0; }, lost});
  const std::weak_ptr<WorkerPool> weak = pool;
  pool->run(options_.patience, [run, weak, read](std::size_t i, WorkerPool::Lock& lock) {
    weak.lock()->attempt(i, lock, [&] { read(i, run->workers[i]->renderer.film()); });
  });
  const WorkerPool::Lock lock(pool->mutex());
  for (const auto& worker : run->gone)
    again_.insert(again_.end(), worker->had.begin(), worker->had.end());
  part_with(run->gone, run->last_failure);
  return run->gone.empty();
}

/// Returns the sum of the workers' films; nothing when one of them could not be read.
std::optional<Film> Session::gather() {
  // A device that hangs and answers later still writes here.
  const auto films = std::make_shared<std::vector<std::optional<Film>>>(workers_.size());
  if (!read_films([films](std::size_t i, const DeviceFilm& film) { (*films)[i] = film.read(); }))
    return {};
  Film out = std::move(*films->front());
  for (std::size_t i = 1; i < films->size(); ++i) out.add(*(*films)[i]);
  // Whatever worker rendered what, it is all samples of the window, though its parts may not be
  // such that join.
  if (out.parts().size() < 2 && !has_lists_) return out;
  std::vector<FilmPart> parts;
  if (next_ > first_) parts.push_back({out.layout().window, first_, next_ - first_});
  return std::move(out).with_parts(std::move(parts));
}

Film Session::film() {
  std::optional<Film> film = gather();
  while (!film) {
    run({}, {}, {});
    film = gather();
  }
  if (before_) film->add(*before_);
  return std::move(*film);
}

void Session::look_at_film(const std::function<void(const Film& rows)>& look) {
  if (workers_.size() > 1 || before_) return look(film());
  const FilmLayout of = layout();
  const std::size_t row_bytes =
      of.words_per_pixel() * sizeof(std::uint64_t) * static_cast<std::size_t>(of.window.width);
  const int rows = static_cast<int>(std::clamp<std::size_t>(
      options_.look_bytes / std::max<std::size_t>(1, row_bytes), 1, 1 << 20));
  const auto read = [&](std::size_t, const DeviceFilm& film) {
    for (int row = 0; row < of.window.height; row += rows)
      look(film.read(row, std::min(rows, of.window.height - row)));
  };
  while (!read_films(read)) run({}, {}, {});
}

std::vector<FilmPart> Session::parts() const {
  std::vector<FilmPart> out = before_ ? before_->parts() : std::vector<FilmPart>();
  if (next_ > first_) add_part(out, {layout().window, first_, next_ - first_});
  return out;
}

std::optional<DeviceFilm> Session::film_on_device() const {
  if (workers_.size() > 1 || before_ || has_lists_ || !again_.empty()) return {};
  return workers_.front()->renderer.film();
}

}  // namespace caplet
