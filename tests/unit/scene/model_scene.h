#pragma once

#include <fstream>
#include <ios>
#include <string>

#include <gtest/gtest.h>

#include "config/config_error.h"
#include "pipeline/scene/description/scene_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::scene {

/// A scene with one tag and a model, whose keys begin on line 8.
class ModelScene : public testing::Test {
 protected:
  void write(const std::string& file, const GltfBuilder& builder) {
    const auto bytes = builder.bytes();
    std::ofstream(folder_.path() / file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  Scene sceneWith(const std::string& source, const std::string& keys) {
    return parseScene(
        "[[tag]]\nid = 0\nedge_m = 0.1\n[[model]]\nname = \"it\"\nattach = \"tag:0\"\n"
        "source = \"" +
            source + "\"\n" + keys,
        "scene.toml", folder_.path());
  }
  std::string errorOf(const std::string& source, const std::string& keys) {
    try {
      sceneWith(source, keys);
    } catch (const config::ConfigError& error) {
      return error.what();
    }
    return "(nothing thrown)";
  }

  support::TemporaryFolder folder_;
};

}  // namespace pleinair::scene
