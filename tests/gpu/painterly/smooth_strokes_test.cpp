// Strokes look the same wherever they lie between pixels; most of all those on models and movers.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/gpu/render_target.h"
#include "pipeline/styles/strokes/brushes.h"
#include "pipeline/styles/strokes/stroke_drawing.h"
#include "tests/gpu/painterly/strip_fixture.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kPictureSize{96, 96};
constexpr float kOfModel = 5.0F;  // a patch's label
constexpr float kOfMover = 4095.0F;
constexpr float kOfSegment = 4096.0F;  // the first of the camera image's

class SmoothStrokesTest : public StripTest {
 protected:
  /// A channel of parallel strokes of the oil look's finest layer, in two tones, some px apart and
  /// displaced by a part of a pixel. Alpha is what they cover.
  cv::Mat1f drawn(float label, glm::vec2 by, std::size_t channel = 0, float apartPixels = 2.0F) {
    std::vector<LaidStroke> strokes;
    for (int i = 0; static_cast<float>(i) * apartPixels < 80.0F; ++i) {
      const glm::vec2 from(8.0F + 7.0F * static_cast<float>(i % 5),
                           8.0F + apartPixels * static_cast<float>(i));
      LaidStroke stroke = straightStroke(from + by, from + by + glm::vec2(28.0F, 9.0F));
      stroke.halfWidth = 2.0F;
      stroke.variant = static_cast<float>(i % 8);
      stroke.paint = glm::vec4(glm::vec3(i % 2 == 0 ? 0.75F : 0.35F), 0.95F);
      stroke.label = label;
      strokes.push_back(stroke);
    }
    lay(strokes);
    const gpu::Texture colour(gpu::TextureFormat::kRgba8, kPictureSize);
    const gpu::Texture height(gpu::TextureFormat::kRgba8, kPictureSize);
    const gpu::RenderTarget target({&colour, &height});
    target.beginKeeping();
    glClearColor(0.5F, 0.5F, 0.5F, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    StrokeDrawing(library_).draw(strips_, makeBrush(Brush::kFlat, 8), {}, {}, kPictureSize,
                                 target);
    hal::Image image = support::readRgba8(colour);
    cv::Mat1f grey(kPictureSize.height, kPictureSize.width);
    for (int y = 0; y < kPictureSize.height; ++y) {
      const auto row = image.row(0, y);
      for (int x = 0; x < kPictureSize.width; ++x) {
        grey(y, x) = static_cast<float>(row[static_cast<std::size_t>(4 * x) + channel]);
      }
    }
    return grey;
  }

  /// The worst of some displacements: the mean square of what a picture is off from the one at
  /// whole pixels, moved there by cubic convolution, in parts of what is finer than 6 px in it.
  double worstChange(float label) {
    const cv::Mat1f still = drawn(label, {0, 0});
    cv::Mat1f coarse;
    cv::GaussianBlur(still, coarse, {}, 6.0);
    const cv::Rect inner(16, 16, 64, 64);
    cv::Mat1f fine;
    cv::subtract(still(inner), coarse(inner), fine);
    double worst = 0.0;
    for (const glm::vec2 by :
         {glm::vec2(0.5F, 0), glm::vec2(0, 0.5F), glm::vec2(0.5F, 0.5F), glm::vec2(0.25F, 0.75F)}) {
      const cv::Mat back = (cv::Mat_<float>(2, 3) << 1, 0, by.x, 0, 1, by.y);
      cv::Mat1f moved;
      cv::warpAffine(drawn(label, by), moved, back, still.size(),
                     cv::INTER_CUBIC | cv::WARP_INVERSE_MAP);
      cv::Mat1f off;
      cv::subtract(moved(inner), still(inner), off);
      worst = std::max(worst, off.dot(off) / fine.dot(fine));
    }
    return worst;
  }
};

TEST_F(SmoothStrokesTest, LookAlikeBetweenPixels) {
  const double onModel = worstChange(kOfModel);
  const double inImage = worstChange(0.0F);
  RecordProperty("on_model", std::to_string(onModel));
  RecordProperty("in_image", std::to_string(inImage));
  EXPECT_LT(inImage, 0.08) << "sides that are steps read 0.147";
  EXPECT_LT(onModel, 0.7 * inImage);
  EXPECT_EQ(worstChange(kOfMover), onModel);
  EXPECT_EQ(worstChange(kOfSegment), inImage);
}

TEST_F(SmoothStrokesTest, CoverTheirWidth) {
  constexpr std::size_t kAlpha = 3;
  constexpr float kApartPixels = 16;
  const double onModel = cv::sum(drawn(kOfModel, {0, 0}, kAlpha, kApartPixels))[0];
  const double inImage = cv::sum(drawn(0.0F, {0, 0}, kAlpha, kApartPixels))[0];
  EXPECT_NEAR(onModel / inImage, 1.0, 0.1);
}

}  // namespace
}  // namespace pleinair::styles
