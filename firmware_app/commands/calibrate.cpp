#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "config/config_error.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/interrupt.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/config/camera_selection.h"
#include "firmware_app/config/configured_parts.h"
#include "firmware_app/offline/calibration_progress.h"
#include "hal/cameras/recording/recording.h"
#include "hal/media/picture_paths.h"
#include "hal/media/png_file.h"
#include "hal/numbered_path.h"
#include "hal/overloaded.h"
#include "hal/pending_file.h"
#include "pipeline/calibration/calibration_output.h"
#include "pipeline/calibration/session.h"
#include "pipeline/tracking/camera/calibration_file.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;
using calibration::CalibrationReport;
using calibration::CalibrationSession;

// bounds the wait until a signal is noticed
constexpr hal::Duration kPollInterval = std::chrono::milliseconds(100);

[[noreturn]] void refuse(hal::ErrorKind kind, std::string subject, std::string problem,
                         std::string remedy) {
  throw hal::Failure(hal::Error{.kind = kind,
                                .subject = std::move(subject),
                                .problem = std::move(problem),
                                .remedy = std::move(remedy)});
}

/// Whether the input is a set of photographs, which have no common motion, whatever their times.
bool arePhotographs(const fs::path& input) {
  std::error_code ignored;
  return fs::is_directory(input, ignored) || hal::looksNumbered(input) || hal::isPictureName(input);
}

/// Whether `output` is an existing calibration, which will be replaced. Refuses any other existing
/// file.
bool replacesCalibration(const fs::path& output) {
  std::error_code ignored;
  if (!fs::exists(output, ignored)) return false;
  try {
    tracking::loadCalibration(output);
  } catch (const config::ConfigError&) {
    refuse(hal::ErrorKind::kInvalidArgument, output.string(),
           "exists and is not a calibration, so it is not overwritten",
           "give --output another name");
  }
  return true;
}

/// Requires an empty folder for the view pictures, which are numbered: those of an earlier run
/// would mix with them.
void requireEmptyFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  const bool isEmpty = !error && fs::is_empty(folder, error);
  if (error) {
    refuse(hal::ErrorKind::kInvalidArgument, folder.string(),
           "cannot make or read the folder: " + error.message(), "give another --views-folder");
  }
  if (!isEmpty) {
    refuse(hal::ErrorKind::kInvalidArgument, folder.string(), "is not empty",
           "give --views-folder a new or an empty folder");
  }
}

/// One calibration, from its camera to its output.
class CalibrationRun {
 public:
  CalibrationRun(const CalibrateOptions& options, std::string subject, hal::Camera& camera,
                 const hal::StreamRequest& request)
      : options_(options),
        subject_(std::move(subject)),
        camera_(camera),
        isLive_(!options.input),
        replaces_(replacesCalibration(options.output)),
        format_(hal::orThrow(camera.start(request))),
        file_(hal::orThrow(hal::PendingFile::create(options.output))),
        session_(boardOf(options.board), format_.frame.size,
                 {.selection = {.isSequence = isLive_ || !arePhotographs(*options.input)},
                  .keepsPictures = options.viewsFolder.has_value()}),
        progress_(clock_) {}

  int run() {
    const int signal = receiveAll();
    progress_.interrupt();
    camera_.stop();
    if (signal != 0 && !isLive_) {
      printError(fmt::format("interrupted by {}; nothing was written", signalName(signal)));
      return kSignalExitBase + signal;
    }
    const CalibrationReport report = session_.solve();
    // also for a refused calibration: they show the reason
    if (options_.viewsFolder) writeViews(report);
    if (!report.isGood()) refuseReport(report);
    const std::string text = calibration::calibrationText(session_.board(), report);
    hal::orThrow(file_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
    hal::orThrow(file_.publish());
    std::fputs(summary(report).c_str(), stdout);
    return 0;
  }

 private:
  /// Runs to the end. Gives the number of the signal that interrupted it, or 0.
  int receiveAll() {
    while (!options_.frames || session_.selector().counts().pictures < *options_.frames) {
      if (const int signal = Interrupt::received(); signal != 0) return signal;
      if (isLive_ && session_.selector().isComplete()) break;
      hal::NextFrame next = camera_.next(isLive_ ? clock_.now() + kPollInterval : hal::kNoDeadline);
      if (!receive(next)) break;
    }
    return 0;
  }

  /// False at the end.
  bool receive(hal::NextFrame& next) {
    const hal::Overloaded take{
        [&](hal::CapturedFrame& frame) {
          examine(frame);
          return true;
        },
        [](hal::CameraTimeout&) { return true; },
        [](hal::FormatChanged&) { return true; },  // each frame carries its own format
        [&](hal::EndOfStream& end) {
          if (end.truncated) warn(end.truncated->message());
          return false;
        },
        [&](hal::CameraLost& lost) {
          if (session_.selector().views().empty()) throw hal::Failure(std::move(lost.cause));
          warn(lost.cause.message() + "; the views so far are used");
          return false;
        },
        [](hal::Error& error) -> bool { throw hal::Failure(std::move(error)); },
    };
    return std::visit(take, next);
  }

  void examine(const hal::CapturedFrame& frame) {
    if (frame.health != hal::FrameHealth::kValid) return;
    const hal::FrameSize size = frame.image.format.size;
    if (size != format_.frame.size) {
      refuse(hal::ErrorKind::kInvalidInput, subject_,
             fmt::format("its frame size changes from {}x{} to {}x{}", format_.frame.size.width,
                         format_.frame.size.height, size.width, size.height),
             "a calibration is for one frame size: give frames of one size");
    }
    const calibration::ViewOutcome outcome =
        session_.offer(frame.image.map().view(), frame.captureTime);
    progress_.advance(session_.selector(), outcome);
  }

  void warn(const std::string& text) {
    progress_.interrupt();
    spdlog::warn("{}", text);
  }

  void writeViews(const CalibrationReport& report) const {
    const calibration::ViewSelector& selector = session_.selector();
    for (std::size_t i = 0; i < selector.views().size(); ++i) {
      const calibration::SelectedView& view = selector.views()[i];
      const hal::Image picture = calibration::viewPicture(session_.pictureOf(view).view(), view, i,
                                                          session_.board(), report);
      hal::orThrow(hal::writePng(*options_.viewsFolder / fmt::format("view-{:02}.png", i + 1),
                                 picture.view()));
    }
    const hal::Image coverage = coveragePicture(selector, report, format_.frame.size);
    hal::orThrow(hal::writePng(*options_.viewsFolder / "coverage.png", coverage.view()));
  }

  [[noreturn]] void refuseReport(const CalibrationReport& report) const {
    std::vector<std::string> reasons;
    for (const calibration::Refusal& refusal : report.refusals) reasons.push_back(refusal.text);
    std::string remedy = report.refusals.front().remedy;
    if (report.refusals.front().reason == calibration::RefusalReason::kNoBoard) {
      if (const auto other = session_.otherBoard()) {
        reasons.push_back("the frames show " + *other + " instead");
      }
    }
    refuse(hal::ErrorKind::kInvalidInput, subject_,
           fmt::format("no calibration is written: {}", fmt::join(reasons, "; ")),
           std::move(remedy));
  }

  std::string summary(const CalibrationReport& report) const {
    const calibration::LensFit& fit = report.choice->fit;
    const tracking::Intrinsics& lens = fit.camera.intrinsics();
    return fmt::format(
        "calibrated from {} views of {} pictures: fx {:.1f} ± {:.1f}, fy {:.1f} ± {:.1f}, "
        "cx {:.1f} ± {:.1f}, cy {:.1f} ± {:.1f}, {}\n"
        "error {:.2f} px RMS, {:.2f} px in views held out; the picture is known to {:.2f} px, and "
        "to {:.2f} px in {}: {}{}\n",
        report.choice->used.size(), session_.selector().counts().pictures, lens.fx, fit.sigma(0),
        lens.fy, fit.sigma(1), lens.cx, fit.sigma(2), lens.cy, fit.sigma(3), toString(fit.model),
        fit.rmsPx, report.choice->heldOutRmsPx, report.typicalSigmaPx, report.worstSigmaPx,
        report.worstPlace, replaces_ ? "replaced " : "", options_.output.string());
  }

  const CalibrateOptions& options_;
  std::string subject_;
  hal::Camera& camera_;
  bool isLive_;
  bool replaces_;
  hal::SteadyClock clock_;
  hal::StreamFormat format_;
  hal::PendingFile file_;
  CalibrationSession session_;
  CalibrationProgress progress_;
};

void refuseCollisionsOf(const CalibrateOptions& options, const Configuration& configuration) {
  std::vector<NamedPath> read = configuredFiles(configuration, {});
  const CameraSettings camera = configuration.camera();
  if (options.input) {
    read.push_back({"--input", *options.input});
  } else if (isRecording(camera)) {
    read.push_back({"--camera", camera.source});
  }
  refuseCollisions(read, {{"--output", options.output}});
}

}  // namespace

int calibrate(const CalibrateOptions& options) {
  const Interrupt interrupt;
  const Configuration configuration(options.configuration);
  return configuration.attributing([&] {
    boardOf(options.board);  // reports errors before a camera is opened
    if (!options.input && configuration.origin("camera.source") == config::kDefaultOrigin) {
      // The default is the workbench, which shows no board, and never ends.
      refuse(hal::ErrorKind::kInvalidArgument, "calibrate", "is given no camera",
             "give one, such as --camera auto, or a recording as --input FILE");
    }
    if (!options.input) refuseSlipOfCamera(configuration);
    refuseCollisionsOf(options, configuration);
    if (options.viewsFolder) requireEmptyFolder(*options.viewsFolder);
    if (options.input) {
      hal::SteppedClock clock;
      const auto recording = hal::openRecording(*options.input, clock);
      return CalibrationRun(options, options.input->string(), *recording, {}).run();
    }
    const CameraSettings settings = configuration.camera();
    hal::SteadyClock clock;
    const auto camera = chosenCamera(settings, clock);
    return CalibrationRun(options, settings.source.string(), *camera, streamRequestOf(settings))
        .run();
  });
}

}  // namespace pleinair::app
