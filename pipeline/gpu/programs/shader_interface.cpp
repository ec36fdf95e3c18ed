#include "pipeline/gpu/programs/shader_interface.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>

namespace pleinair::gpu {
namespace {

using Tokens = std::vector<std::string>;
using Kind = ShaderInput::Kind;

bool isWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The first word of `text` from `from` on.
std::string wordAt(std::string_view text, std::size_t from) {
  while (from < text.size() && !isWordCharacter(text[from])) ++from;
  std::size_t to = from;
  while (to < text.size() && isWordCharacter(text[to])) ++to;
  return std::string(text.substr(from, to - from));
}

/// Words and single characters, without comments and directives.
Tokens tokensOf(std::string_view text) {
  Tokens tokens;
  bool isAtLineStart = true;
  for (std::size_t i = 0; i < text.size();) {
    const std::string_view rest = text.substr(i);
    if (rest.starts_with("//") || (isAtLineStart && rest.front() == '#')) {
      i = std::min(text.find('\n', i), text.size());
    } else if (rest.starts_with("/*")) {
      const std::size_t end = text.find("*/", i + 2);
      i = end == std::string_view::npos ? text.size() : end + 2;
    } else if (isWordCharacter(rest.front())) {
      tokens.push_back(wordAt(text, i));
      i += tokens.back().size();
      isAtLineStart = false;
    } else {
      if (rest.front() == '\n') isAtLineStart = true;
      if (std::isspace(static_cast<unsigned char>(rest.front())) == 0) {
        tokens.emplace_back(1, rest.front());
        isAtLineStart = false;
      }
      ++i;
    }
  }
  return tokens;
}

bool has(const Tokens& tokens, std::string_view word) {
  return std::ranges::find(tokens, word) != tokens.end();
}

std::optional<int> numberOf(const std::string& word) {
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end == word.data()) return std::nullopt;
  return value;
}

/// The value of `NAME = 3` somewhere among the tokens.
std::optional<int> assigned(const Tokens& tokens, std::string_view name) {
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    if (tokens[i] == name && tokens[i + 1] == "=") return numberOf(tokens[i + 2]);
  }
  return std::nullopt;
}

int bindingOf(const Tokens& declaration, const Tokens& all) {
  for (std::size_t i = 0; i + 2 < declaration.size(); ++i) {
    if (declaration[i] != "binding" || declaration[i + 1] != "=") continue;
    const std::string& value = declaration[i + 2];
    return numberOf(value).value_or(assigned(all, value).value_or(-1));
  }
  return -1;
}

/// The text between the qualifiers of a declaration and its end: its type and its names.
Tokens unqualified(const Tokens& declaration) {
  static const std::set<std::string_view> kQualifiers{
      "uniform",  "buffer",    "highp",    "mediump",  "lowp",   "readonly",
      "coherent", "writeonly", "volatile", "restrict", "precise"};
  Tokens result;
  for (std::size_t i = 0; i < declaration.size(); ++i) {
    if (declaration[i] == "layout") {
      while (i < declaration.size() && declaration[i] != ")") ++i;
    } else if (!kQualifiers.contains(declaration[i])) {
      result.push_back(declaration[i]);
    }
  }
  return result;
}

Kind kindOf(std::string_view type) {
  if (type.find("sampler") != std::string_view::npos) return Kind::kSampler;
  return type.find("image") != std::string_view::npos ? Kind::kImage : Kind::kUniform;
}

/// Adds the uniforms of a declaration: a and b for `uniform vec2 a, b[3];`.
void addUniforms(const Tokens& declaration, const Tokens& all, std::vector<ShaderInput>& inputs) {
  const Tokens rest = unqualified(declaration);
  if (rest.empty()) return;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i - 1] != "," && i != 1) continue;
    inputs.push_back({.kind = kindOf(rest.front()),
                      .name = rest[i],
                      .type = rest.front(),
                      .binding = bindingOf(declaration, all)});
  }
}

void addBlock(const Tokens& declaration, const Tokens& all, std::vector<ShaderInput>& inputs) {
  const bool isStorage = has(declaration, "buffer");
  const Tokens rest = unqualified(declaration);
  if (rest.empty()) return;
  inputs.push_back({.kind = isStorage ? Kind::kStorageBlock : Kind::kUniformBlock,
                    .name = rest.front(),
                    .type = {},
                    .binding = bindingOf(declaration, all)});
}

}  // namespace

bool ShaderConditions::reads(std::string_view line) {
  const std::size_t hash = line.find_first_not_of(" \t");
  const bool isDirective = hash != std::string_view::npos && line[hash] == '#';
  const std::string directive = isDirective ? wordAt(line, hash + 1) : "";
  const auto name = [&] { return wordAt(line, line.find(directive, hash) + directive.size()); };
  if (directive == "ifdef" || directive == "ifndef") {
    branches_.push_back(macros_.contains(name()) == (directive == "ifdef"));
    return false;
  }
  if (directive == "if") {
    branches_.push_back(true);
    return false;
  }
  if ((directive == "else" || directive == "endif") && !branches_.empty()) {
    if (directive == "else") {
      branches_.back() = !branches_.back();
    } else {
      branches_.pop_back();
    }
    return false;
  }
  if (std::ranges::find(branches_, false) != branches_.end()) return false;
  if (directive == "define") macros_.insert(name());
  if (directive == "undef") macros_.erase(name());
  return true;
}

std::string activeLines(std::string_view text) {
  ShaderConditions conditions;
  std::string result;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    if (conditions.reads(line)) result += line;
    result += '\n';
  }
  return result;
}

std::vector<ShaderInput> declaredInputs(std::string_view text) {
  const Tokens tokens = tokensOf(activeLines(text));
  std::vector<ShaderInput> inputs;
  Tokens declaration;
  int depth = 0;  // of braces
  for (const std::string& token : tokens) {
    if (token == "{") {
      const bool isBlock = has(declaration, "uniform") || has(declaration, "buffer");
      if (depth++ == 0 && isBlock) addBlock(declaration, tokens, inputs);
    } else if (token == "}") {
      if (--depth == 0) declaration.clear();
    } else if (depth == 0 && token == ";") {
      if (has(declaration, "uniform")) addUniforms(declaration, tokens, inputs);
      declaration.clear();
    } else if (depth == 0) {
      declaration.push_back(token);
    }
  }
  return inputs;
}

}  // namespace pleinair::gpu
