// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes of a live scene: what it is after them, and after they are taken back, against the same
// changes by hand and the scene lowered afresh.
#include "view/editor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "base/error.h"
#include "live_pictures.h"
#include "view/detail/scene_text.h"

namespace caplet::view {
namespace {

using test::fresh_picture_of;
using test::picture_of;
using test::some_scene;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Editor, MovesShapesAndInstances) {
  LiveScene live(some_scene());
  Editor editor(live);
  const glm::dmat4 by =
      glm::rotate(glm::translate(glm::dmat4(1), {0.25, 0.5, 0.75}), 0.5, {0, 0, 1});
  const glm::dmat4 shape = live.scene().shapes[3].world_from_object,
                   instance = live.scene().instances[1].world_from_object;
  editor.make(Move{{3, 6}, by});
  EXPECT_EQ(live.scene().shapes[3].world_from_object, by * shape);
  EXPECT_EQ(live.scene().instances[1].world_from_object, by * instance);
  EXPECT_EQ(editor.rearrangements(), 0u);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(live.scene().shapes[3].world_from_object, shape);
  EXPECT_EQ(live.scene().instances[1].world_from_object, instance);
  EXPECT_FALSE(editor.undo());
  EXPECT_TRUE(editor.redo());
  EXPECT_EQ(live.scene().shapes[3].world_from_object, by * shape);
  EXPECT_FALSE(editor.redo());
}

/// Files that have a ball of the radius that the option `size` says.
SceneFiles balls() {
  SceneFiles files;
  files.options = {{"size", "R", "Radius", false}, {"color", "red|FILE", "Colour", false}};
  files.now = {{"color", "red"}};
  files.read = [](const FileOptions& options) {
    const auto size = options.find("size");
    return test::scene_of_text(
        "Camera \"perspective\" \"float fov\" 10\nWorldBegin\nLightSource \"distant\"\n"
        "Shape \"sphere\" \"string name\" \"file\" \"float radius\" " +
        (size == options.end() ? "1" : size->second) + "\n");
  };
  return files;
}

TEST(Editor, DrawsFilesAnew) {
  LiveScene live(some_scene());
  Editor editor(live, balls());
  const auto first = picture_of(live);
  const Scene before = live.scene();
  editor.make(Hide{{0}, false});
  editor.make(Redraw{{{"size", "0.5"}}});
  EXPECT_EQ(editor.files().now, (FileOptions{{"color", "red"}, {"size", "0.5"}}));
  ASSERT_EQ(live.scene().shapes.size(), 1u);
  EXPECT_EQ(std::get<SphereShape>(live.scene().shapes[0].geometry).radius, 0.5);
  EXPECT_TRUE(editor.hidden().empty());
  // The view, the lights and the name stay.
  EXPECT_EQ(fov_of(live.scene().view.camera), fov_of(before.view.camera));
  EXPECT_EQ(live.scene().view.film.width, 40);
  EXPECT_EQ(live.scene().lights.size(), before.lights.size());
  EXPECT_EQ(live.scene().source, before.source);
  EXPECT_EQ(picture_of(live), fresh_picture_of(live.scene()));
  // An empty text takes an option away.
  editor.make(Redraw{{{"size", ""}, {"color", ""}}});
  EXPECT_EQ(editor.files().now, FileOptions{});
  EXPECT_EQ(std::get<SphereShape>(live.scene().shapes[0].geometry).radius, 1);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.files().now, (FileOptions{{"color", "red"}, {"size", "0.5"}}));
  EXPECT_EQ(std::get<SphereShape>(live.scene().shapes[0].geometry).radius, 0.5);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.files().now, (FileOptions{{"color", "red"}}));
  EXPECT_EQ(editor.hidden().shapes.size(), 1u);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(picture_of(live), first);
  EXPECT_TRUE(editor.redo());
  EXPECT_TRUE(editor.redo());
  EXPECT_EQ(std::get<SphereShape>(live.scene().shapes[0].geometry).radius, 0.5);
}

// What belongs to the file is the new one's: its media, legend and unit. How it is seen stays.
TEST(Redrawn, KeepsHowTheSceneIsSeen) {
  SceneFiles files;
  files.read = [](const FileOptions&) {
    Scene out = test::scene_of_text(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nMediumInterface \"\" \"fog\"\n"
        "Camera \"perspective\" \"string unit\" \"mm\"\nWorldBegin\nShape \"sphere\"\n");
    out.source = "new";
    return out;
  };
  Scene before = some_scene();
  before.framing.up = glm::dvec3(0, 0, 1);
  before.automatic_camera = before.has_no_up = true;
  before.source = "old";
  before.view.clip = ClipPlane{{0, 0, 1}, 1};
  const Scene now = redrawn(files, {}, before);
  EXPECT_EQ(now.view.camera.medium, 0u);
  EXPECT_EQ(now.unit, "mm");
  EXPECT_EQ(now.shapes.size(), 1u);
  EXPECT_EQ(now.framing.up, before.framing.up);
  EXPECT_TRUE(now.automatic_camera);
  EXPECT_TRUE(now.has_no_up);
  EXPECT_EQ(now.source, "old");
  EXPECT_EQ(now.view.clip.value().offset, 1);
  EXPECT_EQ(now.lights.size(), before.lights.size());
}

TEST(Editor, RefusesOptionsThatFilesDoNotHave) {
  LiveScene live(some_scene());
  Editor editor(live, balls()), none(live);
  const auto refused = [](Editor& by, const FileOptions& options, const char* why) {
    EXPECT_THAT([&] { by.make(Redraw{options}); }, ThrowsMessage<InputError>(HasSubstr(why)));
  };
  refused(editor, {{"style", "sticks"}}, "style: the scene's files have no such option");
  refused(editor, {{"color", "/etc/passwd"}}, "may not name files of other folders");
  refused(editor, {{"size", "none"}}, "none");
  refused(none, {{"size", "1"}}, "the scene's files are not read again");
  EXPECT_EQ(editor.files().now, (FileOptions{{"color", "red"}}));
  EXPECT_FALSE(editor.can_undo());
}

TEST(Editor, ReshapesCapsulesInTheWorld) {
  LiveScene live(some_scene());
  Editor editor(live);
  editor.make(
      Reshape{3, 0, {-1, 0, 0}, {0, 0, 2}, 0.25, 0.5});  // of an object whose origin is at -1, 0, 0
  const Capsule now = capsule_at(live.scene(), {std::nullopt, 3}, 0);
  EXPECT_EQ(now.p0, glm::vec3(0, 0, 0));
  EXPECT_EQ(now.p1, glm::vec3(1, 0, 2));
  EXPECT_EQ(now.radius0, 0.25f);
  EXPECT_EQ(now.radius1, 0.5f);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(capsule_at(live.scene(), {std::nullopt, 3}, 0).p1, glm::vec3(0, 1, 0.5f));
}

TEST(Editor, TakesAGestureBackAsOne) {
  LiveScene live(some_scene());
  Editor editor(live);
  const glm::dmat4 before = live.scene().shapes[1].world_from_object,
                   step = glm::translate(glm::dmat4(1), {0.1, 0, 0});
  editor.make(Move{{1}, step});
  editor.make(Move{{1}, step}, true);
  editor.make(Move{{1}, step}, true);
  editor.make(Move{{2}, step}, true);  // another place: a change of its own
  EXPECT_TRUE(editor.undo());
  EXPECT_NE(live.scene().shapes[1].world_from_object, before);
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(live.scene().shapes[1].world_from_object, before);
  EXPECT_FALSE(editor.can_undo());
  EXPECT_TRUE(editor.redo());
  EXPECT_NEAR(live.scene().shapes[1].world_from_object[3].x, before[3].x + 0.3, 1e-12);
}

// A change that merges with the last one is a new state: what was undone before cannot come back.
TEST(Editor, MergingForgetsWhatWasUndone) {
  LiveScene live(some_scene());
  Editor editor(live);
  const glm::dmat4 step = glm::translate(glm::dmat4(1), {0.1, 0, 0});
  editor.make(Move{{1}, step});
  const std::uint64_t first = editor.state();
  editor.make(Move{{2}, step});
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.can_redo());
  editor.make(Move{{1}, step}, true);
  EXPECT_FALSE(editor.can_redo());
  EXPECT_NE(editor.state(), first);
}

TEST(Editor, PaintsSurfacesAndWholes) {
  LiveScene live(some_scene());
  Editor editor(live);
  const Shape& box = live.scene().shapes[2];
  const std::uint32_t gold = box.material;
  editor.make(Paint{{2}, 1, 0});
  ASSERT_EQ(live.scene().shapes[2].materials.size(), surface_count(live.scene().shapes[2]));
  for (std::size_t i = 0; i < live.scene().shapes[2].materials.size(); ++i)
    EXPECT_EQ(live.scene().shapes[2].materials[i], i == 1 ? 0u : gold) << i;
  editor.make(Paint{{1, 2}, std::nullopt, 0});
  EXPECT_TRUE(live.scene().shapes[2].materials.empty());
  EXPECT_EQ(live.scene().shapes[2].material, 0u);
  EXPECT_EQ(live.scene().shapes[1].material, 0u);
  EXPECT_EQ(editor.rearrangements(), 2u);
  EXPECT_EQ(editor.renumberings(), 0u);
  EXPECT_EQ(picture_of(live), fresh_picture_of(live.scene()));
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(live.scene().shapes[2].materials[1], 0u);
  EXPECT_EQ(live.scene().shapes[1].material, gold);
}

TEST(Editor, DuplicatesAndDeletes) {
  LiveScene live(some_scene());
  Editor editor(live);
  const std::vector<std::uint64_t> first = picture_of(live);
  editor.make(Duplicate{{1, 3, 5}, {0, 0, 1}});
  ASSERT_EQ(live.scene().shapes.size(), 7u);
  ASSERT_EQ(live.scene().instances.size(), 3u);
  EXPECT_EQ(editor.made(), (std::vector<std::uint32_t>{5, 6, 9}));  // 7 and 8: the instances before
  EXPECT_TRUE(std::holds_alternative<SphereShape>(live.scene().shapes[5].geometry));
  EXPECT_TRUE(std::holds_alternative<CapsulesShape>(live.scene().shapes[6].geometry));
  EXPECT_EQ(live.scene().shapes[5].world_from_object[3].z, 1);
  EXPECT_EQ(live.scene().instances[2].world_from_object[3].z,
            live.scene().instances[0].world_from_object[3].z + 1);
  EXPECT_EQ(editor.rearrangements(), 1u);
  EXPECT_EQ(editor.renumberings(), 1u);
  editor.make(Delete{{0, 2, 3, 8}});
  ASSERT_EQ(live.scene().shapes.size(), 4u);
  ASSERT_EQ(live.scene().instances.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<SphereShape>(live.scene().shapes[0].geometry));
  EXPECT_NE(picture_of(live), first);
  EXPECT_EQ(picture_of(live), fresh_picture_of(live.scene()));
  EXPECT_TRUE(editor.undo());
  ASSERT_EQ(live.scene().shapes.size(), 7u);
  EXPECT_TRUE(std::holds_alternative<DiskShape>(live.scene().shapes[0].geometry));
  EXPECT_TRUE(std::holds_alternative<CapsulesShape>(live.scene().shapes[3].geometry));
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(picture_of(live), first);
}

// What is left is the sky; pages look at the unit ball's place.
TEST(Editor, DeletesEverything) {
  LiveScene live(some_scene());
  Editor editor(live);
  const std::vector<std::uint64_t> first = picture_of(live);
  editor.make(Delete{{0, 1, 2, 3, 4, 5, 6}});
  EXPECT_TRUE(live.scene().shapes.empty() && live.scene().instances.empty());
  EXPECT_EQ(picture_of(live), fresh_picture_of(live.scene()));
  const auto bounds = scene_text(live.scene(), "", 1, 0).at("bounds");
  EXPECT_EQ(bounds, nlohmann::ordered_json::parse("[[-1.0,-1.0,-1.0],[1.0,1.0,1.0]]"));
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(picture_of(live), first);
  EXPECT_TRUE(editor.redo());
  EXPECT_NE(picture_of(live), first);
}

TEST(Editor, RefusesWhatCannotBe) {
  LiveScene live(some_scene());
  Editor editor(live);
  const std::vector<std::uint64_t> first = picture_of(live);
  const glm::dmat4 flat = glm::scale(glm::dmat4(1), {1, 0, 1}),
                   step = glm::translate(glm::dmat4(1), {1, 0, 0});
  EXPECT_THAT(
      [&] {
        editor.make(Move{{7}, step});
      },
      ThrowsMessage<InputError>(HasSubstr("no thing 7, of 7")));
  EXPECT_THROW(editor.make(Move{{1, 3}, flat}), InputError);
  EXPECT_THROW(editor.make(Move{{1, 99}, step}), InputError);
  EXPECT_THROW(editor.make(Reshape{3, 1, {}, {0, 0, 1}, 1, 1}), InputError);
  EXPECT_THROW(editor.make(Reshape{1, 0, {}, {0, 0, 1}, 1, 1}), InputError);
  EXPECT_THROW(editor.make(Reshape{6, 0, {}, {0, 0, 1}, 1, 1}), InputError);
  EXPECT_THROW(editor.make(Reshape{3, 0, {}, {0, 0, 1}, -1, 1}), InputError);
  EXPECT_THAT(
      [&] {
        editor.make(Paint{{1}, 0, 9});
      },
      ThrowsMessage<InputError>(HasSubstr("material")));
  EXPECT_THAT(
      [&] {
        editor.make(Paint{{1}, 5, 0});
      },
      ThrowsMessage<InputError>(HasSubstr("surface")));
  EXPECT_THROW(editor.make(Paint{{5}, std::nullopt, 0}), InputError);
  EXPECT_FALSE(editor.can_undo());
  EXPECT_EQ(live.scene().shapes.size(), 5u);
  EXPECT_EQ(picture_of(live), first);
}

/// The same by hand, on a plain scene.
void make_by_hand(Scene& scene, const Change& change) {
  const auto world = [&](std::uint32_t id) -> glm::dmat4& {
    return id < scene.shapes.size() ? scene.shapes[id].world_from_object
                                    : scene.instances[id - scene.shapes.size()].world_from_object;
  };
  if (const auto* move = std::get_if<Move>(&change)) {
    for (const std::uint32_t id : move->ids) world(id) = move->world_from_world * world(id);
  } else if (const auto* paint = std::get_if<Paint>(&change)) {
    for (const std::uint32_t id : paint->ids) {
      Shape& shape = scene.shapes[id];
      if (!paint->surface) {
        shape.material = paint->material;
        shape.materials.clear();
        continue;
      }
      shape.materials.resize(surface_count(shape), shape.material);
      shape.materials[*paint->surface] = paint->material;
    }
  } else if (const auto* copy = std::get_if<Duplicate>(&change)) {
    const std::size_t shapes = scene.shapes.size();
    for (const std::uint32_t id : copy->ids) {
      const bool is_shape = id < shapes;
      if (is_shape) {
        scene.shapes.push_back(Shape(scene.shapes[id]));
        scene.shapes.back().world_from_object =
            glm::translate(glm::dmat4(1), copy->by) * scene.shapes.back().world_from_object;
      } else {
        scene.instances.push_back(Instance(scene.instances[id - shapes]));
        scene.instances.back().world_from_object =
            glm::translate(glm::dmat4(1), copy->by) * scene.instances.back().world_from_object;
      }
    }
  } else if (const auto* drop = std::get_if<Delete>(&change)) {
    const std::size_t shapes = scene.shapes.size();
    for (auto id = drop->ids.rbegin(); id != drop->ids.rend(); ++id) {
      if (*id >= shapes)
        scene.instances.erase(scene.instances.begin() + static_cast<std::ptrdiff_t>(*id - shapes));
      else
        scene.shapes.erase(scene.shapes.begin() + *id);
    }
  }
}

TEST(Editor, FiveHundredChangesAreAsByHand) {
  LiveScene live(some_scene());
  Editor editor(live);
  std::vector<Scene> by_hand{live.scene()};  // after each change
  const std::vector<std::uint64_t> first = picture_of(live);
  std::mt19937 engine(20);
  const auto below = [&](std::size_t count) {
    return static_cast<std::uint32_t>(engine() % count);
  };
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine()) / 4294967296.0;
  };
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    const Scene& scene = live.scene();
    const auto things = static_cast<std::uint32_t>(scene.shapes.size() + scene.instances.size());
    std::vector<std::uint32_t> ids{below(things)};
    if (below(3) == 0 && ids[0] + 1 < things) ids.push_back(ids[0] + 1);
    const glm::dvec3 by(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    Change change = Move{ids, glm::rotate(glm::translate(glm::dmat4(1), 0.3 * by),
                                          uniform(-0.5, 0.5), glm::normalize(by))};
    switch (below(8)) {
      case 0:
        change = Paint{{below(scene.shapes.size())}, std::nullopt, below(scene.materials.size())};
        break;
      case 1: {
        const std::uint32_t id = below(scene.shapes.size());
        change = Paint{{id}, below(surface_count(scene.shapes[id])), below(scene.materials.size())};
        break;
      }
      case 2:
        if (things < 20) change = Duplicate{ids, by};
        break;
      case 3:
        if (things > 5) change = Delete{ids};
        break;
      case 4: {  // take some back, and make some of them again
        const std::uint32_t back = below(std::min<std::size_t>(6, by_hand.size() - 1) + 1);
        for (std::uint32_t k = 0; k < back; ++k) ASSERT_TRUE(editor.undo());
        const std::uint32_t again = below(back + 1);
        for (std::uint32_t k = 0; k < again; ++k) ASSERT_TRUE(editor.redo());
        by_hand.resize(by_hand.size() - back + again);
        break;
      }
      default:
        break;
    }
    Scene next = by_hand.back();
    if (live.scene().shapes.size() != next.shapes.size() ||
        live.scene().instances.size() != next.instances.size())
      FAIL() << i;
    const auto now = static_cast<std::uint32_t>(next.shapes.size() + next.instances.size());
    const bool is_there = std::visit(
        [&](const auto& it) {
          if constexpr (requires { it.ids; }) {
            return std::ranges::all_of(it.ids, [&](std::uint32_t id) { return id < now; });
          }
          return true;
        },
        change);
    try {
      editor.make(change);
      ASSERT_TRUE(is_there);
      make_by_hand(next, change);
      by_hand.push_back(std::move(next));
    } catch (const InputError&) {
      ++refused;  // after undos the thing may be gone, an instance or of other surfaces
    }
    if (i % 10 != 9) continue;
    ASSERT_EQ(picture_of(live), fresh_picture_of(by_hand.back())) << i;
  }
  EXPECT_LT(refused, 30);
  EXPECT_GT(by_hand.size(), 200u);
  while (editor.undo()) {
  }
  EXPECT_EQ(picture_of(live), first);
  while (editor.redo()) {
  }
  EXPECT_EQ(picture_of(live), fresh_picture_of(by_hand.back()));
}

}  // namespace
}  // namespace caplet::view
