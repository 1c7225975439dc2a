// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's XML scenes: what is refused and what is told, with its place, and rarer elements.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "import/import.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet::mistakes_test {
namespace {

using glm::dvec3;
using test::complaint;
using test::OneTexel;
using test::write_beside;
using testing::AllOf;
using testing::HasSubstr;

Scene scene_of(const std::string& inside, const std::string& name = "e.xml") {
  return import_scene(
      write_beside(name, "<?xml version=\"1.0\"?>\n<scene>\n" + inside + "</scene>\n"), OneTexel());
}
Scene seen_by(const std::string& options) {
  return import_scene(write_beside("v.ecs", options), OneTexel());
}

const std::string kTriangle =
    "<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 2</triangles>"
    "</TriangleMesh>\n";

std::string shaped(const std::string& material) {
  return "<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 2</triangles>\n" +
         material + "</TriangleMesh>\n";
}
std::string obj_material(const std::string& parameters) {
  return shaped("<material><code>\"OBJ\"</code><parameters>\n" + parameters +
                "</parameters></material>");
}

struct Case {
  std::string text, said;
};

TEST(EmbreeMistakes, AreRefusedWithTheirPlace) {
  write_beside("atoms.xyz", "1\n\nC 0 0 0\n");
  write_beside("broken.png", "");
  std::string many = kTriangle, row;
  for (int i = 0; i < 20; ++i) {
    const std::string name = "m" + std::to_string(i) + ".xml";
    write_beside(name, "<scene>" + kTriangle + "</scene>");
    many += "<xml src=\"" + name + "\"/>\n";
  }
  for (int i = 0; i < 3 * 11588; ++i) row += "0 ";
  const Case cases[] = {
      // With the file that names them these are 21.
      {many, "e.xml:23:2: more than 20 files"},
      {"<assign type=\"scene\" id=\"a\"/>", "e.xml:3:2: assigns neither a material nor a scene"},
      {"<assign type=\"light\" id=\"a\">" + kTriangle + "</assign>",
       "e.xml:3:2: assigns neither a material nor a scene"},
      {"<Transform>\n<Quaternion/>" + kTriangle + "</Transform>",
       "e.xml:4:2: turns by quaternions are not read"},
      {"<Transform>\n<QuaternionArray/>" + kTriangle + "</Transform>",
       "e.xml:4:2: turns by quaternions are not read"},
      {"\n<obj src=\"atoms.xyz\"/>",
       "atoms.xyz': files of the format xyz are not read within a scene of Embree"},
      {"<obj/>", "e.xml:3:2: names no file (src)"},
      {"<obj src=\"gone.obj\"/>", "e.xml:3:2: there is no file '"},
      {"\n<Points type=\"sphere\"><positions>0 0 0 -1</positions></Points>",
       "e.xml:4:2: a radius is negative"},
      // 11587^2 cells are 41,841 more than 2^27; their rows are all the same.
      {"\n<GridMesh><positions>" + row + "</positions><grids>0 0 11588 11588</grids></GridMesh>",
       "e.xml:4:2: grids of more than 2^27 cells"},
      {"<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><normals>0 0 1</normals>"
       "<triangles>0 1 2</triangles></TriangleMesh>",
       "e.xml:3:2: has another number of normals or texture coordinates than of points"},
      {"<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><texcoords>0 0 1 1</texcoords>"
       "<triangles>0 1 2</triangles></TriangleMesh>",
       "e.xml:3:2: has another number of normals or texture coordinates than of points"},
      {"<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions>\n<triangles>0 1 2 0</triangles>"
       "</TriangleMesh>",
       "e.xml:4:2: <triangles>: 4 indices are no rows of 3"},
      {obj_material("<string name=\"Kd\"/>"), "e.xml:5:2: 'string' is no type of a parameter"},
      {obj_material("<float5 name=\"Kd\"/>"), "e.xml:5:2: 'float5' is no type of a parameter"},
      {obj_material("<param name=\"Kd\" type=\"colour\"/>"),
       "e.xml:5:2: 'colour' is no type of a parameter"},
      {obj_material("<texture3d name=\"map_Kd\" src=\"broken.png\"/>"),
       "e.xml:4:2: these bytes are no picture"},
      // Its z is gone, along which it would shine.
      {kTriangle + "<DirectionalLight><AffineSpace scale=\"1 1 0\"/><E>1 1 1</E>"
                   "</DirectionalLight>",
       "e.xml:4:2: a light without a direction"},
      {kTriangle + "<SpotLight><I>1 1 1</I><angleMin>1</angleMin></SpotLight>",
       "e.xml:4:2: <SpotLight> has no <angleMax>"},
      {kTriangle + "<PerspectiveCamera from=\"0 0 0\" to=\"0 0 1\" up=\"0 1 0\" fov=\"179\"/>",
       "e.xml:4:2: a field of view of 179 degrees"},
      {kTriangle + "<PerspectiveCamera from=\"0 0 0\" to=\"0 0 1\" up=\"0 1 0\" fov=\"0\"/>",
       "e.xml:4:2: a field of view of 0 degrees"},
  };
  for (const Case& one : cases)
    EXPECT_THAT(complaint([&] { scene_of(one.text); }), HasSubstr(one.said));
}

// Each level holds the one before twice: the 23rd begins 2^23 elements, of which none is drawn.
TEST(EmbreeMistakes, AreElementsWithoutEnd) {
  std::string doubled = kTriangle + "<Group id=\"0\"/>\n";
  for (int i = 1; i <= 23; ++i)
    doubled += "<Group id=\"" + std::to_string(i) + "\"><ref id=\"" + std::to_string(i - 1) +
               "\"/><ref id=\"" + std::to_string(i - 1) + "\"/></Group>\n";
  EXPECT_THAT(complaint([&] { scene_of(doubled); }),
              AllOf(HasSubstr("e.xml:"), HasSubstr("more than 4000000 elements are placed")));
}

TEST(EmbreeMistakes, OfTheViewersOptions) {
  write_beside("good.xml", "<scene>" + kTriangle + "</scene>");
  write_beside("other.xml", "<?xml version=\"1.0\"?>\n<mujoco/>\n");
  const Case cases[] = {
      {"-i other.xml\n",
       "other.xml:2:2: the root element is not <scene>: this is no scene of Embree"},
      {"-i good.xml\n-size 0 5\n", "v.ecs:2:1: is no size of a picture"},
      {"-i good.xml\n -size 5 65537\n", "v.ecs:2:2: is no size of a picture"},
      {"-i good.xml\n-size 5 1.5\n", "v.ecs:2:1: is no size of a picture"},
      {"-i good.xml -fov\n", "v.ecs:1:13: '-fov' ends early"},
      {"-i good.xml 7\n", "v.ecs:1:13: '7' is no option"},
      {"-i good.xml -dirlight 0 0 0 1 1 1\n", "v.ecs:1:13: a light without a direction"},
  };
  for (const Case& one : cases)
    EXPECT_THAT(complaint([&] { seen_by(one.text); }), HasSubstr(one.said));
}

TEST(EmbreeNotes, AreToldWithTheirPlace) {
  const std::string points = "<positions>0 0 0 1 0 4 0 2</positions>";
  const std::string moved = "what moves is drawn as at its first moment";
  const Case cases[] = {
      {"<Animation>" + kTriangle + "</Animation>", moved},
      {"<Transform><AffineSpace translate=\"1 0 0\"/><AffineSpace translate=\"2 0 0\"/>\n\n"
       "<PointLight><position>0 0 0</position><I>1 1 1</I></PointLight>" +
           kTriangle + "</Transform>",
       "e.xml:6:2: lights do not move"},
      {"<AnimatedPerspectiveCamera><PerspectiveCamera from=\"1 2 3\" to=\"5 2 3\" up=\"0 0 2\" "
       "fov=\"60\"/><PerspectiveCamera from=\"1 2 3\" to=\"5 2 3\" up=\"0 0 2\" fov=\"50\"/>"
       "</AnimatedPerspectiveCamera>",
       "the field of view stays as at its first moment"},
      {"<Transform><AffineSpace translate=\"1 0 0\"/><AffineSpace translate=\"2 0 0\"/>\n"
       "<AnimatedPerspectiveCamera><PerspectiveCamera from=\"1 2 3\" to=\"5 2 3\" up=\"0 0 2\" "
       "fov=\"60\"/><PerspectiveCamera from=\"1 2 3\" to=\"6 2 3\" up=\"0 0 2\" fov=\"60\"/>"
       "</AnimatedPerspectiveCamera></Transform>",
       "e.xml:5:2: a camera that moves within what moves does not go with it"},
      // Cones do not move, and capsules that become more cannot.
      {"<ConeSegments><animated_positions>" + points + points +
           "</animated_positions><indices>0</indices></ConeSegments>",
       moved},
      {"<RoundLineSegments><animated_positions><positions>0 0 0 1 0 4 0 2 0 8 0 2</positions>"
       "<positions>0 0 0 1 0 4 0 0 0 8 0 0</positions></animated_positions><indices>0 1</indices>"
       "</RoundLineSegments>",
       moved},
      {"<Points type=\"sphere\"><animated_positions>" + points +
           "<positions>0 0 0 1 0 4 0 0</positions></animated_positions></Points>",
       moved},
      {"<SubdivisionMesh/>", "<SubdivisionMesh> is left out"},
      {"<FurBall/>", "<FurBall> is left out"},
      {"<AnimatedLight/>", "<AnimatedLight> is left out"},
      {"<Curves type=\"normal_oriented\" basis=\"hermite\">" + points +
           "<tangents>0 1 0 0 0 1 0 0</tangents><indices>0</indices></Curves>",
       "curves that are oriented by normals are drawn as round ones"},
      {"<Curves type=\"flat\" basis=\"linear\">" + points + "<indices>0</indices></Curves>",
       "flat curves are drawn as round ones"},
      {"<Points type=\"disc\">" + points + "</Points>", "points that are discs are drawn as balls"},
      {"<Points type=\"oriented\">" + points + "</Points>",
       "points that are discs are drawn as balls"},
      {"<RoundLineSegments><positions>0 0 0 0 0 4 0 0</positions><indices>0</indices>"
       "</RoundLineSegments>",
       "what has no thickness is left out"},
      {"<ConeSegments><positions>0 0 0 0 0 4 0 0</positions><indices>0</indices></ConeSegments>",
       "cones without length or thickness are left out"},
      {"<ConeSegments><positions>0 4 0 1 0 4 0 2</positions><indices>0</indices></ConeSegments>",
       "cones without length or thickness are left out"},
  };
  for (const Case& one : cases) {
    test::LogOf log;
    scene_of(kTriangle + one.text);
    EXPECT_THAT(log.text(),
                HasSubstr(one.said.starts_with("e.xml:") ? one.said : "e.xml:4:2: " + one.said));
  }
  test::LogOf log;
  scene_of(shaped("<material id=\"nowhere\"/>"));
  EXPECT_THAT(log.text(), HasSubstr("e.xml:4:2: a material is defined nowhere: it is grey"));
}

TEST(EmbreeNotes, AreOfNothingElse) {
  const std::string points = "<positions>0 0 0 1 0 4 0 2</positions>";
  test::LogOf log;
  scene_of("<Points type=\"sphere\">" + points +
           "</Points><Curves type=\"round\" basis=\"linear\">" + points +
           "<indices>0</indices></Curves><RoundLineSegments>" + points +
           "<indices>0</indices></RoundLineSegments><ConeSegments>" + points +
           "<indices>0</indices></ConeSegments><Transform><AffineSpace translate=\"1 0 0\"/>" +
           kTriangle +
           "<PointLight><AffineSpace translate=\"1 0 0\"/><I>1 1 1</I></PointLight>"
           "</Transform><PerspectiveCamera from=\"0 0 0\" to=\"0 0 1\" up=\"0 1 0\" fov=\"60\"/>");
  EXPECT_EQ(log.text(), "");
}

// What the notes above tell is drawn all the same, or not.
TEST(EmbreeNotes, AreOfWhatIsDrawn) {
  const std::string points = "<positions>1 2 3 .5 4 5 6 .25</positions>";
  for (const char* type : {"sphere", "disc", "oriented"}) {
    const CapsulesShape balls = test::capsules_of(
        scene_of("<Points type=\"" + std::string(type) + "\">" + points + "</Points>"));
    EXPECT_EQ(balls.p0, (std::vector<glm::vec3>{{1, 2, 3}, {4, 5, 6}})) << type;
    EXPECT_EQ(balls.radius0, (std::vector<float>{0.5F, 0.25F})) << type;
  }
  const auto curve = [&](const std::string& type) {
    return test::capsules_of(scene_of("<Curves type=\"" + type + "\" basis=\"hermite\">" + points +
                                      "<tangents>1 0 0 0 0 1 0 0</tangents><indices>0</indices>"
                                      "</Curves>"));
  };
  EXPECT_GT(curve("round").p0.size(), 1U);
  EXPECT_EQ(curve("normal_oriented").p0, curve("round").p0);
  // The second of three has no thickness; of the cones the one without length is not there.
  const CapsulesShape thick = test::capsules_of(
      scene_of("<RoundLineSegments><positions>0 0 0 1 0 1 0 0 0 2 0 0 0 3 0 2</positions>"
               "<indices>0 1 2</indices></RoundLineSegments>"));
  EXPECT_EQ(thick.p0, (std::vector<glm::vec3>{{0, 0, 0}, {0, 2, 0}}));
  EXPECT_EQ(thick.radius1, (std::vector<float>{0, 2}));
  const Scene cones = scene_of(
      "<ConeSegments><positions>0 0 0 1 0 1 0 2 0 1 0 3 0 2 0 0 0 3 0 0</positions>"
      "<indices>0 1 2 3</indices></ConeSegments>");
  ASSERT_EQ(cones.shapes.size(), 2U);
  EXPECT_EQ(std::get<ConeShape>(cones.shapes[0].geometry).radius, (std::array<double, 2>{1, 2}));
  EXPECT_EQ(std::get<ConeShape>(cones.shapes[1].geometry).radius, (std::array<double, 2>{3, 0}));
  for (const char* nothing : {"<SubdivisionMesh/>", "<FurBall/>", "<AnimatedLight/>",
                              "<RoundLineSegments><animated_positions/></RoundLineSegments>"})
    EXPECT_EQ(scene_of(kTriangle + nothing).shapes.size(), 1U) << nothing;
}

// Points, lines, curves and meshes at time steps, which are evenly in a second.
TEST(EmbreeScenes, PointsAtTimeStepsMove) {
  test::LogOf log;
  const CapsulesShape line = test::capsules_of(
      scene_of("<RoundLineSegments><animated_positions><positions>0 0 0 1 0 4 0 2</positions>"
               "<positions>1 0 0 1 0 4 3 2</positions><positions>2 0 0 3 0 4 0 2</positions>"
               "</animated_positions><indices>0</indices></RoundLineSegments>"));
  EXPECT_EQ(line.times, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(line.p0, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(line.p1, (std::vector<glm::vec3>{{0, 4, 0}, {0, 4, 3}, {0, 4, 0}}));
  EXPECT_EQ(line.radius0, (std::vector<float>{1, 1, 3}));
  EXPECT_EQ(line.radius1, (std::vector<float>{2, 2, 2}));
  const CapsulesShape ball = test::capsules_of(
      scene_of("<Points type=\"sphere\"><animated_positions><positions>0 0 0 1</positions>"
               "<positions>0 0 5 2</positions></animated_positions></Points>"));
  EXPECT_EQ(ball.p1, (std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 5}}));
  EXPECT_EQ(ball.times, (std::vector<double>{0, 1}));
  // A curve that is moved as a whole has the same chords, and tangents turn it.
  const CapsulesShape curve = test::capsules_of(scene_of(
      "<Curves type=\"round\" basis=\"hermite\"><animated_positions><positions>0 0 0 1 0 4 0 1"
      "</positions><positions>0 0 2 1 0 4 2 1</positions></animated_positions><animated_tangents>"
      "<tangents>1 0 0 0 1 0 0 0</tangents><tangents>1 0 0 0 1 0 0 0</tangents>"
      "</animated_tangents><indices>0</indices></Curves>"));
  const std::size_t half = curve.p0.size() / 2;
  ASSERT_GT(half, 1U);
  for (std::size_t i = 0; i < half; ++i)
    EXPECT_LT(glm::length(curve.p0[half + i] - curve.p0[i] - glm::vec3(0, 0, 2)), 1e-6F);
  const Scene meshes = scene_of(
      "<TriangleMesh><animated_positions><positions>0 0 0 1 0 0 0 1 0</positions><positions>0 0 1 "
      "1 0 "
      "1 0 1 3</positions></animated_positions><animated_normals><normals>0 0 1 0 0 1 0 0 "
      "1</normals>"
      "<normals>0 1 0 0 1 0 0 1 0</normals></animated_normals><triangles>0 1 2</triangles>"
      "</TriangleMesh>");
  const auto& mesh = std::get<TriangleMeshShape>(meshes.shapes.at(0).geometry);
  EXPECT_EQ(mesh.times, (std::vector<double>{0, 1}));
  EXPECT_EQ(mesh.positions.at(5), glm::vec3(0, 1, 3));
  EXPECT_EQ(mesh.normals.at(3), glm::vec3(0, 1, 0));
  EXPECT_EQ(log.text(), "");
}

TEST(EmbreeScenes, AnimationsAreAtTheirFirstMoment) {
  const Scene scene =
      scene_of("<Animation>" + kTriangle + "<Transform><AffineSpace translate=\"1 0 0\"/>" +
               kTriangle + "</Transform></Animation>");
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(dvec3(scene.shapes[0].world_from_object[3]), dvec3(0));
  EXPECT_TRUE(scene_of(kTriangle + "<AnimatedPerspectiveCamera/>").automatic_camera);
}

// A double's least number is about 5e-324.
TEST(EmbreeScenes, NumbersThatUnderflowAreZero) {
  const CapsulesShape all = test::capsules_of(
      scene_of("<RoundLineSegments><positions>1e-400 -1e-400 7 1 0 4 0 2</positions>"
               "<indices>0</indices></RoundLineSegments>"));
  EXPECT_EQ(all.p0, (std::vector<glm::vec3>{{0, 0, 7}}));
}

// Bits 1 and 2 of a byte: a neighbour at the first and at the second end.
TEST(EmbreeScenes, FlagsMayBeInTheCompanion) {
  write_beside("flags.bin", std::string("\x07\x02\x01", 3));
  const Scene scene = scene_of(
      "<ConeSegments><positions>0 0 0 1 0 4 0 2 0 5 0 3</positions><indices>0 1</indices>"
      "<flags ofs=\"1\" size=\"2\"/></ConeSegments>",
      "flags.xml");
  ASSERT_EQ(scene.shapes.size(), 2U);
  EXPECT_EQ(std::get<ConeShape>(scene.shapes[0].geometry).caps,
            (std::array<Cap, 2>{Cap::flat, Cap::open}));
  EXPECT_EQ(std::get<ConeShape>(scene.shapes[1].geometry).caps,
            (std::array<Cap, 2>{Cap::open, Cap::flat}));
}

TEST(EmbreeScenes, MaterialsHaveImages) {
  const std::filesystem::path image = write_beside("a.png", "");
  for (const std::string parameter :
       {"<texture3d name=\"map_Kd\" src=\"a.png\"/>", "<texture name=\"map_Kd\" src=\"a.png\"/>",
        "<param name=\"map_Kd\" type=\"texture\" src=\"a.png\"/>"}) {
    const Scene scene = scene_of(obj_material(parameter));
    const Material& material = scene.materials.at(scene.shapes.at(0).material);
    ASSERT_EQ(material.textures.size(), 1U) << parameter;
    EXPECT_EQ(material.textures[0].field, "reflectance");
    EXPECT_EQ(std::get<ImagemapTexture>(scene.textures.at(material.textures[0].texture).model)
                  .image->file,
              image.string());
  }
  const Scene cut = scene_of(obj_material("<texture3d name=\"map_d\" src=\"a.png\"/>"));
  EXPECT_TRUE(cut.materials.at(cut.shapes.at(0).material).textures.empty());
  ASSERT_TRUE(cut.shapes[0].alpha.has_value());
  EXPECT_EQ(cut.shapes[0].alpha->texture, 0U);
}

TEST(EmbreeScenes, SpotLightsHaveTwoAngles) {
  const auto spot = [](const std::string& angles) {
    const Scene scene =
        scene_of(kTriangle + "<SpotLight><AffineSpace>0 0 2 4  1 0 0 5  0 1 0 6</AffineSpace>" +
                 "<I>1 2 3</I>" + angles + "</SpotLight>");
    return std::get<SpotLight>(scene.lights.at(0).model);
  };
  const SpotLight light = spot("<angleMin>15</angleMin><angleMax>30</angleMax>");
  EXPECT_EQ(std::get<RgbSpectrum>(light.intensity).rgb, dvec3(1, 2, 3));
  EXPECT_EQ(light.position, dvec3(4, 5, 6));
  EXPECT_LT(glm::length(light.direction - dvec3(1, 0, 0)), 1e-12);  // along z, which is 2 0 0
  EXPECT_NEAR(light.total_angle, std::acos(-1.0) / 6, 1e-12);
  EXPECT_NEAR(light.falloff_start_angle, std::acos(-1.0) / 12, 1e-12);
  const SpotLight swapped = spot("<angleMin>40</angleMin><angleMax>30</angleMax>");
  EXPECT_EQ(swapped.falloff_start_angle, swapped.total_angle);
}

TEST(EmbreeScenes, TriangleLightsShineFromBothSides) {
  const Scene scene = scene_of(
      kTriangle + "<TriangleLight><AffineSpace translate=\"3 0 0\"/><L>1 2 3</L></TriangleLight>");
  ASSERT_EQ(scene.shapes.size(), 2U);
  const Shape& light = scene.shapes[1];
  EXPECT_EQ(dvec3(light.world_from_object[3]), dvec3(3, 0, 0));
  const auto& mesh = std::get<TriangleMeshShape>(light.geometry);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  const auto corner = [&](std::size_t k) { return mesh.positions.at(mesh.triangles[0].at(k)); };
  EXPECT_EQ(glm::cross(corner(1) - corner(0), corner(2) - corner(0)), glm::vec3(0, 0, 1));
  EXPECT_EQ(corner(0) + corner(1) + corner(2), glm::vec3(1, 1, 0));
  ASSERT_TRUE(light.emission.has_value());
  EXPECT_TRUE(light.emission->two_sided);
  EXPECT_EQ(std::get<RgbSpectrum>(light.emission->radiance).rgb, dvec3(1, 2, 3));
}

TEST(EmbreeScenes, TheViewersDirectionAndLights) {
  write_beside("good.xml", "<scene>" + kTriangle + "</scene>");
  const Scene scene = seen_by(
      "-i good.xml -vp 1 2 3 -vd 0 0 -5 -vu 0 1 0 -size 7 65536\n"
      "-pointlight 4 5 6 1 2 3\n-dirlight 0 2 0 3 2 1\n-directionallight 3 0 0 1 1 1\n"
      "-distantlight 0 0 -1 1 1 1 90\n");
  EXPECT_EQ(scene.view.film.width, 7);
  EXPECT_EQ(scene.view.film.height, 65536);
  EXPECT_EQ(dvec3(scene.view.camera.world_from_camera[3]), dvec3(1, 2, 3));
  EXPECT_LT(glm::length(dvec3(scene.view.camera.world_from_camera[2]) - dvec3(0, 0, -1)), 1e-12);
  ASSERT_EQ(scene.lights.size(), 4U);
  const auto& point = std::get<PointLight>(scene.lights[0].model);
  EXPECT_EQ(point.position, dvec3(4, 5, 6));
  EXPECT_EQ(std::get<RgbSpectrum>(point.intensity).rgb, dvec3(1, 2, 3));
  const dvec3 directions[] = {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(
        glm::length(std::get<DistantLight>(scene.lights[i + 1].model).direction - directions[i]),
        1e-12)
        << i;
  // Half of the sky, of the radiance 1, sends pi.
  EXPECT_NEAR(scene.lights[3].scale, std::acos(-1.0), 1e-12);
}

}  // namespace
}  // namespace caplet::mistakes_test
