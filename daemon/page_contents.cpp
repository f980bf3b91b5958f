#include "daemon/page_contents.h"

#include <memory>
#include <string>
#include <utility>

#include "daemon/wall/wall_contents.h"
#include "render/image/overview.h"

namespace merlin {
namespace {

using wall::ContentEntry;
using wall::ContentKind;

const char* kindOf(const ContentEntry& entry) {
  if (entry.kind == ContentKind::kModel) return "model";
  if (entry.kind == ContentKind::kSlides) return "slides";
  return entry.show_as == render::content::ShowAs::kPanorama ? "panorama" : "picture";
}

Result<page::ReadPicture> readPicture(const ContentEntry& entry) {
  std::vector<std::string> skipped;
  const auto content = wall::readContent(entry, {}, {}, skipped);
  if (!content) return content.error();
  const auto& picture = *std::get<std::shared_ptr<const render::content::Picture>>(content->data);
  auto image = render::image::readOverview(picture.file);
  if (!image) return image.error();
  return page::ReadPicture{*std::move(image),
                           picture.kind == render::content::PictureKind::kPanorama};
}

}  // namespace

std::vector<page::PageContent> pageContents(const WallSettings& wall) {
  std::vector<page::PageContent> contents;
  for (const ContentEntry& entry : wall::contentsOf(wall)) {
    if (entry.path.empty()) continue;
    contents.push_back({entry.name, kindOf(entry), entry.path, {}});
    if (entry.kind != ContentKind::kModel)
      contents.back().read = [entry] { return readPicture(entry); };
  }
  return contents;
}

}  // namespace merlin
