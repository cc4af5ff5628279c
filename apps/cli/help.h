#pragma once

#include <string>

#include "fovea/base/options.h"
#include "verb.h"

namespace fovea::cli {

/// A flag that is on by itself: what users can say is --no-NAME.
bool is_taken_back(const Option& option, const std::string& default_text);
/// What an option, or the taking back of a flag, means.
std::string meaning(const Option& option, const std::string& default_text);

/// `fovea --help`: verbs, common manners, exit codes.
std::string main_help();
/// `fovea VERB --help`.
std::string verb_help(Verb& verb);
/// `fovea --help=markdown`: the options of all verbs as tables (docs/options.md).
std::string options_markdown();

}  // namespace fovea::cli
