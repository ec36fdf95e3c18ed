#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pleinair::config {

/// A configuration that is part of the program: a file of config/profiles, embedded at build.
struct Profile {
  std::string_view name;  ///< the file's name without ".toml": "demo"
  std::string_view toml;
};

/// All profiles, by name.
std::span<const Profile> profiles();

std::vector<std::string> profileNames();

}  // namespace pleinair::config
