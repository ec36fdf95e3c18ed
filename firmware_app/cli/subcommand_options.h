#pragma once

#include <functional>

#include <CLI/App.hpp>

#include "firmware_app/commands/commands.h"

namespace pleinair::app {

/// What is asked of each subcommand.
struct SubcommandOptions {
  RenderOptions render;
  RecordOptions record;
  CalibrateOptions calibrate;
  MeasureOptions measure;
  ConfigOptions config;
  RunOptions run;
  DevicesOptions devices;
  DoctorOptions doctor;
};

/// Adds all subcommands with their options. Parsing fills `options` and sets `chosen` to what
/// carries the subcommand out; both outlive the parsing and what was chosen. The environment is
/// read here.
void addSubcommands(CLI::App& app, SubcommandOptions& options, std::function<int()>& chosen);

}  // namespace pleinair::app
