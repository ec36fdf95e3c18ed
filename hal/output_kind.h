#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/output.h"

namespace pleinair::hal {

/// Properties of a kind of outputs on which the program depends. It never depends on a kind's name.
struct OutputTraits {
  /// Shows each picture at its due time. Otherwise it takes all of them, as soon as they come.
  bool isPaced = false;
  /// A device that may come back: it is opened again after it has failed.
  bool reopens = false;
  /// Its target is a path, which is written to. Offline painting goes to these only.
  bool writesFiles = false;
  /// It has to be used on the main thread, as windows have.
  bool isOnMainThread = false;
  /// All that people see of the program: it shows a waiting picture while there is no painting, and
  /// can be reconfigured. It lends surfaces that can be mapped, or takes RGBA8 in memory.
  bool showsWaiting = false;
  /// A screen without a desktop, with nothing behind it: it is opened before the camera; keys come
  /// from keyboards, and consoles take turns on it.
  bool isOnConsole = false;
};

/// A setting that outputs of a kind have: a key of [output.KIND]. A switch, one of some words, or a
/// text.
struct OutputOption {
  std::string name;
  std::string help;
  bool isSwitch = false;             ///< "false", the default, or "true"
  std::vector<std::string> choices;  ///< the first is the default; empty: a switch or a text
  // The members below describe a text.
  std::string initial;                        ///< the default
  std::string allowed;                        ///< for messages: "auto, or 1920x1080"
  bool (*takes)(std::string_view) = nullptr;  ///< whether it may be that
};

/// The values of a kind's options, by name. One that is missing has its default.
using OutputOptions = std::map<std::string, std::string, std::less<>>;

/// An output that is present, as its kind describes it.
struct OutputDescription {
  std::string target;                ///< an argument of --output: "loopback:/dev/video50"
  std::string name;                  ///< "pleinair", a card's label; empty where it has none
  std::vector<std::string> formats;  ///< that a device takes: fourccs
  bool isBusy = false;               ///< another program has it
  std::string scanOut;           ///< how pictures reach a display's memory; empty: not found out
  std::optional<Error> problem;  ///< why it could not be looked at
};

/// The outputs of a kind that are there.
struct OutputListing {
  std::vector<OutputDescription> outputs;
  std::optional<Error> problem;  ///< why there is none, and what to do
};

/// A kind of outputs: a folder under hal/outputs exports one, and hal/outputs/registry.cpp lists
/// it. Constant; the functions may be called on any thread, one at a time.
struct OutputKind {
  std::string name;  ///< "loopback"
  std::string help;  ///< one line
  /// How a target is written, for help and messages: "loopback", "loopback:DEVICE". Words in
  /// capitals stand for something else. Without a word of its own (files): "movie.mp4".
  std::vector<std::string> forms;
  OutputTraits traits;
  std::vector<OutputOption> options;
  /// Whether a target is of this kind. Looks at files, opens no device.
  bool (*recognizes)(const std::string& target);
  /// The outputs that are there; null for files, which are made.
  OutputListing (*list)();
  /// Why a target cannot be opened now, found out as start() does it, but no format is negotiated;
  /// null where there is nothing to open.
  std::optional<Error> (*problemOf)(const std::string& target);
  /// Makes one; opens nothing before its start(). Errors: kInvalidArgument (a malformed target or
  /// option), kNotFound (there is no display), kUnsupported (this build lacks it).
  Result<std::unique_ptr<Output>> (*make)(const std::string& target, const OutputOptions& options);
};

}  // namespace pleinair::hal
