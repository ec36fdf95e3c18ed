#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/procedure/procedure_file.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::procedure {

/// A model of parts without surfaces, with these names.
inline std::shared_ptr<const scene::Model> modelWithParts(const std::vector<std::string>& names) {
  scene::Model model;
  for (const std::string& name : names) model.parts.push_back({.name = name});
  return std::make_shared<const scene::Model>(std::move(model));
}

/// A procedure's folder in memory.
class MemorySources : public ProcedureSources {
 public:
  hal::Result<std::string> text(const std::string& name) override {
    const auto found = texts.find(name);
    if (found != texts.end()) return found->second;
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound, .problem = "missing"});
  }
  hal::Result<void> picture(const std::string& name) override {
    if (name == "plug.png") return {};
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .problem = "there is no picture \"" + name + "\""});
  }
  hal::Result<hal::FrameSize> movie(const std::string& name) override {
    if (name == "plug.mp4") return hal::FrameSize{320, 180};
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .problem = "there is no movie \"" + name + "\""});
  }
  hal::Result<std::shared_ptr<const scene::Model>> model(const scene::ModelSource&) override {
    return modelWithParts({"plug", "cover", "bolt_1", "bolt_2", "shaft"});
  }
  std::vector<std::string> languages() override {
    std::vector<std::string> found;
    for (const auto& [name, text] : texts) found.push_back(name.substr(0, name.find('.')));
    return found;
  }
  std::filesystem::path folder() const override { return {}; }

  std::map<std::string, std::string> texts;
};

/// The messages of all mistakes, each on a line.
inline std::string messagesOf(const ProcedureReading& reading) {
  std::string all;
  for (const config::ConfigError& each : reading.faults) all += std::string(each.what()) + "\n";
  return all;
}

/// The head of a procedure in English; steps follow.
inline const std::string kHead =
    "name = \"p\"\nversion = \"1\"\nlanguages = [\"en\"]\n[model]\nsource = \"builtin:gearbox\"\n";

/// Reads `steps` below kHead, with a text for each id.
inline ProcedureReading readSteps(const std::string& steps, const std::vector<std::string>& ids,
                                  const std::string& body = "? Sure?") {
  MemorySources sources;
  std::string text = "# Title\n";
  for (const std::string& id : ids) text += "## " + id + ": T\n" + body + "\n";
  sources.texts["en.md"] = text;
  return readProcedure(kHead + steps, "p.toml", sources);
}

/// The messages of steps whose texts are their ids alone.
inline std::string messagesOfSteps(const std::string& steps, const std::vector<std::string>& ids) {
  return messagesOf(readSteps(steps, ids, ""));
}

}  // namespace pleinair::procedure
