// SoMRFaceSet: the multiresolution face set of [GOURLEY98] (4.2.2, 5.4) as an Open Inventor node.
// It is a separate module, which Coin loads when a file or a program names the class.
//
// Thread-bound, like all of Open Inventor. The class is in the global namespace, because Coin finds
// initClass() by its mangled name.
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

// If the fields do not describe a valid surface, the node posts one SoDebugError and draws nothing
// until they change.
class __attribute__((visibility("default"))) SoMRFaceSet : public SoShape {
  SO_NODE_HEADER(SoMRFaceSet);

 public:
  static void initClass();
  SoMRFaceSet();
  SoMRFaceSet(const SoMRFaceSet&) = delete;
  SoMRFaceSet& operator=(const SoMRFaceSet&) = delete;

  // Resolutions, as numbers of triangles. The resolution drawn is currentResolution, limited to the
  // range from minimumResolution to maximumResolution and to what the model has.
  SoSFInt32 minimumResolution, maximumResolution, currentResolution;
  // Desired frame rate [Hz]. If it is 0, the node draws currentResolution, which the user sets.
  // Otherwise the node controls the resolution: while anything moves, it sets currentResolution so
  // that this rate is held, and draws it; while nothing moves, it draws maximumResolution.
  SoSFFloat desiredFrameRate;
  // A viewer may set this to TRUE while it moves; otherwise the node detects motion by changes of
  // the matrices with which it is drawn.
  SoSFBool interacting;
  // A viewer may set this after each frame to the time of any clock. While it is not 0, the node
  // ignores its own frame times and its own detection of motion. Setting it causes no redraw.
  // Values of `interacting` and `frameTime` in a file are ignored.
  SoSFTime frameTime;

  // Attributes of all nodes of the dendrogram, in its order of nodes; `normal`, `diffuseColor` and
  // `texCoord` may be empty.
  SoMFVec3f vertex, normal;
  SoMFColor diffuseColor;
  SoMFVec2f texCoord;
  // The arrays triangles (`faces`), parents, alive (`aliveCounts`) and error (`levelErrors`) of
  // render/lod/dendrogram.h; levelErrors may be empty.
  SoMFInt32 faces, parents, aliveCounts;
  SoMFFloat levelErrors;

  SoSFNode alternateRep;  // surface for programs without this module; never drawn by this node

  void GLRender(SoGLRenderAction* action) override;
  void getPrimitiveCount(SoGetPrimitiveCountAction* action) override;
  void computeBBox(SoAction* action, SbBox3f& box, SbVec3f& center) override;
  void notify(SoNotList* list) override;

 protected:
  ~SoMRFaceSet() override;
  void generatePrimitives(SoAction* action) override;
  SbBool readInstance(SoInput* in, unsigned short flags) override;

 private:
  using Surface = merlin::render::inventor::Surface;

  void addModelFields();
  Surface* surface();  // rebuilds it if fields have changed; nullptr if they are invalid
  bool automatic() const;
  bool moving() const;
  int budget() const;  // returns the limit of triangles for the next frame
  SoIndexedFaceSet* shown();

  void watchMatrices(SoGLRenderAction* action);
  std::optional<int> frameDrawn(double now_s);
  void applyFrameTime();
  static void endFrame(void* self, SoSensor* sensor);
  static void becomeStill(void* self, SoSensor* sensor);

  std::unique_ptr<Surface> surface_;
  bool changed_ = true;         // whether model fields have changed since surface_ was made
  bool viewer_counts_ = false;  // whether frameTime is not 0
  bool reading_ = false;        // whether readInstance() is running

  merlin::render::inventor::FrameRateLaw law_;
  std::optional<int> next_resolution_;
  SoOneShotSensor after_frame_;  // changes fields after the traversal, not during it

  std::optional<SbMatrix> last_view_;
  bool matrices_move_ = false;
  SoAlarmSensor still_alarm_;
};
