// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The cache folder: what is stored comes back, anything else is a miss.
#include "device/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/content_hash.h"
#include "support/data.h"
#include "support/environment.h"
#include "support/log_of.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Bytes = std::vector<unsigned char>;

const Bytes contents = {0, 10, 13, 255, 'a', 10};

class Cache : public testing::Test {
 protected:
  std::string file() const {
    std::ifstream in(cache_file("key", "test"), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void replace_file(const std::string& text) const {
    std::ofstream(cache_file("key", "test"), std::ios::binary) << text;
  }

  fs::path folder_ = test::temporary_folder() / "deep" / "er";
  test::ScopedVariable variable_{"CAPLET_CACHE", folder_.string()};
};

TEST(ContentHash, IsTheHundredAndTwentyEightBitFnv1a) {
  // From the test vectors of the FNV specification (RFC 9923, appendix C): the empty string and
  // "a".
  EXPECT_EQ(content_hash(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(content_hash("a"), "d228cb696f1a8caf78912b704e4a8964");
}

TEST_F(Cache, GivesBackWhatWasStored) {
  EXPECT_FALSE(cache_load("key", "test"));
  EXPECT_TRUE(cache_store("key", "test", contents));
  EXPECT_EQ(cache_load("key", "test"), contents);
  EXPECT_TRUE(cache_store("key", "test", {}));
  EXPECT_EQ(cache_load("key", "test"), Bytes{});
  EXPECT_FALSE(cache_load("other key", "test"));
  EXPECT_FALSE(cache_load("key", "other"));
}

TEST_F(Cache, LeavesNothingElseBehind) {
  cache_store("key", "test", contents);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(Cache, EveryAlteredByteIsAMiss) {
  cache_store("key", "test", contents);
  const std::string good = file();
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    replace_file(bad);
    EXPECT_FALSE(cache_load("key", "test")) << "byte " << i;
    replace_file(good.substr(0, i));
    EXPECT_FALSE(cache_load("key", "test")) << "cut to " << i;
  }
  replace_file(good + "x");
  EXPECT_FALSE(cache_load("key", "test"));
  replace_file(good);
  EXPECT_EQ(cache_load("key", "test"), contents);
}

TEST_F(Cache, AFileUnderAnotherKeysNameIsAMiss) {
  cache_store("key", "test", contents);
  fs::rename(cache_file("key", "test"), cache_file("other key", "test"));
  EXPECT_FALSE(cache_load("other key", "test"));
}

TEST_F(Cache, AFolderInAFilesPlaceIsAMissAndNamed) {
  fs::create_directories(cache_file("key", "test") / "in the way");
  test::LogOf log;
  EXPECT_FALSE(cache_load("key", "test"));
  EXPECT_FALSE(cache_store("key", "test", contents));
  EXPECT_FALSE(cache_store("key", "test", contents));
  const std::string said = log.text(),
                    name = "'" + cache_file("key", "test").string() + "' is a folder";
  EXPECT_THAT(said, HasSubstr(name));
  EXPECT_EQ(said.find(name), said.rfind(name));  // once
  EXPECT_TRUE(cache_store("other key", "test", contents));
  EXPECT_EQ(cache_load("other key", "test"), contents);
}

TEST(CacheFolder, ThatCannotBeUsedIsNoError) {
  const fs::path folder = test::temporary_folder();
  std::ofstream(folder / "file") << "in the way";
  const test::ScopedVariable variable("CAPLET_CACHE", (folder / "file" / "sub").string());
  EXPECT_FALSE(cache_store("key", "test", contents));
  EXPECT_FALSE(cache_load("key", "test"));
}

TEST(CacheFolder, IsNamedByTheEnvironment) {
  const test::ScopedVariable none("CAPLET_CACHE", std::nullopt);
  const test::ScopedVariable home("HOME", "/h");
  {
    const test::ScopedVariable base("XDG_CACHE_HOME", "/x");
    EXPECT_EQ(cache_folder(), "/x/caplet");
    const test::ScopedVariable own("CAPLET_CACHE", "/c");
    EXPECT_EQ(cache_folder(), "/c");
  }
  const test::ScopedVariable base("XDG_CACHE_HOME", std::nullopt);
  EXPECT_EQ(cache_folder(), "/h/.cache/caplet");
  const test::ScopedVariable no_home("HOME", std::nullopt);
  EXPECT_EQ(cache_folder(), "");
  EXPECT_FALSE(cache_store("key", "test", contents));
}

}  // namespace
}  // namespace caplet
