// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// .npy files against bytes written out by hand, and lists of rays with every fault that can be in
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

#include "support/data.h"
#include "table/npy.h"
#include "table/ray_file.h"

namespace caplet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// An array file as the format's description says: version 1.0, or 2.0 and 3.0 with a longer length
/// field.
std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string out = "\x93NUMPY";
  out += {version, '\0'};
  std::string header = dictionary;
  const std::size_t before = version == 1 ? 10 : 12;
  while ((before + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  out += {static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
  if (version > 1) out += std::string(2, '\0');
  return out + header + data;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

const std::vector<float> two_rays = {1, 2, 3, 0, 0, -1, 0.5f, -2, 1e-3f, 0, 4, 0};
const std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 6), }";

std::vector<RayNumbers> read_all(const std::filesystem::path& path, std::size_t piece = 1000) {
  RayFile file(path);
  std::vector<RayNumbers> out;
  for (;;) {
    const auto some = file.next(piece);
    for (const ListedRay& one : some) out.push_back(one.numbers);
    if (some.size() < piece) return out;
  }
}

std::vector<RayNumbers> expected() {
  std::vector<RayNumbers> out(2);
  std::memcpy(out.data(), two_rays.data(), two_rays.size() * sizeof(float));
  return out;
}

/// What reading the file is refused with; nothing when it is read.
std::string refusal(const std::filesystem::path& path) {
  try {
    read_all(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RayFile, ReadsArraysOfBothTypesAndAllVersions) {
  const auto path = test::temporary_folder() / "rays.npy";
  const std::vector<double> wide(two_rays.begin(), two_rays.end());
  std::string doubles = dictionary;
  doubles.replace(doubles.find("f4"), 2, "f8");
  for (const char version : {'\1', '\2', '\3'}) {
    write_bytes(path, npy(dictionary, bytes_of(two_rays), version));
    EXPECT_EQ(read_all(path), expected()) << int{version};
    EXPECT_EQ(read_all(path, 1), expected()) << int{version};
    write_bytes(path, npy(doubles, bytes_of(wide), version));
    EXPECT_EQ(read_all(path), expected()) << int{version};
  }
  // Spelt differently, the same dictionary.
  write_bytes(path, npy("{\"shape\":(2L,6L),\"fortran_order\":False,\"descr\":\"<f4\"}",
                        bytes_of(two_rays)));
  EXPECT_EQ(read_all(path), expected());
  write_bytes(path, npy("{'descr': '<f4', 'fortran_order': False, 'shape': (0, 6), }", ""));
  EXPECT_TRUE(read_all(path).empty());
}

/// Elements of rows as bytes of another type.
template <class Element>
std::string bytes_as(const std::vector<double>& numbers, bool swapped = false) {
  std::string out;
  for (const double number : numbers) {
    const auto one = static_cast<Element>(number);
    std::string bytes(reinterpret_cast<const char*>(&one), sizeof one);
    if (swapped) std::ranges::reverse(bytes);
    out += bytes;
  }
  return out;
}

TEST(RayFile, ReadsWholeNumbersOtherByteOrdersAndFortranOrder) {
  const auto path = test::temporary_folder() / "rays.npy";
  const std::vector<double> rows{1, 2, 3, 0, 0, 1, 4, 5, 6, 0, 7, 0},
      by_columns{1, 4, 2, 5, 3, 6, 0, 0, 0, 7, 1, 0};
  const std::vector<RayNumbers> wanted{{1, 2, 3, 0, 0, 1}, {4, 5, 6, 0, 7, 0}};
  const auto of = [](const std::string& type, bool fortran) {
    return "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") +
           ", 'shape': (2, 6), }";
  };
  const std::vector<std::pair<std::string, std::string>> files = {
      {of("|i1", false), bytes_as<std::int8_t>(rows)},
      {of("|u1", false), bytes_as<std::uint8_t>(rows)},
      {of("<i2", false), bytes_as<std::int16_t>(rows)},
      {of(">u2", false), bytes_as<std::uint16_t>(rows, true)},
      {of("<i4", false), bytes_as<std::int32_t>(rows)},
      {of("<u8", false), bytes_as<std::uint64_t>(rows)},
      {of(">i8", false), bytes_as<std::int64_t>(rows, true)},
      {of(">f4", false), bytes_as<float>(rows, true)},
      {of("<f8", true), bytes_as<double>(by_columns)},
      {of("<i4", true), bytes_as<std::int32_t>(by_columns)},
  };
  for (const auto& [header, data] : files) {
    write_bytes(path, npy(header, data));
    EXPECT_EQ(read_all(path), wanted) << header;
    EXPECT_EQ(read_all(path, 1), wanted) << header;
  }
  // Negative ones, and halves: 1, -2, 0.5, 65504, the least 2^-24, 0.
  write_bytes(path, npy("{'descr': '<i2', 'fortran_order': False, 'shape': (1, 6)}",
                        bytes_as<std::int16_t>({-1, -300, 7, 0, 0, -1})));
  EXPECT_EQ(read_all(path), (std::vector<RayNumbers>{{-1, -300, 7, 0, 0, -1}}));
  write_bytes(path, npy("{'descr': '<f2', 'fortran_order': False, 'shape': (1, 6)}",
                        std::string("\x00\x3c\x00\xc0\x00\x38\xff\x7b\x01\x00\x00\x00", 12)));
  EXPECT_EQ(read_all(path), (std::vector<RayNumbers>{{1, -2, 0.5F, 65504, 0x1p-24F, 0}}));
  // A half whose exponent has all bits is infinite, or no number where other bits are set.
  const auto with_limit = [&](const char* half) {
    std::string bytes(14, '\0');
    bytes[11] = '\x3c';  // dz is 1
    write_bytes(path, npy("{'descr': '<f2', 'fortran_order': False, 'shape': (1, 8)}",
                          bytes + std::string(half, 2)));
  };
  with_limit("\x00\x7c");
  EXPECT_EQ(RayFile(path).next(1).at(0).t_max, INFINITY);
  with_limit("\x01\x7c");
  EXPECT_THAT(refusal(path), testing::HasSubstr("t_max, nan,"));
  with_limit("\x00\xfc");
  EXPECT_THAT(refusal(path), testing::HasSubstr("t_max, -inf,"));
}

TEST(RayFile, ReadsLimits) {
  const auto path = test::temporary_folder() / "rays.txt";
  write_bytes(path, "0 0 0 0 0 1 0.5 2\n0 0 0 0 0 1\n0 0 0 0 0 1 1 inf\n");
  RayFile file(path);
  const std::vector<ListedRay> rays = file.next(9);
  ASSERT_EQ(rays.size(), 3u);
  EXPECT_EQ(rays[0].t_min, 0.5f);
  EXPECT_EQ(rays[0].t_max, 2.0f);
  EXPECT_EQ(rays[1].t_min, 0.0f);
  EXPECT_EQ(rays[1].t_max, INFINITY);
  EXPECT_EQ(rays[2].t_min, 1.0f);
  EXPECT_EQ(rays[2].t_max, INFINITY);
  const auto array = test::temporary_folder() / "rays.npy";
  write_bytes(array, npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 8)}",
                         bytes_as<float>({0, 0, 0, 0, 0, 1, 3, 4})));
  EXPECT_EQ(RayFile(array).next(1)[0].t_max, 4.0f);
}

TEST(NpyReader, ReadsFramesOfPlaces) {
  const auto path = test::temporary_folder() / "frames.npy";
  std::vector<double> numbers(2 * 3 * 3);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  write_bytes(path, npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 3)}",
                        bytes_as<float>(numbers)));
  NpyReader reader(path, {3}, 3);
  EXPECT_EQ(reader.shape(), (std::vector<std::uint64_t>{2, 3, 3}));
  reader.go_to(3);
  std::vector<double> second(9);
  reader.read(second);
  EXPECT_EQ(second.front(), 9);
  EXPECT_EQ(second.back(), 17);
  EXPECT_THROW(NpyReader(path, {3}), InputError);
  write_bytes(path, npy("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3, 3)}",
                        bytes_as<float>(numbers)));
  EXPECT_THROW(NpyReader(path, {3}, 3), InputError);
}

TEST(RayFile, RefusesOtherArrays) {
  const auto path = test::temporary_folder() / "rays.npy";
  const std::string data = bytes_of(two_rays);
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string out = dictionary;
    out.replace(out.find(what), what.size(), by);
    return out;
  };
  const std::vector<std::pair<std::string, std::string>> rows = {
      {npy(with("<f4", "<c8"), data), "'<c8'"},
      {npy(with("<f4", "|b1"), data), "'|b1'"},
      {npy(with("<f4", "<U6"), data), "'<U6'"},
      {npy(with("'<f4'", "[('x', '<f4'), ('y', '<f4')]"), data), "structured"},
      {npy(with("(2, 6)", "(6, 2)"), data), "(6, 2)"},
      {npy(with("(2, 6)", "(12,)"), data), "(12,)"},
      {npy(with("(2, 6)", "(2, 3, 2)"), data), "(2, 3, 2)"},
      {npy(with("(2, 6)", "()"), data), "()"},
      {npy(with("(2, 6)", "(2, 7)"), data), "(N, 6 or 8)"},
      {npy(dictionary, data.substr(0, 40)), "cut off"},
      {npy(with("(2, 6)", "(3, 6)"), data), "cut off"},
      {npy(with("(2, 6)", "(18446744073709551615, 6)"), data), "cut off"},
      {npy(with("(2, 6)", "(184467440737095516150, 6)"), data), "malformed"},
      {npy(with("(2, 6)", "(-2, 6)"), data), "malformed"},
      {npy(dictionary, data + "more"), "4 bytes follow"},
      {npy("{'descr': '<f4', 'shape': (2, 6)}", data), "malformed"},
      {npy("", data), "malformed"},
      {npy("{'descr': '<f4'", data), "malformed"},
      {npy("{'descr': [('x', '<f4'), 'shape': (2, 6)", data), "malformed"},
      {npy(dictionary, data, 4), "version 4"},
      {npy(dictionary, data).substr(0, 9), "header"},
      {npy(dictionary, data).substr(0, 50), "header"},
      {std::string("\x93NUMPY\2\0\xff\xff\xff\x7f", 12), "2147483647"},
      {"1 2 3 0 0 1\n", "no .npy file"},
      {"", "no .npy file"},
  };
  for (const auto& [bytes, mentions] : rows) {
    write_bytes(path, bytes);
    const std::string message = refusal(path);
    EXPECT_THAT(message, StartsWith(path.string() + ": ")) << mentions;
    EXPECT_THAT(message, HasSubstr(mentions));
  }
  EXPECT_THAT(refusal(path.parent_path() / "none.npy"), HasSubstr("no such file"));
}

TEST(RayFile, NamesTheRowsOfBadRays) {
  const auto path = test::temporary_folder() / "rays.npy";
  const std::vector<std::pair<std::size_t, std::pair<float, std::string>>> faults = {
      {7, {NAN, "row 1: the ray's origin is not finite"}},
      {11, {INFINITY, "row 1: the ray's direction is not finite"}},
      {0, {1e30f, "row 0: 1e+30 is out of range"}},
      {5, {0, "row 0: the ray has no direction"}},
      {5, {1e-30f, "row 0: the direction's length, 1e-30"}},
  };
  for (const auto& [at, fault] : faults) {
    std::vector<float> numbers = two_rays;
    numbers[at] = fault.first;
    write_bytes(path, npy(dictionary, bytes_of(numbers)));
    EXPECT_THAT(refusal(path), HasSubstr(fault.second));
  }
}

TEST(RayFile, ReadsText) {
  const auto path = test::temporary_folder() / "rays.txt";
  write_bytes(path,
              "# origin, direction\n\n1 2 3  0 0 -1\r\n   # nothing here\n+.5,-2e0 , 1e-3\t0,4,0 # "
              "the second");
  EXPECT_EQ(read_all(path), expected());
  EXPECT_EQ(read_all(path, 1), expected());
  write_bytes(path, "");
  EXPECT_TRUE(read_all(path).empty());
  // Longer than what is read at a time, with lines across its seams.
  std::string text;
  std::size_t lines = 0;
  for (; text.size() < 3'000'000; ++lines)
    text += "1 2 3 0 0 -1" + std::string(lines % 7, ' ') + "\n";
  write_bytes(path, text);
  const auto rays = read_all(path);
  ASSERT_EQ(rays.size(), lines);
  for (const RayNumbers& ray : rays) ASSERT_EQ(ray, expected()[0]);
}

TEST(RayFile, RefusesTextWithItsPlace) {
  const auto path = test::temporary_folder() / "rays.txt";
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"0 0 0 0 0 1\n1 2 three 0 0 1\n", ":2:5: 'three' is not a number"},
      {"0 0 0 0 0 1 7\n", ":1:14: seven numbers: t_max is missing"},
      {"0 0 0 0 0 1 7 8 9\n", ":1:17: there are more than eight numbers"},
      {"0 0 0 0 0 1 -1 2\n", ":1:13: t_min, -1, is not from 0"},
      {"0 0 0 0 0 1 2 2\n", ":1:15: t_max, 2, is not above t_min, 2"},
      {"0 0 0 0 0 1 inf inf\n", ":1:13: 'inf' is not finite"},
      {"\n0 0 0 0 1 # five\n", ":2:11: 5 of six numbers"},
      {"0,0,,0,0,1\n", ":1:5: a number is missing"},
      {"0,0,0,0,0,\n", ":1:11: a number is missing"},
      {",0,0,0,0,1\n", ":1:1: a number is missing"},
      {"0 0 nan 0 0 1\n", ":1:5: 'nan' is not finite"},
      {"0 0 0 0 0 inf\n", ":1:11: 'inf' is not finite"},
      {"1e400 0 0 0 0 1\n", ":1:1: '1e400' is out of range"},
      {"0 1e30 0 0 0 1\n", ":1:3: 1e+30 is out of range"},
      {"0 0 0  0 0 0\n", ":1:8: the ray has no direction"},
      {"0 0 0  0 0 1e-30\n", ":1:8: the direction's length, 1e-30"},
      {"0 0 0 0 0 0x1\n", ":1:11: '0x1' is not a number"},
      {std::string("0 0 0 0 0 1\0\n", 13), ":1:11: '1\\x00' is not a number"},
      {std::string(3'000'000, '1'), ":1: the line is longer"},
  };
  for (const auto& [text, message] : rows) {
    write_bytes(path, text);
    EXPECT_EQ(refusal(path).substr(0, path.string().size() + message.size()),
              path.string() + message);
  }
  EXPECT_THAT(refusal(path.parent_path()), HasSubstr("folder"));
  EXPECT_THAT(refusal(path.parent_path() / "none.txt"), HasSubstr("no such file"));
  // Several faults at once, but not without end.
  write_bytes(path, "1\n0 0 0 0 0 1\n2\n3\n");
  try {
    read_all(path);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.messages().size(), 3u);
  }
  std::string many;
  for (int i = 0; i < 100; ++i) many += "x\n";
  write_bytes(path, many);
  try {
    read_all(path);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_LE(error.messages().size(), 21u);
  }
}

TEST(NpyWriter, WritesWhatTheFormatSays) {
  const auto path = test::temporary_folder() / "table.npy";
  for (const std::size_t rows : {std::size_t{0}, std::size_t{1}, std::size_t{123}}) {
    NpyWriter writer(path, {{"t", "<f4"}, {"name", "<U3"}, {"in", "|b1"}});
    std::string data;
    for (std::size_t i = 0; i < rows; ++i) {
      const auto t = static_cast<float>(i) * 0.5f;
      data.append(reinterpret_cast<const char*>(&t), sizeof t);
      append_unicode(data, i % 2 == 0 ? "ab" : "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80z",
                     3);  // U+E9 U+20AC U+1F600 z
      data += static_cast<char>(i % 2);
    }
    writer.append(data);
    writer.finish();
    const std::string bytes = read_bytes(path);
    ASSERT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\1\0", 8));
    const std::size_t header =
        static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
    EXPECT_EQ((10 + header) % 64, 0u);
    std::string text = bytes.substr(10, header);
    EXPECT_EQ(text.back(), '\n');
    text.resize(text.find_last_not_of(" \n") + 1);
    EXPECT_EQ(text,
              "{'descr': [('t', '<f4'), ('name', '<U3'), ('in', '|b1')], 'fortran_order': False, "
              "'shape': (" +
                  std::to_string(rows) + ",), }");
    ASSERT_EQ(bytes.size(), 10 + header + rows * 17);
    if (rows < 2) continue;
    const std::string second = bytes.substr(10 + header + 17, 17);
    EXPECT_EQ(second, std::string("\0\0\0\x3f"
                                  "\xe9\0\0\0\xac\x20\0\0\0\xf6\1\0"
                                  "\1",
                                  17));
  }
  EXPECT_THROW(NpyWriter(path.parent_path() / "none" / "table.npy", {{"t", "<f4"}}), RunError);
}

TEST(NpyWriter, CountsCharactersNotBytes) {
  EXPECT_EQ(unicode_length("axon"), 4u);
  EXPECT_EQ(unicode_length("\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80"), 3u);
  // What is no UTF-8 (alone, cut off, too long a form, a surrogate, beyond the last one) counts as
  // often as Python's bytes.decode("utf-8", "replace") has U+FFFD for it.
  constexpr std::pair<const char*, std::size_t> broken[] = {
      {"\x80", 1},         {"\xc3", 1},         {"\xe2\x82", 1},
      {"\xc0\x80", 2},     {"\xed\xa0\x80", 3}, {"\xf4\x90\x80\x80", 4},
      {"\xf0\x9f\x98", 1}, {"\xff", 1}};
  for (const auto& [bad, count] : broken) {
    std::string row;
    const std::size_t length = unicode_length(bad);
    EXPECT_EQ(length, count);
    append_unicode(row, bad, length);
    for (std::size_t i = 0; i < length; ++i)
      EXPECT_EQ(row.substr(4 * i, 4), std::string("\xfd\xff\0\0", 4));
  }
}

}  // namespace
}  // namespace caplet
