// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/linked_capsules.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>

#include "base/check.h"
#include "base/memory.h"
#include "lower/detail/floats.h"
#include "lower/detail/shapes.h"

namespace caplet {

namespace {

static_assert(CAPLET_LINK_R + CAPLET_WIDTH < CAPLET_LINK_U &&
              CAPLET_LINK_U <= 8 * CAPLET_LINK_ROWS &&
              CAPLET_LINK_U + CAPLET_WIDTH < 8 * (CAPLET_LINK_ROWS + 1));

/// One end of a linked capsule: its centre and radius.
using LinkedEnd = std::array<float, 4>;

bool can_link(const FlatPrimitive& p) {
  return p.shape == shape_capsule || p.shape == shape_tapered_capsule;
}

LinkedEnd end_of(const FlatPrimitive& p, bool second) {
  if (p.shape == shape_capsule) {
    const float* at = second ? capsule_p1(p.data) : capsule_p0(p.data);
    return {at[0], at[1], at[2], capsule_r(p.data)};
  }
  const float* at = second ? tapered_capsule_p1(p.data) : tapered_capsule_p0(p.data);
  return {at[0], at[1], at[2], second ? tapered_capsule_r1(p.data) : tapered_capsule_r0(p.data)};
}

}  // namespace

PlacedCapsules::PlacedCapsules(const CapsulesShape& shape, const glm::dmat4& m, double scale)
    : shape_(&shape), scale_(scale) {
  if (m != glm::dmat4(1)) m_ = m;
}

FlatPrimitive PlacedCapsules::operator[](std::size_t i) const {
  return flat_capsule(*shape_, i, m_ ? &*m_ : nullptr, scale_);
}

void PlacedCapsules::release(std::size_t first, std::size_t end) const {
  const auto give_back = [&](const auto& values) {
    if (!values.empty()) release_pages(&values[first], (end - first) * sizeof values[0]);
  };
  give_back(shape_->p0);
  give_back(shape_->p1);
  give_back(shape_->radius0);
  give_back(shape_->radius1);
  give_back(shape_->u);
  give_back(shape_->materials);
}

std::vector<CapsuleRow> rows_of(const PlacedCapsules& capsules, std::size_t least_count) {
  std::vector<CapsuleRow> out;
  std::uint32_t first = 0, count = 0;
  const auto end_row = [&] {
    if (count > 0 && count >= least_count) out.push_back({first, count});
    count = 0;
  };
  FlatPrimitive before{};
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    const FlatPrimitive next = capsules[i];
    const bool goes_on = count > 0 && can_link(next) &&
                         end_of(before, true) == end_of(next, false) &&
                         (!capsules.is_chain() || capsules.u(i - 1).y == capsules.u(i).x);
    if (!goes_on) end_row();
    if (!can_link(next)) continue;
    if (count == 0) first = narrow<std::uint32_t>(i);
    ++count;
    before = next;
  }
  end_row();
  return out;
}

void LooseCapsules::add(const PlacedCapsules& shape, std::uint32_t id,
                        std::span<const std::uint64_t> counts) {
  shapes_.push_back({shape, id, size_});
  for (std::size_t kind = 0; kind < counts_.size(); ++kind) counts_[kind] += counts[kind];
  size_ += shape.size();
}

FlatPrimitive LooseCapsules::operator[](std::size_t i) const {
  const auto after = std::ranges::upper_bound(shapes_, i, {}, &Placed::first);
  const Placed& of = *std::prev(after);
  FlatPrimitive p = of.capsules[i - of.first];
  p.id = narrow<std::uint32_t>(of.id + (i - of.first));
  return p;
}

void LinkedCapsules::add_row(const CapsuleRow& row) {
  rows_.push_back({narrow<std::uint32_t>(shapes_.size() - 1),
                   narrow<std::uint32_t>(row_of_block_.size()), row});
  row_of_block_.insert(row_of_block_.end(), (row.count + CAPLET_WIDTH - 1) / CAPLET_WIDTH,
                       narrow<std::uint32_t>(rows_.size() - 1));
  size_ += row.count;
}

LinkedCapsules::Block LinkedCapsules::block(std::size_t number) const {
  const Row& row = rows_[row_of_block_[number]];
  const std::size_t count = row.capsules.count, at = number - row.first_block,
                    blocks = (count + CAPLET_WIDTH - 1) / CAPLET_WIDTH;
  return {row.shape, row.capsules.first + count * at / blocks,
          row.capsules.first + count * (at + 1) / blocks};
}

ReferenceBox LinkedCapsules::box(const Block& block) const {
  ReferenceBox out{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (std::size_t i = block.first; i < block.end; ++i) {
    const ReferenceBox box = reference_box(shapes_[block.shape].capsules[i]);
    for (int k = 0; k < 3; ++k) {
      out.min[k] = std::min(out.min[k], box.min[k]);
      out.max[k] = std::max(out.max[k], box.max[k]);
    }
  }
  return out;
}

void LinkedCapsules::write(const Block& block, float* to) const {
  const auto& [capsules, id] = shapes_[block.shape];
  std::fill_n(to, std::size_t{8} * rows_per_block_, 0.f);
  to[0] = std::bit_cast<float>(narrow<std::uint32_t>(id + block.first));
  to[1] = std::bit_cast<float>(narrow<std::uint32_t>(block.end - block.first));
  const std::size_t last = block.end - block.first;
  for (std::size_t i = 0; i <= CAPLET_WIDTH; ++i) {
    // Lanes without a capsule go back and forth along the last one, so that no arithmetic meets odd
    // values there.
    const std::size_t at = i <= last ? i : last - (i - last) % 2;
    const bool second = at == last;
    const std::size_t capsule = block.first + at - (second ? 1 : 0);
    const LinkedEnd end = end_of(capsules[capsule], second);
    to[CAPLET_LINK_X + i] = end[0];
    to[CAPLET_LINK_Y + i] = end[1];
    to[CAPLET_LINK_Z + i] = end[2];
    to[CAPLET_LINK_R + i] = end[3];
    if (capsules.is_chain())
      to[CAPLET_LINK_U + i] = second ? capsules.u(capsule).y : capsules.u(capsule).x;
  }
}

void LinkedCapsules::append(
    std::vector<float>& leaves,
    const std::function<void(std::size_t block, const ReferenceBox&)>& set_box,
    bool release) const {
  // So many blocks are written before the memory of their capsules is given back.
  constexpr std::size_t batch = std::size_t{1} << 16;
  const std::size_t floats = std::size_t{8} * rows_per_block_;
  std::size_t shape = 0, released = 0;  // up to here
  for (std::size_t begin = 0; begin < blocks(); begin += batch) {
    const std::size_t end = std::min(begin + batch, blocks()), at = leaves.size();
    leaves.resize(at + (end - begin) * floats);
    tbb::parallel_for(begin, end, [&](std::size_t i) {
      const Block one = block(i);
      write(one, leaves.data() + at + (i - begin) * floats);
      set_box(i, box(one));
    });
    if (!release) continue;
    const Block last = block(end - 1);
    for (; shape < last.shape; ++shape, released = 0)
      shapes_[shape].capsules.release(released, shapes_[shape].capsules.size());
    shapes_[shape].capsules.release(released, last.end);
    released = last.end;
  }
}

}  // namespace caplet
