#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/saliency/model_saliency.h"

namespace fovea::cli {

/// Where people look: anywhere, as a preset of "fovea saliency" says, or as measures best on pictures.
enum class SaliencySource { none, fovea, yang, lee, munaretti, chosen };

/// Their names in this order, the last, "auto", where a verb can choose.
std::vector<std::string> saliency_sources(bool can_choose);

/// None for the first and the last.
std::optional<SaliencyPreset> preset_of(SaliencySource source);

}  // namespace fovea::cli
