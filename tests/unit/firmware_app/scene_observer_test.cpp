#include "firmware_app/scene/scene_observer.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/scene/description/scene_file.h"
#include "tests/support/tag_scene.h"

namespace pleinair::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kThreeTags = R"(
[camera]
image_size = [640, 480]
fx = 600
fy = 600
cx = 320
cy = 240
pixel_centres = "half"
[[tag]]
id = 0
edge_m = 0.12
position_m = [-0.2, 0, 0]
[[tag]]
id = 1
edge_m = 0.12
position_m = [0.2, 0, 0]
[[tag]]
id = 2
edge_m = 0.12
position_m = [0, 0.15, 0]
)";

scene::Scene sceneOf(const std::string& text) {
  return scene::parseScene(text, "test", {});
}

/// What an observer finds in some frames from above, in which these tags lie.
std::vector<std::string> findingsOf(const scene::Scene& scene,
                                    const std::vector<support::SceneTag>& tags, int frames = 12,
                                    bool isMirrored = false) {
  const tracking::CameraModel camera = scene::assumedCamera({640, 480});
  const tracking::CameraModel& lens = scene.camera ? *scene.camera : camera;
  const glm::dmat4 cameraFromWorld = support::poseOf({3.14159265, 0, 0}, {0, 0, 0.9});
  tracking::TrackerOptions options;
  options.detector.family = scene.tagFamily;
  tracking::Tracker tracker(lens, scene.tags, options);
  SceneObserver observer(scene);
  for (int i = 0; i < frames; ++i) {
    hal::Image picture = support::renderTags(lens, cameraFromWorld, tags);
    for (int y = 0; isMirrored && y < picture.size().height; ++y) {
      std::ranges::reverse(picture.row(0, y));
    }
    observer.take(picture.view(),
                  tracker.track(picture.view(), hal::TimePoint(i * std::chrono::milliseconds(40))));
  }
  return observer.findings();
}

std::vector<support::SceneTag> tagsOf(const scene::Scene& scene) {
  std::vector<support::SceneTag> tags;
  for (const tracking::TagMarker& tag : scene.tags) {
    tags.push_back({.id = tag.id, .edgeMetres = tag.edgeMetres, .worldFromTag = *tag.worldFromTag});
  }
  return tags;
}

TEST(SceneObserver, IsSilentWhereTheSceneIsRight) {
  const scene::Scene scene = sceneOf(kThreeTags);
  EXPECT_THAT(findingsOf(scene, tagsOf(scene)), IsEmpty());
}

TEST(SceneObserver, NamesATagThatIsElsewhereAndItsPlace) {
  const scene::Scene scene = sceneOf(kThreeTags);
  std::vector<support::SceneTag> tags = tagsOf(scene);
  tags[2].worldFromTag = glm::translate(glm::dmat4(1.0), {0.0, 0.05, 0.0}) * tags[2].worldFromTag;
  EXPECT_THAT(findingsOf(scene, tags),
              ElementsAre(testing::AllOf(
                  HasSubstr("tag 2 is not where the scene places it beside the others"),
                  testing::ContainsRegex(R"(position_m = \[-?0\.00., 0\.(199|20.), -?0\.0..\])"))));
}

TEST(SceneObserver, NamesTheFamilyThatIsSeen) {
  const scene::Scene scene = sceneOf("[[tag]]\nfamily = \"tag25h9\"\nid = 3\nedge_m = 0.12\n");
  const std::vector<support::SceneTag> tags{
      {.id = 5, .edgeMetres = 0.2, .worldFromTag = scene::kAttachFromTag}};
  EXPECT_THAT(findingsOf(scene, tags),
              ElementsAre(HasSubstr("tag 3 of the scene was never seen"),
                          "the tags that are seen (5) are of the family tag36h11: give the scene's "
                          "tags family = \"tag36h11\""));
}

TEST(SceneObserver, NamesATagThatWasPrintedAtAnotherSize) {
  const scene::Scene scene = sceneOf(kThreeTags);
  std::vector<support::SceneTag> tags = tagsOf(scene);
  tags[2].edgeMetres = 0.09;
  EXPECT_THAT(findingsOf(scene, tags),
              ElementsAre(testing::AllOf(HasSubstr("tag 2 is not where the scene places it"),
                                         HasSubstr("or the edge_m of one of the tags"))));
}

TEST(SceneObserver, NamesAMirroredPrint) {
  const scene::Scene scene = sceneOf(kThreeTags);
  EXPECT_THAT(findingsOf(scene, tagsOf(scene), 12, true),
              ElementsAre(HasSubstr("never seen"), HasSubstr("printed mirrored")));
}

TEST(SceneObserver, NamesTheTagsThatAreSeenInstead) {
  const scene::Scene scene = sceneOf("[[tag]]\nid = 3\nedge_m = 0.12\n");
  const std::vector<support::SceneTag> tags{
      {.id = 5, .edgeMetres = 0.2, .worldFromTag = scene::kAttachFromTag}};
  EXPECT_THAT(findingsOf(scene, tags), ElementsAre("tag 3 of the scene was never seen; seen: 5"));
}

}  // namespace
}  // namespace pleinair::app
