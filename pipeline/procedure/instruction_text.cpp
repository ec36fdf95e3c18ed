#include "pipeline/procedure/instruction_text.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "config/suggestion.h"
#include "config/toml_text.h"

namespace pleinair::procedure {
namespace {

using config::ConfigError;

constexpr std::size_t kMaxTextBytes = std::size_t{1} << 20U;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t from = text.find_first_not_of(kBlank);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kBlank) - from + 1);
}

/// Reads a file line by line.
class TextReader {
 public:
  TextReader(const std::string& file, std::span<const std::string> ids,
             std::vector<ConfigError>& faults)
      : file_(file), ids_(ids), faults_(&faults) {}

  void take(std::string_view line) {
    ++line_;
    const std::string_view text = trimmed(line);
    if (text.starts_with("## ")) {
      heading(trimmed(text.substr(3)));
    } else if (text.starts_with("# ")) {
      title(trimmed(text.substr(2)));
    } else if (step_ == nullptr) {
      if (!text.empty() && !isInUnknownStep_) {
        refuse("text", "stands before the first step", "\"## step: Title\" above it");
        isInUnknownStep_ = true;  // once is enough
      }
    } else if (text.starts_with("![")) {
      picture(text);
    } else if (text.starts_with("? ")) {
      question(trimmed(text.substr(2)));
    } else {
      step_->body += std::string(text) + "\n";
    }
  }

  InstructionText finish() {
    if (read_.title.empty()) {
      line_ = 1;
      refuse("title", "missing", "a line \"# Title of the procedure\"");
    }
    for (auto& [id, step] : read_.steps) {
      while (step.body.ends_with('\n')) step.body.pop_back();
      while (step.body.starts_with('\n')) step.body.erase(0, 1);
    }
    return std::move(read_);
  }

 private:
  void refuse(std::string key, std::string problem, std::string allowed) {
    faults_->push_back(ConfigError({.file = file_,
                                    .line = line_,
                                    .key = std::move(key),
                                    .problem = std::move(problem),
                                    .allowed = std::move(allowed)}));
  }

  void title(std::string_view text) {
    if (!read_.title.empty()) {
      refuse("title", "is given twice", "one line \"# Title\", and \"## step: Title\" for steps");
      return;
    }
    read_.title = text;
  }

  void heading(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string id(trimmed(text.substr(0, colon)));
    step_ = nullptr;
    isInUnknownStep_ = true;
    if (colon == std::string_view::npos || trimmed(text.substr(colon + 1)).empty()) {
      refuse("heading", fmt::format("\"{}\" has no title", id), "\"## step: Title\"");
      return;
    }
    if (std::ranges::find(ids_, id) == ids_.end()) {
      refuse("heading", "there is no step " + config::foundText(id, ids_),
             "steps of the TOML file: " + config::listText(ids_));
      return;
    }
    if (const auto earlier = read_.lines.find(id); earlier != read_.lines.end()) {
      refuse("heading",
             fmt::format("step \"{}\" has its text at line {} already", id, earlier->second),
             "one heading for each step");
      return;
    }
    isInUnknownStep_ = false;
    read_.lines[id] = line_;
    step_ = &read_.steps[id];
    step_->title = trimmed(text.substr(colon + 1));
  }

  void picture(std::string_view text) {
    const std::size_t middle = text.find("](");
    if (middle == std::string_view::npos || !text.ends_with(')')) {
      refuse("picture", "is not complete", "a line \"![caption](file.png)\"");
      return;
    }
    const std::string file(text.substr(middle + 2, text.size() - middle - 3));
    step_->pictures.push_back({.file = file, .caption = std::string(text.substr(2, middle - 2))});
    read_.pictures.emplace_back(file, line_);
  }

  void question(std::string_view text) {
    if (!step_->question.empty()) {
      refuse("question", "is the second of its step", "one line \"? Question\" in a step");
      return;
    }
    step_->question = text;
  }

  const std::string& file_;
  std::span<const std::string> ids_;
  std::vector<ConfigError>* faults_;
  InstructionText read_;
  StepText* step_ = nullptr;
  bool isInUnknownStep_ = false;
  int line_ = 0;
};

}  // namespace

InstructionText readInstructionText(std::string_view markdown, const std::string& file,
                                    std::span<const std::string> ids,
                                    std::vector<ConfigError>& faults) {
  if (markdown.size() > kMaxTextBytes) {
    faults.push_back(ConfigError({.file = file, .problem = "too large", .allowed = "1 MiB"}));
    return {};
  }
  if (!config::tomlString(markdown)) {
    faults.push_back(ConfigError({.file = file, .problem = "is not UTF-8"}));
    return {};
  }
  TextReader reader(file, ids, faults);
  while (!markdown.empty()) {
    const std::size_t end = markdown.find('\n');
    reader.take(markdown.substr(0, end));
    markdown.remove_prefix(end == std::string_view::npos ? markdown.size() : end + 1);
  }
  return reader.finish();
}

}  // namespace pleinair::procedure
