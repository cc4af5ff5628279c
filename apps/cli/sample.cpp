#include "fovea/sample/sample.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "fovea/io/image_codec.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "report.h"
#include "shared_options.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

class Sample : public Verb {
 public:
  VerbText text() const override {
    return {"sample",
            "make a model to try Fovea with",
            "Makes one of Fovea's own models: textured, with seams, some of them animated. The same on every "
            "machine. Or a terrain of a height map and a picture of the same land.",
            {{"fovea sample vase -o vase.glb", "A painted vase."},
             {"fovea sample terrain -o terrain.glb --detail 4", "A terrain with four times the triangles."},
             {"fovea sample terrain -o land.glb --heights height.png --texture land.jpg --relief 2",
              "Land of your own, 10 m wide and up to 2 m high."},
             {"fovea sample --list", "The names of all samples."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add({"NAME", "A name that --list shows.", &name_, false});
    arguments.add("Sample", {{"list", "List the samples instead of making one.", &list_, ""},
                             {"detail", "Scales the number of triangles.", &detail_, "times", 0.001, 1000}});
    arguments.add(
        "Land", {{"heights",
                  "Height map for terrain, a vertex for each pixel: a grey PNG (8 or 16 bits), JPEG or WebP "
                  "image, white is high.",
                  &heights_, ""},
                 {"texture", "Picture of the same land: PNG, JPEG or WebP.", &texture_, ""},
                 {"land-width", "How long the longer side of the map is.", &map_.width, "metres", 0.001, 1e9},
                 {"relief", "How much higher white is than black.", &map_.relief, "metres", 0, 1e9}});
    arguments.add("Output", {describe_output(output_)});
    arguments.add("Output", describe(write_options_));
    need_format(arguments, write_options_);
    arguments.need({{"detail", "output", "heights"}, "a NAME to make", [&] { return !list_; }});
    arguments.need({{"heights"}, "the NAME terrain", [&] { return name_ == "terrain"; }});
    arguments.need({{"heights"}, "--texture", [&] { return !texture_.empty(); }});
    arguments.need({{"texture", "land-width", "relief"}, "--heights", [&] { return !heights_.empty(); }});
  }

  int run(Session& session) override {
    if (list_) {
      list(session);
    } else {
      make(session);
    }
    return 0;
  }

 private:
  static void list(Session& session) {
    TextTable table("l");
    Json& json = session.report["samples"] = Json::array();
    for (const SampleInfo& sample : samples()) {
      table.row({sample.name, sample.description});
      json.push_back({{"name", sample.name}, {"description", sample.description}});
    }
    session.print(table.text(0));
  }

  std::vector<std::string> inputs() const {
    return heights_.empty() ? std::vector<std::string>{} : std::vector{heights_, texture_};
  }

  static std::vector<std::uint8_t> read_image(const std::string& path) {
    check_input(path);
    const std::vector<std::byte> bytes = read_file(path, ReadOptions().max_file_bytes);
    std::vector<std::uint8_t> encoded(bytes.size());
    std::ranges::transform(bytes, encoded.begin(),
                           [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
    return encoded;
  }

  void read_map(Session& session) {
    session.phase("heights", heights_, [&] { map_.heights = decode_heights(read_image(heights_)); });
    session.phase("texture", texture_, [&] {
      map_.texture.bytes = read_image(texture_);
      decode_image(map_.texture.bytes);  // throws if it is none
      map_.texture.mime_type = image_info(map_.texture.bytes).mime_type;
      map_.texture.name = std::filesystem::path(texture_).stem().string();
    });
    session.report["inputs"] = Json::array();
    for (const std::string& path : inputs()) session.report["inputs"].push_back(file_json(path));
  }

  Model make_model(Session& session) {
    const bool is_mapped = !heights_.empty();
    if (is_mapped) read_map(session);
    return session.phase("make", [&] {
      return is_mapped ? make_terrain(map_, detail_, session.context)
                       : make_sample(name_, detail_, session.context);
    });
  }

  void make(Session& session) {
    if (name_.empty()) {
      throw Error(ErrorKind::usage, "NAME is missing", {}, "fovea sample --list shows the names");
    }
    check_output(output_, name_ + ".glb", inputs(), write_options_.force,
                 [&](const auto& path) { fovea::check_output(path, write_options_); });
    const Model model = make_model(session);
    const auto files =
        session.phase("write", [&] { return write_model(model, output_, write_options_, session.context); });

    const Snapshot made = snapshot(model, measure_output(files, model));
    session.report["outputs"] = Json::array({file_json(output_, made.bytes)});
    session.report["after"] = to_json(made);
    session.print_summary(fmt::format("{} -> {}\n{}, {}, {}\n{}\n", printable(name_), printable(output_),
                                      plural(made.counts.triangles, "triangle", "triangles"),
                                      plural(made.counts.vertices, "vertex", "vertices"),
                                      bytes_text(made.bytes.files), session.spent_text()));
  }

  std::string name_;
  std::string output_;
  bool list_ = false;
  double detail_ = 1;
  std::string heights_, texture_;
  TerrainMap map_;
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_sample() { return std::make_unique<Sample>(); }

}  // namespace fovea::cli
