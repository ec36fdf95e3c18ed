#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pleinair::app {

/// A file or a series of numbered pictures, and the option or description that names it.
struct NamedPath {
  std::string option;  ///< "--input", "a file of the scene"
  std::filesystem::path path;
};

/// Whether `output` means numbered pictures, each published when it is complete: a folder or a
/// pattern.
bool isFrameSeries(const std::filesystem::path& output);

/// Checks that no output overwrites an input, that no two outputs have the same place, and that no
/// pictures are written into a folder that is read. Links are followed. Throws hal::Failure
/// (kInvalidArgument).
void refuseCollisions(const std::vector<NamedPath>& read, const std::vector<NamedPath>& written);

}  // namespace pleinair::app
