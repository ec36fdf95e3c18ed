#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration.h"
#include "hal/cameras/synthetic/synthetic_kind.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {

/// A request, of which tests fill what they are about, and a folder for its files.
class ConfigurationTest : public testing::Test {
 protected:
  ConfigurationTest() { request_.defaultSiteFile = path("absent.toml"); }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  Configuration resolved() const { return Configuration(request_); }

  /// [camera.synthetic]'s seed.
  static std::string seedOf(const Configuration& configuration) {
    return configuration.camera().tableOf(hal::synthetic::cameraKind()).text("seed");
  }

  /// The error's message; "(nothing thrown)" if there is none.
  std::string refusal() const {
    try {
      resolved();
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "(nothing thrown)";
  }

  support::TemporaryFolder folder_;
  ConfigurationRequest request_;
};

}  // namespace pleinair::app
