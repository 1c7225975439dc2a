// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Adds and removes things. A rearrangement changes the scene as a whole, and returns the one that
// undoes it.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "view/hidden.h"

namespace caplet::view {

/// Things, with their present or future indices among their kind, in ascending order.
struct Things {
  std::vector<std::pair<std::size_t, Shape>> shapes;
  std::vector<std::pair<std::size_t, Instance>> instances;
};

template <class T>
void put(std::vector<T>& into, std::vector<std::pair<std::size_t, T>>& from) {
  std::vector<T> out;
  out.reserve(into.size() + from.size());
  auto next = from.begin();
  for (T& each : into) {
    while (next != from.end() && next->first == out.size())
      out.push_back(std::move((next++)->second));
    out.push_back(std::move(each));
  }
  while (next != from.end()) out.push_back(std::move((next++)->second));
  into = std::move(out);
}

template <class T>
void take_out(std::vector<T>& of, const std::vector<std::size_t>& places,
              std::vector<std::pair<std::size_t, T>>& to) {
  std::vector<T> rest;
  rest.reserve(of.size() - places.size());
  auto next = places.begin();
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (next != places.end() && *next == i) {
      to.emplace_back(i, std::move(of[i]));
      ++next;
    } else {
      rest.push_back(std::move(of[i]));
    }
  }
  of = std::move(rest);
}

/// Converts indices among shown things to indices among all, including hidden ones; both ascend.
template <class T>
std::vector<std::size_t> places_in_whole(const HiddenList<T>& hidden,
                                         std::vector<std::size_t> places) {
  std::size_t before = 0;
  for (std::size_t& place : places) {
    while (before < hidden.size() && hidden[before].first <= place + before) ++before;
    place += before;
  }
  return places;
}

/// Adjusts the indices of hidden things when shown ones are removed.
template <class T>
void close_gaps(HiddenList<T>& hidden, const std::vector<std::size_t>& places) {
  const std::vector<std::size_t> gone = places_in_whole(hidden, places);
  std::size_t before = 0;
  for (auto& [place, thing] : hidden) {
    while (before < gone.size() && gone[before] < place) ++before;
    place -= before;
  }
}

// Each of these rearrangements returns the one that undoes it.
template <class Rearrange>
Rearrange removal(std::vector<std::size_t> shapes, std::vector<std::size_t> instances);

template <class Rearrange>
Rearrange addition(std::shared_ptr<const Things> things) {
  return {[things = std::move(things)](Scene& scene, HiddenPointer&) {
    Things copy = *things;
    std::vector<std::size_t> shapes, instances;
    for (const auto& [place, shape] : copy.shapes) shapes.push_back(place);
    for (const auto& [place, instance] : copy.instances) instances.push_back(place);
    put(scene.shapes, copy.shapes);
    put(scene.instances, copy.instances);
    return removal<Rearrange>(std::move(shapes), std::move(instances));
  }};
}

template <class Rearrange>
Rearrange removal(std::vector<std::size_t> shapes, std::vector<std::size_t> instances) {
  return {[shapes = std::move(shapes), instances = std::move(instances)](Scene& scene,
                                                                         HiddenPointer& hidden) {
    auto things = std::make_shared<Things>();
    take_out(scene.shapes, shapes, things->shapes);
    take_out(scene.instances, instances, things->instances);
    if (!hidden->empty()) {
      auto now = std::make_shared<Hidden>(*hidden);
      close_gaps(now->shapes, shapes);
      close_gaps(now->instances, instances);
      hidden = std::move(now);
    }
    return addition<Rearrange>(std::move(things));
  }};
}

}  // namespace caplet::view
