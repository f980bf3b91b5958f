// A handle of libvips' images, and one step of their processing. Private to render/import.
#pragma once

#include <memory>

#include <vips/vips.h>

namespace merlin::render::import {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using Image = std::unique_ptr<VipsImage, Unref>;

// A step of the way: replaces the image by what `step` makes of it, which keeps what it needs of
// the one before. `step` returns what functions of libvips return: 0 for success.
template <typename Step>
bool applyStep(Image& image, const Step& step) {
  VipsImage* made = nullptr;
  if (step(image.get(), &made) != 0) return false;
  image.reset(made);
  return true;
}

}  // namespace merlin::render::import
