#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "pipeline/runtime/status/runtime_status.h"

namespace pleinair::app {

/// Reports the state of a live pipeline: a status line on standard error if that is a terminal, and
/// log messages about failures and recoveries. One thread.
class LiveReporter {
 public:
  explicit LiveReporter(std::vector<std::string> qualityNames);
  /// Ends the status line.
  ~LiveReporter();
  LiveReporter(const LiveReporter&) = delete;
  LiveReporter& operator=(const LiveReporter&) = delete;

  /// To be called several times a second.
  void update(const runtime::RuntimeStatus& status, hal::TimePoint now);
  /// Clears the status line, before other output.
  void interrupt();

 private:
  void reportCamera(const runtime::RuntimeStatus& status);
  void reportPainting(const runtime::RuntimeStatus& status);
  void reportOutputs(const runtime::RuntimeStatus& status);
  const runtime::OutputStage::Status* lastStatusOf(const std::string& output) const;
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
  std::string lastWarning_;  ///< of the camera's stream
  std::string lastRefusal_;
};

}  // namespace pleinair::app
