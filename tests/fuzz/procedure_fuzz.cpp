// Reads text as a procedure: TOML, and after a line "%%%" the Markdown of each of two languages.
#include <memory>
#include <string>
#include <vector>

#include "pipeline/procedure/procedure_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

std::shared_ptr<const scene::Model> smallModel() {
  scene::Model model;
  for (const char* name : {"plug", "cover", "bolt_1", "bolt_2"})
    model.parts.push_back({.name = name});
  return std::make_shared<const scene::Model>(std::move(model));
}

class FuzzSources : public procedure::ProcedureSources {
 public:
  explicit FuzzSources(std::string markdown) : markdown_(std::move(markdown)) {}
  hal::Result<std::string> text(const std::string&) override { return markdown_; }
  hal::Result<void> picture(const std::string& name) override {
    if (name == "plug.png") return {};
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound, .problem = "missing"});
  }
  hal::Result<hal::FrameSize> movie(const std::string& name) override {
    if (name == "plug.mp4") return hal::FrameSize{320, 180};
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .problem = "there is no movie \"" + name + "\""});
  }
  hal::Result<std::shared_ptr<const scene::Model>> model(const scene::ModelSource&) override {
    static const auto kModel = smallModel();
    return kModel;
  }
  std::vector<std::string> languages() override { return {"en", "de"}; }
  std::filesystem::path folder() const override { return "/nonexistent"; }

 private:
  std::string markdown_;
};

/// A procedure without mistakes can be followed: every step has a way on and a text.
void follow(const procedure::Procedure& read) {
  if (read.steps.empty()) fuzz::fail("no step");
  for (std::size_t i = 0; i < read.steps.size(); ++i) {
    const procedure::Step& step = read.steps[i];
    if (step.next.empty()) fuzz::fail("a step without a way on");
    for (const auto& [outcome, next] : step.next) {
      if (next != procedure::kEnd && next >= read.steps.size()) fuzz::fail("a way to nowhere");
    }
    for (const std::string& language : read.languages) {
      procedure::plainText(read.text(i, language).body);
    }
    if (step.check) procedure::limitsText(*step.check);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::asText(data, size);
  const std::size_t cut = text.find("\n%%%\n");
  FuzzSources sources(cut == std::string_view::npos ? "" : std::string(text.substr(cut + 5)));
  const procedure::ProcedureReading reading =
      procedure::readProcedure(text.substr(0, cut), "procedure.toml", sources);
  for (const config::ConfigError& each : reading.faults) fuzz::expectOneLine(each.what());
  if (reading.faults.empty()) follow(reading.procedure);
  return 0;
}
