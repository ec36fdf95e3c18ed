#include <array>
#include <memory>
#include <string_view>

#include "pipeline/styles/painterly/painterly.h"
#include "pipeline/styles/painterly/painterly_parameters.h"
#include "pipeline/styles/painterly/painterly_shaders.h"
#include "pipeline/styles/painterly/painterly_views.h"
#include "pipeline/styles/strokes/brush_cache.h"
#include "pipeline/styles/strokes/strokes_shaders.h"
#include "pipeline/styles/substrate/substrate_shaders.h"

namespace pleinair::styles {
namespace {

constexpr auto kMax = CoherenceGate::Side::kMax;
constexpr auto kMin = CoherenceGate::Side::kMin;
/// The limits that its paintings are held to (docs/measuring.md).
constexpr std::array kGates{
    CoherenceGate{CoherenceMeasure::kEw2, kMax, 0.6, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kEw2, kMax, 0.6, false, GateMotion::kOtherKnown},
    CoherenceGate{CoherenceMeasure::kNHw2, kMax, 0.10, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kNHw2, kMax, 0.20, false, GateMotion::kOtherKnown},
    CoherenceGate{CoherenceMeasure::kS10, kMin, 90, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kS10, kMin, 80, false, GateMotion::kOtherKnown},
    CoherenceGate{CoherenceMeasure::kPop, kMax, 1, false, GateMotion::kPan},
    CoherenceGate{CoherenceMeasure::kPop, kMax, 1.5, false, GateMotion::kOtherKnown},
    CoherenceGate{CoherenceMeasure::kXFlk, kMax, 0.5},
    CoherenceGate{CoherenceMeasure::kDep, kMin, 0.75, true},
    CoherenceGate{CoherenceMeasure::kDet, kMin, 0.75},
};

constexpr std::array<std::string_view, 2> kPaperLooks{"sketch", "ink"};

/// Whether the brush's file is there and valid. Reads it; any thread. Errors: readBrushFile()'s.
hal::Result<void> checkBrush(const config::ParameterValues& values) {
  return checkBrushFile(painterlyParameters().typed(values).brushFile);
}

}  // namespace

const StyleKind& painterlyKind() {
  static const StyleKind kKind{
      .name = "painterly",
      .help = "layers of brush strokes that live (thesis chapter IV, and on)",
      .defaults = painterlyParameters().defaults(),
      .looks = painterlyLooks(),
      .views = painterlyViews(),
      .needs = {.surfaces = true,
                .measuredMotion = true,
                .segments = true,
                .faces = true,
                .canvas = true,
                .shading = scene::Shading::kSmooth},
      .coherence = {.gates = kGates, .holdsAnchors = true, .paperLooks = kPaperLooks},
      .shaders = {gpu::painterlyShaders(), gpu::strokesShaders(), gpu::substrateShaders()},
      .check = checkBrush,
      .make = [](const gpu::ShaderLibrary& library, SceneContents contents)
          -> std::unique_ptr<Style> { return std::make_unique<Painterly>(library, contents); }};
  return kKind;
}

}  // namespace pleinair::styles
