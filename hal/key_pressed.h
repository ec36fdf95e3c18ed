#pragma once

#include <string>

namespace pleinair::hal {

/// A key went down, or repeats while it is held, in a window or on a keyboard without a desktop.
/// Keys with Control, Alt or the logo key belong to the desktop or the console and do not come.
struct KeyPressed {
  /// The name of the key without Shift, in lower case: "a", "1", "tab", "left", "pagedown", "f1",
  /// "space", "escape"; and "?", on its own key or on that of "/".
  std::string name;
  bool shift = false;
  bool isRepeat = false;
  friend bool operator==(const KeyPressed&, const KeyPressed&) = default;
};

}  // namespace pleinair::hal
