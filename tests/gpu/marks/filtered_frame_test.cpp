// The steady picture against the oracle, and what it does where the past does not belong.
#include "pipeline/marks/filtered_frame.h"

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <random>

#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/oracles/filtered_frame_oracle.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

using oracles::FilteredFrameOracle;
using support::readRgba32f;
using support::textureOf;

constexpr hal::FrameSize kSize{69, 46};  // no multiple of a block
constexpr double kTimeConstant = 0.3;
constexpr double kNoise = 2.0;
const double kKept = std::exp(-0.04 / kTimeConstant);  // at 25 Hz

/// A scene seen `shift` px further, with noise of a seed of its own.
hal::Image seen(glm::dvec2 shift, unsigned seed, double sigma = kNoise,
                hal::FrameSize size = kSize) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, std::max(sigma, 1e-9));
  for (int y = 0; y < size.height; ++y) {
    auto* p = image.row(0, y).data();
    for (int x = 0; x < size.width; ++x, p += 4) {
      const double u = x + shift.x;
      const double v = y + shift.y;
      const bool disc = std::hypot(u - 30.0, v - 20.0) < 11.0;
      const double colour[3] = {disc ? 210.0 : 90.0 + 40.0 * std::sin(u * 0.3),
                                120.0 + 50.0 * std::sin(v * 0.4), disc ? 40.0 : 150.0};
      for (int c = 0; c < 3; ++c) {
        p[c] = static_cast<std::uint8_t>(std::clamp(colour[c] + noise(random) + 0.5, 0.0, 255.0));
      }
      p[3] = 255;
    }
  }
  return image;
}

class FilteredFrameTest : public support::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    library_.add(gpu::marksShaders());
    library_.add(gpu::sceneShaders());
    steady_ = std::make_unique<FilteredFrame>(library_);
    move({0.0, 0.0}, 0.01F);
  }

  /// The field that says that all has moved so.
  void move(glm::vec2 displacement, float error, float source = 5.0F) {
    constexpr hal::FrameSize kFields{(kSize.width + 7) / 8, (kSize.height + 7) / 8};
    backward_ = gpu::Texture(gpu::TextureFormat::kRgba16f, kFields, gpu::TextureFilter::kLinear);
    const gpu::RenderTarget target({&backward_});
    target.beginKeeping();
    target.clearColour(0, {displacement, error, source});
  }

  scene::ArFrame frameOf(const hal::Image& image, int number) {
    picture_ = textureOf(image.view());
    return {.colour = &picture_,
            .sequence = static_cast<std::uint64_t>(number),
            .captureTime = hal::TimePoint(std::chrono::milliseconds(40) * number)};
  }
  void take(const scene::ArFrame& frame, bool isCut = false, double timeConstant = kTimeConstant) {
    steady_->update(frame, {.backward = &backward_,
                            .isCut = isCut,
                            .timeConstantSeconds = timeConstant,
                            .noiseLevels = kNoise});
  }
  std::vector<float> picture() const { return readRgba32f(steady_->picture()); }

  /// Root mean square difference from the scene without noise, in 1/255.
  static double noiseOf(const std::vector<float>& found, const hal::Image& clean) {
    double sum = 0.0;
    for (std::size_t i = 0; i < found.size() / 4; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double d =
            255.0 * static_cast<double>(found[i * 4 + c]) - clean.view().planes[0].bytes[i * 4 + c];
        sum += d * d;
      }
    }
    return std::sqrt(sum / (static_cast<double>(found.size()) * 0.75));
  }
  void expectLike(const FilteredFrameOracle& oracle) const {
    const std::vector<float> found = picture();
    for (std::size_t i = 0; i < oracle.picture.size(); ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        const double wanted = oracle.picture[i][static_cast<glm::length_t>(c)];
        ASSERT_NEAR(static_cast<double>(found[i * 4 + c]), wanted, c < 3 ? 0.002 : 0.02)
            << i % kSize.width << "," << i / kSize.width << " channel " << c;
      }
    }
  }

  gpu::ShaderLibrary library_;
  gpu::Texture backward_;
  gpu::Texture picture_;
  std::unique_ptr<FilteredFrame> steady_;
};

TEST_F(FilteredFrameTest, IsTheOraclesUnderMotion) {
  for (const glm::dvec2 v : {glm::dvec2(0.0), {1.0, -2.0}, {-0.5, 0.25}, {3.375, 1.5}}) {
    SCOPED_TRACE(testing::Message() << v.x << "," << v.y);
    steady_->reset();
    FilteredFrameOracle oracle;
    move(glm::vec2(v), 1.0F);
    for (int i = 0; i < 6; ++i) {
      const hal::Image image = seen(-v * double(i), static_cast<unsigned>(i));
      take(frameOf(image, i));
      oracle.take(
          image.view(), [&](glm::ivec2) { return glm::dvec3(v, 1.0); }, i == 0 ? 0.0 : kKept,
          kNoise / 255.0);
      expectLike(oracle);
    }
  }
}

TEST_F(FilteredFrameTest, TakesTheNoiseOutAndKeepsTheScene) {
  for (const glm::dvec2 v : {glm::dvec2(0.0), {-1.5, -0.5}}) {
    steady_->reset();
    move(glm::vec2(v), 0.02F);
    hal::Image last;
    for (int i = 0; i < 30; ++i) {
      last = seen(-v * double(i), static_cast<unsigned>(i));
      take(frameOf(last, i));
    }
    const hal::Image clean = seen(-v * 29.0, 0, 0.0);
    const std::vector<float> averaged = picture();
    steady_->reset();
    take(frameOf(last, 30));
    const double before = noiseOf(picture(), clean);
    EXPECT_LT(noiseOf(averaged, clean), (v == glm::dvec2(0.0) ? 0.4 : 0.65) * before);
  }
}

/// That nothing of the past is in the picture of `image`.
#define EXPECT_FRESH(image) EXPECT_LT(noiseOf(picture(), image), 0.1)

TEST_F(FilteredFrameTest, PastThatDoesNotBelongIsLeftOut) {
  const hal::Image one = seen({0.0, 0.0}, 1);
  const hal::Image other = seen({0.0, 0.0}, 2);
  const auto begin = [&] {
    move({0.0F, 0.0F}, 0.01F);
    for (int i = 0; i < 3; ++i) take(frameOf(one, i));
    EXPECT_GT(picture()[3], 2.0F);
  };
  begin();
  take(frameOf(other, 3));
  EXPECT_GT(noiseOf(picture(), other), 1.0) << "it is to count while it belongs";
  begin();
  take(frameOf(other, 3), true);
  EXPECT_FRESH(other) << "a cut";
  begin();
  move({0.0F, 0.0F}, 50.0F);
  take(frameOf(other, 3));
  EXPECT_FRESH(other) << "its place is not known";
  begin();
  move({0.0F, 0.0F}, 0.0F, 0.0F);
  take(frameOf(other, 3));
  EXPECT_FRESH(other) << "no source";
  begin();
  move({500.0F, 0.0F}, 0.01F);
  take(frameOf(other, 3));
  EXPECT_FRESH(other) << "it was outside";
  begin();
  steady_->reset();
  take(frameOf(other, 3));
  EXPECT_FRESH(other) << "reset";
  begin();
  take(frameOf(other, 3), false, 0.0);
  EXPECT_FRESH(other) << "no time constant";
}

// A change without motion appears at once, unless it could be noise.
TEST_F(FilteredFrameTest, LeavesNoGhosts) {
  for (int i = 0; i < 20; ++i) take(frameOf(seen({0.0, 0.0}, static_cast<unsigned>(i)), i));
  const hal::Image gone = seen({-400.0, 0.0}, 77);  // the disc is not in the picture any more
  take(frameOf(gone, 20));
  const std::vector<float> found = picture();
  for (std::size_t i = 0; i < found.size() / 4; ++i) {
    const double wrong =
        255.0 * static_cast<double>(found[i * 4 + 2]) - gone.view().planes[0].bytes[i * 4 + 2];
    ASSERT_LT(std::abs(wrong), 12.0) << i % kSize.width << "," << i / kSize.width;
  }
}

// Objects have their own motion, and a past that is not the camera's picture's.
TEST_F(FilteredFrameTest, ObjectsGoTheirOwnWay) {
  constexpr int kBorder = 32;
  gpu::Texture ids(gpu::TextureFormat::kR32ui, kSize);
  std::vector<std::uint32_t> words(static_cast<std::size_t>(kSize.pixels()));
  const auto lay = [&](int border) {
    for (std::size_t i = 0; i < words.size(); ++i) {
      words[i] = static_cast<int>(i) % kSize.width < border ? 1U << scene::kTriangleBits : 0U;
    }
    ids.upload({reinterpret_cast<const std::uint8_t*>(words.data()), words.size() * 4},
               std::size_t{kSize.width} * 4);
  };
  gpu::Texture motion(gpu::TextureFormat::kRgba16f, kSize);
  const gpu::RenderTarget target({&motion});
  target.beginKeeping();
  target.clearColour(0, {2.0F, 0.0F, 0.0F, 1.0F});  // the object moves by 2 px, the picture rests
  for (int i = 0; i < 5; ++i) {
    // Left of the border what the scene shows moves by 2 px a frame.
    hal::Image image = seen({0.0, 0.0}, static_cast<unsigned>(i));
    const hal::Image moving = seen({-2.0 * i, 0.0}, static_cast<unsigned>(i));
    for (int y = 0; y < kSize.height; ++y) {
      std::copy_n(moving.view().row(0, y).begin(), kBorder * 4, image.row(0, y).begin());
    }
    lay(i < 4 ? kBorder : kBorder + 8);
    scene::ArFrame frame = frameOf(image, i);
    frame.hasObjects = true;
    frame.ids = &ids;
    frame.motion = scene::SurfaceMotion{.texture = &motion};
    take(frame);
  }
  const std::vector<float> found = picture();
  const auto framesAt = [&](int x) {
    return found[static_cast<std::size_t>((20 * kSize.width + x) * 4 + 3)];
  };
  EXPECT_LT(framesAt(20), -3.5F) << "the object's past is its own, four frames long";
  EXPECT_FLOAT_EQ(framesAt(kBorder + 4), -1.0F) << "the camera's picture was there";
  EXPECT_GT(framesAt(60), 3.5F);
  const hal::Image clean = seen({-8.0, 0.0}, 0, 0.0);
  double wrong = 0.0;
  for (int x = 12; x < 28; ++x) {
    const auto at = static_cast<std::size_t>((30 * kSize.width + x) * 4);
    wrong += std::abs(255.0 * static_cast<double>(found[at + 1]) -
                      clean.view().planes[0].bytes[at + 1]) /
             16.0;
  }
  EXPECT_LT(wrong, 1.5) << "and not smeared";
}

// Its past has not the detail: it would be a blur, or a picture of other pixels.
TEST_F(FilteredFrameTest, AnotherLevelOfQualityBeginsAnew) {
  constexpr hal::FrameSize kSmaller{40, 28};
  for (int i = 0; i < 4; ++i) take(frameOf(seen({0.0, 0.0}, static_cast<unsigned>(i)), i));
  const hal::Image small = seen({0.0, 0.0}, 4, kNoise, kSmaller);
  scene::ArFrame frame = frameOf(small, 4);
  frame.fullSize = kSize;
  take(frame);
  EXPECT_EQ(steady_->picture().size(), kSmaller);
  EXPECT_FRESH(small);
  const hal::Image back = seen({0.0, 0.0}, 5);
  take(frameOf(back, 5));
  EXPECT_EQ(steady_->picture().size(), kSize);
  EXPECT_FRESH(back);
}

}  // namespace
}  // namespace pleinair::marks
