#include "saliency_source.h"

namespace fovea::cli {

std::vector<std::string> saliency_sources(bool can_choose) {
  std::vector<std::string> names{"none"};
  SaliencyOptions options;
  for (const Option& option : describe(options)) {
    if (option.name != "preset") continue;
    const std::vector<std::string>& presets = std::get<Option::Choice>(option.value).names;
    names.insert(names.end(), presets.begin(), presets.end());
  }
  if (can_choose) names.emplace_back("auto");
  return names;
}

std::optional<SaliencyPreset> preset_of(SaliencySource source) {
  if (source == SaliencySource::none || source == SaliencySource::chosen) return std::nullopt;
  return static_cast<SaliencyPreset>(static_cast<int>(source) - static_cast<int>(SaliencySource::fovea));
}

}  // namespace fovea::cli
