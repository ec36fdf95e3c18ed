// Faces are painted with finer strokes: they are like the faces, wherever these go, and nothing
// else changes for it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/faces/face_tracker.h"
#include "tests/gpu/painterly/painterly_fixture.h"
#include "tests/support/drawn_face.h"
#include "tests/support/face_likeness.h"

namespace pleinair::styles {
namespace {

using support::DrawnFace;

class FacesTest : public PainterlyTest {
 protected:
  static constexpr hal::FrameSize kPicture{320, 240};
  static constexpr double kSide = 50.0;     // of a face that is some dozen strokes wide
  static constexpr double kContrast = 0.5;  // of its features, in soft light

  /// The next frame, with a face; `isFound`: by a tracker. The image has gone so far to the right.
  scene::ArFrame next(const DrawnFace& drawn, bool isFound, double goesPx = 0.0) {
    image_ = support::drawnFaces(kPicture, std::array{drawn}, 1.0,
                                 9U + static_cast<unsigned>(number_), drawn.centre.x);
    scene::ArFrame frame = PainterlyTest::next(image_, -goesPx);
    motion_.isCut = number_ == 1;
    motion_.noiseLevels = 1.0;
    face_ = {.centre = drawn.centre, .sidePx = drawn.side, .presence = 1.0};
    if (isFound) frame.measuredFaces = scene::MeasuredFaces{.faces = std::span(&face_, 1)};
    return frame;
  }

  double likenessAfter(int frames, bool isFound, double stepPx = 0.0) {
    restart();
    Painterly style(library_);
    DrawnFace drawn{{150.0, 120.0}, kSide, kContrast};
    double like = 0.0;
    for (int i = 0; i < frames; ++i) {
      const std::vector<std::uint8_t> painted =
          paint(style, next(drawn, isFound, i > 0 ? stepPx : 0.0));
      like = support::likeness(support::greyOf(image_.plane(0)), support::greyOf(painted), kPicture,
                               drawn);
      drawn.centre.x += stepPx;
    }
    return like;
  }

  hal::Image image_;
  tracking::Face face_;
};

TEST_F(FacesTest, AFaceIsPaintedLikeItAtOnceAndForLong) {
  for (const int frames : {1, 20}) {
    const double found = likenessAfter(frames, true);
    const double missed = likenessAfter(frames, false);
    RecordProperty("after_" + std::to_string(frames),
                   std::to_string(found) + ", without " + std::to_string(missed));
    EXPECT_GT(found, 0.93) << frames;
    EXPECT_LT(missed, 0.9) << frames << ": the control";
  }
}

TEST_F(FacesTest, AFaceInAPanIsPaintedLikeIt) {
  const double found = likenessAfter(12, true, 2.0);
  EXPECT_GT(found, 0.8);
  EXPECT_GT(found, likenessAfter(12, false, 2.0) + 0.03) << "the control";
}

TEST_F(FacesTest, AFaceThatIsFoundChangesNothingElse) {
  const DrawnFace drawn{{110.0, 120.0}, 50.0};
  constexpr int kBefore = 4;
  std::array<std::vector<std::uint8_t>, 2> pictures;
  for (const bool isFound : {false, true}) {
    restart();
    Painterly style(library_);
    for (int i = 0; i < kBefore + 10; ++i) {
      pictures.at(isFound ? 1 : 0) = paint(style, next(drawn, isFound && i >= kBefore));
    }
  }
  int inside = 0;
  int outside = 0;
  for (int y = 0; y < kPicture.height; ++y) {
    for (int x = 0; x < kPicture.width; ++x) {
      const std::size_t at = std::size_t{4} * static_cast<std::size_t>(y * kPicture.width + x);
      bool isSame = true;
      for (std::size_t c = 0; c < 3; ++c)
        isSame = isSame && pictures[0][at + c] == pictures[1][at + c];
      const double sides = glm::length(glm::dvec2(x, y) - drawn.centre) / drawn.side;
      if (sides < 0.5 && !isSame) ++inside;
      if (sides > 1.6 && !isSame) ++outside;
    }
  }
  EXPECT_GT(inside, 1000) << "the control";
  EXPECT_EQ(outside, 0);
}

TEST_F(FacesTest, WithoutTheParameterNobodyLooksForThem) {
  Painterly style(library_);
  EXPECT_TRUE(style.needs().faces);
  style.setParameters(style.parameters().with("faces", "0"));
  EXPECT_FALSE(style.needs().faces);
}

}  // namespace
}  // namespace pleinair::styles
