// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What outlives a session: saved files against the live scene, journals that were cut off, altered,
// left by a process that was killed, or are of another content.
#include "view/keep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.h"
#include "film/image.h"
#include "import/import.h"
#include "live_pictures.h"
#include "support/data.h"
#include "view/detail/keeping.h"
#include "view/detail/shown_view.h"

namespace caplet::view::keep_test {
namespace {

namespace fs = std::filesystem;
using test::picture_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

fs::path scene_file(const std::string& name = "scene.pbrt") {
  const fs::path file = test::temporary_folder() / name;
  put(file, test::some_text);
  return file;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder))
    out.push_back(entry.path().filename().string());
  std::ranges::sort(out);
  return out;
}

std::string move_line(std::uint32_t id, double x) {
  return nlohmann::json{{"type", "edit"},
                        {"what", "move"},
                        {"goes_on", false},
                        {"ids", {id}},
                        {"matrix", {1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}
      .dump();
}
constexpr const char *undo = R"({"type":"undo","again":false})",
                     *redo = R"({"type":"undo","again":true})";

/// A session of a scene's file, that ends as if it were killed.
struct Sitting {
  explicit Sitting(const fs::path& file)
      : keeper(std::make_unique<Keeper>(file)),
        live(import_scene(keeper->base(), FileImageReader())) {
    keeper->has_read({});
    keeping.emplace(live, editor, std::move(keeper));
  }
  bool say(const std::string& text) { return keeping->make(parse_message(text), text); }
  nlohmann::ordered_json save(std::optional<std::string> name = {}, bool replace = true) {
    return keeping->save({std::move(name), false, replace}, look_of_scene(live.scene()), {});
  }
  nlohmann::ordered_json told() const { return keeping->text(); }
  double x_of(std::uint32_t id) const { return live.scene().shapes[id].world_from_object[3].x; }

  std::unique_ptr<Keeper> keeper;
  LiveScene live;
  Editor editor{live};
  std::optional<Keeping> keeping;
};

TEST(Journal, HoldsItsLines) {
  const fs::path file = test::temporary_folder() / "j";
  Journal journal;
  ASSERT_TRUE(journal.begin(file, {"one", ""}));
  EXPECT_TRUE(journal.append("three, \xff\x01"));
  EXPECT_THAT(Journal::read(file), ElementsAre("one", "", "three, \xff\x01"));
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  EXPECT_THAT(Journal::read(file.string() + "x"), IsEmpty());
  EXPECT_THAT(Journal::read(file.parent_path()), IsEmpty());
  EXPECT_FALSE(Journal().append("x"));
  EXPECT_FALSE(journal.begin(file.parent_path() / "missing" / "j", {}));
}

TEST(Journal, EndsWhereItIsTornOrAltered) {
  const fs::path file = test::temporary_folder() / "j";
  {
    Journal journal;
    ASSERT_TRUE(journal.begin(file, {"first", "second", "third"}));
  }
  const std::string whole = text_of(file);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    put(file, whole.substr(0, length));
    const auto lines = static_cast<std::size_t>(std::ranges::count(whole.substr(0, length), '\n'));
    EXPECT_EQ(Journal::read(file).size(), lines) << length;
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string other = whole;
    other[at] ^= 1;
    put(file, other);
    EXPECT_EQ(Journal::read(file).size(),
              static_cast<std::size_t>(std::ranges::count(whole.substr(0, at), '\n')))
        << at;
  }
  // A line that is left out, lines in another order.
  const std::size_t second = whole.find('\n') + 1, third = whole.find('\n', second) + 1;
  put(file, whole.substr(0, second) + whole.substr(third));
  EXPECT_THAT(Journal::read(file), ElementsAre("first"));
  put(file, whole.substr(second, third - second) + whole.substr(0, second));
  EXPECT_THAT(Journal::read(file), IsEmpty());
}

TEST(FileHash, IsOfAllBytes) {
  const fs::path file = test::temporary_folder() / "f";
  std::string text((std::size_t{9} << 20) + 3, 'a');
  put(file, text);
  const std::string first = file_hash(file);
  EXPECT_EQ(first.size(), 32u);
  for (const std::size_t at : {std::size_t{0}, std::size_t{5} << 20, text.size() - 1}) {
    text[at] = 'b';
    put(file, text);
    EXPECT_NE(file_hash(file), first) << at;
    text[at] = 'a';
  }
  put(file, text);
  EXPECT_EQ(file_hash(file), first);
  EXPECT_EQ(file_hash(file.string() + "x"), "");
}

TEST(Keeping, ChangesAreThereAfterAKill) {
  const fs::path file = scene_file();
  {
    Sitting run(file);
    EXPECT_FALSE(run.told()["unsaved"]);
    run.say(move_line(1, 0.5));
    run.say(move_line(1, 0.25));
    run.say(move_line(3, 2));
    run.say(undo);
    EXPECT_TRUE(run.told()["unsaved"]);
    EXPECT_TRUE(run.told()["kept"]);
    EXPECT_THROW(run.say(move_line(99, 1)), InputError);
  }
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre(".scene.pbrt.unsaved", "scene.pbrt"));
  {
    Sitting run(file);
    EXPECT_EQ(run.x_of(1), 0.75);
    EXPECT_EQ(run.x_of(3), -1);
    EXPECT_EQ(run.told()["restored"], 4);
    EXPECT_TRUE(run.told()["unsaved"]);
    EXPECT_TRUE(run.say(redo));
    EXPECT_EQ(run.x_of(3), 1);
    EXPECT_TRUE(run.say(undo));
    EXPECT_TRUE(run.say(undo));
    EXPECT_EQ(run.x_of(1), 0.5);
    Sitting second(file);  // two at a time
    EXPECT_FALSE(second.told()["kept"]);
    EXPECT_EQ(second.x_of(1), 0);
    second.say(move_line(1, 7));
  }
  std::ofstream(file.parent_path() / ".scene.pbrt.unsaved", std::ios::app | std::ios::binary)
      << "0123456789abcdef {\"ty";  // torn
  {
    Sitting run(file);
    EXPECT_EQ(run.x_of(1), 0.5);
    EXPECT_TRUE(run.say(redo));
    EXPECT_EQ(run.x_of(1), 0.75);
  }
  Sitting run(file);
  EXPECT_EQ(run.x_of(1), 0.75);
  EXPECT_TRUE(run.say(undo));
  EXPECT_TRUE(run.say(undo));
  EXPECT_FALSE(run.say(undo));
  EXPECT_FALSE(run.told()["unsaved"]);
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre("scene.pbrt"));
  EXPECT_TRUE(run.say(redo));
  EXPECT_TRUE(run.told()["unsaved"]);
  EXPECT_EQ(run.keeping->end(), file.parent_path() / ".scene.pbrt.unsaved");
}

TEST(Keeping, NothingStaysOfASessionThatSaved) {
  const fs::path file = scene_file();
  Sitting run(file);
  run.say(move_line(1, 0.5));
  const std::vector<std::uint64_t> shown = picture_of(run.live);
  const auto told = run.save();
  EXPECT_EQ(told["type"], "saved");
  EXPECT_EQ(told["name"], "scene.pbrt");
  EXPECT_EQ(told["file"], file.string());
  EXPECT_FALSE(run.told()["unsaved"]);
  EXPECT_EQ(picture_of(LiveScene(import_scene(file, FileImageReader()))), shown);
  EXPECT_EQ(run.keeping->end(), std::nullopt);
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre("scene.pbrt"));
}

TEST(Keeping, UndoGoesBackBeyondASaveAlsoAfterAKill) {
  const fs::path file = scene_file();
  const std::vector<std::uint64_t> first =
      picture_of(LiveScene(import_scene(file, FileImageReader())));
  {
    Sitting run(file);
    run.say(move_line(1, 0.5));
    run.save();
    EXPECT_THAT(names_in(file.parent_path()), ElementsAre(".scene.unsaved.pbrt", "scene.pbrt"));
    run.say(move_line(1, 0.25));
    run.say(undo);
    EXPECT_FALSE(run.told()["unsaved"]);
    run.say(undo);  // beyond
    EXPECT_TRUE(run.told()["unsaved"]);
    EXPECT_EQ(run.x_of(1), 0);
  }
  {
    Sitting run(file);
    EXPECT_TRUE(run.told()["unsaved"]);
    EXPECT_EQ(run.x_of(1), 0);
    EXPECT_EQ(picture_of(run.live), first);
    EXPECT_TRUE(run.say(redo));
    EXPECT_FALSE(run.told()["unsaved"]);
    EXPECT_TRUE(run.say(redo));
    EXPECT_EQ(run.x_of(1), 0.75);
  }
  {
    Sitting run(file);
    EXPECT_EQ(run.x_of(1), 0.75);
    run.save();
  }
  // Killed after it had saved: what is there is what was saved.
  Sitting run(file);
  EXPECT_EQ(run.x_of(1), 0.75);
  EXPECT_FALSE(run.editor.can_undo());
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre("scene.pbrt"));
}

TEST(Keeping, AGestureThatGoesOnAfterASaveIsUnsaved) {
  const fs::path file = scene_file();
  const auto goes_on = [](double x) {
    nlohmann::json line = nlohmann::json::parse(move_line(1, x));
    line["goes_on"] = true;
    return line.dump();
  };
  {
    Sitting run(file);
    run.say(move_line(1, 0.5));
    run.say(goes_on(0.25));
    run.save();
    EXPECT_FALSE(run.told()["unsaved"]);
    run.say(goes_on(0.125));
    EXPECT_TRUE(run.told()["unsaved"]);
    EXPECT_EQ(run.x_of(1), 0.875);
  }
  {
    Sitting run(file);  // after a kill
    EXPECT_TRUE(run.told()["unsaved"]);
    EXPECT_EQ(run.x_of(1), 0.875);
    EXPECT_TRUE(run.say(undo));  // back to what is saved, not beyond
    EXPECT_EQ(run.x_of(1), 0.75);
    EXPECT_FALSE(run.told()["unsaved"]);
    EXPECT_TRUE(run.say(redo));
    EXPECT_TRUE(run.say(goes_on(0.5)));
    EXPECT_TRUE(run.say(R"({"type":"discard"})"));
    EXPECT_EQ(run.x_of(1), 0.75);
    EXPECT_TRUE(run.say(undo));
    EXPECT_EQ(run.x_of(1), 0);
    EXPECT_FALSE(run.editor.can_undo());
  }
  EXPECT_EQ(import_scene(file, FileImageReader()).shapes[1].world_from_object[3].x, 0.75);
}

TEST(Keeping, WhatCouldBeMadeAgainIsKeptWhereTheRestIsPutAside) {
  const fs::path file = scene_file(), journal = file.parent_path() / ".scene.pbrt.unsaved";
  {
    Sitting run(file);
    run.say(move_line(1, 0.5));
  }
  std::vector<std::string> lines = Journal::read(journal);
  ASSERT_EQ(lines.size(), 2u);
  lines.push_back(move_line(99, 1));  // of a thing that there is not
  lines.push_back(move_line(1, 7));   // after which nothing is made
  {
    Journal altered;
    ASSERT_TRUE(altered.begin(journal, lines));
  }
  for (int kills = 0; kills < 2; ++kills) {  // each before anything is changed
    Sitting run(file);
    EXPECT_EQ(run.x_of(1), 0.5);
    EXPECT_EQ(run.told()["restored"], 1);
    EXPECT_EQ(run.told()["old"], 2);
    EXPECT_THAT(Journal::read(journal), testing::SizeIs(2));
  }
  Sitting run(file);
  run.say(move_line(1, 0.25));
  EXPECT_THAT(Journal::read(journal), testing::SizeIs(3));
}

TEST(Keeping, ASecondSessionLeavesTheFirstOnesJournalAlone) {
  const fs::path file = scene_file(), journal = file.parent_path() / ".scene.pbrt.unsaved";
  std::optional<Sitting> first(std::in_place, file);
  first->say(move_line(1, 0.5));
  const std::string kept = text_of(journal);
  const auto is_second = [&] {
    Sitting second(file);
    EXPECT_FALSE(second.told()["kept"]);
    EXPECT_THAT(second.told()["why"].get<std::string>(), HasSubstr("another session"));
    second.say(move_line(1, 7));
    EXPECT_EQ(text_of(journal), kept);
    second.say(undo);  // which is all that it had
    EXPECT_EQ(text_of(journal), kept);
    second.say(redo);
    second.say(R"({"type":"discard"})");
    EXPECT_EQ(text_of(journal), kept);
    second.save("of the second");
    EXPECT_EQ(text_of(journal), kept);
    second.say(move_line(2, 1));
    EXPECT_EQ(second.keeping->end(), std::nullopt);
    EXPECT_EQ(text_of(journal), kept);
  };
  is_second();
  is_second();  // the one before has gone, and has left the first one's lock
  EXPECT_THAT(names_in(file.parent_path()),
              ElementsAre(".scene.pbrt.unsaved", "of the second.pbrt", "scene.pbrt"));
  first->say(move_line(1, 0.25));
  first.reset();  // killed
  Sitting run(file);
  EXPECT_TRUE(run.told()["kept"]);
  EXPECT_EQ(run.x_of(1), 0.75);
}

TEST(Keeping, FilesOfAnyNameCount) {
  const fs::path folder = test::temporary_folder(), file = folder / "whole.pbrt";
  // Journals are JSON: names that are no UTF-8 are found again all the same.
  for (const std::string name :
       {"K\xfcgel.pbrt", "\xed\xa0\x80 \xc3\xbc.pbrt", "bytes:\xff.pbrt", "K\xc3\xbcgel.pbrt"}) {
    put(folder / name, "Shape \"sphere\" \"float radius\" 1\n");
    put(file, "WorldBegin\nInclude \"" + name + "\"\nLightSource \"infinite\"\n");
    const auto session = [&] {
      auto keeper = std::make_unique<Keeper>(file);
      auto live = std::make_unique<LiveScene>(import_scene(keeper->base(), FileImageReader()));
      keeper->has_read({file.string(), (folder / name).string()});
      auto editor = std::make_unique<Editor>(*live);
      Keeping keeping(*live, *editor, std::move(keeper));
      const double x = live->scene().shapes[0].world_from_object[3].x;
      keeping.make(parse_message(move_line(0, 1)), move_line(0, 1));
      return x;
    };
    EXPECT_EQ(session(), 0) << name;
    EXPECT_EQ(session(), 1) << name;
    put(folder / name, "Shape \"sphere\" \"float radius\" 2\n");
    EXPECT_EQ(session(), 0) << name;  // another content
    for (const std::string& left : names_in(folder)) fs::remove(folder / left);
  }
}

TEST(Keeping, ChangesOfAnotherContentAreAskedAbout) {
  const fs::path file = scene_file();
  {
    Sitting run(file);
    run.say(move_line(1, 0.5));
    run.say(move_line(4, 1));
    run.say(move_line(1, 0.25));
  }
  std::string other = test::some_text;
  other.replace(other.find("0.6"), 3, "0.5");
  other.erase(other.find("AttributeBegin\n  AreaLight"),
              other.find("ObjectBegin") - other.find("AttributeBegin\n  AreaLight"));
  put(file, other);
  {
    Sitting run(file);
    EXPECT_EQ(run.x_of(1), 0);
    EXPECT_EQ(run.told()["old"], 3);
    EXPECT_FALSE(run.told()["unsaved"]);
    run.say(move_line(2, 1));
  }
  {
    Sitting run(file);
    EXPECT_EQ(run.told()["old"], 3);
    EXPECT_EQ(run.told()["restored"], 1);
    EXPECT_TRUE(run.say(R"({"type":"kept","restore":true})"));
    EXPECT_EQ(run.x_of(1), 0.75);
    EXPECT_EQ(run.x_of(2), 1);
    EXPECT_FALSE(run.told().contains("old"));
    EXPECT_THAT(names_in(file.parent_path()), ElementsAre(".scene.pbrt.unsaved", "scene.pbrt"));
  }
  put(file, test::some_text);
  Sitting run(file);
  EXPECT_EQ(run.told()["old"], 4);
  EXPECT_FALSE(run.say(R"({"type":"kept","restore":false})"));
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre("scene.pbrt"));
}

TEST(Keeping, TheSameFileReadOtherwiseIsAnotherContent) {
  const fs::path file = scene_file();
  const Keeper::ReadAs trace{{"style", "trace"}}, sticks{{"style", "sticks"}};
  {
    Keeper keeper(file, trace);
    keeper.has_read({});
    keeper.keep("{}");
  }
  {
    Keeper keeper(file, trace);
    EXPECT_THAT(keeper.lines(), ElementsAre("{}"));
  }
  for (const Keeper::ReadAs& other : {sticks, Keeper::ReadAs{}}) {
    Keeper keeper(file, other);
    EXPECT_THAT(keeper.lines(), IsEmpty());
    ASSERT_NE(keeper.old(), nullptr);
    EXPECT_THAT(keeper.old()->lines, ElementsAre("{}"));
  }
}

TEST(Keeping, FilesThatTheSceneNamesCountToo) {
  const fs::path folder = test::temporary_folder(), file = folder / "whole.pbrt",
                 part = folder / "part.pbrt";
  put(part, "Shape \"sphere\" \"float radius\" 1\n");
  put(file, "WorldBegin\nInclude \"part.pbrt\"\nLightSource \"infinite\"\n");
  {
    Sitting run(file);
    run.keeping.reset();
    auto keeper = std::make_unique<Keeper>(file);
    keeper->has_read({file.string(), part.string()});
    Keeping keeping(run.live, run.editor, std::move(keeper));
    keeping.make(parse_message(move_line(0, 1)), move_line(0, 1));
  }
  EXPECT_EQ(Sitting(file).x_of(0), 1);
  put(part, "Shape \"sphere\" \"float radius\" 2\n");
  Sitting run(file);
  EXPECT_EQ(run.x_of(0), 0);
  EXPECT_EQ(run.told()["old"], 1);
}

TEST(Keeping, DiscardGoesBackToWhatIsSaved) {
  const fs::path file = scene_file();
  Sitting run(file);
  run.say(move_line(1, 0.5));
  run.save();
  run.say(move_line(1, 0.5));
  run.say(move_line(2, 0.5));
  EXPECT_TRUE(run.say(R"({"type":"discard"})"));
  EXPECT_EQ(run.x_of(1), 0.5);
  EXPECT_EQ(run.x_of(2), 0);
  EXPECT_FALSE(run.told()["unsaved"]);
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre(".scene.unsaved.pbrt", "scene.pbrt"));
  EXPECT_FALSE(run.say(R"({"type":"discard"})"));
  run.say(undo);
  EXPECT_TRUE(run.say(R"({"type":"discard"})"));  // forwards
  EXPECT_EQ(run.x_of(1), 0.5);
  run.say(undo);
  run.say(move_line(2, 1));
  EXPECT_THROW(run.say(R"({"type":"discard"})"), InputError);
  EXPECT_EQ(run.x_of(2), 1);
}

TEST(Keeping, IsElsewhereWhereItCannotBeBesideTheScene) {
  const fs::path file = scene_file();
  fs::create_directories(file.parent_path() / ".scene.pbrt.unsaved" / "in the way");
  {
    Sitting run(file);
    run.say(move_line(1, 0.5));
    EXPECT_TRUE(run.told()["kept"]);
    EXPECT_NE(run.keeping->end()->parent_path(), file.parent_path());
  }
  Sitting run(file);
  EXPECT_EQ(run.x_of(1), 0.5);
  run.say(R"({"type":"discard"})");
  EXPECT_EQ(run.keeping->end(), std::nullopt);
}

TEST(Keeping, SaysWhatASavedFileWouldReplace) {
  const fs::path file = scene_file();
  put(file.parent_path() / "other.pbrt", "of somebody else");
  Sitting run(file);
  run.say(move_line(1, 0.5));
  const auto asked = run.save({}, false);
  EXPECT_EQ(asked["type"], "save_asks");
  EXPECT_THAT(asked["why"].get<std::string>(), HasSubstr("comments"));
  EXPECT_EQ(text_of(file), test::some_text);
  EXPECT_THAT(run.save("other", false)["why"].get<std::string>(), HasSubstr("other.pbrt is there"));
  EXPECT_EQ(text_of(file.parent_path() / "other.pbrt"), "of somebody else");
  EXPECT_EQ(run.save("mine", false)["type"], "saved");
  EXPECT_EQ(run.save("mine", false)["type"], "saved");  // its own
  EXPECT_EQ(run.told()["name"], "mine.pbrt");
  EXPECT_EQ(run.save({}, false)["name"], "mine.pbrt");
  std::ofstream(file.parent_path() / "mine.pbrt", std::ios::app) << "# by hand\n";
  EXPECT_THAT(run.save("mine", false)["why"].get<std::string>(), HasSubstr("changed since"));
  EXPECT_EQ(run.save("scene", true)["type"], "saved");
  EXPECT_EQ(run.save("scene", false)["type"], "saved");
  run.keeping->end();
  run.keeping.reset();
  Sitting next(file);
  EXPECT_EQ(next.save({}, false)["type"], "saved");  // written by the program
}

TEST(Keeping, SavesBesideTheSceneAlone) {
  const fs::path file = scene_file("neuron.pbrt");
  fs::create_symlink("/tmp", file.parent_path() / "link.pbrt");
  fs::create_directory(file.parent_path() / "folder.pbrt");
  Sitting run(file);
  for (const std::string& name :
       {std::string(), std::string("../x"), std::string("/tmp/x"), std::string("a/b"),
        std::string(".."), std::string(".hidden"), std::string("..\\x"), std::string("a\nb"),
        std::string("a\0b", 3), std::string("link"), std::string("folder"),
        std::string("link.pbrt/x")})
    EXPECT_THAT([&] { run.save(name); }, ThrowsMessage<InputError>(HasSubstr("name: '"))) << name;
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre("folder.pbrt", "link.pbrt", "neuron.pbrt"));
  EXPECT_EQ(run.save("ends.in.swc")["name"], "ends.in.swc.pbrt");
}

TEST(Keeping, NamesOtherFormatsAsPbrt) {
  const fs::path folder = test::temporary_folder();
  put(folder / "rods.capsules", "<0, 0, 0> <1, 0, 0> 0.5\n");
  put(folder / "cell.swc", "1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
  Sitting rods(folder / "rods.capsules"), cell(folder / "cell.swc");
  EXPECT_EQ(rods.save({}, false)["name"], "rods.pbrt");
  EXPECT_EQ(cell.save({}, false)["name"], "cell.pbrt");
  for (const char* name : {"rods", "cell"}) {
    const Sitting& run = name[0] == 'r' ? rods : cell;
    EXPECT_EQ(test::fresh_picture_of(
                  import_scene(folder / (std::string(name) + ".pbrt"), FileImageReader()), 1),
              picture_of(run.live, 1));
  }
}

TEST(Keeping, AFailedSaveLeavesAllAsItWas) {
  const fs::path file = scene_file();
  Sitting run(file);
  run.say(move_line(1, 0.5));
  EXPECT_ANY_THROW(
      run.keeping->save({{}, false, true}, look_of_scene(run.live.scene()), [] { return true; }));
  EXPECT_EQ(text_of(file), test::some_text);
  EXPECT_THAT(names_in(file.parent_path()), ElementsAre(".scene.pbrt.unsaved", "scene.pbrt"));
  EXPECT_TRUE(run.told()["unsaved"]);
}

TEST(Keeping, SavesTheViewWhereItIsAskedTo) {
  const fs::path file = scene_file();
  const Scene before = import_scene(file, FileImageReader());
  {
    Sitting run(file);
    ShowView look = look_of_scene(before);
    look.width = 777;
    look.fov = 0.5;
    look.world_from_camera[3].x += 1;
    look.clip = ClipPlane{{0, 0, 1}, 0.75};
    // The page's size and camera are not the scene's.
    View page = run.live.scene().view;
    page.film.width = 123;
    page.camera.projection = PerspectiveProjection{1};
    run.live.edit(page);
    run.save();
    Scene saved = import_scene(file, FileImageReader());
    EXPECT_EQ(saved.view.film.width, 40);
    EXPECT_EQ(fov_of(saved.view.camera), fov_of(before.view.camera));
    EXPECT_EQ(saved.view.camera.world_from_camera, before.view.camera.world_from_camera);
    run.keeping->save({{}, true, true}, look, {});
    saved = import_scene(file, FileImageReader());
    EXPECT_EQ(saved.view.film.width, 40);
    EXPECT_EQ(fov_of(saved.view.camera), 0.5);
    EXPECT_EQ(saved.view.camera.world_from_camera, look.world_from_camera);
    EXPECT_EQ(saved.view.clip.value().offset, 0.75);
    run.say(move_line(1, 0.5));
  }
  Sitting run(file);
  run.save();
  EXPECT_EQ(import_scene(file, FileImageReader()).view.clip.value().offset, 0.75);
  EXPECT_EQ(fov_of(import_scene(file, FileImageReader()).view.camera), 0.5);
}

TEST(KeptToken, StaysForOneAddressAndScene) {
  const fs::path folder = test::temporary_folder();
  const std::string token = kept_token("127.0.0.1", 1234, folder / "a.pbrt");
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(kept_token("127.0.0.1", 1234, folder / "a.pbrt"), token);
  EXPECT_NE(kept_token("127.0.0.1", 1235, folder / "a.pbrt"), token);
  EXPECT_NE(kept_token("127.0.0.1", 1234, folder / "b.pbrt"), token);
}

/// A change of a scene as a message.
std::string random_line(const Scene& scene, std::mt19937& engine) {
  const auto below = [&](std::size_t count) {
    return static_cast<std::uint32_t>(engine() % count);
  };
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine()) / 4294967296.0;
  };
  const auto things = static_cast<std::uint32_t>(scene.shapes.size() + scene.instances.size());
  std::vector<std::uint32_t> ids{below(things)};
  if (below(3) == 0 && ids[0] + 1 < things) ids.push_back(ids[0] + 1);
  nlohmann::json out{{"type", "edit"}, {"goes_on", below(5) == 0}};
  const std::uint32_t shape = below(scene.shapes.size());
  switch (below(9)) {
    case 0:
      out.update({{"what", "paint"},
                  {"ids", {shape}},
                  {"surface", nullptr},
                  {"material", below(scene.materials.size())}});
      break;
    case 1:
      out.update({{"what", "paint"},
                  {"ids", {shape}},
                  {"surface", below(surface_count(scene.shapes[shape]))},
                  {"material", below(scene.materials.size())}});
      break;
    case 2:
    case 3:
      if (things < 20) {
        out.update({{"what", "duplicate"},
                    {"ids", ids},
                    {"by", {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}}});
        break;
      }
      [[fallthrough]];
    case 4:
      if (things > 6) {
        out.update({{"what", "delete"}, {"ids", ids}});
        break;
      }
      [[fallthrough]];
    case 5:
      return below(2) ? undo : redo;
    case 6:
      if (std::holds_alternative<CapsulesShape>(scene.shapes[shape].geometry)) {
        out.update({{"what", "reshape"}, {"id", shape}, {"capsule", 0}});
        for (const char* end : {"p0", "p1"})
          out[end] = {uniform(-2, 2), uniform(-2, 2), uniform(0, 2)};
        for (const char* radius : {"radius0", "radius1"}) out[radius] = uniform(0.05, 0.5);
        break;
      }
      [[fallthrough]];
    default: {
      const double angle = uniform(-0.5, 0.5), c = std::cos(angle), s = std::sin(angle),
                   size = uniform(0.9, 1.1);
      out.update({{"what", "move"}, {"ids", ids}});
      out["matrix"] = {
          size * c, -size * s, 0,    uniform(-0.3, 0.3), size * s, size * c, 0, uniform(-0.3, 0.3),
          0,        0,         size, uniform(-0.2, 0.2), 0,        0,        0, 1};
    }
  }
  return out.dump();
}

TEST(Keeping, FiveHundredChangesAreInTheSavedFile) {
  const fs::path file = scene_file();
  std::mt19937 engine(15);
  auto run = std::make_unique<Sitting>(file);
  int made = 0, refused = 0;
  for (int i = 0; i < 500; ++i) {
    try {
      made += run->say(random_line(run->live.scene(), engine));
    } catch (const InputError&) {
      ++refused;
    }
    if (i % 10 != 9) continue;
    const std::vector<std::uint64_t> shown = picture_of(run->live, 4);
    if (i % 100 == 49) {  // killed, and started again
      const bool undoable = run->editor.can_undo();
      run.reset();
      run = std::make_unique<Sitting>(file);
      ASSERT_EQ(picture_of(run->live, 4), shown) << i;
      ASSERT_EQ(run->editor.can_undo(), undoable);
    }
    ASSERT_EQ(run->save(i % 20 == 9 ? std::optional<std::string>("copy") : std::nullopt)["type"],
              "saved");
    const fs::path saved = file.parent_path() / run->told()["name"].get<std::string>();
    ASSERT_EQ(test::fresh_picture_of(import_scene(saved, FileImageReader()), 4), shown) << i;
  }
  EXPECT_GT(made, 400);
  EXPECT_LT(refused, 60);
}

}  // namespace
}  // namespace caplet::view::keep_test
