#include "hal/cameras/synthetic/synthetic_kind.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/parameter_table.h"
#include "hal/camera_backend.h"

namespace pleinair::hal::synthetic {
namespace {

CameraDescription descriptionOf(std::string_view shot, const SyntheticOptions& options) {
  return {.identity = {.backend = "synthetic",
                       .id = std::string(shot),
                       .description = "simulated camera before a workbench"},
          .serial = {},
          .node = {},
          .modes = {{.layout = "RGB3", .size = options.size, .periods = {options.framePeriod}}},
          .problem = {}};
}

/// A shot that there is not.
class NoShot final : public Camera {
 public:
  explicit NoShot(Error error) : error_(std::move(error)) {}

  CameraIdentity identity() const override {
    return {.backend = "synthetic", .id = error_.subject, .description = error_.problem};
  }
  Result<StreamFormat> start(const StreamRequest&) override { return tl::unexpected(error_); }
  NextFrame next(TimePoint) override { return error_; }
  void stop() override {}

 private:
  Error error_;
};

/// The synthetic camera's shots as cameras; ids are their names ("walkaround"), the options' shot
/// is the first. A name that no shot has becomes a camera whose start() says what there is.
class SyntheticBackend final : public CameraBackend {
 public:
  explicit SyntheticBackend(SyntheticOptions options) : options_(options) {}

  std::string_view name() const override { return "synthetic"; }
  Result<std::vector<CameraDescription>> list() override;
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override;

 private:
  SyntheticOptions options_;
};

Result<std::vector<CameraDescription>> SyntheticBackend::list() {
  std::vector<CameraDescription> cameras;
  const std::string_view first = toString(options_.shot);
  for (const std::string_view shot : syntheticShots()) {
    cameras.push_back(descriptionOf(shot, options_));
    if (shot == first) std::rotate(cameras.begin(), std::prev(cameras.end()), cameras.end());
  }
  return cameras;
}

std::unique_ptr<Camera> SyntheticBackend::make(const std::string& id, Clock& clock) {
  const std::optional<SyntheticShot> shot = syntheticShotNamed(id);
  if (!shot) {
    return std::make_unique<NoShot>(
        Error{.kind = ErrorKind::kInvalidArgument,
              .subject = "synthetic:" + id,
              .problem = "the synthetic camera has no shot \"" + id + "\"",
              .remedy = "allowed: " + syntheticShotNames()});
  }
  SyntheticOptions options = options_;
  options.shot = *shot;
  return std::make_unique<SyntheticCamera>(options, clock);
}

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
