#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "firmware_app/live/live_job.h"
#include "firmware_app/live/screens/screens.h"
#include "firmware_app/live/status/live_reporter.h"
#include "firmware_app/live/status/presentation_watch.h"
#include "hal/camera.h"
#include "hal/output.h"
#include "hal/outputs/window/window.h"
#include "pipeline/runtime/frame_log.h"
#include "pipeline/runtime/live_pipeline.h"

namespace pleinair::app {

/// The outputs of a live painting: from their targets to their stages in the pipeline, and the
/// waiting pictures of those that show some (screens). Main thread.
class LiveOutputs {
 public:
  /// All references, and the log, outlive this; null: no log. Throws hal::Failure for a target that
  /// cannot be an output.
  LiveOutputs(const LiveJob& job, runtime::LivePipeline& pipeline, LiveReporter& reporter,
              runtime::FrameLog* log);

  /// Starts the screens without a desktop, for the stream that the job asks for, as the camera's is
  /// not known yet; each has shown its first picture, has failed, or takes longer than a second.
  /// Throws hal::Failure.
  void startScreens();
  /// Starts windows in the same way, once the camera is late: they show what is waited for, at
  /// update() and stepWindows(). Throws hal::Failure.
  void startWindows();
  /// Hands over what is due at windows, before frames flow.
  void stepWindows();
  /// Starts the others, for the camera's stream, which the screens take too. Throws hal::Failure.
  void start(const hal::StreamFormat& stream);

  /// Whether update() is to be called.
  bool isUpdateDue() const;
  /// Draws the waiting pictures that are due, and opens failed displays again after
  /// devicesChanged().
  void update(const LiveProgress& progress);
  /// Displays may have come or gone. Any thread.
  void devicesChanged() { haveDisplaysChanged_ = true; }
  /// Keeps the last painting of a screen. The stages still exist.
  void finish();

  /// Displays without a desktop, which were started.
  const std::vector<runtime::OutputStage*>& displays() const { return displays_; }
  std::vector<runtime::OutputStage*> screens() const { return screens_.stages(); }
  /// What each output has shown so far.
  std::vector<OutputProgress> progress() const;
  /// Screens::renewAfter().
  void renewWaitingAfter(hal::Duration interval) { screens_.renewAfter(interval); }
  /// Those that the main thread steps: the window.
  const std::vector<runtime::OutputStage*>& stepped() const { return stepped_; }
  /// Null where there is none.
  hal::Window* window() const { return window_; }
  /// The EGLDisplay of the window, for a painter that shares textures with it; null: there is none
  /// any more, or it shares none. Any thread, after start().
  void* windowDisplay() const;
  /// The size of paintings.
  hal::FrameSize pictureSize() const;
  /// Whether each output has got its frames or has failed for good.
  bool haveEnded() const;

 private:
  bool isScreen(const std::string& target) const;
  bool isOnConsole(const std::string& target) const;
  void startOutput(std::size_t index);
  void reconfigureScreens();
  hal::OutputRequest request() const;
  void reportKeeping();
  void reportScanOut();

  const LiveJob& job_;
  runtime::LivePipeline& pipeline_;
  LiveReporter& reporter_;
  std::string keepingProblem_;  ///< the last one of keeping the last painting
  runtime::FrameLog* log_;
  hal::StreamFormat stream_;
  bool isStreamKnown_ = false;
  Screens screens_;
  std::vector<std::unique_ptr<hal::Output>> opened_;  ///< until the pipeline owns them
  std::vector<bool> isStarted_;                       ///< of the same outputs
  std::vector<runtime::OutputStage*> stepped_;
  std::vector<runtime::OutputStage*> displays_;
  std::map<std::string, runtime::ScanOut> scanOut_;  ///< as reported, by the outputs' names
  hal::Window* window_ = nullptr;
  const runtime::OutputStage* windowStage_ = nullptr;  ///< of window_
  void* windowDisplay_ = nullptr;                      ///< EGLDisplay
  std::atomic<bool> haveDisplaysChanged_ = false;
  hal::TimePoint updated_;
};

}  // namespace pleinair::app
