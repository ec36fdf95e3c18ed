#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "config/config_error.h"
#include "config/toml_reader.h"
#include "config/toml_text.h"
#include "firmware_app/cli/counted_text.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/commands/procedure.h"
#include "hal/error.h"
#include "hal/pending_file.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/procedure/skeleton.h"
#include "pipeline/scene/description/scene_values.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

using hal::orThrow;

hal::Failure refusedProcedure(std::string subject, std::string problem, std::string remedy) {
  return hal::Failure({.kind = hal::ErrorKind::kInvalidArgument,
                       .subject = std::move(subject),
                       .problem = std::move(problem),
                       .remedy = std::move(remedy)});
}

bool isInside(const fs::path& file, const fs::path& folder) {
  const fs::path relative = fs::relative(file, folder);
  return !relative.empty() && *relative.begin() != "..";
}

/// How [model] names the model, and the file to copy, if any.
struct ModelFile {
  std::string source;
  fs::path copied;
};

ModelFile modelFileOf(const ProcedureNewOptions& options) {
  if (options.model.starts_with("builtin:")) return {.source = options.model};
  const fs::path file(options.model);
  if (isInside(file, options.folder)) {
    return {.source = fs::relative(file, options.folder).string()};
  }
  if (file.extension() == ".glb" || file.extension() == ".stl") {
    return {.source = file.filename().string(), .copied = file};
  }
  throw refusedProcedure(options.model, "may have its data in other files, so it is not copied",
                         "a .glb or .stl file, or the model already in " + options.folder.string());
}

/// Throws where something would be overwritten.
void refuseExisting(const ProcedureNewOptions& options, const ModelFile& model,
                    const std::vector<std::string>& languages) {
  std::vector<fs::path> written{options.folder / procedure::kProcedureFile};
  for (const std::string& each : languages) written.push_back(options.folder / (each + ".md"));
  if (!model.copied.empty()) written.push_back(options.folder / model.source);
  for (const fs::path& each : written) {
    if (fs::exists(each)) throw refusedProcedure(each.string(), "exists already", "another FOLDER");
  }
}

scene::ModelSource sourceOf(const ProcedureNewOptions& options) {
  // The model is read as the procedure's [model] will be, so that the same names and errors hold.
  const auto text = config::tomlString(options.model);
  if (!text) throw refusedProcedure("--model", "is not UTF-8", "a file name in UTF-8");
  std::string keys = "source = " + *text + "\n";
  if (!options.units.empty()) keys += "units = \"" + options.units + "\"\n";
  const auto document = config::TomlDocument::parseText(keys, "--model");
  auto source = [&]() -> scene::ModelSource {
    try {
      return scene::readSource(document.root(), {});
    } catch (const config::ConfigError& error) {
      // The file and line are of text that nobody wrote.
      throw refusedProcedure("--model", "found " + config::quoted(options.model), error.allowed());
    }
  }();
  const auto* const file = std::get_if<scene::FileSource>(&source);
  if (file == nullptr && !options.units.empty()) {
    throw refusedProcedure("--units", "has no meaning for " + options.model, "no --units");
  }
  if (file == nullptr) return source;
  try {
    scene::readFileUnits(document.root(), *file);
  } catch (const config::ConfigError&) {
    throw refusedProcedure(options.model, "does not say its units",
                           "--units mm (most CAD programs), cm, m or in");
  }
  return source;
}

void writeFile(const fs::path& path, const std::string& text) {
  hal::PendingFile file = orThrow(hal::PendingFile::create(path));
  orThrow(file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  orThrow(file.publish());
}

}  // namespace

int newProcedure(const ProcedureNewOptions& options) {
  std::vector<std::string> languages = options.languages;
  if (languages.empty()) languages.emplace_back("en");
  for (const std::string& each : languages) {
    if (procedure::isLanguageTag(each)) continue;
    throw refusedProcedure("--language", fmt::format("found \"{}\"", each),
                           "a tag such as en or pt-BR");
  }
  const ModelFile file = modelFileOf(options);
  refuseExisting(options, file, languages);
  const scene::Model model = orThrow(scene::modelOf(sourceOf(options)));
  if (model.parts.empty()) {
    throw refusedProcedure(options.model, "has no node that shows anything", "a model with meshes");
  }
  std::string name = fs::absolute(options.folder).lexically_normal().filename().string();
  if (name.empty() || !config::tomlString(name)) name = "procedure";
  const procedure::Skeleton skeleton =
      procedure::skeletonOf(model, name, file.source, options.units, languages);
  std::error_code failure;
  fs::create_directories(options.folder, failure);
  if (failure) {
    throw hal::Failure(hal::errnoError(options.folder.string(), "cannot create", failure.value()));
  }
  if (!file.copied.empty()) {
    fs::copy_file(file.copied, options.folder / file.source, failure);
    if (failure) {
      throw hal::Failure(
          hal::errnoError((options.folder / file.source).string(), "cannot copy", failure.value()));
    }
  }
  for (const auto& [language, text] : skeleton.texts) {
    writeFile(options.folder / (language + ".md"), text);
  }
  writeFile(options.folder / procedure::kProcedureFile, skeleton.toml);
  writeText(stdout, fmt::format("wrote {}: {}\n", countedText(skeleton.steps, "step"),
                                (options.folder / procedure::kProcedureFile).string()));
  writeText(stdout, fmt::format("what is likely wrong: pleinair procedure check {0}\n"
                                "which node is which: pleinair procedure preview {0} --nodes "
                                "--output nodes.png\n",
                                options.folder.string()));
  if (!skeleton.leftOut.empty()) {
    spdlog::warn("{} without a step, from {} on: a procedure has at most {} steps",
                 countedText(skeleton.leftOut.size(), "node"), skeleton.leftOut.front(),
                 procedure::kMaxSteps);
  }
  return 0;
}

}  // namespace pleinair::app
