#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace pleinair::app {

/// A folder that somebody has put files into, as on a stick.
class Medium {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }

  void write(const std::filesystem::path& file, const std::string& text) const {
    std::filesystem::create_directories((path() / file).parent_path());
    std::ofstream(path() / file, std::ios::binary | std::ios::trunc) << text;
  }
  void link(const std::filesystem::path& file, const std::filesystem::path& target) const {
    std::filesystem::create_symlink(target, path() / file);
  }
  void clear() const {
    for (const auto& each : std::filesystem::directory_iterator(path())) {
      std::filesystem::remove_all(each.path());
    }
  }

 private:
  support::TemporaryFolder folder_;
};

}  // namespace pleinair::app
