#pragma once

#include <functional>

#include <CLI/App.hpp>

#include "firmware_app/commands/procedure.h"

namespace pleinair::app {

/// The options of the subcommands of `pleinair procedure`, of `pleinair record-check`, `pleinair
/// record-export` and `pleinair inputs`.
struct ProcedureOptions {
  ProcedureCheckOptions check;
  ProcedureNewOptions made;
  ProcedurePreviewOptions preview;
  ProcedureTemplateOptions taken;
  RecordCheckOptions recordCheck;
  RecordExportOptions recordExport;
  InputsOptions inputs;
};

/// Adds them. Parsing fills `options` and sets `chosen`, as for addSubcommands().
void addProcedure(CLI::App& app, ProcedureOptions& options, std::function<int()>& chosen);

}  // namespace pleinair::app
