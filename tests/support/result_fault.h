#pragma once

#include <string>

#include "fovea/model/model.h"
#include "fovea/simplify/simplify.h"

namespace fovea::test {

/// A simplification: what was asked, and what came of it.
struct SimplifyRun {
  const Model& model;
  const SimplifyOptions& options;
  const Importance& importance;
  const SimplifyResult& result;
};

/// What is wrong with a result whatever was asked for; empty if nothing is. That is:
///
/// - meshes keep their invariants (`check`), no triangle has two corners at one place, all numbers are
/// finite;
/// - counts are those of the record, whose replay gives the same bits and whose errors never fall;
/// - it stopped for a reason that holds: the count is reached, the error is within its bound, or all edges
/// are
///   accounted for;
/// - nothing is torn: the surface has no more edges of one triangle, three, ... than before;
/// - influences are whole and of the joints there were, normals are unit, tangents have a side, colours are
///   within 0 and 1;
/// - what is locked is where it was, with half-edge placement all is;
/// - where topology is to be kept no layer is torn either, and a manifold has as many pieces, handles and
///   holes.
std::string fault_of(const SimplifyRun& run);

/// The first difference between two results of the same request; empty if there is none.
std::string difference(const SimplifyResult& a, const SimplifyResult& b);

}  // namespace fovea::test
