#include <fmt/format.h>

#include "fovea/io/write.h"
#include "fovea/texture/shrink.h"
#include "input.h"
#include "report.h"
#include "shared_options.h"
#include "shrink_text.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

class TextureVerb : public Verb {
 public:
  VerbText text() const override {
    return {
        "texture",
        "make the textures of a model smaller",
        "Reads a model and makes its images smaller, in texels and in bytes, each as its materials use it: "
        "colours are mixed as light, normals keep their length, alpha masks their coverage, and seams of "
        "repeating textures close. No image's file grows; what cannot be made smaller stays as it was, with "
        "a "
        "word why. The meshes are not touched.",
        {{"fovea texture helmet.glb -o helmet-web.glb --max-texture 1024 --texture-format webp",
          "No side above 1,024 texels, as WebP."},
         {"fovea texture chair.glb -o chair-half.glb --texture-scale 0.5",
          "Half the texels along each side."},
         {"fovea texture room.gltf -o room-jpeg.gltf --texture-format jpeg --texture-psnr 36",
          "JPEG, as small as 36 dB allow."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add("Textures", describe(options_));
    arguments.add("Warp", describe(options_.warp));
    arguments.add("Output", {describe_output(output_)});
    arguments.add("Output", describe(write_options_));
    arguments.add("Limits", describe(read_options_));
    need_format(arguments, write_options_);
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    const Snapshot before = snapshot(input.model, input.bytes);
    session.report["inputs"] = inputs_json({&input, 1});
    session.report["before"] = to_json(before);
    const Shrunk result = session.phase(
        "textures", input_, [&] { return shrink_textures(input.model, options_, {}, session.context); });
    const auto files = session.phase(
        "write", [&] { return write_model(result.model, output_, write_options_, session.context); });
    tell(session, before, snapshot(result.model, measure_output(files, result.model)), result);
    return 0;
  }

 private:
  void check_request() const {
    if (options_.scale == 1 && options_.max_side == 0 && options_.output.format == TextureOutput::keep) {
      throw Error(ErrorKind::usage, "nothing is asked for", {},
                  "give --texture-scale, --max-texture or --texture-format, for example --max-texture 1024");
    }
    check_input(input_);
    check_output(output_, "small.glb", {input_}, write_options_.force,
                 [&](const auto& path) { fovea::check_output(path, write_options_); });
  }

  void tell(Session& session, const Snapshot& before, const Snapshot& after, const Shrunk& result) const {
    session.report["outputs"] = Json::array({file_json(output_, after.bytes)});
    session.report["after"] = to_json(after);
    session.print_summary(fmt::format("{} -> {}\n{}{}time     {}\n", printable(input_), printable(output_),
                                      comparison_text(before, after), tell_shrunk(session, result, false),
                                      session.spent_text()));
  }

  std::string input_;
  std::string output_;
  ShrinkOptions options_;
  ReadOptions read_options_;
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_texture() { return std::make_unique<TextureVerb>(); }

}  // namespace fovea::cli
