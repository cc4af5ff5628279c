#pragma once

#include <string>

#include "fovea/simplify/simplify.h"
#include "session.h"

namespace fovea::cli {

/// True unless a triangle count was asked for and is not there: an error bound that came first, or a
/// model that got as simple as the bound allows, is what was asked for.
bool reached_target(const SimplifyResult& result, const SimplifyOptions& options);

/// "result" of the report: target, reached, stop reason, error, blocked counts.
Json result_json(const SimplifyResult& result, const SimplifyOptions& options, bool reached);

/// What became of it, for people: error, stop reason, and when stuck the reasons and the options that would
/// unblock it.
std::string result_text(const SimplifyResult& result, const SimplifyOptions& options);

}  // namespace fovea::cli
