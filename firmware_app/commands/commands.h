#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/cli/board_option.h"
#include "firmware_app/config/configuration.h"
#include "firmware_app/offline/painting.h"
#include "firmware_app/sheets/printed_page.h"
#include "hal/clock.h"
#include "pipeline/measure/input/moved_photograph.h"
#include "pipeline/measure/input/walking_cutout.h"

namespace pleinair::app {

struct CalibrateOptions {
  ConfigurationRequest configuration;
  BoardOption board;
  std::optional<std::filesystem::path> input;  ///< a recording; unset: the camera of [camera]
  std::filesystem::path output;
  std::optional<std::uint64_t> frames;
  std::optional<std::filesystem::path> viewsFolder;
};

/// Calibrates a camera's lens from views of a board: `pleinair calibrate`. A recording is examined
/// frame by frame; a camera until the views suffice, --frames is reached, or a signal comes, after
/// which the views so far are used. Throws hal::Failure, also for an untrustworthy calibration, and
/// config::ConfigError. Returns the exit status: 0, or 128 + the signal that interrupted a
/// recording. The output is written completely or not at all. An existing calibration is replaced,
/// with a note; any other existing file is refused.
int calibrate(const CalibrateOptions& options);

struct ConfigOptions {
  ConfigurationRequest configuration;
  bool givenOnly = false;  ///< leave default values out
};

/// Prints the effective configuration as TOML, with the origin and the allowed range of each value:
/// `pleinair config`. Throws config::ConfigError. Returns the exit status.
int printConfiguration(const ConfigOptions& options);

struct DevicesOptions {
  ConfigurationRequest configuration;
  bool modes = false;  ///< cameras alone, and the mode that each would take for the configuration
  bool json = false;
};

/// Prints the available cameras and outputs, with ids and formats: `pleinair devices`. Cameras are
/// opened for their modes only.
int listDevices(const DevicesOptions& options);

struct DoctorOptions {
  ConfigurationRequest configuration;
  bool json = false;
};

/// Checks this machine and prints the findings, each failed check with the command that fixes it:
/// `pleinair doctor`. Returns 0 unless a check failed, also with warnings; else 1.
int examineMachine(const DoctorOptions& options);

struct MeasureOptions {
  ConfigurationRequest configuration;
  std::optional<std::filesystem::path> input;    ///< default: the synthetic camera
  std::optional<std::filesystem::path> motion;   ///< file with the motion of a recording
  measure::PhotographMotion photograph;          ///< motion of a photograph
  std::optional<measure::WalkerOptions> walker;  ///< what walks past a photograph
  bool standing = false;                         ///< the camera stands
  bool imageSpace = false;                       ///< models are painted as part of a plain video
  std::string movedBy;                           ///< "--pan", "--walker" …; empty: none was given
  double noiseLevels = 2.0;
  std::optional<std::uint64_t> frames;
  std::optional<std::uint64_t> settle;
  bool gates = false;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> html;
  std::filesystem::path shaderDirectory;  ///< overrides embedded shaders; empty: none
};

/// Paints a sequence of known motion and prints how coherent the painting is: `pleinair measure`.
/// Throws hal::Failure and config::ConfigError. Returns the exit status: 0; 1 if --gates was given
/// and a gate failed; 2 if a negative control failed; or 128 + the signal that interrupted it.
int runMeasure(const MeasureOptions& options);

struct RecordOptions {
  ConfigurationRequest configuration;
  std::filesystem::path output;
  std::uint64_t frames = 150;
  std::optional<std::filesystem::path> writeScene;
  bool lossless = false;  ///< to the bit, with what the camera says of each frame, to .mkv
};

/// Records [camera]'s camera to a movie or pictures, unpainted: `pleinair record`. Throws
/// hal::Failure and config::ConfigError. Returns the exit status, as render() does.
int record(const RecordOptions& options);

struct RenderOptions {
  ConfigurationRequest configuration;
  std::vector<std::filesystem::path> inputs;  ///< at least one
  hal::Duration from{0};                      ///< the part of the recording (hal::RecordingOptions)
  std::optional<hal::Duration> to;
  bool keepsSound = true;
  std::string step;  ///< of [procedure]'s: id or number; empty: one after the other
  double secondsPerStep = 4.0;
  std::string crf;  ///< as it was given, until the codec is known
  /// The options that are not configuration. "{name}" in its output, poses and contact sheet
  /// stands for the input's name.
  PaintingOptions painting;
};

/// Paints recordings, every frame, one after the other: `pleinair render`. Of several, one that
/// fails is reported, and the next one is painted. Throws hal::Failure (for a single one) and
/// config::ConfigError. Returns the exit status: 0, that of the first failure, or 128 + the signal
/// that interrupted it. What is kept then is said at runPainting().
int render(const RenderOptions& options);

struct RunOptions {
  ConfigurationRequest configuration;
  std::vector<std::string> outputs;     ///< as they were given
  std::optional<std::uint64_t> frames;  ///< default: until the user ends it
  std::filesystem::path shaderDirectory;
  std::string program;                                ///< version of this program, for records
  std::optional<std::filesystem::path> provisioning;  ///< a folder with a site.toml
  std::optional<std::filesystem::path> notice;        ///< a text for people, which may change
};

/// Paints a camera live: `pleinair run`. Throws hal::Failure and config::ConfigError. Returns the
/// exit status: 0, also after a signal.
int run(const RunOptions& options);

struct RescueOptions {
  ConfigurationRequest configuration;  ///< where the picture is shown; may be wrong
  std::string title = "The painting will be back soon";
  std::string detail;
  std::filesystem::path file;  ///< where the picture is written instead of shown; empty: nowhere
  std::optional<hal::Duration> time;  ///< default: until a signal
  /// Twice as long each time, as RescueBackOff, where a service manager gives a folder.
  bool backsOff = false;
  bool isProvisioned = false;  ///< by the last good site file of `pleinair run`
};

/// Shows a picture with a text on the displays of the configuration, drawn by the processor:
/// `pleinair rescue`. A configuration that is wrong is shown as the text. Throws hal::Failure for a
/// display that can be none. Returns 0, after the time or a signal. Where a file is named, the
/// picture, of 1280x720 px, is written there instead, and errors are those of writing.
int showRescue(const RescueOptions& options);

struct LooksOptions {
  std::filesystem::path input;      ///< a picture, or a movie
  hal::Duration at{0};              ///< the moment of a movie
  std::filesystem::path output;     ///< PNG
  std::vector<std::string> styles;  ///< empty: all that have looks
};

/// Paints one picture in every look of every style, and writes them on one sheet with their names:
/// `pleinair looks`. Throws hal::Failure. Returns the exit status: 0, or 128 + the signal that
/// interrupted it, after which there is no sheet.
int showLooks(const LooksOptions& options);

struct SceneCheckOptions {
  std::filesystem::path scene;
  std::optional<std::filesystem::path> input;   ///< a recording in which its tags are
  std::optional<std::filesystem::path> output;  ///< PNG; with an input
};

/// Prints what a scene file places where, and its likely mistakes, each with a remedy:
/// `pleinair scene check`. With a recording, tracks it, and writes a sheet of frames with tag
/// edges, axes and the models drawn over them. Throws hal::Failure and config::ConfigError. Returns
/// the exit status: 0; 1 with mistakes; or 128 + the signal that interrupted it.
int checkScene(const SceneCheckOptions& options);

struct TagsOptions {
  std::filesystem::path sheet;  ///< PDF
  PaperSize paper;
  std::optional<std::filesystem::path> scene;  ///< whose tags are printed; else `ids`
  std::string family{"tag36h11"};
  std::vector<int> ids{0};
  double edgeMetres = 0.12;
  std::optional<BoardOption> board;  ///< a calibration board instead of tags
};

/// Writes tags, or a calibration board, as a PDF at their true sizes, with rulers, and prints what
/// a scene says of the tags: `pleinair tags`. Throws hal::Failure and config::ConfigError.
int printTags(const TagsOptions& options);

struct WarmUpOptions {
  ConfigurationRequest configuration;  ///< its scene and size are painted too
  std::vector<std::string> styles;     ///< empty: all
};

/// Has the driver compile the programs of the styles, in all looks, quality levels and debug views,
/// into its shader cache, which later runs of the same user start from: `pleinair warm-up`. Throws
/// hal::Failure and config::ConfigError. Returns the exit status: 0, or 128 + the signal that
/// interrupted it; what was compiled until then is kept.
int warmUpShaders(const WarmUpOptions& options);

struct ThesisOptions {
  std::filesystem::path output;   ///< the report's folder
  bool quick = false;             ///< small and short
  std::vector<std::string> only;  ///< names of figures; empty: all
};

/// Makes the thesis's figures with built-in films and models, measures them, and writes a page with
/// its pictures, and the numbers as JSON: `pleinair thesis`. Throws hal::Failure. Returns the exit
/// status: 0; 2 if a negative control of a film failed; or 128 + the signal that interrupted it,
/// after which there is no page.
int makeThesisReport(const ThesisOptions& options);

/// Lists the styles with their looks, parameters and debug views, without a GPU: `pleinair styles`.
int listStyles();

}  // namespace pleinair::app
