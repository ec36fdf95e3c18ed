#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/parameter_values.h"
#include "hal/key_pressed.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {

/// A look that can be chosen while painting goes on.
struct LiveLook {
  std::string name;
  config::ParameterValues values;
};

/// The requests of a user, made by keys or by closing the window.
struct LiveRequests {
  bool quit = false;
  bool snapshot = false;
  bool tuned = false;  ///< parameters, debug view or look may have changed
};

/// Changes the parameters of a live painting by keys: keys in, parameter sets out. One thread.
class LiveTuning {
 public:
  /// The effect of a key that LiveTuning does not handle itself.
  enum class Request {
    kUnknownKey,  ///< the key has no meaning
    kNone,        ///< the key was handled
    kSnapshot,
    kFullScreen,
    kQuit,
  };

  /// `start`: the first parameter set. `style`: its name, for captions.
  LiveTuning(std::string style, PaintParameters start, const std::vector<DebugView>& views,
             std::vector<LiveLook> looks);

  Request press(const hal::KeyPressed& key);

  /// The parameter set for the next frame.
  const PaintParameters& parameters() const { return parameters_; }
  bool isPaused() const { return isPaused_; }
  bool showsHelp() const { return showsHelp_; }

  /// "watercolor · wash, changed · view cells · paused".
  std::string state() const;
  /// The chosen parameter with its value, range and help; or that there is none.
  std::string parameterLine() const;
  /// The list of keys: a line for each, in two columns separated by a tab.
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
  std::vector<std::string> views_;  ///< the first is empty: the finished picture
  std::vector<LiveLook> looks_;
  std::optional<std::size_t> look_;
  std::vector<std::size_t> tunable_;  ///< indices into the style's list
  std::size_t chosen_ = 0;            ///< index into tunable_
  bool isPaused_ = false;
  bool showsHelp_ = false;
};

}  // namespace pleinair::app
