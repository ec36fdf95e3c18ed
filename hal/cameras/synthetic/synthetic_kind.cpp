#include "hal/cameras/synthetic/synthetic_kind.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "config/parameter_table.h"
#include "hal/cameras/synthetic/synthetic_backend.h"

namespace pleinair::hal::synthetic {
namespace {

struct SyntheticSettings {
  std::string shot{toString(SyntheticOptions().shot)};
  int seed = 1;
  double noise = 2.0;
  double exposureDriftStops = 0;
  double whiteBalanceDrift = 0;  ///< a share
  double readout = 0;            ///< of the frame period; 0: global shutter
};

const config::ParameterTable<SyntheticSettings>& syntheticTable() {
  using S = SyntheticSettings;
  using config::numberParameter;
  using config::TakesEffect;
  static const config::ParameterTable<S> kTable{
      config::choiceParameter(
          "shot", &S::shot,
          std::vector<std::string>(syntheticShots().begin(), syntheticShots().end()),
          "What happens before the camera where camera.source is \"synthetic\" alone.",
          TakesEffect::kRestart),
      config::integerParameter("seed", &S::seed, {.min = 0}, "Of its world, path and noise.",
                               TakesEffect::kRestart),
      numberParameter("noise", &S::noise, {.min = 0, .max = 40, .unit = "8-bit levels"},
                      "Standard deviation of the sensor's noise.", TakesEffect::kRestart),
      numberParameter("exposure_drift", &S::exposureDriftStops,
                      {.min = 0, .max = 2, .unit = "stops"}, "How far the brightness wanders.",
                      TakesEffect::kRestart),
      numberParameter("white_balance_drift", &S::whiteBalanceDrift, {.min = 0, .max = 0.5},
                      "How far red and blue wander against each other, as a share.",
                      TakesEffect::kRestart),
      numberParameter("readout", &S::readout, {.min = 0, .max = 1},
                      "The share of a frame's time that the rolling shutter takes; 0: all rows at "
                      "once.",
                      TakesEffect::kRestart)};
  return kTable;
}

}  // namespace

SyntheticOptions optionsOf(const config::ParameterValues& own,
                           const CameraBackendOptions& options) {
  const SyntheticSettings settings = syntheticTable().typed(own);
  const std::chrono::duration<double> period(options.framePeriod);
  const auto rowTime =
      period * (settings.readout / std::max(options.size.height, 1));  // rounded down: it must fit
  return {.size = options.size,
          .framePeriod = options.framePeriod,
          .shot = syntheticShotNamed(settings.shot).value(),
          .seed = static_cast<std::uint32_t>(settings.seed),
          .noiseSigma = settings.noise,
          .exposureDriftStops = settings.exposureDriftStops,
          .whiteBalanceDrift = settings.whiteBalanceDrift,
          .rowTime = std::chrono::duration_cast<Duration>(rowTime),
          .pacing = options.pacing};
}

const CameraKind& cameraKind() {
  static const CameraKind kKind{
      .name = "synthetic",
      .help = "a workbench made by code",
      .naming = CameraNaming::kListed,
      .defaults = syntheticTable().defaults(),
      .open = [](const config::ParameterValues& own,
                 const CameraBackendOptions& options) -> std::unique_ptr<CameraBackend> {
        return std::make_unique<SyntheticBackend>(optionsOf(own, options));
      }};
  return kKind;
}

}  // namespace pleinair::hal::synthetic
