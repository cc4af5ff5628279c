#include "fovea/sample/sample.h"

#include <fmt/format.h>

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
            "machine.",
            {{"fovea sample vase -o vase.glb", "A painted vase."},
             {"fovea sample terrain -o terrain.glb --detail 4", "A terrain with four times the triangles."},
             {"fovea sample --list", "The names of all samples."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add({"NAME", "A name that --list shows.", &name_, false});
    arguments.add("Sample", {{"list", "List the samples instead of making one.", &list_, ""},
                             {"detail", "Scales the number of triangles.", &detail_, "times", 0.001, 1000}});
    arguments.add("Output", {describe_output(output_)});
    arguments.add("Output", describe(write_options_));
    need_format(arguments, write_options_);
    arguments.need({{"detail", "output"}, "a NAME to make", [&] { return !list_; }});
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

  void make(Session& session) {
    if (name_.empty()) {
      throw Error(ErrorKind::usage, "NAME is missing", {}, "fovea sample --list shows the names");
    }
    check_output(output_, name_ + ".glb", {}, write_options_.force,
                 [&](const auto& path) { fovea::check_output(path, write_options_); });
    const Model model = session.phase("make", [&] { return make_sample(name_, detail_, session.context); });
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
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_sample() { return std::make_unique<Sample>(); }

}  // namespace fovea::cli
