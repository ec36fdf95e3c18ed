#include "firmware_app/commands/procedure.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <spdlog/spdlog.h>

#include "firmware_app/cli/exit_status.h"
#include "firmware_app/cli/standard_streams.h"
#include "firmware_app/scene/scene_check.h"
#include "pipeline/procedure/procedure_file.h"

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
  constexpr double kHugeMetres = 20.0;
  constexpr double kTinyMetres = 0.02;  // what carries a tag is larger
  const scene::Scene scene = sceneOf(procedure);
  std::vector<std::string> findings = placementFindings(scene);
  const AxisBox box = attachedBox(scene.models.front());
  const glm::dvec3 size = box.most - box.least;
  const double longest = std::max({size.x, size.y, size.z});
  if (longest > kHugeMetres) {
    findings.push_back(
        fmt::format("the model is {} large: export it in metres, or say units = \"mm\" in [model]",
                    sizeText(box)));
  } else if (longest > 0.0 && longest < kTinyMetres) {
    findings.push_back(fmt::format(
        "the model is {} small: it may have been scaled twice, or its units are not these",
        sizeText(box)));
  }
  for (const std::string& notice : procedure.model->notices) findings.push_back(notice);
  return findings;
}

/// Tools and warnings that no step names.
std::vector<std::string> unusedNames(const Procedure& procedure) {
  std::vector<std::string> findings;
  const auto isUsed = [&](auto member, std::size_t index) {
    return std::ranges::any_of(procedure.steps, [&](const procedure::Step& step) {
      return std::ranges::find(step.*member, index) != (step.*member).end();
    });
  };
  for (std::size_t i = 0; i < procedure.tools.size(); ++i) {
    if (isUsed(&procedure::Step::tools, i)) continue;
    findings.push_back(fmt::format("tools.{}: no step needs it", procedure.tools[i].id));
  }
  for (std::size_t i = 0; i < procedure.warnings.size(); ++i) {
    if (isUsed(&procedure::Step::warnings, i)) continue;
    findings.push_back(fmt::format("warnings.{}: no step gives it", procedure.warnings[i].id));
  }
  return findings;
}

/// "backlash: high -> overhaul"
std::vector<std::string> branchLines(const Procedure& procedure) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < procedure.steps.size(); ++i) {
    const procedure::Step& step = procedure.steps[i];
    for (const auto& [outcome, next] : step.next) {
      const std::size_t following = i + 1 < procedure.steps.size() ? i + 1 : procedure::kEnd;
      if (next == following) continue;
      lines.push_back(fmt::format("{}: {} -> {}", step.id, nameOf(outcome),
                                  next == procedure::kEnd ? "end" : procedure.steps[next].id));
    }
  }
  return lines;
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

int checkProcedure(const ProcedureCheckOptions& options) {
  const procedure::ProcedureReading reading = procedure::readProcedureFolder(options.folder);
  if (options.listsNodes) writeText(stdout, nodeLines(reading.procedure));
  for (const config::ConfigError& fault : reading.faults) printError(fault.what());
  if (!reading.faults.empty()) return static_cast<int>(ExitStatus::kUsage);
  const Procedure& procedure = reading.procedure;
  const AxisBox box = attachedBox(sceneOf(procedure).models.front());
  std::string text = fmt::format("{} {}: {} steps in {}\n", procedure.name, procedure.version,
                                 procedure.steps.size(), fmt::join(procedure.languages, ", "));
  text += fmt::format("  model: {} parts, {}\n", procedure.model->parts.size(), sizeText(box));
  text += fmt::format("  files: {}\n", fmt::join(procedure.files, ", "));
  text += fmt::format("  hash: {}\n", procedure.hash);
  for (const std::string& line : branchLines(procedure)) text += "  " + line + "\n";
  writeText(stdout, text);
  std::vector<std::string> findings = modelFindings(procedure);
  for (std::string& each : unusedNames(procedure)) findings.push_back(std::move(each));
  for (const std::string& finding : findings) spdlog::warn("{}", finding);
  return findings.empty() ? 0 : static_cast<int>(ExitStatus::kInternal);
}

}  // namespace pleinair::app
