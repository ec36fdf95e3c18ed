#pragma once

#include <stdexcept>
#include <string>

namespace pleinair::config {

/// The parts of a ConfigError. Empty parts are left out of the message.
struct ConfigFault {
  std::string file;     ///< the file, or another source of the value: "--set"
  int line = 0;         ///< from 1; 0 if there is none
  std::string key;      ///< with its path: "tag[0].edge"
  std::string problem;  ///< "missing"; empty stands for "found <found>"
  std::string found;    ///< the value found: "\"big\" (string)"
  std::string allowed;  ///< "a number of metres in (0, 10]"
};

/// An error in a configuration, scene or calibration file, or in a value given for one of its keys.
/// what() is one line: `scene.toml:12: tag.edge: found "big" (string), allowed: a number of ...`.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(ConfigFault fault);

  const std::string& file() const { return fault_.file; }
  int line() const { return fault_.line; }
  const std::string& key() const { return fault_.key; }
  const std::string& found() const { return fault_.found; }
  const std::string& allowed() const { return fault_.allowed; }

 private:
  ConfigFault fault_;
};

/// The text in quotes, shortened if it is long, for messages about a string that was found.
std::string quoted(const std::string& text);

}  // namespace pleinair::config
