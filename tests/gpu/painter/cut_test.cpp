#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/cameras/synthetic/world/bench_tags.h"
#include "pipeline/styles/registry.h"
#include "tests/gpu/painter/painter_fixture.h"

namespace pleinair {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr hal::FrameSize kFrame{320, 240};
constexpr std::size_t kBefore = 5;  // frames of the scene before the cut
constexpr std::size_t kAfter = 3;

/// Appends the first frames that a camera gives; they count as a 30th of a second apart.
void film(const hal::SyntheticOptions& options, std::size_t count,
          std::vector<hal::CapturedFrame>& frames) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera(options, clock);
  ASSERT_TRUE(camera.start({}));
  for (std::size_t i = 0; i < count; ++i) {
    const hal::NextFrame next = camera.next(hal::kNoDeadline);
    const auto* frame = std::get_if<hal::CapturedFrame>(&next);
    ASSERT_NE(frame, nullptr);
    const auto image = std::make_shared<const hal::Image>(frame->image);
    const std::size_t number = frames.size();
    frames.push_back(
        {.image = image->view(),
         .sequence = 40 + number,
         .captureTime = hal::TimePoint(hal::Duration(33'333'333) * static_cast<int>(number)),
         .lease = image});
  }
}

constexpr int kTag = 0;  // hal::benchTags()

/// A model on a tag of the workbench.
scene::Scene boxOnTheBench() {
  scene::Scene scene;
  for (const hal::BenchTag& tag : hal::benchTags()) {
    scene.tags.push_back(
        {.id = tag.id, .edgeMetres = tag.edgeMetres, .worldFromTag = tag.worldFromTag});
  }
  const scene::BoxSource box{glm::dvec3(0.15)};
  scene.models.push_back(
      {.name = "box",
       .source = box,
       .model = std::make_shared<const scene::Model>(scene::modelOf(box).value()),
       .tagId = kTag,
       .srgb = {0.1F, 0.2F, 0.9F}});
  return scene;
}

/// The workbench from one side, then at once from farther away.
const std::vector<hal::CapturedFrame>& splicedFrames() {
  static const std::vector<hal::CapturedFrame> kFrames = [] {
    std::vector<hal::CapturedFrame> frames;
    film({.size = kFrame, .shot = hal::SyntheticShot::kWalkaround, .seed = 3}, kBefore, frames);
    film({.size = kFrame, .shot = hal::SyntheticShot::kVisitors, .seed = 3}, kAfter, frames);
    return frames;
  }();
  return kFrames;
}

struct LookCase {
  std::string style;
  std::string look;
};

std::vector<LookCase> allLooks() {
  std::vector<LookCase> looks;
  for (const char* const style : {"painterly", "watercolor", "hatching"}) {
    for (const styles::Look& look : styles::styleKind(style).looks) {
      looks.push_back({style, std::string(look.name)});
    }
  }
  return looks;
}

PaintParameters parametersOf(const LookCase& look) {
  return {.style = styles::styleKind(look.style).parametersOf(look.look), .view = {}};
}

class CutTest : public PainterTest, public testing::WithParamInterface<LookCase> {};
INSTANTIATE_TEST_SUITE_P(Looks, CutTest, testing::ValuesIn(allLooks()),
                         [](const auto& each) { return each.param.style + "_" + each.param.look; });

/// The frame of a cut, and those after it, are those of a run that begins there, to the bit.
TEST_P(CutTest, IsPaintedAsAFirstFrame) {
  const std::vector<hal::CapturedFrame>& frames = splicedFrames();
  ASSERT_EQ(frames.size(), kBefore + kAfter);
  const PaintParameters parameters = parametersOf(GetParam());
  Painter wentOn({.pictureSize = kFrame, .style = GetParam().style});
  Painter fresh({.pictureSize = kFrame, .style = GetParam().style});
  for (std::size_t i = 0; i < kBefore; ++i) painted(wentOn, frames[i], parameters);
  for (std::size_t i = kBefore; i < frames.size(); ++i) {
    EXPECT_EQ(painted(wentOn, frames[i], parameters), painted(fresh, frames[i], parameters)) << i;
  }
}

/// Control: without a cut, the past shows.
TEST_P(CutTest, NoCutIsNotPaintedAsAFirstFrame) {
  const std::vector<hal::CapturedFrame>& frames = splicedFrames();
  ASSERT_EQ(frames.size(), kBefore + kAfter);
  const PaintParameters parameters = parametersOf(GetParam());
  Painter wentOn({.pictureSize = kFrame, .style = GetParam().style});
  Painter fresh({.pictureSize = kFrame, .style = GetParam().style});
  for (std::size_t i = 0; i + 1 < kBefore; ++i) painted(wentOn, frames[i], parameters);
  EXPECT_NE(painted(wentOn, frames[kBefore - 1], parameters),
            painted(fresh, frames[kBefore - 1], parameters));
}

/// A cut from one side of the workbench to another, with the model's tag in sight before and after.
std::vector<hal::CapturedFrame> cutBesideTheTag() {
  // The shot cuts after two seconds.
  constexpr hal::Duration kTwoSeconds = std::chrono::seconds(2);
  std::vector<hal::CapturedFrame> frames;
  film({.size = {640, 480},
        .framePeriod = kTwoSeconds / kBefore,
        .shot = hal::SyntheticShot::kCut,
        .seed = 3},
       kBefore + kAfter, frames);
  return frames;
}

bool seesTag(const Picture& picture, int id) {
  return std::ranges::any_of(picture.tracking.tags, [id](const tracking::TrackedTag& tag) {
    return tag.id == id && tag.cameraFromTag && tag.source == tracking::PoseSource::kSeen;
  });
}

/// Neither a model's pose nor the light on it is held over a cut.
TEST_F(PainterTest, ModelsOfACutAreThoseOfAFirstFrame) {
  const std::vector<hal::CapturedFrame> frames = cutBesideTheTag();
  ASSERT_EQ(frames.size(), kBefore + kAfter);
  Painter wentOn({.pictureSize = kFrame, .scene = boxOnTheBench()});
  Painter fresh({.pictureSize = kFrame, .scene = boxOnTheBench()});
  const PaintParameters parameters = wentOn.defaultParameters();
  for (std::size_t i = 0; i < kBefore; ++i) {
    const auto picture = wentOn.paint(frames[i], parameters);
    ASSERT_TRUE(picture);
    EXPECT_TRUE(seesTag(*picture, kTag)) << i;
  }
  for (std::size_t i = kBefore; i < frames.size(); ++i) {
    const auto picture = wentOn.paint(frames[i], parameters);
    ASSERT_TRUE(picture);
    EXPECT_TRUE(seesTag(*picture, kTag)) << i;
    EXPECT_EQ(bytesOf(hal::orThrow(wentOn.snapshot())), painted(fresh, frames[i])) << i;
  }
}

}  // namespace
}  // namespace pleinair
