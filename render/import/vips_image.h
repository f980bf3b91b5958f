// Image: an owning handle for libvips' images, and a helper to process them in steps. Private to
// render/import.
#pragma once

#include <memory>

#include <vips/vips.h>

namespace merlin::render::import {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using Image = std::unique_ptr<VipsImage, Unref>;

// Replaces the image by the image that `step` makes from it; the new image keeps its own reference
// to the old one if it needs it. step(image, &made) returns 0 for success, as functions of libvips
// do. Returns whether the step succeeded; if not, the image stays unchanged.
template <typename Step>
bool applyStep(Image& image, const Step& step) {
  VipsImage* made = nullptr;
  if (step(image.get(), &made) != 0) return false;
  image.reset(made);
  return true;
}

}  // namespace merlin::render::import
