#include <cstdio>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware_app/cli/path_collisions.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/sheets/tag_sheets.h"
#include "hal/pending_file.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

/// The tags of the scene, or those that the options name.
std::vector<PrintedTag> tagsOf(const TagsOptions& options) {
  std::vector<PrintedTag> tags;
  if (!options.scene) {
    for (const int id : options.ids) tags.push_back({options.family, id, options.edgeMetres});
    return tags;
  }
  const scene::Scene scene = sceneOfFile(*options.scene);
  for (const tracking::TagMarker& tag : scene.tags) {
    tags.push_back({scene.tagFamily, tag.id, tag.edgeMetres});
  }
  if (tags.empty()) {
    throw hal::Failure(hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                                  .subject = options.scene->string(),
                                  .problem = "has no tag",
                                  .remedy = "give --ids"});
  }
  return tags;
}

/// The tables of a scene file that describe these tags.
std::string sceneText(const std::vector<PrintedTag>& tags) {
  std::string text;
  for (const PrintedTag& tag : tags) {
    text += fmt::format("\n[[tag]]\nid = {}\nedge_m = {:g}\n", tag.id, tag.edgeMetres);
    if (tag.family != "tag36h11") text += fmt::format("family = \"{}\"\n", tag.family);
  }
  return text;
}

}  // namespace

int printTags(const TagsOptions& options) {
  if (options.scene) refuseCollisions({{"--scene", *options.scene}}, {{"--sheet", options.sheet}});
  std::vector<std::uint8_t> pdf;
  std::string text;
  if (options.board) {
    const calibration::Board board = boardOf(*options.board);
    pdf = boardSheet(board, options.paper);
    text = fmt::format("{}: {}\n", options.sheet.string(), board.text());
  } else {
    const std::vector<PrintedTag> tags = tagsOf(options);
    pdf = tagSheets(tags, options.paper);
    text = fmt::format("{}: {} {} of {}\n", options.sheet.string(), tags.size(),
                       tags.size() == 1 ? "tag" : "tags", tags.front().family);
    if (!options.scene) text += sceneText(tags);
  }
  hal::PendingFile file = orThrow(hal::PendingFile::create(options.sheet));
  orThrow(file.write(pdf));
  orThrow(file.publish());
  writeText(stdout, text);
  return 0;
}

}  // namespace pleinair::app
