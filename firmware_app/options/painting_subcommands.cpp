#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/parameter.h"
#include "config/suggestion.h"
#include "firmware_app/cli/option_values.h"
#include "firmware_app/options/shared_options.h"
#include "firmware_app/options/subcommands.h"
#include "hal/outputs/registry.h"

namespace pleinair::app {
namespace {

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

constexpr std::array<std::pair<std::string_view, hal::VideoCodec>, 4> kCodecs{
    {{"h264", hal::VideoCodec::kH264},
     {"hevc", hal::VideoCodec::kHevc},
     {"av1", hal::VideoCodec::kAv1},
     {"ffv1", hal::VideoCodec::kFfv1}}};

/// Throws CLI::ValidationError for an unknown name, with all names.
hal::VideoCodec codecNamed(const std::string& text) {
  // the names of standards and encoders
  static const std::map<std::string_view, std::string_view> kOtherNames{
      {"h265", "hevc"}, {"x265", "hevc"}, {"avc", "h264"}, {"x264", "h264"}};
  std::vector<std::string> names;
  for (const auto& [name, codec] : kCodecs) {
    if (text == name) return codec;
    names.emplace_back(name);
  }
  const auto other = kOtherNames.find(text);
  const std::string found = other == kOtherNames.end()
                                ? config::foundText(text, names)
                                : fmt::format("\"{}\" (did you mean \"{}\"?)", text, other->second);
  throw CLI::ValidationError("--codec",
                             fmt::format("found {}, allowed: {}", found, config::listText(names)));
}

/// The range depends on the codec, which may be given after it.
void readCrf(const std::string& text, hal::MovieOptions& movie) {
  if (text.empty()) return;
  constexpr double kMostCrf = 51;
  constexpr double kMostCrfOfAv1 = 63;
  const bool isAv1 = movie.codec == hal::VideoCodec::kAv1;
  movie.crf = numberOf("--crf", text, "", 0, isAv1 ? kMostCrfOfAv1 : kMostCrf);
}

/// How movies and pictures are coded. Which of the options the output takes, render() checks.
/// `crf` is read by readCrf() once all options are known.
void addFileFormat(CLI::App& command, PaintingOptions& painting, std::string& crf) {
  const auto addNumber = [&command](const std::string& name, const std::string& help, double least,
                                    double most, std::optional<double>& number) {
    command
        .add_option_function<std::string>(
            name,
            [name, least, most, &number](const std::string& text) {
              number = numberOf(name, text, "", least, most);
            },
            help)
        ->type_name("N");
  };
  command
      .add_option_function<std::string>(
          "--codec",
          [&painting](const std::string& text) { painting.movie.codec = codecNamed(text); },
          "of .mp4 and .mkv: h264 (default: plays everywhere), hevc and av1 (smaller, slower), "
          "ffv1 (lossless, .mkv)")
      ->type_name("NAME");
  command
      .add_option(
          "--crf", crf,
          "quality of .mp4 and .mkv: 0 to 51 (av1: 63), less is better and larger (default: "
          "18; hevc 22, av1 26)")
      ->type_name("N");
  addNumber("--quality", "of .jpg: 1 to 100, more is better and larger (default: 92)", 1, 100,
            painting.pictures.quality);
  addNumber("--dpi", "resolution that pictures are tagged with, for printing", 1, 10'000,
            painting.pictures.dotsPerInch);
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

/// --output, as often as wanted: the targets in their order; `given`: as they were given.
void addOutputs(CLI::App& command, ConfigurationRequest& request, const std::string& help,
                std::vector<std::string>* given = nullptr) {
  const auto assign = [&request, given](const std::vector<std::string>& targets) {
    for (const std::string& target : targets) {
      if (const std::string refusal = refuseStandardOutput(target); !refusal.empty()) {
        throw CLI::ValidationError("--output: " + refusal);
      }
    }
    const std::vector<std::filesystem::path> list(targets.begin(), targets.end());
    if (given != nullptr) *given = targets;
    request.options.push_back({"output.targets", config::textOfPaths(list), "--output"});
  };
  command.add_option_function<std::vector<std::string>>("--output", assign, help)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME|PATH");
}

}  // namespace

void addRender(CLI::App& app, RenderOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("render", "paint a recording: every frame, none dropped");
  command
      .add_option(
          "FILE,--input", options.inputs,
          "movie, Y4M, folder, one picture, a pattern such as in/%04d.png, or - for a movie "
          "on standard input; several are painted one after the other")
      ->required()
      ->type_name("PATH");
  command
      .add_option(
          "--output", options.painting.output,
          "movie (.mp4, .mkv), .y4m, one picture (.png, .jpg, .tif), a folder, a pattern such as "
          "out/%04d.png, or - for Y4M on standard output; {name} stands for the input's name: "
          "out/{name}.mp4")
      ->required()
      ->type_name("PATH");
  addPainting(command, options.configuration);
  addKey(command, options.configuration, "--size", "painting.size",
         "size of the painting (default: the input's); movies need even sides: an odd one becomes "
         "one px longer",
         "WxH");
  addKey(command, options.configuration, "--procedure", "procedure.folder",
         "draw the steps of a work instruction over its machine, which --scene places", "FOLDER");
  command
      .add_option("--step", options.step,
                  "only this step of it, by id or number (default: one after the other)")
      ->type_name("STEP");
  command
      .add_option_function<std::string>(
          "--step-seconds",
          [&options](const std::string& text) {
            options.secondsPerStep = numberOf("--step-seconds", text, "s", 0.1, 3600);
          },
          "how long each step is shown (default: 4)")
      ->type_name("N");
  addFrames(
      command, [&options](std::uint64_t count) { options.painting.frames = count; },
      "paint the first N frames only");
  addPart(command, options);
  command.add_flag_callback(
      "--no-sound", [&options] { options.keepsSound = false; },
      "leave the sound of a movie out; it is kept as it is coded where the output can hold it, "
      "else as AAC");
  addFileFormat(command, options.painting, options.crf);
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
  command.callback([&] {
    readCrf(options.crf, options.painting.movie);
    chosen = [&options] { return render(options); };
  });
}

void addRun(CLI::App& app, RunOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand("run", "paint a camera live");
  ConfigurationRequest& configuration = options.configuration;
  addKey(command, configuration, "--camera", "camera.source",
         "synthetic (default), auto, a device (see docs/cameras.md), or a recording's path, "
         "played in a loop at its own rate",
         "NAME|PATH");
  addOutputs(command, configuration, outputHelp(), &options.outputs);
  addPainting(command, configuration);
  addKey(command, configuration, "--size", "painting.size",
         "size of the painting (default: the camera's)", "WxH");
  addKey(command, configuration, "--procedure", "procedure.folder",
         "a work instruction that keys step through, drawn over its machine, which --scene places",
         "FOLDER");
  addFrames(
      command, [&options](std::uint64_t count) { options.frames = count; }, "end after N frames");
  addKey(command, configuration, "--snapshots", "output.snapshots",
         "the folder that the key s saves pictures to (default: .)", "DIR");
  command
      .add_option("--shaders", options.shaderDirectory,
                  "a copy of the source tree whose shaders replace the built-in ones")
      ->type_name("DIR");
  command
      .add_option("--provisioning", options.provisioning,
                  "a folder with a site.toml and what it names, such as a mounted partition; the "
                  "last good one is kept, and what is wrong is shown (docs/appliance.md)")
      ->excludes(command.get_option("--config"))
      ->type_name("DIR");
  command
      .add_option("--notice", options.notice,
                  "a text file that another program writes, shown over the painting for as long as "
                  "it says something")
      ->type_name("FILE");
  command.footer("In the window, h lists the keys.");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return run(options); }; });
}

void addRescue(CLI::App& app, RescueOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "rescue", "show a picture with a text on a display, without a camera and without GL");
  addOutputs(command, options.configuration,
             "the display (default: those of the configuration, else the first)");
  command.add_option("--title", options.title, "the text (default: that the painting comes back)")
      ->type_name("TEXT");
  command
      .add_option("--detail", options.detail,
                  "a smaller line under it; what is wrong with the configuration replaces it")
      ->type_name("TEXT");
  command
      .add_option("--write", options.file,
                  "write the picture to a file (.png, .jpg, .tif) instead of showing it")
      ->excludes("--output")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--seconds",
          [&options](const std::string& text) {
            options.time = hal::fromSeconds(numberOf("--seconds", text, "s", 1, 86400));
          },
          "end after this time (default: at a signal)")
      ->type_name("N");
  command
      .add_flag("--back-off", options.backsOff,
                "under a service manager, stay twice as long each time that the picture is needed "
                "again within ten minutes, at most half an hour")
      ->needs("--seconds");
  addConfiguration(command, options.configuration);
  command
      .add_flag("--provisioned", options.isProvisioned,
                "use the last good site file of `pleinair run --provisioning`")
      ->excludes(command.get_option("--config"));
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return showRescue(options); }; });
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
  addKey(
      command, configuration, "--size", "camera.size",
      "of the frames (default: 640x480); movies have even sides: an odd one becomes one px longer",
      "WxH");
  addKey(command, configuration, "--seed", "camera.synthetic.seed",
         "of the synthetic camera's world and path (default: 1)", "N");
  command.add_flag("--lossless", options.lossless,
                   "keep frames to the bit, with the camera's times and losses, in a .mkv that "
                   "--camera plays");
  command
      .add_option("--write-scene", options.writeScene,
                  "write a scene file that fits the synthetic camera's world")
      ->check(refuseStandardOutput)
      ->type_name("FILE");
  addConfiguration(command, configuration);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return record(options); }; });
}

void addLooks(CLI::App& app, LooksOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "looks", "paint one picture in every look of every style, on one sheet with their names");
  command.add_option("FILE,--input", options.input, "a picture, or a movie")
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

}  // namespace pleinair::app
