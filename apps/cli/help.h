#pragma once

#include <string>

#include "verb.h"

namespace fovea::cli {

/// `fovea --help`: verbs, common manners, exit codes.
std::string main_help();
/// `fovea VERB --help`.
std::string verb_help(Verb& verb);
/// `fovea --help=markdown`: the options of all verbs as tables (docs/options.md).
std::string options_markdown();

}  // namespace fovea::cli
