#pragma once

#include <functional>

#include <CLI/App.hpp>

#include "firmware_app/commands/commands.h"

namespace pleinair::app {

// Each adds a subcommand with its options. Parsing fills `options` and sets `chosen` to the
// function that runs the subcommand. Both must outlive the parsing and that call.

// Subcommands that paint.
void addRun(CLI::App& app, RunOptions& options, std::function<int()>& chosen);
void addRender(CLI::App& app, RenderOptions& options, std::function<int()>& chosen);
void addRescue(CLI::App& app, RescueOptions& options, std::function<int()>& chosen);
void addRecord(CLI::App& app, RecordOptions& options, std::function<int()>& chosen);
void addLooks(CLI::App& app, LooksOptions& options, std::function<int()>& chosen);

// Subcommands that measure.
void addCalibrate(CLI::App& app, CalibrateOptions& options, std::function<int()>& chosen);
void addMeasure(CLI::App& app, MeasureOptions& options, std::function<int()>& chosen);
void addThesis(CLI::App& app, ThesisOptions& options, std::function<int()>& chosen);

// Subcommands that print.
void addTags(CLI::App& app, TagsOptions& options, std::function<int()>& chosen);

}  // namespace pleinair::app
