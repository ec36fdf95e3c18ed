#include "firmware_app/cli/subcommand_options.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "config/profiles.h"
#include "config/suggestion.h"
#include "firmware_app/cli/option_values.h"
#include "firmware_app/commands/commands.h"

namespace pleinair::app {
namespace {

/// An option that gives a key of the configuration, which checks it.
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

/// Where the configuration comes from.
void addConfiguration(CLI::App& command, ConfigurationRequest& request) {
  command
      .add_option("--profile", request.profile,
                  fmt::format("what to build on: {}, or a file (.toml)",
                              config::listText(config::profileNames())))
      ->type_name("NAME|FILE");
  command
      .add_option("--config", request.siteFile,
                  fmt::format("the site file (default: ${}, else {} where there is one)",
                              "PLEINAIR_CONFIG", request.defaultSiteFile.string()))
      ->type_name("FILE");
  command
      .add_option("--set", request.set,
                  "a parameter of the style, such as cell_size=12, or any other key, such as "
                  "camera.rate=15; `pleinair config` lists them")
      ->type_name("NAME=VALUE")
      ->take_all();
}

/// The options of [painting], for commands that paint.
void addPainting(CLI::App& command, ConfigurationRequest& request) {
  addKey(command, request, "--style", "painting.style",
         "how to paint; `pleinair styles` lists them", "NAME");
  addKey(command, request, "--look", "painting.look", "a preset of the style's parameters", "NAME");
  addKey(command, request, "--view", "painting.view",
         "an inner picture instead of the finished one", "NAME");
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

void addRender(CLI::App& app, RenderOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("render", "paint a recording: every frame, none dropped");
  command
      .add_option("--input", options.input,
                  "movie, Y4M, folder, one picture, or a pattern such as in/%04d.png")
      ->required()
      ->type_name("PATH");
  command
      .add_option("--output", options.painting.output,
                  "movie (.mp4, .mkv), .y4m, one .png, a folder, or a pattern such as out/%04d.png")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("PATH");
  addPainting(command, options.configuration);
  addKey(command, options.configuration, "--size", "painting.size",
         "of the painting (default: the input's); movies have even sides", "WxH");
  addFrames(
      command, [&options](std::uint64_t count) { options.painting.frames = count; },
      "paint the first N only");
  command
      .add_option("--poses", options.painting.poses,
                  "write what was tracked, a JSON object a frame")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  command
      .add_option("--contact-sheet", options.painting.contactSheet,
                  "write a PNG of several moments, original beside painting")
      ->check(requirePngName)
      ->type_name("FILE");
  command
      .add_option("--shaders", options.painting.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return render(options); }; });
}

/// --output, up to three times: the targets in their order.
void addOutputs(CLI::App& command, ConfigurationRequest& request) {
  static constexpr std::array kKeys{"output.target", "output.second_target", "output.third_target"};
  const auto assign = [&request](const std::vector<std::string>& targets) {
    if (targets.size() > kKeys.size()) throw CLI::ValidationError("--output: three at the most");
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (const std::string refusal = refuseStandardOutput(targets[i]); !refusal.empty()) {
        throw CLI::ValidationError("--output: " + refusal);
      }
      request.options.push_back({kKeys.at(i), targets[i], "--output"});
    }
  };
  command
      .add_option_function<std::vector<std::string>>(
          "--output", assign,
          "window (default), loopback (a V4L2 device that others read as a camera), or a file or "
          "folder as of render; may be given up to three times")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME|PATH");
}

void addRun(CLI::App& app, RunOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("run", "paint a camera live");
  ConfigurationRequest& configuration = options.configuration;
  addKey(command, configuration, "--camera", "camera.source",
         "synthetic (default), auto, a device as docs/cameras.md says, or a recording's path, "
         "played over and over at its own pace",
         "NAME|PATH");
  addOutputs(command, configuration);
  addPainting(command, configuration);
  addKey(command, configuration, "--size", "painting.size",
         "of the painting (default: the camera's)", "WxH");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; }, "end after N");
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
  addKey(command, configuration, "--camera", "camera.source", "as of run (default: synthetic)",
         "NAME|PATH");
  command.add_option("--output", options.output, "as of render")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("PATH");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; }, "how many")
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
      .add_option("--spacing", board.spacing, "gap between tags, of a tag's edge (default: 0.3)")
      ->type_name("SHARE");
  command.add_option("--first-id", board.firstId, "id of the lower left tag (default: 0)")
      ->type_name("ID");
}

void addCalibrate(CLI::App& app, CalibrateOptions& options, std::function<int()>& chosen) {
  CLI::App& command =
      *app.add_subcommand("calibrate", "find a camera's lens from views of a board");
  CLI::Option* camera = addKey(command, options.configuration, "--camera", "camera.source",
                               "as of run: until the views suffice, or SIGINT", "NAME|PATH");
  command.add_option("--input", options.input, "a recording, as of render")
      ->excludes(camera)
      ->type_name("PATH");
  addBoard(command, options.board);
  command.add_option("--output", options.output, "the calibration (TOML)")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; },
      "look at the first N only");
  command
      .add_option("--views-folder", options.viewsFolder,
                  "write the views that were chosen, with their corners, and the coverage")
      ->type_name("DIR");
  addKey(command, options.configuration, "--size", "camera.size",
         "asked of a camera (default: 640x480)", "WxH");
  addConfiguration(command, options.configuration);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return calibrate(options); }; });
}

void addConfig(CLI::App& app, ConfigOptions& options, std::function<int()>& chosen) {
  CLI::App& command =
      *app.add_subcommand("config", "print what is in force, and where each value came from");
  addPainting(command, options.configuration);
  addKey(command, options.configuration, "--camera", "camera.source", "as of run", "NAME|PATH");
  command.add_flag("--given", options.givenOnly, "leave out what nobody gave: a short site file");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return printConfiguration(options); }; });
}

void addDevices(CLI::App& app, DevicesOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("devices", "list the cameras and outputs that are there");
  command.add_flag("--json", options.json, "for programs");
  command.callback([&] { chosen = [&options] { return listDevices(options); }; });
}

void addDoctor(CLI::App& app, DoctorOptions& options, std::function<int()>& chosen) {
  CLI::App& command =
      *app.add_subcommand("doctor", "say what works on this machine, and what fixes the rest");
  command.add_flag("--json", options.json, "for programs");
  addConfiguration(command, options.configuration);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return examineMachine(options); }; });
}

/// How `measure` moves a photograph; `other` says how a recording moves by itself.
void addPhotographMotion(CLI::App& command, CLI::Option* other, MeasureOptions& options) {
  CLI::Option* still = command
                           .add_flag_callback(
                               "--still", [&options] { options.movedBy = "--still"; },
                               "show a photograph as it is, with the sensor's noise")
                           ->excludes(other);
  const auto add = [&](const std::string& name, const std::string& help, const std::string& type,
                       auto assign) {
    command
        .add_option_function<std::string>(
            name,
            [&options, name, assign](const std::string& text) {
              assign(text);
              options.movedBy = name;
            },
            help)
        ->type_name(type)
        ->excludes(other)
        ->excludes(still);
  };
  measure::PhotographMotion& motion = options.photograph;
  add("--pan", "move a photograph by so many px a frame, such as -1.5,-0.5", "VX,VY",
      [&motion](const std::string& text) {
        const auto [x, y] = vectorOf("--pan", text, 40);
        motion.pan = {x, y};
      });
  add("--zoom", "move into a photograph by so much a frame, such as 1%", "PERCENT",
      [&motion](const std::string& text) {
        motion.zoomPercent = numberOf("--zoom", text, "%", -10, 10);
      });
  add("--roll", "turn a photograph by so many degrees a frame", "DEGREES",
      [&motion](const std::string& text) {
        motion.rollDegrees = numberOf("--roll", text, "", -45, 45);
      });
}

void addMeasure(CLI::App& app, MeasureOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "measure", "paint a sequence whose motion is known, and say how coherent the painting is");
  CLI::Option* input =
      command
          .add_option("--input", options.input,
                      "a folder with motion.json or KITTI flow, a photograph with --pan, --zoom, "
                      "--roll or --still, or any recording")
          ->type_name("PATH");
  addKey(command, options.configuration, "--camera", "camera.source",
         "the workbench, whose motion is known (default: synthetic)", "synthetic:SHOT")
      ->excludes(input);
  CLI::Option* motion =
      command.add_option("--motion", options.motion, "how a recording moves (as motion.json)")
          ->needs(input)
          ->type_name("FILE");
  addPhotographMotion(command, motion, options);
  command
      .add_option_function<std::string>(
          "--noise",
          [&options](const std::string& text) {
            options.noiseLevels = numberOf("--noise", text, "", 0, 40);
          },
          "of the sensor, on a photograph and on the still scene, in 8-bit levels (default: 2)")
      ->type_name("SIGMA");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; },
      "measure N (default: all, or 60 where there is no end)");
  command
      .add_option_function<std::string>(
          "--settle",
          [&options](const std::string& text) {
            options.settle = frameCountOf(text, "--settle", 0);
          },
          "paint N frames before measuring (default: 0, or 30 where there is no end)")
      ->type_name("N");
  command.add_flag("--gates", options.gates, "exit with 1 unless the style passes its gates");
  command.add_option("--json", options.json, "write the report for programs")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  command.add_option("--html", options.html, "write the report as one page, with plots")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addPainting(command, options.configuration);
  addKey(
      command, options.configuration, "--size", "painting.size",
      "of a photograph's frames (default: its own, scaled down to 640x480 or as many px), of the "
      "workbench's, or of the painting of a recording whose motion is not known",
      "WxH");
  addKey(command, options.configuration, "--quality", "runtime.quality",
         "the level to paint at (default: the best)", "NAME");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return runMeasure(options); }; });
}

}  // namespace

void addSubcommands(CLI::App& app, SubcommandOptions& options, std::function<int()>& chosen) {
  for (ConfigurationRequest* each :
       {&options.render.configuration, &options.record.configuration, &options.run.configuration,
        &options.calibrate.configuration, &options.measure.configuration,
        &options.config.configuration, &options.doctor.configuration}) {
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
  app.add_subcommand("styles", "list styles with their looks, parameters and views")->callback([&] {
    chosen = listStyles;
  });
}

}  // namespace pleinair::app
