// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where outputs go: what stands there stays what it is, nothing that is read or written otherwise
// is written over, modes stay, and a disk that is full costs nothing but the new file.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "film/image.h"
#include "pictures.h"
#include "program.h"
#include "small_disk.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::folder_with_scene;
using test::render;
using test::Result;
using testing::AllOf;
using testing::HasSubstr;

using Names = std::vector<std::string>;

struct stat status_of(const fs::path& path) {
  struct stat out {};
  EXPECT_EQ(::lstat(path.c_str(), &out), 0) << path;
  return out;
}
mode_t mode_of(const fs::path& path) { return status_of(path).st_mode & 07777; }

/// A character device of the memory driver's: 3 is null, 7 full. False, with the reason printed,
/// where none may be made.
bool make_device(const fs::path& path, unsigned minor) {
  if (::mknod(path.c_str(), S_IFCHR | 0666, makedev(1, minor)) == 0) {
    const int opened = ::open(path.c_str(), O_WRONLY);  // a file system may forbid their use
    if (opened >= 0) {
      ::close(opened);
      return true;
    }
  }
  std::printf("no device node can be made here: %s\n", std::strerror(errno));
  return false;
}

TEST(Outputs, ADeviceNodeTakesThemAndStays) {
  const fs::path folder = folder_with_scene();
  if (!make_device(folder / "null", 3)) GTEST_SKIP() << "mknod is not allowed";
  for (const Names& arguments : {Names{"-o", "out.exr", "--stats", "null"}, Names{"-o", "null"},
                                 Names{"-o", "null", "--stats", "null"}}) {
    const Result result = render(folder, arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    const struct stat node = status_of(folder / "null");
    EXPECT_TRUE(S_ISCHR(node.st_mode));
    EXPECT_EQ(node.st_rdev, makedev(1, 3));
  }
  EXPECT_EQ(test::names_in(folder), (Names{"null", "out.exr", "scene.pbrt"}));
}

TEST(Outputs, AFifoTakesThemAndStays) {
  const fs::path folder = folder_with_scene(), received = test::temporary_folder();
  ASSERT_EQ(render(folder, {"-o", "plain.exr"}).code, 0);
  ASSERT_EQ(::mkfifo((folder / "picture").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo((folder / "stats").c_str(), 0600), 0);
  std::thread reader([&] {
    test::write_file(received / "picture.exr", test::read_file(folder / "picture"));
    test::write_file(received / "stats.json", test::read_file(folder / "stats"));
  });
  const Result result = render(folder, {"-o", "picture", "--stats", "stats"});
  EXPECT_EQ(result.code, 0) << result.err;
  if (result.code != 0)  // or the reader would wait for ever
    for (const char* name : {"picture", "stats"})
      ::close(::open((folder / name).c_str(), O_WRONLY | O_NONBLOCK));
  reader.join();
  test::expect_equal_pictures(folder / "plain.exr", received / "picture.exr");
  EXPECT_EQ(nlohmann::json::parse(test::read_file(received / "stats.json")).at("samples_per_pixel"),
            2);
  for (const char* name : {"picture", "stats"})
    EXPECT_TRUE(S_ISFIFO(status_of(folder / name).st_mode)) << name;
}

TEST(Outputs, LinksAreFollowed) {
  const fs::path folder = folder_with_scene();
  fs::create_directory(folder / "there");
  test::write_file(folder / "there/old.exr", "the previous picture");
  fs::create_symlink("there/old.exr", folder / "old.exr");
  fs::create_symlink("old.exr", folder / "older.exr");
  fs::create_symlink("there/new.json", folder / "new.json");  // leads to nothing yet
  const Result result = render(folder, {"-o", "older.exr", "--stats", "new.json"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* name : {"old.exr", "older.exr", "new.json"})
    EXPECT_TRUE(fs::is_symlink(folder / name)) << name;
  EXPECT_EQ(read_exr(folder / "there/old.exr").data_width, 24);
  EXPECT_TRUE(nlohmann::json::accept(test::read_file(folder / "there/new.json")));
  EXPECT_EQ(test::names_in(folder / "there"), (Names{"new.json", "old.exr"}));

  fs::create_symlink("round.exr", folder / "about.exr");
  fs::create_symlink("about.exr", folder / "round.exr");
  const Result loop = render(folder, {"-o", "round.exr"});
  EXPECT_EQ(loop.code, 2);
  EXPECT_THAT(loop.err, HasSubstr("-o: 'round.exr' is a loop of links"));
}

TEST(Outputs, WhatCannotBeAFileIsRefused) {
  const fs::path folder = folder_with_scene();
  fs::create_directory(folder / "folder.exr");
  fs::create_symlink("folder.exr", folder / "link.exr");
  fs::create_symlink("no/such/folder.exr", folder / "nowhere.exr");
  const auto refused = [&](const std::string& name) {
    const Result result = render(folder, {"-o", name});
    EXPECT_EQ(result.code, 2) << name;
    return result.err;
  };
  EXPECT_THAT(refused("folder.exr"), HasSubstr("-o: 'folder.exr' is a folder"));
  EXPECT_THAT(refused("link.exr"), HasSubstr("is a folder"));
  EXPECT_THAT(refused("nowhere.exr"), HasSubstr("no/such' does not exist"));
  EXPECT_THAT(refused("scene.pbrt/out.exr"), HasSubstr("does not exist"));
  EXPECT_THAT(refused(std::string(300, 'x') + ".exr"), HasSubstr("name too long"));
  // This device's driver is not there: nothing is behind it.
  if (::mknod((folder / "block").c_str(), S_IFBLK | 0600, makedev(240, 200)) == 0) {
    EXPECT_THAT(refused("block"), HasSubstr("is a block device"));
  }
}

TEST(Outputs, TheLongestNamesAreWritten) {
  const fs::path folder = folder_with_scene();
  const std::string name = std::string(251, 'x') + ".exr";  // 255 bytes, the file systems' most
  const Result result = render(folder, {"-o", name});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(fs::exists(folder / name));
}

TEST(Outputs, ModesAreKeptAndNewOnesAreByTheUmask) {
  const fs::path folder = folder_with_scene();
  test::write_file(folder / "rays.txt", "0 0 5 0 0 -1\n");
  const std::vector<std::pair<std::string, Names>> outputs = {
      {"out.exr", {"render", "scene.pbrt", "-q", "-o", "out.exr"}},
      {"stats.json", {"render", "scene.pbrt", "-q", "-o", "none", "--stats", "stats.json"}},
#ifdef CAPLET_WITH_OIIO
      {"out.png", {"render", "scene.pbrt", "-q", "-o", "none", "--preview", "out.png"}},
#endif
      {"out.csv", {"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "out.csv"}},
      {"out.npy", {"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "out.npy"}},
      {"heat.exr", {"verify", "scene.pbrt", "-q", "--rays", "10", "--heatmap", "heat.exr"}}};
  for (const auto& [name, arguments] : outputs) {
    SCOPED_TRACE(name);
    const auto run = [&, &arguments = arguments] {
      const Result result = test::run_program(arguments, folder, {}, [] { ::umask(027); });
      EXPECT_EQ(result.code, 0) << result.err;
    };
    run();
    EXPECT_EQ(mode_of(folder / name), 0640u);
    const bool given = ::chown((folder / name).c_str(), 1234, 2345) == 0;  // as root alone
    ::chmod((folder / name).c_str(), 0664);
    run();
    EXPECT_EQ(mode_of(folder / name), 0664u);
    if (!given) continue;
    EXPECT_EQ(status_of(folder / name).st_uid, 1234u);
    EXPECT_EQ(status_of(folder / name).st_gid, 2345u);
  }
}

/// A folder in which scene.pbrt reads every kind of file there is.
fs::path folder_with_inputs() {
  const fs::path folder = test::temporary_folder();
  LayeredImage sky;
  sky.width = sky.data_width = sky.height = sky.data_height = 4;
  for (const char* name : {"R", "G", "B"})
    sky.channels.push_back({name, std::vector<float>(16, 1.0f), {}});
  write_exr(folder / "env.exr", sky);
  test::write_file(folder / "grey.spd", "300 0.5\n900 0.5\n");
  const std::string small = test::small_scene;
  test::write_file(folder / "part.pbrt", small.substr(small.find("Shape ")));
  std::string text =
      small.substr(0, small.find("LightSource ")) +
      "LightSource \"infinite\" \"string filename\" \"env.exr\"\n" +
      "Material \"diffuse\" \"spectrum reflectance\" \"grey.spd\"\nInclude \"part.pbrt\"\n";
  test::write_file(folder / "mesh.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                   "y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
                   "0\n0 1 0\n3 0 1 2\n");
  text += "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\n";
  test::write_file(folder / "scene.pbrt", text);
  test::write_file(folder / "cell.swc", "1 1 0 0 0 1 -1\n2 3 0 5 0 1 1\n");
  test::write_file(folder / "axon.capsules", "<0, 0, 0> <1, 0, 0> 0.5\n");
  test::write_file(folder / "rays.csv", "0 0 5 0 0 -1\n");
  return folder;
}

TEST(Outputs, NoInputIsReplaced) {
  const fs::path folder = folder_with_inputs();
  fs::create_hard_link(folder / "env.exr", folder / "hard.exr");
  fs::create_symlink("env.exr", folder / "soft.exr");
  fs::create_directory(folder / "sub");
  const Names names = test::names_in(folder);
  std::map<std::string, std::string> contents;
  for (const std::string& name : names)
    if (name != "sub") contents[name] = test::read_file(folder / name);
  const auto refused = [&](const Names& arguments, const std::string& flag) {
    const Result result = test::run_program(arguments, folder);
    EXPECT_EQ(result.code, 2) << testing::PrintToString(arguments) << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr("caplet: error: " + flag + ": '"),
                                  HasSubstr("is an input of this run")));
  };
  for (const char* name : {"env.exr", "./env.exr", "sub/../env.exr", "hard.exr", "soft.exr"})
    refused({"render", "scene.pbrt", "-o", name}, "-o");
  for (const char* name : {"scene.pbrt", "part.pbrt", "grey.spd", "env.exr", "mesh.ply"})
    refused({"render", "scene.pbrt", "-o", "out.exr", "--stats", name}, "--stats");
  refused({"render", "cell.swc", "--stats", "cell.swc"}, "--stats");
  refused({"render", "axon.capsules", "--stats", "axon.capsules"}, "--stats");
  refused({"pick", "scene.pbrt", "--rays", "rays.csv", "--out", "rays.csv"}, "--out");
  refused({"verify", "scene.pbrt", "--rays", "10", "--heatmap", "env.exr"}, "--heatmap");
  EXPECT_EQ(test::names_in(folder), names);
  for (const auto& [name, bytes] : contents)
    EXPECT_EQ(test::read_file(folder / name), bytes) << name;
}

TEST(Outputs, NoTwoAreTheSameFile) {
  const fs::path folder = folder_with_scene();
  test::write_file(folder / "old.exr", "the previous picture");
  fs::create_hard_link(folder / "old.exr", folder / "hard");
  fs::create_symlink("old.exr", folder / "soft");
  fs::create_symlink("new.exr", folder / "dangling");
  fs::create_directory(folder / "sub");
  for (const auto& [picture, stats] :
       std::vector<std::pair<std::string, std::string>>{{"new.exr", "new.exr"},
                                                        {"new.exr", "./sub/../new.exr"},
                                                        {"new.exr", "dangling"},
                                                        {"old.exr", "hard"},
                                                        {"old.exr", "soft"}}) {
    const Result result = render(folder, {"-o", picture, "--stats", stats});
    EXPECT_EQ(result.code, 2) << stats;
    EXPECT_THAT(result.err, HasSubstr("--stats: '" + stats + "' is the output of -o as well"));
  }
#ifdef CAPLET_WITH_OIIO
  EXPECT_EQ(render(folder, {"--preview", "a.png", "--stats", "a.png"}).code, 2);
#endif
  // The scene's own name for the picture.
  EXPECT_THAT(render(folder, {"--stats", "pbrt.exr"}).err,
              HasSubstr("-o: 'pbrt.exr' is the output of --stats as well"));
  EXPECT_EQ(test::read_file(folder / "old.exr"), "the previous picture");
  EXPECT_FALSE(fs::exists(folder / "new.exr"));
}

/// In a process of its own: a namespace in which `target` is a mount point, with `source` mounted
/// there. 0, or the error's number.
int mount_file(const fs::path& source, const fs::path& target) {
  const uid_t user = ::geteuid();
  if (::unshare(CLONE_NEWNS | (user == 0 ? 0 : CLONE_NEWUSER)) != 0) return errno;
  if (user != 0) test::write_file("/proc/self/uid_map", "0 " + std::to_string(user) + " 1");
  if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return errno;
  return ::mount(source.c_str(), target.c_str(), nullptr, MS_BIND, nullptr) == 0 ? 0 : errno;
}

// As files are in containers: no file can take a mount point's place, so that it is written over.
TEST(Outputs, AFileThatIsMountedIsWrittenOver) {
  const fs::path folder = folder_with_scene(), source = folder / "source.exr",
                 target = folder / "target.exr";
  test::write_file(source, "what was there");
  test::write_file(target, "behind it");
  const pid_t child = ::fork();
  if (child == 0) ::_exit(mount_file(source, target));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (status != 0)
    GTEST_SKIP() << "no file can be mounted here: " << std::strerror(WEXITSTATUS(status));
  const Result result = render(folder, {"-o", "target.exr"}, [&] { mount_file(source, target); });
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(read_exr(source).data_width, 24);
  EXPECT_EQ(test::read_file(target), "behind it");
  EXPECT_EQ(test::names_in(folder), (Names{"scene.pbrt", "source.exr", "target.exr"}));
}

TEST(Outputs, AFullDiskCostsNothing) {
  const fs::path folder = folder_with_scene(), disk = folder / "disk";
  fs::create_directory(disk);
  const test::SmallDisk small(disk);
  if (!small.mounted()) GTEST_SKIP() << "mount is not allowed";
  test::write_file(folder / "rays.txt", "0 0 5 0 0 -1\n");
  const std::vector<std::pair<std::string, Names>> outputs = {
      {"disk/out.exr", {"render", "scene.pbrt", "-q", "-o", "disk/out.exr"}},
      {"disk/stats.json",
       {"render", "scene.pbrt", "-q", "-o", "none", "--stats", "disk/stats.json"}},
#ifdef CAPLET_WITH_OIIO
      {"disk/out.png", {"render", "scene.pbrt", "-q", "-o", "none", "--preview", "disk/out.png"}},
#endif
      {"disk/out.csv", {"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "disk/out.csv"}},
      {"disk/out.npy", {"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "disk/out.npy"}},
      {"disk/heat.exr",
       {"verify", "scene.pbrt", "-q", "--rays", "10", "--heatmap", "disk/heat.exr"}}};
  for (const auto& [name, arguments] : outputs) {
    SCOPED_TRACE(name);
    fs::remove(disk / "filler");
    ASSERT_EQ(test::run_program(arguments, folder).code, 0);
    const std::uintmax_t whole = fs::file_size(folder / name),
                         page = static_cast<std::uintmax_t>(::getpagesize());
    test::write_file(folder / name, "what was there");
    small.leave((whole + page - 1) / page - 1);  // the last bytes find no room
    const Names names = test::names_in(disk);
    const Result result = test::run_program(arguments, folder);
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("caplet: error: " + name + ": cannot be written"));
    EXPECT_EQ(test::read_file(folder / name), "what was there");
    EXPECT_EQ(test::names_in(disk), names);
    fs::remove(folder / name);
  }
}

TEST(Outputs, AFullDeviceIsTold) {
  const fs::path folder = folder_with_scene();
  if (!make_device(folder / "full", 7)) GTEST_SKIP() << "mknod is not allowed";
  const Result result = render(folder, {"-o", "out.exr", "--stats", "full"});
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("full: cannot be written: No space left on device"));
  EXPECT_TRUE(fs::exists(folder / "out.exr"));
  for (const Names& arguments :
       {Names{"info", "scene.pbrt"}, Names{"info", "scene.pbrt", "--json"}, Names{"devices"},
        Names{"--help"}, Names{"render", "scene.pbrt", "-q", "-o", "none", "--stats", "-"}}) {
    const Result told = test::run_program(arguments, folder, {}, [&] {
      ::dup2(::open((folder / "full").c_str(), O_WRONLY), STDOUT_FILENO);
    });
    EXPECT_EQ(told.code, 1) << arguments[0];
    EXPECT_THAT(told.err, HasSubstr("cannot be written: No space left on device")) << arguments[0];
  }
}

// --- Standard streams ---

TEST(StandardStreams, AClosedStdoutIsToldAndGivenToNoFile) {
  const fs::path folder = folder_with_scene();
  const auto close_all = [] {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO}) ::close(stream);
  };
  const Result info = test::run_program({"info", "scene.pbrt"}, folder, {}, close_all);
  EXPECT_EQ(info.code, 1);
  EXPECT_THAT(info.err, HasSubstr("stdout cannot be written"));
  EXPECT_EQ(render(folder, {"-o", "out.exr"}, close_all).code, 0);
  EXPECT_EQ(read_exr(folder / "out.exr").data_width, 24);
}

TEST(StandardStreams, AReaderThatGoesDoesNotEndARender) {
  const fs::path folder = folder_with_scene();
  const auto to_nobody = [] {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(126);
    ::close(ends[0]);
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(ends[1], STDERR_FILENO);
  };
  EXPECT_EQ(
      test::run_program({"render", "scene.pbrt", "-o", "out.exr"}, folder, {}, to_nobody).code, 0);
  EXPECT_EQ(read_exr(folder / "out.exr").data_width, 24);
  EXPECT_EQ(test::run_program({"info", "scene.pbrt"}, folder, {}, to_nobody).code, 1);
}

// As after `| head`, which has seen enough.
TEST(StandardStreams, AReaderThatGoesIsNoNews) {
  const auto to_nobody = [] {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(126);
    ::close(ends[0]);
    ::dup2(ends[1], STDOUT_FILENO);
  };
  const Result help = test::run_program({"help", "render"}, folder_with_scene(), {}, to_nobody);
  EXPECT_EQ(help.code, 1);
  EXPECT_EQ(help.err, "");
}

TEST(StandardStreams, DashIsStdout) {
  const fs::path folder = folder_with_scene();
  const Result stats = render(folder, {"-o", "none", "--stats", "-"});
  EXPECT_EQ(stats.code, 0) << stats.err;
  EXPECT_EQ(nlohmann::json::parse(stats.out).at("samples_per_pixel"), 2);
  test::write_file(folder / "rays.txt", "0 0 5 0 0 -1\n");
  const Result rows =
      test::run_program({"pick", "scene.pbrt", "-q", "--rays", "rays.txt", "--out", "-"}, folder);
  EXPECT_EQ(rows.code, 0) << rows.err;
  EXPECT_EQ(test::lines_of(rows.out).size(), 2u);
  EXPECT_EQ(test::names_in(folder), (Names{"rays.txt", "scene.pbrt"}));
}

TEST(StandardStreams, RaysComeFromAFifo) {
  const fs::path folder = folder_with_scene();
  ASSERT_EQ(::mkfifo((folder / "rays").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo((folder / "rays.npy").c_str(), 0600), 0);
  std::thread writer([&] { test::write_file(folder / "rays", "0 0 5 0 0 -1\n0 0.1 5 0 0 -1\n"); });
  const Result result =
      test::run_program({"pick", "scene.pbrt", "-q", "--rays", "rays", "--out", "out.csv"}, folder);
  EXPECT_EQ(result.code, 0) << result.err;
  if (result.code != 0) ::close(::open((folder / "rays").c_str(), O_RDONLY | O_NONBLOCK));
  writer.join();
  EXPECT_EQ(test::lines_of(test::read_file(folder / "out.csv")).size(), 3u);
  // An array's length is in its file's.
  const Result array = test::run_program(
      {"pick", "scene.pbrt", "-q", "--rays", "rays.npy", "--out", "out.csv"}, folder);
  EXPECT_EQ(array.code, 2);
  EXPECT_THAT(array.err, HasSubstr("not a regular file"));
}

// --- Pictures ---

// A pixel's samples are its own, whatever else is rendered.
TEST(Pictures, BandsAreOfTheirRows) {
  constexpr std::size_t width = 2600, last = 20;
  const fs::path folder = folder_with_scene();
  // The last rows are of two bands.
  const auto height = 2 * static_cast<std::size_t>(band_rows(width, 22)) + 7;
  const std::string size = "2600x" + std::to_string(height);
  ASSERT_EQ(render(folder, {"-o", "whole.exr", "--size", size, "--spp", "2", "--variance"}).code,
            0);
  // Variances are those of three rows around, too.
  const std::string rest =
      "0," + std::to_string(height - last - 3) + ",2600," + std::to_string(height);
  ASSERT_EQ(
      render(folder, {"-o", "rows.exr", "--size", size, "--spp", "2", "--variance", "--crop", rest})
          .code,
      0);
  const LayeredImage whole = read_exr(folder / "whole.exr"), rows = read_exr(folder / "rows.exr");
  for (const char* name : {"R", "Z", "variance.G"}) {
    const std::vector<float>&all = whole.find(name)->floats, &some = rows.find(name)->floats;
    ASSERT_EQ(all.size(), width * height);
    ASSERT_EQ(some.size(), width * (last + 3));
    EXPECT_TRUE(std::equal(all.end() - width * last, all.end(), some.end() - width * last)) << name;
    EXPECT_GT(std::ranges::max(some), 0) << name;
  }
}

#ifdef CAPLET_WITH_OIIO
TEST(Pictures, APreviewAlone) {
  const fs::path folder = folder_with_scene();
  ASSERT_EQ(render(folder, {"-o", "out.exr", "--preview", "with.png"}).code, 0);
  const test::Result alone = render(folder, {"-o", "none", "--preview", "alone.png"});
  ASSERT_EQ(alone.code, 0);
  EXPECT_EQ(alone.err, "") << "libraries have nothing to say";
  EXPECT_EQ(test::names_in(folder), (Names{"alone.png", "out.exr", "scene.pbrt", "with.png"}));
  EXPECT_EQ(test::read_file(folder / "alone.png"), test::read_file(folder / "with.png"));
}

TEST(Pictures, ThePreviewHasEveryRow) {
  const fs::path folder = folder_with_scene();
  const std::string size = "2600x" + std::to_string(2 * band_rows(2600, 19) + 5);  // of three bands
  ASSERT_EQ(
      render(folder, {"-o", "out.exr", "--preview", "out.png", "--size", size, "--spp", "1"}).code,
      0);
  const EnvironmentImage shown = FileImageReader().read_rgb(folder / "out.png");
  LayeredImage picture = read_exr(folder / "out.exr");
  picture.chromaticities.reset();  // as single precision has them
  write_preview(folder / "again.png", picture);
  EXPECT_TRUE(shown.rgb == FileImageReader().read_rgb(folder / "again.png").rgb);
}

// The exposure is that of the whole picture, whose bands are of different light; the EXR stays.
TEST(Pictures, ThePreviewHasTheExposureThatIsAsked) {
  const fs::path folder = folder_with_scene();
  const int width = 2600, height = band_rows(width, 19) + 40;  // of two bands
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  ASSERT_EQ(render(folder, {"-o", "plain.exr", "--size", size, "--spp", "1"}).code, 0);
  LayeredImage picture = read_exr(folder / "plain.exr");
  picture.chromaticities.reset();  // as single precision has them
  for (const std::string asked : {"-1.25", "auto"}) {
    const bool is_automatic = asked == "auto";
    const Result result =
        test::run_program({"render", "scene.pbrt", "-o", "out.exr", "--preview", "out.png",
                           "--film", "out.film", "--size", size, "--spp", "1", "--exposure", asked},
                          folder);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err.find("exposure of previews: ") != std::string::npos, is_automatic);
    test::expect_equal_pictures(folder / "out.exr", folder / "plain.exr");
    picture.exposure = {is_automatic ? 0 : -1.25, is_automatic};
    write_preview(folder / "again.png", picture);
    EXPECT_TRUE(FileImageReader().read_rgb(folder / "out.png").rgb ==
                FileImageReader().read_rgb(folder / "again.png").rgb)
        << asked;
    ASSERT_EQ(test::run_program({"merge", "out.film", "-o", "sum.png"}, folder).code, 0);
    EXPECT_EQ(test::read_file(folder / "sum.png"), test::read_file(folder / "out.png")) << asked;
  }
}

TEST(Pictures, MeteringCountsNoPixelTwice) {
  std::string scene = test::small_scene;
  scene.insert(scene.find("Film \"rgb\"") + 10, " \"float iso\" 1e30 \"float exposure\" 0 ");
  scene.insert(scene.find("LightSource \"infinite\"") + 22, " \"rgb L\" [1e20 1e20 1e20] ");
  const fs::path folder = folder_with_scene(scene);
  for (const char* asked : {"0", "auto"})
    EXPECT_THAT(render(folder, {"-o", "a.exr", "--preview", "a.png", "--exposure", asked}).err,
                HasSubstr("384 of 384 pixels are beyond"))
        << asked;
}

TEST(Pictures, OverlaysLieOnAllBandsOfThePreview) {
  const fs::path folder = folder_with_scene();
  const int width = 2600, height = 1000;
  EXPECT_GT(height, band_rows(width, 4)) << "one band is all of it";
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  ASSERT_EQ(
      render(folder, {"-o", "none", "--preview", "plain.png", "--size", size, "--spp", "1"}).code,
      0);
  ASSERT_EQ(render(folder, {"-o", "none", "--preview", "bar.png", "--size", size, "--spp", "1",
                            "--scale-bar"})
                .code,
            0);
  const EnvironmentImage plain = FileImageReader().read_rgb(folder / "plain.png"),
                         bar = FileImageReader().read_rgb(folder / "bar.png");
  ASSERT_EQ(bar.rgb.size(), plain.rgb.size());
  // The bar lies at the bottom: a tenth of the picture is more than it and its margin take.
  const auto upper = static_cast<std::ptrdiff_t>(plain.rgb.size() / 10 * 9);
  EXPECT_TRUE(std::equal(plain.rgb.begin(), plain.rgb.begin() + upper, bar.rgb.begin()));
  EXPECT_FALSE(std::equal(plain.rgb.begin() + upper, plain.rgb.end(), bar.rgb.begin() + upper));
}

TEST(Pictures, PreviewsThatCannotBeWrittenAreFoundOutBefore) {
  const fs::path folder = folder_with_scene();
  for (const auto& [name, size] : std::vector<std::pair<std::string, std::string>>{
           {"out.jpg", "65501x1"}, {"out.jpeg", "1x70000"}, {"out.png", "1000001x1"}}) {
    const Result result = render(folder, {"-o", "none", "--preview", name, "--size", size});
    EXPECT_EQ(result.code, 2) << name;
    EXPECT_THAT(result.err, AllOf(HasSubstr("--size: '" + name + "'"),
                                  HasSubstr("larger than its format can hold")));
  }
  EXPECT_EQ(
      render(folder, {"-o", "none", "--preview", "out.jpg", "--size", "65500x1", "--spp", "1"})
          .code,
      0);
  EXPECT_EQ(test::names_in(folder), (Names{"out.jpg", "scene.pbrt"}));
}
#endif

TEST(Pictures, WhatCannotBeWrittenIsFoundOutBefore) {
  const fs::path folder = folder_with_scene();
  for (const char* size : {"1048577x1", "1x1048577"}) {
    const Result result = render(folder, {"-o", "out.exr", "--size", size});
    EXPECT_EQ(result.code, 2) << size;
    EXPECT_THAT(result.err, HasSubstr("--size: an EXR of "));
  }
  const Result nothing = render(folder, {"-o", "none"});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err,
              HasSubstr("-o: 'none' goes with --preview, --deep, --depth, --film or --stats"));
  EXPECT_EQ(test::names_in(folder), Names{"scene.pbrt"});
}

TEST(Pictures, AMillionPixelsInARow) {
  const fs::path folder = folder_with_scene();
  const Result result = render(folder, {"-o", "out.exr", "--size", "1000000x1", "--spp", "1"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(read_exr(folder / "out.exr").data_width, 1000000);
}

}  // namespace
}  // namespace caplet
