#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "hal/machine/machine_state.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::support {

/// A machine's files as the kernel writes them, in a folder of their own.
class FakeMachine {
 public:
  hal::MachinePlaces places() const {
    return {.thermal = path() / "thermal",
            .process = path() / "self",
            .memory = path() / "meminfo",
            .cgroups = path() / "cgroup",
            .synchronized = path() / "synchronized",
            .state = path()};
  }
  const std::filesystem::path& path() const { return folder_.path(); }

  /// `file`: within the folder.
  void write(const std::filesystem::path& file, const std::string& text) const {
    std::filesystem::create_directories((path() / file).parent_path());
    std::ofstream(path() / file) << text << "\n";
  }
  void setZone(int number, const std::string& type, int celsius) const {
    const auto zone = zoneOf(number);
    write(zone / "type", type);
    write(zone / "temp", std::to_string(celsius * 1000));
  }
  void setTrip(int zone, int number, const std::string& type, int celsius) const {
    const std::string trip = "trip_point_" + std::to_string(number);
    write(zoneOf(zone) / (trip + "_type"), type);
    write(zoneOf(zone) / (trip + "_temp"), std::to_string(celsius * 1000));
  }
  static std::filesystem::path zoneOf(int number) {
    return std::filesystem::path("thermal") / ("thermal_zone" + std::to_string(number));
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace pleinair::support
