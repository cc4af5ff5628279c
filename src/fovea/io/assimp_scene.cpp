#include "fovea/io/assimp_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fovea/base/error.h"
#include "fovea/io/indexed_mesh.h"
#include "fovea/model/weld.h"

namespace fovea {

namespace {

Vec3f to_vec3(const aiVector3D& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// The library's matrices are row-major.
Mat4 to_mat4(const aiMatrix4x4& a) {
  Mat4 result;
  for (unsigned row = 0; row < 4; ++row) {
    for (unsigned column = 0; column < 4; ++column) {
      result(static_cast<int>(row), static_cast<int>(column)) = static_cast<double>(a[row][column]);
    }
  }
  return result;
}

bool is_finite(const Mat4& a) {
  return std::all_of(a.m.begin(), a.m.end(), [](double x) { return std::isfinite(x); });
}

double largest_difference(const Mat4& a, const Mat4& b) {
  double largest = 0;
  for (std::size_t i = 0; i < 16; ++i) largest = std::max(largest, std::abs(a.m[i] - b.m[i]));
  return largest;
}

double largest_entry(const Mat4& a) {
  double largest = 0;
  for (const double x : a.m) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Translation, rotation and scale where they say the same as the matrix: only those can be animated.
void set_transform(Node& node, const aiMatrix4x4& matrix) {
  const Mat4 wanted = to_mat4(matrix);
  if (!is_finite(wanted)) return;
  aiVector3D scale, position;
  aiQuaternion rotation;
  matrix.Decompose(scale, rotation, position);
  node.translation = Vec3d(to_vec3(position));
  node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
  node.scale = Vec3d(to_vec3(scale));
  const Mat4 made = compose(node.translation, node.rotation, node.scale);
  // Floats carry 7 digits, and the decomposition loses one or two.
  if (is_finite(made) && largest_difference(made, wanted) <= 1e-5 * largest_entry(wanted)) return;
  node.translation = {0, 0, 0};
  node.rotation = {};
  node.scale = {1, 1, 1};
  node.matrix = wanted;
}

class SceneConverter {
 public:
  SceneConverter(const aiScene& scene, const std::string& place, const ReadOptions& options, Context& context)
      : scene_(scene), place_(place), options_(options), context_(context) {}

  void run(Model& model) {
    model_ = &model;
    add_nodes();
    for (std::size_t n = 0; n < sources_.size(); ++n) add_geometry(n);
    check_triangles();
    report_losses();
  }
  const std::map<std::string, int>& node_of_name() const { return node_of_name_; }

 private:
  using Joints = std::vector<const aiBone*>;  // the first bone of each name

  void add_nodes();
  void add_geometry(std::size_t node);
  int add_mesh(const std::vector<unsigned>& meshes, std::size_t node);
  SplitPart make_part(const aiMesh& mesh) const;
  void add_colors_and_uvs(const aiMesh& mesh, SplitPart& part) const;
  Joints find_joints(const std::vector<unsigned>& meshes) const;
  void add_influences(const aiMesh& mesh, const Joints& joints, SplitPart& part) const;
  int add_skin(const Joints& joints, std::size_t node);
  void check_triangles() const;
  void report_losses() const;

  const aiScene& scene_;
  const std::string& place_;
  const ReadOptions& options_;
  Context& context_;
  Model* model_ = nullptr;
  std::vector<const aiNode*> sources_;  // [#nodes]
  std::map<std::string, int> node_of_name_;
  struct Placed {
    int mesh, skin;
  };
  std::map<std::vector<unsigned>, Placed> placed_;
};

/// Parents before children, each level in the file's order.
void SceneConverter::add_nodes() {
  sources_.push_back(scene_.mRootNode);
  for (std::size_t n = 0; n < sources_.size(); ++n) {
    const aiNode& from = *sources_[n];
    Node node;
    node.name = from.mName.C_Str();
    set_transform(node, from.mTransformation);
    for (unsigned c = 0; c < from.mNumChildren; ++c) {
      node.children.push_back(static_cast<int>(sources_.size()));
      sources_.push_back(from.mChildren[c]);
    }
    node_of_name_.try_emplace(node.name, static_cast<int>(n));
    model_->nodes.push_back(std::move(node));
  }
  model_->scenes.push_back({{}, {0}, {}});
  model_->default_scene = 0;
}

/// All meshes of a node become one, with a part for each: that is how they share positions.
void SceneConverter::add_geometry(std::size_t node) {
  const aiNode& from = *sources_[node];
  std::vector<unsigned> meshes;
  for (unsigned m = 0; m < from.mNumMeshes; ++m) {
    const unsigned index = from.mMeshes[m];
    if (index >= scene_.mNumMeshes)
      throw Error(ErrorKind::format, "a node names a mesh that is not there", place_);
    if (scene_.mMeshes[index]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) meshes.push_back(index);
  }
  if (meshes.empty()) return;
  Node& to = model_->nodes[node];
  const auto known = placed_.find(meshes);
  if (known != placed_.end()) {
    to.mesh = known->second.mesh;
    to.skin = known->second.skin;
    return;
  }
  const int mesh = add_mesh(meshes, node);
  model_->nodes[node].mesh = mesh;
  placed_[meshes] = {mesh, model_->nodes[node].skin};
}

int SceneConverter::add_mesh(const std::vector<unsigned>& meshes, std::size_t node) {
  const Joints joints = find_joints(meshes);
  std::vector<SplitPart> parts;
  for (const unsigned m : meshes) {
    SplitPart& part = parts.emplace_back(make_part(*scene_.mMeshes[m]));
    if (!joints.empty()) add_influences(*scene_.mMeshes[m], joints, part);
  }
  const std::string name = sources_[node]->mName.C_Str();
  Mesh mesh;
  mesh.name = name;
  mesh.surface = weld(parts, context_, fmt::format("{}: mesh \"{}\"", place_, name));
  model_->meshes.push_back(std::move(mesh));
  if (!joints.empty()) model_->nodes[node].skin = add_skin(joints, node);
  return static_cast<int>(model_->meshes.size()) - 1;
}

SplitPart SceneConverter::make_part(const aiMesh& mesh) const {
  check_element_count(mesh.mNumVertices, "vertices", options_, place_);
  check_element_count(std::uint64_t{mesh.mNumFaces} * 3, "indices", options_, place_);
  SplitPart part;
  part.part.material =
      mesh.mMaterialIndex < scene_.mNumMaterials ? static_cast<int>(mesh.mMaterialIndex) : -1;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) part.positions.push_back(to_vec3(mesh.mVertices[v]));
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    for (unsigned k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices) {
        throw Error(ErrorKind::format, "a face has an index out of range",
                    fmt::format("{}: mesh \"{}\" face {}", place_, mesh.mName.C_Str(), f));
      }
      part.indices.push_back(face.mIndices[k]);
    }
  }
  if (mesh.HasNormals()) {
    VertexArray& array = part.attributes.emplace_back();
    array.semantic = Semantic::normal;
    array.width = 3;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Vec3f n = to_vec3(mesh.mNormals[v]);
      array.values.insert(array.values.end(), {n.x, n.y, n.z});
    }
    repair_normals(part, context_, place_);
  }
  add_colors_and_uvs(mesh, part);
  return part;
}

void SceneConverter::add_colors_and_uvs(const aiMesh& mesh, SplitPart& part) const {
  const auto finite = [](auto x) { return std::isfinite(x) ? static_cast<float>(x) : 0.0f; };
  for (unsigned set = 0; set < mesh.GetNumUVChannels(); ++set) {
    VertexArray& array = part.attributes.emplace_back();
    array.semantic = Semantic::uv;
    array.set = static_cast<int>(set);
    array.width = 2;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& uv = mesh.mTextureCoords[set][v];
      array.values.insert(array.values.end(), {finite(uv.x), finite(uv.y)});
    }
  }
  for (unsigned set = 0; set < mesh.GetNumColorChannels(); ++set) {
    VertexArray& array = part.attributes.emplace_back();
    array.semantic = Semantic::color;
    array.set = static_cast<int>(set);
    array.width = 4;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiColor4D& c = mesh.mColors[set][v];
      array.values.insert(array.values.end(), {finite(c.r), finite(c.g), finite(c.b), finite(c.a)});
    }
  }
}

SceneConverter::Joints SceneConverter::find_joints(const std::vector<unsigned>& meshes) const {
  Joints joints;
  for (const unsigned m : meshes) {
    const aiMesh& mesh = *scene_.mMeshes[m];
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone* bone = mesh.mBones[b];
      const auto same = [&](const aiBone* other) { return other->mName == bone->mName; };
      if (std::any_of(joints.begin(), joints.end(), same)) continue;
      if (node_of_name_.contains(bone->mName.C_Str())) {
        joints.push_back(bone);
      } else {
        context_.report("missing-joint", fmt::format("bone \"{}\" has no node", bone->mName.C_Str()), place_);
      }
    }
  }
  return joints;
}

/// Four influences per vertex that sum to 1. Vertices without any follow the mesh's own node, which
/// `add_skin` puts behind the joints.
void SceneConverter::add_influences(const aiMesh& mesh, const Joints& joints, SplitPart& part) const {
  const std::size_t count = part.positions.size();
  std::vector<float> index(4 * count, 0.0f), weight(4 * count, 0.0f);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto same = [&](const aiBone* other) { return other->mName == bone.mName; };
    const auto joint = std::find_if(joints.begin(), joints.end(), same);
    if (joint == joints.end()) continue;
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& influence = bone.mWeights[w];
      if (influence.mVertexId >= count || !(influence.mWeight > 0)) continue;
      float* weights = &weight[4 * std::size_t{influence.mVertexId}];
      const auto slot = std::find(weights, weights + 4, 0.0f) - weights;
      if (slot == 4) continue;
      weights[slot] = static_cast<float>(influence.mWeight);
      index[4 * std::size_t{influence.mVertexId} + static_cast<std::size_t>(slot)] =
          static_cast<float>(joint - joints.begin());
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    const float sum = weight[4 * v] + weight[4 * v + 1] + weight[4 * v + 2] + weight[4 * v + 3];
    if (sum > 0 && std::isfinite(sum)) {
      for (std::size_t k = 0; k < 4; ++k) weight[4 * v + k] /= sum;
    } else {
      std::fill_n(&weight[4 * v], 4, 0.0f);
      std::fill_n(&index[4 * v], 4, 0.0f);
      weight[4 * v] = 1;
      index[4 * v] = static_cast<float>(joints.size());
    }
  }
  const ComponentType type = joints.size() < 256 ? ComponentType::u8 : ComponentType::u16;
  part.attributes.push_back({Semantic::joints, 0, {}, 4, {type, false}, std::move(index)});
  part.attributes.push_back({Semantic::weights, 0, {}, 4, {}, std::move(weight)});
}

int SceneConverter::add_skin(const Joints& joints, std::size_t node) {
  Skin skin;
  std::vector<float> inverse_bind;
  const auto add = [&](int joint, const Mat4& matrix) {
    skin.joints.push_back(joint);
    for (const double x : matrix.m) inverse_bind.push_back(static_cast<float>(x));
  };
  for (const aiBone* bone : joints) {
    const Mat4 matrix = to_mat4(bone->mOffsetMatrix);
    add(node_of_name_.at(bone->mName.C_Str()), is_finite(matrix) ? matrix : Mat4{});
  }
  add(static_cast<int>(node), Mat4{});
  skin.inverse_bind = Accessor::from_floats(inverse_bind, 16);
  skin.inverse_bind->matrix = true;
  model_->skins.push_back(std::move(skin));
  return static_cast<int>(model_->skins.size()) - 1;
}

void SceneConverter::check_triangles() const {
  for (const Mesh& mesh : model_->meshes) {
    if (mesh.surface.face_count() > 0) return;
  }
  throw Error(ErrorKind::unsupported, "the file has no triangles", place_,
              "point clouds and curves have no surface to simplify");
}

void SceneConverter::report_losses() const {
  const auto lost = [&](unsigned count, const char* what) {
    if (count > 0) context_.report("dropped-on-import", fmt::format("{} were left out", what), place_, count);
  };
  unsigned targets = 0;
  for (unsigned m = 0; m < scene_.mNumMeshes; ++m) targets += scene_.mMeshes[m]->mNumAnimMeshes;
  lost(targets, "morph targets");
  lost(scene_.mNumCameras, "cameras");
  lost(scene_.mNumLights, "lights");
}

}  // namespace

Model convert_scene(const aiScene& scene, const std::filesystem::path& folder, const std::string& place,
                    const ReadOptions& options, Context& context) {
  if (!scene.mRootNode || scene.mNumMeshes == 0) {
    throw Error(ErrorKind::unsupported, "the file has no triangles", place);
  }
  Model model;
  SceneConverter converter(scene, place, options, context);
  converter.run(model);
  TextureLoader textures(model, folder, options, context);
  convert_materials(scene, model, textures, place, context);
  convert_animations(scene, model, converter.node_of_name(), place, context);
  drop_textures_without_uvs(model);
  return model;
}

}  // namespace fovea
