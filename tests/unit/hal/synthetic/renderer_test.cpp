#include "hal/cameras/synthetic/render/renderer.h"

#include <cmath>

#include "hal/cameras/synthetic/render/sampler.h"
#include "hal/cameras/synthetic/world/srgb.h"
#include "hal/cameras/synthetic/world/workbench.h"
#include "tests/unit/hal/synthetic/captured.h"
#include "tests/unit/hal/synthetic/ray_oracle.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr FrameSize kSize{160, 120};

Texel colourOf(std::size_t patch) {
  return {static_cast<std::uint8_t>(20 + (patch * 37) % 211),
          static_cast<std::uint8_t>(20 + (patch * 101) % 223),
          static_cast<std::uint8_t>(20 + (patch * 59) % 199)};
}

/// The workbench with a different colour for each patch.
std::shared_ptr<const World> mapOfPatches() {
  World world{workbenchGeometry(), {}};
  std::size_t patches = 0;
  for (const Facet& facet : world.geometry.facets) {
    patches = std::max(patches, static_cast<std::size_t>(facet.patch) + 1);
  }
  for (std::size_t patch = 0; patch < patches; ++patch) {
    PatchTexture texture{MipTexture(2, 2), 1, {1, 1}};
    std::ranges::fill(texture.texture.base().texels, colourOf(patch));
    world.textures.push_back(std::move(texture));
  }
  return std::make_shared<const World>(std::move(world));
}

/// Row-major, three levels per pixel.
std::vector<double> rendered(const Exposure& exposure) {
  Renderer renderer(mapOfPatches());
  renderer.begin(exposure);
  std::vector<double> levels;
  for (int y = 0; y < exposure.size().height; ++y) {
    for (const std::int16_t level : renderer.nextRow()) levels.push_back(level / 64.0);
  }
  return levels;
}

/// The patch at each pixel's centre, by the oracle.
std::vector<std::size_t> oraclePatches(const Exposure& exposure) {
  const Geometry& geometry = workbenchGeometry();
  std::vector<std::size_t> patches;
  for (int y = 0; y < exposure.size().height; ++y) {
    const CameraView view = exposure.viewAt(y + 0.5);
    const BodyPoses bodies = exposure.bodiesAt(y + 0.5);
    for (int x = 0; x < exposure.size().width; ++x) {
      const auto hit = oracleHit(geometry, view, bodies, {x + 0.5, y + 0.5});
      patches.push_back(hit ? geometry.facets[hit->facet].patch : 9999);
    }
  }
  return patches;
}

/// Every pixel without an edge nearby must show the oracle's patch; the others may be mixed.
void expectOraclesPatches(const Exposure& exposure) {
  const std::vector<double> levels = rendered(exposure);
  const std::vector<std::size_t> patches = oraclePatches(exposure);
  const auto width = static_cast<std::size_t>(exposure.size().width);
  const auto height = static_cast<std::size_t>(exposure.size().height);
  int compared = 0;
  int wrong = 0;
  for (std::size_t y = 1; y + 1 < height; ++y) {
    for (std::size_t x = 1; x + 1 < width; ++x) {
      const std::size_t i = y * width + x;
      bool isInner = true;
      for (const std::size_t j : {i - 1, i + 1, i - width, i + width, i - width - 1, i - width + 1,
                                  i + width - 1, i + width + 1}) {
        isInner &= patches[j] == patches[i];
      }
      if (!isInner) continue;
      ++compared;
      const Texel expected = colourOf(patches[i]);
      const bool isSame = std::abs(levels[3 * i] - expected.red) < 1.5 &&
                          std::abs(levels[3 * i + 1] - expected.green) < 1.5 &&
                          std::abs(levels[3 * i + 2] - expected.blue) < 1.5;
      wrong += isSame ? 0 : 1;
    }
  }
  EXPECT_GT(compared, static_cast<int>(width * height) / 2);
  // Slivers narrower than a pixel may run between centres.
  EXPECT_LE(wrong, compared / 500) << "of " << compared;
}

TEST(Renderer, ShowsWhatRaysMeet) {
  for (const SyntheticShot shot : {SyntheticShot::kWalkaround, SyntheticShot::kRoll}) {
    const Motion motion(shot, 1);
    for (const int seconds : {0, 5}) {
      expectOraclesPatches(Exposure(kSize, motion, std::chrono::seconds(seconds), {}));
    }
  }
}

TEST(Renderer, ShowsWhatMoves) {
  const Motion motion(SyntheticShot::kOccluder, 1);
  expectOraclesPatches(Exposure(kSize, motion, std::chrono::milliseconds(2400), {}));
}

TEST(Renderer, ShowsPersons) {
  const Motion motion(SyntheticShot::kVisitors, 1);
  expectOraclesPatches(Exposure(kSize, motion, std::chrono::milliseconds(3200), {}));
  expectOraclesPatches(
      Exposure(kSize, motion, std::chrono::milliseconds(9400), std::chrono::microseconds(280)));
}

TEST(Renderer, ShowsEachRowOfARollingShutterAtItsMoment) {
  using std::chrono::microseconds;
  const Motion roll(SyntheticShot::kRoll, 1);
  expectOraclesPatches(Exposure(kSize, roll, {}, microseconds(700)));
  const Motion arm(SyntheticShot::kOccluder, 1);
  expectOraclesPatches(Exposure(kSize, arm, std::chrono::milliseconds(1200), microseconds(280)));
}

/// The column, with subpixel precision, of a row's largest step between two levels.
double largestStep(const std::vector<double>& levels, int row, int from, int to) {
  double best = 0;
  double at = 0;
  for (int x = from; x + 2 < to; ++x) {
    const std::size_t i =
        3 * (static_cast<std::size_t>(row) * kSize.width + static_cast<std::size_t>(x));
    const auto light = [&](std::size_t k) {
      return static_cast<double>(linearFromLevel(static_cast<std::uint8_t>(levels[k] + 0.5)));
    };
    const double whole = light(i + 6) - light(i);
    if (std::abs(whole) <= std::abs(best)) continue;
    best = whole;
    // The pixel between contains the right side in proportion to its light.
    at = x + 2 - (light(i + 3) - light(i)) / whole;
  }
  return at;
}

TEST(Renderer, SlantsAVerticalEdgeAsFarAsTheCameraTurnsMeanwhile) {
  // The poster's right edge is vertical at x = -0.405; the pan passes it.
  const Motion motion(SyntheticShot::kPan, 1);
  const Duration rowTime = std::chrono::microseconds(900);
  const auto columns = [&](Duration each) {
    const Exposure exposure(kSize, motion, {}, each);
    const std::vector<double> levels = rendered(exposure);
    const glm::dvec2 top = *exposure.project({{-0.405, kWallY - 0.002, 0.60}});
    const glm::dvec2 low = *exposure.project({{-0.405, kWallY - 0.002, 0.41}});
    for (const glm::dvec2& at : {top, low}) {
      const int middle = static_cast<int>(at.x);
      const double found = largestStep(levels, static_cast<int>(at.y), middle - 6, middle + 7);
      EXPECT_NEAR(found, at.x, 0.15);
    }
    return low.x - top.x;
  };
  const double standing = columns({});
  const double rolling = columns(rowTime);
  EXPECT_GT(std::abs(rolling - standing), 0.5) << "the slant must be large enough to tell";
}

TEST(Renderer, GivesEdgesAllShades) {
  // Coverage takes many values between two patches, not just 0 and 1.
  const Motion motion(SyntheticShot::kRoll, 1);
  const Exposure exposure({640, 480}, motion, std::chrono::milliseconds(300), {});
  const std::vector<double> levels = rendered(exposure);
  std::vector<bool> seen(256);
  for (const double level : levels) seen[static_cast<std::size_t>(level)] = true;
  EXPECT_GT(std::ranges::count(seen, true), 200);
}

}  // namespace
}  // namespace pleinair::hal::synthetic
