#include "firmware_app/subcommand_options.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/parameter.h"
#include "config/profiles.h"
#include "config/suggestion.h"
#include "firmware_app/cli/option_values.h"
#include "firmware_app/commands/commands.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

/// Adds an option that sets a key of the configuration. The configuration validates the value.
CLI::Option* addKey(CLI::App& command, ConfigurationRequest& request, const std::string& option,
                    const std::string& key, const std::string& help, const std::string& type) {
  return command
      .add_option_function<std::string>(
          option,
          [&request, option, key](const std::string& text) {
            request.options.push_back({key, text, option});
          },
          help)
      ->type_name(type);
}

/// Adds the options that select the configuration's sources.
void addConfiguration(CLI::App& command, ConfigurationRequest& request) {
  command
      .add_option("--profile", request.profile,
                  fmt::format("the base configuration: {}, or a file (.toml)",
                              config::listText(config::profileNames())))
      ->type_name("NAME|FILE");
  command
      .add_option("--config", request.siteFile,
                  fmt::format("the site file (default: ${}, else {} if it exists)",
                              "PLEINAIR_CONFIG", request.defaultSiteFile.string()))
      ->type_name("FILE");
  command
      .add_option("--set", request.set,
                  "a parameter of the style, such as cell_size=12, or any other key, such as "
                  "camera.rate=15; `pleinair config` lists them")
      ->type_name("NAME=VALUE")
      ->take_all();
}

/// Adds the options of [painting], for subcommands that paint.
void addPainting(CLI::App& command, ConfigurationRequest& request) {
  addKey(command, request, "--style", "painting.style", "the style; `pleinair styles` lists them",
         "NAME");
  addKey(command, request, "--look", "painting.look", "a preset of the style's parameters", "NAME");
  addKey(command, request, "--view", "painting.view", "a debug view instead of the finished image",
         "NAME");
  addKey(command, request, "--scene", "painting.scene", "tags and models (TOML)", "FILE");
  addConfiguration(command, request);
}

CLI::Option* addFrames(CLI::App& command, std::function<void(std::uint64_t)> assign,
                       const std::string& help) {
  return command
      .add_option_function<std::string>(
          "--frames",
          [assign = std::move(assign)](const std::string& text) { assign(frameCountOf(text)); },
          help)
      ->type_name("N");
}

/// The part of a recording, or one moment.
void addPart(CLI::App& command, RenderOptions& options) {
  const auto add = [&command](const std::string& name, const std::string& help, auto assign) {
    return command
        .add_option_function<std::string>(
            name, [name, assign](const std::string& text) { assign(timeOf(name, text)); }, help)
        ->type_name("TIME");
  };
  CLI::Option* from = add("--from", "begin here, such as 12.5 or 1:02.5, in the recording's time",
                          [&options](hal::Duration time) { options.from = time; });
  CLI::Option* to =
      add("--to", "end before this time", [&options](hal::Duration time) { options.to = time; });
  add("--at", "paint one frame only: the first at or after this time",
      [&options](hal::Duration time) {
        options.from = time;
        options.painting.frames = 1;
      })
      ->excludes(from)
      ->excludes(to)
      ->excludes(command.get_option("--frames"));
}

void addRender(CLI::App& app, RenderOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("render", "paint a recording: every frame, none dropped");
  command
      .add_option(
          "--input", options.input,
          "movie, Y4M, folder, one picture, a pattern such as in/%04d.png, or - for a movie "
          "on standard input")
      ->required()
      ->type_name("PATH");
  command
      .add_option(
          "--output", options.painting.output,
          "movie (.mp4, .mkv), .y4m, one .png, a folder, a pattern such as out/%04d.png, or "
          "- for Y4M on standard output")
      ->required()
      ->type_name("PATH");
  addPainting(command, options.configuration);
  addKey(command, options.configuration, "--size", "painting.size",
         "size of the painting (default: the input's); movies need even sides", "WxH");
  addFrames(
      command, [&options](std::uint64_t count) { options.painting.frames = count; },
      "paint the first N frames only");
  addPart(command, options);
  command.add_flag_callback(
      "--no-sound", [&options] { options.keepsSound = false; },
      "leave the sound of a movie out; it is kept as it is coded where the output can hold it");
  command
      .add_option_function<std::string>(
          "--crf",
          [&options](const std::string& text) {
            options.painting.movie.crf = numberOf("--crf", text, "", 0, 51);
          },
          "quality of .mp4 and .mkv: 0 to 51, less is better and larger (default: 18)")
      ->type_name("N");
  command
      .add_option("--poses", options.painting.poses,
                  "write the tracking results, one JSON object per frame")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  command
      .add_option("--contact-sheet", options.painting.contactSheet,
                  "write a PNG that shows originals and paintings side by side")
      ->check(requirePngName)
      ->type_name("FILE");
  command
      .add_option("--shaders", options.painting.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return render(options); }; });
}

/// "a window on the desktop (window); …; files as of render"
std::string outputHelp() {
  std::string help;
  std::vector<std::string> files;
  for (const hal::OutputKind& kind : hal::outputKinds()) {
    if (kind.traits.writesFiles) {
      std::ranges::copy(kind.forms, std::back_inserter(files));
    } else {
      help += fmt::format("{}: {}; ", fmt::join(kind.forms, ", "), kind.help);
    }
  }
  return fmt::format("{}or a path: {}. Default: window; may be given several times", help,
                     fmt::join(files, ", "));
}

/// --output, as often as wanted: the targets in their order.
void addOutputs(CLI::App& command, ConfigurationRequest& request) {
  const auto assign = [&request](const std::vector<std::string>& targets) {
    for (const std::string& target : targets) {
      if (const std::string refusal = refuseStandardOutput(target); !refusal.empty()) {
        throw CLI::ValidationError("--output: " + refusal);
      }
    }
    const std::vector<std::filesystem::path> list(targets.begin(), targets.end());
    request.options.push_back({"output.targets", config::textOfPaths(list), "--output"});
  };
  command.add_option_function<std::vector<std::string>>("--output", assign, outputHelp())
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME|PATH");
}

void addRun(CLI::App& app, RunOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("run", "paint a camera live");
  ConfigurationRequest& configuration = options.configuration;
  addKey(command, configuration, "--camera", "camera.source",
         "synthetic (default), auto, a device (see docs/cameras.md), or a recording's path, "
         "played in a loop at its own rate",
         "NAME|PATH");
  addOutputs(command, configuration);
  addPainting(command, configuration);
  addKey(command, configuration, "--size", "painting.size",
         "size of the painting (default: the camera's)", "WxH");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; }, "end after N frames");
  addKey(command, configuration, "--snapshots", "output.snapshots",
         "the folder that the key s saves pictures to (default: .)", "DIR");
  command
      .add_option("--shaders", options.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
  command.footer("In the window, h lists the keys.");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return run(options); }; });
}

void addRecord(CLI::App& app, RecordOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("record", "record a camera");
  ConfigurationRequest& configuration = options.configuration;
  addKey(command, configuration, "--camera", "camera.source", "as in run (default: synthetic)",
         "NAME|PATH");
  command.add_option("--output", options.output, "as in render")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("PATH");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; }, "record N frames")
      ->default_str(std::to_string(options.frames));
  addKey(command, configuration, "--size", "camera.size",
         "of the frames (default: 640x480); movies have even sides", "WxH");
  addKey(command, configuration, "--seed", "camera.synthetic.seed",
         "of the synthetic camera's world and path (default: 1)", "N");
  command
      .add_option("--write-scene", options.writeScene,
                  "write a scene file that fits the synthetic camera's world")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addConfiguration(command, configuration);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return record(options); }; });
}

void addBoard(CLI::App& command, BoardOption& board) {
  command
      .add_option("--board", board.kind,
                  "checkerboard:COLUMNSxROWS (inner corners) or aprilgrid:COLUMNSxROWS (tags)")
      ->required()
      ->type_name("KIND:CxR");
  command.add_option("--square", board.square, "side of a checkerboard's square")
      ->type_name("METRES");
  command.add_option("--tag-edge", board.tagEdge, "edge of an aprilgrid's tag, the black square")
      ->type_name("METRES");
  command
      .add_option("--spacing", board.spacing,
                  "gap between tags, as a share of a tag's edge (default: 0.3)")
      ->type_name("SHARE");
  command.add_option("--first-id", board.firstId, "id of the lower left tag (default: 0)")
      ->type_name("ID");
}

void addCalibrate(CLI::App& app, CalibrateOptions& options, std::function<int()>& chosen) {
  CLI::App& command =
      *app.add_subcommand("calibrate", "calibrate a camera's lens from views of a board");
  CLI::Option* camera = addKey(command, options.configuration, "--camera", "camera.source",
                               "as in run; ends when the views suffice, or at SIGINT", "NAME|PATH");
  command.add_option("--input", options.input, "a recording, as in render")
      ->excludes(camera)
      ->type_name("PATH");
  addBoard(command, options.board);
  command.add_option("--output", options.output, "the calibration (TOML)")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; },
      "use the first N frames only");
  command
      .add_option("--views-folder", options.viewsFolder,
                  "write the selected views with their corners, and the coverage")
      ->type_name("DIR");
  addKey(command, options.configuration, "--size", "camera.size",
         "frame size to request from a camera (default: 640x480)", "WxH");
  addConfiguration(command, options.configuration);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return calibrate(options); }; });
}

void addConfig(CLI::App& app, ConfigOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "config", "print the effective configuration, with the origin of each value");
  addPainting(command, options.configuration);
  addKey(command, options.configuration, "--camera", "camera.source", "as in run", "NAME|PATH");
  command.add_flag("--given", options.givenOnly, "leave default values out: a short site file");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return printConfiguration(options); }; });
}

void addDevices(CLI::App& app, DevicesOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("devices", "list the available cameras and outputs");
  command.add_flag("--json", options.json, "print JSON");
  command.callback([&] { chosen = [&options] { return listDevices(options); }; });
}

void addDoctor(CLI::App& app, DoctorOptions& options, std::function<int()>& chosen) {
  CLI::App& command =
      *app.add_subcommand("doctor", "check this machine, and show how to fix each failed check");
  command.add_flag("--json", options.json, "print JSON");
  addConfiguration(command, options.configuration);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return examineMachine(options); }; });
}

/// Adds the options of `measure` that move a photograph; they exclude `others`, which say how a
/// recording moves.
void addPhotographMotion(CLI::App& command, const std::vector<CLI::Option*>& others,
                         MeasureOptions& options) {
  CLI::Option* still = command.add_flag_callback(
      "--still", [&options] { options.movedBy = "--still"; },
      "show a photograph without motion, with sensor noise");
  for (CLI::Option* other : others) still->excludes(other);
  const auto add = [&](const std::string& name, const std::string& help, const std::string& type,
                       auto assign) {
    CLI::Option* option = command.add_option_function<std::string>(
        name,
        [&options, name, assign](const std::string& text) {
          assign(text);
          options.movedBy = name;
        },
        help);
    option->type_name(type)->excludes(still);
    for (CLI::Option* other : others) option->excludes(other);
  };
  measure::PhotographMotion& motion = options.photograph;
  add("--pan", "move a photograph by this many px per frame, such as -1.5,-0.5", "VX,VY",
      [&motion](const std::string& text) {
        const auto [x, y] = vectorOf("--pan", text, 40);
        motion.pan = {x, y};
      });
  add("--zoom", "zoom into a photograph by this share per frame, such as 1%", "PERCENT",
      [&motion](const std::string& text) {
        motion.zoomPercent = numberOf("--zoom", text, "%", -10, 10);
      });
  add("--roll", "turn a photograph by this many degrees per frame", "DEGREES",
      [&motion](const std::string& text) {
        motion.rollDegrees = numberOf("--roll", text, "", -45, 45);
      });
}

void addMeasure(CLI::App& app, MeasureOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "measure", "paint a sequence of known motion, and measure how coherent the painting is");
  CLI::Option* input =
      command
          .add_option("--input", options.input,
                      "a folder with motion.json or KITTI flow, a photograph with --pan, --zoom, "
                      "--roll or --still, or any recording")
          ->type_name("PATH");
  addKey(command, options.configuration, "--camera", "camera.source",
         "the workbench, whose motion is known (default: synthetic)", "synthetic:SHOT")
      ->excludes(input);
  CLI::Option* motion = command
                            .add_option("--motion", options.motion,
                                        "file with the motion of a recording (as motion.json)")
                            ->needs(input)
                            ->type_name("FILE");
  CLI::Option* standing = command
                              .add_flag("--standing", options.standing,
                                        "the camera stands: measure also what moves before it")
                              ->excludes(motion);
  command.add_flag("--image-space", options.imageSpace,
                   "paint the film with the models of --scene in it as a plain video, without "
                   "knowing the models, to compare");
  addPhotographMotion(command, {motion, standing}, options);
  command
      .add_option_function<std::string>(
          "--noise",
          [&options](const std::string& text) {
            options.noiseLevels = numberOf("--noise", text, "", 0, 40);
          },
          "sensor noise on a photograph and on the still scene, in 8-bit levels (default: 2)")
      ->type_name("SIGMA");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; },
      "measure N frames (default: all, or 60 of an endless input)");
  command
      .add_option_function<std::string>(
          "--settle",
          [&options](const std::string& text) {
            options.settle = frameCountOf(text, "--settle", 0);
          },
          "paint N frames before measuring (default: 0, or 30 with an endless input)")
      ->type_name("N");
  command.add_flag("--gates", options.gates, "exit with 1 unless the style passes its gates");
  command.add_option("--json", options.json, "write the report as JSON")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  command.add_option("--html", options.html, "write the report as one page, with plots")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addPainting(command, options.configuration);
  addKey(
      command, options.configuration, "--size", "painting.size",
      "size of a photograph's frames (default: its own, scaled down to 640x480 or as many px), of "
      "the workbench's, or of the painting of a recording of unknown motion",
      "WxH");
  addKey(command, options.configuration, "--quality", "runtime.quality",
         "the quality level to paint at (default: the best)", "NAME");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return runMeasure(options); }; });
}

void addThesis(CLI::App& app, ThesisOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "thesis", "make and measure the thesis's figures, with built-in films and models");
  command.add_option("--output", options.output, "the folder of the report: thesis.html")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("DIR");
  command.add_flag("--quick", options.quick, "small and short films: a trial of the report");
  command.add_option("--only", options.only, "only these figures, by the names of their files")
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return makeThesisReport(options); }; });
}

void addStyles(CLI::App& command, std::vector<std::string>& styles) {
  command
      .add_option("--style", styles, "only these styles; may be given several times (default: all)")
      ->allow_extra_args(false)
      ->type_name("NAME");
}

void addLooks(CLI::App& app, LooksOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "looks", "paint one picture in every look of every style, on one sheet with their names");
  command.add_option("--input", options.input, "a picture, or a movie")
      ->required()
      ->type_name("PATH");
  command
      .add_option_function<std::string>(
          "--at", [&options](const std::string& text) { options.at = timeOf("--at", text); },
          "the moment of a movie, such as 12.5 or 1:02.5 (default: its beginning)")
      ->type_name("TIME");
  command.add_option("--output", options.output, "the sheet, a PNG")
      ->required()
      ->check(requirePngName)
      ->type_name("FILE");
  addStyles(command, options.styles);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return showLooks(options); }; });
}

void addScene(CLI::App& app, SceneCheckOptions& options, std::function<int()>& chosen) {
  CLI::App& scene = *app.add_subcommand("scene", "check a scene file");
  scene.require_subcommand(1);
  CLI::App& command = *scene.add_subcommand(
      "check", "print what a scene file places where, and its likely mistakes");
  command.add_option("FILE", options.scene, "the scene (TOML)")->required()->type_name("");
  CLI::Option* input =
      command.add_option("--input", options.input, "a movie or picture in which its tags are seen")
          ->type_name("PATH");
  CLI::Option* output =
      command
          .add_option("--output", options.output,
                      "a PNG of some frames, with tags, axes and models drawn over them")
          ->check(requirePngName)
          ->needs(input)
          ->type_name("FILE");
  input->needs(output);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return checkScene(options); }; });
}

void addWarmUp(CLI::App& app, WarmUpOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "warm-up", "compile all shaders into the driver's cache, so that later starts are fast");
  addStyles(command, options.styles);
  addKey(command, options.configuration, "--scene", "painting.scene",
         "a scene whose models are painted too", "FILE");
  addKey(command, options.configuration, "--size", "painting.size",
         "size of the painting (default: 640x480)", "WxH");
  addConfiguration(command, options.configuration);
  command.footer("Run it as the user who paints: the cache belongs to a user.");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return warmUpShaders(options); }; });
}

}  // namespace

void addSubcommands(CLI::App& app, SubcommandOptions& options, std::function<int()>& chosen) {
  for (ConfigurationRequest* each :
       {&options.render.configuration, &options.record.configuration, &options.run.configuration,
        &options.calibrate.configuration, &options.measure.configuration,
        &options.config.configuration, &options.doctor.configuration,
        &options.warmUp.configuration}) {
    each->environment = environmentOfProcess();
  }
  addRun(app, options.run, chosen);
  addRender(app, options.render, chosen);
  addRecord(app, options.record, chosen);
  addCalibrate(app, options.calibrate, chosen);
  addMeasure(app, options.measure, chosen);
  addConfig(app, options.config, chosen);
  addDevices(app, options.devices, chosen);
  addDoctor(app, options.doctor, chosen);
  addThesis(app, options.thesis, chosen);
  addLooks(app, options.looks, chosen);
  addScene(app, options.sceneCheck, chosen);
  addWarmUp(app, options.warmUp, chosen);
  app.add_subcommand("styles", "list styles with their looks, parameters and debug views")
      ->callback([&] { chosen = listStyles; });
}

}  // namespace pleinair::app
