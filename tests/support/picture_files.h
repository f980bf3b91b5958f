// Checks of image files that programs have written.
#pragma once

#include <cstring>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "render/image/image_file.h"

namespace merlin::test {

// Expects an image file that can be read and has at least `least` distinct colours. If `width` is
// not 0, the image must be width x height pixels.
inline void expectPicture(const std::string& path, std::size_t least, int width = 0,
                          int height = 0) {
  const auto image = render::image::readImage(path);
  ASSERT_TRUE(image) << image.error().what;
  if (width > 0) {
    EXPECT_EQ(image->width, width) << path;
    EXPECT_EQ(image->height, height) << path;
  }
  std::set<std::uint32_t> colours;
  for (std::size_t i = 0; i < image->pixels.size(); i += 3) {
    std::uint32_t colour = 0;
    std::memcpy(&colour, &image->pixels[i], 3);
    colours.insert(colour);
  }
  EXPECT_GE(colours.size(), least) << path << " shows too few colours";
}

}  // namespace merlin::test
