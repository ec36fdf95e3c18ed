#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "firmware_app/cli/board_option.h"
#include "firmware_app/config/configuration.h"
#include "firmware_app/offline/painting.h"
#include "pipeline/measure/input/moved_photograph.h"

namespace pleinair::app {

struct CalibrateOptions {
  ConfigurationRequest configuration;
  BoardOption board;
  std::optional<std::filesystem::path> input;  ///< a recording; else [camera]'s camera
  std::filesystem::path output;
  std::optional<std::uint64_t> frames;
  std::optional<std::filesystem::path> viewsFolder;
};

/// Finds a camera's lens from views of a board: `pleinair calibrate`. A recording is looked at
/// frame by frame; a camera until the views suffice, --frames are over or a signal comes, which
/// then uses what there is. Throws hal::Failure, for a calibration that is not to be trusted
/// too, and config::ConfigError. Returns the exit status: 0, or 128 + the signal that broke off a
/// recording. The output is written whole or not at all; a calibration that stood there is
/// replaced, and said so; any other file is refused.
int calibrate(const CalibrateOptions& options);

struct ConfigOptions {
  ConfigurationRequest configuration;
  bool givenOnly = false;  ///< leave out what nobody gave
};

/// Prints what is in force, where each value came from and what is allowed, as TOML: `pleinair
/// config`. Throws config::ConfigError. Returns the exit status.
int printConfiguration(const ConfigOptions& options);

struct DevicesOptions {
  bool json = false;
};

/// Prints the cameras and outputs that are there, with ids and formats: `pleinair devices`.
int listDevices(const DevicesOptions& options);

struct DoctorOptions {
  ConfigurationRequest configuration;
  bool json = false;
};

/// Prints what works on this machine, what does not, and what fixes it: `pleinair doctor`. Gives 0
/// where nothing is wrong, warnings or not, else 1.
int examineMachine(const DoctorOptions& options);

struct MeasureOptions {
  ConfigurationRequest configuration;
  std::optional<std::filesystem::path> input;   ///< default: the synthetic camera
  std::optional<std::filesystem::path> motion;  ///< how a recording moves
  measure::PhotographMotion photograph;         ///< how a photograph is moved
  std::string movedBy;                          ///< "--pan", "--still" …; empty: by none
  double noiseLevels = 2.0;
  std::optional<std::uint64_t> frames;
  std::optional<std::uint64_t> settle;
  bool gates = false;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> html;
};

/// Paints a sequence of which the motion is known and prints how coherent the painting is:
/// `pleinair measure`. Throws hal::Failure and config::ConfigError. Returns the exit status:
/// 0; 1 where a gate was asked for and not passed; 2 where the controls do not read as they must;
/// or 128 + the signal that broke it off.
int runMeasure(const MeasureOptions& options);

struct RecordOptions {
  ConfigurationRequest configuration;
  std::filesystem::path output;
  std::uint64_t frames = 150;
  std::optional<std::filesystem::path> writeScene;
};

/// Records [camera]'s camera to a movie or pictures, unpainted: `pleinair record`. Throws
/// hal::Failure and config::ConfigError. Returns the exit status, as render() does.
int record(const RecordOptions& options);

struct RenderOptions {
  ConfigurationRequest configuration;
  std::filesystem::path input;
  PaintingOptions painting;  ///< of one run alone; the rest is configuration
};

/// Paints a recording, frame by frame, none dropped: `pleinair render`. Throws hal::Failure
/// and config::ConfigError. Returns the exit status: 0, or 128 + the signal that broke it off.
/// Then, or after a failure, nothing stands under the output's name, but a folder or a pattern
/// keeps the whole frames that were written so far.
int render(const RenderOptions& options);

struct RunOptions {
  ConfigurationRequest configuration;
  std::optional<std::uint64_t> frames;  ///< default: until someone ends it
  std::filesystem::path shaderDirectory;
};

/// Paints a camera live: `pleinair run`. Throws hal::Failure and config::ConfigError. Returns
/// the exit status: 0, also where a signal ended it.
int run(const RunOptions& options);

/// Lists the styles with their looks, parameters and views, without a GPU: `pleinair styles`.
int listStyles();

}  // namespace pleinair::app
