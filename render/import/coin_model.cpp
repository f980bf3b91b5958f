// Reads Open Inventor 1.0 and 2.x, ASCII and binary, and VRML 1 and 97, with Coin.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <Inventor/SbMatrix.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoFullPath.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLColor.h>
#include <Inventor/VRMLnodes/SoVRMLElevationGrid.h>
#include <Inventor/VRMLnodes/SoVRMLImageTexture.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/elements/SoLazyElement.h>
#include <Inventor/elements/SoNormalBindingElement.h>
#include <Inventor/elements/SoOverrideElement.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFTime.h>
#include <Inventor/nodes/SoImage.h>
#include <Inventor/nodes/SoIndexedNurbsCurve.h>
#include <Inventor/nodes/SoIndexedNurbsSurface.h>
#include <Inventor/nodes/SoNurbsCurve.h>
#include <Inventor/nodes/SoNurbsSurface.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoText2.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoWWWInline.h>
#include <fmt/format.h>

#include "daemon/base/files.h"
#include "daemon/base/printable_text.h"
#include "render/import/coin_graph.h"
#include "render/import/coin_indices.h"
#include "render/import/model_file.h"
#include "render/import/model_textures.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/gzip.h"

namespace merlin::render::import {
namespace {

// Coin's messages about the file, one line each. The list is static, since Coin has one message
// handler per process; the process reads only one file.
std::vector<std::string>& complaints() {
  static std::vector<std::string> all;
  return all;
}

// Stores a message, "Coin read error: WHAT\n\tOccurred at line 4 in PATH", as one line.
void complain(const SoError* error, void*) {
  std::string text = error->getDebugString().getString();
  for (std::size_t at = 0; (at = text.find("\n\t", at)) != std::string::npos;)
    text.replace(at, 2, "; ");
  while (!text.empty() && text.back() == '\n') text.pop_back();
  constexpr std::string_view kPrefix = "Coin read error: ";
  if (text.starts_with(kPrefix)) text.erase(0, kPrefix.size());
  text.erase(std::min(text.find(" in any of the following directories"), text.size()));
  if (text.starts_with("Could not read texture file") ||
      text.find("SbImage::readFile()") != std::string::npos)
    return;  // ModelTextures reads the texture files
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

// Returns all nodes of a type below `root`, each once.
template <typename Node>
std::vector<Node*> nodesOf(SoNode* root) {
  SoSearchAction search;
  search.setType(Node::getClassTypeId());
  search.setInterest(SoSearchAction::ALL);
  search.setSearchingAll(TRUE);
  search.apply(root);
  std::vector<Node*> nodes;
  std::unordered_set<const SoNode*> known;
  for (int i = 0; i < search.getPaths().getLength(); ++i) {
    // Uses the full path, because nodes inside VRML's nodes are hidden from SoPath.
    auto* const path = static_cast<SoFullPath*>(search.getPaths()[i]);
    auto* const node = static_cast<Node*>(path->getTail());
    if (known.insert(node).second) nodes.push_back(node);
  }
  return nodes;
}

class GraphReader {
 public:
  GraphReader(const ModelFile& file, const OnTriangles& on_triangles)
      : textures_(file), on_triangles_(on_triangles) {}

  Result<BuiltModel> read(SoNode* root) {
    prepareTextures(root);
    SoCallbackAction action;
    const SoType shape = SoShape::getClassTypeId();
    action.addPreCallback(root->getTypeId(), leaveOutNormals, nullptr);
    action.addPreCallback(shape, beginShape, this);
    for (const SoType type :
         {SoImage::getClassTypeId(), SoText2::getClassTypeId(), SoNurbsSurface::getClassTypeId(),
          SoIndexedNurbsSurface::getClassTypeId(), SoNurbsCurve::getClassTypeId(),
          SoIndexedNurbsCurve::getClassTypeId()})
      action.addPreCallback(type, leaveOut, this);
    action.addTriangleCallback(shape, takeTriangle, this);
    action.addLineSegmentCallback(shape, takeLine, this);
    action.addPointCallback(shape, takePoint, this);
    action.apply(root);
    if (!shapes_are_whole_) return shapes_are_whole_.error();
    const std::size_t inlines =
        nodesOf<SoVRMLInline>(root).size() + nodesOf<SoWWWInline>(root).size();
    BuiltModel built = std::move(builder_).finish();
    const auto notes = textures_.notes();
    built.notes.insert(built.notes.end(), notes.begin(), notes.end());
    if (others_ > 0) built.notes.push_back(fmt::format("left out: {} lines and points", others_));
    if (unmade_ > 0)
      built.notes.push_back(
          fmt::format("left out: {} images, flat texts (Text2) and NURBS, for which Coin needs a "
                      "display",
                      unmade_));
    if (inlines > 0)
      built.notes.push_back(fmt::format("left out: {} other files that it includes", inlines));
    return built;
  }

 private:
  static GraphReader& of(void* self) { return *static_cast<GraphReader*>(self); }

  // Replaces the image file of each texture by a single pixel, so that Coin reads no image files.
  // The traversal recognises the texture by the address of the pixel.
  void prepareTextures(SoNode* root) {
    constexpr unsigned char kPixel[3] = {255, 255, 255};
    for (SoTexture2* const node : nodesOf<SoTexture2>(root)) {
      const std::string name = node->filename.getValue().getString();
      if (name.empty()) continue;  // its pixels are in the file itself
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

  // Returns the image of a texture whose pixels are in the file itself. `bytes`: rows from the
  // lowest to the highest, as Coin stores them.
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

  // Makes Coin ignore a shape's normals, whatever their indices are. They are not needed, since
  // MERLIN computes normals from the surface.
  static SoCallbackAction::Response leaveOutNormals(void*, SoCallbackAction* action,
                                                    const SoNode* node) {
    SoState* const state = action->getState();
    auto* const by = const_cast<SoNode*>(node);
    SoNormalBindingElement::set(state, by, SoNormalBindingElement::OVERALL);
    SoOverrideElement::setNormalBindingOverride(state, by, TRUE);
    return SoCallbackAction::CONTINUE;
  }

  static SoCallbackAction::Response beginShape(void* self, SoCallbackAction* action,
                                               const SoNode* node) {
    GraphReader& reader = of(self);
    const double shapes = static_cast<double>(++reader.shapes_);
    reader.on_triangles_(0.5 + 0.5 * shapes / (shapes + 100),
                         static_cast<std::int64_t>(reader.builder_.triangles()));
    reader.begun_ = false;
    reader.vrml_clockwise_ = clockwiseOf(*node);
    reader.grid_ = dynamic_cast<const SoVRMLElevationGrid*>(node);
    reader.grid_colours_ = reader.grid_ ? coloursOf(*reader.grid_) : nullptr;
    reader.drawn_ = 0;
    if (const auto good = checkIndices(*action, static_cast<const SoShape&>(*node)); !good) {
      reader.shapes_are_whole_ =
          Error{good.error().code,
                fmt::format("shape {}, {}: {}", reader.shapes_, nameOf(*node), good.error().what)};
      return SoCallbackAction::ABORT;
    }
    return SoCallbackAction::CONTINUE;
  }

  // Returns the node's type and name: "IndexedFaceSet", or "IndexedFaceSet 'ROOF'".
  static std::string nameOf(const SoNode& node) {
    std::string_view type = node.getTypeId().getName().getString();
    if (type.starts_with("VRML")) type.remove_prefix(4);
    const std::string name = oneLine(excerpt(node.getName().getString()));
    return name.empty() ? std::string(type) : fmt::format("{} '{}'", type, name);
  }

  // Returns whether a VRML 97 node's faces are clockwise, which Coin does not provide; nothing for
  // other nodes.
  static std::optional<bool> clockwiseOf(const SoNode& node) {
    if (const auto* const faces = dynamic_cast<const SoVRMLIndexedFaceSet*>(&node))
      return !faces->ccw.getValue();
    if (const auto* const grid = dynamic_cast<const SoVRMLElevationGrid*>(&node))
      return !grid->ccw.getValue();
    return std::nullopt;
  }

  // Returns the colours of an ElevationGrid, which Coin does not apply as its material; null if it
  // has none.
  static const SoMFColor* coloursOf(const SoVRMLElevationGrid& grid) {
    const auto* const colours = dynamic_cast<const SoVRMLColor*>(grid.color.getValue());
    return colours && colours->color.getNum() > 0 ? &colours->color : nullptr;
  }

  static SoCallbackAction::Response leaveOut(void* self, SoCallbackAction*, const SoNode*) {
    ++of(self).unmade_;
    return SoCallbackAction::PRUNE;
  }

  // Returns the colour with this index; if the index is too large, the last colour, as Coin draws
  // it.
  SbColor colourOf(const SoCallbackAction& action, int index) const {
    const auto within = [&index](int number) { return std::clamp(index, 0, number - 1); };
    if (grid_colours_) {
      // A face of the grid is a square of two triangles; Coin's own index counts only rows.
      if (!grid_->colorPerVertex.getValue()) index = drawn_ / 2;
      return (*grid_colours_)[within(grid_colours_->getNum())];
    }
    SoState* const state = action.getState();
    const int number = SoLazyElement::getInstance(state)->getNumDiffuse();
    const SbColor diffuse =
        number > 0 ? SoLazyElement::getDiffuse(state, within(number)) : SbColor(0, 0, 0);
    // In VRML, a black diffuse colour with an emissive colour that is not black means a colour
    // without shading.
    const SbColor& emission = SoLazyElement::getEmissive(state);
    const bool glows = diffuse == SbColor(0, 0, 0) && emission != SbColor(0, 0, 0);
    return glows ? emission : diffuse;
  }

  Corner cornerOf(const SoCallbackAction& action, const SoPrimitiveVertex& v) const {
    SbVec3f at;
    action.getModelMatrix().multVecMatrix(v.getPoint(), at);
    SbVec4f uv;
    action.getTextureMatrix().multVecMatrix(v.getTextureCoords(), uv);
    const SbColor c = colourOf(action, v.getMaterialIndex());
    const float w = uv[3] != 0 ? uv[3] : 1;
    Corner corner{{at[0], at[1], at[2]}, {c[0], c[1], c[2]}, {}};
    if (textured_) corner.texcoord = {uv[0] / w, uv[1] / w};
    return corner;
  }

  static void takeTriangle(void* self, SoCallbackAction* action, const SoPrimitiveVertex* a,
                           const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
    GraphReader& reader = of(self);
    // At the first triangle, the action's material and texture are those of this shape; not
    // earlier.
    if (!std::exchange(reader.begun_, true)) {
      const mesh::SurfaceTexture texture = reader.textureOf(*action);
      reader.textured_ = texture.picture != nullptr;
      reader.builder_.beginPart(texture);
      const bool mirrored = action->getModelMatrix().det3() < 0;
      const bool clockwise =
          reader.vrml_clockwise_.value_or(action->getVertexOrdering() == SoShapeHints::CLOCKWISE);
      reader.turned_ = mirrored != clockwise;
    }
    std::array<Corner, 3> corners = {reader.cornerOf(*action, *a), reader.cornerOf(*action, *b),
                                     reader.cornerOf(*action, *c)};
    if (reader.turned_) std::swap(corners[1], corners[2]);
    reader.builder_.add(corners);
    ++reader.drawn_;
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
  Result<Ok> shapes_are_whole_ = Ok{};  // or the error of the last shape
  // State of the current shape.
  bool begun_ = false, turned_ = false, textured_ = false;
  std::optional<bool> vrml_clockwise_;
  const SoVRMLElevationGrid* grid_ = nullptr;
  const SoMFColor* grid_colours_ = nullptr;
  int drawn_ = 0;  // triangles
};

SbBool reportReading(const SbName&, float share, SbBool, void* on_triangles) {
  (*static_cast<const OnTriangles*>(on_triangles))(0.5 * static_cast<double>(share), 0);
  return TRUE;
}

// Returns the unpacked content of a file that Coin cannot read directly; empty if Coin can. Coin
// could unpack gzip as well, but without a limit of size, and it does not recognise a file that
// begins with a byte order mark.
Result<std::string> unpacked(const std::string& path) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // limit of the unpacked size [bytes]
  const auto beginning = FileCopy::read(path, 2);
  const bool gzip = beginning && mesh::isGzip(beginning->text());
  const bool marked = beginning && beginning->text().starts_with('\xEF');
  if (!gzip && !marked) return std::string();
  const auto file = MappedFile::open(path);
  if (!file && file.error().code == Errc::kNoMemory) throw std::bad_alloc();
  if (!file) {
    return Error{
        file.error().code,
        "its beginning could be read, but then it could not be opened again; was it moved? "
        "Try again"};
  }
  if (!gzip) return std::string(file->text());
  auto text = mesh::gunzip(file->text(), kMost);
  if (text && text->empty()) return Error{Errc::kMalformed, "gzip: nothing is packed"};
  return text;
}

// Returns Coin's messages about why it could not read the file.
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
  const auto text = unpacked(file.path);
  if (!text) return text.error();
  SoInput input;
  SoInput::addDirectoryFirst(mesh::folderOf(file.path).c_str());
  bool opened = true;
  if (text->empty())
    opened = input.openFile(file.path.c_str());
  else
    input.setBuffer(text->data(), text->size());
  if (!opened || !input.isValidFile())
    return Error{Errc::kMalformed, "cannot be read: " + reasons()};
  SoDB::addProgressCallback(reportReading, const_cast<OnTriangles*>(&on_triangles));
  SoSeparator* const root = SoDB::readAll(&input);
  SoDB::removeProgressCallback(reportReading, const_cast<OnTriangles*>(&on_triangles));
  if (!root) return Error{Errc::kMalformed, "cannot be read: " + reasons()};
  const NodeReference held(root);
  if (const auto ends = checkGraphEnds(root); !ends) return ends.error();
  auto built = GraphReader(file, on_triangles).read(root);
  if (!built) return built;
  for (const std::string& c : complaints()) built->notes.push_back("Coin: " + c);
  return built;
}

}  // namespace merlin::render::import
