// Reads models with assimp: glTF, COLLADA, FBX, 3DS and the others that input_kinds.cpp of
// daemon/cli/mesh sends here.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/import/companion_path.h"
#include "render/import/gltf_check.h"
#include "render/import/model_file.h"
#include "render/import/model_textures.h"
#include "render/mesh/io/companion_files.h"

namespace merlin::render::import {
namespace {

// A file in memory, read-only.
class MappedStream final : public Assimp::IOStream {
 public:
  explicit MappedStream(MappedFile file) : file_(std::move(file)) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t items = std::min(count, (FileSize() - at_) / size);
    if (items > 0) std::memcpy(to, file_.bytes().data() + at_, items * size);
    at_ += items * size;
    return items;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin from) override {
    const std::size_t size = FileSize();
    const std::size_t base = from == aiOrigin_SET ? 0 : from == aiOrigin_CUR ? at_ : size;
    const std::size_t to = base + offset;  // a negative offset wraps, as it should
    if (to > size) return aiReturn_FAILURE;
    at_ = to;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return file_.bytes().size(); }
  void Flush() override {}

 private:
  MappedFile file_;
  std::size_t at_ = 0;
};

// The model under a name whose ending says its format, and files beside the model.
class ModelFolder final : public Assimp::IOSystem {
 public:
  explicit ModelFolder(const ModelFile& file)
      : file_(file), name_("model." + file.format), folder_(mesh::folderOf(file.path)) {}

  const std::string& name() const noexcept { return name_; }

  bool Exists(const char* name) const override { return fileStamp(pathOf(name)).has_value(); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (std::strchr(mode, 'w') || std::strchr(mode, 'a') || std::strchr(mode, '+')) return nullptr;
    auto file = MappedFile::open(pathOf(name));
    return file ? new MappedStream(*std::move(file)) : nullptr;
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string pathOf(const char* name) const {
    return name == name_ ? file_.path : companionPath(folder_, name);
  }

  const ModelFile& file_;
  std::string name_, folder_;
};

// assimp owns it. It reads the first half of the way.
class Progress final : public Assimp::ProgressHandler {
 public:
  explicit Progress(const OnTriangles& on_triangles) : on_triangles_(on_triangles) {}
  bool Update(float share) override {
    on_triangles_(0.5 * static_cast<double>(std::clamp(share, 0.0F, 1.0F)), 0);
    return true;
  }

 private:
  const OnTriangles& on_triangles_;
};

float toSrgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear
                              : 1.055F * std::pow(std::max(linear, 0.0F), 1 / 2.4F) - 0.055F;
}

image::Wrap wrapOf(aiTextureMapMode mode) {
  if (mode == aiTextureMapMode_Mirror) return image::Wrap::kMirror;
  const bool ends = mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal;
  return ends ? image::Wrap::kClamp : image::Wrap::kRepeat;
}

// What the triangles of a mesh look like.
struct Material {
  std::array<float, 3> colour = kPlain;
  mesh::SurfaceTexture texture;
  unsigned texcoords = 0;  // which of the mesh's texture coordinates
  // What is done to them: each times `scale`, and then `offset` is added.
  std::array<float, 2> scale = {1, 1}, offset{};
};

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const ModelFile& file, const OnTriangles& on_triangles)
      : scene_(scene),
        linear_(file.format == "gltf" || file.format == "glb"),
        textures_(mesh::folderOf(file.path)),
        on_triangles_(on_triangles) {
    for (unsigned m = 0; m < scene.mNumMaterials; ++m)
      materials_.push_back(materialOf(*scene.mMaterials[m]));
  }

  BuiltModel read() {
    findNodes();
    for (const auto& [node, to_model] : nodes_) {
      for (unsigned m = 0; m < node->mNumMeshes; ++m)
        addMesh(*scene_.mMeshes[node->mMeshes[m]], to_model);
    }
    BuiltModel built = std::move(builder_).finish();
    const auto& notes = textures_.notes();
    built.notes.insert(built.notes.end(), notes.begin(), notes.end());
    if (transforms_ > 0)
      built.notes.push_back(
          fmt::format("left out: the {} of {} textures, which lie otherwise than in the model",
                      linear_ ? "rotations" : "scales, offsets and rotations", transforms_));
    if (others_ > 0) built.notes.push_back(fmt::format("left out: {} lines and points", others_));
    if (morphs_ || scene_.mNumAnimations > 0)
      built.notes.push_back(fmt::format("left out: {} animations{}; this is the rest pose",
                                        scene_.mNumAnimations,
                                        morphs_ ? " and morph targets" : ""));
    return built;
  }

 private:
  std::array<float, 3> screenColour(const aiColor4D& c) const {
    if (linear_) return {toSrgb(c.r), toSrgb(c.g), toSrgb(c.b)};
    return {c.r, c.g, c.b};
  }

  const image::ImageFile* imageOf(const aiString& path) {
    const aiTexture* const t = scene_.GetEmbeddedTexture(path.C_Str());
    if (!t) return textures_.named(path.C_Str());
    if (t->mHeight == 0) {
      return textures_.inside(path.C_Str(),
                              {reinterpret_cast<const std::uint8_t*>(t->pcData), t->mWidth});
    }
    image::ImageFile pixels{static_cast<int>(t->mWidth), static_cast<int>(t->mHeight), {}};
    for (std::size_t i = 0; i < std::size_t{t->mWidth} * t->mHeight; ++i) {
      const aiTexel& p = t->pcData[i];
      pixels.pixels.insert(pixels.pixels.end(), {p.r, p.g, p.b});
    }
    return textures_.ofPixels(path.C_Str(), std::move(pixels));
  }

  Material materialOf(const aiMaterial& material) {
    Material m;
    aiString name;
    const bool plain = material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
                       std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME;
    aiColor4D colour;
    if (!plain && (material.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
                   material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS))
      m.colour = screenColour(colour);
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
      aiString path;
      aiTextureMapMode wrap[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
      if (m.texture.picture || material.GetTexture(type, 0, &path, nullptr, &m.texcoords, nullptr,
                                                   nullptr, wrap) != aiReturn_SUCCESS)
        continue;
      m.texture = {imageOf(path), wrapOf(wrap[0]), wrapOf(wrap[1])};
      takeTransform(material, type, m);
    }
    if (linear_) tint(material, m);
    return m;
  }

  // A glTF material's colour is multiplied with its texture. Other formats mean different things by
  // having both.
  void tint(const aiMaterial& material, Material& m) {
    aiColor4D c;
    if (!m.texture.picture || material.Get(AI_MATKEY_BASE_COLOR, c) != aiReturn_SUCCESS) return;
    const std::array<float, 3> factor = {c.r, c.g, c.b};
    const bool white = std::ranges::all_of(factor, [](float f) { return f == 1; });
    if (!white && std::ranges::all_of(factor, [](float f) { return std::isfinite(f); }))
      m.texture.picture = textures_.tinted(*m.texture.picture, factor);
  }

  // Of glTF, assimp says with v upwards what is to be done. Its own step (TransformUVCoords) does
  // something else, about the picture's middle, and of other formats its meaning is not known.
  void takeTransform(const aiMaterial& material, aiTextureType type, Material& m) {
    aiUVTransform t;
    const bool there =
        aiGetMaterialUVTransform(&material, AI_MATKEY_UVTRANSFORM(type, 0), &t) == aiReturn_SUCCESS;
    const bool none = t.mScaling == aiVector2D(1, 1) && t.mTranslation == aiVector2D(0, 0);
    if (!there || (none && t.mRotation == 0)) return;
    if (!linear_ || t.mRotation != 0) {
      ++transforms_;
      return;
    }
    m.scale = {t.mScaling.x, t.mScaling.y};
    m.offset = {t.mTranslation.x, t.mTranslation.y};
  }

  // The nodes with the transforms that take their coordinates to the model's.
  void findNodes() {
    std::vector<std::pair<const aiNode*, aiMatrix4x4>> left = {
        {scene_.mRootNode, scene_.mRootNode->mTransformation}};
    while (!left.empty()) {
      const auto at = left.back();
      left.pop_back();
      nodes_.push_back(at);
      by_name_.emplace(at.first->mName.C_Str(), at.second);
      for (unsigned i = at.first->mNumChildren; i-- > 0;) {
        const aiNode* const child = at.first->mChildren[i];
        left.emplace_back(child, at.second * child->mTransformation);
      }
    }
  }

  // Positions of a mesh in the model: its bones', or its node's where no bone holds a vertex.
  std::vector<aiVector3D> positionsOf(const aiMesh& mesh, const aiMatrix4x4& to_model) const {
    std::vector<aiVector3D> at(mesh.mNumVertices);
    std::vector<float> held(mesh.mNumVertices);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const auto joint = by_name_.find(bone.mName.C_Str());
      if (joint == by_name_.end()) continue;
      const aiMatrix4x4 posed = joint->second * bone.mOffsetMatrix;
      for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        const aiVertexWeight& weight = bone.mWeights[w];
        if (weight.mVertexId >= mesh.mNumVertices) continue;
        at[weight.mVertexId] += weight.mWeight * (posed * mesh.mVertices[weight.mVertexId]);
        held[weight.mVertexId] += weight.mWeight;
      }
    }
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      if (held[v] > 0)
        at[v] /= held[v];
      else
        at[v] = to_model * mesh.mVertices[v];
    }
    return at;
  }

  Corner cornerOf(const aiMesh& mesh, const Material& material, unsigned v) const {
    Corner corner;
    corner.colour = mesh.mColors[0] ? screenColour(mesh.mColors[0][v]) : material.colour;
    if (material.texcoords < AI_MAX_NUMBER_OF_TEXTURECOORDS &&
        mesh.mTextureCoords[material.texcoords]) {
      const aiVector3D& t = mesh.mTextureCoords[material.texcoords][v];
      corner.texcoord = {t.x * material.scale[0] + material.offset[0],
                         t.y * material.scale[1] + material.offset[1]};
    }
    return corner;
  }

  void addMesh(const aiMesh& mesh, const aiMatrix4x4& to_model) {
    Material material;
    if (mesh.mMaterialIndex < materials_.size()) material = materials_[mesh.mMaterialIndex];
    const bool mapped = material.texcoords < AI_MAX_NUMBER_OF_TEXTURECOORDS &&
                        mesh.mTextureCoords[material.texcoords];
    if (!mapped) material.texture = {};
    builder_.beginPart(material.texture);
    morphs_ = morphs_ || mesh.mNumAnimMeshes > 0;
    const std::vector<aiVector3D> at = positionsOf(mesh, to_model);
    const bool mirrored = mesh.mNumBones == 0 && to_model.Determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) {
        ++others_;
        continue;
      }
      std::array<Corner, 3> corners;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned v = face.mIndices[mirrored ? 2 - k : k];
        if (v >= mesh.mNumVertices) continue;  // ValidateDataStructure refuses it
        corners[k] = cornerOf(mesh, material, v);
        corners[k].position = {at[v].x, at[v].y, at[v].z};
      }
      builder_.add(corners);
    }
    const auto done = static_cast<double>(++meshes_);
    on_triangles_(0.5 + 0.5 * done / (done + static_cast<double>(scene_.mNumMeshes)),
                  static_cast<std::int64_t>(builder_.triangles()));
  }

  const aiScene& scene_;
  bool linear_;  // colours are proportional to light
  ModelTextures textures_;
  const OnTriangles& on_triangles_;
  std::vector<Material> materials_;
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> nodes_;
  std::map<std::string, aiMatrix4x4> by_name_;
  ModelBuilder builder_;
  std::size_t others_ = 0, meshes_ = 0, transforms_ = 0;
  bool morphs_ = false;
};

bool isGltf(const ModelFile& file) { return file.format == "gltf" || file.format == "glb"; }

Result<Ok> checkFirst(const ModelFile& file) {
  if (!isGltf(file)) return Ok{};
  const auto bytes = MappedFile::open(file.path);
  if (!bytes) return Ok{};  // assimp says so
  return checkGltf(bytes->text());
}

}  // namespace

Result<BuiltModel> readByAssimp(const ModelFile& file, const OnTriangles& on_triangles) {
  if (const auto good = checkFirst(file); !good) return good.error();
  Assimp::Importer importer;
  auto* const folder = new ModelFolder(file);  // the importer's from here on
  importer.SetIOHandler(folder);
  importer.SetProgressHandler(new Progress(on_triangles));
  const aiScene* const scene =
      importer.ReadFile(folder->name(), aiProcess_Triangulate | aiProcess_ValidateDataStructure);
  if (!scene) {
    const std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    return Error{Errc::kMalformed, fmt::format("cannot be read as .{}: {}", file.format,
                                               why.empty() ? "assimp gives no reason" : why)};
  }
  if (!scene->mRootNode || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0)
    return Error{Errc::kUnsupported, "holds no surface"};
  return SceneReader(*scene, file, on_triangles).read();
}

}  // namespace merlin::render::import
