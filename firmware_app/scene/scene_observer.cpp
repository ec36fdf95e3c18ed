#include "firmware_app/scene/scene_observer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "firmware_app/scene/attach_rotation.h"
#include "firmware_app/scene/scene_warnings.h"
#include "pipeline/tracking/image/luma.h"
#include "pipeline/tracking/pose/tag_detector.h"

namespace pleinair::app {
namespace {

/// The frames that are kept while no tag is seen.
constexpr std::array<std::uint64_t, 4> kKeptFrames{0, 10, 50, 200};
/// A tag is elsewhere from so far on, as a share of its distance, or turned by so much.
constexpr double kElsewhereShare = 0.03;
constexpr double kElsewhereDegrees = 8.0;
/// The families that are printed, without those whose codes are often found in other things.
constexpr std::array<std::string_view, 5> kSearchedFamilies{
    "tag36h11", "tag25h9", "tagStandard41h12", "tag36h10", "tagStandard52h13"};

double degreesBetween(const glm::dmat4& a, const glm::dmat4& b) {
  const glm::dmat3 turn = glm::transpose(glm::dmat3(a)) * glm::dmat3(b);
  const double cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0);
  return glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0)));
}

hal::Image greyCopy(const hal::ImageView& frame) {
  tracking::LumaConverter converter;
  const hal::PlaneView luma = converter.convert(frame);
  return hal::Image(
      hal::ImageView{.format = {.pixelFormat = hal::PixelFormat::kGrey8, .size = frame.format.size},
                     .planes = {luma}});
}

}  // namespace

void SceneObserver::take(const hal::ImageView& frame, const tracking::TrackingResult& tracking) {
  for (const tracking::TrackedTag& tag : tracking.tags) {
    ++sightings_[tag.id];
    const bool isSeen = tag.source == tracking::PoseSource::kSeen &&
                        tracking.worldSource == tracking::PoseSource::kSeen;
    if (isSeen && tracking.cameraFromWorld) comparePlace(tag, *tracking.cameraFromWorld);
  }
  if (tracking.counted.mirroredTags > 0) ++mirrored_;
  const bool isKept = !scene_.tags.empty() && sightings_.empty() &&
                      std::ranges::find(kKeptFrames, frames_) != kKeptFrames.end();
  if (isKept) tagless_.push_back(greyCopy(frame));
  ++frames_;
}

std::uint64_t SceneObserver::sightings(int id) const {
  const auto found = sightings_.find(id);
  return found == sightings_.end() ? 0 : found->second;
}

void SceneObserver::comparePlace(const tracking::TrackedTag& tag,
                                 const glm::dmat4& cameraFromWorld) {
  const tracking::TagMarker* const marker = scene_.findTag(tag.id);
  if (marker == nullptr || !marker->worldFromTag || !tag.cameraFromTag) return;
  Placement& placement = placements_[tag.id];
  ++placement.frames;
  const glm::dmat4 expected = cameraFromWorld * *marker->worldFromTag;
  const double distance = glm::length(glm::dvec3((*tag.cameraFromTag)[3]));
  const double away = glm::length(glm::dvec3(expected[3] - (*tag.cameraFromTag)[3]));
  const bool isElsewhere = away > kElsewhereShare * distance ||
                           degreesBetween(expected, *tag.cameraFromTag) > kElsewhereDegrees;
  if (!isElsewhere) return;
  ++placement.elsewhere;
  placement.worldFromTag = glm::inverse(cameraFromWorld) * *tag.cameraFromTag;
}

std::string SceneObserver::familyFinding() const {
  for (const std::string_view family : kSearchedFamilies) {
    if (family == scene_.tagFamily) continue;
    tracking::TagDetectorOptions options;
    options.family = family;
    options.maxHamming = 0;
    tracking::TagDetector detector(options);
    tracking::DetectionCounters ignored;
    std::set<int> ids;
    for (const hal::Image& frame : tagless_) {
      const hal::ImageView view = frame.view();
      for (const auto& tag : detector.detect(view.planes[0], view.format.size, ignored)) {
        ids.insert(tag.id);
      }
    }
    if (ids.empty()) continue;
    return fmt::format(
        "the tags that are seen ({}) are of the family {}: give the scene's tags family = "
        "\"{}\"",
        fmt::join(ids, ", "), family, family);
  }
  return {};
}

std::vector<std::string> SceneObserver::findings() const {
  std::vector<std::string> findings;
  std::set<int> seen;
  for (const auto& [id, count] : sightings_) seen.insert(id);
  if (auto unseen = unseenTagsWarning(scene_, seen, frames_ == 1)) {
    findings.push_back(*std::move(unseen));
  }
  if (seen.empty() && !tagless_.empty()) {
    std::string family = mirrored_ == 0 ? familyFinding() : std::string();
    if (!family.empty()) findings.push_back(std::move(family));
  }
  if (seen.empty() && mirrored_ > 0) {
    findings.emplace_back(
        "the scene's tags are seen mirrored: the sheet was printed mirrored (print it anew, "
        "without "
        "the driver's mirror option), is seen in a mirror, or the camera mirrors its image");
  }
  for (const auto& [id, placement] : placements_) {
    if (2 * placement.elsewhere <= placement.frames) continue;
    const glm::dmat4 worldFromAttach = placement.worldFromTag * scene::kTagFromAttach;
    const glm::dvec3 turn = rotationDegrees(worldFromAttach);
    findings.push_back(fmt::format(
        "tag {} is not where the scene places it beside the others, in {} of {} frames; it is at "
        "position_m = [{:.3f}, {:.3f}, {:.3f}], rotation_deg = [{:.0f}, {:.0f}, {:.0f}]: correct "
        "these, or the edge_m of one of the tags",
        id, placement.elsewhere, placement.frames, worldFromAttach[3].x, worldFromAttach[3].y,
        worldFromAttach[3].z, turn.x, turn.y, turn.z));
  }
  return findings;
}

}  // namespace pleinair::app
