// House rule: in steady state a frame allocates nothing of ours (STYLE 10).
#include <array>
#include <vector>

#include "tests/gpu/painter/painter_fixture.h"
#include "tests/support/allocation_count.h"
#include "tests/support/tag_scene.h"

namespace pleinair {
namespace {

using support::poseOf;

constexpr hal::FrameSize kFrame{320, 240};

tracking::CameraModel camera() {
  return {{.fx = 300.0, .fy = 300.0, .cx = 160.0, .cy = 120.0}, {.k1 = 0.05}, kFrame};
}

/// Three with a place in the world, one of which was moved, and one without.
const std::array<support::SceneTag, 4> kTags{
    {{.id = 0, .edgeMetres = 0.06, .worldFromTag = poseOf({}, {-0.1, 0.0, 0.0})},
     {.id = 1, .edgeMetres = 0.06, .worldFromTag = poseOf({}, {0.1, 0.05, 0.0})},
     {.id = 2, .edgeMetres = 0.06, .worldFromTag = poseOf({0.1, 0.1, 0.0}, {0.0, -0.08, 0.0})},
     {.id = 3, .edgeMetres = 0.06, .worldFromTag = poseOf({}, {0.0, 0.08, 0.0})}}};

scene::SceneModel modelOn(std::optional<int> tag, const scene::ModelSource& source) {
  return {.name = "model",
          .source = source,
          .model = std::make_shared<const scene::Model>(scene::modelOf(source).value()),
          .tagId = tag};
}

scene::Scene sceneOfTags() {
  scene::Scene scene;
  scene.camera = camera();
  for (const support::SceneTag& tag : kTags) {
    tracking::TagMarker marker{.id = tag.id, .edgeMetres = tag.edgeMetres};
    if (tag.id != 3) marker.worldFromTag = tag.worldFromTag;
    if (tag.id == 2) marker.worldFromTag = poseOf({}, {0.02, -0.06, 0.0});
    scene.tags.push_back(marker);
  }
  scene.models.push_back(modelOn(3, scene::BoxSource{glm::dvec3(0.05)}));
  scene.models.push_back(modelOn(0, scene::GearSource{}));
  scene.models.push_back(modelOn(1, scene::GearboxSource{}));
  scene.models.push_back(modelOn(std::nullopt, scene::BoxSource{glm::dvec3(0.03)}));
  scene.models.back().focus = 1.0F;
  return scene;
}

/// The camera sways; every third frame sees one tag only, every fifth none.
std::vector<hal::CapturedFrame> framesOf(hal::PixelFormat format) {
  std::vector<hal::CapturedFrame> frames;
  for (int i = 0; i < 15; ++i) {
    const glm::dmat4 cameraFromWorld = poseOf({0.02 * i, 0.1, 0.01 * i}, {0.002 * i, 0.0, 0.45});
    const std::size_t shown = i % 5 == 4 ? 0 : i % 3 == 2 ? 1 : kTags.size();
    const hal::Image grey =
        support::renderTags(camera(), cameraFromWorld, std::span(kTags).first(shown));
    frames.push_back(frameOf(support::neutralPicture(grey, format), i));
  }
  return frames;
}

/// A row of frames as an output has them painted.
struct Show {
  Painter& painter;
  bool changesLevels = false;
  const std::size_t levels = qualityLevels().size();
  PaintParameters parameters = painter.defaultParameters();
  const int readback = painter.openReadback({hal::PixelFormat::kI420, kFrame});
  OutputFrame picture;
  std::size_t painted = 0;
  std::size_t maxTags = 0;
  bool everWorld = false;

  /// Visits all levels, the next but one first where that meets all of them.
  std::size_t levelAfter() const {
    return (parameters.quality + (levels % 2 == 1 ? 2 : 1)) % levels;
  }

  void play(const std::vector<hal::CapturedFrame>& frames) {
    for (const hal::CapturedFrame& frame : frames) {
      if (changesLevels && painted % 2 == 0) parameters.quality = levelAfter();
      const hal::Result<Picture> result = painter.paint(frame, parameters);
      if (!result) continue;
      ++painted;
      maxTags = std::max(maxTags, result->tracking.tags.size());
      everWorld |= result->tracking.cameraFromWorld.has_value();
      while (hal::orThrow(painter.hasRoom(readback) ? painter.poll(readback, picture)
                                                    : painter.wait(readback, picture))) {
      }
    }
  }
};

class PainterAllocations : public PainterTest,
                           public testing::WithParamInterface<hal::PixelFormat> {};

TEST_P(PainterAllocations, AreNoneAFrameOnceAllIsWarm) {
  SCOPED_TRACE(toString(GetParam()));
  const std::vector<hal::CapturedFrame> frames = framesOf(GetParam());
  Painter painter({.pictureSize = kFrame, .scene = sceneOfTags()});
  Show show{.painter = painter};
  show.play(frames);
  ASSERT_EQ(show.painted, frames.size());
  ASSERT_EQ(show.maxTags, kTags.size());
  ASSERT_TRUE(show.everWorld);
  EXPECT_EQ(support::allocationsIn([&] { show.play(frames); }), 0) << support::allocationSites();
  EXPECT_EQ(show.painted, 2 * frames.size());
}

INSTANTIATE_TEST_SUITE_P(Formats, PainterAllocations,
                         testing::Values(hal::PixelFormat::kI420, hal::PixelFormat::kNv12,
                                         hal::PixelFormat::kRgb8, hal::PixelFormat::kYuyv,
                                         hal::PixelFormat::kBayerRggb8));

TEST_F(PainterTest, ChangesOfLevelAllocateNothing) {
  const std::vector<hal::CapturedFrame> frames = framesOf(hal::PixelFormat::kI420);
  Painter painter({.pictureSize = kFrame,
                   .scene = sceneOfTags(),
                   .expectedFormat = frames[0].image.format,
                   .qualityLevels = true});
  Show show{.painter = painter};
  show.play(frames);  // at full only: the others are ready
  show.changesLevels = true;
  EXPECT_EQ(support::allocationsIn([&] { show.play(frames); }), 0) << support::allocationSites();
  EXPECT_EQ(show.painted, 2 * frames.size());
}

TEST_F(PainterTest, AllocationsAreCountedOnThePaintersThread) {
  Painter painter({.pictureSize = kFrame, .scene = sceneOfTags()});
  const PaintParameters parameters = painter.defaultParameters();
  const std::vector<hal::CapturedFrame> frames = framesOf(hal::PixelFormat::kI420);
  EXPECT_GT(support::allocationsIn([&] { (void)painter.paint(frames[0], parameters); }), 0);
  std::string text;
  EXPECT_EQ(support::allocationsIn([&] { text = std::string(100, 'x'); }), 1)
      << "what the C++ library allocates for us is ours";
}

}  // namespace
}  // namespace pleinair
