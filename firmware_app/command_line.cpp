#include "firmware_app/command_line.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <functional>
#include <iostream>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "config/suggestion.h"
#include "firmware_app/commands/record.h"
#include "firmware_app/commands/render.h"
#include "firmware_app/commands/styles.h"
#include "firmware_app/exit_status.h"
#include "firmware_app/log.h"
#include "firmware_app/option_values.h"
#include "firmware_app/version.h"
#include "hal/cameras/synthetic/shot.h"

namespace pleinair::app {
namespace {

CLI::Option* addSize(CLI::App& command, std::function<void(hal::FrameSize)> assign,
                     const std::string& help) {
  return command
      .add_option_function<std::string>(
          "--size", [assign = std::move(assign)](const std::string& text) { assign(sizeOf(text)); },
          help)
      ->type_name("WxH");
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
      .add_option("--output", options.output,
                  "movie (.mp4, .mkv), .y4m, one .png, a folder, or a pattern such as out/%04d.png")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("PATH");
  command.add_option("--style", options.style, "how to paint; `pleinair styles` lists them")
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--scene", options.scene, "tags and models (TOML)")->type_name("FILE");
  addSize(
      command, [&options](hal::FrameSize size) { options.size = size; },
      "of the painting (default: the input's); movies have even sides");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; },
      "paint the first N only");
  command.add_option("--view", options.view, "an inner picture instead of the finished one")
      ->type_name("NAME");
  command.add_option("--set", options.set, "a parameter of the style, such as cell_size=12")
      ->type_name("NAME=VALUE")
      ->take_all();
  command.add_option("--poses", options.poses, "write what was tracked, a JSON object a frame")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  command
      .add_option("--contact-sheet", options.contactSheet,
                  "write a PNG of several moments, original beside painting")
      ->check(requirePngName)
      ->type_name("FILE");
  command
      .add_option("--shaders", options.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return render(options); }; });
}

/// What a real camera does to a picture, for the synthetic one.
void addSensor(CLI::App& command, RecordOptions& options) {
  const auto add = [&command](const char* name, double& value, double least, double most,
                              const char* help) {
    command.add_option(name, value, help)
        ->capture_default_str()
        ->check(CLI::Range(least, most))
        ->type_name("NUMBER");
  };
  add("--rate", options.framesPerSecond, 1, 1000, "frames a second");
  add("--noise", options.noiseSigma, 0, 40, "of the sensor: standard deviation in 8-bit levels");
  add("--exposure-drift", options.exposureDriftStops, 0, 2, "stops by which brightness wanders");
  add("--white-balance-drift", options.whiteBalanceDrift, 0, 0.5,
      "share by which red and blue wander against each other");
  add("--readout", options.readoutMilliseconds, 0, 1000,
      "milliseconds that a rolling shutter takes from the first row to the last; 0: global "
      "shutter");
}

void addRecord(CLI::App& app, RecordOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("record", "record a camera");
  command
      .add_option("--camera", options.camera,
                  "which camera: synthetic:SHOT, where SHOT is one of " +
                      hal::syntheticShotNames() + "; synthetic alone is the walkaround")
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--output", options.output, "as of render")
      ->required()
      ->check(refuseStandardOutput)
      ->type_name("PATH");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; }, "how many")
      ->default_str(std::to_string(options.frames));
  addSize(
      command, [&options](hal::FrameSize size) { options.size = size; },
      "of the frames (default: 640x480); movies have even sides");
  command.add_option("--seed", options.seed, "of the synthetic camera's world and path")
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option("--write-scene", options.writeScene,
                  "write a scene file that fits the synthetic camera's world")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addSensor(command, options);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return record(options); }; });
}

/// What was not recognised, the first option of it where there is one: the rest may be its value.
std::string unknownText(const CLI::App& app, const std::vector<std::string>& unknown) {
  const auto option =
      std::ranges::find_if(unknown, [](const std::string& text) { return text.starts_with('-'); });
  const std::string word = option == unknown.end() ? unknown.front() : *option;
  const std::string name = word.substr(0, word.find('='));
  const std::vector<CLI::App*> commands = app.get_subcommands();
  std::vector<std::string> known;
  if (option != unknown.end()) {
    for (const CLI::Option* each : (commands.empty() ? app : *commands.front()).get_options()) {
      known.push_back(each->get_name());
    }
    return fmt::format("{}: {}", name, config::unknownText("option", name, known));
  }
  if (!commands.empty()) return fmt::format("{}: unexpected argument", word);
  for (const CLI::App* each : app.get_subcommands({})) known.push_back(each->get_name());
  return fmt::format("{}: {}", word, config::unknownText("command", word, known));
}

/// CLI11's own message on one line, under our exit status.
int reportParseError(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  // CLI11 would say that --input is missing where "--inpt" was meant for it.
  const std::vector<std::string> unknown = app.remaining(true);
  const bool isAboutUnknown = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string text =
      isAboutUnknown && !unknown.empty() ? unknownText(app, unknown) : error.what();
  printError(fmt::format("{}; see pleinair --help", text));
  return static_cast<int>(ExitStatus::kUsage);
}

/// The status, unless what was printed did not arrive.
int withOutputFlushed(int status) {
  errno = 0;
  std::cout.flush();  // CLI11's help
  const bool arrived = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  if (arrived || status != 0) return status;
  const std::string cause = errno == 0 ? "" : ": " + std::generic_category().message(errno);
  printError("standard output: cannot write" + cause);
  return static_cast<int>(ExitStatus::kUsage);
}

/// The arguments in the order in which CLI11 wants them, the last first. It would take the argument
/// after "--name=" for the value.
std::vector<std::string> argumentsReversed(int argc, const char* const* argv) {
  std::vector<std::string> arguments;
  for (const char* each :
       std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0)) {
    std::string argument = each;
    const bool hasEmptyValue =
        argument.starts_with("--") && argument.find('=') == argument.size() - 1;
    if (hasEmptyValue) argument.pop_back();
    arguments.push_back(std::move(argument));
    if (hasEmptyValue) arguments.emplace_back();
  }
  std::ranges::reverse(arguments);
  return arguments;
}

int parseAndRun(int argc, const char* const* argv) {
  CLI::App app("pleinair paints live augmented-reality video with marks that stay put.",
               "pleinair");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(0, 1);  // none is named below: CLI11 would keep quiet about a wrong one
  RenderOptions renderOptions;
  RecordOptions recordOptions;
  std::function<int()> chosen;
  addRender(app, renderOptions, chosen);
  addRecord(app, recordOptions, chosen);
  app.add_subcommand("styles", "list styles with their views and parameters")->callback([&] {
    chosen = listStyles;
  });
  try {
    app.parse(argumentsReversed(argc, argv));
    if (!chosen) throw CLI::RequiredError("one of render, record and styles");
    return chosen();
  } catch (const CLI::ParseError& error) {
    return reportParseError(app, error);
  } catch (...) {
    return static_cast<int>(reportCurrentException());
  }
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
  logToStandardError();
  return withOutputFlushed(parseAndRun(argc, argv));
}

}  // namespace pleinair::app
