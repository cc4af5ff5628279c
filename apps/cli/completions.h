#pragma once

#include <string>

namespace fovea::cli {

/// What bash, zsh or fish needs to complete verbs, options and the names of choices: `fovea
/// --completions=SHELL`, to be evaluated or installed. Throws Error(usage) for another shell.
std::string completions(const std::string& shell);

}  // namespace fovea::cli
