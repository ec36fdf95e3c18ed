#include "firmware_app/config/input_map.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "config/toml_reader.h"
#include "config/toml_text.h"
#include "hal/keyboards/buttons.h"

namespace pleinair::app {
namespace {

using config::TomlTable;
using procedure::StepCommand;

std::string quotedText(const std::string& text) {
  return config::tomlString(text).value_or("\"\"");  // the kernel's names need not be UTF-8
}

constexpr int kMaxCardId = 1'000'000;

StepCommand commandAt(const TomlTable& table, const std::string& key) {
  const std::string text = table.string(key, "a command: one of " + procedure::stepCommandForms());
  const auto command = procedure::parseStepCommand(text);
  if (!command) throw table.error(key, command.error().problem, procedure::stepCommandForms());
  return *command;
}

MappedDevice readDevice(const TomlTable& table) {
  MappedDevice device{.device = table.string("device", "vendor:product, a name or a path")};
  if (device.device.empty())
    throw table.error("device", "is empty", "`pleinair inputs` lists them");
  device.label = table.optionalString("label").value_or("");
  device.grabs = table.optionalBoolean("grab").value_or(true);
  const TomlTable buttons = table.table("buttons");
  for (const std::string& name : buttons.keys()) {
    const std::optional<unsigned> code = hal::buttonNamed(name);
    if (!code) {
      throw buttons.error(name, "is no button",
                          "names such as BTN_LEFT and KEY_PAGEDOWN; `pleinair inputs --watch` "
                          "prints those that are pressed");
    }
    device.buttons[*code] = commandAt(buttons, name);
  }
  if (device.buttons.empty()) throw table.error("buttons", "has no button", "at least one");
  return device;
}

std::map<int, StepCommand> readCards(const TomlTable& table) {
  std::map<int, StepCommand> cards;
  for (const std::string& key : table.keys()) {
    int id = 0;
    const char* const end = key.data() + key.size();
    const auto read = std::from_chars(key.data(), end, id);
    if (read.ec != std::errc{} || read.ptr != end || id < 0 || id > kMaxCardId) {
      throw table.error(key, "is no tag's id", "a number from 0");
    }
    cards[id] = commandAt(table, key);
  }
  return cards;
}

}  // namespace

InputMap readInputMap(const std::filesystem::path& file) {
  const config::TomlDocument document = config::TomlDocument::parseFile(file);
  const TomlTable& root = document.root();
  InputMap map;
  std::set<std::string> known;
  for (const TomlTable& each : root.tables("device")) {
    map.devices.push_back(readDevice(each));
    if (!known.insert(map.devices.back().device).second) {
      throw each.error("device", "is there twice", "one table for each device");
    }
  }
  if (const auto cards = root.optionalTable("cards")) map.cards = readCards(*cards);
  root.finish();
  if (map.isEmpty()) throw root.error("device", "missing", "[[device]], [cards], or both");
  return map;
}

std::string inputMapText(const InputMap& map) {
  std::string text = "# Inputs of a procedure: `pleinair inputs --learn` writes such files.\n";
  for (const MappedDevice& device : map.devices) {
    text += fmt::format("\n[[device]]\ndevice = {}\n", quotedText(device.device));
    if (!device.label.empty()) text += fmt::format("label = {}\n", quotedText(device.label));
    text += fmt::format("grab = {}\n[device.buttons]\n", device.grabs);
    for (const auto& [code, command] : device.buttons) {
      text +=
          fmt::format("{} = {}\n", hal::buttonName(code), quotedText(procedure::textOf(command)));
    }
  }
  if (!map.cards.empty()) text += "\n[cards]\n";
  for (const auto& [id, command] : map.cards) {
    text += fmt::format("{} = {}\n", id, quotedText(procedure::textOf(command)));
  }
  return text;
}

}  // namespace pleinair::app
