#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "firmware_app/repair_station/live_procedure.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {

/// A procedure of four steps, one with each kind of answer, that keys step through.
class LiveProcedureTest : public testing::Test {
 protected:
  static void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }
  static std::string textOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  void SetUp() override {
    std::filesystem::create_directories(procedure());
    std::filesystem::create_directories(records());
    writeSteps("max = 2");
    write(procedure() / "en.md",
          "# Service\n## open: Open it\nLift the *cover*.\n## look: Look\n? Is it clean?\n"
          "## gap: Measure\n? Gap\n## shoot: Photograph\n");
  }

  void writeSteps(const std::string& limit) const {
    write(procedure() / "procedure.toml",
          "name = \"service\"\nversion = \"1\"\nlanguages = [\"en\"]\n"
          "step = [\n{ id = \"open\", removes = [\"oil_plug\"], torque = \"5 Nm\" },\n"
          "{ id = \"look\", check = \"yes_no\" },\n"
          "{ id = \"gap\", check = { kind = \"value\", unit = \"mm\", " +
              limit + " } },\n{ id = \"shoot\", check = \"photo\" }]\n" +
              "[model]\nsource = \"builtin:gearbox\"\n");
  }

  /// Saves another limit; poll() sees it from now on.
  void edit(const std::string& limit) {
    writeSteps(limit);
    edited_ += std::chrono::seconds(1);
    std::filesystem::last_write_time(procedure() / "procedure.toml",
                                     std::filesystem::file_time_type::clock::now() + edited_);
    clock_.advance(std::chrono::seconds(1));
  }

  LiveProcedure begin(bool isRecorded = true,
                      record::RecordSystem system = record::RecordSystem::real()) {
    return LiveProcedure({.folder = procedure(),
                          .records = isRecorded ? records() : std::filesystem::path(),
                          .operatorName = "Jo",
                          .program = "1",
                          .system = std::move(system)},
                         clock_);
  }

  /// Signs off before the end.
  static void pressAbort(LiveProcedure& procedure) {
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(procedure.press({.name = "x", .shift = true}));
  }
  /// Presses keys with spaces between them.
  static void press(LiveProcedure& procedure, const std::string& keys) {
    std::size_t at = 0;
    while (at < keys.size()) {
      const std::size_t end = std::min(keys.find(' ', at), keys.size());
      EXPECT_TRUE(procedure.press({.name = keys.substr(at, end - at)}))
          << keys.substr(at, end - at);
      procedure.finish();
      at = end + 1;
    }
  }

  static hal::Image picture() {
    return hal::Image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {8, 8}});
  }

  std::filesystem::path procedure() const { return folder_.path() / "service"; }
  std::filesystem::path records() const { return folder_.path() / "records"; }

  support::TemporaryFolder folder_;
  hal::SteppedClock clock_;
  std::chrono::seconds edited_{0};
};

}  // namespace pleinair::app
