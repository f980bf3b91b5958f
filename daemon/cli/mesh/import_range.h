// Reads a range image or an elevation map and makes a mesh of it, for `merlin mesh import`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/clock.h"
#include "daemon/base/result.h"
#include "daemon/cli/arguments.h"
#include "daemon/cli/mesh/about_text.h"
#include "daemon/cli/progress.h"
#include "render/range/io/range_file.h"
#include "render/range/triangulate.h"

namespace merlin::cli {

// The command-line options for range images.
class RangeImport {
 public:
  void addTo(Command command);
  // Adds all options except --max-edge, --feature, --colour-by and --border, for a command that
  // makes its own mesh from several files.
  void addReadingTo(Command command);
  // Returns the name of one of these options that was given, for a message that it does not apply;
  // empty if none was given.
  std::string anyGiven() const;
  // Returns the name of a given option that affects a mesh only, and so has no effect if the output
  // is a range image; empty if none was given.
  std::string givenForMesh() const;
  // Removes from the values of --angles a file name that the parser took for one of them, because
  // the option was before the input, and returns it; nothing if there is none.
  std::optional<std::string> takeInput();

  // Returns advice for a message about a feature whose file is missing.
  std::string otherFileFor(const std::string& feature) const;

  // Returns the options for the readers. Errors: kInvalidArgument (values or a combination of
  // options are not valid), those of parseRawLayout().
  Result<render::range::RangeOptions> fileOptions() const;

  bool isRaw() const { return !raw_.empty(); }
  bool filters() const { return !between.empty() || !spikes.empty() || median > 0; }

  std::optional<double> scale;  // metres per unit of the file, for any input
  std::string hdu;              // HDU of a FITS file; empty: the first image
  std::string variable;         // variable of a file with several maps
  std::string colour_by, max_edge, spikes;
  std::vector<std::string> features;
  std::vector<double> between;
  std::size_t median = 0;
  bool border = false;

 private:
  Argument keep(const char* name, Argument argument);  // remembers the option for anyGiven()
  void addGeometry(Command command);
  void addRaw(Command command);
  void addMaxEdge(Command command);
  void addFilters(Command command);
  void addFeatures(Command command);

  std::string geometry_, raw_;
  std::vector<std::string> angles_;
  std::vector<double> cell_;
  std::optional<double> exaggeration_, no_return_;
  std::size_t raw_header_ = 0;
  bool raw_interleaved_ = false;
  bool takes_features_ = false;  // whether the command has the option --feature
  std::vector<Argument> arguments_;
  std::vector<std::string> names_;
};

// A range image, what was done to it, and the mesh made from it.
struct ImportedRange {
  render::range::RangeImage image;
  std::string format;
  std::vector<std::string> notes;
  std::vector<FeatureFacts> features;
  bool in_metres = false;  // whether its unit is the metre, as in LoadedRange
  std::size_t returns_in_file = 0, outside = 0, spikes = 0;
  render::range::Threshold max_edge;
  std::string max_edge_text;  // description of `max_edge` for a person
  render::range::RangeMesh mesh;
  // Origin that must be added to the coordinates of the mesh to get those of the file.
  render::mesh::Origin origin{};
};

// A function that reads a file with these options, such as render::range::readRange().
using RangeReader = std::function<Result<render::range::LoadedRange>(
    const std::string& path, const render::range::RangeOptions&)>;

// Reads a range image and its modalities. `texture`: whether a texture will be put on the mesh.
// Errors: those of the readers; kInvalidArgument (an option is not valid, or two features have the
// same name); kMalformed (the file names a feature that is not allowed).
Result<ImportedRange> loadRange(const std::string& path, const RangeImport& options, bool texture,
                                const RangeReader& read);

// Runs the filters that the options name, after checking that the filters and the mesh need at most
// `limit` bytes. Errors: kInvalidArgument (too little memory, or an invalid threshold), kMalformed
// (no return is left).
Result<Ok> filterRange(const std::string& path, const RangeImport& options, std::size_t limit,
                       const render::range::Work& work, ImportedRange& range);

// Chooses an origin near the scanner's position, whose coordinates may be the large numbers of a
// map; subtracts it from the camera transform, and returns it.
render::mesh::Origin takeOrigin(render::range::Geometry& geometry);
// Subtracts the origin from the translation of the camera transform.
void subtract(const render::mesh::Origin& origin, render::range::Geometry& geometry);

// Makes the mesh and sets range.origin, which it is relative to: the origin of the map of an
// elevation map, otherwise that of takeOrigin(). Errors: kInvalidArgument (--max-edge or
// --colour-by is not valid), kMalformed (no triangle has edges within --max-edge).
Result<Ok> meshRange(const std::string& path, const RangeImport& options,
                     const render::range::Work& work, ImportedRange& range);

}  // namespace merlin::cli
