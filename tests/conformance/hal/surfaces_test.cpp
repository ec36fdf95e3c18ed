#include <memory>
#include <vector>

#include "hal/outputs/display/display_output.h"
#include "tests/conformance/surface_conformance.h"
#include "tests/support/fake_card.h"
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

/// A display of a fake card.
SurfaceCase display(const std::string& name, const support::FakeCardSpec& spec) {
  // Each output has a card of its own, which outlives it.
  const auto machines = std::make_shared<std::vector<std::unique_ptr<support::FakeCards>>>();
  return {.name = name,
          .make =
              [machines, spec](Clock& clock) {
                machines->push_back(std::make_unique<support::FakeCards>(clock));
                support::FakeCards& cards = *machines->back();
                cards.add(spec);
                return std::unique_ptr<Output>(*openDisplay("display", {}, cards, clock));
              },
          .backend = "display",
          .missing = {},
          .hasOwnSize = true};
}

INSTANTIATE_TEST_SUITE_P(
    Displays, SurfaceConformance,
    testing::Values(display("At60Hz", {}),
                    display("At24HzWithBars",
                            {.connectors = {{.modes = {{.size = {100, 48}, .hertz = 24.0}}}}}),
                    display("WithoutVerticalBlanking", {.hasVblank = false})),
    surfaceCaseName);

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
