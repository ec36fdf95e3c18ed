#include "hal/cameras/recording/recording_kind.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/parameter_table.h"
#include "hal/camera_backend.h"
#include "hal/cameras/recording/recording.h"

namespace pleinair::hal::recording {
namespace {

/// Recordings as cameras; ids are their paths, as of openRecording(). It lists none: which of a
/// computer's files are meant, nobody but their owner knows.
class RecordingBackend final : public CameraBackend {
 public:
  explicit RecordingBackend(RecordingOptions options) : options_(options) {}

  std::string_view name() const override { return "recording"; }
  Result<std::vector<CameraDescription>> list() override {
    return std::vector<CameraDescription>();
  }
  std::unique_ptr<Camera> make(const std::string& id, Clock& clock) override {
    return openRecording(id, clock, options_);
  }

 private:
  RecordingOptions options_;
};

struct RecordingSettings {
  bool loop = true;
  double pictureRate = 30;
};

const config::ParameterTable<RecordingSettings>& recordingTable() {
  using S = RecordingSettings;
  using config::TakesEffect;
  static const config::ParameterTable<S> kTable{
      config::switchParameter("loop", &S::loop,
                              "Whether a recording that is played live starts over at its end.",
                              TakesEffect::kRestart),
      config::numberParameter("picture_rate", &S::pictureRate,
                              {.min = 0.1, .max = 240, .unit = "pictures a second"},
                              "How fast the pictures of a folder or pattern follow each other.",
                              TakesEffect::kRestart)};
  return kTable;
}

std::unique_ptr<CameraBackend> openBackend(const config::ParameterValues& own,
                                           const CameraBackendOptions& options) {
  const RecordingSettings settings = recordingTable().typed(own);
  return std::make_unique<RecordingBackend>(
      RecordingOptions{.pacing = options.pacing,
                       .loop = settings.loop && options.pacing == Pacing::kRealTime,
                       .picturePeriod = fromSeconds(1.0 / settings.pictureRate)});
}

}  // namespace

const CameraKind& cameraKind() {
  static const CameraKind kKind{.name = "recording",
                                .help = "a movie, picture, folder or pattern, by its path",
                                .naming = CameraNaming::kPaths,
                                .defaults = recordingTable().defaults(),
                                .open = openBackend};
  return kKind;
}

}  // namespace pleinair::hal::recording
