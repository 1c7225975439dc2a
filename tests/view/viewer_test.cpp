// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A viewer as its pages meet it: the picture as a file against a render of the same scene, saving,
// and guests that mean harm.
#include "view/viewer.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <tuple>

#include "film/image.h"
#include "guests.h"
#include "import/import.h"
#include "live_pictures.h"
#include "support/data.h"
#include "view/server.h"

namespace caplet::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace fs = std::filesystem;
namespace websocket = beast::websocket;
using nlohmann::json;
using tcp = asio::ip::tcp;
using testing::HasSubstr;

using test::Guest;
using test::height;
using test::options_of;
using test::Place;
using test::width;

TEST(Viewer, ItsSnapshotIsTheRenderedPicture) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(4));
  Guest guest(Place(viewer.address()));
  guest.look(scene);
  guest.until_samples(4);
  guest.say({{"type", "snapshot"}});
  const fs::path file = test::temporary_folder() / "snapshot.exr";
  std::ofstream(file, std::ios::binary) << guest.until("");
  const LayeredImage shown = read_exr(file);
  Scene same = scene;
  same.view.film.width = width;
  same.view.film.height = height;
  const LayeredImage rendered = test::render_model(same, 4).image;
  EXPECT_EQ(shown.width, width);
  EXPECT_EQ(shown.height, height);
  for (const char* name : {"R", "G", "B", "variance.R", "variance.G", "variance.B"}) {
    ASSERT_TRUE(shown.find(name)) << name;
    EXPECT_EQ(shown.find(name)->floats, rendered.find(name)->floats) << name;
  }
  for (const char* name : {"object.id", "primitive.id"}) {
    ASSERT_TRUE(shown.find(name)) << name;
    EXPECT_EQ(shown.find(name)->uints, rendered.find(name)->uints) << name;
  }
}

TEST(Viewer, PagesKnowWhatIsUnderPictures) {
  for (const auto& [backdrop, told] :
       {std::pair<std::optional<Backdrop>, json>(std::nullopt, nullptr),
        {Backdrop{}, "transparent"},
        {Backdrop{Backdrop::Kind::color, {0.25, 0.5, 1}, nullptr}, {0.25, 0.5, 1}}}) {
    Scene scene = test::some_scene();
    scene.view.film.backdrop = backdrop;
    const Viewer viewer(LiveScene(std::move(scene)), test::test_device(), options_of(1));
    Guest guest(Place(viewer.address()));
    EXPECT_EQ(json::parse(guest.until("scene")).at("backdrop"), told);
    guest.say({{"type", "edit"}, {"what", "delete"}, {"goes_on", false}, {"ids", {1}}});
    EXPECT_EQ(json::parse(guest.until("edited")).at("backdrop"), told);
  }
}

TEST(Viewer, PagesKnowTheExposure) {
  for (const PreviewExposure exposure : {PreviewExposure{-1.5, false}, PreviewExposure{0, true}}) {
    Scene scene = test::some_scene();
    scene.view.film.exposure = exposure;
    const json told{{"stops", exposure.stops}, {"auto", exposure.is_automatic}};
    const Viewer viewer(LiveScene(std::move(scene)), test::test_device(), options_of(1));
    Guest guest(Place(viewer.address()));
    EXPECT_EQ(json::parse(guest.until("scene")).at("exposure"), told);
    guest.say({{"type", "edit"}, {"what", "delete"}, {"goes_on", false}, {"ids", {1}}});
    EXPECT_EQ(json::parse(guest.until("edited")).at("exposure"), told);
  }
}

// A click on the face of a solid that is cut finds the face; open surfaces have none.
TEST(Viewer, ClicksFindTheFacesOfCuts) {
  const std::string head =
      "Scale -1 1 1\nLookAt 0 0 10  0 0 0  0 1 0\nCamera \"orthographic\""
      " \"float screenwindow\" [-2 2 -2 2] \"float clipplane\" [0 0 1 0.25]\n"
      "Film \"rgb\" \"integer xresolution\" 96 \"integer yresolution\" 64\nWorldBegin\n"
      "LightSource \"infinite\"\n";
  const std::string sphere = "Shape \"sphere\" \"float radius\" 1\n",
                    disk = "ReverseOrientation\nShape \"disk\" \"float radius\" 1\n";
  const auto object = [](const std::string& shape) {
    return "ObjectBegin \"o\"\n" + shape + "ObjectEnd\nObjectInstance \"o\"\n";
  };
  for (const auto& [text, z, t] : {std::tuple{sphere, 0.25, 9.75},
                                   {object(sphere), 0.25, 9.75},
                                   {disk, 0.0, 10.0},
                                   {object(disk), 0.0, 10.0}}) {
    SCOPED_TRACE(text);
    const Viewer viewer(LiveScene(test::scene_of_text(head + text)), test::test_device(),
                        options_of(1));
    Guest guest(Place(viewer.address()));
    guest.say({{"type", "ask"},
               {"number", 1},
               {"x", width / 2},
               {"y", height / 2},
               {"all", false},
               {"reference", false}});
    const json crossing = json::parse(guest.until("answer")).at("pick").at("crossings").at(0);
    EXPECT_NEAR(crossing.at("point").at(2).get<double>(), z, 1e-5);
    EXPECT_NEAR(crossing.at("t").get<double>(), t, 1e-5);
    EXPECT_NEAR(crossing.at("normal").at(2).get<double>(), 1, 1e-5);
  }
}

TEST(Viewer, SavesWhatItsPagesMade) {
  const fs::path folder = test::temporary_folder(), file = folder / "scene.pbrt";
  std::ofstream(file) << test::some_text;
  std::vector<std::uint64_t> first, moved;
  {
    auto keeper = std::make_unique<Keeper>(file);
    Scene scene = import_scene(keeper->base(), FileImageReader());
    first = test::fresh_picture_of(scene);
    const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(2),
                        std::move(keeper));
    Guest guest(Place(viewer.address())), other(Place(viewer.address()));
    EXPECT_FALSE(json::parse(guest.until("scene"))["keep"]["unsaved"]);
    guest.look(scene);
    const std::uint32_t view = guest.until_samples(1).view;
    const json move{{"type", "edit"},
                    {"what", "move"},
                    {"goes_on", false},
                    {"ids", {1}},
                    {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
    guest.say(move);
    EXPECT_TRUE(json::parse(other.until("edited"))["keep"]["unsaved"]);
    EXPECT_GT(guest.until_samples(1, view).view, view);
    guest.say({{"type", "save"}, {"name", nullptr}, {"camera", false}, {"replace", false}});
    EXPECT_THAT(json::parse(guest.until("save_asks"))["why"].get<std::string>(),
                HasSubstr("comments"));
    guest.say({{"type", "save"}, {"name", "../moved"}, {"camera", false}, {"replace", true}});
    EXPECT_THAT(json::parse(guest.until("error"))["text"].get<std::string>(),
                HasSubstr("plain name"));
    guest.say({{"type", "save"}, {"name", "moved"}, {"camera", false}, {"replace", false}});
    EXPECT_EQ(json::parse(other.until("saved"))["file"], (folder / "moved.pbrt").string());
    scene.shapes[1].world_from_object[3].x += 0.5;
    moved = test::fresh_picture_of(scene);
    EXPECT_EQ(test::fresh_picture_of(import_scene(folder / "moved.pbrt", FileImageReader())),
              moved);
    guest.say(move);
    while (!json::parse(other.until("edited"))["keep"]["unsaved"]) {
    }
  }
  EXPECT_TRUE(fs::exists(folder / ".scene.pbrt.unsaved"));
  EXPECT_EQ(test::fresh_picture_of(import_scene(file, FileImageReader())), first);
}

TEST(Viewer, ThatIsReadOnlySavesNothing) {
  ViewerOptions options = options_of(1);
  options.read_only = true;
  const fs::path folder = test::temporary_folder(), file = folder / "scene.pbrt";
  std::ofstream(file) << test::some_text;
  const Viewer viewer(LiveScene(test::some_scene()), test::test_device(), options,
                      std::make_unique<Keeper>(file));
  Guest guest(Place(viewer.address()));
  for (const json& message :
       {json{{"type", "save"}, {"name", "x"}, {"camera", false}, {"replace", true}},
        json{{"type", "discard"}}, json{{"type", "kept"}, {"restore", true}}}) {
    guest.say(message);
    EXPECT_THAT(guest.until("error"), HasSubstr("read-only"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

// --- Guests that mean harm ---

std::size_t resident_bytes() {
  std::ifstream in("/proc/self/statm");
  std::size_t whole = 0, resident = 0;
  in >> whole >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// So many messages, right and wrong, from guests who come again when they are put out.
std::size_t flood(const Place& place, std::size_t count) {
  const std::string messages[] = {
      R"({"type":"ask","number":1,"x":3,"y":4,"all":true,"reference":true})",
      R"({"type":"describe","number":1,"id":3,"primitive":0})",
      R"({"type":"look"})",
      std::string(2000, '['),
      R"({"type":"edit","what":"delete","goes_on":false,"ids":[99]})",
      R"({"type":"undo","again":true})",
      R"({"type":"save","name":"../../x","camera":true,"replace":true})",
      R"({"type":"snapshot"})",
      std::string(60000, 'x'),
      "{\"type\":\"\xff\"}",
  };
  std::size_t sent = 0;
  while (sent < count) try {
      Guest guest(place);
      beast::error_code error;
      while (sent < count && !error) {
        guest.stream().write(asio::buffer(messages[sent % std::size(messages)]), error);
        ++sent;
      }
    } catch (const boost::system::system_error&) {  // no room, or put out
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  return sent;
}

void send_bytes(const Place& place, const std::string& bytes) {
  asio::io_context context;
  tcp::socket socket(context);
  beast::error_code error;
  socket.connect(place.endpoint(), error);
  asio::write(socket, asio::buffer(bytes), error);
}

/// Frames of all kinds that are none: reserved codes, no mask, parts of control frames, lengths
/// that are announced alone.
void send_wrong_frames(const Place& place, int count) {
  std::mt19937 engine(7);
  for (int i = 0; i < count; ++i) try {
      Guest guest(place);
      std::string frame{static_cast<char>(engine()), static_cast<char>(engine())};
      if (i % 4 == 0) frame = std::string("\x81\xff\0\0\0\0\x40\0\0\0\1\2\3\4", 14);  // a GB
      if (i % 4 == 1) frame = std::string("\x01\x85\1\2\3\4hello\x01\x85\1\2\3\4hello", 22);
      for (std::uint32_t k = engine() % 64; k > 0; --k) frame += static_cast<char>(engine());
      beast::error_code error;
      asio::write(guest.raw(), asio::buffer(frame), error);
    } catch (const boost::system::system_error&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST(Viewer, GoesOnWhateverItsGuestsDo) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(1 << 20));
  const Place place(viewer.address());
  Guest guest(place);
  guest.look(scene);
  guest.until_samples(1);
  const std::size_t before = resident_bytes();
  std::atomic<bool> done = false;
  std::atomic<std::size_t> most = 0;
  std::thread watch([&] {
    while (!done) {
      most = std::max<std::size_t>(most, resident_bytes());
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  });
  std::vector<std::unique_ptr<Guest>> deaf;
  for (int i = 0; i < 6; ++i) deaf.push_back(std::make_unique<Guest>(place));
  std::size_t sent = 0;
  std::atomic<int> views = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::vector<std::thread> harm;
  harm.emplace_back([&] {
    do {  // for as long as some pictures take, on a machine with other work too
      sent = flood(place, 100000);
    } while (views <= 5 && std::chrono::steady_clock::now() < end);
  });
  harm.emplace_back([&] { send_wrong_frames(place, 400); });
  harm.emplace_back([&] {
    asio::io_context context;
    std::vector<tcp::socket> silent;
    for (int i = 0; i < 100; ++i) {
      silent.emplace_back(context);
      beast::error_code error;
      silent.back().connect(place.endpoint(), error);
    }
    for (const std::string& target :
         {std::string("/../../etc/passwd"), place.path + "../../etc/passwd",
          place.path + "%2e%2e/x", "/" + std::string(5000, 'a') + "/"})
      for (int i = 0; i < 20; ++i)
        send_bytes(place,
                   fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\n\r\n", target, place.authority));
    for (int i = 0; i < 20; ++i)
      send_bytes(place, fmt::format("GET {}socket HTTP/1.1\r\nHost: {}\r\nOrigin: "
                                    "http://evil.example\r\nConnection: Upgrade\r\n"
                                    "Upgrade: websocket\r\nSec-WebSocket-Version: "
                                    "13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n",
                                    place.path, place.authority));
    send_bytes(place, std::string(std::size_t{8} << 20, 'x'));
  });
  // Meanwhile there are pictures of each view.
  std::uint32_t view = 0;
  std::thread harmed([&] {
    for (std::thread& each : harm) each.join();
    done = true;
  });
  while (!done && std::chrono::steady_clock::now() < end) {
    guest.look(scene, 0.01 * ++views);
    view = guest.until_samples(1, view).view;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  harmed.join();
  watch.join();
  EXPECT_EQ(sent, 100000u);
  EXPECT_GT(views, 5);
  RecordProperty("views", views.load());
  RecordProperty("grown_bytes", std::to_string(most - before));
  std::printf("  %d views meanwhile; memory grew by %.1f MB\n", views.load(),
              static_cast<double>(most - std::min<std::size_t>(most, before)) / 1e6);
#if !defined(__SANITIZE_ADDRESS__)
  // Each of the deaf may leave so much waiting as the server allows; 64 MiB are for all else.
  EXPECT_LT(most,
            before + deaf.size() * ServerOptions{}.most_waiting_bytes + (std::size_t{64} << 20));
#endif
  guest.look(scene, -1);
  EXPECT_GT(guest.until_samples(1, view).view, view);
}

}  // namespace
}  // namespace caplet::view
