#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/parameter_values.h"
#include "hal/outputs/window/window.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {

/// A look that can be put on while pictures run.
struct LiveLook {
  std::string name;
  config::ParameterValues values;
};

/// Changes the parameters of a running painting by keys: keys in, parameter sets out. One thread.
class LiveTuning {
 public:
  /// What a key asks of others.
  enum class Request {
    kUnknownKey,  ///< nothing; it means nothing here
    kNone,        ///< nothing; it was about the parameters
    kSnapshot,
    kFullScreen,
    kQuit,
  };

  /// Starts from `start`; `style` is for the captions.
  LiveTuning(std::string style, PaintParameters start, const std::vector<DebugView>& views,
             std::vector<LiveLook> looks);

  Request press(const hal::KeyPressed& key);

  /// To paint the next frame with.
  const PaintParameters& parameters() const { return parameters_; }
  bool isPaused() const { return isPaused_; }
  bool showsHelp() const { return showsHelp_; }

  /// "watercolor · wash, changed · view cells · paused".
  std::string state() const;
  /// The chosen parameter with its value, range and help; or why there is none.
  std::string parameterLine() const;
  /// A line a key, in two columns.
  static std::string help();

 private:
  Request pressOnce(const hal::KeyPressed& key);
  bool pressHeld(const hal::KeyPressed& key);
  void choose(int direction);
  void change(int direction, bool large);
  void resetParameter();
  void cycleView(int direction);
  void cycleLook(int direction);

  std::string style_;
  PaintParameters parameters_;
  std::vector<std::string> views_;  ///< the first is the finished picture's: empty
  std::vector<LiveLook> looks_;
  std::optional<std::size_t> look_;
  std::vector<std::size_t> tunable_;  ///< indices into the style's list
  std::size_t chosen_ = 0;            ///< index into tunable_
  bool isPaused_ = false;
  bool showsHelp_ = false;
};

}  // namespace pleinair::app
