// The tensor field: each step against the thesis's text on the CPU.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/tensors/segment_map.h"
#include "tests/gpu/marks/tensor_field_fixture.h"
#include "tests/oracles/tensor_oracle.h"

namespace pleinair::marks {
namespace {

using oracles::Decision;
using oracles::TensorGrid;
using support::textureOf;

constexpr int kRegionPixels = 8;
constexpr double kHalf = 1.0 / 2048.0;  // what a half-precision number is rounded to, of itself
const glm::dvec2 kNothingAnywhere(-0.94, -0.342);

class TensorFieldTest : public TensorFieldFixture {
 protected:
  /// The greatest error of gradient.frag, of what is allowed.
  double worstGradient(const hal::Image& image, const oracles::TensorImage& expected) {
    const gpu::Texture picture = textureOf(image.view());
    const gpu::Texture noIds(gpu::TextureFormat::kR32ui, {1, 1});
    gpu::Texture made(gpu::TextureFormat::kRg16f, kSize);
    const gpu::RenderTarget target({&made});
    gpu::Program pass = library_.fragmentPass("pipeline/marks/tensors/shaders/gradient.frag");
    pass.use()
        .texture("picture", picture)
        .texture("ids", noIds)
        .set("hasObjects", 0)
        .drawFullscreen(target);
    const std::vector<float> values = support::readRgba32f(made);
    double worst = 0.0;
    for (std::size_t i = 0; i < expected.tensors.size(); ++i) {
      const glm::dvec2 is(values[4 * i], values[4 * i + 1]);
      const glm::dvec2 should = expected.tensors[i];
      // Half precision, cut off or rounded; and float's sums of eight bytes.
      const double allowed = 2.0 * kHalf * glm::length(should) + 1e-5;
      worst = std::max(worst, glm::distance(is, should) / allowed);
    }
    return worst;
  }

  /// The GPU's threshold: it shows in `detail`, which is the mean P by it.
  double thresholdOf(const oracles::TensorImage& gradients) const {
    const TensorGrid asOne =
        oracles::tensorRegions(gradients, kRegionPixels, 1.0, Decision::kGradual);
    const std::vector<FieldTexel> regions = read(field_->regions());
    double sum = 0.0;
    double of = 0.0;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      sum += asOne.regions[i].detail;
      of += regions[i].detail;
    }
    return sum / of;
  }
};

TEST_F(TensorFieldTest, GradientsAreTheThesiss) {
  const hal::Image image = greyPicture(kSize, variedLuma, 6.0);
  EXPECT_LT(worstGradient(image, oracles::gradientTensors(image.view())), 1.0);
}

TEST_F(TensorFieldTest, GradientsAreOfColoursToo) {
  hal::Image image = greyPicture(kSize, variedLuma, 6.0, 1);
  hal::Image green = greyPicture(
      kSize,
      [](glm::dvec2 px) {
        return variedLuma({256.0 - px.x, px.y});
      },
      6.0, 2);
  hal::Image blue = greyPicture(
      kSize,
      [](glm::dvec2 px) {
        return variedLuma({px.x, 128.0 - px.y});
      },
      6.0, 3);
  for (int y = 0; y < kSize.height; ++y) {
    const auto row = image.row(0, y);
    for (std::size_t i = 0; i < row.size(); i += 4) {
      row[i + 1] = green.row(0, y)[i];
      row[i + 2] = blue.row(0, y)[i];
    }
  }
  EXPECT_LT(worstGradient(image, oracles::colourTensors(image.view())), 1.0);
  EXPECT_GT(worstGradient(image, oracles::gradientTensors(image.view())), 10.0) << "luma alone";
}

/// Two colours of one luma side by side, and on the left what is strong.
TEST_F(TensorFieldTest, AnEdgeBetweenColoursOfOneLumaLeadsStrokes) {
  hal::Image image = greyPicture(kSize, [](glm::dvec2 px) {
    return px.x < 128.0 ? 0.5 + 0.45 * std::sin(0.4 * px.y) : 150.0 / 255.0;
  });
  constexpr std::array<std::uint8_t, 3> kOther{180, 150, 71};  // luma 150
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 204; x < kSize.width; ++x) {
      std::ranges::copy(kOther, image.row(0, y).data() + static_cast<std::ptrdiff_t>(4) * x);
    }
  }
  update(image, standing(), kNoMemory);
  const auto at = placeOf(25, 8);  // px 200 to 208
  const FieldTexel coloured = read(field_->regions())[at];
  EXPECT_GT(coloured.known, 0.95);
  EXPECT_GT(coloured.tensor.x, 0.95) << "the gradient is level";
  const TensorGrid byLuma = oracles::tensorRegions(oracles::gradientTensors(image.view()),
                                                   kRegionPixels, kMaxLeading, Decision::kGradual);
  EXPECT_EQ(byLuma.regions[at].known, 0.0) << "the control: luma alone";
}

/// Black and white beside a step of luma by 0.07, P of 0.28: a third of the strongest is 1.3.
TEST_F(TensorFieldTest, AWeakEdgeLeadsStrokesHoweverStrongOthersAre) {
  const hal::Image image = greyPicture(kSize, [](glm::dvec2 px) {
    if (px.x < 128.0) return std::fmod(px.y, 16.0) < 8.0 ? 0.02 : 0.98;
    return px.x < 204.0 ? 0.5 : 0.57;
  });
  update(image, standing(), kNoMemory);
  const auto at = placeOf(25, 8);  // px 200 to 208
  const FieldTexel weak = read(field_->regions())[at];
  EXPECT_GT(weak.known, 0.9);
  EXPECT_GT(weak.tensor.x, 0.95);
  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  const TensorGrid thesiss =
      oracles::tensorRegions(gradients, kRegionPixels,
                             oracles::edgePercentile(gradients, 0.995) / 3.0, Decision::kGradual);
  EXPECT_EQ(thesiss.regions[at].known, 0.0) << "the control: the thesis's threshold";
  EXPECT_GT(weak.detail, 2.0 * thesiss.regions[at].detail);
  TensorFieldOptions less = kNoMemory;
  less.maxLeading = kMaxDetailUnit;
  update(image, standing(), less);
  EXPECT_LT(read(field_->regions())[at].known, 0.1) << "the limit is the caller's";
}

TEST_F(TensorFieldTest, TheThresholdIsAThirdOfThePercentile) {
  for (const double contrast : {0.3, 1.0}) {
    const auto luma = [&](glm::dvec2 px) { return contrast * variedLuma(px); };
    const hal::Image image = greyPicture(kSize, luma, 3.0);
    update(image, standing(), kNoMemory);
    const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
    const double percentile = oracles::edgePercentile(gradients, 0.995);
    // From 128 bins, as wide as their root, and every fourth pixel.
    const double binWidth = 2.0 * std::sqrt(percentile * 5.7) / 128.0;
    EXPECT_NEAR(3.0 * thresholdOf(gradients), percentile, 2.0 * binWidth) << contrast;
  }
  const hal::Image strong =
      greyPicture(kSize, [](glm::dvec2 px) { return std::fmod(px.y, 16.0) < 8.0 ? 0.02 : 0.98; });
  update(strong, standing(), kNoMemory);
  EXPECT_NEAR(thresholdOf(oracles::gradientTensors(strong.view())), kMaxDetailUnit, 0.005);
}

TEST_F(TensorFieldTest, OneHotPixelDoesNotMoveTheThreshold) {
  hal::Image image = greyPicture(kSize, [](glm::dvec2 px) { return 0.3 * variedLuma(px); });
  update(image, standing(), kNoMemory);
  const double before = thresholdOf(oracles::gradientTensors(image.view()));
  std::fill_n(image.row(0, 100).data() + 400, 3, std::uint8_t{255});
  update(image, standing(), kNoMemory);
  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  EXPECT_GT(oracles::edgePercentile(gradients, 1.0) / 3.0, 2.0 * before) << "the thesis's moves";
  EXPECT_NEAR(thresholdOf(gradients), before, 0.03 * before);
}

TEST_F(TensorFieldTest, EachStepIsTheOracles) {
  const hal::Image image = greyPicture(kSize, variedLuma, 2.0);
  update(image, standing(), kNoMemory);
  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  const TensorGrid expected = oracles::tensorRegions(
      gradients, kRegionPixels, thresholdOf(gradients), Decision::kGradual, kMaxLeading);
  const auto pyramid = oracles::tensorPyramid(expected, 1.0, Decision::kGradual);
  ASSERT_EQ(pyramid.size(), field_->levelCount());
  const auto compare = [](const std::vector<FieldTexel>& is, const TensorGrid& should,
                          double tolerance) {
    ASSERT_EQ(is.size(), should.regions.size());
    for (std::size_t i = 0; i < is.size(); ++i) {
      const oracles::TensorRegion& each = should.regions[i];
      EXPECT_NEAR(is[i].known, each.known, tolerance) << i;
      EXPECT_NEAR(is[i].detail, each.detail, tolerance * (1.0 + each.detail)) << i;
      // A tensor that is hardly there says little.
      EXPECT_LT(glm::distance(is[i].tensor, each.tensor) * std::min(1.0, 10.0 * each.known),
                tolerance)
          << i;
    }
  };
  compare(read(field_->regions()), expected, 0.004);
  for (std::size_t level = 0; level < pyramid.size(); ++level) {
    SCOPED_TRACE(level);
    EXPECT_EQ(field_->filled(level).size(), pyramid[level].size);
    compare(read(field_->filled(level)), pyramid[level], 0.006);
    const std::vector<FieldTexel> resolved = read(field_->resolved(level));
    const hal::FrameSize size = pyramid[level].size;
    for (int i = 0; i < static_cast<int>(resolved.size()); ++i) {
      const glm::ivec2 region(i % size.width, i / size.width);
      const glm::dvec2 tensor = oracles::lookedUp(pyramid, level, region, Decision::kGradual);
      EXPECT_LT(glm::distance(resolved[static_cast<std::size_t>(i)].tensor, tensor), 0.03)
          << region.x << "," << region.y;
    }
  }
}

/// Gradual decisions change little of what the thesis's text gives where it is sure.
TEST_F(TensorFieldTest, DirectionsAreThoseOfTheThesissText) {
  const hal::Image image = greyPicture(kSize, variedLuma, 2.0);
  update(image, standing(), kNoMemory);
  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  const auto pyramid = oracles::tensorPyramid(
      oracles::tensorRegions(gradients, kRegionPixels, thresholdOf(gradients), Decision::kThesis,
                             kMaxLeading),
      1.0, Decision::kThesis);
  const std::vector<FieldTexel> resolved = read(field_->resolved(0));
  std::vector<double> apart;
  for (int i = 0; i < static_cast<int>(resolved.size()); ++i) {
    const glm::ivec2 region(i % 32, i / 32);
    const glm::dvec2 tensor = oracles::lookedUp(pyramid, 0, region, Decision::kThesis);
    if (glm::length(tensor) < 0.3) continue;
    apart.push_back(
        degrees(oracles::angleBetween(tensor, resolved[static_cast<std::size_t>(i)].tensor)));
  }
  ASSERT_GT(apart.size(), 350U);
  std::ranges::sort(apart);
  RecordProperty("median_degrees", std::to_string(apart[apart.size() / 2]));
  EXPECT_LT(apart[apart.size() / 2], 3.0);
  EXPECT_LT(apart[apart.size() * 9 / 10], 15.0);
}

/// A pyramid whose levels do not lie over each other would lean to one side.
TEST_F(TensorFieldTest, TheFieldOfAMirroredPictureIsMirrored) {
  const auto sparse = [](glm::dvec2 px) {
    return std::hypot(px.x - 40.0, px.y - 90.0) < 14.0 ? 0.9 : (px.x + px.y < 30.0 ? 0.1 : 0.5);
  };
  update(greyPicture(kSize, sparse), standing(), kNoMemory);
  std::vector<std::vector<FieldTexel>> levels;
  for (std::size_t i = 0; i < field_->levelCount(); ++i) levels.push_back(read(field_->filled(i)));
  const std::vector<FieldTexel> regions = read(field_->regions());
  update(greyPicture(kSize,
                     [&](glm::dvec2 px) {
                       return sparse({256.0 - px.x, 128.0 - px.y});
                     }),
         standing(), kNoMemory);
  // Turned by half a turn, directions stay.
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const std::vector<FieldTexel> turned = read(field_->filled(level));
    for (std::size_t i = 0; i < turned.size(); ++i) {
      const FieldTexel& was = levels[level][turned.size() - 1 - i];
      EXPECT_NEAR(turned[i].known, was.known, 0.005) << level << ": " << i;
      EXPECT_LT(glm::distance(turned[i].tensor, was.tensor) * was.known, 0.005)
          << level << ": " << i;
    }
  }
}

TEST_F(TensorFieldTest, ABlankFrameHasTheDefaultDirection) {
  update(greyPicture(kSize, [](glm::dvec2) { return 0.5; }));
  for (std::size_t level = 0; level < field_->levelCount(); ++level) {
    for (const FieldTexel& each : read(field_->resolved(level))) {
      EXPECT_LT(glm::distance(each.tensor, kNothingAnywhere), 0.002);
      EXPECT_EQ(each.known, 0.0);
    }
  }
}

TEST_F(TensorFieldTest, TensorsThatCancelHaveTheDefaultDirection) {
  // As much upright as level everywhere: a region's tensors sum to nothing.
  const auto chequered = [](glm::dvec2 px) {
    return (static_cast<int>(px.x / 4.0) + static_cast<int>(px.y / 4.0)) % 2 == 0 ? 0.8 : 0.2;
  };
  update(greyPicture(kSize, chequered), standing(), kNoMemory);
  const std::vector<FieldTexel> resolved = read(field_->resolved(0));
  const std::vector<FieldTexel> regions = read(field_->regions());
  double worst = 0.0;
  for (int y = 1; y < 15; ++y) {
    for (int x = 1; x < 31; ++x) {
      const auto i = placeOf(x, y);
      EXPECT_EQ(regions[i].known, 1.0);
      EXPECT_LT(glm::length(regions[i].tensor), 0.02);
      worst = std::max(worst, degrees(oracles::angleBetween(resolved[i].tensor, kNothingAnywhere)));
    }
  }
  // The border's own edges, which do not cancel, reach in a little by the coarsest levels.
  EXPECT_LT(worst, 8.0);
}

TEST_F(TensorFieldTest, StrokesFollowRoundShapes) {
  // Rings: the truth is known everywhere.
  const glm::dvec2 middle(128.0, 64.0);
  update(greyPicture(
             kSize,
             [&](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.35 * glm::distance(px, middle)); }),
         standing(), kNoMemory);
  const std::vector<FieldTexel> resolved = read(field_->resolved(0));
  double worst = 0.0;
  for (int i = 0; i < static_cast<int>(resolved.size()); ++i) {
    const glm::dvec2 out = 8.0 * (glm::dvec2(i % 32, i / 32) + 0.5) - middle;
    if (glm::length(out) < 24.0) continue;
    const double theta = std::atan2(out.y, out.x);
    worst = std::max(worst, oracles::angleBetween(resolved[static_cast<std::size_t>(i)].tensor,
                                                  {std::cos(2 * theta), std::sin(2 * theta)}));
  }
  EXPECT_LT(degrees(worst), 4.0);
}

TEST_F(TensorFieldTest, ASmallerVersionHasTheSameField) {
  const hal::Image image = greyPicture(kSize, variedLuma);
  update(image, standing(), kNoMemory);
  const std::vector<FieldTexel> whole = read(field_->resolved(0));
  const hal::FrameSize half{kSize.width / 2, kSize.height / 2};
  const hal::Image smaller = greyPicture(half, [](glm::dvec2 px) { return variedLuma(2.0 * px); });
  const gpu::Texture texture = textureOf(smaller.view());
  scene::ArFrame frame = frameOf(texture);
  motion_.frameSize = kSize;
  frame.fullSize = kSize;
  motionField_->update(frame);
  field_->update(frame, texture, *motionField_, kNoMemory);
  const std::vector<FieldTexel> less = read(field_->resolved(0));
  ASSERT_EQ(less.size(), whole.size());
  std::vector<double> apart;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    apart.push_back(degrees(oracles::angleBetween(whole[i].tensor, less[i].tensor)));
  }
  std::ranges::sort(apart);
  EXPECT_LT(apart[apart.size() / 2], 5.0);
}

/// The pyramid gives about what the global interpolation gives, which asks every edge pixel.
TEST_F(TensorFieldTest, GoesWithTheGlobalInterpolation) {
  const auto shapes = [](glm::dvec2 px) {
    return std::hypot(px.x - 128.0, px.y - 64.0) < 38.0 ? 0.8 : 0.3;
  };
  const hal::Image image = greyPicture(kSize, shapes);
  update(image, standing(), kNoMemory);
  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  const double threshold = thresholdOf(gradients);
  const std::vector<FieldTexel> resolved = read(field_->resolved(0));
  std::vector<double> apart;
  for (int i = 0; i < static_cast<int>(resolved.size()); i += 7) {
    const glm::dvec2 px = 8.0 * (glm::dvec2(i % 32, i / 32) + 0.5);
    // Far from the rim, and at its middle, neither has much to say.
    const double fromRim = std::abs(glm::distance(px, {128.0, 64.0}) - 38.0);
    if (fromRim > 28.0) continue;
    apart.push_back(degrees(oracles::angleBetween(
        resolved[static_cast<std::size_t>(i)].tensor,
        oracles::radialBasisTensor(gradients, threshold, 8.0, oracles::RadialBasis::kEq12, px))));
  }
  ASSERT_GT(apart.size(), 20U);
  std::ranges::sort(apart);
  EXPECT_LT(apart[apart.size() / 2], 8.0);
}

/// Upright stripes on the left; on the right, two segments without edges, of which the left one
/// belongs to the stripes: only that has their direction, the other that of the level lines below.
TEST_F(TensorFieldTest, DirectionsDoNotSpreadFromOneSegmentToAnother) {
  constexpr double kStripes = 96.0;
  constexpr double kBorder = 108.0;
  const auto luma = [](glm::dvec2 px) {
    if (px.x < kStripes) return 0.5 + 0.3 * std::sin(0.9 * px.x);
    return px.y > 88.0 ? 0.5 + 0.3 * std::sin(0.9 * px.y) : 0.5;
  };
  const hal::Image image = greyPicture(kSize, luma);
  const gpu::Texture texture = textureOf(image.view());
  constexpr hal::FrameSize kGrid{64, 32};
  std::vector<tracking::SegmentCell> cells;
  for (int i = 0; i < kGrid.width * kGrid.height; ++i) {
    const bool isLeft = 4.0 * (i % kGrid.width) < kBorder;
    cells.push_back({.label = static_cast<std::uint16_t>(isLeft ? 1 : 2)});
  }
  const tracking::ImageSegments segments{.frameSize = kSize, .grid = kGrid, .cells = cells};
  const auto directionBeyondTheBorder = [&](bool isSegmented) {
    field_.emplace(library_, kSize);
    scene::ArFrame frame = frameOf(texture);
    if (isSegmented) frame.measuredSegments = scene::MeasuredSegments{.segments = &segments};
    SegmentMap map;
    map.update(frame);
    motionField_->update(frame);
    field_->update(frame, texture, *motionField_, kNoMemory, nullptr, &map);
    // The gradient of stripes is level: its tensor is (1, 0); that of level lines is (-1, 0).
    return read(field_->resolved(0))[placeOf(13, 9)].tensor;  // px 104 to 112, 72 to 80
  };
  EXPECT_LT(directionBeyondTheBorder(true).x, -0.5);
  EXPECT_GT(directionBeyondTheBorder(false).x, 0.0) << "the control: without segments";
}

TEST(TensorOracle, RadialBasisFormsDifferByTheWeights) {
  // One edge, upright, 20 px from where it is asked.
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {64, 9}});
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 64; ++x) {
      std::fill_n(image.row(0, y).data() + static_cast<std::ptrdiff_t>(x) * 4, 4,
                  static_cast<std::uint8_t>(x < 32 ? 0 : 255));
    }
  }
  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  using oracles::RadialBasis;
  const glm::dvec2 at(12.0, 4.5);
  const auto tensorOf = [&](RadialBasis form, double sigma) {
    return oracles::radialBasisTensor(gradients, 1.0, sigma, form, at);
  };
  // P is 4 at every edge pixel, the gradient level: normalised, that comes back whatever σ is.
  EXPECT_NEAR(tensorOf(RadialBasis::kEq12, 2.0).x, 4.0, 1e-9);
  EXPECT_NEAR(tensorOf(RadialBasis::kEq12, 50.0).x, 4.0, 1e-9);
  // Eq. 11 leaves a hole far from edges.
  EXPECT_LT(tensorOf(RadialBasis::kEq11, 2.0).x, 0.01);
  EXPECT_EQ(oracles::angleBetween({1, 0}, {-1, 0}), std::numbers::pi / 2.0);
}

}  // namespace
}  // namespace pleinair::marks
