#include <fmt/format.h>

#include <cmath>

#include "fovea/io/assimp_scene.h"

namespace fovea {

namespace {

struct Keys {
  std::vector<float> times, values;
};

/// Appends a key unless its time does not come after the last one's, which glTF demands.
void add_key(Keys& keys, double seconds, std::initializer_list<double> value) {
  const auto time = static_cast<float>(seconds);
  if (!std::isfinite(time) || time < 0 || (!keys.times.empty() && time <= keys.times.back())) return;
  for (const double x : value) {
    if (!std::isfinite(x)) return;
  }
  keys.times.push_back(time);
  for (const double x : value) keys.values.push_back(static_cast<float>(x));
}

void add_channel(Animation& animation, int node, const char* path, const Keys& keys, int width) {
  if (keys.times.empty()) return;
  AnimationSampler sampler;
  sampler.input = Accessor::from_floats(keys.times, 1);
  sampler.output = Accessor::from_floats(keys.values, width);
  AnimationChannel channel;
  channel.sampler = static_cast<int>(animation.samplers.size());
  channel.node = node;
  channel.path = path;
  animation.samplers.push_back(std::move(sampler));
  animation.channels.push_back(std::move(channel));
}

void add_channels(Animation& animation, const aiNodeAnim& from, int node, double ticks_per_second) {
  Keys translation, rotation, scale;
  for (unsigned k = 0; k < from.mNumPositionKeys; ++k) {
    const auto& key = from.mPositionKeys[k];
    add_key(translation, key.mTime / ticks_per_second, {key.mValue.x, key.mValue.y, key.mValue.z});
  }
  for (unsigned k = 0; k < from.mNumRotationKeys; ++k) {
    const auto& key = from.mRotationKeys[k];
    aiQuaternion q = key.mValue;
    q.Normalize();
    add_key(rotation, key.mTime / ticks_per_second, {q.x, q.y, q.z, q.w});
  }
  for (unsigned k = 0; k < from.mNumScalingKeys; ++k) {
    const auto& key = from.mScalingKeys[k];
    add_key(scale, key.mTime / ticks_per_second, {key.mValue.x, key.mValue.y, key.mValue.z});
  }
  add_channel(animation, node, "translation", translation, 3);
  add_channel(animation, node, "rotation", rotation, 4);
  add_channel(animation, node, "scale", scale, 3);
}

}  // namespace

void convert_animations(const aiScene& scene, Model& model, const std::map<std::string, int>& node_of_name,
                        const std::string& place, Context& context) {
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& from = *scene.mAnimations[a];
    const double ticks_per_second = from.mTicksPerSecond > 0 ? from.mTicksPerSecond : 25.0;
    Animation animation;
    animation.name = from.mName.C_Str();
    for (unsigned c = 0; c < from.mNumChannels; ++c) {
      const auto node = node_of_name.find(from.mChannels[c]->mNodeName.C_Str());
      // A node with a sheared matrix has no translation, rotation and scale to move.
      if (node == node_of_name.end() || model.nodes[static_cast<std::size_t>(node->second)].matrix) {
        context.report("dropped-animation-channels", "animations of nodes that cannot move were left out",
                       place);
        continue;
      }
      add_channels(animation, *from.mChannels[c], node->second, ticks_per_second);
    }
    if (from.mNumMeshChannels + from.mNumMorphMeshChannels > 0) {
      context.report("dropped-animation-channels", "animations of meshes were left out", place,
                     from.mNumMeshChannels + from.mNumMorphMeshChannels);
    }
    if (!animation.channels.empty()) model.animations.push_back(std::move(animation));
  }
}

}  // namespace fovea
