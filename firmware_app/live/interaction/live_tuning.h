#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
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

/// A style that can be chosen while painting goes on.
struct LiveStyle {
  std::string name;
  PaintParameters start;  ///< its parameter set at first
  std::vector<DebugView> views;
  std::vector<LiveLook> looks;
};

/// The requests of a user, made by keys or by closing the window.
struct LiveRequests {
  bool quit = false;
  bool snapshot = false;
  bool saveLook = false;
  bool commandLine = false;  ///< the command line that repeats what is seen
  bool tuned = false;        ///< parameters, debug view, look or style may have changed
};

/// Changes the parameters of a live painting by keys: keys in, parameter sets out. One thread.
class LiveTuning {
 public:
  /// The effect of a key that LiveTuning does not handle itself.
  enum class Request {
    kUnknownKey,  ///< the key has no meaning
    kNone,        ///< the key was handled
    kSnapshot,
    kSaveLook,
    kCommandLine,
    kFullScreen,
    kQuit,
  };

  /// `first`: the style to begin with. Each keeps what was tuned while another one is chosen.
  /// Precondition: there are styles.
  explicit LiveTuning(std::vector<LiveStyle> styles, std::size_t first = 0);

  Request press(const hal::KeyPressed& key);
  /// Sees every key first, and returns whether it has handled it: a procedure that is carried out.
  using KeyFilter = std::function<bool(const hal::KeyPressed&)>;
  /// `help`: its keys, as help() has them.
  void setKeyFilter(KeyFilter filter, std::string help) {
    filter_ = std::move(filter);
    filterHelp_ = std::move(help);
  }

  /// Shows the camera's picture, or, where that is shown, the finished picture again.
  void toggleCamera();
  /// Replaces all parameters and the debug view, as at the start; the choice of a parameter stays.
  /// Precondition: one of the styles has this name, and the parameters are its own.
  void setParameters(const std::string& style, PaintParameters parameters);
  /// The parameter set for the next frame, and its style.
  const PaintParameters& parameters() const { return style().parameters; }
  const std::string& styleName() const { return style().name; }
  bool isPaused() const { return isPaused_; }
  bool showsHelp() const { return showsHelp_; }

  /// The options of `pleinair run` that paint as now: --style, --look, --set and --view.
  std::vector<std::string> arguments() const;
  /// The values in force as a look file.
  std::string lookFile() const;

  /// "watercolor · wash, changed · view cells · paused".
  std::string state() const;
  /// The chosen parameter with its value, range and help; or that there is none.
  std::string parameterLine() const;
  /// The list of keys, those of a filter first: a line for each, in two columns separated by a tab.
  std::string help() const;

 private:
  struct Style {
    explicit Style(LiveStyle given);
    /// The look whose values are in force, if there is one.
    void findLook();

    std::string name;
    PaintParameters parameters;
    std::vector<std::string> views;  ///< the first is empty: the finished picture
    std::vector<LiveLook> looks;
    std::optional<std::size_t> look;
    std::vector<std::size_t> given;    ///< those that the configuration gave, beside the look
    std::vector<std::size_t> tunable;  ///< indices into the style's list
    std::size_t chosen = 0;            ///< index into tunable
  };

  const Style& style() const { return styles_.at(current_); }
  Style& style() { return styles_.at(current_); }
  Request pressOnce(const hal::KeyPressed& key);
  bool pressHeld(const hal::KeyPressed& key);
  void choose(int direction);
  void change(int direction, bool large);
  void resetParameter();
  void cycleView(int direction);
  void cycleLook(int direction);
  void cycleStyle(int direction);
  /// The look's values, or the style's defaults if no look is chosen.
  const config::ParameterValue& baseAt(std::size_t index) const;

  std::vector<Style> styles_;
  std::size_t current_ = 0;
  bool isPaused_ = false;
  bool showsHelp_ = false;
  KeyFilter filter_;
  std::string filterHelp_;
};

}  // namespace pleinair::app
