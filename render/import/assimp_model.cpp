// Reads models with assimp: glTF, COLLADA, FBX, 3DS and other formats that input_kinds.cpp of
// daemon/cli/mesh assigns to this reader.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/import/assimp_folder.h"
#include "render/import/assimp_values.h"
#include "render/import/gltf_check.h"
#include "render/import/gltf_values.h"
#include "render/import/model_file.h"
#include "render/import/model_textures.h"
#include "render/import/model_unit.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/non_numbers.h"

namespace merlin::render::import {
namespace {

// Reports assimp's progress as the first half of the whole progress. assimp owns the object.
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

// The appearance of the triangles of a mesh.
struct Material {
  std::array<float, 3> colour = kPlain;
  aiColor4D factor{1, 1, 1, 1};  // factor of the vertices' colours
  mesh::SurfaceTexture texture;
  unsigned texcoords = 0;  // index of the mesh's set of texture coordinates
  // Transform of the texture coordinates: each is multiplied by `scale`, then `offset` is added.
  std::array<float, 2> scale = {1, 1}, offset{};
};

class SceneReader {
 public:
  SceneReader(const aiScene& scene, const ModelFile& file, const OnTriangles& on_triangles,
              OwnValues own)
      : scene_(scene),
        linear_(file.format == "gltf" || file.format == "glb"),
        amf_(file.format == "amf"),
        textures_(file),
        on_triangles_(on_triangles) {
    for (unsigned m = 0; m < scene.mNumMaterials; ++m)
      materials_.push_back(materialOf(*scene.mMaterials[m]));
    if (own.features.empty()) return;
    rows_ = firstEqualRows(own.features, own.rows);
    first_rows_ = std::move(own.first_rows);
    builder_.takeValues(std::move(own.features));
  }

  BuiltModel read() {
    findNodes();
    for (const auto& [node, to_model] : nodes_) {
      for (unsigned m = 0; m < node->mNumMeshes; ++m) addMesh(node->mMeshes[m], to_model);
    }
    BuiltModel built = std::move(builder_).finish();
    built.origin = origin_;
    const auto notes = textures_.notes();
    built.notes.insert(built.notes.end(), notes.begin(), notes.end());
    if (transforms_ > 0)
      built.notes.push_back(fmt::format(
          "left out: the {} of {} textures, which therefore lie otherwise than in the model",
          linear_ ? "rotations" : "scales, offsets and rotations", transforms_));
    if (others_ > 0) built.notes.push_back(fmt::format("left out: {} lines and points", others_));
    if (coloured_pictures_ > 0)
      built.notes.push_back(
          fmt::format("left out: the vertices' colours of {} parts, which have a "
                      "texture to be multiplied with them",
                      coloured_pictures_));
    if (const std::string moved = motions(); !moved.empty())
      built.notes.push_back("left out: " + moved + "; this is the rest pose");
    return built;
  }

 private:
  std::string motions() const {
    std::string text;
    if (scene_.mNumAnimations > 0) text = fmt::format("{} animations", scene_.mNumAnimations);
    if (morphs_) text += text.empty() ? "morph targets" : " and morph targets";
    return text;
  }

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

  // Returns true for a glTF material with KHR_materials_pbrSpecularGlossiness. Its actual colour
  // and texture are the diffuse ones; its base colour is white, or is meant for readers without the
  // extension.
  static bool isSpecularGlossiness(const aiMaterial& material) {
    ai_real glossiness = 0;
    return material.Get(AI_MATKEY_GLOSSINESS_FACTOR, glossiness) == aiReturn_SUCCESS;
  }

  static bool baseColour(const aiMaterial& material, aiColor4D& colour) {
    if (!isSpecularGlossiness(material) &&
        material.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS)
      return true;
    return material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS;
  }

  Material materialOf(const aiMaterial& material) {
    Material m;
    aiString name;
    const bool plain = material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
                       std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME;
    aiColor4D colour;
    if (!plain && baseColour(material, colour)) {
      m.colour = screenColour(colour);
      if (linear_) m.factor = colour;
    }
    std::array<aiTextureType, 2> types = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
    if (isSpecularGlossiness(material)) std::swap(types[0], types[1]);
    for (const aiTextureType type : types) {
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

  // Multiplies a glTF material's texture by the material's colour. In other formats, the meaning of
  // having both varies.
  void tint(const aiMaterial& material, Material& m) {
    aiColor4D c;
    if (!m.texture.picture || !baseColour(material, c)) return;
    const std::array<float, 3> factor = {c.r, c.g, c.b};
    const bool white = std::ranges::all_of(factor, [](float f) { return f == 1; });
    if (!white && std::ranges::all_of(factor, [](float f) { return std::isfinite(f); }))
      m.texture.picture = textures_.tinted(*m.texture.picture, factor);
  }

  // Takes over the transform of texture coordinates. For glTF, assimp provides it for coordinates
  // with v upwards; assimp's own step (TransformUVCoords) is not used, since it transforms
  // differently, about the picture's middle. For other formats the meaning is unknown, so their
  // transforms are only counted.
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

  // Collects the nodes with the transforms from their coordinates to the model's. Model coordinates
  // are relative to an origin near the first node with a mesh, since a node may move a map far
  // away.
  void findNodes() {
    findNodesFrom(scene_.mRootNode->mTransformation);
    const auto first =
        std::ranges::find_if(nodes_, [](const auto& node) { return node.first->mNumMeshes > 0; });
    if (first == nodes_.end()) return;
    const aiMatrix4x4& m = first->second;
    origin_ = mesh::originNear({double{m.a4}, double{m.b4}, double{m.c4}});
    if (origin_ == mesh::Origin{}) return;
    nodes_.clear();
    by_name_.clear();
    aiMatrix4x4 root = scene_.mRootNode->mTransformation;
    root.a4 = static_cast<float>(root.a4 - origin_[0]);
    root.b4 = static_cast<float>(root.b4 - origin_[1]);
    root.c4 = static_cast<float>(root.c4 - origin_[2]);
    findNodesFrom(root);
  }

  void findNodesFrom(const aiMatrix4x4& root) {
    std::vector<std::pair<const aiNode*, aiMatrix4x4>> left = {{scene_.mRootNode, root}};
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

  // Returns the positions of a mesh's vertices in the model: transformed by their bones, or by the
  // mesh's node if a vertex has no bone.
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

  // Returns the colours of a mesh's vertices; null if it has none. For an AMF file without colours,
  // assimp makes black, transparent vertices; these count as vertices without colours.
  const aiColor4D* coloursOf(const aiMesh& mesh) const {
    const aiColor4D* const colours = mesh.mColors[0];
    if (!colours || !amf_) return colours;
    const bool any = std::any_of(colours, colours + mesh.mNumVertices,
                                 [](const aiColor4D& c) { return c != aiColor4D(0, 0, 0, 0); });
    return any ? colours : nullptr;
  }

  // Returns whether a glTF mesh has both a texture and vertex colours other than white. Only glTF
  // defines the meaning of this combination.
  bool hasColouredPicture(const aiMesh& mesh, const Material& material) const {
    const aiColor4D* const colours = mesh.mColors[0];
    return linear_ && colours && material.texture.picture &&
           std::any_of(colours, colours + mesh.mNumVertices,
                       [](const aiColor4D& c) { return c.r != 1 || c.g != 1 || c.b != 1; });
  }

  Corner cornerOf(const aiMesh& mesh, const Material& material, const aiColor4D* colour,
                  unsigned v) const {
    Corner corner;
    corner.colour = colour ? screenColour(*colour * material.factor) : material.colour;
    if (material.texcoords < AI_MAX_NUMBER_OF_TEXTURECOORDS &&
        mesh.mTextureCoords[material.texcoords]) {
      const aiVector3D& t = mesh.mTextureCoords[material.texcoords][v];
      corner.texcoord = {t.x * material.scale[0] + material.offset[0],
                         t.y * material.scale[1] + material.offset[1]};
    }
    return corner;
  }

  void addMesh(unsigned number, const aiMatrix4x4& to_model) {
    const aiMesh& mesh = *scene_.mMeshes[number];
    Material material;
    if (mesh.mMaterialIndex < materials_.size()) material = materials_[mesh.mMaterialIndex];
    const bool mapped = material.texcoords < AI_MAX_NUMBER_OF_TEXTURECOORDS &&
                        mesh.mTextureCoords[material.texcoords];
    if (!mapped) material.texture = {};
    builder_.beginPart(material.texture);
    const aiColor4D* const colours = coloursOf(mesh);
    coloured_pictures_ += hasColouredPicture(mesh, material);
    morphs_ = morphs_ || mesh.mNumAnimMeshes > 0;
    const std::vector<aiVector3D> at = positionsOf(mesh, to_model);
    const std::size_t first_row = rows_.empty() ? 0 : first_rows_[number];
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
        if (v >= mesh.mNumVertices) continue;  // cannot occur: ValidateDataStructure rejects it
        corners[k] = cornerOf(mesh, material, colours ? colours + v : nullptr, v);
        if (first_row + v < rows_.size()) corners[k].row = rows_[first_row + v];
        corners[k].position = {at[v].x, at[v].y, at[v].z};
      }
      builder_.add(corners);
    }
    const auto done = static_cast<double>(++meshes_);
    on_triangles_(0.5 + 0.5 * done / (done + static_cast<double>(scene_.mNumMeshes)),
                  static_cast<std::int64_t>(builder_.triangles()));
  }

  const aiScene& scene_;
  bool linear_;  // whether colours are proportional to light
  bool amf_;
  ModelTextures textures_;
  const OnTriangles& on_triangles_;
  std::vector<Material> materials_;
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> nodes_;
  std::map<std::string, aiMatrix4x4> by_name_;
  mesh::Origin origin_{};
  ModelBuilder builder_;
  // rows_: for each vertex of all meshes, its row in the builder's values; empty if there are none.
  // first_rows_: for each mesh, the index of its first vertex in rows_.
  std::vector<std::uint32_t> rows_;
  std::vector<std::size_t> first_rows_;
  std::size_t others_ = 0, meshes_ = 0, transforms_ = 0, coloured_pictures_ = 0;
  bool morphs_ = false;
};

bool isGltf(const ModelFile& file) { return file.format == "gltf" || file.format == "glb"; }

// A glTF file and the contents that its JSON declares; `promised` refers to `buffers`, and
// `buffers` to `file`.
struct CheckedGltf {
  MappedFile file{};
  std::optional<GltfBuffers> buffers{};
  GltfPromise promised{};
};

Result<Ok> checkFirst(const ModelFile& file, CheckedGltf& checked) {
  if (!isGltf(file)) return Ok{};
  auto bytes = MappedFile::open(file.path);
  if (!bytes) return Ok{};  // assimp will report the error
  checked.file = *std::move(bytes);
  checked.buffers.emplace(checked.file.text(), mesh::folderOf(file.path));
  auto promised = checkGltf(checked.file.text(), *checked.buffers);
  if (!promised) return promised.error();
  checked.promised = *std::move(promised);
  if (checked.promised.own.empty()) {  // frees the memory before assimp reads the file
    checked.buffers.reset();
    checked.file = MappedFile();
  }
  return Ok{};
}

// Matches each mesh with a primitive that has the same number of triangles. Returns the primitives
// without a match; `lossy` receives the meshes without a match. Both are sorted by number of
// triangles.
std::vector<GltfPrimitive> unmatched(std::vector<GltfPrimitive> promised,
                                     std::vector<const aiMesh*> meshes,
                                     std::vector<const aiMesh*>& lossy) {
  std::ranges::stable_sort(promised, {}, &GltfPrimitive::triangles);
  std::ranges::stable_sort(meshes, {}, &aiMesh::mNumFaces);
  std::vector<GltfPrimitive> left;
  auto next = promised.begin();
  for (const aiMesh* mesh : meshes) {
    for (; next != promised.end() && next->triangles < mesh->mNumFaces; ++next)
      left.push_back(*next);
    if (next != promised.end() && next->triangles == mesh->mNumFaces)
      ++next;
    else
      lossy.push_back(mesh);
  }
  left.insert(left.end(), next, promised.end());
  return left;
}

// Checks that assimp has dropped no triangles. assimp makes a mesh of each primitive that a node
// shows, in the order in which it reaches them, and drops triangles with an index out of range. So
// each of its meshes must have the same number of triangles as one of the file's primitives, each
// of which corresponds to one mesh.
Result<Ok> checkTriangles(std::vector<GltfPrimitive> promised, const aiScene& scene) {
  std::vector<const aiMesh*> meshes, lossy;
  for (std::size_t i = 0; i < scene.mNumMeshes; ++i) {
    if ((scene.mMeshes[i]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0)
      meshes.push_back(scene.mMeshes[i]);
  }
  const auto left = unmatched(std::move(promised), std::move(meshes), lossy);
  for (const aiMesh* mesh : lossy) {
    const auto of = std::ranges::upper_bound(left, std::uint64_t{mesh->mNumFaces}, {},
                                             &GltfPrimitive::triangles);
    if (of == left.end()) continue;
    return Error{
        Errc::kMalformed,
        fmt::format("glTF: mesh {}, primitive {}: {} of its {} triangles have an index beyond its "
                    "{} vertices",
                    of->mesh, of->number, of->triangles - mesh->mNumFaces, of->triangles,
                    mesh->mNumVertices)};
  }
  return Ok{};
}

// Returns the unit that an AMF or 3MF file names; empty for other formats and for AMF files that
// name none.
std::string namedUnit(const ModelFile& file) {
  constexpr std::size_t kEnough = 4096;
  if (file.format == "amf") {
    const auto beginning = FileCopy::read(file.path, kEnough);
    return beginning ? unitOf(beginning->text(), "amf") : "";
  }
  if (file.format != "3mf") return {};
  const std::string named = unitOf(beginningOf3mf(file.path, kEnough), "model");
  return named.empty() ? "millimeter" : named;  // the default of 3MF
}

// Returns a note about the attributes that are left out; empty if there are none.
std::string noteOf(const std::set<std::string>& own_attributes) {
  constexpr std::size_t kNamed = 8;
  if (own_attributes.empty()) return {};
  std::string names;
  std::size_t named = 0;
  for (const std::string& name : own_attributes) {
    if (named++ == kNamed) break;
    names += (named > 1 ? ", " : "") + name;
  }
  if (own_attributes.size() > kNamed)
    names += fmt::format(" and {} others", own_attributes.size() - kNamed);
  return fmt::format(
      "left out: vertex attributes that glTF does not define ({}); a PLY file keeps such values as "
      "features",
      names);
}

// Returns a note for coordinates that are not converted to metres, with the option that converts
// them.
std::string noteOf(const std::string& unit) {
  const double metres = metresPer(unit);
  const std::string way = metres == 0 || metres == 1
                              ? std::string()
                              : fmt::format("; --scale {} makes them metres", metres);
  return fmt::format("its coordinates are left in its unit, {}{}", unit, way);
}

}  // namespace

Result<BuiltModel> readByAssimp(const ModelFile& file, const OnTriangles& on_triangles) {
  CheckedGltf checked;
  if (const auto good = checkFirst(file, checked); !good) return good.error();
  Assimp::Importer importer;
  auto* const folder = new ModelFolder(file);  // the importer takes ownership
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
  if (const auto whole = checkTriangles(std::move(checked.promised.primitives), *scene); !whole)
    return whole.error();
  OwnValues own = takeOwnValues(checked.promised, *scene);
  for (mesh::Feature& f : own.features) {
    if (f.name == "colour") std::ranges::transform(f.values, f.values.begin(), toSrgb);
  }
  std::string replaced = mesh::replaceNonNumbers(own.features);
  BuiltModel built = SceneReader(*scene, file, on_triangles, std::move(own)).read();
  if (!replaced.empty()) built.notes.push_back(std::move(replaced));
  if (std::string note = noteOf(checked.promised.own_attributes); !note.empty())
    built.notes.push_back(std::move(note));
  if (const std::string unit = namedUnit(file); !unit.empty()) built.notes.push_back(noteOf(unit));
  return built;
}

}  // namespace merlin::render::import
