#include <fmt/format.h>

#include "fovea/io/gltf_scene_read.h"

namespace fovea::gltf {

namespace {

Interpolation interpolation(const JsonView& json) {
  const auto member = json.find("interpolation");
  if (!member || member->text() == "LINEAR") return Interpolation::linear;
  if (member->text() == "STEP") return Interpolation::step;
  if (member->text() == "CUBICSPLINE") return Interpolation::cubic_spline;
  member->fail(shown(member->text()) + " is not an interpolation");
}

Accessor read_accessor(ReadState& state, const JsonView& reference) {
  return state.data.read(state.data.accessor_index(reference));
}

AnimationSampler read_animation_sampler(ReadState& state, const JsonView& json) {
  AnimationSampler sampler;
  sampler.interpolation = interpolation(json);
  const JsonView input = json.at("input");
  sampler.input = read_accessor(state, input);
  if (sampler.input.width != 1 || sampler.input.storage.type != ComponentType::f32) {
    input.fail("times are SCALAR float");
  }
  sampler.output = read_accessor(state, json.at("output"));
  // A cubic spline has a tangent on either side of every value.
  const std::size_t per_key = sampler.interpolation == Interpolation::cubic_spline ? 3 : 1;
  const std::size_t keys = sampler.input.count * per_key;
  if (keys == 0 ? sampler.output.count != 0 : sampler.output.count % keys != 0) {
    json.at("output").fail(fmt::format("{} values for {} times", sampler.output.count, sampler.input.count));
  }
  sampler.json = state.keeper.keep(without(json.raw(), {"input", "output"}), json);
  return sampler;
}

AnimationChannel read_channel(ReadState& state, const JsonView& json, std::size_t sampler_count) {
  AnimationChannel channel;
  channel.sampler = json.at("sampler").index(sampler_count, "samplers");
  const JsonView target = json.at("target");
  channel.node = target.index("node", state.count("nodes"), "nodes");
  channel.path = target.at("path").text();
  channel.json = state.keeper.keep(json.raw(), json);
  return channel;
}

/// What a channel drives needs values of a certain shape; whoever evaluates it relies on that.
void check_values(const AnimationChannel& channel, const AnimationSampler& sampler, const JsonView& json) {
  const int width = channel.path == "rotation"                                 ? 4
                    : channel.path == "translation" || channel.path == "scale" ? 3
                                                                               : 0;
  const std::size_t per_key = sampler.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (width != 0 &&
      (sampler.output.width != width || sampler.output.count != sampler.input.count * per_key)) {
    json.fail(fmt::format("{} values of {} components do not drive a {} at {} times", sampler.output.count,
                          sampler.output.width, channel.path, sampler.input.count));
  }
}

Animation read_animation(ReadState& state, const JsonView& json) {
  Animation animation;
  animation.name = json.text("name");
  for (const JsonView& sampler : json.at("samplers").elements()) {
    state.add(animation.samplers, read_animation_sampler(state, sampler), sampler);
  }
  for (const JsonView& channel : json.at("channels").elements()) {
    state.add(animation.channels, read_channel(state, channel, animation.samplers.size()), channel);
    const AnimationChannel& made = animation.channels.back();
    check_values(made, animation.samplers[static_cast<std::size_t>(made.sampler)], channel);
  }
  animation.json = state.keeper.keep(without(json.raw(), {"samplers", "channels"}), json);
  return animation;
}

}  // namespace

void read_animations(ReadState& state) {
  for (const JsonView& json : state.root.elements("animations")) {
    state.add(state.model.animations, read_animation(state, json), json);
  }
}

}  // namespace fovea::gltf
