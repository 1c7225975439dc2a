// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/verify_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/summary.h"

namespace caplet::report {

namespace {

using Json = nlohmann::ordered_json;
using verify::DeviceReport;
using verify::KindStatistics;
using verify::Report;
using verify::Statistics;

/// JSON has no infinity.
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(1e308); }

Json to_json(const verify::Distribution& d) {
  return {{"median", number(d.percentile(0.5))},
          {"p99", number(d.percentile(0.99))},
          {"worst", number(d.worst())}};
}

Json to_json(const KindStatistics& kind) {
  Json out = {{"rays", kind.rays},
              {"hits", kind.hits},
              {"disagreements", kind.disagreements},
              {"grazing", kind.grazed},
              {"worst", number(kind.worst())}};
  for (std::size_t q = 0; q < verify::quantity_names.size(); ++q)
    out[verify::quantity_names[q]] = {{"bounds", to_json(kind.quantities[q].in_bounds)},
                                      {"ulps", to_json(kind.quantities[q].in_ulps)}};
  return out;
}

void add_statistics(Json& out, const Statistics& s) {
  out["hits"] = s.hits;
  out["worst"] = number(s.worst());
  Json faults = Json::object(), families = Json::object(), kinds = Json::object();
  for (std::size_t i = 0; i < s.faults.size(); ++i)
    if (s.faults[i] > 0) faults[verify::fault_names[i]] = s.faults[i];
  for (std::size_t i = 0; i < s.family_rays.size(); ++i)
    families[verify::family_names[i]] = {{"rays", s.family_rays[i]},
                                         {"disagreements", s.family_disagreements[i]}};
  for (std::size_t i = 0; i < s.kinds.size(); ++i)
    if (s.kinds[i].rays > 0) kinds[reference::kind_names[i]] = to_json(s.kinds[i]);
  out["faults"] = faults;
  out["families"] = families;
  out["kinds"] = kinds;
}

std::string device_label(const DeviceInfo& info) {
  return fmt::format("{}  {} ({}, driver {})", info.index, info.name, info.platform, info.driver);
}

std::string table_of(const Statistics& s) {
  std::string out = fmt::format("{:<16}{:>11}{:>11}{:>9}{:>9} |", "kind", "rays", "crossings",
                                "grazing", "disagree");
  for (const char* name : verify::quantity_names)
    out += fmt::format(" {:>7}{:>8}{:>9} |", name, "99 %", "worst");
  out += "\n";
  for (std::size_t i = 0; i < s.kinds.size(); ++i) {
    const KindStatistics& k = s.kinds[i];
    if (k.rays == 0) continue;
    out += fmt::format("{:<16}{:>11}{:>11}{:>9}{:>9} |", reference::kind_names[i], k.rays, k.hits,
                       k.grazed, k.disagreements);
    for (const auto& q : k.quantities)
      out += fmt::format(" {:>7.3f}{:>8.3f}{:>9.3f} |", q.in_bounds.percentile(0.5),
                         q.in_bounds.percentile(0.99), q.in_bounds.worst());
    out += "\n";
    out += fmt::format("{:>56} |", "ulps");
    for (const auto& q : k.quantities)
      out += fmt::format(" {:>7.2g}{:>8.2g}{:>9.2g} |", q.in_ulps.percentile(0.5),
                         q.in_ulps.percentile(0.99), q.in_ulps.worst());
    out += "\n";
  }
  return out;
}

constexpr const char* nothing_to_verify = "nothing to verify: the scene has no shapes";

std::string verdict_of(const DeviceReport& device) {
  const Statistics& s = device.statistics;
  if (s.disagreements == 0)
    return fmt::format("agrees: no disagreement in {} rays, {:.3f} of the bounds at worst\n",
                       s.rays, s.worst());
  std::string out = fmt::format("DISAGREES: {} of {} rays:", s.disagreements, s.rays);
  for (std::size_t i = 0; i < s.faults.size(); ++i)
    if (s.faults[i] > 0) out += fmt::format(" {} {}", verify::fault_names[i], s.faults[i]);
  if (!device.failures.empty()) {
    const verify::Failure& first = device.failures.front();
    const RayRecord& r = first.ray;
    out += fmt::format("\nfirst      {} ray {:a} {:a} {:a}  {:a} {:a} {:a}: {}", first.family, r.ox,
                       r.oy, r.oz, r.dx, r.dy, r.dz, first.disagreements.front().text);
  }
  return out + "\n";
}

}  // namespace

std::string plain_text(const Report& report, const std::string& scene) {
  std::string out = fmt::format("scene      {}\n", scene);
  if (report.is_empty) return out + fmt::format("verdict    {}\n", nothing_to_verify);
  for (const DeviceReport& device : report.devices) {
    const Statistics& s = device.statistics;
    out += fmt::format(
        "device     {}\nrays       {}, of which {} hit something; {:.1f} s on the device\n\n",
        device_label(device.info), s.rays, s.hits, device.seconds);
    out += table_of(s) + "\n";
  }
  if (report.devices.size() > 1) {
    out += fmt::format("{:<40}{:>12}{:>12}{:>12}{:>10}{:>10}\n", "device", "rays", "hits",
                       "disagree", "worst", "seconds");
    for (const DeviceReport& d : report.devices)
      out += fmt::format("{:<40}{:>12}{:>12}{:>12}{:>10.3f}{:>10.1f}\n",
                         fmt::format("{}  {:.34}", d.info.index, d.info.name), d.statistics.rays,
                         d.statistics.hits, d.statistics.disagreements, d.statistics.worst(),
                         d.seconds);
    out += fmt::format("\n{:<40}{:>12}{:>12}{:>12}{:>10}\n", "nearest hits, device against device",
                       "same bits", "other t", "other place", "ulps of t");
    for (const verify::Difference& d : report.differences)
      out += fmt::format("{:<40}{:>12}{:>12}{:>12}{:>10.3g}\n",
                         fmt::format("{} and {}", report.devices[d.first].info.index,
                                     report.devices[d.second].info.index),
                         d.same, d.other_t, d.other_place, d.worst_ulps);
    out += "\n";
  }
  out += fmt::format("seconds    {:.1f}\n", report.seconds);
  for (const DeviceReport& device : report.devices)
    out += (report.devices.size() > 1 ? fmt::format("verdict {}  ", device.info.index)
                                      : std::string("verdict    ")) +
           verdict_of(device);
  if (report.interrupted) out += "interrupted: these are the rays until then\n";
  return out;
}

std::string json_text(const Report& report, const std::string& scene,
                      const verify::Options& options) {
  Statistics sum;
  for (const DeviceReport& device : report.devices) sum.add(device.statistics);
  Json out;
  out["scene"] = scene;
  out["seed"] = options.seed;
  out["rays"] = report.devices.empty() ? 0 : report.devices[0].statistics.rays;
  out["disagreements"] = report.disagreements();
  out["seconds"] = report.seconds;
  out["verdict"] = report.is_empty               ? nothing_to_verify
                   : report.disagreements() == 0 ? "agrees"
                                                 : "disagrees";
  out["interrupted"] = report.interrupted;
  add_statistics(out, sum);
  out["devices"] = Json::array();
  for (const DeviceReport& device : report.devices) {
    Json one;
    one["index"] = device.info.index;
    one["name"] = device.info.name;
    one["platform"] = device.info.platform;
    one["driver"] = device.info.driver;
    one["compute_units"] = device.info.compute_units;
    one["rays"] = device.statistics.rays;
    one["disagreements"] = device.statistics.disagreements;
    one["seconds"] = device.seconds;
    add_statistics(one, device.statistics);
    out["devices"].push_back(one);
  }
  out["differences"] = Json::array();
  for (const verify::Difference& d : report.differences)
    out["differences"].push_back({{"first", report.devices[d.first].info.index},
                                  {"second", report.devices[d.second].info.index},
                                  {"same", d.same},
                                  {"other_t", d.other_t},
                                  {"other_place", d.other_place},
                                  {"worst_ulps", d.worst_ulps}});
  return to_text(out);
}

}  // namespace caplet::report
