#include "render/inventor/so_mr_face_set.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <Inventor/SbTime.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoGLRenderAction.h>
#include <Inventor/actions/SoGetPrimitiveCountAction.h>
#include <Inventor/details/SoFaceDetail.h>
#include <Inventor/details/SoPointDetail.h>
#include <Inventor/elements/SoCacheElement.h>
#include <Inventor/elements/SoModelMatrixElement.h>
#include <Inventor/elements/SoProjectionMatrixElement.h>
#include <Inventor/elements/SoViewingMatrixElement.h>
#include <Inventor/errors/SoDebugError.h>

SO_NODE_SOURCE(SoMRFaceSet)

namespace {

constexpr int kAll = std::numeric_limits<int>::max();

constexpr double kSettle_s = 0.25;  // time after its last frame at which a motion counts as ended

SbMatrix viewOf(SoState* state) {
  SbMatrix view = SoModelMatrixElement::get(state);
  view.multRight(SoViewingMatrixElement::get(state));
  view.multRight(SoProjectionMatrixElement::get(state));
  return view;
}

SbVec3f facing(const SoMFVec3f& vertex, const int* corners) {
  const SbVec3f& a = vertex[corners[0]];
  SbVec3f normal = (vertex[corners[1]] - a).cross(vertex[corners[2]] - a);
  normal.normalize();
  return normal;
}

// Sets the attributes of a corner from a node of the dendrogram. An attribute for which the model
// has no values stays unchanged.
void setCorner(const SoVertexProperty& attributes, int node, SoPrimitiveVertex& corner,
               SoPointDetail& point) {
  corner.setPoint(attributes.vertex[node]);
  point.setCoordinateIndex(node);
  if (attributes.normal.getNum() > 0) {
    corner.setNormal(attributes.normal[node]);
    point.setNormalIndex(node);
  }
  if (attributes.texCoord.getNum() > 0) {
    corner.setTextureCoords(attributes.texCoord[node]);
    point.setTextureCoordIndex(node);
  }
  if (attributes.orderedRGBA.getNum() > 0) {
    corner.setMaterialIndex(node);
    point.setMaterialIndex(node);
  }
}

}  // namespace

void SoMRFaceSet::initClass() { SO_NODE_INIT_CLASS(SoMRFaceSet, SoShape, "Shape"); }

SoMRFaceSet::SoMRFaceSet() : after_frame_(endFrame, this), still_alarm_(becomeStill, this) {
  SO_NODE_CONSTRUCTOR(SoMRFaceSet);
  SO_NODE_ADD_FIELD(minimumResolution, (0));
  SO_NODE_ADD_FIELD(maximumResolution, (kAll));
  SO_NODE_ADD_FIELD(currentResolution, (kAll));
  SO_NODE_ADD_FIELD(desiredFrameRate, (0));
  SO_NODE_ADD_FIELD(interacting, (FALSE));
  SO_NODE_ADD_FIELD(frameTime, (SbTime::zero()));
  addModelFields();
}

void SoMRFaceSet::addModelFields() {
  SO_NODE_ADD_EMPTY_MFIELD(vertex);
  SO_NODE_ADD_EMPTY_MFIELD(normal);
  SO_NODE_ADD_EMPTY_MFIELD(diffuseColor);
  SO_NODE_ADD_EMPTY_MFIELD(texCoord);
  SO_NODE_ADD_EMPTY_MFIELD(faces);
  SO_NODE_ADD_EMPTY_MFIELD(parents);
  SO_NODE_ADD_EMPTY_MFIELD(aliveCounts);
  SO_NODE_ADD_EMPTY_MFIELD(levelErrors);
  SO_NODE_ADD_FIELD(alternateRep, (nullptr));
}

SoMRFaceSet::~SoMRFaceSet() = default;

void SoMRFaceSet::notify(SoNotList* list) {
  const SoField* field = list->getLastField();
  // No notification, as a redraw would set the field again.
  if (field == &frameTime) return applyFrameTime();
  if (field == &interacting) law_.rest();
  const SoField* const kOfNoModel[] = {&minimumResolution, &maximumResolution, &currentResolution,
                                       &desiredFrameRate,  &interacting,       &alternateRep};
  changed_ |=
      std::find(std::begin(kOfNoModel), std::end(kOfNoModel), field) == std::end(kOfNoModel);
  SoShape::notify(list);
}

merlin::render::inventor::Surface* SoMRFaceSet::surface() {
  if (!changed_) return surface_.get();
  changed_ = false;
  auto made = Surface::make(
      {vertex, normal, diffuseColor, texCoord, faces, parents, aliveCounts, levelErrors});
  if (made) {
    surface_ = *std::move(made);
    return surface_.get();
  }
  surface_.reset();
  SoDebugError::post("SoMRFaceSet",
                     "node \"%s\": %s; nothing is drawn. \"merlin mesh export MODEL.mrm "
                     "--multiresolution -o OUT.iv\" writes a valid file",
                     getName().getString(), made.error().what.c_str());
  return nullptr;
}

bool SoMRFaceSet::automatic() const { return desiredFrameRate.getValue() > 0; }

bool SoMRFaceSet::moving() const {
  return interacting.getValue() || (matrices_move_ && !viewer_counts_);
}

int SoMRFaceSet::budget() const {
  const int most = std::max(0, maximumResolution.getValue());
  if (automatic() && !moving()) return most;
  return std::clamp(currentResolution.getValue(), std::clamp(minimumResolution.getValue(), 0, most),
                    most);
}

SoIndexedFaceSet* SoMRFaceSet::shown() {
  Surface* const ready = surface();
  if (!ready) return nullptr;
  const auto wanted = static_cast<std::size_t>(budget());
  const auto most = static_cast<std::size_t>(std::max(0, maximumResolution.getValue()));
  const bool full = ready->trianglesFor(wanted) == ready->trianglesFor(most);
  return &ready->at(full ? Surface::kStill : Surface::kMoving, wanted);
}

void SoMRFaceSet::GLRender(SoGLRenderAction* action) {
  if (!surface()) return;
  const bool first_pass = action->getCurPass() == 0 && !action->isRenderingDelayedPaths();
  if (automatic()) {
    // A parent's render cache would draw the old resolution and hide frames from law_.
    SoCacheElement::invalidate(action->getState());
  }
  if (automatic() && first_pass && !viewer_counts_) {
    watchMatrices(action);
    if (const auto next = frameDrawn(SbTime::getTimeOfDay().getValue())) next_resolution_ = next;
    after_frame_.schedule();
  }
  shown()->GLRender(action);
}

// Detects motion: a frame whose matrices differ from those of the frame before belongs to a motion.
// The alarm that ends the motion is stopped until the frame is drawn, however long that takes.
void SoMRFaceSet::watchMatrices(SoGLRenderAction* action) {
  const SbMatrix view = viewOf(action->getState());
  const bool moved = last_view_ && view != *last_view_;
  last_view_ = view;
  if (!moved) return;
  matrices_move_ = true;
  still_alarm_.unschedule();
}

// Counts a frame; returns the new currentResolution if it has to change.
std::optional<int> SoMRFaceSet::frameDrawn(double now_s) {
  Surface* const ready = automatic() && moving() ? surface() : nullptr;
  if (!ready) {
    law_.rest();
    return std::nullopt;
  }
  const std::size_t triangles = ready->trianglesFor(static_cast<std::size_t>(budget()));
  const auto wanted = law_.frameDrawn(now_s, triangles, desiredFrameRate.getValue());
  if (!wanted) return std::nullopt;
  const int most = std::max(0, maximumResolution.getValue());
  const int next = std::clamp(*wanted, std::clamp(minimumResolution.getValue(), 0, most), most);
  if (next == currentResolution.getValue()) return std::nullopt;
  return next;
}

void SoMRFaceSet::applyFrameTime() {
  const double now_s = frameTime.getValue().getValue();
  viewer_counts_ = now_s != 0;
  if (!viewer_counts_ || reading_) return;
  if (const auto next = frameDrawn(now_s)) currentResolution = *next;
}

// Resets the two fields that a viewer sets: a file may hold the state of another viewer.
SbBool SoMRFaceSet::readInstance(SoInput* in, unsigned short flags) {
  reading_ = true;
  const SbBool read = SoShape::readInstance(in, flags);
  reading_ = false;
  interacting = FALSE;
  frameTime = SbTime::zero();
  return read;
}

void SoMRFaceSet::endFrame(void* self, SoSensor*) {
  auto* const node = static_cast<SoMRFaceSet*>(self);
  if (const auto next = std::exchange(node->next_resolution_, std::nullopt)) {
    node->currentResolution = *next;
  }
  if (!node->matrices_move_ || node->still_alarm_.isScheduled()) return;
  node->still_alarm_.setTimeFromNow(kSettle_s);
  node->still_alarm_.schedule();
}

void SoMRFaceSet::becomeStill(void* self, SoSensor*) {
  auto* const node = static_cast<SoMRFaceSet*>(self);
  node->matrices_move_ = false;
  node->law_.rest();
  node->currentResolution.touch();  // causes a redraw
}

void SoMRFaceSet::getPrimitiveCount(SoGetPrimitiveCountAction* action) {
  if (!shouldPrimitiveCount(action)) return;
  Surface* const ready = surface();
  if (!ready) return;
  action->addNumTriangles(
      static_cast<int>(ready->trianglesFor(static_cast<std::size_t>(budget()))));
}

void SoMRFaceSet::computeBBox(SoAction*, SbBox3f& box, SbVec3f& center) {
  Surface* const ready = surface();
  if (!ready) return;
  box = ready->box();  // is the same for every resolution
  center = box.getCenter();
}

void SoMRFaceSet::generatePrimitives(SoAction* action) {
  const SoIndexedFaceSet* const drawn = shown();
  if (!drawn) return;
  SoVertexProperty& attributes = surface_->attributes();
  action->getState()->push();
  attributes.doAction(action);
  SoFaceDetail face;
  SoPointDetail point;
  SoPrimitiveVertex corner;
  corner.setDetail(&point);
  const int* index = drawn->coordIndex.getValues(0);
  beginShape(action, TRIANGLES, &face);
  for (int at = 0; at < drawn->coordIndex.getNum(); at += 4, face.incFaceIndex()) {
    corner.setNormal(facing(attributes.vertex, index + at));
    for (int k = at; k < at + 3; ++k) {
      setCorner(attributes, index[k], corner, point);
      shapeVertex(&corner);
    }
  }
  endShape();
  action->getState()->pop();
}
