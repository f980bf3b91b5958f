// Reads Open Inventor 1.0 and 2.x, ASCII and binary, and VRML 1 and 97, with Coin.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <unordered_map>
#include <utility>

#include <Inventor/SbMatrix.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLImageTexture.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFTime.h>
#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoImage.h>
#include <Inventor/nodes/SoIndexedNurbsCurve.h>
#include <Inventor/nodes/SoIndexedNurbsSurface.h>
#include <Inventor/nodes/SoNurbsCurve.h>
#include <Inventor/nodes/SoNurbsSurface.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoWWWInline.h>
#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/import/model_file.h"
#include "render/import/model_textures.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/gzip.h"

namespace merlin::render::import {
namespace {

// What Coin complained of in this file, one line each. Coin's handler is one for the process, which
// reads one file.
std::vector<std::string>& complaints() {
  static std::vector<std::string> all;
  return all;
}

// "Coin read error: WHAT\n\tOccurred at line 4 in PATH" as one line.
void complain(const SoError* error, void*) {
  std::string text = error->getDebugString().getString();
  for (std::size_t at = 0; (at = text.find("\n\t", at)) != std::string::npos;)
    text.replace(at, 2, "; ");
  while (!text.empty() && text.back() == '\n') text.pop_back();
  constexpr std::string_view kPrefix = "Coin read error: ";
  if (text.starts_with(kPrefix)) text.erase(0, kPrefix.size());
  text.erase(std::min(text.find(" in any of the following directories"), text.size()));
  if (text.starts_with("Could not read texture file")) return;  // ModelTextures reads them
  if (complaints().size() < 4) complaints().push_back(std::move(text));
}

// Holds a reference to a node of Coin.
class NodeReference {
 public:
  explicit NodeReference(SoNode* node) : node_(node) { node_->ref(); }
  ~NodeReference() { node_->unref(); }
  NodeReference(const NodeReference&) = delete;
  NodeReference& operator=(const NodeReference&) = delete;

 private:
  SoNode* node_;
};

constexpr double kMostShapes = 1e7;  // with each as often as it is used

// Walks a graph whose nodes may have several parents; a node that is below itself, and one that
// multiplies, would never end.
class GraphCheck {
 public:
  Result<Ok> run(SoNode* root) {
    enter(root);
    while (!path_.empty()) {
      const auto [node, next] = path_.back();
      const SoChildList* const children = node->getChildren();
      if (!children || next >= children->getLength()) {
        leave();
        continue;
      }
      ++path_.back().second;
      SoNode* const child = (*children)[next];
      const auto known = shapes_.find(child);
      if (known == shapes_.end()) {
        enter(child);
      } else if (known->second < 0) {
        return Error{Errc::kMalformed, fmt::format("is cyclic: a {} contains itself",
                                                   child->getTypeId().getName().getString())};
      } else {
        sums_.back() += known->second;
      }
    }
    if (shapes_[root] <= kMostShapes) return Ok{};
    return Error{Errc::kMalformed, fmt::format("uses its shapes {:.3g} times; allowed are {:.0f}",
                                               shapes_[root], kMostShapes)};
  }

 private:
  void enter(SoNode* node) {
    shapes_[node] = -1;  // on the path
    path_.emplace_back(node, 0);
    sums_.push_back(node->isOfType(SoShape::getClassTypeId()) ? 1 : 0);
  }
  void leave() {
    const double shapes = sums_.back();
    shapes_[path_.back().first] = shapes;
    path_.pop_back();
    sums_.pop_back();
    if (!sums_.empty()) sums_.back() += shapes;
  }

  std::vector<std::pair<SoNode*, int>> path_;
  std::vector<double> sums_;
  std::unordered_map<SoNode*, double> shapes_;  // below a node; -1: not known yet
};

// All nodes of a type, each once.
template <typename Node>
std::vector<Node*> nodesOf(SoNode* root) {
  SoSearchAction search;
  search.setType(Node::getClassTypeId());
  search.setInterest(SoSearchAction::ALL);
  search.setSearchingAll(TRUE);
  search.apply(root);
  std::vector<Node*> nodes;
  for (int i = 0; i < search.getPaths().getLength(); ++i) {
    // The whole path: nodes inside VRML's nodes are hidden from others.
    auto* const path = static_cast<SoFullPath*>(search.getPaths()[i]);
    auto* const node = static_cast<Node*>(path->getTail());
    if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
  }
  return nodes;
}

class GraphReader {
 public:
  GraphReader(const ModelFile& file, const OnTriangles& on_triangles)
      : textures_(mesh::folderOf(file.path)), on_triangles_(on_triangles) {}

  BuiltModel read(SoNode* root) {
    prepareTextures(root);
    SoCallbackAction action;
    const SoType shape = SoShape::getClassTypeId();
    action.addPreCallback(shape, beginShape, this);
    for (const SoType type :
         {SoImage::getClassTypeId(), SoNurbsSurface::getClassTypeId(),
          SoIndexedNurbsSurface::getClassTypeId(), SoNurbsCurve::getClassTypeId(),
          SoIndexedNurbsCurve::getClassTypeId()})
      action.addPreCallback(type, leaveOut, this);
    action.addTriangleCallback(shape, takeTriangle, this);
    action.addLineSegmentCallback(shape, takeLine, this);
    action.addPointCallback(shape, takePoint, this);
    action.apply(root);
    const std::size_t inlines =
        nodesOf<SoVRMLInline>(root).size() + nodesOf<SoWWWInline>(root).size();
    BuiltModel built = std::move(builder_).finish();
    const auto& notes = textures_.notes();
    built.notes.insert(built.notes.end(), notes.begin(), notes.end());
    if (others_ > 0) built.notes.push_back(fmt::format("left out: {} lines and points", others_));
    if (unmade_ > 0)
      built.notes.push_back(
          fmt::format("left out: {} images and NURBS, for which Coin needs a display", unmade_));
    if (inlines > 0)
      built.notes.push_back(fmt::format("left out: {} other files that it includes", inlines));
    return built;
  }

 private:
  static GraphReader& of(void* self) { return *static_cast<GraphReader*>(self); }

  // Coin reads no image files here. A texture gets one pixel instead, by whose address the
  // traversal knows it.
  void prepareTextures(SoNode* root) {
    constexpr unsigned char kPixel[3] = {255, 255, 255};
    for (SoTexture2* const node : nodesOf<SoTexture2>(root)) {
      const std::string name = node->filename.getValue().getString();
      if (name.empty()) continue;  // it has pixels of its own
      const image::ImageFile* const image = textures_.named(name);
      node->filename.setValue("");
      if (!image) continue;
      node->image.setValue(SbVec2s(1, 1), 3, kPixel);
      SbVec2s size;
      int components = 0;
      pictures_[node->image.getValue(size, components)] = image;
    }
    for (SoVRMLImageTexture* const node : nodesOf<SoVRMLImageTexture>(root)) {
      if (node->url.getNum() == 0) continue;
      const image::ImageFile* const image = textures_.named(node->url[0].getString());
      node->url.setNum(0);
      if (!image) continue;
      node->setImage(SbImage(kPixel, SbVec2s(1, 1), 3));
      const SbImage* const set = node->getImage();
      SbVec2s size;
      int components = 0;
      if (set) pictures_[set->getValue(size, components)] = image;
    }
  }

  // The pixels of a texture that the file itself has; rows from the lowest, as Coin has them.
  const image::ImageFile* inlineImage(const unsigned char* bytes, const SbVec2s& size,
                                      int components) {
    image::ImageFile image{size[0], size[1], {}};
    const auto width = static_cast<std::size_t>(std::max<short>(size[0], 0));
    const auto n = static_cast<std::size_t>(components);
    for (int row = size[1]; row-- > 0;) {
      for (std::size_t x = 0; x < width; ++x) {
        const unsigned char* p = bytes + (static_cast<std::size_t>(row) * width + x) * n;
        for (std::size_t k = 0; k < 3; ++k) image.pixels.push_back(n < 3 ? p[0] : p[k]);
      }
    }
    return textures_.ofPixels(fmt::format("pixels {}", pictures_.size()), std::move(image));
  }

  mesh::SurfaceTexture textureOf(const SoCallbackAction& action) {
    SbVec2s size;
    int components = 0;
    const unsigned char* const bytes = action.getTextureImage(size, components);
    if (!bytes || components < 1 || components > 4) return {};
    auto found = pictures_.find(bytes);
    if (found == pictures_.end())
      found = pictures_.emplace(bytes, inlineImage(bytes, size, components)).first;
    const auto wrapOf = [](int wrap) {
      return wrap == SoTexture2::CLAMP ? image::Wrap::kClamp : image::Wrap::kRepeat;
    };
    return {found->second, wrapOf(action.getTextureWrapS()), wrapOf(action.getTextureWrapT())};
  }

  static SoCallbackAction::Response beginShape(void* self, SoCallbackAction*, const SoNode*) {
    GraphReader& reader = of(self);
    const double shapes = static_cast<double>(++reader.shapes_);
    reader.on_triangles_(0.5 + 0.5 * shapes / (shapes + 100),
                         static_cast<std::int64_t>(reader.builder_.triangles()));
    reader.begun_ = false;
    return SoCallbackAction::CONTINUE;
  }

  static SoCallbackAction::Response leaveOut(void* self, SoCallbackAction*, const SoNode*) {
    ++of(self).unmade_;
    return SoCallbackAction::PRUNE;
  }

  static Corner cornerOf(const SoCallbackAction& action, const SoPrimitiveVertex& v) {
    SbVec3f at;
    action.getModelMatrix().multVecMatrix(v.getPoint(), at);
    SbVec4f uv;
    action.getTextureMatrix().multVecMatrix(v.getTextureCoords(), uv);
    SbColor ambient, diffuse, specular, emission;
    float shininess = 0, transparency = 0;
    action.getMaterial(ambient, diffuse, specular, emission, shininess, transparency,
                       v.getMaterialIndex());
    // VRML's way of a colour without shading.
    const bool glows = diffuse == SbColor(0, 0, 0) && emission != SbColor(0, 0, 0);
    const SbColor& c = glows ? emission : diffuse;
    const float w = uv[3] != 0 ? uv[3] : 1;
    return {{at[0], at[1], at[2]}, {c[0], c[1], c[2]}, {uv[0] / w, uv[1] / w}};
  }

  static void takeTriangle(void* self, SoCallbackAction* action, const SoPrimitiveVertex* a,
                           const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
    GraphReader& reader = of(self);
    // Only here has the shape's own material and texture reached the action.
    if (!std::exchange(reader.begun_, true)) {
      reader.builder_.beginPart(reader.textureOf(*action));
      const bool mirrored = action->getModelMatrix().det3() < 0;
      const bool clockwise = action->getVertexOrdering() == SoShapeHints::CLOCKWISE;
      reader.turned_ = mirrored != clockwise;
    }
    std::array<Corner, 3> corners = {cornerOf(*action, *a), cornerOf(*action, *b),
                                     cornerOf(*action, *c)};
    if (reader.turned_) std::swap(corners[1], corners[2]);
    reader.builder_.add(corners);
  }

  static void takeLine(void* self, SoCallbackAction*, const SoPrimitiveVertex*,
                       const SoPrimitiveVertex*) {
    ++of(self).others_;
  }
  static void takePoint(void* self, SoCallbackAction*, const SoPrimitiveVertex*) {
    ++of(self).others_;
  }

  ModelTextures textures_;
  const OnTriangles& on_triangles_;
  ModelBuilder builder_;
  std::unordered_map<const unsigned char*, const image::ImageFile*> pictures_;
  std::size_t shapes_ = 0, others_ = 0, unmade_ = 0;
  bool begun_ = false, turned_ = false;  // of this shape
};

SbBool reportReading(const SbName&, float share, SbBool, void* on_triangles) {
  (*static_cast<const OnTriangles*>(on_triangles))(0.5 * static_cast<double>(share), 0);
  return TRUE;
}

// What a file holds that is packed by gzip; empty if it is not. Coin could unpack it as well, but
// without a limit.
Result<std::string> unpackedIfGzip(const std::string& path) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // [bytes]
  const auto mark = FileCopy::read(path, 2);
  if (!mark || !mesh::isGzip(mark->text())) return std::string();
  const auto packed = MappedFile::open(path);
  if (!packed) throw std::bad_alloc();  // it could be read, so memory is what lacks
  auto text = mesh::gunzip(packed->text(), kMost);
  if (text && text->empty()) return Error{Errc::kMalformed, "gzip: nothing is packed"};
  return text;
}

// Why Coin gave up.
std::string reasons() {
  std::string text;
  for (const std::string& c : complaints()) text += (text.empty() ? "" : "; ") + c;
  return text.empty() ? "Coin gives no reason" : text;
}

}  // namespace

Result<Ok> prepareModels(const char*) {
  SoDB::init();
  SoInteraction::init();
  SoReadError::setHandlerCallback(complain, nullptr);
  SoDebugError::setHandlerCallback(complain, nullptr);
  SoDB::enableRealTimeSensor(FALSE);
  if (auto* const time = dynamic_cast<SoSFTime*>(SoDB::getGlobalField("realTime")))
    time->setValue(SbTime::zero());
  return Ok{};
}

Result<BuiltModel> readByCoin(const ModelFile& file, const OnTriangles& on_triangles) {
  complaints().clear();
  const auto unpacked = unpackedIfGzip(file.path);
  if (!unpacked) return unpacked.error();
  SoInput input;
  SoInput::addDirectoryFirst(mesh::folderOf(file.path).c_str());
  bool opened = true;
  if (unpacked->empty())
    opened = input.openFile(file.path.c_str());
  else
    input.setBuffer(unpacked->data(), unpacked->size());
  if (!opened || !input.isValidFile())
    return Error{Errc::kMalformed, "cannot be read: " + reasons()};
  SoDB::addProgressCallback(reportReading, const_cast<OnTriangles*>(&on_triangles));
  SoSeparator* const root = SoDB::readAll(&input);
  SoDB::removeProgressCallback(reportReading, const_cast<OnTriangles*>(&on_triangles));
  if (!root) return Error{Errc::kMalformed, "cannot be read: " + reasons()};
  const NodeReference held(root);
  if (const auto ends = GraphCheck().run(root); !ends) return ends.error();
  BuiltModel built = GraphReader(file, on_triangles).read(root);
  for (const std::string& c : complaints()) built.notes.push_back("Coin: " + c);
  return built;
}

}  // namespace merlin::render::import
