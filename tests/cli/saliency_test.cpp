#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "fovea/io/field_file.h"
#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "run_command.h"
#include "support/meshes.h"

namespace fovea::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class SaliencyVerb : public ::testing::Test {
 protected:
  std::string out(const std::string& name) const { return folder_ / name; }

  Image8 picture(const std::string& name) const {
    const std::string bytes = read_text(out(name));
    return decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
  Model model(const std::string& path) const {
    Context context;
    return read_model(path, {}, context);
  }
  static Outcome saliency(std::vector<std::string> words) {
    words.insert(words.begin(), "saliency");
    return fovea(words);
  }

  /// A sheet of two materials, each with an image of its own.
  std::string write_two_textures() const {
    Model sheet = model_of(two_part_grid(8, 8));
    for (const int size : {16, 8}) {
      EncodedImage image;
      image.mime_type = "image/png";
      image.bytes = encode_png(Image8(size, size, 3, ColorEncoding::srgb));
      image.bytes.push_back(static_cast<std::uint8_t>(size));  // files may end in more than they need
      sheet.images.push_back(image);
      sheet.textures.push_back({static_cast<int>(sheet.images.size()) - 1, -1, "", ""});
    }
    sheet.materials.assign(2, Material{});
    for (int m = 0; m < 2; ++m)
      sheet.materials[static_cast<std::size_t>(m)].base_color = TextureRef{m, 0, {}};
    Context context;
    write_model(sheet, out("two.glb"), {}, context);
    return out("two.glb");
  }

  Folder folder_;
  std::string grid_ = write_grid(folder_, "grid.glb");
};

TEST_F(SaliencyVerb, WritesAHeatMap) {
  const Outcome outcome = saliency({grid_, "-o", out("heat.glb"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_TRUE(json.is_object()) << outcome.out;
  EXPECT_EQ(json["verb"], "saliency");
  ASSERT_EQ(json["inputs"].size(), 1u);
  EXPECT_EQ(json["inputs"][0]["path"], grid_);
  EXPECT_EQ(json["inputs"][0]["bytes"], std::filesystem::file_size(grid_));
  EXPECT_EQ(json["outputs"].size(), 1u);
  EXPECT_EQ(json["outputs"][0]["path"], out("heat.glb"));
  EXPECT_EQ(json["outputs"][0]["format"], "glb");
  EXPECT_EQ(json["outputs"][0]["bytes"], std::filesystem::file_size(out("heat.glb")));
  EXPECT_EQ(json["outputs"][0]["map"], "saliency");
  EXPECT_EQ(json["poses"], nlohmann::json::array({"rest"}));
  EXPECT_EQ(json["textured"], false) << "its image is black all over";
  EXPECT_EQ(json["options"]["preset"], "fovea");
  EXPECT_EQ(json["options"]["map"], "saliency");
  const nlohmann::json& whole = json["maps"]["saliency"];
  EXPECT_EQ(whole["min"], 0);
  EXPECT_EQ(whole["max"], 1);
  for (const char* key : {"mean", "deviation", "quarter", "median", "three_quarters"}) {
    EXPECT_GE(whole[key], 0) << key;
    EXPECT_LE(whole[key], 1) << key;
  }
  EXPECT_TRUE(json["maps"].contains("geometry"));
  const Model heat = model(out("heat.glb"));
  EXPECT_NE(heat.meshes[0].surface.find(Semantic::color), nullptr);
  EXPECT_TRUE(heat.images.empty());
}

TEST_F(SaliencyVerb, KeysOfItsReportAreOnThePage) {
  const std::string page = read_text(FOVEA_COMMAND_PAGE);
  const nlohmann::json json = saliency({grid_, "-o", out("heat.glb"), "--json"}).json();
  const auto expect_there = [&](const nlohmann::json& object) {
    for (const auto& [key, value] : object.items()) EXPECT_THAT(page, HasSubstr("`" + key + "`"));
  };
  expect_there(json);
  expect_there(json["inputs"][0]);
  expect_there(json["outputs"][0]);
  expect_there(json["maps"]["saliency"]);
}

TEST_F(SaliencyVerb, TheExtensionSaysWhatIsWritten) {
  for (const char* name : {"a.png", "a.jpg", "a.webp", "b.PNG"}) {
    const Outcome outcome = saliency({grid_, "-o", out(name), "--view-size", "32", "--columns", "3"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(picture(name).width, 96) << "six views, three beside each other";
    EXPECT_EQ(picture(name).height, 64);
  }
  const std::size_t sources = model(grid_).meshes[0].surface.source_vertex.size();
  for (const char* name : {"a.npy", "a.csv", "a.txt", "b.NPY"}) {
    const Outcome outcome = saliency({grid_, "-o", out(name)});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(read_field(out(name)).size(), sources) << name;
  }
  EXPECT_EQ(read_field(out("a.npy")), read_field(out("a.csv")));
  EXPECT_THAT(read_text(out("a.csv")), ::testing::StartsWith("saliency\n"));
  for (const char* name : {"a.gltf", "a.ply"}) {
    ASSERT_EQ(saliency({grid_, "-o", out(name)}).code, 0) << name;
    EXPECT_NE(model(out(name)).meshes[0].surface.find(Semantic::color), nullptr) << name;
  }
}

TEST_F(SaliencyVerb, AttributeKeepsTheModel) {
  ASSERT_EQ(saliency({grid_, "-o", out("marked.glb"), "--as", "attribute"}).code, 0);
  ASSERT_EQ(saliency({grid_, "-o", out("field.npy")}).code, 0);
  const Model before = model(grid_), marked = model(out("marked.glb"));
  EXPECT_EQ(marked.images[0].bytes, before.images[0].bytes);
  EXPECT_TRUE(marked.materials[0].base_color.has_value());
  const auto expected = field_from_source_order(before, read_field(out("field.npy")));
  const auto found = field_from_attribute(marked, "_SALIENCY");
  const auto sorted = [](const VertexField& field) {
    std::vector<float> values(field.values().begin(), field.values().end());
    std::sort(values.begin(), values.end());
    return values;
  };
  EXPECT_EQ(sorted(found[0]), sorted(expected[0]));
  ASSERT_EQ(saliency({grid_, "-o", out("marked.ply"), "--as", "attribute"}).code, 0);
  EXPECT_EQ(sorted(field_from_attribute(model(out("marked.ply")), "SALIENCY")[0]), sorted(expected[0]));
  ASSERT_EQ(saliency({grid_, "-o", out("m.glb"), "--as", "attribute", "--map", "curvature-contrast-1"}).code,
            0);
  EXPECT_EQ(field_from_attribute(model(out("m.glb")), "_CURVATURE_CONTRAST_1").size(), 1u);
}

// What one verb writes another one reads.
TEST_F(SaliencyVerb, ItsFieldsAreImportanceForSimplify) {
  ASSERT_EQ(saliency({grid_, "-o", out("field.npy")}).code, 0);
  const Outcome outcome =
      fovea({"simplify", grid_, "-o", out("small.glb"), "--ratio", "0.5", "--importance", out("field.npy")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(fovea({"render", grid_, "-o", out("field.png"), "--pass", "field", "--field", out("field.npy"),
                   "--view", "1", "--width", "32", "--height", "32"})
                .code,
            0);
}

TEST_F(SaliencyVerb, TextureSpaceIsAPictureOfTheTexturesSize) {
  ASSERT_EQ(saliency({grid_, "-o", out("map.png"), "--as", "texture"}).code, 0);
  EXPECT_EQ(picture("map.png").width, 16);
  EXPECT_EQ(picture("map.png").height, 8);
}

TEST_F(SaliencyVerb, EveryTextureHasAFileOfItsOwn) {
  const std::string two = write_two_textures();
  const Outcome outcome = saliency({two, "-o", out("map.png"), "--as", "texture", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  ASSERT_EQ(json["outputs"].size(), 2u);
  EXPECT_EQ(json["outputs"][0]["path"], out("map-image0.png"));
  EXPECT_EQ(json["outputs"][1]["path"], out("map-image1.png"));
  EXPECT_EQ(picture("map-image0.png").width, 16);
  EXPECT_EQ(picture("map-image1.png").width, 8);
  EXPECT_THAT(folder_.names(), Not(Contains("map.png")));

  ASSERT_EQ(saliency({two, "-o", out("all.png"), "--as", "texture", "--map", "all"}).code, 0);
  for (const char* name :
       {"all-image0.png", "all-image1.png", "all-geometry-image0.png", "all-geometry-image1.png"})
    EXPECT_THAT(folder_.names(), Contains(name));
}

TEST_F(SaliencyVerb, OneMapByName) {
  ASSERT_EQ(saliency({grid_, "-o", out("height.csv"), "--map", "height"}).code, 0);
  EXPECT_THAT(read_text(out("height.csv")), ::testing::StartsWith("height\n"));
  ASSERT_EQ(saliency({grid_, "-o", out("all.csv"), "--map", "saliency"}).code, 0);
  EXPECT_NE(read_field(out("height.csv")), read_field(out("all.csv")));
}

TEST_F(SaliencyVerb, AllMapsAreFilesOfTheirNames) {
  const Outcome outcome = saliency({grid_, "-o", out("maps.npy"), "--map", "all", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  std::vector<std::string> expected{"grid.glb"};
  for (const auto& [name, s] : json["maps"].items())
    expected.push_back(name == "saliency" ? "maps.npy" : "maps-" + name + ".npy");
  EXPECT_GT(expected.size(), 5u);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(folder_.names(), expected);
  EXPECT_EQ(json["outputs"].size() + 1, expected.size());
  for (const auto& output : json["outputs"])
    EXPECT_THAT(folder_.names(), Contains(std::filesystem::path(output["path"]).filename().string()));
}

TEST_F(SaliencyVerb, AnUnknownMapListsThoseThereAre) {
  const Outcome outcome = saliency({grid_, "-o", out("x.npy"), "--map", "geometri"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--map: there is no map \"geometri\""));
  for (const char* name : {"all", "geometry", "height", "visibility", "saliency"})
    EXPECT_THAT(outcome.err, HasSubstr(name));
  EXPECT_THAT(folder_.names(), ElementsAre("grid.glb"));
}

TEST_F(SaliencyVerb, FilesArePosesOfOneModel) {
  const std::string flat = folder_.write("a.obj", square_obj()),
                    bent = folder_.write("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"),
                    more = folder_.write("c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 2\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  const Outcome outcome = saliency({flat, bent, more, "-o", out("heat.ply"), "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["poses"], nlohmann::json::array({"file 1", "file 2", "file 3"}));
  ASSERT_EQ(outcome.json()["inputs"].size(), 3u);
  EXPECT_EQ(outcome.json()["inputs"][1]["path"], bent);
}

TEST_F(SaliencyVerb, APoseThatDoesNotFitIsNamed) {
  const std::string flat = folder_.write("a.obj", square_obj()),
                    same = folder_.write("same.obj", square_obj()),
                    other = folder_.write("other.obj", square_obj() + "v 5 5 5\nf 1 2 5\n");
  const Outcome outcome = saliency({flat, same, other, "-o", out("heat.glb")});
  EXPECT_EQ(outcome.code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("error: " + other));
  EXPECT_THAT(outcome.err, HasSubstr("hint: poses must have the same"));
  EXPECT_EQ(saliency({flat, grid_, "-o", out("heat.glb")}).code, 5);
  EXPECT_THAT(folder_.names(), ElementsAre("a.obj", "grid.glb", "other.obj", "same.obj"));
}

TEST_F(SaliencyVerb, AMissingPoseIsMissedBeforeTheWork) {
  const Outcome outcome = saliency({grid_, out("none.glb"), "-o", out("heat.glb")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("none.glb: no such file"));
  EXPECT_THAT(folder_.names(), ElementsAre("grid.glb"));
}

TEST_F(SaliencyVerb, KeyPosesOfAnAnimation) {
  const std::string arm = out("arm.glb");
  ASSERT_EQ(fovea({"sample", "arm", "-o", arm, "--detail", "0.03"}).code, 0);
  const Outcome outcome = saliency({arm, "-o", out("heat.glb"), "--key-poses", "3", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_GT(json["poses"].size(), 1u);
  EXPECT_LE(json["poses"].size(), 3u);
  EXPECT_THAT(json["poses"][0].get<std::string>(), HasSubstr("animation 0"));
  EXPECT_TRUE(json["maps"].contains("geometry-pose-2"));
  const Model heat = model(out("heat.glb"));
  EXPECT_EQ(heat.animations.size(), 1u) << "the heat map moves as the model does";
  EXPECT_EQ(heat.skins.size(), 1u);
  const Outcome moment =
      saliency({arm, "-o", out("moment.npy"), "--animation", "0", "--time", "0.5", "--json"});
  ASSERT_EQ(moment.code, 0) << moment.err;
  EXPECT_EQ(moment.json()["poses"], nlohmann::json::array({"animation 0 at 0.50 s"}));
}

TEST_F(SaliencyVerb, ThePresetsDiffer) {
  std::vector<std::vector<float>> fields;
  for (const char* preset : {"fovea", "yang", "lee", "munaretti"}) {
    const std::string path = out(std::string(preset) + ".npy");
    ASSERT_EQ(saliency({grid_, "-o", path, "--preset", preset}).code, 0);
    fields.push_back(read_field(path));
    for (std::size_t i = 0; i + 1 < fields.size(); ++i) EXPECT_NE(fields[i], fields.back()) << preset;
  }
}

TEST_F(SaliencyVerb, WritesTheSameForAnyThreads) {
  for (const char* name : {"heat.glb", "heat.png", "heat.npy"}) {
    for (const std::string threads : {"1", "2"})
      ASSERT_EQ(saliency({grid_, "-o", out(threads + name), "--threads", threads}).code, 0);
    EXPECT_EQ(read_text(out(std::string("1") + name)), read_text(out(std::string("2") + name))) << name;
  }
}

TEST_F(SaliencyVerb, TextNamesMapsAndOutput) {
  const Outcome outcome = saliency({grid_, "-o", out("heat.glb")});
  for (const char* word : {"geometry", "visibility", "saliency", "median", "1 pose"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
  EXPECT_THAT(outcome.out, HasSubstr(grid_ + " -> " + out("heat.glb")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("contrast")));
  EXPECT_THAT(saliency({grid_, "-o", out("more.glb"), "--verbose"}).out, HasSubstr("contrast"));
  EXPECT_THAT(saliency({grid_, "-o", out("quiet.glb"), "--quiet"}).out, IsEmpty());
}

TEST_F(SaliencyVerb, RefusesWhatItCannotDo) {
  const std::string square = folder_.write("square.obj", square_obj());
  const std::vector<std::string> before = folder_.names();
  struct Case {
    std::vector<std::string> words;
    int code;
    const char* message;
  };
  const Case cases[] = {
      {{grid_}, 2, "-o"},
      {{"-o", out("x.glb")}, 2, "MODEL"},
      {{grid_, "-o", out("x.abc")}, 2, ".abc"},
      {{grid_, "-o", out("x.glb"), "--as", "field"}, 2, "known for fields: .npy, .csv, .txt"},
      {{grid_, "-o", out("x.glb"), "--columns", "3"}, 2, "--columns needs a picture as output"},
      {{grid_, "-o", out("x.png"), "--elevation", "9", "--views", "cube"},
       2,
       "--elevation needs --views orbit"},
      {{grid_, "-o", out("x.npy"), "--map", "heigth"}, 2, "did you mean height? there are: all, "},
      {{grid_, "-o", out("x.glb"), "--as", "picture"}, 2, ".png"},
      {{grid_, "-o", out("x.npy"), "--as", "texture"}, 2, ".png"},
      {{grid_, "-o", out("x.png"), "--as", "heat"}, 2, ".glb"},
      {{grid_, "-o", out("x.csv"), "--as", "attribute"}, 2, ".glb"},
      {{grid_, "-o", out("x.obj"), "--as", "attribute"}, 2, "no place"},
      {{grid_, "-o", out("x.glb"), "--as", "photo"}, 2, "texture"},
      {{square, "-o", out("x.png"), "--as", "texture"},
       5,
       "square.obj: no triangle has a texture as its base colour"},
      {{grid_, "-o", grid_}, 2, "the output is an input"},
      {{square, grid_, "-o", grid_}, 2, "the output is an input"},
      {{grid_, "-o", folder_ / "no/x.npy"}, 7, "folder"},
      {{grid_, "-o", out("x.png"), "--views", "cameras"}, 5, "grid.glb: the model has no cameras"},
      {{grid_, "-o", out("x.png"), "--view-size", "8192", "--columns", "9", "--view-count", "9"}, 2, "65536"},
      {{grid_, "-o", out("x.glb"), "--preset", "itti"}, 2, "munaretti"},
      {{grid_, "-o", out("x.glb"), "--entropy-window", "8"}, 2, "even"},
      {{grid_, "-o", out("x.glb"), "--animation", "3"}, 5, "grid.glb: the model has no animation 3"},
      {{grid_, "-o", out("x.glb"), "--time", "1"}, 2, "--animation"},
      {{grid_, "-o", out("x.glb"), "--key-poses", "65"}, 2, "1..64"},
      {{grid_, "-o", out("x.glb"), "--geometry-weight", "-1"}, 2, "0..1000"},
      {{grid_, "-o", out("x.glb"), "--preset", "lee", "--geometry-weight", "0"}, 2, "weight"},
  };
  for (const Case& c : cases) {
    const Outcome outcome = saliency(c.words);
    EXPECT_EQ(outcome.code, c.code) << c.message << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(c.message));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
  EXPECT_EQ(folder_.names(), before) << "nothing is left behind";
}

TEST_F(SaliencyVerb, ExistingFilesAreKept) {
  const std::string two = write_two_textures();
  struct Case {
    const char* kept;
    std::vector<std::string> words;
  };
  // The first file of an output and one that comes later.
  const Case cases[] = {
      {"x.npy", {grid_, "-o", out("x.npy"), "--map", "all"}},
      {"x-geometry.npy", {grid_, "-o", out("x.npy"), "--map", "all"}},
      {"x.glb", {grid_, "-o", out("x.glb")}},
      {"x-image1.png", {two, "-o", out("x.png"), "--as", "texture"}},
      {"x-height-image1.png", {two, "-o", out("x.png"), "--as", "texture", "--map", "all"}}};
  for (const Case& c : cases) {
    const std::string path = folder_.write(c.kept, "precious");
    const Outcome outcome = saliency(c.words);
    EXPECT_EQ(outcome.code, 2) << c.kept;
    EXPECT_THAT(outcome.err, HasSubstr(path + ": the file exists"));
    EXPECT_THAT(outcome.err, HasSubstr("--force"));
    EXPECT_EQ(read_text(path), "precious");
    EXPECT_THAT(folder_.names(), ElementsAre("grid.glb", "two.glb", c.kept)) << "no other file was written";
    std::filesystem::remove(path);
  }
  folder_.write("x-geometry.npy", "old");
  EXPECT_EQ(saliency({grid_, "-o", out("x.npy"), "--map", "all", "--force"}).code, 0);
  EXPECT_NE(read_text(out("x-geometry.npy")), "old");
}

TEST_F(SaliencyVerb, AFileOfAMapIsNoInputEither) {
  const std::string input = out("x-geometry.glb");
  std::filesystem::rename(grid_, input);
  const std::string before = read_text(input);
  const Outcome outcome = saliency({input, "-o", out("x.glb"), "--map", "all"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("the output is an input"));
  EXPECT_EQ(read_text(input), before);
  EXPECT_THAT(folder_.names(), ElementsAre("x-geometry.glb"));
}

TEST_F(SaliencyVerb, ModelsOfAnySizeHaveNumbers) {
  for (const char* size : {"1e38", "1e-30"}) {
    const std::string one(size),
        square = folder_.write("square.obj", "v 0 0 0\nv " + one + " 0 0\nv " + one + " " + one + " 0\nv 0 " +
                                                 one + " " + one + "\nf 1 2 3\nf 1 3 4\n");
    for (const char* name : {"x.glb", "x.csv", "x.png"}) {
      const Outcome outcome = saliency({square, "-o", out(name), "--map", "all", "--force", "--json"});
      EXPECT_EQ(outcome.code, 0) << name << outcome.err;
      for (const auto& [map, statistics] : outcome.json()["maps"].items()) {
        for (const auto& [key, number] : statistics.items()) EXPECT_TRUE(number.is_number()) << map << key;
      }
    }
    const std::vector<float> field = read_field(out("x.csv"));
    EXPECT_EQ(*std::min_element(field.begin(), field.end()), 0);
    EXPECT_EQ(*std::max_element(field.begin(), field.end()), 1);
  }
}

// --- simplify --saliency ---------------------------------------------------------------------------

class SimplifySaliency : public SaliencyVerb {
 protected:
  Outcome simplify(const std::string& name, std::vector<std::string> words) const {
    words.insert(words.begin(), {"simplify", grid_, "-o", out(name), "--ratio", "0.2", "--json"});
    return fovea(words);
  }
};

TEST_F(SimplifySaliency, EveryPresetHasAResultOfItsOwn) {
  std::vector<std::string> files;
  for (const char* source : {"none", "fovea", "yang", "lee", "munaretti"}) {
    const std::string name = std::string(source) + ".glb";
    const Outcome outcome = simplify(name, {"--saliency", source});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json["options"]["saliency"], source);
    EXPECT_EQ(json.contains("saliency"), std::string(source) != "none");
    if (json.contains("saliency")) {
      EXPECT_EQ(json["saliency"]["poses"], nlohmann::json::array({"rest"}));
    }
    EXPECT_EQ(json["result"]["reached"], true);
    files.push_back(read_text(out(name)));
    for (std::size_t i = 0; i + 1 < files.size(); ++i) EXPECT_NE(files[i], files.back()) << source;
  }
  ASSERT_EQ(simplify("plain.glb", {}).code, 0);
  EXPECT_EQ(read_text(out("plain.glb")), files[0]) << "none is the default";
}

TEST_F(SimplifySaliency, WeightingAndStrengthCount) {
  const auto result = [&](const std::string& name, std::vector<std::string> words) {
    words.insert(words.begin(), {"--saliency", "fovea"});
    const Outcome outcome = simplify(name, words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_text(out(name));
  };
  const std::string yang = result("yang.glb", {}), lee = result("lee.glb", {"--saliency-weighting", "lee"}),
                    strong = result("strong.glb", {"--saliency-strength", "4"}),
                    weak = result("weak.glb", {"--saliency-strength", "0"});
  EXPECT_NE(yang, lee);
  EXPECT_NE(yang, strong);
  ASSERT_EQ(simplify("plain.glb", {}).code, 0);
  EXPECT_EQ(weak, read_text(out("plain.glb"))) << "all vertices alike";
}

TEST_F(SimplifySaliency, AutoSaysWhatItTriedAndChose) {
  const Outcome outcome = simplify("auto.glb", {"--saliency", "auto"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json found = outcome.json()["saliency"];
  ASSERT_TRUE(found.is_object()) << outcome.out;
  ASSERT_GE(found["trials"].size(), 3u);
  EXPECT_EQ(found["trials"][0]["name"], "none");
  double least = 1, chosen = 2;
  for (const auto& trial : found["trials"]) {
    least = std::min(least, trial["flip"].get<double>());
    if (trial["name"] == found["chosen"]) chosen = trial["flip"];
  }
  EXPECT_EQ(chosen, least);
  EXPECT_GT(found["seconds"], 0);
  const Outcome text = fovea({"simplify", grid_, "-o", out("b.glb"), "--ratio", "0.2", "--saliency", "auto"});
  EXPECT_THAT(text.out, HasSubstr("saliency " + found["chosen"].get<std::string>()));
  EXPECT_EQ(read_text(out("auto.glb")), read_text(out("b.glb")));
}

TEST_F(SimplifySaliency, AloneIsAutoWhereverItStands) {
  const auto source = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"-o", out("alone.glb"), "--ratio", "0.2", "--json", "--force"});
    const Outcome outcome = fovea(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.json()["options"]["saliency"];
  };
  EXPECT_EQ(source({"simplify", "--saliency", grid_}), "auto") << "what follows is a file";
  EXPECT_EQ(source({"simplify", grid_, "--saliency"}), "auto") << "an option follows";
  EXPECT_EQ(source({"simplify", "--saliency", "lee", grid_}), "lee");
  EXPECT_EQ(source({"simplify", grid_, "--saliency=lee"}), "lee");
  EXPECT_EQ(simplify("last.glb", {"--saliency"}).json()["options"]["saliency"], "auto");
  const Outcome misspelt = fovea({"simplify", "--saliency", "leee", grid_, "-o", out("no.glb")});
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("'leee'"));
  EXPECT_THAT(misspelt.err, HasSubstr("hint: did you mean lee?"));
}

TEST_F(SimplifySaliency, GoesWithImportance) {
  const std::size_t count = model(grid_).meshes[0].surface.source_vertex.size();
  std::string csv;
  for (std::size_t i = 0; i < count; ++i) csv += i < 10 ? "5\n" : "1\n";
  const std::string importance = folder_.write("own.csv", csv);
  for (const char* source : {"fovea", "auto"}) {
    const std::string a = std::string(source) + "-own.glb", b = std::string(source) + ".glb";
    ASSERT_EQ(simplify(a, {"--saliency", source, "--importance", importance}).code, 0);
    ASSERT_EQ(simplify(b, {"--saliency", source}).code, 0);
    EXPECT_NE(read_text(out(a)), read_text(out(b))) << "both count";
  }
}

TEST_F(SimplifySaliency, KeyPosesOfAnAnimation) {
  const std::string arm = out("arm.glb");
  ASSERT_EQ(fovea({"sample", "arm", "-o", arm, "--detail", "0.03"}).code, 0);
  const Outcome outcome = fovea({"simplify", arm, "-o", out("small.glb"), "--ratio", "0.3", "--saliency",
                                 "munaretti", "--key-poses", "3", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(outcome.json()["saliency"]["poses"].size(), 1u);
}

TEST_F(SimplifySaliency, WrongValuesAreRefused) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--saliency", "itti"}, "none|fovea|yang|lee|munaretti|auto"},
      {{"--saliency-weighting", "strong"}, "yang"},
      {{"--saliency-strength", "11"}, "0..10"},
      {{"--saliency-strength", "1"}, "--saliency-strength needs a preset"},
      {{"--saliency-weighting", "yang", "--saliency", "auto"}, "--saliency-weighting needs a preset"},
      {{"--up", "z"}, "--up needs --saliency"},
      {{"--saliency-strength", "-1"}, "0..10"},
      {{"--saliency", "lee", "--key-poses", "0"}, "1..64"},
      {{"--saliency", "lee", "--up", "w"}, "up"},
  };
  for (const auto& [words, message] : cases) {
    const Outcome outcome = simplify("x.glb", words);
    EXPECT_EQ(outcome.code, 2) << message;
    EXPECT_THAT(outcome.err, HasSubstr(message));
  }
  EXPECT_THAT(folder_.names(), ElementsAre("grid.glb"));
}

TEST_F(SimplifySaliency, CancellingLeavesNoDebris) {
  const std::string grid = write_grid(folder_, "large.glb", 300);
  for (const char* verb : {"saliency", "simplify"}) {
    std::vector<std::string> words{verb, grid, "-o", out("out.glb"), "--verbose"};
    if (std::string(verb) == "simplify") words.insert(words.end(), {"--ratio", "0.1", "--saliency", "auto"});
    Running running(words);
    ASSERT_TRUE(running.wait_for_talk());
    running.send(SIGINT);
    EXPECT_EQ(running.wait().code, 130) << verb;
    EXPECT_THAT(folder_.names(), ElementsAre("grid.glb", "large.glb"));
  }
}

}  // namespace
}  // namespace fovea::test
