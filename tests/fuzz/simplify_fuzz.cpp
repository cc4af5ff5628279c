// Makes a model and options of the bytes, simplifies it, and writes and reads all its levels.

#include <cstdio>

#include "fovea/lod/levels_file.h"
#include "fuzz/fuzz_model.h"
#include "support/any_model.h"
#include "support/result_fault.h"

using namespace fovea;

namespace {

void expect_none(const std::string& fault) {
  if (fault.empty()) return;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}

void expect_levels(const Model& model, const CollapseRecord& record, Context& context) {
  const LeveledModel leveled{model, make_multi_tessellation(model, record, context)};
  const std::vector<std::byte> bytes = encode_levels(leveled, {}, context);
  const LeveledModel back = read_levels(bytes, "fuzz.fovea", {}, fuzz::small_limits(), context);
  for (const Mesh& mesh : back.original.meshes) check(mesh.surface);
  if (counts(back.original).triangles != counts(model).triangles)
    expect_none("the levels have another original");
  if (counts(coarsest(back)).triangles != counts(coarsest(leveled)).triangles)
    expect_none("the levels have another coarsest");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  test::Choices choices(std::span(data, size));
  const SimplifyOptions options = test::any_simplify_options(choices, static_cast<Metric>(choices.below(6)));
  const bool with_levels = choices.one_in(4);
  const Model model = test::any_model(choices);
  const Importance importance = test::any_importance(choices, model);
  fuzz::expect_answer([&] {
    Context context;
    context.threads = 1;
    const SimplifyResult result = simplify(model, options, importance, context);
    expect_none(test::fault_of({model, options, importance, result}));
    if (with_levels && !options.per_mesh) expect_levels(model, result.record, context);
  });
  return 0;
}
