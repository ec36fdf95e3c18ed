// Faces are drawn by their features.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/tracking/faces/face_tracker.h"
#include "tests/gpu/hatching/hatching_fixture.h"
#include "tests/support/drawn_face.h"
#include "tests/support/face_likeness.h"

namespace pleinair::styles {
namespace {

class HatchFacesTest : public HatchingTest {
 protected:
  static constexpr hal::FrameSize kPicture{320, 240};

  /// Of a drawing of a standing camera's image, after so many frames.
  double likenessAfter(int frames, bool isFound) {
    restart();
    Hatching style(library_);
    const support::DrawnFace drawn{{150.0, 120.0}, 60.0, 0.4};
    const tracking::Face face{.centre = drawn.centre, .sidePx = drawn.side, .presence = 1.0};
    double like = 0.0;
    for (int i = 0; i < frames; ++i) {
      hal::Image image =
          support::drawnFaces(kPicture, std::array{drawn}, 1.0, 3U + static_cast<unsigned>(i));
      scene::ArFrame frame = next(image);
      motion_.isCut = i == 0;
      if (isFound) frame.measuredFaces = scene::MeasuredFaces{.faces = std::span(&face, 1)};
      const std::vector<std::uint8_t> painted = paint(style, frame);
      like = support::likeness(support::greyOf(image.plane(0)), support::greyOf(painted), kPicture,
                               drawn);
    }
    return like;
  }
};

TEST_F(HatchFacesTest, AFaceIsDrawnLikeItAtOnceAndForLong) {
  for (const int frames : {1, 12}) {
    const double found = likenessAfter(frames, true);
    const double missed = likenessAfter(frames, false);
    RecordProperty("after_" + std::to_string(frames),
                   std::to_string(found) + ", without " + std::to_string(missed));
    EXPECT_GT(found, 0.8) << frames;
    EXPECT_LT(missed, 0.75) << frames << ": the control";
  }
}

TEST_F(HatchFacesTest, WithoutTheParameterNobodyLooksForThem) {
  Hatching style(library_);
  EXPECT_TRUE(style.needs().faces);
  set(style, {{"faces", "0"}});
  EXPECT_FALSE(style.needs().faces);
}

}  // namespace
}  // namespace pleinair::styles
