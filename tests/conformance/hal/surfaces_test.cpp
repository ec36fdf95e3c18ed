#include <memory>
#include <vector>

#include "tests/conformance/surface_conformance.h"
#include "tests/support/fake_display_output.h"

namespace pleinair::hal::conformance {
namespace {

SurfaceCase fakeDisplay(const std::string& name, support::FakeDisplay display) {
  const auto shared = std::make_shared<support::FakeDisplay>(std::move(display));
  return {.name = name,
          .make =
              [shared](Clock& clock) {
                return std::make_unique<support::FakeDisplayOutput>(*shared, clock);
              },
          .backend = "fake_display",
          .missing = {}};
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, SurfaceConformance,
    testing::Values(fakeDisplay("At60Hz", {}),
                    fakeDisplay("At50HzWithTwoSurfaces",
                                {.period = std::chrono::milliseconds(20), .surfaces = 2}),
                    fakeDisplay("OfUnknownPhase", {.phase = TimePoint(Duration(1'234'567)),
                                                   .surfaces = 5,
                                                   .fourcc = kXbgr8888,
                                                   .paddingBytes = 0,
                                                   .tellsPhase = false})),
    surfaceCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
