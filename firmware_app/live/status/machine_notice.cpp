#include "firmware_app/live/status/machine_notice.h"

#include <array>
#include <fstream>
#include <sstream>

#include "config/toml_text.h"

namespace pleinair::app {

MachineNotice::MachineNotice(const std::filesystem::path& file, hal::Duration interval)
    : readings_(
          "notice", [file] { return readNotice(file); }, interval) {}

std::string MachineNotice::text() const {
  const auto reading = readings_.latest();
  return reading ? reading->value : std::string();
}

std::string readNotice(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, kMostNoticeBytes> bytes{};
  stream.read(bytes.data(), bytes.size());
  std::istringstream lines(std::string(bytes.data(), static_cast<std::size_t>(stream.gcount())));
  std::string text;
  int count = 0;
  for (std::string line; count < kMostNoticeLines && std::getline(lines, line); ++count) {
    text += (text.empty() ? "" : "\n") + config::tomlComment(line);
  }
  return text;
}

}  // namespace pleinair::app
