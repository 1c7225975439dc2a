// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Bytes that are no UTF-8, against what Python's decoder and nlohmann's JSON make of them.
#include "base/utf8.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>

#include "base/log.h"
#include "support/broken_utf8.h"
#include "support/log_of.h"

namespace caplet {
namespace {

constexpr const char* good[] = {"",
                                "axon",
                                "K\xc3\xbcgel",
                                "\xe2\x82\xac",
                                "\xf0\x9f\x98\x80",
                                "\xc2\x80",
                                "\xdf\xbf",
                                "\xe0\xa0\x80",
                                "\xed\x9f\xbf",
                                "\xee\x80\x80",
                                "\xef\xbf\xbd",
                                "\xef\xbf\xbf",
                                "\xf0\x90\x80\x80",
                                "\xf4\x8f\xbf\xbf"};

TEST(ValidUtf8, LeavesGoodTextAlone) {
  for (const char* text : good) EXPECT_EQ(valid_utf8(text), text);
  const std::string with_zero("a\0b", 3);
  EXPECT_EQ(valid_utf8(with_zero), with_zero);
}

TEST(ValidUtf8, HasAReplacementForEveryBrokenPart) {
  for (const test::Broken& one : test::broken_utf8) {
    EXPECT_EQ(valid_utf8(one.bytes), one.valid) << one.what;
    EXPECT_EQ(valid_utf8("a" + std::string(one.bytes) + "z"), "a" + std::string(one.valid) + "z")
        << one.what;
    EXPECT_EQ(valid_utf8(valid_utf8(one.bytes)), one.valid) << one.what;
  }
}

/// All text of one and two bytes, and much of up to six, of bytes that sequences begin and go on
/// with.
TEST(ValidUtf8, IsWhatJsonHas) {
  const auto check = [](const std::string& text) {
    const nlohmann::json written = text;
    const std::string read = nlohmann::json::parse(json_dump(written)).get<std::string>();
    ASSERT_EQ(valid_utf8(text), read) << testing::PrintToString(text);
    for (std::string_view left = read; !left.empty();) {
      const char32_t character = take_character(left);
      ASSERT_TRUE(character <= 0x10ffff && (character < 0xd800 || character > 0xdfff));
    }
  };
  for (int first = 0; first < 256; ++first) {
    check({static_cast<char>(first)});
    for (int second = 0; second < 256; ++second)
      check({static_cast<char>(first), static_cast<char>(second)});
  }
  std::mt19937 engine(9);
  constexpr std::array<std::uint8_t, 20> telling{'a',  0x7f, 0x80, 0x8f, 0x90, 0x9f, 0xa0,
                                                 0xbf, 0xc0, 0xc2, 0xdf, 0xe0, 0xe1, 0xed,
                                                 0xef, 0xf0, 0xf1, 0xf4, 0xf5, 0xff};
  for (int i = 0; i < 100000; ++i) {
    std::string text;
    for (auto k = 1 + engine() % 6; k > 0; --k)
      text += static_cast<char>(telling[engine() % telling.size()]);
    check(text);
  }
}

TEST(JsonDump, TakesKeysAndControlCharacters) {
  const nlohmann::ordered_json written{{"K\xfcgel", std::string("a\0\x1b[31m\n\x7f", 9)}};
  const std::string text = json_dump(written);
  EXPECT_EQ(text, "{\"K\xef\xbf\xbdgel\":\"a\\u0000\\u001b[31m\\n\x7f\"}");
  EXPECT_EQ(json_dump(written, 2).find('\n'), 1u);
}

TEST(OneLine, HasBlanksForControlCharacters) {
  EXPECT_EQ(one_line("plain, \xc3\xbc"), "plain, \xc3\xbc");
  EXPECT_EQ(one_line(std::string("a\nb\r\t\0\x1b[2J\x7f", 11)), "a b    [2J ");
  EXPECT_EQ(one_line("\xc2\x9b"
                     "31m\xc2\x80\xc2\xa0"),
            " 31m \xc2\xa0");  // CSI of one character
  EXPECT_EQ(one_line("\x9b"), "\xef\xbf\xbd");
}

TEST(Log, IsOneLineOfUtf8) {
  test::LogOf log;
  log::warn("{}", "a\x1b[2J\nb\xff");
  EXPECT_EQ(log.text(), "caplet: warning: a [2J b\xef\xbf\xbd\n");
}

}  // namespace
}  // namespace caplet
