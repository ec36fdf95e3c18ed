#include "hal/cameras/synthetic/synthetic_camera.h"
#include "tests/conformance/camera_conformance.h"

namespace pleinair::hal::conformance {
namespace {

CameraCase synthetic(const std::string& name, const SyntheticOptions& options) {
  return {
      .name = name,
      .make = [options](Clock& clock) { return std::make_unique<SyntheticCamera>(options, clock); },
      .backend = "synthetic",
      .frames = options.frameCount.value_or(0)};
}

INSTANTIATE_TEST_SUITE_P(
    Synthetic, CameraConformance,
    testing::Values(synthetic("Stepped", {.size = {96, 72}, .frameCount = 5}),
                    synthetic("RealTime",
                              {.size = {97, 55}, .frameCount = 5, .pacing = Pacing::kRealTime}),
                    synthetic("EndlessRealTime", {.size = {64, 48}, .pacing = Pacing::kRealTime}),
                    synthetic("OnePixel", {.size = {1, 1}, .frameCount = 3})),
    cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
