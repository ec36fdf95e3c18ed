#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "pipeline/runtime/runtime_status.h"

namespace pleinair::app {

/// Tells what happens to a live chain: a status line on standard error where that is a terminal,
/// and what went wrong or well again as log messages. One thread.
class LiveReporter {
 public:
  explicit LiveReporter(std::vector<std::string> qualityNames);
  /// Ends the line.
  ~LiveReporter();
  LiveReporter(const LiveReporter&) = delete;
  LiveReporter& operator=(const LiveReporter&) = delete;

  /// To be called several times a second.
  void update(const runtime::RuntimeStatus& status, hal::TimePoint now);
  /// Clears the line, so that something else can be said.
  void interrupt();

 private:
  void tellCamera(const runtime::RuntimeStatus& status);
  void tellPainting(const runtime::RuntimeStatus& status);
  void tellOutputs(const runtime::RuntimeStatus& status);
  template <class... Arguments>
  void warn(const char* format, const Arguments&... arguments);
  template <class... Arguments>
  void inform(const char* format, const Arguments&... arguments);

  std::vector<std::string> qualityNames_;
  bool isTerminal_;
  bool isDrawn_ = false;
  std::optional<hal::TimePoint> drawn_;
  std::optional<runtime::RuntimeStatus> last_;
  bool wasLost_ = false;
  std::string lastLoss_;
  std::string lastRefusal_;
};

}  // namespace pleinair::app
