#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pleinair::config {

/// A configuration that ships with the program: a file of config/profiles, embedded at build.
struct Profile {
  std::string_view name;  ///< the file's, without ".toml": "demo"
  std::string_view toml;
};

/// All of them, by name.
std::span<const Profile> profiles();

std::vector<std::string> profileNames();

}  // namespace pleinair::config
