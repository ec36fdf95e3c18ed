#include <map>
#include <memory>
#include <utility>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "tests/conformance/camera_conformance.h"

namespace pleinair::hal::conformance {
namespace {

/// Keeps the workbench of a size alive, so that it is painted once, not at every start.
void keepWorkbenchOf(FrameSize size) {
  static SteppedClock clock;
  static std::map<std::pair<int, int>, std::unique_ptr<SyntheticCamera>> keepers;
  auto& keeper = keepers[{size.width, size.height}];
  if (keeper) return;
  keeper = std::make_unique<SyntheticCamera>(SyntheticOptions{.size = size}, clock);
  EXPECT_TRUE(keeper->start({}));
}

CameraCase synthetic(const std::string& name, const SyntheticOptions& options) {
  return {.name = name,
          .make =
              [options](Clock& clock) {
                keepWorkbenchOf(options.size);
                return std::make_unique<SyntheticCamera>(options, clock);
              },
          .backend = "synthetic",
          .frames = options.frameCount.value_or(0)};
}

INSTANTIATE_TEST_SUITE_P(
    Synthetic, CameraConformance,
    testing::Values(synthetic("Stepped", {.size = {96, 72}, .frameCount = 5}),
                    synthetic("RealTime",
                              {.size = {97, 55}, .frameCount = 5, .pacing = Pacing::kRealTime}),
                    synthetic("Rolling", {.size = {96, 72},
                                          .frameCount = 5,
                                          .shot = SyntheticShot::kOccluder,
                                          .exposureDriftStops = 0.3,
                                          .whiteBalanceDrift = 0.1,
                                          .rowTime = std::chrono::microseconds(300)}),
                    synthetic("Lights", {.size = {64, 48},
                                         .framePeriod = std::chrono::milliseconds(500),
                                         .frameCount = 5,
                                         .shot = SyntheticShot::kLights}),
                    synthetic("EndlessRealTime", {.size = {64, 48}, .pacing = Pacing::kRealTime}),
                    synthetic("OnePixel", {.size = {1, 1}, .frameCount = 3})),
    cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
