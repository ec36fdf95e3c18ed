#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/procedure/procedure.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/record/record_check.h"

namespace pleinair::app {

struct ProcedureCheckOptions {
  std::filesystem::path folder;
  bool listsNodes = false;  ///< prints the names that steps can use, also with mistakes elsewhere
};

/// Warns of what is likely wrong in a procedure without mistakes; returns whether anything is.
bool warnOfLikelyMistakes(const procedure::ProcedureReading& reading,
                          const std::filesystem::path& folder);

/// Prints what a procedure's folder holds, and every mistake in it, each with file, line and
/// remedy: `pleinair procedure check`. Returns the exit status: 0; 1 with likely mistakes only; 2
/// with mistakes that keep it from running.
int checkProcedure(const ProcedureCheckOptions& options);

struct ProcedureNewOptions {
  std::filesystem::path folder;        ///< new, or empty, or holding the model
  std::string model;                   ///< a model file, or a built-in model
  std::string units;                   ///< of the file's lengths: "mm"; empty: the file's own
  std::vector<std::string> languages;  ///< empty: English
};

/// Writes the first version of a procedure, with a step for each node of the model: `pleinair
/// procedure new`. A .glb or .stl file is copied into the folder. Throws hal::Failure; nothing is
/// overwritten. Returns the exit status.
int newProcedure(const ProcedureNewOptions& options);

struct ProcedurePreviewOptions {
  std::filesystem::path folder;
  std::filesystem::path output;  ///< PNG
  std::string language;          ///< empty: the procedure's first
  bool nodes = false;            ///< draw the model's nodes in place of the steps
};

/// Draws every step, or every node of the model, on one sheet, without a camera: `pleinair
/// procedure preview`. Throws hal::Failure and config::ConfigError. Returns the exit status: 0, or
/// 128 + the signal that interrupted it, after which there is no sheet.
int previewProcedure(const ProcedurePreviewOptions& options);

struct ProcedureTemplateOptions {
  std::filesystem::path folder;
  std::string picture;               ///< the template's name in the folder, a PNG
  std::filesystem::path scene;       ///< with the machine's tags and model
  std::filesystem::path input;       ///< a recording of the machine as it should be
  std::optional<std::string> model;  ///< the machine's name in the scene; default: the only one
};

/// Takes the template of a comparison from a recording: the frame in which the machine is located
/// best, and where it is: `pleinair procedure template`. What was there is replaced. Throws
/// hal::Failure and config::ConfigError. Returns the exit status: 0, or 128 + the signal that
/// interrupted it.
int takeTemplate(const ProcedureTemplateOptions& options);

struct InputsOptions {
  bool watches = false;                        ///< prints presses until a signal
  std::optional<std::filesystem::path> learn;  ///< the file that the map is written to
};

/// Lists the pedals, gamepads, presenters and keyboards of this machine; shows what is pressed, or
/// learns which button means what and writes an input map: `pleinair inputs`. Throws hal::Failure.
/// Returns the exit status: 0, or 128 + the signal that interrupted the learning.
int showInputs(const InputsOptions& options);

struct RecordCheckOptions {
  std::filesystem::path record;
  std::optional<std::string> finalHash;            ///< as noted elsewhere at the sign-off
  std::optional<std::filesystem::path> report;     ///< HTML
  std::optional<std::filesystem::path> procedure;  ///< the folder, for the report's titles
};

/// Verifies the record of a procedure that was carried out, and its stills; writes a report of it:
/// `pleinair record-check`. Throws hal::Failure and config::ConfigError. Returns the exit status:
/// 0; 1 if anything was changed, removed, swapped or repeated, or if it is not signed off.
int checkRecordOfWork(const RecordCheckOptions& options);

struct RecordExportOptions {
  std::filesystem::path record;
  std::filesystem::path output;                    ///< ZIP
  std::optional<std::filesystem::path> procedure;  ///< the folder, which goes into it, too
};

/// Writes a record, its stills, the report and the procedure to one archive: `pleinair
/// record-export`. Throws hal::Failure and config::ConfigError. Returns the exit status: 0; 1 for a
/// record with findings, which is exported all the same, and says so.
int exportRecord(const RecordExportOptions& options);

/// The procedure in `folder`, where one is given. Throws hal::Failure (kInvalidArgument) unless it
/// is the version that the record ends with.
std::optional<procedure::Procedure> procedureOfRecord(
    const std::optional<std::filesystem::path>& folder, const record::RecordReading& reading);

/// Prints what is wrong with a record, each with file and line.
void printFindings(const std::filesystem::path& file, const record::RecordReading& reading);

}  // namespace pleinair::app
