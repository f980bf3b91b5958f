#include "render/mesh/io/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
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

// The ending in lower case, "ply" for "a/b.PLY"; empty if the name has none.
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

// Returns a note if floats, so far from 0, are too coarse for a mesh of this size; empty if they
// resolve at least 16,384 steps along its diagonal.
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

struct CompanionFile {
  std::string path, content;
};

// The companion files that the mesh file refers to: the texture image and the material file.
std::vector<CompanionFile> companionsOf(const MeshWriter& writer, const Mesh& mesh,
                                        const std::string& path) {
  if (!isTextured(mesh) || writer.picture != PicturePlace::kCompanionFile) return {};
  const std::string name = plainName(path), folder = folderOf(path);
  std::vector<CompanionFile> files = {
      {folder + pictureName(mesh, name), {mesh.texture.begin(), mesh.texture.end()}}};
  if (writer.material) files.push_back({folder + name + ".mtl", writer.material(mesh, name)});
  return files;
}

// Whether the companion file exists already, with the same content. Its name was not given by the
// user, so a file with different content is not overwritten. Errors: kInvalidArgument (different
// content).
Result<bool> isThere(const CompanionFile& file) {
  std::error_code absent;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file.path, absent))) return false;
  const auto there = MappedFile::open(file.path);
  if (there && there->text() == file.content) return true;
  return Error{Errc::kInvalidArgument,
               file.path + ": exists with different content; remove it or name another output"};
}

// Writes files, and removes them in its destructor unless keep() was called.
class WrittenFiles {
 public:
  WrittenFiles() = default;
  ~WrittenFiles() {
    std::error_code gone;
    for (const std::string& path : paths_) std::filesystem::remove(path, gone);
  }
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;

  Result<Ok> make(const CompanionFile& file) {
    const auto done = writeFile(file.path, file.content);
    if (done) paths_.push_back(file.path);
    return done;
  }
  void keep() { paths_.clear(); }

 private:
  std::vector<std::string> paths_;
};

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
  // Colours of faces may need a vertex for each corner of its triangles.
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
  *file = MappedFile();  // unmap it: it is as large as the mesh
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
  WrittenFiles files;
  for (const CompanionFile& file : companionsOf(writer, mesh, path)) {
    const auto there = isThere(file);
    if (!there) return there.error();
    const auto done = *there ? Result<Ok>(Ok{}) : files.make(file);
    if (!done) return done.error();
    written.companions.push_back(file.path);
  }
  const auto done = writeFile(
      path, [&](const WriteBytes& bytes) { return writer.write(mesh, added, name, bytes); });
  if (!done) return done.error();
  files.keep();
  for (const Feature& f : mesh.features) {
    if (!writer.carries(mesh, f)) written.left_out.push_back(f.name);
  }
  if (!mesh.texture.empty() && (writer.picture == PicturePlace::kNone || !isTextured(mesh)))
    written.left_out.emplace_back("the texture image");
  return written;
}

}  // namespace merlin::render::mesh
