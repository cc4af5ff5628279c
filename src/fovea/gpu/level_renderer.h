#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "fovea/gpu/gpu_contraction.h"
#include "fovea/lod/level_selection.h"
#include "fovea/lod/vertex_hierarchy.h"
#include "fovea/model/image.h"
#include "fovea/model/model.h"

namespace fovea {

/// Draws levels with OpenGL, plainly: grey, lit from the eye, one sample for each pixel. To measure what
/// drawing them costs, and as an example of how they are drawn. All instances of the model at rest; those of
/// skinned meshes as their first joint places them.
class LevelRenderer {
 public:
  /// In the context that is current, as for GpuContraction. The two must outlive this. Pictures are of so
  /// many pixels, and stay on the card.
  LevelRenderer(const Model& original, const VertexHierarchy& hierarchy, int width, int height);
  ~LevelRenderer();

  /// A level of the processor: uploads its indices.
  void draw(const LevelCamera& camera, const LevelIndices& level);
  /// A level that is on the card.
  void draw(const LevelCamera& camera, const GpuContraction& level);
  /// All triangles of the original, whose indices are there from the beginning.
  void draw(const LevelCamera& camera);

  /// Waits until all is drawn.
  void finish() const;
  /// What was drawn last, RGB.
  Image8 picture() const;

 private:
  struct Card;
  void begin(const LevelCamera& camera) const;
  template <class DrawPart>
  void draw_parts(DrawPart&& draw_part) const;

  const VertexHierarchy& hierarchy_;
  int width_, height_;
  std::unique_ptr<Card> card_;
};

}  // namespace fovea
