#pragma once

#include <functional>

#include <CLI/App.hpp>

#include "firmware_app/commands/commands.h"
#include "firmware_app/procedure_options.h"

namespace pleinair::app {

/// The options of each subcommand.
struct SubcommandOptions {
  RenderOptions render;
  RecordOptions record;
  CalibrateOptions calibrate;
  MeasureOptions measure;
  ThesisOptions thesis;
  ConfigOptions config;
  RunOptions run;
  RescueOptions rescue;
  DevicesOptions devices;
  DoctorOptions doctor;
  LooksOptions looks;
  SceneCheckOptions sceneCheck;
  TagsOptions tags;
  ProcedureOptions procedure;
  WarmUpOptions warmUp;
};

/// Adds all subcommands with their options. Parsing fills `options` and sets `chosen` to the
/// function that runs the subcommand. Both must outlive the parsing and that call. Reads the
/// environment.
void addSubcommands(CLI::App& app, SubcommandOptions& options, std::function<int()>& chosen);

}  // namespace pleinair::app
