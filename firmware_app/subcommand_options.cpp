#include "firmware_app/subcommand_options.h"

#include <functional>

#include <CLI/CLI.hpp>

#include "firmware_app/cli/option_values.h"
#include "firmware_app/commands/commands.h"
#include "firmware_app/options/shared_options.h"
#include "firmware_app/options/subcommands.h"

namespace pleinair::app {
namespace {

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
  CLI::Option* const modes = command.add_flag(
      "--modes", options.modes,
      "list the modes of cameras, and which one each would take for camera.size and camera.rate");
  addKey(command, options.configuration, "--size", "camera.size", "the size asked for", "WxH")
      ->needs(modes);
  addKey(command, options.configuration, "--rate", "camera.rate", "the frames a second asked for",
         "FPS")
      ->needs(modes);
  command.add_flag("--json", options.json, "print JSON");
  addConfiguration(command, options.configuration);
  refuseEmptyValues(command);
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
        &options.rescue.configuration, &options.calibrate.configuration,
        &options.measure.configuration, &options.config.configuration,
        &options.doctor.configuration, &options.warmUp.configuration}) {
    each->environment = environmentOfProcess();
  }
  addRun(app, options.run, chosen);
  addRescue(app, options.rescue, chosen);
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
  addTags(app, options.tags, chosen);
  addProcedure(app, options.procedure, chosen);
  addWarmUp(app, options.warmUp, chosen);
  app.add_subcommand("styles", "list styles with their looks, parameters and debug views")
      ->callback([&] { chosen = listStyles; });
}

}  // namespace pleinair::app
