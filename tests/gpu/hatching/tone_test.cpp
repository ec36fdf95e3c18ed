// The tone of a drawing: smoothed as by a viewer from afar, it is that of the image, up to the best
// curve (docs/measured.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "tests/golden/still_life.h"
#include "tests/gpu/hatching/hatching_fixture.h"

namespace pleinair::styles {
namespace {

/// Luma in [0, 1], smoothed by a Gaussian; beyond the border its own pixels again.
std::vector<double> smoothLuma(const hal::Image& image, double sigma) {
  const int width = image.size().width;
  const int height = image.size().height;
  std::vector<double> luma;
  for (int y = 0; y < height; ++y) {
    const auto* p = image.view().row(0, y).data();
    for (int x = 0; x < width; ++x, p += 4) {
      luma.push_back((0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]) / 255.0);
    }
  }
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  const auto along = [&](const std::vector<double>& from, int dx, int dy) {
    std::vector<double> to(from.size());
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = 0.0;
        double weights = 0.0;
        for (int i = -reach; i <= reach; ++i) {
          const int u = std::clamp(x + i * dx, 0, width - 1);
          const int v = std::clamp(y + i * dy, 0, height - 1);
          const double weight = std::exp(-0.5 * i * i / (sigma * sigma));
          sum += weight * from[static_cast<std::size_t>(v * width + u)];
          weights += weight;
        }
        to[static_cast<std::size_t>(y * width + x)] = sum / weights;
      }
    }
    return to;
  };
  return along(along(luma, 1, 0), 0, 1);
}

/// The mean difference between the drawing and the best monotone curve of the image: isotonic
/// regression over 64 steps of the image's tone (pool adjacent violators).
double toneError(const std::vector<double>& image, const std::vector<double>& drawing) {
  struct Pool {
    double sum = 0.0;
    double count = 0.0;
    int last = 0;
    double mean() const { return sum / count; }
  };
  constexpr int kSteps = 64;
  std::array<Pool, kSteps> steps{};
  const auto stepOf = [](double luma) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(luma * kSteps), 0, kSteps - 1));
  };
  for (std::size_t i = 0; i < image.size(); ++i) {
    steps.at(stepOf(image[i])).sum += drawing[i];
    steps.at(stepOf(image[i])).count += 1.0;
  }
  std::vector<Pool> pools;
  for (int i = 0; i < kSteps; ++i) {
    Pool pool = steps.at(static_cast<std::size_t>(i));
    if (pool.count == 0.0) continue;
    pool.last = i;
    while (!pools.empty() && pools.back().mean() > pool.mean()) {
      pool.sum += pools.back().sum;
      pool.count += pools.back().count;
      pools.pop_back();
    }
    pools.push_back(pool);
  }
  double error = 0.0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto step = static_cast<int>(stepOf(image[i]));
    const auto pool = std::ranges::find_if(pools, [&](const Pool& p) { return p.last >= step; });
    error += std::abs(drawing[i] - pool->mean());
  }
  return error / static_cast<double>(image.size());
}

class HatchTone : public HatchingTest, public testing::WithParamInterface<std::string_view> {
 protected:
  hal::Image drawn(const hal::Image& image) {
    Hatching style(library_);
    style.setParameters(style.kind().parametersOf(GetParam()));
    restart();
    hal::Image picture;
    for (int i = 0; i < 3; ++i) picture = support::readRgba8(style.paint(next(image), {}));
    return picture;
  }
};
INSTANTIATE_TEST_SUITE_P(Looks, HatchTone,
                         testing::Values("pen", "pencil", "engraving", "blueprint", "chalk",
                                         "crayon"));

constexpr double kSigma = 6.0;

TEST_P(HatchTone, IsThatOfTheImageUpToACurve) {
  const hal::Image image = golden::stillLife();
  const std::vector<double> tone = smoothLuma(image, kSigma);
  const std::vector<double> drawing = smoothLuma(drawn(image), kSigma);
  const double error = toneError(tone, drawing);
  RecordProperty("error", std::to_string(error));
  EXPECT_LE(error, 0.08);
  // Control: the drawing of another image, here this one's mirror image, has another tone. In
  // blueprints, which leave most of the ground bare, the difference is smaller.
  hal::Image mirrored = golden::stillLife();
  for (int y = 0; y < mirrored.size().height; ++y) {
    for (int x = 0; x < mirrored.size().width; ++x) {
      const auto* from = image.view().row(0, y).data() + 4 * (mirrored.size().width - 1 - x);
      std::copy_n(from, 4, mirrored.row(0, y).data() + 4 * x);
    }
  }
  EXPECT_GT(toneError(smoothLuma(mirrored, kSigma), drawing), 2.0 * error);
}

/// Darker tones give more ink, in every step of a ramp that is wide enough for lines to average.
TEST_P(HatchTone, IsMonotone) {
  constexpr int kSteps = 8;
  const hal::FrameSize size{320, 160};
  const hal::Image ramp =
      imageOf(size, [&](int x, int) { return (x * kSteps / size.width + 0.5) / kSteps; });
  const std::vector<double> drawing = smoothLuma(drawn(ramp), 0.5);
  std::array<double, kSteps> means{};
  for (int x = 0; x < size.width; ++x) {
    const int inStep = x % (size.width / kSteps);
    if (inStep < 8 || inStep >= 32) continue;  // contours of the steps
    for (int y = 0; y < size.height; ++y) {
      means.at(static_cast<std::size_t>(x * kSteps / size.width)) +=
          drawing[static_cast<std::size_t>(y * size.width + x)] / (24.0 * size.height);
    }
  }
  for (std::size_t i = 1; i < kSteps; ++i) EXPECT_GT(means.at(i), means.at(i - 1) - 0.02) << i;
  EXPECT_GT(means.back(), means.front() + 0.08);
}

class HatchLightening : public HatchingTest {
 protected:
  /// The share of ink on the left half and on the right one.
  std::pair<double, double> inkOfHalves(double left, double right, const char* lighten) {
    Hatching style(library_);
    set(style, {{"lighten", lighten}, {"contours", "0"}});
    restart();
    const hal::Image image =
        imageOf(kSize, [&](int x, int) { return x < kSize.width / 2 ? left : right; });
    style.paint(next(image), {});
    std::array<double, 2> sums{};
    const std::vector<std::uint8_t> ink = inkOf(style);
    for (std::size_t i = 0; i < ink.size(); ++i) {
      const bool isRight = static_cast<int>(i) % kSize.width >= kSize.width / 2;
      sums.at(isRight ? 1 : 0) += ink[i];
    }
    const double most = 255.0 * static_cast<double>(ink.size()) / 2.0;
    return {sums[0] / most, sums[1] / most};
  }
};

/// Two darks, which without it are one black.
TEST_F(HatchLightening, TellsTheDarksOfADarkPictureApart) {
  const auto [dark, lighter] = inkOfHalves(0.03, 0.2, "1");
  const auto [darkAsItIs, lighterAsItIs] = inkOfHalves(0.03, 0.2, "0");
  EXPECT_GT(dark - lighter, 0.2);
  EXPECT_LT(darkAsItIs - lighterAsItIs, 0.1) << "the control";
}

TEST_F(HatchLightening, LeavesABrightPictureAsItIs) {
  EXPECT_EQ(inkOfHalves(0.1, 0.7, "1"), inkOfHalves(0.1, 0.7, "0"));
}

/// A picture of another brightness gets its own lightening within some seconds, a cut's at once.
TEST_F(HatchLightening, FollowsThePictureSlowlyAndACutAtOnce) {
  const auto toneOf = [&](Hatching& style, double luma, bool isCut) {
    const hal::Image image = flat(luma);
    const scene::ArFrame frame = next(image);
    motion_.isCut = isCut;
    return paint(style, frame, "tone")[0];
  };
  Hatching style(library_);
  set(style, {{"filter_time", "0"}});
  restart();
  for (int i = 0; i < 3; ++i) toneOf(style, 0.5, false);
  const int first = toneOf(style, 0.12, false);
  int later = first;
  for (int i = 0; i < 150; ++i) later = toneOf(style, 0.12, false);  // 6 s
  const int cut = toneOf(style, 0.5, true);
  Hatching fresh(library_);
  set(fresh, {{"filter_time", "0"}});
  restart();
  const int own = toneOf(fresh, 0.12, false);
  EXPECT_GT(std::abs(first - own), 30) << "a frame later, it is all but as it was";
  EXPECT_NEAR(later, own, 4);
  fresh.reset();
  restart();
  EXPECT_EQ(cut, toneOf(fresh, 0.5, false));
}

/// Something bright that passes before a dark ground changes no tone beside it.
TEST_F(HatchLightening, IsThatOfTheBackground) {
  const auto toneChanges = [&](const char* movers) {
    Hatching style(library_);
    set(style, {{"movers", movers}});
    restart();
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 2.0 / 255.0);
    const auto toneBeside = [&](bool hasDisc) {
      const hal::Image image = imageOf(kSize, [&](int x, int y) {
        const bool isDisc = hasDisc && std::hypot(x - 96.0, y - 72.0) < 40.0;
        const double luma =
            isDisc ? 0.8 + 0.1 * std::sin(0.6 * y) : 0.12 + 0.06 * std::sin(0.6 * x);
        return luma + noise(random);
      });
      const std::vector<std::uint8_t> tone = paint(style, next(image), "tone");
      double sum = 0.0;
      for (std::size_t x = 0; x < 40; ++x) sum += tone[4 * (20 * 192 + x)] / 40.0;
      return sum;
    };
    double before = 0.0;
    for (int i = 0; i < 8; ++i) before = toneBeside(false);
    double after = before;
    for (int i = 0; i < 15; ++i) after = toneBeside(true);
    return std::abs(after - before);
  };
  const double told = toneChanges("true");
  const double untold = toneChanges("false");
  EXPECT_LT(told, 2.0);
  EXPECT_GT(untold, 5.0) << "the control: everything counts";
}

}  // namespace
}  // namespace pleinair::styles
