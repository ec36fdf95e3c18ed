#include "firmware_app/commands/procedure.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <spdlog/spdlog.h>

#include "config/suggestion.h"
#include "firmware_app/cli/counted_text.h"
#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/scene/scene_check.h"
#include "pipeline/procedure/node_names.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/procedure/step_parts.h"

namespace pleinair::app {
namespace {

using procedure::Procedure;

/// The procedure's model alone, as a scene, for the checks of scenes.
scene::Scene sceneOf(const Procedure& procedure) {
  scene::Scene scene;
  scene.models.push_back({.name = "model",
                          .source = procedure.source,
                          .model = procedure.model,
                          .tagId = 0,
                          .attachFromModel = glm::scale(glm::dmat4(procedure.uprightFromModel),
                                                        glm::dvec3(procedure.unitMetres)),
                          .unitMetres = procedure.unitMetres});
  return scene;
}

std::string sizeText(const AxisBox& box) {
  const glm::dvec3 size = box.most - box.least;
  return fmt::format("{:.3g} x {:.3g} x {:.3g} m", size.x, size.y, size.z);
}

std::vector<std::string> modelFindings(const Procedure& procedure) {
  constexpr double kHugeMetres = 5.0;   // more does not fit before one camera
  constexpr double kTinyMetres = 0.02;  // what carries a tag is larger
  const scene::Scene scene = sceneOf(procedure);
  std::vector<std::string> findings = placementFindings(scene);
  const AxisBox box = attachedBox(scene.models.front());
  const glm::dvec3 size = box.most - box.least;
  const double longest = std::max({size.x, size.y, size.z});
  if (longest > kHugeMetres) {
    findings.push_back(fmt::format(
        "the model is {} large: is units in [model] right (\"mm\" of most CAD programs)?",
        sizeText(box)));
  } else if (longest > 0.0 && longest < kTinyMetres) {
    findings.push_back(fmt::format(
        "the model is {} small: it may have been scaled twice, or its units are not these",
        sizeText(box)));
  }
  for (const std::string& notice : procedure.model->notices) findings.push_back(notice);
  return findings;
}

/// Warns of what is likely wrong with the model; returns whether anything is.
bool warnOfModel(const Procedure& procedure, const std::string& file) {
  const std::vector<std::string> findings = modelFindings(procedure);
  for (const std::string& finding : findings) spdlog::warn("{}: model: {}", file, finding);
  return !findings.empty();
}

/// "gap: ok -> lash, low stays here, high -> end": where a check's outcomes lead.
std::vector<std::string> branchLines(const Procedure& procedure) {
  const auto nameOfStep = [&](std::size_t step) {
    return step == procedure::kEnd ? std::string("end") : procedure.steps[step].id;
  };
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    const procedure::Step& step = procedure.steps[i];
    const std::size_t following = i + 1 < procedure.steps.size() ? i + 1 : procedure::kEnd;
    std::vector<std::string> ways;
    for (const procedure::Outcome outcome : procedure::outcomesOf(step.checkKind())) {
      const auto next = step.next.find(outcome);
      const bool stays = next == step.next.end() || next->second == i;
      if (!step.check && !stays && next->second == following) continue;
      ways.push_back(stays ? fmt::format("{} stays here", nameOf(outcome))
                           : fmt::format("{} -> {}", nameOf(outcome), nameOfStep(next->second)));
    }
    if (!ways.empty()) lines.push_back(fmt::format("{}: {}", step.id, fmt::join(ways, ", ")));
  }
  return lines;
}

/// "  off at the end: cover; on some ways: seal\n"; empty where all parts are on again.
std::string leftOffLine(const Procedure& procedure) {
  const procedure::PartsLeftOff left = procedure::partsLeftOff(procedure);
  const auto namesOf = [&](const std::vector<std::size_t>& parts) {
    return config::listText(procedure::namesOfParts(*procedure.model, parts));
  };
  std::vector<std::string> lists;
  if (!left.onEveryWay.empty()) lists.push_back(namesOf(left.onEveryWay));
  if (!left.onSomeWays.empty()) lists.push_back("on some ways: " + namesOf(left.onSomeWays));
  return lists.empty() ? "" : fmt::format("  off at the end: {}\n", fmt::join(lists, "; "));
}

/// The names that steps can use, each once; nothing where the model cannot be read.
std::string nodeLines(const Procedure& procedure) {
  if (!procedure.model) return {};
  std::map<std::string, int> names;
  for (const scene::ModelPart& part : procedure.model->parts) ++names[part.name];
  std::string text;
  for (const auto& [name, count] : names) {
    text +=
        count == 1 ? fmt::format("  {}\n", name) : fmt::format("  {}  ({} parts)\n", name, count);
  }
  return text;
}

}  // namespace

bool warnOfLikelyMistakes(const procedure::ProcedureReading& reading,
                          const std::filesystem::path& folder) {
  for (const config::ConfigError& each : reading.warnings) spdlog::warn("{}", each.what());
  return warnOfModel(reading.procedure, (folder / procedure::kProcedureFile).string()) ||
         !reading.warnings.empty();
}

int checkProcedure(const ProcedureCheckOptions& options) {
  const procedure::ProcedureReading reading = procedure::readProcedureFolder(options.folder);
  if (options.listsNodes) writeText(stdout, nodeLines(reading.procedure));
  const Procedure& procedure = reading.procedure;
  const std::string file = (options.folder / procedure::kProcedureFile).string();
  for (const config::ConfigError& fault : reading.faults) printError(fault.what());
  if (!reading.faults.empty()) {
    if (procedure.model) warnOfModel(procedure, file);
    return static_cast<int>(ExitStatus::kUsage);
  }
  const AxisBox box = attachedBox(sceneOf(procedure).models.front());
  std::string text = fmt::format("{} {}: {} in {}\n", procedure.name, procedure.version,
                                 countedText(procedure.steps.size(), "step"),
                                 fmt::join(procedure.languages, ", "));
  text += fmt::format("  model: {}, {}\n", countedText(procedure.model->parts.size(), "part"),
                      sizeText(box));
  text += fmt::format("  files: {}\n", fmt::join(procedure.files, ", "));
  text += fmt::format("  hash: {}\n", procedure.hash);
  for (const std::string& line : branchLines(procedure)) text += "  " + line + "\n";
  text += leftOffLine(procedure);
  writeText(stdout, text);
  const bool isDoubtful = warnOfLikelyMistakes(reading, options.folder);
  return isDoubtful ? static_cast<int>(ExitStatus::kInternal) : 0;
}

}  // namespace pleinair::app
