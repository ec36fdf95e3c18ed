#include "firmware_app/procedure_options.h"

#include <string>

#include <CLI/CLI.hpp>

#include "firmware_app/cli/option_values.h"

namespace pleinair::app {
namespace {

void addCheck(CLI::App& procedure, ProcedureCheckOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *procedure.add_subcommand(
      "check", "print what a procedure holds, and every mistake in it with its remedy");
  command.add_option("FOLDER", options.folder, "the procedure's folder")->required()->type_name("");
  command.add_flag("--nodes", options.listsNodes, "print the model's nodes, which steps name");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return checkProcedure(options); }; });
}

void addNew(CLI::App& procedure, ProcedureNewOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *procedure.add_subcommand(
      "new", "write the first version of a procedure: a step for each node of a model");
  command.add_option("FOLDER", options.folder, "the procedure's folder, new or empty")
      ->required()
      ->type_name("");
  command
      .add_option("--model", options.model,
                  "a .glb or .stl file, which is copied, a model in FOLDER, or builtin:gearbox")
      ->required()
      ->type_name("FILE|NAME");
  command
      .add_option("--units", options.units,
                  "the unit of the model's lengths, which STL and OBJ files do not say")
      ->check(CLI::IsMember({"m", "mm", "cm", "in"}))
      ->type_name("UNIT");
  command
      .add_option("--language", options.languages,
                  "a language of its texts; repeatable (default: en)")
      ->type_name("TAG")
      ->take_all();
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return newProcedure(options); }; });
}

void addPreview(CLI::App& procedure, ProcedurePreviewOptions& options,
                std::function<int()>& chosen) {
  CLI::App& command =
      *procedure.add_subcommand("preview", "draw every step on one sheet, without a camera");
  command.add_option("FOLDER", options.folder, "the procedure's folder")->required()->type_name("");
  command.add_option("--output", options.output, "the sheet, a PNG")
      ->required()
      ->check(requirePngName)
      ->type_name("FILE");
  CLI::Option* language =
      command
          .add_option("--language", options.language, "the texts' language (default: its first)")
          ->type_name("TAG");
  command
      .add_flag("--nodes", options.nodes,
                "draw every node of the model in place of the steps, with its name")
      ->excludes(language);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return previewProcedure(options); }; });
}

void addTemplate(CLI::App& procedure, ProcedureTemplateOptions& options,
                 std::function<int()>& chosen) {
  CLI::App& command = *procedure.add_subcommand(
      "template",
      "take the template of a comparison from a recording of the machine as it should be");
  command.add_option("FOLDER", options.folder, "the procedure's folder")->required()->type_name("");
  command.add_option("PICTURE", options.picture, "the template's name in it, a PNG")
      ->required()
      ->check(requirePngName)
      ->type_name("");
  command.add_option("--scene", options.scene, "the scene with the machine's tags and model")
      ->required()
      ->type_name("FILE");
  command.add_option("--input", options.input, "a movie or picture")->required()->type_name("PATH");
  command.add_option("--model", options.model, "the machine's name in the scene")
      ->type_name("NAME");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return takeTemplate(options); }; });
}

std::string requireHash(const std::string& text) {
  const bool isHash =
      text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  return isHash ? "" : "found " + text + ", allowed: 64 lower-case hexadecimal digits";
}

void addRecordCheck(CLI::App& app, RecordCheckOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "record-check", "verify the record of a procedure that was carried out, and its stills");
  command.add_option("FILE", options.record, "the record (JSONL)")->required()->type_name("");
  command
      .add_option("--final", options.finalHash,
                  "the final hash, as noted elsewhere at the sign-off")
      ->check(requireHash)
      ->type_name("HASH");
  CLI::Option* report =
      command.add_option("--report", options.report, "a page to print (HTML), beside the record")
          ->check(refuseStandardOutput)
          ->type_name("FILE");
  command
      .add_option("--procedure", options.procedure,
                  "the folder of the procedure, for the titles in the report")
      ->needs(report)
      ->type_name("FOLDER");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return checkRecordOfWork(options); }; });
}

std::string requireZipName(const std::string& text) {
  return std::filesystem::path(text).extension() == ".zip"
             ? ""
             : "found " + text + ", allowed: a name that ends in .zip";
}

void addRecordExport(CLI::App& app, RecordExportOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "record-export", "put a record, its stills, a page to print and the procedure into one file");
  command.add_option("FILE", options.record, "the record (JSONL)")->required()->type_name("");
  command.add_option("--output", options.output, "the archive (ZIP)")
      ->required()
      ->check(requireZipName)
      ->type_name("FILE");
  command
      .add_option("--procedure", options.procedure,
                  "the folder of the procedure, for the archive and the report's titles")
      ->type_name("FOLDER");
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return exportRecord(options); }; });
}

void addInputs(CLI::App& app, InputsOptions& options, std::function<int()>& chosen) {
  CLI::App& command = *app.add_subcommand(
      "inputs", "list pedals, gamepads, presenters and keyboards; show or learn their buttons");
  CLI::Option* watches =
      command.add_flag("--watch", options.watches, "print what is pressed until Ctrl+C");
  command
      .add_option("--learn", options.learn,
                  "ask for a button for each command, and write the map to this file (TOML)")
      ->type_name("FILE")
      ->excludes(watches);
  refuseEmptyValues(command);
  command.callback([&] { chosen = [&options] { return showInputs(options); }; });
}

}  // namespace

void addProcedure(CLI::App& app, ProcedureOptions& options, std::function<int()>& chosen) {
  CLI::App& procedure =
      *app.add_subcommand("procedure", "write, check and preview work instructions");
  procedure.require_subcommand(1);
  addCheck(procedure, options.check, chosen);
  addNew(procedure, options.made, chosen);
  addPreview(procedure, options.preview, chosen);
  addTemplate(procedure, options.taken, chosen);
  addRecordCheck(app, options.recordCheck, chosen);
  addRecordExport(app, options.recordExport, chosen);
  addInputs(app, options.inputs, chosen);
}

}  // namespace pleinair::app
