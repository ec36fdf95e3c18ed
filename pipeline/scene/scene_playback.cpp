#include "pipeline/scene/scene_playback.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "config/suggestion.h"

namespace pleinair::scene {
namespace {

std::vector<std::string> namesOf(const Rig& rig) {
  std::vector<std::string> names;
  for (const Clip& clip : rig.clips) names.push_back(clip.name);
  return names;
}

std::optional<std::size_t> readClip(const config::TomlTable& table, const Rig& rig) {
  const auto name = table.optionalString("clip");
  if (!name) return rig.clips.size() == 1 ? std::optional<std::size_t>(0) : std::nullopt;
  const std::vector<std::string> names = namesOf(rig);
  const auto found = std::ranges::find(names, *name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw table.error(
      "clip", "found " + config::foundText(*name, names),
      names.empty() ? "a model with animations; this one has none" : config::listText(names));
}

}  // namespace

Playback readPlayback(const config::TomlTable& table, const Rig& rig) {
  static constexpr std::array<config::Choice<bool>, 2> kStarts{
      {{"at_once", false}, {"on_sight", true}}};
  Playback playback{.clip = readClip(table, rig)};
  playback.speed =
      table.optionalNumber("speed", {.min = -100.0, .max = 100.0}).value_or(playback.speed);
  playback.loops = table.optionalBoolean("loop").value_or(playback.loops);
  playback.startsOnSight = table.optionalChoice("start", kStarts).value_or(playback.startsOnSight);
  if (playback.clip) return playback;
  for (const char* key : {"speed", "loop", "start"}) {
    if (!table.has(key)) continue;
    throw table.error(key, "is for a clip, and none is played",
                      rig.clips.empty() ? "a model with animations; this one has none"
                                        : "clip as one of " + config::listText(namesOf(rig)));
  }
  return playback;
}

std::optional<std::string> standingStillNotice(const Rig& rig, const Playback& playback) {
  if (playback.clip || rig.clips.empty()) return std::nullopt;
  return fmt::format("stands at rest; clip = \"NAME\" plays one of its animations: {}",
                     config::listText(namesOf(rig)));
}

}  // namespace pleinair::scene
