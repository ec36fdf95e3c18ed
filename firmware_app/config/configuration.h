#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/parameter_values.h"
#include "config/sections.h"
#include "hal/camera_kind.h"
#include "hal/error.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {

/// [camera]
struct CameraSettings {
  std::filesystem::path source = "synthetic";  ///< or a recording
  bool wait = false;                           ///< for a camera where there is none at the start
  config::PixelSize size{640, 480};            ///< made, or asked of a device, as the rate
  double framesPerSecond = 30.0;
  bool isMounted = false;           ///< tracking::ImageMotionOptions::isMounted
  std::string exposure = "device";  ///< of a device (control_text.h), as the next three
  std::string gain = "device";
  std::string focus = "device";
  std::string whiteBalance = "device";
  /// The tables of the kinds of cameras, such as [camera.synthetic], by the kind's name. One that
  /// is missing is at its defaults.
  std::map<std::string, config::ParameterValues, std::less<>> tables;

  const config::ParameterValues& tableOf(const hal::CameraKind& kind) const;
};

/// [painting]
struct PaintingSettings {
  std::string style = "watercolor";
  std::filesystem::path look = "default";  ///< a look's name, or a look file
  std::string view = "finished";
  config::PixelSize size;  ///< 0x0: the camera's
  std::filesystem::path scene = "none";
};

/// [output]
struct OutputSettings {
  std::vector<std::filesystem::path> targets{"window"};  ///< as of hal::openOutput()
  std::filesystem::path snapshots = ".";                 ///< the folder that snapshots are saved to
  bool wait = false;                                     ///< for one that is not there at the start
  bool waitingPictures = true;       ///< on displays, while there is no painting
  bool keepsLastPainting = true;     ///< of displays, for the first picture of the next run
  hal::OutputOptionsByKind options;  ///< [output.KIND]
};

/// [input]
struct InputSettings {
  std::string keyboards = "auto";  ///< hal::KeyboardChoice::parsed()
  bool grab = false;
  std::filesystem::path map = "none";  ///< the file that readInputMap() reads
};

/// [runtime]
struct RuntimeSettings {
  double latencyMs = 120;  ///< from capture to being shown
  double maxLatencyMs = 400;
  std::string quality = "auto";  ///< or a level that is kept
  double rate = 0;               ///< frames a second that quality is lowered for; 0: the camera's
  double heatMargin = 5;         ///< K to the machine's limit that quality is lowered at; 0: never
  std::filesystem::path frameLog = "none";  ///< the file that FrameLogFile writes
};

/// [procedure]
struct ProcedureSettings {
  std::filesystem::path folder = "none";
  std::string language = "default";        ///< the procedure's first
  std::string machine = "auto";            ///< the model of the scene that it is about
  std::string inset = "auto";              ///< when the step is drawn from the model: or "always"
  std::filesystem::path records = "none";  ///< the folder that records go to
  std::string operatorName = "unnamed";
  std::string workOrder = "none";
  std::string stills = "checks";  ///< or "steps": before and after each, too
};

/// [status]
struct StatusSettings {
  std::string listen = "off";                ///< or ADDRESS:PORT
  std::filesystem::path tokenFile = "none";  ///< of those who may send commands
};

/// A key that an option of the command line gives.
struct OptionValue {
  std::string key;  ///< "painting.style"
  std::string text;
  std::string option;  ///< "--style"
};

/// Where a configuration comes from.
struct ConfigurationRequest {
  std::optional<std::string> profile;             ///< --profile: a name or a file
  std::optional<std::filesystem::path> siteFile;  ///< --config
  std::optional<std::string> siteText;            ///< in place of that file's content
  std::vector<OptionValue> options;
  std::vector<std::string> set;                          ///< --set: "cell_size=8", "camera.rate=15"
  std::vector<config::EnvironmentVariable> environment;  ///< all that begin with PLEINAIR_
  std::filesystem::path defaultSiteFile = "/etc/pleinair/site.toml";
};

/// The variables of this process that begin with PLEINAIR_.
std::vector<config::EnvironmentVariable> environmentOfProcess();

/// The values in force and their origins. Immutable; one thread at a time.
class Configuration {
 public:
  /// Lays over the defaults: the profile, the site file, the environment, the command line; a look
  /// goes right above the defaults of its style, whichever layer names it. A layer that changes the
  /// style drops the look and the view that a weaker one named, for they are the former style's. A
  /// look file (look_file.h) chooses its style, too.
  ///
  /// The site file is --config's, else PLEINAIR_CONFIG's (empty: none), else the default one where
  /// there is one. The profile is --profile's, PLEINAIR_PROFILE's or the site file's.
  ///
  /// Throws config::ConfigError, which names the place, for whatever is wrong or unknown in any
  /// layer, in force or not.
  explicit Configuration(const ConfigurationRequest& request);

  CameraSettings camera() const;
  PaintingSettings painting() const;
  OutputSettings output() const;
  InputSettings input() const;
  RuntimeSettings runtime() const;
  ProcedureSettings procedure() const;
  StatusSettings status() const;
  /// The parameters of the style in force.
  const config::ParameterValues& styleParameters() const;
  /// Those of a style, in force or not. Precondition: there is one of this name.
  const config::ParameterValues& parametersOfStyle(std::string_view style) const;

  const std::string& origin(std::string_view key) const { return sections_.origin(key); }
  /// The keys whose values differ from those of `other`, with their sections.
  std::vector<std::string> keysUnlike(const Configuration& other) const;
  /// The profile, the site file and the look file, where there are any: nothing may be written over
  /// them.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  /// As of `pleinair config`.
  std::string toToml(config::Printed which) const;

  /// Blames the place that gave the value of a key, as Sections::errorAt().
  config::ConfigError errorAt(std::string_view key, std::string problem, std::string allowed) const;

  /// Runs `action`, which uses what is in force. An error that it throws of a file which a profile,
  /// a site file or the environment named is told with the place that named it.
  template <class Action>
  auto attributing(Action&& action) const {
    try {
      return std::forward<Action>(action)();
    } catch (const hal::Failure& error) {
      throw hal::Failure(attributed(error.error()));
    } catch (const config::ConfigError& error) {
      throw attributed(error);
    }
  }

 private:
  /// The key that gave the path, unless nobody or the command line did, whose errors need no more.
  std::optional<std::string> keyThatNamed(const std::string& path) const;
  hal::Error attributed(hal::Error error) const;
  config::ConfigError attributed(const config::ConfigError& error) const;

  config::Sections sections_;
  config::Sections given_;  ///< without the look's values
  std::vector<std::filesystem::path> files_;
};

}  // namespace pleinair::app
