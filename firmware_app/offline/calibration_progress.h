#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "pipeline/calibration/view_selection.h"

namespace pleinair::app {

/// The lines of the panel: the cells of the image with the number of views that reach each (. none,
/// o one, O more), beside them the state and the outcome of the last picture, below them the next
/// step.
std::vector<std::string> coveragePanel(const calibration::ViewSelector& selector,
                                       calibration::ViewOutcome last);

/// Shows the progress of a calibration on standard error: the panel on a terminal, else a line
/// every few seconds after a change. One thread.
class CalibrationProgress {
 public:
  explicit CalibrationProgress(const hal::Clock& clock);
  /// After each picture.
  void advance(const calibration::ViewSelector& selector, calibration::ViewOutcome outcome);
  /// Clears the panel before other output.
  void interrupt();

 private:
  void draw(const std::vector<std::string>& lines);
  void tell(const calibration::ViewSelector& selector);

  const hal::Clock& clock_;
  hal::TimePoint told_;
  bool isTerminal_;
  std::size_t drawnLines_ = 0;
  std::string lastLine_;
};

}  // namespace pleinair::app
