// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Zip archives for tests, written by hand (APPNOTE 6.3): local headers and data, the list of files,
// its end.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace caplet::test {

/// Files as they are, or deflated.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files,
                          bool deflated = false) {
  const auto number = [](std::string& out, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i, value >>= 8) out += static_cast<char>(value);
  };
  std::string out, list;
  for (const auto& [name, bytes] : files) {
    std::string packed = bytes;
    if (deflated) {
      z_stream stream{};
      deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY);
      packed.resize(deflateBound(&stream, static_cast<uLong>(bytes.size())));
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
      stream.avail_in = static_cast<uInt>(bytes.size());
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, Z_FINISH);
      packed.resize(stream.total_out);
      deflateEnd(&stream);
    }
    std::string about;  // what both headers say
    number(about, 20, 2);
    number(about, 0, 2);
    number(about, deflated ? 8 : 0, 2);
    number(about, 0, 4);
    number(about,
           crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())),
           4);
    number(about, packed.size(), 4);
    number(about, bytes.size(), 4);
    number(about, name.size(), 2);
    number(about, 0, 2);
    list += "PK\x01\x02";
    number(list, 20, 2);
    list += about;
    number(list, 0, 10);
    number(list, out.size(), 4);
    list += name;
    out += "PK\x03\x04" + about + name + packed;
  }
  std::string end = "PK\x05\x06";
  number(end, 0, 4);
  number(end, files.size(), 2);
  number(end, files.size(), 2);
  number(end, list.size(), 4);
  number(end, out.size(), 4);
  number(end, 0, 2);
  return out + list + end;
}

/// A 3MF package of one model.
inline std::string package_3mf(const std::string& model) {
  return zip_of(
      {{"_rels/.rels",
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
        "<Relationship Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" "
        "Target=\"/3D/a.model\" "
        "Id=\"r\"/></Relationships>"},
       {"3D/a.model", model}});
}

}  // namespace caplet::test
