#include "pipeline/procedure/procedure_file.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "config/suggestion.h"
#include "config/toml_reader.h"
#include "pipeline/procedure/instruction_text.h"
#include "pipeline/procedure/likely_mistakes.h"
#include "pipeline/procedure/step_graph.h"
#include "pipeline/procedure/step_parts.h"
#include "pipeline/procedure/step_table.h"
#include "pipeline/procedure/unknown_keys.h"
#include "pipeline/scene/description/scene_values.h"

namespace pleinair::procedure {
namespace {

using config::ConfigError;
using config::TomlTable;

class ProcedureReader {
 public:
  ProcedureReader(const std::string& name, ProcedureSources& sources)
      : name_(name), sources_(sources) {}

  ProcedureReading read(std::string_view toml) {
    tryTo([&] { readToml(toml); });
    return std::move(reading_);
  }

 private:
  /// Runs `action`; a mistake is noted, and reading goes on after it.
  template <class Action>
  bool tryTo(const Action& action) {
    try {
      action();
      return true;
    } catch (const ConfigError& error) {
      reading_.faults.push_back(error);
      return false;
    }
  }

  void readToml(std::string_view toml) {
    const auto document = config::TomlDocument::parseText(toml, name_, sources_.folder());
    const TomlTable& root = document.root();
    bool isSound = tryTo([&] { readHead(root); });
    if (reading_.procedure.languages.empty()) return;  // the rest would be about languages only
    isSound = tryTo([&] { readModel(root.table("model")); }) && isSound;
    if (reading_.procedure.model) tryTo([&] { root.table("model").finish(); });
    isSound = readNames(root) && isSound;
    isSound = readSteps(root) && isSound;
    static const std::vector<std::string> kKeys{"languages", "model",   "name",    "step",
                                                "tools",     "version", "warnings"};
    std::ranges::move(unknownKeys(root, kKeys), std::back_inserter(reading_.faults));
    readTexts();
    addWayFindings();
    if (isSound)
      reading_.warnings =
          joined(std::move(reading_.warnings), likelyMistakes(reading_.procedure, name_));
  }

  void addWayFindings() {
    if (!areWaysKnown_) return;
    const Procedure& procedure = reading_.procedure;
    reading_.faults = joined(std::move(reading_.faults), wayFaults(procedure, name_));
    if (!arePartsKnown_ || !procedure.model) return;
    PartFindings found = partFindings(procedure, name_);
    reading_.faults = joined(std::move(reading_.faults), std::move(found.faults));
    reading_.warnings = joined(std::move(reading_.warnings), std::move(found.warnings));
  }

  static std::vector<ConfigError> joined(std::vector<ConfigError> all,
                                         std::vector<ConfigError> more) {
    std::ranges::move(more, std::back_inserter(all));
    return all;
  }

  void readHead(const TomlTable& root) {
    Procedure& procedure = reading_.procedure;
    const auto languages = root.optionalStrings("languages", {1, kMaxLanguages},
                                                "an array of 1 to 20 languages, such as \"en\"");
    if (!languages) throw root.error("languages", "missing", "an array such as [\"en\", \"de\"]");
    for (const std::string& each : *languages) {
      if (!isLanguageTag(each)) {
        throw root.error("languages", "found " + config::quoted(each),
                         "a language tag, such as \"en\" or \"pt-BR\"");
      }
      if (std::ranges::count(*languages, each) > 1) {
        throw root.error("languages", config::quoted(each) + " is there twice", "each once");
      }
    }
    procedure.languages = *languages;
    procedure.name = root.string("name");
    procedure.version = root.string("version", "a string, such as \"1.2\"");
    if (procedure.name.empty()) throw root.error("name", "is empty", "a name");
    if (procedure.version.empty()) throw root.error("version", "is empty", "such as \"1.2\"");
  }

  void readModel(const TomlTable& table) {
    Procedure& procedure = reading_.procedure;
    procedure.source = scene::readSource(table, sources_.folder());
    if (const auto* file = std::get_if<scene::FileSource>(&procedure.source)) {
      const glm::dmat3 frame(scene::readFileFrame(table, *file));
      procedure.unitMetres = glm::length(frame[0]);
      procedure.uprightFromModel = frame / procedure.unitMetres;
    }
    auto model = sources_.model(procedure.source);
    if (!model) {
      const hal::Error& error = model.error();
      throw table.error("source", error.subject + ": " + error.problem, error.remedy);
    }
    procedure.model = std::move(*model);
  }

  bool readNames(const TomlTable& root) {
    Procedure& procedure = reading_.procedure;
    bool isSound = true;
    isSound = tryTo([&] {
                const auto table = root.optionalTable("tools");
                if (!table) return;
                for (const std::string& id : table->keys()) {
                  procedure.tools.push_back({.id = id, .line = table->lineOf(id)});
                  const bool isRead =
                      tryTo([&] { procedure.tools.back().name = translations(table->table(id)); });
                  if (isRead) tryTo([&] { table->table(id).finish(); });
                  isSound = isRead && isSound;
                }
              }) &&
              isSound;
    isSound = tryTo([&] {
                const auto table = root.optionalTable("warnings");
                if (!table) return;
                for (const std::string& id : table->keys()) {
                  procedure.warnings.push_back({.id = id, .line = table->lineOf(id)});
                  const bool isRead =
                      tryTo([&] { readWarning(table->table(id), procedure.warnings.back()); });
                  if (isRead) tryTo([&] { table->table(id).finish(); });
                  isSound = isRead && isSound;
                }
              }) &&
              isSound;
    return isSound;
  }

  void readWarning(const TomlTable& table, Warning& warning) const {
    static constexpr std::array<config::Choice<WarningLevel>, 4> kLevels{
        {{"danger", WarningLevel::kDanger},
         {"warning", WarningLevel::kWarning},
         {"caution", WarningLevel::kCaution},
         {"notice", WarningLevel::kNotice}}};
    warning.level = table.choice("level", kLevels);
    warning.text = translations(table);
  }

  Translations translations(const TomlTable& table) const {
    Translations texts;
    for (const std::string& language : reading_.procedure.languages) {
      texts[language] = table.string(language, fmt::format("the text in \"{}\"", language));
      if (texts[language].empty()) throw table.error(language, "is empty", "a text");
    }
    return texts;
  }

  bool readSteps(const TomlTable& root) {
    Procedure& procedure = reading_.procedure;
    std::vector<TomlTable> tables;
    bool isSound = tryTo([&] {
      tables = root.tables("step");
      if (tables.empty()) throw root.error("step", "missing", "at least one [[step]]");
      if (tables.size() > kMaxSteps) {
        throw root.error("step", fmt::format("found {} steps", tables.size()),
                         fmt::format("at most {}", kMaxSteps));
      }
    });
    if (!isSound) return false;
    for (const TomlTable& table : tables) {
      const bool isNamed = tryTo([&] { procedure.steps.push_back(readStepId(table, procedure)); });
      // Its place is kept, and other mistakes are found, too.
      if (!isNamed) procedure.steps.push_back({.id = wrongIdOf(table)});
      areWaysKnown_ = areWaysKnown_ && isNamed;
      isSound = isNamed && isSound;
    }
    for (std::size_t i = 0; i < tables.size(); ++i) {
      const std::size_t before = reading_.faults.size();
      const StepReading step = readStep(tables[i], procedure, i, reading_.faults);
      if (!step.isCheckKnown) unknownChecks_.insert(i);
      areWaysKnown_ = areWaysKnown_ && step.isWayKnown;
      arePartsKnown_ = arePartsKnown_ && step.arePartsKnown;
      isSound = reading_.faults.size() == before && isSound;
      std::ranges::move(unknownStepKeys(tables[i]), std::back_inserter(reading_.faults));
      if (auto& movie = procedure.steps[i].movie) {
        isSound = tryTo([&] { checkMovie(tables[i], *movie); }) && isSound;
      }
      const auto& check = procedure.steps[i].check;
      if (!check || check->kind != CheckKind::kCompare) continue;
      isSound = tryTo([&] { checkTemplate(tables[i].table("check"), *check); }) && isSound;
    }
    return isSound;
  }

  /// What a step with a mistake in its id is called by texts; empty where that is another step's.
  std::string wrongIdOf(const TomlTable& table) const {
    std::string id = table.isString("id") ? table.string("id") : "";
    return reading_.procedure.findStep(id) ? "" : id;
  }

  void checkMovie(const TomlTable& step, StepMovie& movie) {
    const auto size = sources_.movie(movie.file);
    if (!size) throw step.error("movie", size.error().problem, size.error().remedy);
    movie.size = *size;
    addFile(movie.file);
  }

  void checkTemplate(const TomlTable& table, const Check& check) {
    const auto usable = sources_.picture(check.comparison);
    if (!usable) throw table.error("template", usable.error().problem, usable.error().remedy);
    addFile(check.comparison);
    // Where it was taken; without it, people compare by eye.
    const std::string pose =
        std::filesystem::path(check.comparison).replace_extension(".toml").string();
    if (sources_.text(pose)) addFile(pose);
  }

  void readTexts() {
    Procedure& procedure = reading_.procedure;
    std::vector<std::string> ids;
    for (const Step& step : procedure.steps) {
      if (!step.id.empty()) ids.push_back(step.id);
    }
    for (const std::string& language : procedure.languages) readText(language, ids);
    for (const std::string& language : sources_.languages()) {
      if (std::ranges::find(procedure.languages, language) != procedure.languages.end()) continue;
      refuse(language + ".md", 0, fmt::format("languages has no \"{}\"", language),
             fmt::format("\"{}\" in languages of {}, or no such file", language, name_));
    }
    std::ranges::sort(procedure.files);
  }

  void readText(const std::string& language, const std::vector<std::string>& ids) {
    Procedure& procedure = reading_.procedure;
    const std::string file = (sources_.folder() / (language + ".md")).string();
    const auto markdown = sources_.text(language + ".md");
    if (!markdown) {
      refuse(file, 0, markdown.error().problem,
             fmt::format("the texts of the language \"{}\", which {} lists", language, name_));
      return;
    }
    addFile(language + ".md");
    if (procedure.steps.empty()) return;  // every heading would be a mistake
    InstructionText text = readInstructionText(*markdown, file, ids, reading_.faults);
    procedure.title[language] = text.title;
    for (const auto& [picture, line] : text.pictures) {
      if (const auto usable = sources_.picture(picture); !usable) {
        refuse(file, line, usable.error().problem, usable.error().remedy);
      } else {
        addFile(picture);
      }
    }
    for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
      Step& step = procedure.steps[i];
      if (step.id.empty()) continue;
      const auto found = text.steps.find(step.id);
      if (found == text.steps.end()) {
        refuse(file, 0, fmt::format("has no text for step \"{}\"", step.id),
               fmt::format("\"## {}: Title\"", step.id));
        continue;
      }
      step.text[language] = std::move(found->second);
      if (!unknownChecks_.contains(i)) checkQuestion(step, language, file, text.lines[step.id]);
    }
  }

  void checkQuestion(const Step& step, const std::string& language, const std::string& file,
                     int line) {
    const std::string& question = step.text.at(language).question;
    const bool asks = step.check && (step.check->kind == CheckKind::kYesNo ||
                                     step.check->kind == CheckKind::kValue);
    if (asks && question.empty()) {
      refuse(file, line, fmt::format("step \"{}\" has a check but no question", step.id),
             "a line \"? Question\" below the heading");
    } else if (!step.check && !question.empty()) {
      refuse(file, line, fmt::format("step \"{}\" has a question but no check", step.id),
             "a check in the TOML file, or no line that begins with \"? \"");
    }
  }

  void addFile(const std::string& file) {
    std::vector<std::string>& files = reading_.procedure.files;
    if (std::ranges::find(files, file) == files.end()) files.push_back(file);
  }

  void refuse(std::string file, int line, std::string problem, std::string allowed) {
    reading_.faults.push_back(ConfigError({.file = std::move(file),
                                           .line = line,
                                           .problem = std::move(problem),
                                           .allowed = std::move(allowed)}));
  }

  const std::string& name_;
  ProcedureSources& sources_;
  ProcedureReading reading_;
  std::set<std::size_t> unknownChecks_;  ///< steps with a mistake in their check
  bool areWaysKnown_ = true;
  bool arePartsKnown_ = true;
};

}  // namespace

bool isLanguageTag(std::string_view text) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const std::string_view primary = text.substr(0, text.find('-'));
  return primary.size() >= 2 && primary.size() <= 3 && text.size() <= 20 && !text.ends_with('-') &&
         std::ranges::all_of(
             text, [&](char c) { return isLetter(c) || c == '-' || (c >= '0' && c <= '9'); });
}

ProcedureReading readProcedure(std::string_view toml, const std::string& name,
                               ProcedureSources& sources) {
  return ProcedureReader(name, sources).read(toml);
}

Procedure loadProcedure(const std::filesystem::path& folder) {
  ProcedureReading reading = readProcedureFolder(folder);
  if (!reading.faults.empty()) throw reading.faults.front();
  return std::move(reading.procedure);
}

}  // namespace pleinair::procedure
