// The table of what merlin-import reads. To add a kind: an adapter in render/import, and a row in
// importers.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "render/points/surface_guess.h"

namespace merlin::import {

struct Request {
  std::string input;   // the file to read
  std::string folder;  // where the result is written, and whatever is needed meanwhile
  bool panorama = false;
  int quality = 90;
  int tile_px = 256;
  std::optional<std::array<double, 2>> range;  // of a picture's values: black and white
  std::string format;    // of a model: ending of the usual name of its format, in lower case
  std::string hdu;       // of a FITS file: number or name of the image; empty: the first
  std::string variable;  // of a file of several maps: number or name of one; empty: none is named
  render::points::SurfaceSettings surface{};  // of a point cloud
  std::vector<std::string>
      beside{};  // absolute paths of the files beside the input, as Importer::beside has them
};

// What an importer tells while it works.
struct Reports {
  // The size of the result's raw data [bytes], as soon as it is known: it limits what is written.
  std::function<Result<Ok>(std::uint64_t raw_bytes)> size;
  // The part of the work that is done, 0..1, and the number of items (pixels, triangles) so far.
  std::function<void(double share, std::int64_t items)> progress;
  // For the user: something that was left out or assumed.
  std::function<void(const std::string&)> note;
};

// What was made: the name of the file in the request's folder, and facts about it as JSON members.
struct Imported {
  std::string file, facts;
};

struct Importer {
  std::string_view kind;  // first argument of merlin-import
  std::string_view help;
  // Loads libraries, before the sandbox closes.
  Result<Ok> (*prepare)(const char* program);
  Result<Imported> (*run)(const Request& request, const Reports& reports);
  // The files beside the input that may be read as well, such as textures; null: none.
  std::vector<std::string> (*beside)(const std::string& input) = nullptr;
};

std::span<const Importer> importers() noexcept;

}  // namespace merlin::import
