#include "verb.h"

namespace fovea::cli {

std::unique_ptr<Verb> make_info();
std::unique_ptr<Verb> make_simplify();
std::unique_ptr<Verb> make_lods();
std::unique_ptr<Verb> make_focus();
std::unique_ptr<Verb> make_fit();
std::unique_ptr<Verb> make_texture();
std::unique_ptr<Verb> make_saliency();
std::unique_ptr<Verb> make_segment();
std::unique_ptr<Verb> make_fly();
std::unique_ptr<Verb> make_compare();
std::unique_ptr<Verb> make_render();
std::unique_ptr<Verb> make_sample();

std::vector<std::unique_ptr<Verb>> make_verbs() {
  std::vector<std::unique_ptr<Verb>> verbs;
  for (const auto make : {make_info, make_simplify, make_lods, make_focus, make_fit, make_texture,
                          make_saliency, make_segment, make_fly, make_compare, make_render, make_sample})
    verbs.push_back(make());
  return verbs;
}

}  // namespace fovea::cli
