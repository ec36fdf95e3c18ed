#include "firmware_app/command_line.h"

#include <charconv>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware_app/commands/record.h"
#include "firmware_app/commands/render.h"
#include "firmware_app/commands/styles.h"
#include "firmware_app/exit_status.h"
#include "firmware_app/log.h"
#include "firmware_app/version.h"

namespace pleinair::app {
namespace {

/// Takes a number in digits, and nothing else, off the front.
bool takeNumber(std::string_view& text, int& number) {
  // from_chars would take a sign.
  if (text.empty() || text.front() < '0' || text.front() > '9') return false;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return status == std::errc();
}

/// "1280x720" as a size within the limits.
bool parseSize(std::string_view text, hal::FrameSize& size) {
  hal::FrameSize parsed;
  if (!takeNumber(text, parsed.width) || !text.starts_with('x')) return false;
  text.remove_prefix(1);
  if (!takeNumber(text, parsed.height) || !text.empty()) return false;
  size = parsed;
  return hal::isAcceptedSize(size);
}

CLI::Option* addSize(CLI::App& command, std::function<void(hal::FrameSize)> assign,
                     const std::string& help) {
  return command
      .add_option_function<std::string>(
          "--size",
          [assign = std::move(assign)](const std::string& text) {
            hal::FrameSize size;
            if (!parseSize(text, size)) {
              throw CLI::ValidationError(
                  "--size", fmt::format("found \"{}\", allowed: WIDTHxHEIGHT, at most {} px a side "
                                        "and {} Mpx, such as 1280x720",
                                        text, hal::kMaxSidePixels, hal::kMaxPixels / 1'000'000));
            }
            assign(size);
          },
          help)
      ->type_name("WxH");
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
      ->type_name("PATH");
  command.add_option("--style", options.style, "how to paint; `pleinair styles` lists them")
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--scene", options.scene, "tags and models (TOML)")->type_name("FILE");
  addSize(
      command, [&options](hal::FrameSize size) { options.size = size; },
      "of the painting (default: the input's)");
  command.add_option("--frames", options.frames, "paint the first N only")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command.add_option("--view", options.view, "an inner picture instead of the finished one")
      ->type_name("NAME");
  command.add_option("--set", options.set, "a parameter of the style, such as cell_size=12")
      ->type_name("NAME=VALUE")
      ->take_all();
  command.add_option("--poses", options.poses, "write what was tracked, a JSON object a frame")
      ->type_name("FILE");
  command
      .add_option("--contact-sheet", options.contactSheet,
                  "write a PNG of several moments, original beside painting")
      ->type_name("FILE");
  command
      .add_option("--shaders", options.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
  command.callback([&] { chosen = [&options] { return render(options); }; });
}

void addRecord(CLI::App& app, RecordOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("record", "record a camera");
  command.add_option("--camera", options.camera, "which camera")
      ->capture_default_str()
      ->type_name("NAME");
  command.add_option("--output", options.output, "as of render")->required()->type_name("PATH");
  command.add_option("--frames", options.frames, "how many")
      ->capture_default_str()
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  addSize(
      command, [&options](hal::FrameSize size) { options.size = size; },
      "of the frames (default: 640x480)");
  command.add_option("--seed", options.seed, "of the synthetic camera's world and path")
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option("--write-scene", options.writeScene,
                  "write a scene file that fits the synthetic camera's world")
      ->type_name("FILE");
  command.callback([&] { chosen = [&options] { return record(options); }; });
}

/// CLI11's own message on one line, under our exit status.
int reportParseError(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  printError(fmt::format("{}; see pleinair --help", error.what()));
  return static_cast<int>(ExitStatus::kUsage);
}

}  // namespace

int runCommandLine(int argc, const char* const* argv) {
  logToStandardError();
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
    app.parse(argc, argv);
    if (!chosen) throw CLI::RequiredError("one of render, record and styles");
    return chosen();
  } catch (const CLI::ParseError& error) {
    return reportParseError(app, error);
  } catch (...) {
    return static_cast<int>(reportCurrentException());
  }
}

}  // namespace pleinair::app
