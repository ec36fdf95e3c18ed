#include "pipeline/scene/scene_attachment.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pleinair::scene {

std::optional<int> readAttachment(const config::TomlTable& table, const Scene& scene) {
  const std::string text = table.string("attach");
  const bool hasWorld = std::ranges::any_of(
      scene.tags, [](const tracking::TagMarker& tag) { return tag.worldFromTag.has_value(); });
  if (text == "world") {
    if (hasWorld) return std::nullopt;
    throw table.error("attach", "no tag says where the world is",
                      "\"world\" once a [[tag]] has a position_m");
  }
  for (const tracking::TagMarker& tag : scene.tags) {
    if (text == fmt::format("tag:{}", tag.id)) return tag.id;
  }
  std::vector<std::string> places;
  if (hasWorld) places.emplace_back("\"world\"");
  for (const tracking::TagMarker& tag : scene.tags)
    places.push_back(fmt::format("\"tag:{}\"", tag.id));
  throw table.error("attach", "found " + config::quoted(text),
                    places.empty() ? "the scene's tags, but it has no [[tag]]"
                                   : fmt::format("{}", fmt::join(places, ", ")));
}

}  // namespace pleinair::scene
