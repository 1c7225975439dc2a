// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes of strangers that name files of others: each way in which a format names a file, by each
// way out of the scene's folder.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <future>
#include <memory>
#include <thread>

#include "base/reading.h"
#include "film/image.h"
#include "import/import.h"
#include "support/data.h"
#include "support/log_of.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// One way in which a file names another, whose name stands for @ and ends in `ending`.
struct Naming {
  const char *what, *main, *text, *ending;
  int line;  // where it says so; 0: the file as a whole
};

constexpr Naming namings[] = {
    {"Include", "a.pbrt", "WorldBegin\nInclude \"@\"\n", "", 2},
    {"Import", "a.pbrt", "WorldBegin\nImport \"@\"\n", ".pbrt", 2},
    {"plymesh", "a.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"@\"\n", "", 2},
    {"capsules", "a.pbrt", "WorldBegin\nShape \"capsules\" \"string filename\" \"@\"\n", "", 2},
    {"swc", "a.pbrt", "WorldBegin\nShape \"swc\" \"string filename\" \"@\"\n", "", 2},
    {"an OBJ of Shape file", "a.pbrt", "WorldBegin\nShape \"file\" \"string filename\" \"@\"\n",
     ".obj", 2},
    {"XML of Shape file", "a.pbrt", "WorldBegin\nShape \"file\" \"string filename\" \"@\"\n",
     ".xml", 2},
    {"values of neurons", "a.pbrt",
     "WorldBegin\nShape \"swc\" \"string filename\" \"own.swc\" \"string color\" \"@\"\n", "", 2},
    {"places of atoms", "a.pbrt",
     "WorldBegin\nShape \"file\" \"string filename\" \"own.xyz\" \"string positions\" \"@\"\n",
     ".npy", 2},
    {"components", "a.pbrt",
     "WorldBegin\nShape \"file\" \"string filename\" \"own.pdb\" \"string components\" \"@\"\n",
     ".cif", 2},
    {"imagemap", "a.pbrt",
     "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"@\"\n", ".png", 2},
    {"imagemap of EXR", "a.pbrt",
     "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"@\"\n", ".exr", 2},
    {"normalmap", "a.pbrt",
     "WorldBegin\nMaterial \"diffuse\" \"string normalmap\" \"@\"\nShape \"sphere\"\n", ".png", 2},
    {"infinite", "a.pbrt", "WorldBegin\nLightSource \"infinite\" \"string filename\" \"@\"\n",
     ".exr", 2},
    {"goniometric", "a.pbrt", "WorldBegin\nLightSource \"goniometric\" \"string filename\" \"@\"\n",
     "", 2},
    {"projection", "a.pbrt", "WorldBegin\nLightSource \"projection\" \"string filename\" \"@\"\n",
     ".hdr", 2},
    {"ies", "a.pbrt", "WorldBegin\nLightSource \"ies\" \"string filename\" \"@\"\n", "", 2},
    {"area light", "a.pbrt", "WorldBegin\nAreaLightSource \"diffuse\" \"string filename\" \"@\"\n",
     ".png", 2},
    {"nanovdb", "a.pbrt",
     "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"@\"\nWorldBegin\n",
     "", 1},
    {"spectrum", "a.pbrt", "WorldBegin\nLightSource \"distant\" \"spectrum L\" \"@\"\n", "", 2},
    {"spectrum of a metal", "a.pbrt",
     "WorldBegin\nMaterial \"conductor\" \"spectrum eta\" \"@\"\nShape \"sphere\"\n", ".spd", 2},
    {"background", "a.pbrt",
     "Film \"rgb\" \"string background\" \"image\" \"string backgroundfile\" \"@\"\nWorldBegin\n",
     ".png", 1},
    {"mtllib", "a.obj", "v 0 0 0\nmtllib @\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "", 2},
    {"mtllib's image", "a.obj", "mtllib own.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ".png", -1},
    {"buffer", "a.gltf",
     R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
     R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
     R"("buffers":[{"byteLength":36,"uri":"@"}]})",
     "", 0},
    {"image", "a.gltf",
     R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],)"
     R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
     R"("buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
     R"("images":[{"uri":"@"}],"textures":[{"source":0}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}]})",
     ".png", 0},
    {"init_from", "a.dae",
     "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
     "version='1.4.1'><library_images><image id='i'>"
     "<init_from>@</init_from></image></library_images><library_effects><effect "
     "id='e'><profile_COMMON><technique><lambert>"
     "<diffuse><texture texture='i' "
     "texcoord='u'/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
     "<library_materials><material id='m'><instance_effect "
     "url='#e'/></material></library_materials><library_geometries>"
     "<geometry id='g'><mesh><source id='p'><float_array id='pa' count='9'>0 0 0 1 0 0 0 1 "
     "0</float_array><technique_common>"
     "<accessor source='#pa' count='3' stride='3'/></technique_common></source><vertices "
     "id='v'><input semantic='POSITION' "
     "source='#p'/></vertices><triangles count='1' material='s'><input semantic='VERTEX' "
     "source='#v' offset='0'/><p>0 1 2</p>"
     "</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene "
     "id='vs'><node>"
     "<instance_geometry url='#g'><bind_material><technique_common><instance_material symbol='s' "
     "target='#m'/>"
     "</technique_common></bind_material></instance_geometry></node></visual_scene></"
     "library_visual_scenes><scene>"
     "<instance_visual_scene url='#vs'/></scene></COLLADA>",
     ".png", 1},
    {"mesh of URDF", "a.urdf",
     "<robot name='r'><link name='l'>\n<visual><geometry><mesh "
     "filename='@'/></geometry></visual></link></robot>",
     ".stl", 2},
    {"file:// of URDF", "a.urdf",
     "<robot name='r'><link name='l'>\n<visual><geometry><mesh "
     "filename='file://@'/></geometry></visual></link></robot>",
     ".obj", 2},
    {"include of MJCF", "a.mjcf", "<mujoco>\n<include file='@'/></mujoco>", "", 2},
    {"attached model", "a.mjcf",
     "<mujoco><asset>\n<model name='m' file='@'/></asset><worldbody><attach model='m' "
     "prefix='p'/></worldbody></mujoco>",
     ".xml", 2},
    {"attached model without a name", "a.mjcf",
     "<mujoco><asset>\n<model file='@'/></asset></mujoco>", ".xml", 2},
    {"mesh of MJCF", "a.mjcf",
     "<mujoco><asset><mesh name='m' file='@'/></asset><worldbody>\n<geom type='mesh' "
     "mesh='m'/></worldbody></mujoco>",
     ".stl", 2},
    {"OBJ of MJCF", "a.mjcf",
     "<mujoco><asset><mesh name='m' file='@'/></asset><worldbody>\n<geom type='mesh' "
     "mesh='m'/></worldbody></mujoco>",
     ".obj", 2},
    {"height field", "a.mjcf",
     "<mujoco><asset>\n<hfield name='h' file='@' size='1 1 1 1'/></asset><worldbody><geom "
     "type='hfield' "
     "hfield='h'/></worldbody></mujoco>",
     "", 2},
    {"picture of a height field", "a.mjcf",
     "<mujoco><asset>\n<hfield name='h' file='@' size='1 1 1 1'/></asset><worldbody><geom "
     "type='hfield' "
     "hfield='h'/></worldbody></mujoco>",
     ".png", 2},
    {"texture of MJCF", "a.mjcf",
     "<mujoco><asset>\n<texture name='t' type='2d' file='@'/><material name='m' "
     "texture='t'/></asset><worldbody>"
     "<geom type='sphere' size='1' material='m'/></worldbody></mujoco>",
     ".png", 2},
    {"cube of MJCF", "a.mjcf",
     "<mujoco><asset>\n<texture name='t' type='cube' file='@'/><material name='m' "
     "texture='t'/></asset><worldbody>"
     "<geom type='sphere' size='1' material='m'/></worldbody></mujoco>",
     ".png", 2},
    {"skin", "a.mjcf",
     "<mujoco><asset>\n<skin file='@'/></asset><worldbody><body name='b'><geom "
     "size='1'/></body></worldbody></mujoco>",
     ".skn", 2},
    {"scene of Embree", "a.xml", "<scene>\n<xml src='@'/></scene>", ".xml", 2},
    {"mesh of Embree", "a.xml", "<scene>\n<obj src='@'/></scene>", ".obj", 2},
    {"PLY of Embree", "a.xml", "<scene>\n<obj src='@'/></scene>", ".ply", 2},
    {"image of Embree", "a.xml",
     "<scene><TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 "
     "2</triangles>\n<material><code>\"OBJ\"</code>"
     "<parameters><texture3d name=\"map_Kd\" "
     "src=\"@\"/></parameters></material></TriangleMesh></scene>",
     ".png", 2},
    {"option of Embree", "a.ecs", "-vp 0 0 1\n-i @\n", ".xml", 2},
};

class Strangers : public testing::Test {
 protected:
  Strangers() {
    fs::create_directories(inside_ / "sub");
    fs::create_directories(outside_);
  }
  static void put(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  static std::string with_name(std::string text, const std::string& name) {
    for (std::size_t at; (at = text.find('@')) != std::string::npos;) text.replace(at, 1, name);
    return text;
  }
  /// The scene that names it so, beside what the namings need.
  fs::path scene(const Naming& naming, const std::string& name) const {
    put(inside_ / "own.swc", "1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
    put(inside_ / "own.xyz", "1\n\nC 0 0 0\n");
    put(inside_ / "own.pdb",
        "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C\n");
    put(inside_ / "own.mtl", with_name("newmtl m\nmap_Kd @\n", name));
    put(inside_ / naming.main, with_name(naming.text, name));
    return inside_ / naming.main;
  }
  /// All that is said of it, warnings among it; empty: it is a scene.
  static std::string said(const fs::path& file, bool no_outside) {
    ImportOptions options;
    if (no_outside) options.set("no-outside", "yes");
    test::LogOf log;
    std::string out;
    try {
      import_scene(file, FileImageReader(), options);
    } catch (const InputError& error) {
      out = error.what();
    }
    return out + "\n" + log.text();
  }
  static bool is_refused(const std::string& text) {
    return text.find("which --no-outside does not let it read") != std::string::npos;
  }

  const fs::path folder_ = test::temporary_folder(), inside_ = folder_ / "scene",
                 outside_ = folder_ / "out";
};

/// Names that lead out of the folder, to a file that is there and to one that is not.
TEST_F(Strangers, ReadNothingOutsideOfTheirFolder) {
  fs::create_directory_symlink("../out", inside_ / "away");
  fs::create_directory_symlink(folder_, inside_ / "sub" / "up");
  for (const Naming& naming : namings) {
    std::string first;
    for (const char* stem : {"there", "gone"}) {
      const std::string file = stem + std::string(naming.ending);
      if (stem[0] == 't') put(outside_ / file, "hunter2");
      fs::remove(inside_ / ("link" + file));
      fs::create_symlink("../out/" + file, inside_ / ("link" + file));
      fs::remove(inside_ / ("chain" + file));
      fs::create_symlink("link" + file, inside_ / ("chain" + file));
      for (const std::string& name :
           {"../out/" + file, (outside_ / file).string(), "link" + file, "chain" + file,
            "away/" + file, "sub/../../out/" + file, "sub/up/out/" + file,
            "missing/../../out/" + file, "./../scene/../out/" + file}) {
        if (std::string_view(naming.what) == "file:// of URDF" && name[0] != '/')
          continue;  // is of the file system's root
        const fs::path path = scene(naming, name);
        const std::string text = said(path, true);
        EXPECT_TRUE(is_refused(text)) << naming.what << ", " << name << ":\n" << text;
        EXPECT_THAT(text, Not(HasSubstr("hun"))) << naming.what << ", " << name;
        EXPECT_EQ(text.find('\n'), text.size() - 1) << text;  // and nothing else
        const std::string place = naming.line > 0
                                      ? fmt::format("{}:{}:", path.string(), naming.line)
                                  : naming.line == 0 ? path.string()
                                                     : std::string();
        EXPECT_THAT(text, StartsWith(place)) << naming.what << ", " << name;
      }
    }
  }
}

TEST_F(Strangers, SayTheSameOfWhatIsThereAndOfWhatIsNot) {
  for (const Naming& naming : namings) {
    std::string text[2];
    for (const int there : {0, 1}) {
      const std::string name = "../out/file" + std::string(naming.ending);
      fs::remove(outside_ / fs::path(name).filename());
      if (there) put(outside_ / fs::path(name).filename(), "hunter2");
      if (std::string_view(naming.what) != "file:// of URDF")
        text[there] = said(scene(naming, name), true);
    }
    EXPECT_EQ(text[0], text[1]) << naming.what;
  }
}

TEST_F(Strangers, MayNameWhatLiesInTheirFolder) {
  fs::create_directory_symlink("sub", inside_ / "here");
  for (const Naming& naming : namings) {
    const std::string file = "file" + std::string(naming.ending);
    put(inside_ / "sub" / file, "nothing of use");
    fs::remove(inside_ / ("link" + file));
    fs::create_symlink((inside_ / "sub" / file).string(), inside_ / ("link" + file));
    for (const std::string& name :
         {"sub/" + file, (inside_ / "sub" / file).string(), "here/" + file, "sub/../sub/" + file,
          "link" + file, "../scene/sub/" + file, "missing" + file}) {
      if (std::string_view(naming.what) == "file:// of URDF" && name[0] != '/')
        continue;  // is of the file system's root
      const fs::path path = scene(naming, name);
      EXPECT_FALSE(is_refused(said(path, true))) << naming.what << ", " << name << ":\n"
                                                 << said(path, true);
      EXPECT_EQ(said(path, true), said(path, false)) << naming.what << ", " << name;
    }
  }
}

TEST_F(Strangers, MayBeNoLinkThemselves) {
  put(outside_ / "a.swc", "1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
  fs::create_symlink("../out/a.swc", inside_ / "a.swc");
  EXPECT_TRUE(is_refused(said(inside_ / "a.swc", true)));
  EXPECT_EQ(said(inside_ / "a.swc", false), "\n");
  // Links above it are the user's own.
  fs::create_directory_symlink(outside_, folder_ / "linked");
  EXPECT_EQ(said(folder_ / "linked" / "a.swc", true), "\n");
  const fs::path before = fs::current_path();
  fs::current_path(outside_);
  EXPECT_EQ(said("a.swc", true), "\n");
  EXPECT_EQ(said("./a.swc", true), "\n");
  EXPECT_EQ(said("../out/a.swc", true), "\n");
  fs::current_path(before);
}

TEST_F(Strangers, CompanionsAreNoLinks) {
  // Embree looks for numbers beside the scene by itself.
  put(inside_ / "a.xml",
      "<scene><TriangleMesh><positions ofs=\"0\" size=\"3\"/><triangles>0 1 "
      "2</triangles></TriangleMesh></scene>");
  put(outside_ / "numbers", std::string(36, '\0'));
  fs::create_symlink("../out/numbers", inside_ / "a.bin");
  EXPECT_TRUE(is_refused(said(inside_ / "a.xml", true))) << said(inside_ / "a.xml", true);
  EXPECT_EQ(said(inside_ / "a.xml", false), "\n");
}

TEST_F(Strangers, UsersNameWhatTheyLike) {
  put(inside_ / "a.swc", "1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
  put(inside_ / "a.pdb",
      "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  0.00           C\n");
  put(outside_ / "values.txt", "1\n2\n");
  put(outside_ / "parts.cif",
      "data_x\nloop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_"
      "2\nA B C\n");
  const auto fine = [](const fs::path& file, const std::string& option, const fs::path& value) {
    ImportOptions options;
    options.set("no-outside", "yes");
    options.set(option, value.string());
    EXPECT_NO_THROW(import_scene(file, FileImageReader(), options)) << option;
  };
  fine(inside_ / "a.swc", "color", outside_ / "values.txt");
  fine(inside_ / "a.pdb", "components", outside_ / "parts.cif");
  // The picture in a glTF file's own buffer is read by way of a temporary file.
  const std::vector<fs::path> both{inside_ / "a.swc", outside_ / "b.swc"};
  put(both[1], "1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
  ImportOptions options;
  options.set("no-outside", "yes");
  EXPECT_FALSE(import_scenes(both, FileImageReader(), options).shapes.empty());
  EXPECT_TRUE(may_read("/etc/passwd"));  // after them
}

TEST_F(Strangers, SeveralFilesHaveAFolderEach) {
  put(outside_ / "mine.swc", "1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n");
  put(inside_ / "a.pbrt", "WorldBegin\nShape \"swc\" \"string filename\" \"../out/mine.swc\"\n");
  ImportOptions options;
  options.set("no-outside", "yes");
  EXPECT_THAT(
      [&] {
        import_scenes(std::vector{outside_ / "mine.swc", inside_ / "a.pbrt"}, FileImageReader(),
                      options);
      },
      testing::ThrowsMessage<InputError>(HasSubstr("--no-outside")));
  for (const char* word : {"yes", "no"}) {
    options.set("no-outside", word);
    EXPECT_EQ(is_refused(said(inside_ / "a.pbrt", word[0] == 'y')), word[0] == 'y');
  }
  options.set("no-outside", "perhaps");
  EXPECT_THROW(import_scene(inside_ / "a.pbrt", FileImageReader(), options), InputError);
}

/// Fifos would be waited for, and devices never end.
TEST_F(Strangers, WaitForNoPipeAndReadNoDevice) {
  for (const Naming& naming : namings) {
    const std::string ending = naming.ending;
    const fs::path pipe = inside_ / ("pipe" + ending), zero = inside_ / ("zero" + ending);
    fs::remove(pipe);
    fs::remove(zero);
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("/dev/zero", zero);
    for (const fs::path& name : {pipe, zero})
      for (const bool no_outside : {false, true}) {
        const fs::path path = scene(naming, name.filename().string());
        auto done = std::make_shared<std::promise<bool>>();
        std::future<bool> ended = done->get_future();
        std::thread([=] {
          ImportOptions options;
          if (no_outside) options.set("no-outside", "yes");
          bool throws = false;
          try {
            import_scene(path, FileImageReader(), options);
          } catch (const InputError&) {
            throws = true;
          }
          done->set_value(throws);
        }).detach();
        ASSERT_EQ(ended.wait_for(std::chrono::seconds(20)), std::future_status::ready)
            << naming.what << ", " << name;
        EXPECT_TRUE(ended.get() || !no_outside || name != zero) << naming.what;
      }
  }
}

// --- What errors show ---

/// Files of other kinds, in which every word is a secret. Some formats have columns of three
/// letters, so that three are looked for.
const std::pair<const char*, std::string> secrets[] = {
    {"passwords", "root:$6$hunter2$hunter2:19000:0:99999:7:::\nhunter2:!:19000:0:99999:7:::\n"},
    {"words", "hunter2 hunter2 hunter2 hunter2 hunter2 hunter2 hunter2 hunter2\nhunter2\n"},
    {"variables", "hunter2=hunter2\nexport hunter2='hunter2'\n"},
    {"a key", "-----BEGIN hunter2 KEY-----\nhunter2hunter2\n-----END hunter2 KEY-----\n"},
    {"JSON", "{\"hunter2\": \"hunter2\", \"version\": \"hunter2\"}\n"},
    {"XML", "<?xml version=\"1.0\"?>\n<hunter2 hunter2=\"hunter2\">hunter2</hunter2>\n"},
    {"numbers and words", "12 hunter2\n13 hunter2\n14 hunter2\n"},
    {"words and numbers", "hunter2 12\nhunter2 13\nhunter2 14\n"},
    {"one number", "3\nhunter2\nhunter2 hunter2 hunter2 hunter2\n"},
    {"quotes", "\"hunter2\" \"hunter2\"\n\"hunter2\n"},
    {"sections", "[hunter2]\nhunter2 = hunter2\n; hunter2\n"},
    {"statements of a shell",
     "# hunter2\nInclude hunter2\nHost hunter2\n  Option hunter2\n  Film hunter2\n"},
    {"statements that a scene has",
     "Shape \"hunter2\" \"hunter2 hunter2\" hunter2\nOption \"hunter2\" hunter2\nTranslate hunter2 "
     "1 2\n"},
    {"a statement with a word of another one", "Camera \"sphere\" hunter2\n"},
    {"many words", "hunter2\nhunter2\nhunter2\nhunter2\nhunter2\nhunter2\n"},
    {"a table", "hunter2,hunter2,1.5\nhunter2,hunter2,2.5\n"},
    {"dashes", "-hunter2 --hunter2 - hunter2\n"},
    {"brackets", "<hunter2, 0, 0> <1, 0, 0> hunter2\n(hunter2)\n"},
    {"letters of one line", "hunter2"},
    {"records",
     "ATOM  hunter2 hunter2 hunter2 hunter2 hunter2 hunter2 hunter2 hunter2\nHETATM "
     "hunter2\nCONECT hunter2\n"},
    {"short records", "HETATM hunter2\nATOM hunter2\n"},
    {"records of fixed columns",
     "ATOM      1  CA  ALA A   1     hunter2 hunter2 hunter2  1.00  0.00     hunter2\n"},
    {"lists", "data_hunter2\nloop_\n_hunter2.hunter2\nhunter2 'hunter2\n_hunter2\n"},
    {"bytes", std::string("\0\1\2hunter2\xff\xfehunter2", 19)},
    {"a long word", std::string(3000, 'x') + "hunter2" + std::string(3000, 'x')},
};

TEST_F(Strangers, ErrorsShowNothingOfFilesThatAreNoScenes) {
  for (const Format& format : formats())
    for (const std::string& extension : format.extensions) {
      if (extension.ends_with(".gz")) continue;
      for (const auto& [what, text] : secrets) {
        const fs::path file = inside_ / ("secret" + extension);
        put(file, text);
        const std::string shown = said(file, false);
        EXPECT_THAT(shown, Not(HasSubstr("hun"))) << format.name << " of " << what;
        EXPECT_TRUE(shown == "\n" || shown.find("secret" + extension) != std::string::npos)
            << format.name << " of " << what;
      }
    }
}

TEST_F(Strangers, ErrorsShowNothingOfWhatScenesName) {
  for (const Naming& naming : namings)
    for (const auto& [what, text] : secrets) {
      const std::string name = "../out/private" + std::string(naming.ending);
      if (std::string_view(naming.what) == "file:// of URDF") continue;
      put(outside_ / fs::path(name).filename(), text);
      EXPECT_THAT(said(scene(naming, name), false), Not(HasSubstr("hun")))
          << naming.what << " of " << what;
    }
}

/// Mistakes in scenes are shown as ever.
TEST_F(Strangers, ErrorsShowWhatIsWrongInScenes) {
  const std::pair<const char*, const char*> wrong[] = {
      {"a.pbrt", "WorldBegin\nShpe \"sphere\"\n"},
      {"b.pbrt", "WorldBegin\nShape \"sphere\" \"float radius\" Shpe\n"},
      {"a.swc", "1 1 0 0 0 1 -1\n2 3 5 Shpe 0 1 1\n"},
      {"a.capsules", "<0, 0, 0> <1, 0, 0> 0.5\n<0, 0, Shpe> <1, 0, 0> 0.5\n"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 Shpe 0\nf 1 2 3\n"},
      {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 Shpe\n"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 Shpe 0\n3 0 1 2\n"},
      {"a.xyz", "2\n\nC 0 0 0\nC 0 0 Shpe\n"},
      {"a.sdf",
       "a\n\n\n  2  0  0  0  0  0  0  0  0  0999 V2000\n    0.0000    0.0000    0.0000 C   0  0\n"
       "    1.0000    0.0000      Shpe C   0  0\n"},
      {"a.vtk",
       "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 Shpe\n"},
      {"a.urdf",
       "<robot name='r'><link name='l'><visual><geometry><sphere "
       "radius='Shpe'/></geometry></visual></link></robot>"},
      {"a.mjcf", "<mujoco><worldbody><geom size='Shpe'/></worldbody></mujoco>"},
      {"a.xml", "<scene><TriangleMesh><positions>0 0 Shpe</positions></TriangleMesh></scene>"},
      {"a.ecs", "-vp 0 0 1\n-vi 0 0 Shpe\n"}};
  for (const auto& [name, text] : wrong) {
    put(inside_ / name, text);
    EXPECT_THAT(said(inside_ / name, false), HasSubstr("Shpe")) << name;
  }
  put(inside_ / "part.pbrt", "Translate 1 0 0\nShpe \"sphere\"\n");
  put(inside_ / "whole.pbrt", "WorldBegin\nInclude \"part.pbrt\"\n");
  EXPECT_THAT(said(inside_ / "whole.pbrt", false),
              HasSubstr("part.pbrt:2:1: unknown directive \"Shpe\""));
  put(inside_ / "part.pbrt", "Shpe \"sphere\"\nShpe \"sphere\"\n");
  EXPECT_THAT(
      said(inside_ / "whole.pbrt", false),
      StartsWith((inside_ /
                  "part.pbrt:1:1: unknown directive \"...\"; the nearest known name is \"Shape\"\n")
                     .string()));
}

// --- Paths ---

TEST_F(Strangers, PathsAreFollowedAsTheSystemDoes) {
  fs::create_directory_symlink("../out", inside_ / "away");
  put(outside_ / "file", "x");
  fs::create_symlink("file", outside_ / "again");
  fs::create_symlink("../../out/./again", inside_ / "sub" / "there");
  // Where all of it is there the system's own answer is the right one.
  for (const char* path : {"away/file", "away/again", "sub/there", "sub/../away/file",
                           "away/../scene/sub/there", ".", "..", "/", "sub/"}) {
    const fs::path whole = path[0] == '/' ? fs::path(path) : inside_ / path;
    fs::path real = fs::canonical(whole);
    EXPECT_EQ(without_links(whole), real) << path;
  }
  EXPECT_EQ(without_links(inside_ / "gone" / "x"), fs::canonical(inside_) / "gone" / "x");
  EXPECT_EQ(without_links(inside_ / "gone" / ".." / ".." / "x"), fs::canonical(folder_) / "x");
  EXPECT_EQ(without_links("/../../x"), "/x");
  fs::create_symlink("/etc/caplet-gone", inside_ / "dangling");
  EXPECT_EQ(without_links(inside_ / "dangling"), "/etc/caplet-gone");
  fs::create_symlink("round", inside_ / "round");
  EXPECT_EQ(without_links(inside_ / "round"), "");
  // As many links as the system would not follow.
  fs::create_symlink("/etc", inside_ / "step0");
  for (int i = 1; i < 60; ++i)
    fs::create_symlink(fmt::format("step{}", i - 1), inside_ / fmt::format("step{}", i));
  const ReadingBeneath fence(inside_ / "a.pbrt");
  for (const int steps : {0, 20, 39, 40, 41, 59})
    EXPECT_FALSE(may_read(inside_ / fmt::format("step{}", steps) / "passwd")) << steps;
  EXPECT_FALSE(may_read(inside_ / "round"));
  EXPECT_TRUE(may_read(inside_ / "a" / "b"));
  EXPECT_TRUE(may_read(inside_));
  EXPECT_FALSE(may_read(folder_ / "scene2" / "x"));  // begins alike
  {
    const ReadingAnywhere anywhere;
    EXPECT_TRUE(may_read("/etc/passwd"));
  }
  EXPECT_FALSE(may_read("/etc/passwd"));
  bool elsewhere = false;
  std::thread([&] { elsewhere = may_read("/etc/passwd"); }).join();
  EXPECT_TRUE(elsewhere);  // another thread reads for another user
}

}  // namespace
}  // namespace caplet
