#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>

#include "field_source.h"
#include "fovea/base/text.h"
#include "fovea/budget/fit.h"
#include "fovea/io/extension.h"
#include "fovea/io/gltf_write.h"
#include "fovea/io/read.h"
#include "fovea/io/write.h"
#include "fovea/lod/levels_file.h"
#include "fovea/lod/lod_chain.h"
#include "fovea/lod/lod_chain_files.h"
#include "fovea/lod/lod_chain_gltf.h"
#include "input.h"
#include "lods_text.h"
#include "report.h"
#include "shared_options.h"
#include "text.h"
#include "verb.h"

namespace fovea::cli {

namespace {

namespace fs = std::filesystem;

enum class LevelTextures { follow, keep };
enum class LevelRebake { off, on };
/// What is written. The first leaves it to the extension of the output.
enum class LodsOutput { by_extension, chain, levels };
/// Of the coarsest of all levels, if nobody says how many triangles it is to have.
constexpr double kCoarsestRatio = 0.01;

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

class Lods : public Verb {
 public:
  VerbText text() const override {
    return {
        "lods",
        "make a chain of levels of detail, measured, in files of their own or in one",
        "Simplifies a model once and takes every level from the steps on the way, then measures each against "
        "the "
        "original: distance of the surfaces, at rest and in key poses, and pictures as large as the level "
        "will be. "
        "The output is a folder, which gets NAME_LOD0.glb, NAME_LOD1.glb, ... and NAME_lods.json with all "
        "that is "
        "known of them; or a .glb, which gets all levels as MSFT_lod has them. Level 0 is the original. A "
        "level "
        "that would be no smaller, or no farther from the original, than a neighbour is left out. A .fovea "
        "gets every step from the coarsest level to the original instead, each with its error, so that any "
        "level can be read off it, also one that is finer in places; so does a .glb with --as levels, in "
        "which other programs see the coarsest. All verbs read both as the original. Exit code 8 says "
        "that fewer triangles were asked for than could be reached; the output is written all the same, but "
        "not "
        "if a level takes more than --bytes.",
        {{"fovea lods helmet.glb -o lods", "Four levels, each with half the triangles of the one before."},
         {"fovea lods helmet.glb -o helmet-lods.glb --triangles 8000,2000,500",
          "The original and three levels of so many triangles in one file."},
         {"fovea lods chair.glb -o lods --coverage 0.5,0.25,0.1",
          "Each level as simple as one pixel of error allows where the chair takes a half, a quarter, a "
          "tenth of "
          "the screen's height."},
         {"fovea lods helmet.glb -o lods --bytes 600KB,150KB,40KB --quantize",
          "Three levels of so many bytes, triangles and texels as they look best."},
         {"fovea lods tree.glb -o lods --distances 20,50,200 --fov 70 --height 1440 --pixel-error 2",
          "The same by distances, on another screen."},
         {"fovea lods rock.glb -o rock-lods.glb --share-vertices",
          "All levels from one list of vertices, of which each uses a beginning."},
         {"fovea lods fox.glb -o lods --name 'LOD{i}_{name}' --textures keep",
          "Names as Unreal has them; every level has all texels."},
         {"fovea lods bunny.ply -o bunny.fovea --triangles 500",
          "All levels down to 500 triangles, for \"fovea focus bunny.fovea\" and programs."}}};
  }

  void declare(Arguments& arguments) override {
    arguments.add(model_argument(input_));
    arguments.add("Levels", level_options());
    arguments.add("Levels",
                  {{"as",
                    "A chain of some levels, or all levels with the steps between them, for which "
                    "--triangles is the coarsest (1 % by itself). By itself as the extension says: .fovea "
                    "has all levels, folders and .glb have chains.",
                    choice(as_, {"extension", "chain", "levels"}), ""}});
    arguments.add("Simplification", simplify_options());
    arguments.add(
        "Simplification",
        {describe_field("importance", "How much each vertex matters (1 is neutral, more keeps)", importance_),
         {"allow-miss", "Exit with 0 even if a number of triangles is not reached.", &allow_miss_, ""}});
    arguments.add("Textures", texture_options());
    arguments.add("Errors", error_options());
    arguments.add("Output", output_options());
    arguments.add("Output", describe(write_options_));
    arguments.add("Limits", describe(read_options_));
    declare_needs(arguments);
    arguments.add_hint("ratio", "a ratio is a fraction: 0.5 halves the triangles from level to level");
  }

  int run(Session& session) override {
    check_request();
    const Input input = read_input(session, input_, read_options_);
    need_triangles(input);
    session.report["inputs"] = inputs_json({&input, 1});
    Importance importance;
    if (!importance_.empty())
      importance = session.phase("importance", [&] { return load_importance(input); });
    if (has_all_levels()) return write_levels(session, input, importance);
    if (input.levels) options_.record = &input.levels->record;
    if (share_vertices_) share_vertices(input);
    if (rebake_ == LevelRebake::on) options_.textures.rebake.original = &input.model;
    if (!options_.bytes.empty()) {
      const std::optional<std::uint64_t> smallest =
          session.phase("split", input_, [&] { return split_bytes(input.model, session.context); });
      if (smallest)
        return too_many_bytes(session, options_.bytes.back(), *smallest,
                              "--quantize and --compression meshopt take less");
    }
    LodChain chain = session.phase(
        "levels", input_, [&] { return make_lod_chain(input.model, options_, importance, session.context); });
    std::vector<LodFile> files = session.phase("encode", [&] {
      return make_lod_files(chain, name_, stem(), original(input), write_options_, session.context);
    });
    if (chain.levels.size() < 2) {
      throw Error(ErrorKind::unsupported, "no level is smaller than the original", input_,
                  "the notes say why; for a file that is compressed, --quantize --compression meshopt");
    }
    for (std::size_t i = 0; i < files.size() && !allow_miss_; ++i) {
      const std::uint64_t most = chain.levels[i].most_bytes;
      if (most > 0 && files[i].glb.size() > most)
        return too_many_bytes(session, most, files[i].glb.size(), "--textures follow lets images give way");
    }
    const std::string sidecar = lod_sidecar(chain, files, fs::path(input_).filename().string());
    const std::vector<std::string> written =
        session.phase("write", [&] { return write(chain, files, sidecar, session.context); });
    return tell(session, chain, files, sidecar, written);
  }

 private:
  /// Levels keep to the vertices of the original.
  void share_vertices(const Input& input) {
    options_.simplify.placement = Placement::half_edge;
    options_.textures.moves = TexelMoves::none;
    if (!input.levels) return;
    const auto moves = [](const CollapseStep& step) { return step.moved; };
    if (std::ranges::any_of(input.levels->record.steps, moves))
      throw Error(ErrorKind::usage, "the steps of this file move vertices, which levels cannot share then",
                  input_, "make it with --placement half-edge, or leave out --share-vertices");
  }

  OptionList level_options() {
    OptionList list = describe(options_);
    std::erase_if(list, [](const Option& o) { return o.name != "levels" && o.name != "ratio"; });
    list.push_back(
        {"triangles", "Triangles of levels 1, 2, ..., falling: 10000,3000,500.", &triangles_, "counts"});
    list.push_back(
        {"coverage",
         "Where levels 1, 2, ... come in, falling: the part of the screen's height that the model's "
         "bounding sphere takes there. Each level is as simple as --pixel-error allows.",
         &coverages_, "fractions"});
    list.push_back({"distances",
                    "The same as distances from the eye to the sphere's centre, rising, in scene units.",
                    &distances_, "lengths"});
    list.push_back(
        {"bytes",
         "Bytes of the files of levels 1, 2, ..., falling: 500KB,120KB,30KB. Each has triangles and "
         "texels so that pictures lose least.",
         &bytes_, "sizes"});
    const OptionList screen = describe_screen();
    list.insert(list.end(), screen.begin(), screen.end());
    return list;
  }

  OptionList describe_screen() { return describe(options_.screen); }

  OptionList simplify_options() {
    static const std::set<std::string> kTaken{"placement",     "uv-weight",       "normal-weight",
                                              "color-weight",  "boundary-weight", "seam-weight",
                                              "lock-boundary", "keep-topology"};
    OptionList list = describe(options_.simplify);
    std::erase_if(list, [](const Option& o) { return !kTaken.contains(o.name); });
    list.push_back(
        {"metric",
         "What a collapse costs, as of \"fovea simplify\". auto: quadric for all levels, but pictures for "
         "the last part of the way to the coarsest of given counts, if it is small enough.",
         choice(options_.simplify.metric,
                {"auto", "quadric", "visibility", "entropy", "polygon-entropy", "image"}),
         ""});
    return list;
  }

  OptionList texture_options() {
    OptionList list{
        {"textures",
         "Whether the images of a level follow its size on the screen: about one texel for each pixel that "
         "shows "
         "them where the level comes in, as seen from all around.",
         choice(textures_, {"follow", "keep"}), ""},
        {"rebake", "Whether they are baked anew for the level's surface, too; then levels share fewer.",
         choice(rebake_, {"off", "on"}), ""}};
    for (const Option& option : describe(options_.textures)) {
      if (option.name == "warp" || option.name == "texture-format" || option.name == "texture-psnr")
        list.push_back(option);
    }
    return list;
  }

  OptionList error_options() {
    OptionList list = describe(options_);
    std::erase_if(list, [](const Option& o) { return o.name == "levels" || o.name == "ratio"; });
    list.push_back({"pictures", "Compare pictures of each level with the original's, which takes longer.",
                    &options_.pictures, ""});
    return list;
  }

  OptionList output_options() {
    return {
        {"output", "A folder for a file for each level, or a .glb or .fovea for all of them.", &output_,
         "folder or file"},
        {"name", "Name of a level's file: {name} is the model's, {i} the level's number.", &name_, "pattern"},
        {"vanish", "The coverage below which not even the last level is shown; 0 always shows it.", &vanish_,
         "", 0, 1},
        {"share-vertices",
         "Let all levels of a .glb be made of the same vertices, so that they differ in indices alone; edges "
         "then collapse to one of their ends (--placement half-edge), and texels do not move (--warp none).",
         &share_vertices_, ""}};
  }

  void declare_needs(Arguments& arguments) {
    need_format(arguments, write_options_);
    arguments.need({{"levels", "ratio"}, "no --triangles, --coverage, --distances and --bytes", [this] {
                      return triangles_.empty() && coverages_.empty() && distances_.empty() && bytes_.empty();
                    }});
    arguments.need({{"rebake", "warp", "texture-format", "texture-psnr"}, "--textures follow", [this] {
                      return textures_ == LevelTextures::follow;
                    }});
    arguments.need({{"name", "bytes"}, "a folder as output", [this] { return !is_one_file(); }});
    arguments.need({{"vanish", "share-vertices"}, "a .glb as output", [this] { return is_one_file(); }});
    arguments.need({{"placement", "warp", "rebake"},
                    "levels with vertices of their own",
                    [this] { return !share_vertices_; },
                    "leave it out, or --share-vertices"});
    std::vector<std::string> of_chains{"levels",         "ratio",          "coverage",     "distances",
                                       "textures",       "rebake",         "warp",         "vanish",
                                       "share-vertices", "texture-format", "texture-psnr", "bytes"};
    for (const Option& option : describe_screen()) of_chains.push_back(option.name);
    for (const Option& option : error_options()) of_chains.push_back(option.name);
    arguments.need({of_chains, "a chain, not all levels", [this] { return !has_all_levels(); }});
    std::vector<std::string> of_steps{"importance"};
    for (const Option& option : simplify_options()) of_steps.push_back(option.name);
    const auto has_no_steps = [this] { return find_levels(input_) == LevelsPlace::none; };
    const std::string hint = "this file has its steps already";
    arguments.need({of_steps, "a model without levels", has_no_steps, hint});
    arguments.need({{"triangles"},
                    "a chain, or a model without levels",
                    [this, has_no_steps] { return !has_all_levels() || has_no_steps(); },
                    hint});
  }

  bool is_one_file() const {
    const std::string extension = lower_extension(output_);
    return (extension == ".glb" || extension == ".fovea") && !is_folder(output_);
  }
  bool has_all_levels() const {
    if (as_ != LodsOutput::by_extension) return as_ == LodsOutput::levels;
    return lower_extension(output_) == ".fovea";
  }
  std::string stem() const { return fs::path(input_).stem().string(); }
  std::string sidecar_name() const { return stem() + "_lods.json"; }

  void check_request() {
    read_lists();
    options_.textures_follow = textures_ == LevelTextures::follow;
    check_input(input_);
    const std::string example = has_all_levels() ? "model.fovea" : is_one_file() ? "lods.glb" : "lods";
    check_output(output_, example, {input_}, write_options_.force, [&](const fs::path& path) {
      if (has_all_levels() || lower_extension(path) == ".fovea") {
        check_extension(
            path, "levels",
            has_all_levels() ? std::vector<std::string>{".fovea", ".glb"} : std::vector<std::string>{".glb"});
        check_place(path, write_options_.force);
      } else if (is_one_file()) {
        fovea::check_output(path, write_options_);
      } else {
        check_folder(path);
      }
    });
  }

  void read_lists() {
    options_.triangles = count_list(triangles_, "triangles");
    options_.coverages = number_list(coverages_, "coverage");
    options_.distances = number_list(distances_, "distances");
    if (!bytes_.empty()) options_.bytes = parse_byte_list("--bytes", bytes_);
    const int given = !triangles_.empty() + !coverages_.empty() + !distances_.empty() + !bytes_.empty();
    if (given > 1)
      throw Error(ErrorKind::usage, "levels are asked for in several ways", {},
                  "give one of --triangles, --coverage, --distances and --bytes");
  }

  /// Where levels are to go: a folder that is there or can be made, with nothing in the way.
  void check_folder(const fs::path& path) const {
    const fs::path folder = folder_of_levels();
    std::error_code ignored;
    const bool exists = fs::exists(path, ignored);
    if (!is_folder(path) && path.has_filename() && path.has_extension())
      throw Error(ErrorKind::usage, "this is neither a folder nor a .glb", output_,
                  "name a folder for a file for each level, or a .glb for all of them");
    if (!exists) {
      check_place(folder, true);
      return;
    }
    if (!is_folder(path)) throw Error(ErrorKind::output, "this is not a folder", output_);
    for (std::size_t i = 0; i < planned_levels(); ++i)
      check_place(folder / lod_name(name_, stem(), i), write_options_.force);
    check_place(folder / sidecar_name(), write_options_.force);
  }

  /// Without a slash at its end.
  fs::path folder_of_levels() const {
    const fs::path path(output_);
    return path.has_filename() ? path : path.parent_path();
  }

  std::size_t planned_levels() const {
    const std::size_t listed = std::max({options_.triangles.size(), options_.coverages.size(),
                                         options_.distances.size(), options_.bytes.size()});
    return listed > 0 ? listed + 1 : static_cast<std::size_t>(options_.levels);
  }

  /// All levels of the input, with the steps between them.
  int write_levels(Session& session, const Input& input, const Importance& importance) {
    if (options_.triangles.size() > 1)
      throw Error(ErrorKind::usage, "all levels have one that is the coarsest", "--triangles",
                  "give one number");
    bool reached = true;
    const LeveledModel leveled = session.phase("levels", input_, [&] {
      return LeveledModel{input.model, input.levels
                                           ? *input.levels
                                           : make_levels(input.model, importance, session.context, reached)};
    });
    std::vector<std::string> written{output_};
    session.phase("encode", [&] {
      if (lower_extension(output_) == ".fovea") {
        const OutputFile file{"", encode_levels(leveled, write_options_, session.context)};
        write_files(output_, {&file, 1}, write_options_.force);
      } else {
        WriteOptions options = write_options_;
        options.quantize = false;  // levels are, and the coarsest is one of them
        write_model(with_levels(leveled, write_options_, session.context), output_, options, session.context);
      }
    });
    const std::uint64_t fewest = counts(coarsest(leveled)).triangles, bytes = fs::file_size(output_);
    const std::uint64_t images = counts(leveled.original).image_bytes;
    const std::size_t steps = leveled.levels.step_count();
    session.report["outputs"] = Json::array({file_json(output_)});
    session.report["result"] = {{"triangles", leveled.levels.triangles},
                                {"triangles_coarsest", fewest},
                                {"steps", steps},
                                {"bytes", bytes},
                                {"image_bytes", images},
                                {"reached", reached}};
    session.print_summary(fmt::format(
        "{} -> {}\nlevels   {} to {} triangles, {}\n"
        "size     {}, of which images {}; the rest is {:.1f} bytes per triangle\ntime     {}\n",
        printable(input_), printable(output_), count_text(fewest), count_text(leveled.levels.triangles),
        plural(steps, "step", "steps"), bytes_text(bytes), bytes_text(images),
        static_cast<double>(bytes - std::min(bytes, images)) /
            static_cast<double>(std::max<std::uint64_t>(1, leveled.levels.triangles)),
        session.spent_text()));
    return target_code(session, reached, allow_miss_);
  }

  MultiTessellation make_levels(const Model& model, const Importance& importance, Context& context,
                                bool& reached) const {
    SimplifyOptions options = options_.simplify;
    if (options.metric == Metric::automatic) options.metric = Metric::quadric;
    if (options_.triangles.empty()) {
      options.ratio = kCoarsestRatio;
    } else {
      options.triangles = options_.triangles.front();
    }
    SimplifyResult result = simplify(model, options, importance, context);
    if (result.stop == StopReason::cancelled) throw Error(ErrorKind::cancelled, "cancelled");
    reached = result.triangles_after <= result.triangles_target;
    return make_multi_tessellation(model, std::move(result.record), context);
  }

  /// Finds the triangles of each level from its bytes; of the smallest file if there are too few for one.
  std::optional<std::uint64_t> split_bytes(const Model& model, Context& context) {
    options_.form = {write_options_, true, stem()};
    FitOptions fit;
    fit.form = options_.form;
    fit.most_bytes = options_.bytes.front();
    fit.format = options_.textures.output.format;
    if (textures_ == LevelTextures::keep) fit.gives = FitGives::triangles;
    BudgetFit splits(model, fit, context);
    // Simplified for all levels alike they take a little more; and a level has fewer triangles than the one
    // before.
    constexpr double kMargin = 0.98, kFewer = 0.8;
    auto most = static_cast<double>(counts(model).triangles);
    for (const std::uint64_t bytes : options_.bytes) {
      const FitResult split = splits.within(bytes);
      if (split.cancelled) throw Error(ErrorKind::cancelled, "cancelled");
      if (!split.reached && !allow_miss_) return split.chosen.bytes;
      most = std::min(kMargin * static_cast<double>(split.chosen.triangles), kFewer * most);
      options_.triangles.push_back(std::max<std::int64_t>(1, static_cast<std::int64_t>(most)));
    }
    return std::nullopt;
  }

  Importance load_importance(const Input& input) const {
    NamedFields found = load_fields(importance_, input, read_options_);
    about(found.path, [&] { check(found.fields); });
    return std::move(found.fields);
  }

  /// The input itself, if it is a GLB that needs no other file.
  std::optional<LodFile> original(const Input& input) const {
    std::error_code vanished;
    const std::uint64_t size = fs::file_size(input_, vanished);
    if (vanished || input.bytes.format != FileFormat::glb || input.bytes.files != size) return std::nullopt;
    return LodFile{"", read_file(input_, read_options_.max_file_bytes), input.bytes.kinds};
  }

  /// Returns what was written.
  std::vector<std::string> write(const LodChain& chain, std::vector<LodFile>& files,
                                 const std::string& sidecar, Context& context) const {
    if (is_one_file()) {
      std::vector<int> level_of;
      const Model all = with_lods(chain, vanish_, context, &level_of);
      if (!share_vertices_) level_of.clear();
      const GltfOutput file = write_gltf(all, true, stem(), write_options_, context, level_of);
      write_files(output_, file.files, write_options_.force);
      return {output_};
    }
    // Named from the folder's own, which is made with them or not at all.
    const fs::path folder = folder_of_levels();
    const fs::path place = fs::absolute(folder).lexically_normal();
    const fs::path inside = place.filename();
    std::vector<OutputFile> outputs;
    std::vector<std::string> written;
    const auto add = [&](const std::string& name, std::vector<std::byte> bytes) {
      outputs.push_back({(inside / name).string(), std::move(bytes)});
      written.push_back((folder / name).string());
    };
    for (const LodFile& file : files) add(file.name, file.glb);
    const auto* text = reinterpret_cast<const std::byte*>(sidecar.data());
    add(sidecar_name(), {text, text + sidecar.size()});
    write_files(place, outputs, write_options_.force);
    return written;
  }

  int tell(Session& session, const LodChain& chain, const std::vector<LodFile>& files,
           const std::string& sidecar, const std::vector<std::string>& written) const {
    Json& outputs = session.report["outputs"] = Json::array();
    for (const std::string& path : written) outputs.push_back(file_json(path));
    const Json levels = Json::parse(sidecar);
    for (const auto& [key, value] : levels.items()) {
      if (key != "schema_version" && key != "source") session.report[key] = value;
    }
    session.report["metric"] = to_string(chain.metric);
    session.report["metric_from_triangles"] = chain.metric_from;
    session.report["reached"] = chain.reached;
    session.print_summary(fmt::format("{} -> {}\n{}time     {}\n", printable(input_), printable(output_),
                                      levels_text(chain, files), session.spent_text()));
    return target_code(session, chain.reached, allow_miss_);
  }

  std::string input_, output_, importance_;
  std::string triangles_, coverages_, distances_, bytes_;
  std::string name_ = "{name}_LOD{i}";
  double vanish_ = 0;
  bool share_vertices_ = false;
  bool allow_miss_ = false;
  LodsOutput as_ = LodsOutput::by_extension;
  LevelTextures textures_ = LevelTextures::follow;
  LevelRebake rebake_ = LevelRebake::off;
  LodChainOptions options_;
  ReadOptions read_options_;
  WriteOptions write_options_;
};

}  // namespace

std::unique_ptr<Verb> make_lods() { return std::make_unique<Lods>(); }

}  // namespace fovea::cli
