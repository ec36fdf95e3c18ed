#include "hal/keyboards/key_codes.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <linux/input-event-codes.h>

namespace pleinair::hal::keyboards {
namespace {

using Named = std::pair<unsigned, std::string_view>;

/// Keys that bear a word or a sign. SDL's names, as a window has them.
constexpr std::array<Named, 34> kNamed{{
    {KEY_ESC, "escape"},
    {KEY_TAB, "tab"},
    {KEY_BACKSPACE, "backspace"},
    {KEY_ENTER, "return"},
    {KEY_SPACE, "space"},
    {KEY_LEFT, "left"},
    {KEY_RIGHT, "right"},
    {KEY_UP, "up"},
    {KEY_DOWN, "down"},
    {KEY_PAGEUP, "pageup"},
    {KEY_PAGEDOWN, "pagedown"},
    {KEY_HOME, "home"},
    {KEY_END, "end"},
    {KEY_INSERT, "insert"},
    {KEY_DELETE, "delete"},
    {KEY_MINUS, "-"},
    {KEY_EQUAL, "="},
    {KEY_COMMA, ","},
    {KEY_DOT, "."},
    {KEY_SLASH, "/"},
    {KEY_SEMICOLON, ";"},
    {KEY_APOSTROPHE, "'"},
    {KEY_LEFTBRACE, "["},
    {KEY_RIGHTBRACE, "]"},
    {KEY_BACKSLASH, "\\"},
    {KEY_GRAVE, "`"},
    {KEY_QUESTION, "?"},
    {KEY_F11, "f11"},
    {KEY_F12, "f12"},
    {KEY_PAUSE, "pause"},
    {KEY_PRINT, "printscreen"},
    {KEY_MENU, "menu"},
    {KEY_HELP, "help"},
    {KEY_0, "0"},
}};

/// Runs of keys whose codes follow each other.
struct Row {
  unsigned first;
  std::string_view keys;
};
constexpr std::array<Row, 4> kRows{
    {{KEY_1, "123456789"}, {KEY_Q, "qwertyuiop"}, {KEY_A, "asdfghjkl"}, {KEY_Z, "zxcvbnm"}}};

}  // namespace

Modifier modifierOf(unsigned code) {
  switch (code) {
    case KEY_LEFTSHIFT:
    case KEY_RIGHTSHIFT:
      return Modifier::kShift;
    case KEY_LEFTCTRL:
    case KEY_RIGHTCTRL:
    case KEY_LEFTALT:
    case KEY_RIGHTALT:
    case KEY_LEFTMETA:
    case KEY_RIGHTMETA:
      return Modifier::kOther;
    default:
      return Modifier::kNone;
  }
}

std::string keyNameOf(unsigned code, bool shift) {
  if (code == KEY_SLASH && shift) return "?";
  const auto named = std::ranges::find(kNamed, code, &Named::first);
  if (named != kNamed.end()) return std::string(named->second);
  for (const Row& row : kRows) {
    if (code >= row.first && code - row.first < row.keys.size()) {
      return std::string(1, row.keys[code - row.first]);
    }
  }
  if (code >= KEY_F1 && code <= KEY_F10) return "f" + std::to_string(code - KEY_F1 + 1);
  return {};
}

}  // namespace pleinair::hal::keyboards
