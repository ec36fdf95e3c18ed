#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "firmware_app/cli/option_values.h"
#include "firmware_app/options/shared_options.h"
#include "firmware_app/options/subcommands.h"

namespace pleinair::app {
namespace {

/// Adds the options of `measure` that move a photograph; they exclude `others`, which say how
/// something else moves.
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

/// Adds the options of `measure` for what walks past a photograph, and returns the first.
CLI::Option* addWalker(CLI::App& command, MeasureOptions& options) {
  CLI::Option* walker =
      command
          .add_option_function<std::string>(
              "--walker",
              [&options](const std::string& path) {
                if (!options.walker) options.walker.emplace();
                options.walker->cutout = path;
                options.movedBy = "--walker";
                options.standing = true;
              },
              "a picture with transparency, such as a person cut out of a photograph, that walks "
              "past --input's photograph; implies --standing")
          ->type_name("PICTURE");
  command
      .add_option_function<std::string>(
          "--walker-speed",
          [&options](const std::string& text) {
            if (!options.walker) options.walker.emplace();
            options.walker->pixelsPerSecond = numberOf("--walker-speed", text, "", 10, 2000);
          },
          "its speed in px a second (default: 180)")
      ->needs(walker)
      ->type_name("SPEED");
  return walker;
}

}  // namespace

void addCalibrate(CLI::App& app, CalibrateOptions& options, std::function<int()>& chosen) {
  CLI::App& command =
      *app.add_subcommand("calibrate", "calibrate a camera's lens from views of a board");
  CLI::Option* camera = addKey(command, options.configuration, "--camera", "camera.source",
                               "as in run; ends when the views suffice, or at SIGINT", "NAME|PATH");
  command.add_option("--input", options.input, "a recording, as in render")
      ->excludes(camera)
      ->type_name("PATH");
  addBoard(command, options.board, true);
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

void addMeasure(CLI::App& app, MeasureOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "measure", "paint a sequence of known motion, and measure how coherent the painting is");
  CLI::Option* input =
      command
          .add_option("--input", options.input,
                      "a folder with motion.json or KITTI flow, a photograph with --pan, --zoom, "
                      "--roll, --still or --walker, or any recording")
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
  CLI::Option* walker = addWalker(command, options)->needs(input)->excludes(motion);
  addPhotographMotion(command, {motion, standing, walker}, options);
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
  command
      .add_option("--shaders", options.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
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
  command
      .add_option(
          "--only", options.only,
          "only these figures, by their numbers or the names of their files: 15 or 15_16_21")
      ->delimiter(',')
      ->type_name("NAME[,NAME]");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return makeThesisReport(options); }; });
}

}  // namespace pleinair::app
