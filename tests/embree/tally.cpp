// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "tally.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace caplet::test {

void Errors::add(const Judgement& judgement, const CaseFacts& facts) {
  beyond_world += std::max(judgement.depth, judgement.off_surface) > facts.world_bound;
  switch (judgement.verdict) {
    case Verdict::right:
      break;
    case Verdict::touching:
      ++touching;
      break;
    case Verdict::missed:
      ++missed;
      missed_deep += judgement.depth > 0.01 * facts.size;
      missed_along += facts.along_axis;
      break;
    case Verdict::false_hit:
      ++false_hits;
      break;
    case Verdict::displaced:
      ++displaced;
      off_1e2 += judgement.off_surface > 0.01 * facts.size;
      t_beyond_1e3 += judgement.t_error > 1e-3;
      later += judgement.later;
      grazing += judgement.grazing;
      t_beyond_1e2 += judgement.t_error > 1e-2;
  }
}

double Tally::error_of(const Judgement& judgement, double size) {
  return (judgement.verdict == Verdict::displaced ? judgement.off_surface : judgement.depth) / size;
}

std::string Tally::text_of(const Judgement& judgement, double size) {
  switch (judgement.verdict) {
    case Verdict::missed:
      return fmt::format("missed, entered {:.3g} radii deep", judgement.depth / size);
    case Verdict::false_hit:
      return fmt::format("hit falsely, passed {:.3g} radii away", judgement.depth / size);
    default:
      return fmt::format("displaced, {:.3g} radii off the surface, t off by {:.3g} of itself",
                         judgement.off_surface / size, judgement.t_error);
  }
}

void Tally::report(const Judgement& judgement, double size, const std::string& where) {
  ADD_FAILURE() << "ours: " << text_of(judgement, size) << "\n" << where;
}

void Tally::print(const std::string& name) const {
  fmt::print("{}: {} rays, {} hits ({} along axis), {} left out\n", name, rays, hits, hits_along,
             left_out);
  const auto row = [&](const char* side, const Errors& e) {
    fmt::print(
        "  {:<6} | missed {} (> 1 % deep {}, along axis {}) | false {} | displaced {} (> 1 % off "
        "{}, t > 1e-3 {}, t > 1e-2 {}, "
        "later {}, grazing {}) "
        "| beyond the world bound {} | touching {}\n",
        side, e.missed, e.missed_deep, e.missed_along, e.false_hits, e.displaced, e.off_1e2,
        e.t_beyond_1e3, e.t_beyond_1e2, e.later, e.grazing, e.beyond_world, e.touching);
  };
  row("ours", our_errors);
  row("Embree", embree_errors);
  for (const Worst& worst : worst_)
    if (!worst.text.empty()) fmt::print("  Embree: {}\n", worst.text);
  std::fflush(stdout);
}

std::string described(const RayRecord& r) {
  return fmt::format("ray: {:.9g} {:.9g} {:.9g}  {:.9g} {:.9g} {:.9g}", r.ox, r.oy, r.oz, r.dx,
                     r.dy, r.dz);
}

std::string described(const FlatPrimitive& p, const RayRecord& r) {
  std::string out = fmt::format("shape {}:", p.shape);
  for (int i = 0; i < length_count(p); ++i) out += fmt::format(" {:.9g}", p.data[i]);
  return out + "\n  " + described(r);
}

}  // namespace caplet::test
