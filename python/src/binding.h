// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The files of the binding share these. Arrays come as the package's Python has checked them: of
// 32- or 64-bit floats or of 32-bit unsigned integers, with any strides; what they hold is for the
// library to check.
#pragma once

#include <caplet/error.h>
#include <caplet/scene.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "threads.h"

namespace caplet_python {

using Array = nb::ndarray<nb::ro, nb::device::cpu>;

void bind_errors(nb::module_& m);
void bind_scene(nb::module_& m);
void bind_render(nb::module_& m);
void bind_trace(nb::module_& m);
void bind_batch(nb::module_& m);

/// bool, numbers, text, arrays of 64-bit floats, lists of texts, and tuples of a word and numbers:
/// ("texture", 3),
/// ("materials", 0, 1), ("blackbody", 5000.0), ("rgb", r, g, b), ("pixels", array).
caplet::Parameters parameters_of(const nb::dict& given);

/// Rows of three 64-bit floats, four each.
caplet::Transform transform_of(const Array& rows);

/// read(i, k) -> element k of row i, whatever the array's strides.
template <class From, class Use>
void with_rows(const Array& array, Use&& use) {
  const auto* data = static_cast<const From*>(array.data());
  const std::int64_t row = array.ndim() > 0 ? array.stride(0) : 0,
                     column = array.ndim() > 1 ? array.stride(1) : 0;
  use([=](std::size_t i, std::size_t k) {
    return data[static_cast<std::int64_t>(i) * row + static_cast<std::int64_t>(k) * column];
  });
}

template <class Use>
void with_floats(const Array& array, Use&& use) {
  if (array.dtype() == nb::dtype<float>()) return with_rows<float>(array, use);
  if (array.dtype() == nb::dtype<double>()) return with_rows<double>(array, use);
  throw nb::type_error("an array of 32- or 64-bit floats");
}

/// `count` rows of K numbers as floats. A first dimension of 1 is repeated.
template <std::size_t K>
std::vector<std::array<float, K>> rows_of(const Array& array, std::size_t count) {
  if (array.ndim() != 2 || array.shape(1) != K || (array.shape(0) != count && array.shape(0) != 1))
    throw nb::value_error("an array of another shape");
  std::vector<std::array<float, K>> out(count);
  const std::size_t step = array.shape(0) == 1 ? 0 : 1;
  with_floats(array, [&](auto read) {
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < K; ++k) out[i][k] = static_cast<float>(read(i * step, k));
  });
  return out;
}

std::vector<float> floats_of(const Array& array, std::size_t count);
std::vector<std::uint32_t> numbers_of(const Array& array);

/// An array that owns the vector.
template <class T, std::size_t N>
nb::ndarray<nb::numpy, T, nb::ndim<N>> array_of(std::vector<T> values,
                                                const std::array<std::size_t, N>& shape) {
  auto* held = new std::vector<T>(std::move(values));
  nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::ndarray<nb::numpy, T, nb::ndim<N>>(held->data(), N, shape.data(), owner);
}

/// A scene, and whose turn it is with it.
struct HeldScene {
  HeldScene() = default;
  explicit HeldScene(caplet::Scene of) : scene(std::move(of)) {}
  HeldScene(HeldScene&& other) noexcept : scene(std::move(other.scene)) {}
  /// As it is now, for other threads.
  caplet::Scene now() {
    const Turn turn(lock);
    return scene;
  }
  caplet::Scene scene;
  Lock lock;
};

}  // namespace caplet_python
