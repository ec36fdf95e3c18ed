// The baselines of the thesis's report: fields of edges, and straight strokes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include "pipeline/measure/baselines/edge_tensors.h"
#include "pipeline/measure/baselines/straight_strokes.h"

namespace pleinair::measure {
namespace {

constexpr hal::FrameSize kSize{160, 120};

/// A bright disc on a dark ground.
hal::Image disc() {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kSize});
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const bool isIn = std::hypot(x - 80.0, y - 60.0) < 35.0;
      for (std::size_t c = 0; c < 3; ++c) {
        image.row(0, y)[3 * static_cast<std::size_t>(x) + c] =
            static_cast<std::uint8_t>(isIn ? 220 - 40 * c : 30 + 20 * c);
      }
    }
  }
  return image;
}

/// How far directions are from the disc's, near its rim: the gradient is radial. Degrees, median.
double fromRadial(const std::vector<glm::dvec2>& tensors) {
  const std::vector<glm::dvec2> middles = regionMiddles(kSize, 8);
  std::vector<double> apart;
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    const glm::dvec2 out = middles[i] - glm::dvec2(80.0, 60.0);
    if (std::abs(std::hypot(out.x, out.y) - 35.0) > 12.0) continue;
    const double theta = std::atan2(out.y, out.x);
    apart.push_back(angleBetween(tensors[i], {std::cos(2.0 * theta), std::sin(2.0 * theta)}) *
                    180.0 / std::numbers::pi);
  }
  EXPECT_GT(apart.size(), 30U);
  std::ranges::nth_element(apart, apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2));
  return apart[apart.size() / 2];
}

TEST(EdgeTensors, AllInterpolationsFollowTheRim) {
  const TensorImage gradients = gradientTensors(disc().view());
  const double threshold = edgePercentile(gradients, 0.995) / 3.0;
  const std::vector<glm::dvec2> middles = regionMiddles(kSize, 8);
  const auto tensors = radialBasisTensors(gradients, threshold, 8.0, RadialBasis::kEq12, middles);
  ASSERT_EQ(tensors.size(), 20U * 15U);
  EXPECT_LT(fromRadial(tensors), 6.0);
  EXPECT_EQ(tensors[40],
            radialBasisTensor(gradients, threshold, 8.0, RadialBasis::kEq12, middles[40]));
  EXPECT_LT(fromRadial(meanPyramidTensors(gradients, 8, threshold)), 12.0);
  EXPECT_GT(fromRadial(std::vector<glm::dvec2>(tensors.size(), {1.0, 0.0})), 30.0)
      << "the measure can fail";
}

TEST(EdgeTensors, TheMeanPyramidLeavesNoRegionWithout) {
  const TensorImage gradients = gradientTensors(disc().view());
  const double threshold = edgePercentile(gradients, 0.995) / 3.0;
  for (const glm::dvec2& each : meanPyramidTensors(gradients, 8, threshold)) {
    EXPECT_GT(std::hypot(each.x, each.y), 0.0);
  }
}

/// The mean difference of two pictures' bytes, levels.
double apart(const hal::Image& a, const hal::Image& b) {
  double sum = 0.0;
  const hal::ImageView first = a.view();
  const hal::ImageView second = b.view();
  for (int y = 0; y < kSize.height; ++y) {
    for (std::size_t i = 0; i < 3 * static_cast<std::size_t>(kSize.width); ++i) {
      sum += std::abs(int{first.row(0, y)[i]} - int{second.row(0, y)[i]});
    }
  }
  return sum / (3.0 * static_cast<double>(kSize.pixels()));
}

TEST(StraightStrokes, PaintTheImageAndAreClippedAtEdges) {
  const hal::Image image = disc();
  const StraightStrokePainting painted = paintWithStraightStrokes(image);
  EXPECT_GT(painted.strokes, 200U);
  EXPECT_GT(apart(painted.picture, image), 0.5) << "it is a painting";
  EXPECT_LT(apart(painted.picture, image), 20.0) << "of the image";
  EXPECT_EQ(apart(paintWithStraightStrokes(image).picture, painted.picture), 0.0);
  StraightStrokeOptions unclipped;
  unclipped.edgePart = 10.0;
  EXPECT_GT(apart(paintWithStraightStrokes(image, unclipped).picture, image),
            1.2 * apart(painted.picture, image));
}

}  // namespace
}  // namespace pleinair::measure
