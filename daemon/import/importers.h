// The table of the kinds of files that merlin-import reads. To add a kind: an adapter in
// render/import, and a row in importers.cpp.
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
  std::string folder;  // where the result and temporary files are written
  bool panorama = false;
  int quality = 90;
  int tile_px = 256;
  std::optional<std::array<double, 2>> range;  // a picture's values that become black and white
  std::string format;    // of a model: usual file name ending of its format, in lower case
  std::string hdu;       // of a FITS file: number or name of the image; empty: the first
  std::string variable;  // of a file of several maps: number or name of one; empty: none is named
  render::points::SurfaceSettings surface{};  // of a point cloud
  std::vector<std::string>
      beside{};  // absolute paths of the files beside the input, as Importer::beside has them
};

// Functions that an importer calls while it works.
struct Reports {
  // Takes the size of the result's raw data [bytes] as soon as it is known, and limits the size of
  // written files accordingly. Errors: kIo.
  std::function<Result<Ok>(std::uint64_t raw_bytes)> size;
  // Takes the share of the work that is done, 0..1, and the number of items (pixels, triangles) so
  // far.
  std::function<void(double share, std::int64_t items)> progress;
  // Takes a sentence for the user about something that was left out or assumed.
  std::function<void(const std::string&)> note;
};

// The result: the name of the file (or folder) in the request's folder, and facts about it as JSON
// members.
struct Imported {
  std::string file, facts;
};

struct Importer {
  std::string_view kind;  // first argument of merlin-import
  std::string_view help;
  // Loads libraries; called before closeSandbox(). `program`: argv[0].
  Result<Ok> (*prepare)(const char* program);
  Result<Imported> (*run)(const Request& request, const Reports& reports);
  // Returns the files beside the input that may be read as well, such as textures; null: there are
  // none.
  std::vector<std::string> (*beside)(const std::string& input) = nullptr;
};

std::span<const Importer> importers() noexcept;

}  // namespace merlin::import
