// SoMRFaceSet: the multiresolution face set of 1998 as an Open Inventor node ([GOURLEY98] 4.2.2,
// 5.4). A module of its own, which Coin loads where a file or a program names the class.
//
// Thread-bound, as all of Open Inventor. In the global namespace: Coin calls it by its mangled
// name.
#pragma once

#include <memory>
#include <optional>

#include <Inventor/SbMatrix.h>
#include <Inventor/fields/SoMFColor.h>
#include <Inventor/fields/SoMFFloat.h>
#include <Inventor/fields/SoMFInt32.h>
#include <Inventor/fields/SoMFVec2f.h>
#include <Inventor/fields/SoMFVec3f.h>
#include <Inventor/fields/SoSFBool.h>
#include <Inventor/fields/SoSFFloat.h>
#include <Inventor/fields/SoSFInt32.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/fields/SoSFTime.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoSubNode.h>
#include <Inventor/sensors/SoAlarmSensor.h>
#include <Inventor/sensors/SoOneShotSensor.h>

#include "render/inventor/frame_rate_law.h"
#include "render/inventor/surface.h"

// Fields that describe no surface give one SoDebugError, and nothing is drawn until they change.
class __attribute__((visibility("default"))) SoMRFaceSet : public SoShape {
  SO_NODE_HEADER(SoMRFaceSet);

 public:
  static void initClass();
  SoMRFaceSet();
  SoMRFaceSet(const SoMRFaceSet&) = delete;
  SoMRFaceSet& operator=(const SoMRFaceSet&) = delete;

  // In triangles. Current is kept within the other two, and they within what the model has.
  SoSFInt32 minimumResolution, maximumResolution, currentResolution;
  // Hz. 0: currentResolution is drawn, and set by hand. Else it is what holds this rate, set by the
  // node and drawn while anything moves; maximumResolution is drawn while all is still.
  SoSFFloat desiredFrameRate;
  // A viewer may say when it moves; else the node takes it from the matrices it is drawn with.
  SoSFBool interacting;
  // A viewer may say when it has drawn a frame, by any clock; while this is not 0 it alone is
  // believed, for `interacting` too. Changing it draws nothing. Neither is taken from a file.
  SoSFTime frameTime;

  // Attributes of all nodes of the dendrogram, numbered by their death; the last three may be
  // empty.
  SoMFVec3f vertex, normal;
  SoMFColor diffuseColor;
  SoMFVec2f texCoord;
  // render/lod/dendrogram.h: triangles, parents, alive; levelErrors may be empty.
  SoMFInt32 faces, parents, aliveCounts;
  SoMFFloat levelErrors;

  SoSFNode alternateRep;  // for programs without this module; not drawn here

  void GLRender(SoGLRenderAction* action) override;
  void getPrimitiveCount(SoGetPrimitiveCountAction* action) override;
  void computeBBox(SoAction* action, SbBox3f& box, SbVec3f& center) override;
  void notify(SoNotList* list) override;

 protected:
  ~SoMRFaceSet() override;
  void generatePrimitives(SoAction* action) override;
  SbBool readInstance(SoInput* in, unsigned short flags) override;

 private:
  using Surface = merlin::render::Surface;

  void addModelFields();
  Surface* surface();  // made of the fields where they have changed; nullptr where they are broken
  bool automatic() const;
  bool moving() const;
  int budget() const;  // triangles, at most
  SoIndexedFaceSet* shown();

  void watchMatrices(SoGLRenderAction* action);
  std::optional<int> frameDrawn(double now_s);
  void applyFrameTime();
  static void endFrame(void* self, SoSensor* sensor);
  static void becomeStill(void* self, SoSensor* sensor);

  std::unique_ptr<Surface> surface_;
  bool changed_ = true;         // the model's fields, since surface_ was made
  bool viewer_counts_ = false;  // frameTime is set
  bool reading_ = false;        // from a file

  merlin::render::FrameRateLaw law_;
  std::optional<int> next_resolution_;
  SoOneShotSensor after_frame_;  // fields are not changed while they are drawn

  std::optional<SbMatrix> last_view_;
  bool matrices_move_ = false;
  SoAlarmSensor still_alarm_;
};
