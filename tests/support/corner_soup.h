#pragma once

#include <string>
#include <vector>

#include "fovea/model/tri_mesh.h"

namespace fovea::test {

/// What a mesh says, without how it is indexed or ordered: for each part with triangles, the sorted list of
/// its triangles, each as text of the bits of all attributes of its corners, beginning with the smallest
/// corner so that turned triangles are equal and flipped ones are not. -0 counts as 0, and so
/// does a joint whose weight is 0.
std::vector<std::vector<std::string>> corner_soup(const TriMesh& mesh);

}  // namespace fovea::test
