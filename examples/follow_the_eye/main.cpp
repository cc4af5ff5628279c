// How an engine draws levels that follow the eye: follow_the_eye INPUT.

#include <cmath>
#include <iostream>

#include "fovea/base/error.h"
#include "fovea/io/read.h"
#include "fovea/lod/contraction.h"
#include "fovea/lod/error_selection.h"
#include "fovea/lod/view_dependent_lod.h"
#include "fovea/simplify/simplify.h"

namespace {

/// What an engine does with a part of a level: it has uploaded the vertices once, the indices are new.
void draw(const fovea::LevelPart& part, std::span<const std::uint32_t> indices) {
  std::cout << "  mesh " << part.mesh << ", part " << part.part << ": " << indices.size() / 3
            << " triangles\n";
}

void run(const char* path) {
  fovea::Context context;
  const fovea::Model model = fovea::read_model(path, {}, context);

  // Once, or read from a .fovea file (lod/levels_file.h): simplify, and order the steps.
  fovea::SimplifyOptions options;
  options.metric = fovea::Metric::quadric;
  options.ratio = 0.002;
  fovea::CollapseRecord record = fovea::simplify(model, options, {}, context).record;
  const fovea::MultiTessellation levels = make_multi_tessellation(model, std::move(record), context);

  // Buffers that never change: upload hierarchy.vertices[m].positions and layers.
  const fovea::VertexHierarchy hierarchy = make_vertex_hierarchy(model, levels, context);

  // In every frame. A GpuContraction (gpu/gpu_contraction.h) keeps indices on the card instead.
  fovea::ErrorSelection selection(model, levels);
  fovea::Contraction contraction(hierarchy);
  fovea::ViewDependentLod lod(selection, contraction);
  const fovea::Box box = bounds(model);
  const fovea::Vec3d center = (box.low + box.high) * 0.5;
  for (int frame = 0; frame < 4; ++frame) {
    const double angle = 1.5 * frame, away = 2 * box.diagonal();
    fovea::LevelCamera camera;
    camera.view =
        fovea::view_from(center + fovea::Vec3d{std::sin(angle), 0.3, std::cos(angle)} * away, center, 40);
    camera.width = 1920;
    camera.height = 1080;
    fovea::LevelBudget budget;
    budget.error_px = 1;           // no finer than a pixel of error needs,
    budget.triangles = 1'000'000;  // and never more than that
    if (lod.update(camera, budget)) {
      std::cout << "frame " << frame << ": " << contraction.level().triangle_count() << " of "
                << hierarchy.face_count() << " triangles\n";
    }
    for (std::size_t p = 0; p < hierarchy.parts.size(); ++p)
      draw(hierarchy.parts[p], contraction.level().of_part(hierarchy, p));
  }
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) {
    std::cerr << "usage: follow_the_eye INPUT\n";
    return 2;
  }
  try {
    run(words[1]);
    return 0;
  } catch (const fovea::Error& error) {
    std::cerr << error.what() << '\n';
    return fovea::exit_code(error.kind());
  }
}
