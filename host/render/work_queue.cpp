// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/work_queue.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace caplet {

namespace {

// Camera rays are numbered in tiles of 8 x 8 pixels (kernels/stages/path.cl).
constexpr int tile_rows = 8;

std::uint32_t end_of(const FilmPart& part) { return part.sample_begin + part.sample_count; }

}  // namespace

double Work::paths() const {
  return samples ? static_cast<double>(count) * samples->count
                 : static_cast<double>(part.window.pixels()) * part.sample_count;
}

void Speed::measured(double paths, double seconds) {
  paths_ = 0.5 * paths_ + paths;
  seconds_ = 0.5 * seconds_ + seconds;
}

double part_paths(double open, double speed, double all_speed) {
  return std::clamp(0.5 * open * speed / all_speed, least_part_seconds * speed,
                    most_part_seconds * speed);
}

FilmPart cut_part(const FilmPart& from, double paths, std::uint32_t most_samples,
                  std::vector<FilmPart>& rest) {
  FilmPart part = from;
  const auto pixels = static_cast<double>(from.window.pixels());
  const double samples =
      std::min(paths / pixels, static_cast<double>(std::min(most_samples, from.sample_count)));
  if (samples >= 1) {
    part.sample_count = static_cast<std::uint32_t>(samples);
  } else {
    part.sample_count = 1;
    int rows = std::max(1, static_cast<int>(paths / from.window.width));
    if (rows >= tile_rows) rows -= rows % tile_rows;
    part.window.height = std::min(rows, from.window.height);
  }
  if (part.window.height < from.window.height) {
    FilmPart below = from;
    below.window.y += part.window.height;
    below.window.height -= part.window.height;
    below.sample_count = part.sample_count;
    rest.push_back(below);
  }
  if (part.sample_count < from.sample_count) {
    FilmPart later = from;
    later.sample_begin += part.sample_count;
    later.sample_count -= part.sample_count;
    rest.push_back(later);
  }
  return part;
}

Work cut_work(const Work& from, double paths, std::uint32_t most_samples, std::vector<Work>& rest) {
  Work out = from;
  if (from.samples) {
    const double pixels = std::max(1.0, paths / from.samples->count);
    if (pixels >= static_cast<double>(from.count)) return out;
    out.count = static_cast<std::size_t>(pixels);
    const auto of = std::span(from.samples->pixels).subspan(from.first, from.count);
    while (out.count < from.count && is_same_pixel(of[out.count - 1], of[out.count])) ++out.count;
    if (out.count == from.count) return out;
    Work other = from;
    other.first += out.count;
    other.count -= out.count;
    rest.push_back(std::move(other));
    return out;
  }
  std::vector<FilmPart> parts;
  out.part = cut_part(from.part, paths, most_samples, parts);
  for (const FilmPart& part : parts) {
    rest.push_back(from);
    rest.back().part = part;
  }
  return out;
}

WorkQueue::WorkQueue(const Window& window, std::uint32_t begin, std::uint32_t count,
                     std::vector<Work> again, std::vector<Worker> workers)
    : begin_(begin), end_(begin + count), begun_end_(begin), workers_(std::move(workers)) {
  open_again(std::move(again));
  if (count > 0) open_.push_back({{window, begin, count}, nullptr});
}

WorkQueue::WorkQueue(std::vector<PixelSamples> samples, std::vector<Work> again,
                     std::vector<Worker> workers)
    : begin_(std::numeric_limits<std::uint32_t>::max()),  // no sample of the window is new
      end_(begin_),
      begun_end_(begin_),
      workers_(std::move(workers)) {
  open_again(std::move(again));
  for (PixelSamples& each : samples) {
    const std::size_t count = each.pixels.size();
    lists_.push_back(std::make_shared<const PixelSamples>(std::move(each)));
    open_.push_back({{}, lists_.back(), 0, count});
  }
}

std::optional<Work> WorkQueue::take(std::size_t worker) {
  Worker& to = workers_[worker];
  if (open_.empty() || !to.there) return {};
  const Work from = open_.front();
  double paths = from.paths();
  if (workers_.size() > 1) {
    double known = 0, there = 0, fastest = 0;
    for (const Worker& each : workers_)
      if (each.there && each.speed.paths_a_second() > 0) {
        known += each.speed.paths_a_second();
        fastest = std::max(fastest, each.speed.paths_a_second());
        ++there;
      }
    const double speed = to.speed.paths_a_second();
    if (speed > 0) {
      // Workers whose speed is not known count as the mean of the others.
      const double all = known / there * static_cast<double>(workers_there());
      paths = part_paths(open_paths(), speed, all);
      // A worker gets nothing if it is so slow that the others would finish before it had one row.
      const double least = from.samples ? 1 : from.part.window.width;
      if (speed < fastest && least / speed > open_paths() / (known - speed) + least_part_seconds)
        return {};
    } else {
      paths = std::min(static_cast<double>(to.batch_paths),
                       0.5 * open_paths() / static_cast<double>(workers_there()));
    }
  }
  // A list, of few samples a pixel or many, is stopped only between parts.
  if (from.samples) paths = std::min(paths, static_cast<double>(to.batch_paths));
  std::vector<Work> rest;
  const Work work = cut_work(from, paths, to.most_samples, rest);
  open_.pop_front();
  open_.insert(open_.begin(), rest.begin(), rest.end());
  if (work.samples)
    list_begun_ |= !work.again;
  else
    begun_end_ = std::max(begun_end_, std::min(end_of(work.part), end_));
  to.under_way = work;
  return work;
}

void WorkQueue::done(std::size_t worker, double seconds) {
  Worker& by = workers_[worker];
  by.speed.measured(by.under_way->paths(), seconds);
  paths_done_ += new_paths(*by.under_way);
  by.under_way.reset();
}

void WorkQueue::lose(std::size_t worker, std::span<const Work> had) {
  Worker& lost = workers_[worker];
  lost.there = false;
  for (const Work& work : had) paths_done_ -= new_paths(work);
  open_.insert(open_.begin(), had.begin(), had.end());
  for (std::size_t i = 0; i < had.size(); ++i) open_[i].again = true;
  if (lost.under_way) open_.push_front(*lost.under_way);
  lost.under_way.reset();
  std::ranges::stable_sort(open_, {}, [](const Work& work) { return work.part.sample_begin; });
}

void WorkQueue::close() {
  end_ = begun_end_;
  std::deque<Work> left;
  for (Work& work : open_) {
    if (!work.again && (work.samples || work.part.sample_begin >= end_)) continue;
    if (!work.again)
      work.part.sample_count = std::min(work.part.sample_count, end_ - work.part.sample_begin);
    left.push_back(std::move(work));
  }
  open_ = std::move(left);
}

bool WorkQueue::complete() const {
  return open_.empty() && std::ranges::none_of(workers_, [](const Worker& each) {
           return each.under_way.has_value();
         });
}

std::size_t WorkQueue::workers_there() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(workers_, [](const Worker& each) { return each.there; }));
}

double WorkQueue::open_paths() const {
  return std::accumulate(open_.begin(), open_.end(), 0.0,
                         [](double sum, const Work& work) { return sum + work.paths(); });
}

double WorkQueue::new_paths(const Work& work) const {
  if (work.samples)
    return std::ranges::find(lists_, work.samples) == lists_.end() ? 0 : work.paths();
  const FilmPart& part = work.part;
  const std::uint32_t end = end_of(part),
                      first = std::min(end, std::max(part.sample_begin, begin_));
  return static_cast<double>(part.window.pixels()) * (end - first);
}

void WorkQueue::open_again(std::vector<Work> again) {
  for (Work& work : again) {
    work.again = true;
    open_.push_back(std::move(work));
  }
}

}  // namespace caplet
