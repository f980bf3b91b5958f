// Navigator: moves a content or the viewer according to input; one class for each kind of
// navigation. Pure.
//
// Wall frame as in scene.h. Input vectors are given in the axes of the viewer: x right, y up, z
// towards the person; these are the wall's axes until the viewer turns.
#pragma once

#include <Eigen/Geometry>

#include "render/content/navigation.h"
#include "render/scene/settings.h"

namespace merlin::render::scene {

enum class BallMode { kObject, kFly };  // the ball moves the content, or the viewer

struct Poses {
  Eigen::Isometry3f T_wall_content, T_wall_eye;
};

// Translation and rotation of one frame; the rotation is a vector along its axis whose length is
// the angle.
struct Push {
  Eigen::Vector3f way_m = Eigen::Vector3f::Zero(), turn_rad = Eigen::Vector3f::Zero();
};

// Port (an interface): how one kind of content and its viewer are moved. Stateless. Cost of a call:
// under a microsecond.
class Navigator {
 public:
  virtual ~Navigator() = default;

  virtual Poses start() const = 0;
  virtual void push(Poses& poses, const Push& push, BallMode mode) const = 0;
  // Moves the viewer by `way_m`; called in each frame in which a hand steers the flight.
  virtual void fly(Poses& poses, const Eigen::Vector3f& way_m) const = 0;
  // Turns the content while nobody touches it, as a demonstration: an object rotates about the
  // viewer's vertical axis, its front to the right; in a panorama the view turns to the right.
  // Returns false, and moves nothing, if the content is demonstrated at rest, as a plane is.
  virtual bool turn(Poses& poses, float angle_rad) const = 0;
  // Moves a content that is grabbed: the hand was at `hand_then` and the poses were `grabbed` when
  // the grab began; the hand is at `hand` now.
  virtual void carry(Poses& poses, const Poses& grabbed, const Eigen::Isometry3f& hand_then,
                     const Eigen::Isometry3f& hand) const = 0;
};

// For an object, which is rotated about its own centre and translated. In mode kFly the ball
// translates the viewer and rotates the view about the eye.
class ObjectNavigator final : public Navigator {
 public:
  explicit ObjectNavigator(const SceneSettings& settings);
  Poses start() const override;
  void push(Poses& poses, const Push& push, BallMode mode) const override;
  void fly(Poses& poses, const Eigen::Vector3f& way_m) const override;
  bool turn(Poses& poses, float angle_rad) const override;
  void carry(Poses& poses, const Poses& grabbed, const Eigen::Isometry3f& hand_then,
             const Eigen::Isometry3f& hand) const override;

 private:
  float hand_gain_;
  Poses start_;
};

// For a plane that faces the viewer. It is moved sideways, and zoomed by changing its distance; the
// same push zooms by the same factor at any distance. The plane never rotates, and its centre stays
// within its radius of the view's axis, both horizontally and vertically. In both modes the ball
// moves the plane.
class PlaneNavigator final : public Navigator {
 public:
  // `nearest`: the minimum distance, as a multiple of the initial one.
  explicit PlaneNavigator(const SceneSettings& settings, float nearest = kNearest);
  Poses start() const override;
  void push(Poses& poses, const Push& push, BallMode mode) const override;
  void fly(Poses& poses, const Eigen::Vector3f& way_m) const override;
  bool turn(Poses& poses, float angle_rad) const override;
  void carry(Poses& poses, const Poses& grabbed, const Eigen::Isometry3f& hand_then,
             const Eigen::Isometry3f& hand) const override;

  // Nearest (by default) and farthest distance, as multiples of the initial one.
  static constexpr float kNearest = content::kNearestPlane, kFarthest = 4;

 private:
  void move(Poses& poses, const Poses& from, const Eigen::Vector3f& way_m) const;

  float hand_gain_, distance_m_, radius_m_, nearest_;
};

// The viewer stands in the centre of a panorama and looks around: without limit about the vertical
// axis, up and down by at most kMostPitch_rad, without roll. To zoom in, the panorama is pulled
// towards the viewer.
class PanoramaNavigator final : public Navigator {
 public:
  explicit PanoramaNavigator(const SceneSettings& settings);
  Poses start() const override;
  void push(Poses& poses, const Push& push, BallMode mode) const override;
  void fly(Poses& poses, const Eigen::Vector3f& way_m) const override;
  bool turn(Poses& poses, float angle_rad) const override;
  void carry(Poses& poses, const Poses& grabbed, const Eigen::Isometry3f& hand_then,
             const Eigen::Isometry3f& hand) const override;

  static constexpr float kMostPitch_rad = 1.48F;  // 85 degrees
  static constexpr float kNearest = 0.7F;         // limit of the pull, as a share of the radius

 private:
  void look(Poses& poses, const Poses& from, float yaw, float pitch, float nearer_m) const;

  float hand_gain_, radius_m_;
};

}  // namespace merlin::render::scene
