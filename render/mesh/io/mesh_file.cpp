#include "render/mesh/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "daemon/base/files.h"
#include "render/mesh/facet_colours.h"
#include "render/mesh/io/companion_files.h"
#include "render/mesh/io/gzip.h"
#include "render/mesh/io/reader.h"
#include "render/mesh/io/writer.h"
#include "render/mesh/non_numbers.h"
#include "render/mesh/weld_degenerate.h"

namespace merlin::render::mesh {
namespace {

// Returns the ending of a path in lower case, e.g. "ply" for "a/b.PLY"; empty if it has none.
std::string ending(const std::string& path) {
  const auto dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] != '.') return {};
  std::string end = path.substr(dot + 1);
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end;
}

Error inFile(const std::string& path, const Error& error) {
  return {error.code, path + ": " + error.what};
}

std::string noteOf(const Origin& origin) {
  return fmt::format(
      "its coordinates have more digits than a float keeps; they are taken relative to {}, {}, {}, "
      "where the mesh has its (0, 0, 0)",
      origin[0], origin[1], origin[2]);
}

// Returns a note for the user if the mesh lies so far from 0 that floats are too coarse for its
// size; an empty text if they resolve at least 16,384 steps along its diagonal.
std::string noteOfSteps(const Mesh& mesh) {
  constexpr double kFewSteps = 16384;
  const Box box = boundingBox(mesh.positions);
  float farthest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    farthest = std::max({farthest, std::abs(box.low[k]), std::abs(box.high[k])});
  const double step =
      double{std::nextafter(farthest, std::numeric_limits<float>::infinity())} - farthest;
  if (box.diagonal() >= kFewSteps * step) return {};
  return fmt::format(
      "it lies so far from (0, 0, 0) that its coordinates, which are read as floats, are rounded "
      "to steps of up to {:.2g}; a .ply of doubles or an .obj of the same mesh keeps them",
      step);
}

constexpr std::array kReaders = {&kPlyReader, &kObjReader, &kOffReader, &kOmReader, &kStlReader};
constexpr std::array kWriters = {&kPlyWriter,  &kObjWriter, &kGlbWriter,
                                 &kGltfWriter, &kStlWriter, &kInventorWriter};

const MeshWriter* writerFor(const std::string& path) {
  const std::string end = ending(path);
  for (const MeshWriter* w : kWriters) {
    if (end == w->ending) return w;
  }
  return nullptr;
}

const MeshReader* readerFor(const std::string& path) {
  const std::string end = ending(path);
  for (const MeshReader* r : kReaders) {
    if (end == r->ending) return r;
  }
  return nullptr;
}

// Returns the reader that recognises the beginning of the file; nullptr if none does.
const MeshReader* readerForContent(const std::string& path) {
  const auto file = MappedFile::open(path);
  if (!file) return nullptr;
  const std::string_view content = file->text();
  const auto found =
      std::ranges::find_if(kReaders, [&](const MeshReader* r) { return r->is && r->is(content); });
  return found == kReaders.end() ? nullptr : *found;
}

// Returns the endings as a list such as ".ply, .obj and .stl".
template <typename Rows>
std::string endingsOf(const Rows& rows) {
  std::string list;
  for (const auto* row : rows)
    list += fmt::format("{}.{}",
                        list.empty()         ? ""
                        : row == rows.back() ? " and "
                                             : ", ",
                        row->ending);
  return list;
}

// Returns the companion files that the mesh file will refer to: the texture image and the material
// file.
std::vector<CompanionFile> companionsOf(const MeshWriter& writer, const Mesh& mesh,
                                        const std::string& path) {
  if (writer.picture != PicturePlace::kCompanionFile) return {};
  auto picture = pictureBeside(mesh, path);
  if (!picture) return {};
  std::vector<CompanionFile> files = {*std::move(picture)};
  if (writer.material) {
    const std::string name = plainName(path), own = name + ".mtl";
    files.push_back({own, folderOf(path) + own, writer.material(mesh, name)});
  }
  return files;
}

}  // namespace

void replaceNonNumbers(LoadedMesh& loaded) {
  if (std::string note = replaceNonNumbers(loaded.mesh.features); !note.empty())
    loaded.notes.push_back(std::move(note));
}

bool isUsual(const Feature& f) {
  return (f.name == "normal" && f.dimension == 3) || (f.name == "colour" && f.dimension == 3) ||
         (f.name == "texcoord" && f.dimension == 2);
}

bool isTextured(const Mesh& mesh) { return !mesh.texture.empty() && findOf(mesh, "texcoord", 2); }

std::string pictureName(const Mesh& mesh, const std::string& name) {
  return name + (isPng(mesh.texture) ? ".png" : ".jpg");
}

bool isPng(const std::vector<std::uint8_t>& picture) { return picture[0] == 0x89; }

const Feature* findOf(const Mesh& mesh, std::string_view name, std::size_t dimension) {
  const Feature* f = mesh.find(name);
  return f && f->dimension == dimension ? f : nullptr;
}

std::string readableEndings() { return endingsOf(kReaders); }

bool isReadable(const std::string& path) { return readerFor(path) != nullptr; }

std::optional<MeshFileSize> meshFileSize(const std::string& path) {
  const MeshReader* reader = readerForContent(path);
  if (!reader) reader = readerFor(path);
  if (!reader || !reader->size) return std::nullopt;
  const auto file = MappedFile::open(path);
  if (!file) return std::nullopt;
  auto size = reader->size(file->text(), folderOf(path));
  const std::size_t bytes = file->text().size();
  // Allows three vertices per byte, as colours of faces may need a vertex for each corner.
  if (!size || size->mesh.vertices > 3 * bytes || size->mesh.triangles > bytes) return std::nullopt;
  return size;
}

Result<LoadedMesh> readMesh(const std::string& path) {
  if (const MeshReader* const reader = readerFor(path)) return readMeshAs(*reader, path);
  return Error{
      Errc::kUnsupported,
      fmt::format("{}: is not a mesh file that can be read here; supported are {}. merlin mesh "
                  "import reads other formats and writes a model",
                  path, readableEndings())};
}

bool isMeshFile(const std::string& path) { return readerForContent(path) != nullptr; }

Result<LoadedMesh> readMeshByContent(const std::string& path) {
  const MeshReader* const reader = readerForContent(path);
  return reader ? readMeshAs(*reader, path) : readMesh(path);
}

Result<LoadedMesh> readMeshAs(const MeshReader& reader, const std::string& path) {
  auto file = MappedFile::open(path);
  if (!file) return file.error();
  if (isGzip(file->text())) return inFile(path, packedFileError(file->text()));
  auto loaded = reader.read(file->text(), folderOf(path));
  if (!loaded) return inFile(path, loaded.error());
  *file = MappedFile();  // unmaps the file, which is as large as the mesh
  replaceNonNumbers(*loaded);
  if (const auto valid = validate(loaded->mesh); !valid) return inFile(path, valid.error());
  if (!loaded->facet_colours.empty()) {
    colourByFacets(std::exchange(loaded->facet_colours, {}), loaded->mesh);
    if (const auto valid = validate(loaded->mesh); !valid) return inFile(path, valid.error());
  }
  weldDegenerate(loaded->mesh);
  const TidyReport tidied = tidy(loaded->mesh);
  if (loaded->origin != Origin{}) loaded->notes.push_back(noteOf(loaded->origin));
  const std::size_t in_file = loaded->tidied.degenerate;
  loaded->tidied = tidied;
  loaded->tidied.degenerate += in_file;
  if (loaded->mesh.triangles.empty()) {
    return Error{Errc::kMalformed, path + ": has no triangles"};
  }
  if (auto note = noteOfSteps(loaded->mesh); !note.empty())
    loaded->notes.push_back(std::move(note));
  loaded->split = splitNonManifold(loaded->mesh);
  return loaded;
}

Result<Ok> checkMeshEnding(const std::string& path) {
  if (writerFor(path)) return Ok{};
  return Error{Errc::kUnsupported,
               fmt::format("{}: meshes are written as {}", path, endingsOf(kWriters))};
}

Result<Ok> checkCompanions(const std::string& path, const Mesh& mesh) {
  const MeshWriter* writer = writerFor(path);
  if (!writer) return Ok{};
  for (const CompanionFile& file : companionsOf(*writer, mesh, path)) {
    if (const auto there = isThere(file); !there) return there.error();
  }
  return Ok{};
}

Result<WrittenMesh> writeMesh(const std::string& path, const Mesh& mesh, const Origin& origin) {
  if (const auto known = checkMeshEnding(path); !known) return known.error();
  const MeshWriter& writer = *writerFor(path);
  if (mesh.triangles.empty()) {
    return Error{Errc::kUnsupported, path + ": the mesh has no triangles; nothing is written"};
  }
  const Origin added = writer.exact ? origin : Origin{};
  if (writer.fits) {
    if (const auto fits = writer.fits(mesh, added); !fits) return inFile(path, fits.error());
  }
  const std::string name = plainName(path);
  WrittenMesh written{writer.ending, {}, {}, writer.exact ? Origin{} : origin};
  const std::vector<CompanionFile> companions = companionsOf(writer, mesh, path);
  const auto done = writeBeside(companions, [&] {
    return writeFile(
        path, [&](const WriteBytes& bytes) { return writer.write(mesh, added, name, bytes); });
  });
  if (!done) return done.error();
  for (const CompanionFile& file : companions) written.companions.push_back(file.path);
  for (const Feature& f : mesh.features) {
    if (!writer.carries(mesh, f)) written.left_out.push_back(f.name);
  }
  if (!mesh.texture.empty() && (writer.picture == PicturePlace::kNone || !isTextured(mesh)))
    written.left_out.emplace_back("the texture image");
  return written;
}

}  // namespace merlin::render::mesh
