#include "config/toml_reader.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <map>
#include <regex>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "config/suggestion.h"
#include "config/toml_nesting.h"

namespace pleinair::config {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr int kMaxDepth = 16;
constexpr std::string_view kAllowedFile = "a TOML file of at most 1 MiB";

int lineOfRegion(const toml::source_region& region) {
  return static_cast<int>(region.begin.line);
}

/// The value for a message; `withType` if its type is the error.
std::string describe(const toml::node& node, bool withType) {
  const auto typed = [&](std::string value, std::string_view type) {
    return withType ? fmt::format("{} ({})", value, type) : value;
  };
  if (const auto* string = node.as_string()) return typed(quoted(string->get()), "string");
  if (const auto* integer = node.as_integer()) {
    return typed(fmt::format("{}", integer->get()), "integer");
  }
  if (const auto* number = node.as_floating_point()) {
    return typed(fmt::format("{}", number->get()), "number");
  }
  if (const auto* boolean = node.as_boolean())
    return typed(boolean->get() ? "true" : "false", "boolean");
  if (const auto* array = node.as_array()) return fmt::format("an array of {}", array->size());
  return node.is_table() ? "a table" : "a date or time";
}

std::optional<double> asNumber(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  return std::nullopt;
}

template <class T>
T orMissing(std::optional<T> value, const TomlTable& table, std::string_view key,
            const std::string& allowed) {
  if (!value) throw table.error(key, "missing", allowed);
  return std::move(*value);
}

}  // namespace

struct TomlTable::State {
  std::shared_ptr<const toml::table> document;  // keeps `table` alive
  const toml::table* table = nullptr;
  std::string file;
  std::filesystem::path directory;
  std::string path;
  int line = 0;
  std::vector<std::string> known;
  std::map<std::string, std::vector<std::shared_ptr<State>>, std::less<>> children;

  std::string pathOf(std::string_view key) const {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }

  /// Returns the node, or null if it is absent. Marks the key as known.
  const toml::node* ask(std::string_view key) {
    if (std::find(known.begin(), known.end(), key) == known.end()) known.emplace_back(key);
    return table->get(key);
  }

  ConfigError wrong(std::string keyPath, const toml::node& node, bool wrongType,
                    std::string allowed) const {
    return ConfigError({.file = file,
                        .line = lineOfRegion(node.source()),
                        .key = std::move(keyPath),
                        .found = describe(node, wrongType),
                        .allowed = std::move(allowed)});
  }

  double numberOf(const std::string& keyPath, const toml::node& node,
                  const NumberRange& range) const {
    const std::optional<double> value = asNumber(node);
    if (!value || !range.contains(*value)) throw wrong(keyPath, node, !value, range.describe());
    return *value;
  }

  std::shared_ptr<State> child(const toml::table& node, std::string childPath) const {
    auto state = std::make_shared<State>();
    state->document = document;
    state->table = &node;
    state->file = file;
    state->directory = directory;
    state->path = std::move(childPath);
    state->line = lineOfRegion(node.source());
    return state;
  }

  void finish() const {
    for (const auto& [key, node] : *table) {
      const std::string_view name = key.str();
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      throw ConfigError({.file = file,
                         .line = lineOfRegion(key.source()),
                         .key = pathOf(name),
                         .problem = unknownText("key", name, known),
                         .allowed = listText(known)});
    }
    for (const auto& [key, tables] : children) {
      for (const std::shared_ptr<State>& each : tables) each->finish();
    }
  }
};

std::optional<std::string> TomlTable::optionalString(std::string_view key,
                                                     std::string_view allowed) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  const auto* value = node->as_string();
  if (!value) throw state_->wrong(pathOf(key), *node, true, std::string(allowed));
  return value->get();
}

std::string TomlTable::string(std::string_view key, std::string_view allowed) const {
  return orMissing(optionalString(key, allowed), *this, key, std::string(allowed));
}

std::optional<double> TomlTable::optionalNumber(std::string_view key,
                                                const NumberRange& range) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  return state_->numberOf(pathOf(key), *node, range);
}

double TomlTable::number(std::string_view key, const NumberRange& range) const {
  return orMissing(optionalNumber(key, range), *this, key, range.describe());
}

std::optional<int> TomlTable::optionalInteger(std::string_view key,
                                              const IntegerRange& range) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  const auto* value = node->as_integer();
  if (!value || !range.contains(value->get())) {
    throw state_->wrong(pathOf(key), *node, !value, range.describe());
  }
  return static_cast<int>(value->get());
}

int TomlTable::integer(std::string_view key, const IntegerRange& range) const {
  return orMissing(optionalInteger(key, range), *this, key, range.describe());
}

std::optional<bool> TomlTable::optionalBoolean(std::string_view key) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  if (const auto* word = node->as_string()) {
    if (word->get() == "on") return true;
    if (word->get() == "off") return false;
  }
  const auto* value = node->as_boolean();
  if (!value) throw state_->wrong(pathOf(key), *node, true, "true or false");
  return value->get();
}

bool TomlTable::boolean(std::string_view key) const {
  return orMissing(optionalBoolean(key), *this, key, "true or false");
}

std::optional<std::vector<double>> TomlTable::optionalNumbers(std::string_view key,
                                                              LengthRange length,
                                                              const NumberRange& range) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  const auto* array = node->as_array();
  if (!array || !length.contains(array->size())) {
    throw state_->wrong(pathOf(key), *node, true, length.describe(range.describe(true)));
  }
  std::vector<double> values;
  values.reserve(array->size());
  for (const toml::node& element : *array) {
    const std::string path = fmt::format("{}[{}]", pathOf(key), values.size());
    values.push_back(state_->numberOf(path, element, range));
  }
  return values;
}

std::vector<double> TomlTable::numbers(std::string_view key, LengthRange length,
                                       const NumberRange& range) const {
  return orMissing(optionalNumbers(key, length, range), *this, key,
                   length.describe(range.describe(true)));
}

std::optional<std::vector<std::string>> TomlTable::optionalStrings(std::string_view key,
                                                                   LengthRange length,
                                                                   std::string_view allowed) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  const auto* array = node->as_array();
  if (!array || !length.contains(array->size())) {
    throw state_->wrong(pathOf(key), *node, true, std::string(allowed));
  }
  std::vector<std::string> values;
  for (const toml::node& element : *array) {
    const auto* text = element.as_string();
    if (!text) {
      throw state_->wrong(fmt::format("{}[{}]", pathOf(key), values.size()), element, true,
                          std::string(allowed));
    }
    values.push_back(text->get());
  }
  return values;
}

std::optional<std::size_t> TomlTable::optionalChoice(std::string_view key,
                                                     std::span<const std::string> choices) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  const auto* value = node->as_string();
  // "90" may be written as a number.
  const auto* number = node->as_integer();
  const std::string text = value    ? value->get()
                           : number ? fmt::format("{}", number->get())
                                    : std::string();
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end() && value) {
    throw error(key, "found " + foundText(value->get(), choices), listText(choices));
  }
  if (found == choices.end()) throw state_->wrong(pathOf(key), *node, true, listText(choices));
  return static_cast<std::size_t>(found - choices.begin());
}

std::size_t TomlTable::choice(std::string_view key, std::span<const std::string> choices) const {
  return orMissing(optionalChoice(key, choices), *this, key, listText(choices));
}

std::optional<TomlTable> TomlTable::optionalTable(std::string_view key) const {
  const toml::node* node = state_->ask(key);
  if (!node) return std::nullopt;
  const toml::table* table = node->as_table();
  if (!table) throw state_->wrong(pathOf(key), *node, true, "a table");
  auto& views = state_->children[std::string(key)];
  if (views.empty()) views.push_back(state_->child(*table, pathOf(key)));
  return TomlTable(views.front());
}

TomlTable TomlTable::table(std::string_view key) const {
  return orMissing(optionalTable(key), *this, key, "a table");
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  const toml::node* node = state_->ask(key);
  if (!node) return {};
  const toml::array* array = node->as_array();
  if (!array) {
    throw state_->wrong(pathOf(key), *node, true,
                        fmt::format("an array of tables, [[{}]]", pathOf(key)));
  }
  auto& views = state_->children[std::string(key)];
  for (std::size_t i = views.size(); i < array->size(); ++i) {
    const std::string path = fmt::format("{}[{}]", pathOf(key), i);
    const toml::table* table = (*array)[i].as_table();
    if (!table) throw state_->wrong(path, (*array)[i], true, "a table");
    views.push_back(state_->child(*table, path));
  }
  std::vector<TomlTable> result;
  for (const auto& view : views) result.push_back(TomlTable(view));
  return result;
}

bool TomlTable::has(std::string_view key) const {
  return state_->table->contains(key);
}

bool TomlTable::isString(std::string_view key) const {
  const toml::node* node = state_->table->get(key);
  return node != nullptr && node->is_string();
}

bool TomlTable::isTable(std::string_view key) const {
  const toml::node* node = state_->table->get(key);
  return node != nullptr && node->is_table();
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, node] : *state_->table) names.emplace_back(key.str());
  return names;
}

int TomlTable::lineOf(std::string_view key) const {
  const toml::node* node = state_->table->get(key);
  return node ? lineOfRegion(node->source()) : state_->line;
}

std::string TomlTable::pathOf(std::string_view key) const {
  return state_->pathOf(key);
}

const std::string& TomlTable::file() const {
  return state_->file;
}

const std::filesystem::path& TomlTable::directory() const {
  return state_->directory;
}

void TomlTable::finish() const {
  state_->finish();
}

ConfigError TomlTable::error(std::string_view key, std::string problem, std::string allowed) const {
  return ConfigError({.file = state_->file,
                      .line = lineOf(key),
                      .key = pathOf(key),
                      .problem = std::move(problem),
                      .allowed = std::move(allowed)});
}

namespace {

std::string_view lineNumbered(std::string_view text, int line) {
  for (; line > 1 && !text.empty(); --line) {
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return text.substr(0, text.find('\n'));
}

/// "= 0,1": the comma of most languages.
bool hasDecimalComma(std::string_view line) {
  static const std::regex kPattern(R"(=\s*[-+]?\d{1,10},\d)");
  constexpr std::size_t kLongest = 1000;  // std::regex recurses
  line = line.substr(0, kLongest);
  return std::regex_search(line.begin(), line.end(), kPattern);
}

}  // namespace

TomlDocument TomlDocument::parseText(std::string_view text, std::string name,
                                     const std::filesystem::path& directory) {
  if (text.size() > kMaxBytes) {
    throw ConfigError(
        {.file = std::move(name), .problem = "too large", .allowed = std::string(kAllowedFile)});
  }
  if (const std::optional<int> line = lineNestedTooDeep(text, kMaxDepth)) {
    throw ConfigError({.file = std::move(name),
                       .line = *line,
                       .problem = "nested too deeply",
                       .allowed = fmt::format("{} levels", kMaxDepth)});
  }
  auto state = std::make_shared<TomlTable::State>();
  try {
    state->document = std::make_shared<const toml::table>(toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    const int line = lineOfRegion(error.source());
    throw ConfigError({.file = std::move(name),
                       .line = line,
                       .problem = fmt::format("not TOML: {}", error.description()),
                       .allowed = hasDecimalComma(lineNumbered(text, line))
                                      ? "a decimal point: 0.1, not 0,1"
                                      : ""});
  }
  state->table = state->document.get();
  state->file = std::move(name);
  state->directory = directory;
  return TomlDocument(TomlTable(std::move(state)));
}

TomlDocument TomlDocument::parseFile(const std::filesystem::path& path) {
  const auto refuse = [&](std::string problem) {
    return ConfigError({.file = path.string(),
                        .problem = std::move(problem),
                        .allowed = std::string(kAllowedFile)});
  };
  // Checked before opening: opening a pipe without a writer would block.
  std::error_code failure;
  const std::filesystem::file_status status = std::filesystem::status(path, failure);
  if (failure) throw refuse("cannot open: " + failure.message());
  if (std::filesystem::is_directory(status)) throw refuse("is a directory");
  if (!std::filesystem::is_regular_file(status)) throw refuse("is not a regular file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw refuse("cannot open: " + std::generic_category().message(errno));
  std::string text(kMaxBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad()) throw refuse("cannot read");
  text.resize(static_cast<std::size_t>(file.gcount()));
  return parseText(text, path.string(), path.parent_path());
}

}  // namespace pleinair::config
