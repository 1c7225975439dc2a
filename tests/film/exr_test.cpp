// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// EXR files: round trips, files of other programs, broken files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <random>

#include "base/error.h"
#include "film/exr_bytes.h"
#include "film/image.h"
#include "images.h"
#include "support/broken_utf8.h"
#include "support/data.h"

namespace caplet {
namespace {

using test::file_bytes;
using test::layered_image;
using test::write_bytes;
using testing::AllOf;
using testing::HasSubstr;

std::string read_error(const std::filesystem::path& path) {
  try {
    read_exr(path);
  } catch (const InputError& error) {
    EXPECT_EQ(error.messages().size(), 1u);
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    return error.what();
  }
  return "no error";
}

TEST(Exr, KeepsEveryChannelToTheBit) {
  LayeredImage image = layered_image();
  image.channels[0].floats[3] = std::numeric_limits<float>::infinity();
  image.channels[0].floats[4] = std::numeric_limits<float>::denorm_min();
  image.channels[4].floats[0] = 1e10f;
  const auto path = test::temporary_folder() / "layers.exr";
  write_exr(path, image);
  const LayeredImage back = read_exr(path);
  ASSERT_EQ(back.channels.size(), image.channels.size());
  for (const Channel& channel : image.channels) {
    const Channel* read = back.find(channel.name);
    ASSERT_NE(read, nullptr) << channel.name;
    EXPECT_EQ(read->floats, channel.floats) << channel.name;
    EXPECT_EQ(read->uints, channel.uints) << channel.name;
  }
}

TEST(Exr, IsTheSameInMemory) {
  const auto path = test::temporary_folder() / "memory.exr";
  write_exr(path, layered_image());
  EXPECT_EQ(exr_bytes(layered_image()), file_bytes(path));
}

TEST(Exr, KeepsWindowsAndMetadata) {
  LayeredImage image = layered_image();
  image.metadata = {{"caplet.seed", "17"},
                    {"software", "Caplet"},
                    {"caplet.command", "caplet render 'a b.pbrt' -o \xc3\xa4.exr"}};
  const auto path = test::temporary_folder() / "windows.exr";
  write_exr(path, image);
  const LayeredImage back = read_exr(path);
  EXPECT_EQ(back.width, 16);
  EXPECT_EQ(back.height, 9);
  EXPECT_EQ(back.x, 2);
  EXPECT_EQ(back.y, 1);
  EXPECT_EQ(back.data_width, 7);
  EXPECT_EQ(back.data_height, 5);
  for (const auto& [name, value] : image.metadata) EXPECT_EQ(back.metadata.at(name), value) << name;
}

TEST(Exr, HeadersAreUtf8) {
  LayeredImage image;
  image.width = image.height = image.data_width = image.data_height = 1;
  image.channels.push_back({"Y", {1.0f}, {}});
  for (std::size_t i = 0; i < std::size(test::broken_utf8); ++i)
    image.metadata["caplet.test" + std::to_string(i)] = test::broken_utf8[i].bytes;
  const std::filesystem::path file = test::temporary_folder() / "a.exr";
  write_exr(file, image);
  const LayeredImage read = read_exr(file);
  for (std::size_t i = 0; i < std::size(test::broken_utf8); ++i)
    EXPECT_EQ(read.metadata.at("caplet.test" + std::to_string(i)), test::broken_utf8[i].valid)
        << test::broken_utf8[i].what;
}

TEST(Exr, KeepsTheColorSpaceByItsChromaticities) {
  for (const ColorSpace space :
       {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1}) {
    LayeredImage image = layered_image();
    image.space = space;
    const auto path = test::temporary_folder() / "space.exr";
    write_exr(path, image);
    const LayeredImage back = read_exr(path);
    EXPECT_EQ(back.space, space);
    ASSERT_TRUE(back.chromaticities.has_value());
    // Single precision in the file.
    EXPECT_NEAR(back.chromaticities->green[1], chromaticities_of(space).green[1], 1e-7);
    EXPECT_NEAR(back.chromaticities->white[0], chromaticities_of(space).white[0], 1e-7);
  }
}

TEST(Exr, NamesChannelsAsLayers) {
  const auto path = test::temporary_folder() / "names.exr";
  write_exr(path, layered_image());
  const std::string bytes = file_bytes(path);
  // In the file a channel is its name, a null, and its type: 0 uint, 2 float.
  const auto entry = [](const char* name, char type) { return name + std::string(1, '\0') + type; };
  for (const char* name : {"R", "A", "Z", "albedo.R", "N.X", "P.Z", "variance.B"})
    EXPECT_THAT(bytes, HasSubstr(entry(name, 2))) << name;
  for (const char* name : {"object.id", "primitive.id"})
    EXPECT_THAT(bytes, HasSubstr(entry(name, 0))) << name;
}

TEST(Exr, WritesThePixelsWhereOthersLookForThem) {
  // A value whose bytes survive uncompressed in tiny files: OpenEXR stores a block raw when ZIP
  // does not shrink it.
  LayeredImage image;
  image.width = image.height = image.data_width = image.data_height = 1;
  image.channels.push_back({"Y", {1234.5678f}, {}});
  const auto path = test::temporary_folder() / "one.exr";
  write_exr(path, image);
  EXPECT_THAT(file_bytes(path), HasSubstr(test::little_endian(1234.5678f)));
}

TEST(Exr, AFailedWriteLeavesTheOldFile) {
  const auto folder = test::temporary_folder();
  write_exr(folder / "a.exr", layered_image());
  const std::string before = file_bytes(folder / "a.exr");
  LayeredImage image = layered_image();
  image.channels[0].floats.pop_back();
  EXPECT_THROW(write_exr(folder / "a.exr", image), std::logic_error);
  EXPECT_THROW(write_exr(folder / "missing" / "a.exr", layered_image()), RunError);
  EXPECT_EQ(file_bytes(folder / "a.exr"), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST(Exr, BandsMakeTheSamePicture) {
  const LayeredImage image = layered_image();
  const auto folder = test::temporary_folder();
  for (const ExrCompression compression : {ExrCompression::zip, ExrCompression::rle})
    for (const int step : {1, 2, 5, 100}) {
      BandedImage bands;
      bands.whole = image;
      bands.whole.channels.clear();
      bands.rows = step;
      bands.band = [&](int first, int rows) {
        EXPECT_LE(rows, step);
        LayeredImage band;
        for (const Channel& channel : image.channels) {
          const auto part = [&](const auto& values, auto& to) {
            if (!values.empty())
              to.assign(values.begin() + 7 * first, values.begin() + 7 * (first + rows));
          };
          Channel& copy = band.channels.emplace_back();
          copy.name = channel.name;
          part(channel.floats, copy.floats);
          part(channel.uints, copy.uints);
        }
        return band;
      };
      const auto path = folder / ("bands" + std::to_string(step) +
                                  (compression == ExrCompression::zip ? "zip.exr" : "rle.exr"));
      write_exr(path, bands, compression);
      const LayeredImage back = read_exr(path);
      EXPECT_EQ(back.x, image.x);
      EXPECT_EQ(back.y, image.y);
      EXPECT_EQ(back.data_height, image.data_height);
      for (const Channel& channel : image.channels) {
        ASSERT_NE(back.find(channel.name), nullptr) << channel.name;
        EXPECT_EQ(back.find(channel.name)->floats, channel.floats) << channel.name;
        EXPECT_EQ(back.find(channel.name)->uints, channel.uints) << channel.name;
      }
    }
}

// In the file, compression is a byte: 1 RLE, 3 ZIP of 16 rows (OpenEXR's file layout).
TEST(Exr, SaysItsCompression) {
  const auto path = test::temporary_folder() / "packed.exr";
  const auto entry = [](char kind) {
    std::string out("compression\0compression\0\1\0\0\0", 28);
    out.push_back(kind);
    return out;
  };
  write_exr(path, layered_image(), ExrCompression::rle);
  EXPECT_THAT(file_bytes(path), HasSubstr(entry(1)));
  write_exr(path, layered_image());
  EXPECT_THAT(file_bytes(path), HasSubstr(entry(3)));
}

TEST(Exr, PackingTakesATenthOfTheRenderAtMost) {
  constexpr std::uint64_t bytes = 600'000'000;  // ten seconds of one core
  EXPECT_EQ(compression_for(bytes, 99, 1), ExrCompression::rle);
  EXPECT_EQ(compression_for(bytes, 101, 1), ExrCompression::zip);
  EXPECT_EQ(compression_for(bytes, 26, 4), ExrCompression::zip);
  EXPECT_EQ(compression_for(bytes, 24, 4), ExrCompression::rle);
}

// As a quota does; OpenEXR itself says nothing when the last bytes or the table of rows do not fit.
TEST(Exr, EveryByteThatIsNotWrittenIsTold) {
  const auto path = test::temporary_folder() / "out.exr";
  write_exr(path, layered_image());
  const auto whole = std::filesystem::file_size(path);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const std::uintmax_t most : {whole - 1, whole / 2, std::uintmax_t{10}}) {
    write_bytes(path, "what was there");
    const rlimit limit{most, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_THROW(write_exr(path, layered_image()), RunError) << most;
    ::setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_EQ(file_bytes(path), "what was there");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
  }
  std::signal(SIGXFSZ, handler);
}

struct KnownFile {
  const char* path;
  int width, height;
};
void PrintTo(const KnownFile& file, std::ostream* out) { *out << file.path; }

class ExrOfOthers : public testing::TestWithParam<KnownFile> {};

// Sizes from the shared data's NOTICE.md: half and float, PIZ and ZIP.
INSTANTIATE_TEST_SUITE_P(
    Shared, ExrOfOthers,
    testing::Values(
        KnownFile{"scenes_pbrt/cornell-box/TungstenRender.exr", 1024, 1024},
        KnownFile{"scenes_pbrt/veach-mis/TungstenRender.exr", 1280, 720},
        KnownFile{"scenes_pbrt/coffee/TungstenRender.exr", 800, 1000},
        KnownFile{"reference/ignis/evaluation/references/ref-cbox-d6-4096.exr", 256, 256},
        KnownFile{"reference/ignis/evaluation/references/ref-point-4096.exr", 256, 256},
        KnownFile{"reference/mitsuba/mis-grey.exr", 128, 128},
        KnownFile{"hdr/ignis/constant.exr", 60, 40},
        KnownFile{"fibres/embree_curves/round_line_segments_0.ecs.embree_viewer.exr", 512, 512}));

TEST_P(ExrOfOthers, IsRead) {
  CAPLET_NEEDS_DATA();
  const LayeredImage image = read_exr(test::data_folder() / GetParam().path);
  EXPECT_EQ(image.data_width, GetParam().width);
  EXPECT_EQ(image.data_height, GetParam().height);
  double sum = 0;
  for (const char* name : {"R", "G", "B"}) {
    const Channel* channel = image.find(name);
    ASSERT_NE(channel, nullptr) << name;
    ASSERT_EQ(channel->floats.size(), static_cast<std::size_t>(GetParam().width) *
                                          static_cast<std::size_t>(GetParam().height));
    for (const float value : channel->floats) {
      ASSERT_TRUE(std::isfinite(value));
      sum += value;
    }
  }
  EXPECT_GT(sum, 0);
}

TEST(ExrOfOthers, MitsubaBringsVariance) {
  CAPLET_NEEDS_DATA();
  const LayeredImage image = read_exr(test::data_folder() / "reference/mitsuba/cornell.exr");
  for (const char* name : {"variance.R", "variance.G", "variance.B"}) {
    const Channel* channel = image.find(name);
    ASSERT_NE(channel, nullptr) << name;
    for (const float value : channel->floats) ASSERT_GE(value, 0);
  }
}

TEST(BrokenExr, MissingFolderGarbageAndEmpty) {
  const auto folder = test::temporary_folder();
  EXPECT_THAT(read_error(folder / "none.exr"),
              AllOf(HasSubstr("none.exr"), HasSubstr("no such file")));
  EXPECT_THAT(read_error(folder), HasSubstr("not a file"));
  write_bytes(folder / "empty.exr", "");
  EXPECT_THAT(read_error(folder / "empty.exr"), HasSubstr("empty.exr"));
  write_bytes(folder / "text.exr", "this is a text file and no picture at all");
  EXPECT_THAT(read_error(folder / "text.exr"), HasSubstr("text.exr"));
  std::mt19937 random(1);
  std::string noise = file_bytes(folder / "text.exr").substr(0, 0);
  for (int i = 0; i < 4096; ++i) noise += static_cast<char>(random() & 255u);
  write_bytes(folder / "noise.exr", noise);
  EXPECT_THAT(read_error(folder / "noise.exr"), HasSubstr("noise.exr"));
}

TEST(BrokenExr, TruncatedAnywhere) {
  const auto folder = test::temporary_folder();
  write_exr(folder / "whole.exr", layered_image());
  const std::string bytes = file_bytes(folder / "whole.exr");
  ASSERT_GT(bytes.size(), 500u);
  for (std::size_t size = 1; size < bytes.size(); size += 1 + size / 16) {
    write_bytes(folder / "cut.exr", bytes.substr(0, size));
    EXPECT_THAT(read_error(folder / "cut.exr"), HasSubstr("cut.exr"))
        << size << " of " << bytes.size() << " bytes";
  }
}

TEST(BrokenExr, FlippedBytesNeverCrash) {
  const auto folder = test::temporary_folder();
  write_exr(folder / "whole.exr", layered_image());
  const std::string bytes = file_bytes(folder / "whole.exr");
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string broken = bytes;
    for (int flips = 0; flips < 3; ++flips)
      broken[random() % broken.size()] = static_cast<char>(random() & 255u);
    write_bytes(folder / "flipped.exr", broken);
    try {
      read_exr(folder / "flipped.exr");
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(BrokenExr, HugeClaimsAreRefusedBeforeMemoryIsTaken) {
  const auto folder = test::temporary_folder();
  write_exr(folder / "small.exr", layered_image());
  const std::string bytes = file_bytes(folder / "small.exr");
  const std::int32_t huge = std::numeric_limits<std::int32_t>::max() / 2;
  for (const auto& [width, height] : {std::pair{15999, 15999},
                                      {huge, huge},
                                      {huge, 0},
                                      {0, huge},
                                      {(1 << 20) - 1, (1 << 20) - 1}}) {
    const std::string box = test::little_endian<std::int32_t>(0, 0, width, height);
    const std::string claimed = test::with_attribute(
        test::with_attribute(bytes, "dataWindow", "box2i", box), "displayWindow", "box2i", box);
    ASSERT_EQ(claimed.size(), bytes.size());
    write_bytes(folder / "huge.exr", claimed);
    EXPECT_THAT(read_error(folder / "huge.exr"), HasSubstr("huge.exr")) << width << " x " << height;
  }
}

TEST(BrokenExr, ImpossibleWindowsAreRefused) {
  const auto folder = test::temporary_folder();
  write_exr(folder / "small.exr", layered_image());
  const std::string bytes = file_bytes(folder / "small.exr");
  for (const auto& box :
       {test::little_endian<std::int32_t>(5, 5, 4, 4),
        test::little_endian<std::int32_t>(0, 0, -2147483647, 3),
        test::little_endian<std::int32_t>(-2147483647, -2147483647, 2147483646, 2147483646)}) {
    write_bytes(folder / "window.exr", test::with_attribute(bytes, "dataWindow", "box2i", box));
    EXPECT_THAT(read_error(folder / "window.exr"), HasSubstr("window.exr"));
  }
}

}  // namespace
}  // namespace caplet
