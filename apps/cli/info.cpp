#include "info_report.h"
#include "input.h"
#include "shared_options.h"
#include "verb.h"

namespace fovea::cli {

namespace {

class Info : public Verb {
 public:
  VerbText text() const override {
    return {"info",
            "show what is inside a model",
            "Reads a model and lists its meshes, materials, textures, animations and where the bytes are. "
            "Problems "
            "that reading repaired are told as notes.",
            {{"fovea info helmet.glb", "Tables of all that is inside."},
             {"fovea info helmet.glb --json", "The same as one JSON object, every list complete."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add("Limits", describe(read_options_));
  }

  int run(Session& session) override {
    check_input(input_);
    const Input input = read_input(session, input_, read_options_);
    session.report["inputs"] = inputs_json({&input, 1});
    const Snapshot totals = snapshot(input.model, input.bytes);
    const ModelFacts facts =
        session.phase("inspect", input_, [&] { return inspect(input.model, session.context); });
    add_info_json(session.report, input.model, facts, totals);
    session.print(info_text(input_, input.model, facts, totals, session.verbose()));
    return 0;
  }

 private:
  std::string input_;
  ReadOptions read_options_;
};

}  // namespace

std::unique_ptr<Verb> make_info() { return std::make_unique<Info>(); }

}  // namespace fovea::cli
